//! The real program in a pty and a temporary working directory, and the screen that a terminal would show.

#![allow(dead_code, reason = "no test needs all of it")]

use super::ground::{Args, GYROLAB, Ground, VARIABLES};
use portable_pty::{Child, CommandBuilder, ExitStatus, MasterPty, PtySize, native_pty_system};
use std::io::{Read, Write};
use std::num::NonZero;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(20);
/// Maximum time until the last bytes of an ended program arrive.
const LAST_BYTES: Duration = Duration::from_secs(2);
pub const LEAVES_ALTERNATE_SCREEN: &str = "\u{1b}[?1049l";
pub const SHOWS_CURSOR: &str = "\u{1b}[?25h";
pub const MOUSE_ON: &str = "\u{1b}[?1000h\u{1b}[?1002h\u{1b}[?1006h";
pub const MOUSE_OFF: &str = "\u{1b}[?1006l\u{1b}[?1002l\u{1b}[?1000l";

impl Ground {
    pub fn open(&self, args: impl Args) -> Terminal {
        self.open_with(args, &VARIABLES)
    }

    pub fn open_with(&self, args: impl Args, variables: &[(&str, &str)]) -> Terminal {
        let mut command = CommandBuilder::new(GYROLAB);
        command.args(args.list());
        self.spawn(command, variables)
    }

    /// Opens the program on a terminal that is not its controlling terminal, as after `su -c`. It gets no signal when the
    /// line is lost.
    pub fn open_uncontrolled(&self, args: impl Args) -> Terminal {
        let mut command = CommandBuilder::new(GYROLAB);
        command.args(args.list());
        command.set_controlling_tty(false);
        self.spawn(command, &VARIABLES)
    }

    /// Opens a shell with job control.
    pub fn open_shell(&self) -> Terminal {
        let mut command = CommandBuilder::new("sh");
        command.arg("-i");
        command.env("PS1", "shell> ");
        command.env("ENV", "");
        self.spawn(command, &VARIABLES)
    }

    /// Opens a shell without job control that leads the session and runs the program with `args`, which may continue the script.
    pub fn open_command(&self, args: &str) -> Terminal {
        let mut command = CommandBuilder::new("sh");
        command.args(["-c", &format!("{GYROLAB} {args}")]);
        self.spawn(command, &VARIABLES)
    }

    fn spawn(&self, mut command: CommandBuilder, variables: &[(&str, &str)]) -> Terminal {
        for name in ["LC_ALL", "LC_CTYPE", "NO_COLOR", "COLORFGBG", "COLORTERM"] {
            command.env_remove(name);
        }
        command.env("XDG_STATE_HOME", self.state());
        command.env("XDG_CONFIG_HOME", self.config());
        command.env("HOME", self.path());
        command.cwd(self.path());
        for (name, value) in variables {
            command.env(name, value);
        }
        Terminal::spawn(command, self.clone())
    }
}

/// The bytes that the program has sent, and the resulting screen.
struct Shown {
    bytes: Vec<u8>,
    parser: vt100::Parser,
}

/// The program in its own pty.
pub struct Terminal {
    pub child: Box<dyn Child + Send + Sync>,
    ground: Ground,
    keys: Option<Box<dyn Write + Send>>,
    pty: Option<Box<dyn MasterPty + Send>>,
    shown: Arc<Mutex<Shown>>,
    /// The thread that reads the output of the program. It ends when the last handle of the pty is closed.
    reader: JoinHandle<()>,
    size: (u16, u16),
    /// True if the reader closes the line at the next byte.
    lost: Arc<AtomicBool>,
    /// True if the reader accepts no bytes, like a terminal stopped with Ctrl-S.
    stopped: Arc<AtomicBool>,
}

impl Terminal {
    /// Opens the program in a new working directory.
    pub fn open(args: impl Args) -> Self {
        Ground::new().open(args)
    }

    pub fn open_with(args: impl Args, variables: &[(&str, &str)]) -> Self {
        Ground::new().open_with(args, variables)
    }

    fn spawn(command: CommandBuilder, ground: Ground) -> Self {
        let size = (80, 24);
        let pty = native_pty_system().openpty(pty_size(size)).unwrap();
        let child = pty.slave.spawn_command(command).unwrap();
        let mut output = pty.master.try_clone_reader().unwrap();
        let shown = Arc::new(Mutex::new(Shown {
            bytes: Vec::new(),
            parser: parser(size),
        }));
        let lost = Arc::new(AtomicBool::new(false));
        let stopped = Arc::new(AtomicBool::new(false));
        let (kept, cut, shut) = (shown.clone(), lost.clone(), stopped.clone());
        let reader = thread::spawn(move || {
            let mut buffer = [0; 65536];
            while let Ok(length @ 1..) = output.read(&mut buffer) {
                if let Ok(mut screen) = kept.lock() {
                    screen.bytes.extend_from_slice(&buffer[..length]);
                    screen.parser.process(&buffer[..length]);
                }
                if cut.load(Ordering::Relaxed) {
                    break; // drops the last handle of the pty's master side: the line is lost
                }
                while shut.load(Ordering::Relaxed) {
                    thread::sleep(Duration::from_millis(20));
                }
            }
        });
        let keys = Some(pty.master.take_writer().unwrap());
        Self {
            child,
            ground,
            keys,
            pty: Some(pty.master),
            shown,
            reader,
            size,
            lost,
            stopped,
        }
    }

    /// Returns the program's working directory.
    pub fn ground(&self) -> &Ground {
        &self.ground
    }

    pub fn press(&mut self, keys: &str) {
        let writer = self.keys.as_mut().unwrap();
        writer.write_all(keys.as_bytes()).unwrap();
        writer.flush().unwrap();
    }

    /// Presses `keys` and waits for `words` on the screen.
    #[track_caller]
    pub fn ask(&mut self, keys: &str, words: &str) {
        self.press(keys);
        self.wait_for(words);
    }

    pub fn resize(&mut self, size: (u16, u16)) {
        // The lock is held during the resize: a picture of the new size must not reach a screen of the old size.
        let mut shown = self.shown.lock().unwrap();
        self.size = size;
        self.pty.as_ref().unwrap().resize(pty_size(size)).unwrap();
        let (columns, rows) = cells(size);
        shown.parser.screen_mut().set_size(rows, columns);
    }

    pub fn signal(&self, name: &str) {
        signal(self.child.process_id().unwrap(), name);
    }

    /// Closes the terminal's side of the pty, like a lost line.
    pub fn lose_line(&mut self) {
        self.lost.store(true, Ordering::Relaxed);
        self.keys = None;
        self.pty = None;
    }

    /// Makes the terminal accept no bytes, or accept them again.
    pub fn set_stopped(&self, stopped: bool) {
        self.stopped.store(stopped, Ordering::Relaxed);
    }

    pub fn sent(&self) -> Vec<u8> {
        self.shown.lock().unwrap().bytes.clone()
    }

    pub fn sent_text(&self) -> String {
        String::from_utf8_lossy(&self.sent()).into_owned()
    }

    /// Clears the screen and the stored bytes.
    pub fn clear_output(&self) {
        let mut shown = self.shown.lock().unwrap();
        shown.bytes.clear();
        shown.parser = parser(self.size);
    }

    /// Returns the screen that a terminal would show, as text.
    pub fn screen(&self) -> String {
        self.shown.lock().unwrap().parser.screen().contents()
    }

    /// Returns the words on the screen, separated by single blanks.
    pub fn words(&self) -> String {
        let screen = self.screen();
        screen.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Returns the step in the header.
    pub fn step(&self) -> Option<u64> {
        let screen = self.screen();
        let (_, rest) = screen.lines().next()?.split_once(" step ")?;
        rest.split_whitespace().next()?.parse().ok()
    }

    /// Returns the value of the run in the row `label` (a name and its unit) of the values pane, at the right of the screen.
    pub fn value(&self, label: &str) -> Option<String> {
        let screen = self.screen();
        let heading = screen.lines().find_map(|line| line.split_once("values"));
        let column = heading?.0.chars().count().saturating_sub(1);
        let mut rows = screen.lines().filter_map(|line| {
            let cells: String = line.chars().skip(column).collect();
            let rest = cells.trim_start().strip_prefix(label)?;
            rest.split_whitespace().next().map(str::to_owned)
        });
        rows.next()
    }

    #[track_caller]
    pub fn wait_for(&self, words: &str) {
        self.wait_until(words, |terminal| terminal.words().contains(words));
    }

    #[track_caller]
    pub fn wait_for_step(&self, step: u64) {
        self.wait_until(&format!("step {step}"), |terminal| {
            terminal.step() == Some(step)
        });
    }

    #[track_caller]
    pub fn wait_until(&self, wanted: &str, is_so: impl Fn(&Self) -> bool) {
        let begin = Instant::now();
        while !is_so(self) {
            assert!(
                begin.elapsed() < PATIENCE,
                "no {wanted:?} in\n{}\nin the folder of sessions: {:?}",
                self.screen(),
                self.ground.session_files("")
            );
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits until the program has ended and its output has been read.
    #[track_caller]
    pub fn wait_for_end(&mut self) -> ExitStatus {
        let begin = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                self.drain_output();
                return status;
            }
            assert!(
                begin.elapsed() < PATIENCE,
                "the program does not end:\n{}",
                self.screen()
            );
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits for the last bytes. Gives up if the terminal is stopped, or if a program left by a shell keeps the pty open.
    fn drain_output(&self) {
        let begin = Instant::now();
        while !self.reader.is_finished()
            && !self.stopped.load(Ordering::Relaxed)
            && begin.elapsed() < LAST_BYTES
        {
            thread::sleep(Duration::from_millis(2));
        }
    }

    /// Quits the lab with q, and asserts exit code 0.
    #[track_caller]
    pub fn quit(&mut self) {
        self.press("q");
        assert_eq!(self.wait_for_end().exit_code(), 0);
    }

    /// Ends the class of a teacher's lab while seats are present.
    pub fn end_class(&mut self) {
        self.ask("q", "press q again to end the class");
        self.quit();
    }

    /// Kills the program with SIGKILL.
    pub fn kill(&mut self) {
        self.signal("KILL");
        self.wait_for_end();
    }

    /// Asserts that the program has restored the screen, the cursor and the mouse.
    #[track_caller]
    pub fn assert_terminal_restored(&self) {
        self.wait_until("the cursor", |terminal| {
            let sent = terminal.sent_text();
            let left = sent.rfind(LEAVES_ALTERNATE_SCREEN);
            // An earlier restoration, before the lab took the terminal again, does not count.
            let is_last = left > sent.rfind(MOUSE_ON);
            left.is_some_and(|left| is_last && sent[left..].contains(SHOWS_CURSOR))
        });
        let sent = self.sent_text();
        assert!(
            !sent.contains("\u{1b}[?1003h"),
            "mouse motion is not requested"
        );
        let [on, off] = [MOUSE_ON, MOUSE_OFF].map(|mode| sent.matches(mode).count());
        assert_eq!(on, off, "the mouse is released as often as it was taken");
        assert!(sent.rfind(MOUSE_OFF) >= sent.rfind(MOUSE_ON));
        assert!(sent.rfind(MOUSE_OFF) < sent.rfind(LEAVES_ALTERNATE_SCREEN));
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends the process `id` the signal called `name`.
pub fn signal(id: u32, name: &str) {
    let mut kill = Command::new("kill");
    let sent = kill.args(["-s", name, &id.to_string()]).status().unwrap();
    assert!(sent.success());
}

fn parser(size: (u16, u16)) -> vt100::Parser {
    let (columns, rows) = cells(size);
    vt100::Parser::new(rows, columns, 0)
}

fn cells((columns, rows): (u16, u16)) -> (NonZero<u16>, NonZero<u16>) {
    (NonZero::new(columns).unwrap(), NonZero::new(rows).unwrap())
}

fn pty_size((cols, rows): (u16, u16)) -> PtySize {
    PtySize {
        rows,
        cols,
        pixel_width: 0,
        pixel_height: 0,
    }
}
