//! Sessions on the disk, used by processes that run, quit and are killed.

use crate::support::ground;
use crate::support::words::has;
use gyrolab::lab::storage::at_exit::{self, Release};
use gyrolab::lab::storage::session::{Session, SessionContent, SessionSearch, later, list, resume};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant, SystemTime};
use tempfile::TempDir;

const PATIENCE: Duration = Duration::from_secs(20);
/// Input that makes the child process run the exit hooks, as a signal would.
const END: &str = "end";
/// Environment variable that names the sessions' folder for the child process.
const CHILD: &str = "GYROLAB_TEST_SESSION";

pub(crate) fn content(work: &str, place: &str) -> SessionContent {
    let work = work.to_owned();
    SessionContent {
        work: later(move || work),
        place: place.to_owned(),
    }
}

/// Returns the work and the place as texts.
pub(crate) fn texts(content: &SessionContent) -> (String, String) {
    (content.work.to_string(), content.place.clone())
}

fn pair(work: &str, place: &str) -> (String, String) {
    (work.to_owned(), place.to_owned())
}

/// A sessions' folder in a temporary folder.
pub(crate) fn folder() -> (TempDir, PathBuf) {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("state/gyrolab");
    (outer, folder)
}

fn resume_any(folder: &Path) -> SessionSearch<(String, String)> {
    resume(folder, None, |content| Ok(texts(content))).unwrap()
}

/// Returns the content of the newest unused session, and closes the session.
fn newest_content(folder: &Path) -> Option<(String, String)> {
    let found = resume_any(folder);
    assert!(found.left_alone.is_empty(), "{:?}", found.left_alone);
    found.resumed.map(|(_, what)| what)
}

/// Saves a session and closes it.
fn save_session(folder: &Path, work: &str, place: &str) {
    let session = Session::begin(folder).unwrap();
    session.note(content(work, place));
    closed(session);
}

/// Flushes until saving has been attempted: on a busy machine one flush may time out.
#[track_caller]
fn flush_until_saved(session: &Session) {
    wait_until(|| session.flush());
}

/// Closes the session, and asserts that its content was saved.
#[track_caller]
fn closed(session: Session) {
    let closed = session.close(PATIENCE);
    assert_eq!(closed.trouble, None);
    assert!(closed.kept.is_some());
}

fn names(folder: &Path, end: &str) -> Vec<PathBuf> {
    let mut names = ground::names(folder);
    names.retain(|name| name.ends_with(end));
    names.into_iter().map(|name| folder.join(name)).collect()
}

fn only_file(folder: &Path, end: &str) -> PathBuf {
    let mut names = names(folder, end);
    assert_eq!(names.len(), 1, "{names:?}");
    names.pop().unwrap()
}

/// Returns the path of the session file that ends with `text` (its place, then its work).
fn find_file(folder: &Path, text: &str) -> PathBuf {
    let mut names = names(folder, ".session").into_iter();
    let end = format!("\n{text}");
    names
        .find(|path| fs::read_to_string(path).unwrap().ends_with(&end))
        .unwrap()
}

/// Sets the modification time of `path` to `seconds` ago.
fn backdate(path: &Path, seconds: u64) {
    let file = fs::File::options().append(true).open(path).unwrap();
    let time = SystemTime::now() - Duration::from_secs(seconds);
    file.set_modified(time).unwrap();
}

#[track_caller]
fn wait_until(is_so: impl Fn() -> bool) {
    let begin = Instant::now();
    while !is_so() {
        assert!(begin.elapsed() < PATIENCE, "condition never became true");
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn an_empty_or_missing_folder_has_no_session() {
    let (_outer, folder) = folder();
    assert_eq!(newest_content(&folder), None);
    let session = Session::begin(&folder).unwrap();
    assert_eq!(newest_content(&folder), None);
    drop(session);
    assert_eq!(newest_content(&folder), None);
    // An empty session leaves nothing.
    assert_eq!(names(&folder, ".lock").len(), 0);
}

#[test]
fn the_last_content_is_resumed_and_the_session_continues() {
    let (_outer, folder) = folder();
    let session = Session::begin(&folder).unwrap();
    let text = "the run: ω\nand its journal\n";
    let work = content(text, "").work;
    for step in 0..1000 {
        let (work, place) = (work.clone(), format!("step {step}"));
        session.note(SessionContent { work, place });
    }
    closed(session);
    let (resumed, what) = resume_any(&folder).resumed.unwrap();
    assert_eq!(what, pair(text, "step 999"));
    resumed.note(content("another run", "step 5"));
    flush_until_saved(&resumed);
    resumed.note(content("another run", "step 6"));
    closed(resumed);
    assert_eq!(newest_content(&folder), Some(pair("another run", "step 6")));
    assert_eq!(names(&folder, ".session").len(), 1, "it is one session");
}

#[test]
fn only_the_user_may_read_a_session() {
    let (_outer, folder) = folder();
    let session = Session::begin(&folder).unwrap();
    for place in ["one", "two"] {
        session.note(content("run", place));
        flush_until_saved(&session);
    }
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    assert_eq!(mode(&folder), 0o700);
    for end in [".session", ".lock"] {
        assert_eq!(mode(&only_file(&folder, end)), 0o600, "{end}");
    }
}

#[test]
fn a_session_is_written_without_a_flush() {
    let (_outer, folder) = folder();
    let session = Session::begin(&folder).unwrap();
    for place in ["one", "two"] {
        session.note(content("run", place));
        wait_until(|| {
            let text = names(&folder, ".session").first().map(fs::read_to_string);
            text.is_some_and(|text| text.is_ok_and(|text| text.ends_with(&format!("{place}run"))))
        });
    }
}

#[test]
fn a_flush_writes_at_once() {
    let (_outer, folder) = folder();
    let session = Session::begin(&folder).unwrap();
    for step in 0..50 {
        let place = format!("step {step}.");
        session.note(content("run", &place));
        flush_until_saved(&session);
        let text = fs::read_to_string(only_file(&folder, ".session")).unwrap();
        assert!(text.ends_with(&format!("{place}run")));
    }
}

#[test]
fn the_newest_session_not_in_use_is_resumed() {
    let (_outer, folder) = folder();
    save_session(&folder, "old", "");
    backdate(&only_file(&folder, ".session"), 100);
    let middle = Session::begin(&folder).unwrap();
    middle.note(content("middle", "1"));
    flush_until_saved(&middle);
    backdate(&find_file(&folder, "1middle"), 200);
    save_session(&folder, "new", "");
    assert_eq!(newest_content(&folder).unwrap().0, "new");
    let new = resume_any(&folder).resumed.unwrap();
    assert_eq!(
        newest_content(&folder).unwrap().0,
        "old",
        "two sessions are in use"
    );
    middle.note(content("middle", "2"));
    closed(middle);
    drop(new);
    // The middle session now has the newest place.
    assert_eq!(newest_content(&folder), Some(pair("middle", "2")));
}

#[test]
fn processes_that_resume_at_the_same_time_get_different_sessions() {
    let (_outer, folder) = folder();
    (0..8).for_each(|n| save_session(&folder, &n.to_string(), ""));
    let folder = &folder;
    let found: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..8).map(|_| scope.spawn(|| resume_any(folder))).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    });
    let mut works: Vec<_> = found
        .iter()
        .map(|found| found.resumed.as_ref().unwrap().1.0.clone())
        .collect();
    works.sort_unstable();
    assert_eq!(works, ["0", "1", "2", "3", "4", "5", "6", "7"]);
}

#[test]
fn a_damaged_session_is_reported_and_left_alone() {
    type Damage = fn(&Path);
    let damages: [Damage; 4] = [
        |path| cut(path, 3),
        |path| cut(path, 1000),
        |path| fs::write(path, [0; 100]).unwrap(),
        |path| fs::write(path, [0xff, 0xfe]).unwrap(),
    ];
    for damage in damages {
        let (_outer, folder) = folder();
        save_session(&folder, "the one before", "");
        backdate(&only_file(&folder, ".session"), 100);
        let before = only_file(&folder, ".session");
        save_session(&folder, "the newest", "here");
        let mut names = names(&folder, ".session").into_iter();
        damage(&names.find(|path| *path != before).unwrap());
        let found = resume_any(&folder);
        assert_eq!(found.resumed.unwrap().1.0, "the one before");
        let [alone] = found.left_alone.as_slice() else {
            panic!("{:?}", found.left_alone);
        };
        has(&alone.reason, "cut off");
        assert!(alone.path.exists());
    }
}

/// The file is sparse: it takes no disk space, but reading it whole would take memory.
#[test]
fn an_oversized_session_is_left_alone() {
    let (_outer, folder) = folder();
    save_session(&folder, "the one before", "");
    backdate(&only_file(&folder, ".session"), 100);
    let long = fs::File::create(folder.join("2.session")).unwrap();
    long.set_len(64 << 30).unwrap();
    let found = resume_any(&folder);
    assert_eq!(found.resumed.unwrap().1.0, "the one before");
    has(&found.left_alone[0].reason, "longer than");
    let listed = list(&folder).unwrap();
    assert!(listed.iter().any(|listed| listed.content.is_err()));
}

fn cut(path: &Path, bytes: u64) {
    let file = fs::File::options().write(true).open(path).unwrap();
    let length = file.metadata().unwrap().len();
    file.set_len(length.saturating_sub(bytes)).unwrap();
}

#[test]
fn a_session_with_invalid_content_is_left_alone() {
    let (_outer, folder) = folder();
    save_session(&folder, "good", "");
    backdate(&only_file(&folder, ".session"), 100);
    save_session(&folder, "bad", "");
    let found = resume(&folder, None, |content| match content.work.as_str() {
        "bad" => Err("line 3: no such key".to_owned()),
        work => Ok(work.to_owned()),
    })
    .unwrap();
    assert_eq!(found.resumed.unwrap().1, "good");
    let [alone] = found.left_alone.as_slice() else {
        panic!("{:?}", found.left_alone);
    };
    assert_eq!(alone.reason, "line 3: no such key");
    assert!(fs::read_to_string(&alone.path).unwrap().ends_with("bad"));
}

#[test]
fn the_oldest_sessions_not_in_use_are_deleted() {
    let (_outer, folder) = folder();
    let in_use = Session::begin(&folder).unwrap();
    in_use.note(content("in use", ""));
    flush_until_saved(&in_use);
    backdate(&only_file(&folder, ".session"), 100_000);
    for n in 0..30 {
        save_session(&folder, &n.to_string(), "");
        backdate(&find_file(&folder, &n.to_string()), 1000 - n);
    }
    drop(Session::begin(&folder).unwrap());
    assert_eq!(names(&folder, ".session").len(), 21);
    assert_eq!(names(&folder, ".lock").len(), 21);
    closed(in_use);
    let mut found = Vec::new();
    while let Some(resumed) = resume_any(&folder).resumed {
        found.push(resumed);
    }
    let works: Vec<_> = found.iter().map(|(_, what)| what.0.clone()).collect();
    let mut wanted: Vec<_> = (10..30).rev().map(|n| n.to_string()).collect();
    wanted.insert(0, "in use".to_owned()); // the session that was closed last comes first
    assert_eq!(works, wanted);
}

#[test]
fn an_unusable_folder_is_an_error() {
    let (outer, folder) = folder();
    fs::write(outer.path().join("state"), "a file").unwrap();
    let error = Session::begin(&folder).unwrap_err().to_string();
    assert!(error.contains(folder.to_str().unwrap()), "{error}");
    assert!(resume(&folder, None, |_| Ok(())).is_err());
    fs::remove_file(outer.path().join("state")).unwrap();
    fs::create_dir_all(folder.parent().unwrap()).unwrap();
    fs::write(&folder, "a file").unwrap();
    assert!(Session::begin(&folder).is_err());
    assert!(resume(&folder, None, |_| Ok(())).is_err());
    assert!(Session::begin(Path::new("/proc/gyrolab")).is_err());
}

#[test]
fn saving_is_retried_and_errors_are_reported_until_it_succeeds() {
    let (_outer, folder) = folder();
    let session = Session::begin(&folder).unwrap();
    session.note(content("run", "one"));
    flush_until_saved(&session);
    assert_eq!(session.trouble(), None);
    // A folder in its place cannot be replaced: writing fails, as on a full disk.
    let path = only_file(&folder, ".session");
    let in_the_way = || {
        fs::remove_file(&path).unwrap();
        fs::create_dir(&path).unwrap();
    };
    in_the_way();
    session.note(content("run", "two"));
    flush_until_saved(&session);
    for place in ["three", "four"] {
        assert!(session.trouble().unwrap().contains("cannot be saved"));
        session.note(content("run", place));
        flush_until_saved(&session);
    }
    fs::remove_dir(&path).unwrap();
    wait_until(|| session.trouble().is_none());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 2, "with its lock");
    in_the_way();
    session.note(content("run", "five"));
    flush_until_saved(&session);
    assert!(session.trouble().is_some(), "reported again");
    let closed = session.close(PATIENCE);
    assert!(closed.trouble.is_some());
    assert_eq!(texts(&closed.kept.unwrap()), pair("run", "four"));
}

#[test]
fn a_session_without_content_saves_nothing() {
    let (_outer, folder) = folder();
    let closed = Session::begin(&folder).unwrap().close(PATIENCE);
    assert!(closed.kept.is_none() && closed.trouble.is_none());
}

#[test]
fn sessions_keep_their_short_names() {
    let (_outer, folder) = folder();
    save_session(&folder, "first", "");
    let second = Session::begin(&folder).unwrap();
    second.note(content("second", ""));
    flush_until_saved(&second);
    assert_eq!(second.name(), "2");
    save_session(&folder, "third", "");
    let mut listed = list(&folder).unwrap();
    listed.sort_unstable_by(|a, b| a.name.cmp(&b.name));
    let listed = listed
        .iter()
        .map(|session| (session.name.as_str(), session.is_in_use, session.owner));
    let own = std::process::id();
    let [first, third] = ["1", "3"].map(|name| (name, false, None));
    assert!(listed.eq([first, ("2", true, Some(own)), third]));
    let found = resume(&folder, Some("1"), |content| Ok(texts(content))).unwrap();
    let (session, what) = found.resumed.unwrap();
    assert_eq!((what.0.as_str(), session.name()), ("first", "1"));
    let other = resume(&folder, Some("2"), |_| Ok(())).unwrap();
    assert!(other.resumed.is_none());
    assert_eq!(other.in_use_by, [own]);
    for name in ["4", "", "lock", "../1", "1.session"] {
        assert!(resume(&folder, Some(name), |_| Ok(())).is_err(), "{name}");
    }
}

#[test]
fn a_deleted_folder_is_created_again() {
    let (_outer, folder) = folder();
    let session = Session::begin(&folder).unwrap();
    session.note(content("run", "one"));
    flush_until_saved(&session);
    fs::remove_dir_all(&folder).unwrap();
    session.note(content("run", "two"));
    flush_until_saved(&session);
    closed(session);
    assert_eq!(newest_content(&folder), Some(pair("run", "two")));
}

/// Not a test by itself, but the body of a child process: it keeps a session and notes each line of its input.
#[test]
fn child() {
    let Some(folder) = std::env::var_os(CHILD) else {
        return;
    };
    let found = resume_any(Path::new(&folder));
    let (session, (_, was)) = match found.resumed {
        Some(resumed) => resumed,
        None => (Session::begin(Path::new(&folder)).unwrap(), pair("", "new")),
    };
    println!("\nbegins at {was}");
    for line in std::io::stdin().lines().map(Result::unwrap) {
        if line == END {
            at_exit::run_hooks(Release::Exit);
            std::process::exit(0); // nothing is dropped
        }
        session.note(content("run", &line));
        println!("\nnoted");
    }
}

/// A child process with its own session.
struct OtherProcess {
    child: Child,
    says: BufReader<ChildStdout>,
}

impl OtherProcess {
    fn begin(folder: &Path) -> Self {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "session::child", "--nocapture"])
            .env(CHILD, folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let says = BufReader::new(child.stdout.take().unwrap());
        Self { child, says }
    }

    fn hear(&mut self, begin: &str) -> String {
        let mut lines = self.says.by_ref().lines().map(Result::unwrap);
        lines.find(|line| line.starts_with(begin)).unwrap()
    }

    fn note(&mut self, place: &str) {
        writeln!(self.child.stdin.as_mut().unwrap(), "{place}").unwrap();
        self.hear("noted");
    }

    fn kill(self) {
        drop(self);
    }
}

impl Drop for OtherProcess {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn a_killed_process_loses_at_most_a_second_and_releases_its_session() {
    let (_outer, folder) = folder();
    let mut other = OtherProcess::begin(&folder);
    assert_eq!(other.hear("begins"), "begins at new");
    for n in 0..100 {
        other.note(&n.to_string());
    }
    thread::sleep(Duration::from_secs(1));
    assert_eq!(newest_content(&folder), None, "the session is in use");
    other.kill();
    assert_eq!(newest_content(&folder), Some(pair("run", "99")));
    let mut next = OtherProcess::begin(&folder);
    assert_eq!(next.hear("begins"), "begins at 99");
    let third = OtherProcess::begin(&folder).hear("begins");
    assert_eq!(third, "begins at new", "the session is in use");
    next.kill();
}

#[test]
fn the_exit_hook_saves_the_last_content() {
    let (_outer, folder) = folder();
    let mut other = OtherProcess::begin(&folder);
    (0..1000).for_each(|n| other.note(&n.to_string()));
    writeln!(other.child.stdin.as_mut().unwrap(), "{END}").unwrap();
    assert!(other.child.wait().unwrap().success());
    assert_eq!(newest_content(&folder), Some(pair("run", "999")));
}

#[test]
fn a_process_killed_at_any_time_leaves_a_valid_session() {
    let (_outer, folder) = folder();
    for n in 0..20 {
        let mut other = OtherProcess::begin(&folder);
        other.hear("begins");
        other.note(&n.to_string().repeat(1 << 22)); // takes a while to write
        thread::sleep(Duration::from_millis(n % 10));
        other.kill();
        assert!(resume_any(&folder).left_alone.is_empty());
    }
}

#[test]
fn the_processes_that_use_newer_sessions_are_reported() {
    let (_outer, folder) = folder();
    save_session(&folder, "old", "");
    backdate(&only_file(&folder, ".session"), 100);
    let newer = Session::begin(&folder).unwrap();
    newer.note(content("newer", ""));
    flush_until_saved(&newer);
    let found = resume_any(&folder);
    assert_eq!(found.resumed.unwrap().1.0, "old");
    assert_eq!(found.in_use_by, [std::process::id()]);
    closed(newer);
    assert!(resume_any(&folder).in_use_by.is_empty());
}
