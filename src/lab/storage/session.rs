//! A session: the data from which the lab resumes where it was. A thread saves it to the disk while the lab runs, at
//! most a second late, so that it survives any end of the process.
//!
//! The content is two texts, which this module does not interpret: the work, which rarely changes and may be long, and
//! the place, which changes all the time.

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

/// Maximum time for which a flush may block the main loop.
const FLUSH_LIMIT: Duration = Duration::from_millis(400);
/// Interval at which new content is saved. It is long enough that a running run does not keep the disk busy.
const SAVE_INTERVAL: Duration = Duration::from_millis(500);

/// The final state of a session that has ended.
#[derive(Debug)]
pub struct ClosedSession {
    /// The content that was last saved; `None` if none was.
    pub kept: Option<SessionContent>,
    /// The reason why `kept` is not the latest content; `None` if it is.
    pub trouble: Option<String>,
}

/// The session of this process. No other process can open it while this value exists. Dropping the value saves and
/// releases the session.
#[derive(Debug)]
pub struct Session {
    name: String,
    state: Arc<Mutex<SaveState>>,
    flushes: Flushes,
    writer: Option<JoinHandle<()>>,
    _at_end: Registered,
}

/// Requests to the writer to save at once and to answer. If the flag is true, the writer then ends.
type Flushes = Sender<(Sender<()>, bool)>;

/// The content to save, and what has been saved.
#[derive(Debug, Default)]
struct SaveState {
    noted: Option<SessionContent>,
    /// True if the latest content is not saved yet.
    is_news: bool,
    kept: Option<SessionContent>,
    trouble: Option<String>,
}

/// The result of looking for a session to resume.
#[derive(Debug)]
pub struct SessionSearch<T> {
    /// The newest session that is not in use and can be read, and the value that `read` returned for it.
    pub resumed: Option<(Session, T)>,
    /// Newer files that cannot be read, or that belong to another version or user. They are left unchanged.
    pub left_alone: Vec<LeftAlone>,
    /// Process IDs of the processes that use newer sessions, as far as known.
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
    /// Time at which it was last saved.
    pub written: SystemTime,
    /// True if a running process uses it.
    pub is_in_use: bool,
    /// Process ID of that process, if known.
    pub owner: Option<u32>,
    /// Its content, or the reason why it cannot be read.
    pub content: Result<SessionContent, String>,
}

/// Returns the folder for sessions: `$XDG_STATE_HOME/gyrolab`, by default `~/.local/state/gyrolab`.
pub fn folder() -> Result<PathBuf, String> {
    let state = Xdg::new().ok().and_then(|places| places.state_dir());
    match state.filter(|folder| folder.is_absolute()) {
        Some(folder) => Ok(folder.join("gyrolab")),
        None => Err(
            "sessions cannot be saved: there is no home folder; set HOME or XDG_STATE_HOME to the full path of a folder"
                .to_owned(),
        ),
    }
}

/// Resumes the newest session in `folder` that no running process uses and that `read` accepts, or the session called
/// `only`.
///
/// # Errors
/// Returns an error if the folder cannot be read or there is no session called `only`.
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

/// Lists the sessions in `folder`, the latest first, without changing anything.
pub fn list(folder: &Path) -> io::Result<Vec<ListedSession>> {
    let names = sessions(folder)?.into_iter();
    Ok(names.map(|name| listed(folder, name)).collect())
}

/// Returns the entry of the session called `name` in `folder`, as in [`list`]; `None` if there is none.
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

/// Returns the names of all sessions in `folder`, the latest first; empty if there is no such folder.
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
    /// Starts a new session in `folder`, which is created if it does not exist, and removes the oldest unused sessions.
    /// Nothing is saved before the first [`note`](Self::note).
    pub fn begin(folder: &Path) -> io::Result<Self> {
        let begun = make_folder(folder).and_then(|()| {
            session_file::prune(folder);
            HeldSession::new(folder)
        });
        match begun {
            Ok(held) => Self::start(held, None),
            Err(error) => Err(error_about(&error, "sessions cannot be saved in", folder)),
        }
    }

    /// Starts the session of `held`, whose content on the disk is `kept`.
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

    /// Sets the content to save. This is fast, and may be called in every round of the main loop.
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

    /// Saves at once, and gives up after 0.4 s. Returns true if saving was attempted in that time.
    /// [`trouble`](Self::trouble) says whether it failed.
    pub fn flush(&self) -> bool {
        flush(&self.flushes, FLUSH_LIMIT, false)
    }

    /// Returns the reason why the last attempt to save failed; `None` if it succeeded. The thread tries again every
    /// half second.
    pub fn trouble(&self) -> Option<String> {
        locked(&self.state).trouble.clone()
    }

    /// Saves and ends the session. Waits at most `patience` for the disk.
    pub fn close(mut self, patience: Duration) -> ClosedSession {
        let is_in_time = self.end(patience);
        let state = locked(&self.state);
        let mut trouble = state.trouble.clone();
        if !is_in_time {
            let slow = "the session cannot be saved: the disk takes too long";
            trouble.get_or_insert_with(|| slow.to_owned());
        }
        ClosedSession {
            kept: state.kept.clone(),
            trouble,
        }
    }

    /// Saves and ends the writer. A writer that hangs in a write to a dead disk is abandoned after `patience`.
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

/// Makes the writer save, and waits for it at most `patience`. Returns true if it tried in that time.
fn flush(flushes: &Flushes, patience: Duration, ends: bool) -> bool {
    let (done, is_done) = channel();
    let _ = flushes.send((done, ends));
    is_done.recv_timeout(patience).is_ok()
}

/// The body of the writer thread. It returns when the session is closed. A session that was never saved is removed.
fn keep_writing(
    held: HeldSession,
    state: &Mutex<SaveState>,
    flushes: &Receiver<(Sender<()>, bool)>,
) {
    loop {
        let flushed = flushes.recv_timeout(SAVE_INTERVAL);
        // A flush saves unchanged content too, so that the session that was left last has the newest file.
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
            state.trouble = Some(format!("the session cannot be saved: {error}"));
            state.is_news = true;
        }
    }
}
