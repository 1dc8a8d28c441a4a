//! A session: what the lab needs to resume where it was. A thread saves it to the disk while the lab runs, at most a second
//! late, so that it survives whatever ends the process.
//!
//! The content is two texts, which this module does not interpret: the work, which changes seldom and may be long, and the
//! place in it, which changes all the time.

use super::at_exit::{self, Registered, Release};
use super::own::make_folder;
use super::slot::{self, Slot};
use crate::text::printable::Shown;
use etcetera::{BaseStrategy, base_strategy::Xdg};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime};

/// How long a flush may hold up the loop, or the shell that suspends the process.
const PATIENCE: Duration = Duration::from_millis(400);
/// How long it may hold up the end of the process.
const LAST_PATIENCE: Duration = Duration::from_secs(4);
/// Least time between two saves, so that a running run does not keep the disk busy.
const PERIOD: Duration = Duration::from_millis(500);

/// A text that is written when it is first read, once; a clone shares it.
pub type Text = Arc<LazyLock<String, Box<dyn FnOnce() -> String + Send>>>;

pub fn later(write: impl FnOnce() -> String + Send + 'static) -> Text {
    Arc::new(LazyLock::new(Box::new(write)))
}

/// The content of a session.
#[derive(Clone, Debug)]
pub struct Content {
    /// What changes seldom, such as the runs and their journals.
    pub work: Text,
    /// What changes all the time, such as the present step. It is short.
    pub place: String,
}

impl Content {
    fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.work, &other.work) && self.place == other.place
    }
}

/// What is left of a session that has ended.
#[derive(Debug)]
pub struct Closed {
    /// The content that was saved last; `None` if none was.
    pub kept: Option<Content>,
    /// Why that is not the content that was noted last.
    pub trouble: Option<String>,
}

/// The session of this process. No other process can take it while this value lives; dropping it saves the session and
/// frees it.
#[derive(Debug)]
pub struct Session {
    name: String,
    state: Arc<Mutex<State>>,
    orders: Sender<Order>,
    writer: Option<JoinHandle<()>>,
    _at_end: Registered,
}

/// The content to save, and what has been saved.
#[derive(Debug, Default)]
struct State {
    noted: Option<Content>,
    /// Whether the writer has taken what was noted last.
    is_taken: bool,
    kept: Option<Content>,
    trouble: Option<String>,
}

/// What the writer is to do.
enum Order {
    Save,
    /// Save at once, and answer.
    Flush(Sender<()>),
    End,
}

/// The result of looking for a session to resume.
#[derive(Debug)]
pub struct Found<T> {
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

/// A session in a listing.
#[derive(Debug)]
pub struct Listed {
    pub name: String,
    /// When it was saved last.
    pub written: SystemTime,
    /// Whether a running process holds it.
    pub is_in_use: bool,
    /// The number of that process, if known.
    pub owner: Option<u32>,
    /// What it holds, or why it cannot be read.
    pub content: Result<Content, String>,
}

/// The folder for sessions: `$XDG_STATE_HOME/gyrolab`, by default `~/.local/state/gyrolab`.
pub fn folder() -> Result<PathBuf, String> {
    let state = Xdg::new().ok().and_then(|places| places.state_dir());
    let folder = state.filter(|folder| folder.is_absolute());
    folder.map(|folder| folder.join("gyrolab")).ok_or_else(|| {
        "sessions cannot be kept: there is no home folder; set HOME or XDG_STATE_HOME to the full path of a folder"
            .to_owned()
    })
}

/// Resumes the newest session in `folder` that no running process holds and that `read` accepts; with a `name` only that
/// one.
///
/// # Errors
/// When `folder` cannot be listed, there is no session of that name, or the system gives no thread. A `folder` that does
/// not exist yet is no error.
pub fn resume<T>(
    folder: &Path,
    name: Option<&str>,
    mut read: impl FnMut(&Content) -> Result<T, String>,
) -> io::Result<Found<T>> {
    let mut names = sessions(folder)?;
    if let Some(name) = name {
        names.retain(|other| other == name);
        if names.is_empty() {
            let kind = io::ErrorKind::NotFound;
            return Err(io::Error::new(kind, "there is no such session"));
        }
    }
    let mut found = Found {
        resumed: None,
        left_alone: Vec::new(),
        in_use_by: Vec::new(),
    };
    for name in names {
        match taken(folder, &name, &mut read) {
            Ok(Some((slot, content, what))) => {
                found.resumed = Some((Session::start(slot, Some(content))?, what));
                break;
            }
            Ok(None) => found.in_use_by.extend(slot::owner(folder, &name)),
            Err(reason) => found.left_alone.push(LeftAlone {
                path: slot::file(folder, &name, "session"),
                reason,
            }),
        }
    }
    Ok(found)
}

/// Takes the session and reads it; `None` if it is in use.
fn taken<T>(
    folder: &Path,
    name: &str,
    read: &mut impl FnMut(&Content) -> Result<T, String>,
) -> Result<Option<(Slot, Content, T)>, String> {
    let Some(slot) = Slot::take(folder, name).map_err(|error| error.to_string())? else {
        return Ok(None);
    };
    let content = slot::stored(folder, name)?;
    let what = read(&content)?;
    Ok(Some((slot, content, what)))
}

/// Lists the sessions in `folder`, the one saved last first. It changes nothing.
pub fn list(folder: &Path) -> io::Result<Vec<Listed>> {
    let names = sessions(folder)?.into_iter();
    Ok(names.map(|name| listed(folder, name)).collect())
}

/// The session called `name` in `folder`, as [`list`] has it; `None` if there is none.
pub fn look_at(folder: &Path, name: &str) -> Option<Listed> {
    let mut names = sessions(folder).ok()?.into_iter();
    Some(listed(folder, names.find(|other| other == name)?))
}

fn listed(folder: &Path, name: String) -> Listed {
    let is_in_use = slot::is_in_use(folder, &name);
    Listed {
        written: slot::written_at(folder, &name),
        is_in_use,
        owner: slot::owner(folder, &name).filter(|_| is_in_use),
        content: slot::stored(folder, &name),
        name,
    }
}

/// The names of all sessions in `folder`, the one saved last first; none where there is no such folder.
fn sessions(folder: &Path) -> io::Result<Vec<String>> {
    match slot::sessions(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => {
            let text = format!("cannot look for sessions in {}: {error}", Shown(folder));
            Err(io::Error::new(error.kind(), text))
        }
        found => found,
    }
}

impl Session {
    /// Begins a new session in `folder`, which is created if it does not exist, and removes the oldest unused sessions.
    /// Nothing is saved before the first [`note`](Self::note).
    pub fn begin(folder: &Path) -> io::Result<Self> {
        let made = make_folder(folder).and_then(|()| {
            slot::prune(folder);
            Slot::new(folder)
        });
        let slot = made.map_err(|error| {
            let text = format!("sessions cannot be kept in {}: {error}", Shown(folder));
            io::Error::new(error.kind(), text)
        })?;
        Self::start(slot, None)
    }

    /// The session of `slot`, of which the disk holds `kept`.
    fn start(slot: Slot, kept: Option<Content>) -> io::Result<Self> {
        let name = slot.name().to_owned();
        let state = Arc::new(Mutex::new(State {
            kept,
            ..State::default()
        }));
        let (orders, received) = channel();
        let (of_writer, at_end) = (Arc::clone(&state), orders.clone());
        let writer = thread::Builder::new()
            .name("session".to_owned())
            .spawn(move || keep_writing(slot, &of_writer, &received))?;
        Ok(Self {
            name,
            state,
            orders,
            writer: Some(writer),
            _at_end: at_exit::hook(move |release| {
                let patience = match release {
                    Release::Exit => LAST_PATIENCE,
                    Release::Suspend => PATIENCE,
                };
                flush(&at_end, patience);
            }),
        })
    }

    /// Makes `content` the content to save. It only wakes the saving thread, and may be called in every round of the
    /// loop.
    pub fn note(&self, content: Content) {
        let mut state = locked(&self.state);
        if state
            .noted
            .as_ref()
            .is_some_and(|old| old.is_same(&content))
        {
            return;
        }
        let is_news = state.noted.replace(content).is_none() || state.is_taken;
        state.is_taken = false;
        if is_news {
            let _ = self.orders.send(Order::Save);
        }
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// Saves at once, and gives up after 0.4 s. Returns whether saving was attempted in that time;
    /// [`trouble`](Self::trouble) tells whether it failed.
    pub fn flush(&self) -> bool {
        flush(&self.orders, PATIENCE)
    }

    /// Why the last attempt to save failed; `None` if it succeeded. The thread tries again every half second.
    pub fn trouble(&self) -> Option<String> {
        locked(&self.state).trouble.clone()
    }

    /// Saves and ends the session. It waits at most `patience` for the disk.
    pub fn close(mut self, patience: Duration) -> Closed {
        let is_in_time = self.end(patience);
        let state = locked(&self.state);
        let slow = || "the session cannot be kept: the disk takes too long".to_owned();
        Closed {
            kept: state.kept.clone(),
            trouble: state.trouble.clone().or_else(|| (!is_in_time).then(slow)),
        }
    }

    /// Saves and ends the writer. One that hangs in a write to a dead disk is left to itself after `patience`.
    fn end(&mut self, patience: Duration) -> bool {
        let Some(writer) = self.writer.take() else {
            return true;
        };
        let is_in_time = flush(&self.orders, patience);
        let _ = self.orders.send(Order::End);
        if is_in_time {
            let _ = writer.join();
        }
        is_in_time
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.end(PATIENCE);
    }
}

fn locked(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes the writer save, and waits for it at most `patience`. Returns whether it tried in that time.
fn flush(orders: &Sender<Order>, patience: Duration) -> bool {
    let (done, is_done) = channel();
    let _ = orders.send(Order::Flush(done));
    is_done.recv_timeout(patience).is_ok()
}

/// The body of the writer. It returns when the session is closed; one that was never saved leaves nothing.
fn keep_writing(slot: Slot, state: &Mutex<State>, orders: &Receiver<Order>) {
    let mut last = None;
    let mut due: Option<Instant> = None;
    loop {
        let order = match due {
            None => orders.recv().map_err(|_| RecvTimeoutError::Disconnected),
            Some(due) => orders.recv_timeout(due.saturating_duration_since(Instant::now())),
        };
        let waiting = match order {
            Ok(Order::Save) => {
                let next = last.map_or_else(Instant::now, |last| last + PERIOD);
                due = due.or(Some(next));
                continue;
            }
            // A flush saves even what has not changed, so that the session left last has the newest file.
            Ok(Order::Flush(waiting)) => Some(waiting),
            Err(RecvTimeoutError::Timeout) => None,
            Ok(Order::End) | Err(RecvTimeoutError::Disconnected) => break,
        };
        let is_saved = save(&slot, state);
        last = Some(Instant::now());
        due = (!is_saved).then(|| Instant::now() + PERIOD);
        if let Some(waiting) = waiting {
            let _ = waiting.send(());
        }
    }
    if locked(state).kept.is_none() {
        slot.remove();
    }
}

/// Saves what was noted last. Returns whether there is nothing left to save.
fn save(slot: &Slot, state: &Mutex<State>) -> bool {
    let noted = {
        let mut state = locked(state);
        state.is_taken = true;
        state.noted.clone()
    };
    let Some(content) = noted else {
        return true;
    };
    let saved = slot.save(&content);
    let mut state = locked(state);
    let trouble = saved.err();
    let trouble = trouble.map(|error| format!("the session cannot be kept: {error}"));
    if trouble.is_none() {
        state.kept = Some(content);
    }
    state.trouble = trouble;
    state.trouble.is_none()
}
