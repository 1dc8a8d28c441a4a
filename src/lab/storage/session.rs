//! A session: what the lab needs to resume where it was. A thread saves it to the disk while the lab runs, at most a second
//! late, so that it survives whatever ends the process.
//!
//! The content is two texts, which this module does not interpret: the work, which changes seldom and may be long, and the
//! place in it, which changes all the time.

use super::at_exit::{self, Registered};
use super::private_files::make_folder;
use super::session_file::{self, HeldSession};
pub use super::session_file::{SessionContent, SharedText, later};
use crate::engine::text::printable::PrintablePath;
use etcetera::{BaseStrategy, base_strategy::Xdg};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime};

/// How long a flush may hold up the loop.
const FLUSH_LIMIT: Duration = Duration::from_millis(400);
/// How often what was noted is saved; a running run does not keep the disk busy.
const SAVE_INTERVAL: Duration = Duration::from_millis(500);

/// What is left of a session that has ended.
#[derive(Debug)]
pub struct ClosedSession {
    /// The content that was saved last; `None` if none was.
    pub kept: Option<SessionContent>,
    /// Why that is not the content that was noted last.
    pub trouble: Option<String>,
}

/// The session of this process. No other process can take it while this value lives; dropping it saves the session and
/// frees it.
#[derive(Debug)]
pub struct Session {
    name: String,
    state: Arc<Mutex<SaveState>>,
    flushes: Flushes,
    writer: Option<JoinHandle<()>>,
    _at_end: Registered,
}

/// Each asks the writer to save at once and to answer, and tells whether it is to end then.
type Flushes = Sender<(Sender<()>, bool)>;

/// The content to save, and what has been saved.
#[derive(Debug, Default)]
struct SaveState {
    noted: Option<SessionContent>,
    /// Whether what was noted last is still to be saved.
    is_news: bool,
    kept: Option<SessionContent>,
    trouble: Option<String>,
}

/// The result of looking for a session to resume.
#[derive(Debug)]
pub struct SessionSearch<T> {
    /// The newest session that is not in use and can be read, and what `read` made of its content.
    pub resumed: Option<(Session, T)>,
    /// Newer files that cannot be read or are another version's or user's; they are unchanged.
    pub left_alone: Vec<LeftAlone>,
    /// Process numbers of the processes that use newer sessions, as far as they are known.
    pub in_use_by: Vec<u32>,
}

/// A file of a session that cannot be resumed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftAlone {
    pub path: PathBuf,
    pub reason: String,
}

#[derive(Debug)]
pub struct ListedSession {
    pub name: String,
    /// When it was saved last.
    pub written: SystemTime,
    /// Whether a running process holds it.
    pub is_in_use: bool,
    /// The number of that process, if known.
    pub owner: Option<u32>,
    /// What it holds, or why it cannot be read.
    pub content: Result<SessionContent, String>,
}

/// Returns the folder for sessions: `$XDG_STATE_HOME/gyrolab`, by default `~/.local/state/gyrolab`.
pub fn folder() -> Result<PathBuf, String> {
    let state = Xdg::new().ok().and_then(|places| places.state_dir());
    match state.filter(|folder| folder.is_absolute()) {
        Some(folder) => Ok(folder.join("gyrolab")),
        None => Err(
            "sessions cannot be kept: there is no home folder; set HOME or XDG_STATE_HOME to the full path of a folder"
                .to_owned(),
        ),
    }
}

/// Resumes the newest session in `folder` that no running process holds and that `read` accepts, or `only` that of one
/// name.
pub fn resume<T>(
    folder: &Path,
    only: Option<&str>,
    read: impl Fn(&SessionContent) -> Result<T, String>,
) -> io::Result<SessionSearch<T>> {
    let mut names = sessions(folder)?;
    if let Some(only) = only {
        names.retain(|name| name == only);
        if names.is_empty() {
            let kind = io::ErrorKind::NotFound;
            return Err(io::Error::new(kind, "there is no such session"));
        }
    }
    let mut found = SessionSearch {
        resumed: None,
        left_alone: Vec::new(),
        in_use_by: Vec::new(),
    };
    for name in names {
        let reason = match HeldSession::lock(folder, &name) {
            Ok(None) => {
                found.in_use_by.extend(session_file::owner(folder, &name));
                continue;
            }
            Ok(Some(held)) => {
                let stored = session_file::stored(folder, &name);
                match stored.and_then(|content| Ok((read(&content)?, content))) {
                    Ok((what, content)) => {
                        found.resumed = Some((Session::start(held, Some(content))?, what));
                        break;
                    }
                    Err(reason) => reason,
                }
            }
            Err(error) => error.to_string(),
        };
        let path = session_file::file(folder, &name, "session");
        found.left_alone.push(LeftAlone { path, reason });
    }
    Ok(found)
}

/// Lists the sessions in `folder`, the one saved last first. It changes nothing.
pub fn list(folder: &Path) -> io::Result<Vec<ListedSession>> {
    let names = sessions(folder)?.into_iter();
    Ok(names.map(|name| listed(folder, name)).collect())
}

/// Returns the session called `name` in `folder`, as [`list`] has it; `None` if there is none.
pub fn look_at(folder: &Path, name: &str) -> Option<ListedSession> {
    let names = sessions(folder).ok()?;
    names
        .contains(&name.to_owned())
        .then(|| listed(folder, name.to_owned()))
}

fn listed(folder: &Path, name: String) -> ListedSession {
    let is_in_use = session_file::is_in_use(folder, &name);
    ListedSession {
        written: session_file::written_at(folder, &name),
        is_in_use,
        owner: session_file::owner(folder, &name).filter(|_| is_in_use),
        content: session_file::stored(folder, &name),
        name,
    }
}

/// Returns the names of all sessions in `folder`, the one saved last first; none where there is no such folder.
fn sessions(folder: &Path) -> io::Result<Vec<String>> {
    let found = session_file::sessions(folder);
    found.map_err(|error| error_about(&error, "cannot look for sessions in", folder))
}

fn error_about(error: &io::Error, what: &str, folder: &Path) -> io::Error {
    io::Error::new(
        error.kind(),
        format!("{what} {}: {error}", PrintablePath(folder)),
    )
}

impl Session {
    /// Begins a new session in `folder`, which is created if it does not exist, and removes the oldest unused sessions.
    /// Nothing is saved before the first [`note`](Self::note).
    pub fn begin(folder: &Path) -> io::Result<Self> {
        let begun = make_folder(folder).and_then(|()| {
            session_file::prune(folder);
            HeldSession::new(folder)
        });
        match begun {
            Ok(held) => Self::start(held, None),
            Err(error) => Err(error_about(&error, "sessions cannot be kept in", folder)),
        }
    }

    /// Returns the session of `held`, of which the disk holds `kept`.
    fn start(held: HeldSession, kept: Option<SessionContent>) -> io::Result<Self> {
        let name = held.name().to_owned();
        let state = Arc::new(Mutex::new(SaveState {
            kept,
            ..SaveState::default()
        }));
        let (flushes, received) = channel();
        let (of_writer, at_end) = (Arc::clone(&state), flushes.clone());
        let writer = thread::Builder::new()
            .name("session".to_owned())
            .spawn(move || keep_writing(held, &of_writer, &received))?;
        Ok(Self {
            name,
            state,
            flushes,
            writer: Some(writer),
            _at_end: at_exit::hook(move |release| {
                flush(&at_end, release.patience(), false);
            }),
        })
    }

    /// Makes `content` the content to save. It is quick, and may be called in every round of the loop.
    pub fn note(&self, content: SessionContent) {
        let mut state = locked(&self.state);
        if !state
            .noted
            .as_ref()
            .is_some_and(|noted| noted.is_same(&content))
        {
            state.noted = Some(content);
            state.is_news = true;
        }
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// Saves at once, and gives up after 0.4 s. Returns whether saving was attempted in that time;
    /// [`trouble`](Self::trouble) tells whether it failed.
    pub fn flush(&self) -> bool {
        flush(&self.flushes, FLUSH_LIMIT, false)
    }

    /// Returns why the last attempt to save failed; `None` if it succeeded. The thread tries again every half second.
    pub fn trouble(&self) -> Option<String> {
        locked(&self.state).trouble.clone()
    }

    /// Saves and ends the session. It waits at most `patience` for the disk.
    pub fn close(mut self, patience: Duration) -> ClosedSession {
        let is_in_time = self.end(patience);
        let state = locked(&self.state);
        let mut trouble = state.trouble.clone();
        if !is_in_time {
            let slow = "the session cannot be kept: the disk takes too long";
            trouble.get_or_insert_with(|| slow.to_owned());
        }
        ClosedSession {
            kept: state.kept.clone(),
            trouble,
        }
    }

    /// Saves and ends the writer. One that hangs in a write to a dead disk is left to itself after `patience`.
    fn end(&mut self, patience: Duration) -> bool {
        let Some(writer) = self.writer.take() else {
            return true;
        };
        let is_in_time = flush(&self.flushes, patience, true);
        if is_in_time {
            let _ = writer.join();
        }
        is_in_time
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.end(FLUSH_LIMIT);
    }
}

fn locked(state: &Mutex<SaveState>) -> MutexGuard<'_, SaveState> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes the writer save, and waits for it at most `patience`. Returns whether it tried in that time.
fn flush(flushes: &Flushes, patience: Duration, ends: bool) -> bool {
    let (done, is_done) = channel();
    let _ = flushes.send((done, ends));
    is_done.recv_timeout(patience).is_ok()
}

/// The body of the writer. It returns when the session is closed; one that was never saved leaves nothing.
fn keep_writing(
    held: HeldSession,
    state: &Mutex<SaveState>,
    flushes: &Receiver<(Sender<()>, bool)>,
) {
    loop {
        let flushed = flushes.recv_timeout(SAVE_INTERVAL);
        // A flush saves even what has not changed, so that the session left last has the newest file.
        if flushed.is_ok() || locked(state).is_news {
            save(&held, state);
        }
        match flushed {
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
            Ok((done, ends)) => {
                let _ = done.send(());
                if ends {
                    break;
                }
            }
        }
    }
    if locked(state).kept.is_none() {
        held.remove();
    }
}

fn save(held: &HeldSession, state: &Mutex<SaveState>) {
    let noted = {
        let mut state = locked(state);
        state.is_news = false;
        state.noted.clone()
    };
    let Some(content) = noted else { return };
    let saved = held.save(&content);
    let mut state = locked(state);
    match saved {
        Ok(()) => (state.kept, state.trouble) = (Some(content), None),
        Err(error) => {
            state.trouble = Some(format!("the session cannot be kept: {error}"));
            state.is_news = true;
        }
    }
}
