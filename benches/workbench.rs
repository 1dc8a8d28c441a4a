//! Cost of the lab, measured with the real program in a pty of 80x24: bytes sent, processor time, memory, and the time to
//! the first frame. `cargo bench --bench workbench` prints the values with their budgets. `-- presets` prints the bytes and
//! the processor share for every preset, and `-- edit` the time that an edit of a long run takes.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Document;
use gyrolab::engine::scenario::presets::PRESETS;
use portable_pty::{Child, CommandBuilder, PtySize, native_pty_system};
use std::io::{Read, Write};
use std::num::NonZero;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

const MEASURED: Duration = Duration::from_secs(8);
/// Duration of the measurement of each preset on each screen.
const MEASURED_OF_PRESET: Duration = Duration::from_secs(5);
/// Clock ticks per second in /proc, the same on every Linux.
const TICKS: f64 = 100.0;

const SMALL: (u16, u16) = (80, 24);
const LARGE: (u16, u16) = (200, 50);

struct Lab {
    child: Box<dyn Child + Send + Sync>,
    keys: Box<dyn Write + Send>,
    output: Arc<Mutex<Vec<u8>>>,
    /// The terminal after the first `shown` bytes.
    terminal: vt100::Parser,
    shown: usize,
    first_frame: Duration,
    _pty: Box<dyn portable_pty::MasterPty + Send>,
    _state: tempfile::TempDir,
}

impl Lab {
    fn open(args: &[&str], (cols, rows): (u16, u16)) -> Self {
        let size = PtySize {
            rows,
            cols,
            pixel_width: 0,
            pixel_height: 0,
        };
        let state = tempfile::tempdir().unwrap(); // leaves the user's sessions alone
        let pty = native_pty_system().openpty(size).unwrap();
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_gyrolab"));
        command.args(args);
        command.env("TERM", "xterm");
        command.env("LANG", "C.UTF-8");
        command.env("XDG_STATE_HOME", state.path());
        let mut reader = pty.master.try_clone_reader().unwrap();
        let keys = pty.master.take_writer().unwrap();
        let begin = Instant::now();
        let child = pty.slave.spawn_command(command).unwrap();
        let output = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&output);
        thread::spawn(move || {
            let mut buffer = [0; 65536];
            while let Ok(length @ 1..) = reader.read(&mut buffer) {
                kept.lock().unwrap().extend_from_slice(&buffer[..length]);
            }
        });
        let mut lab = Self {
            child,
            keys,
            output,
            terminal: {
                let [rows, cols] = [rows, cols].map(|count| NonZero::new(count).unwrap());
                vt100::Parser::new(rows, cols, 0)
            },
            shown: 0,
            first_frame: Duration::ZERO,
            _pty: pty.master,
            _state: state,
        };
        // The first frame is complete when its last line, the footer, has arrived.
        lab.wait_for("quit", 0);
        lab.first_frame = begin.elapsed();
        lab
    }

    fn sent(&self) -> usize {
        self.output.lock().unwrap().len()
    }

    fn wait_for(&self, words: &str, from: usize) {
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_secs(10) {
            if String::from_utf8_lossy(&self.output.lock().unwrap()[from..]).contains(words) {
                return;
            }
            thread::sleep(Duration::from_millis(1));
        }
        panic!("{words:?} never came");
    }

    /// Measures `times` times the time from pressing ? to the help on the screen, and returns the maximum.
    fn slowest_answer(&mut self, times: u32) -> Duration {
        let mut slowest = Duration::ZERO;
        for _ in 0..times {
            thread::sleep(Duration::from_millis(137));
            let (from, begin) = (self.sent(), Instant::now());
            self.press("?");
            self.wait_for("search", from);
            slowest = slowest.max(begin.elapsed());
            self.press("?");
        }
        slowest
    }

    /// Returns the screen that the terminal shows. Only new bytes are parsed, so that polling takes no time from the lab.
    fn picture(&mut self) -> String {
        let output = self.output.lock().unwrap();
        self.terminal.process(&output[self.shown..]);
        self.shown = output.len();
        self.terminal.screen().contents()
    }

    /// Waits until `wanted` returns true for the picture, and returns it.
    fn wait_for_picture(&mut self, wanted: impl Fn(&str) -> bool) -> String {
        let (begin, mut seen) = (Instant::now(), usize::MAX);
        while begin.elapsed() < Duration::from_secs(60) {
            if self.sent() != seen {
                let picture = self.picture();
                if wanted(&picture) {
                    return picture;
                }
                seen = self.shown;
            }
            thread::sleep(Duration::from_millis(1));
        }
        panic!("the picture never came:\n{}", self.picture());
    }

    fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).unwrap();
        self.keys.flush().unwrap();
    }

    fn proc(&self, file: &str) -> String {
        let id = self.child.process_id().unwrap();
        std::fs::read_to_string(format!("/proc/{id}/{file}")).unwrap_or_default()
    }

    /// Returns the processor time so far, s.
    fn processor_s(&self) -> f64 {
        let stat = self.proc("stat");
        let after_name = stat.rsplit(") ").next().unwrap_or_default();
        let fields: Vec<f64> = after_name
            .split(' ')
            .skip(11)
            .take(2)
            .filter_map(|f| f.parse().ok())
            .collect();
        fields.iter().sum::<f64>() / TICKS
    }

    /// Returns the processor time of the thread that steps and draws, ms, with nanosecond resolution.
    fn own_processor_ms(&self) -> f64 {
        let id = self.child.process_id().unwrap();
        let spent = self.proc(&format!("task/{id}/schedstat"));
        let nanoseconds = spent.split(' ').next().and_then(|word| word.parse().ok());
        nanoseconds.map_or(f64::NAN, |number: f64| number / 1e6)
    }

    fn memory_mb(&self) -> f64 {
        let status = self.proc("status");
        let line = status
            .lines()
            .find(|line| line.starts_with("VmHWM"))
            .unwrap_or_default();
        line.split_whitespace()
            .nth(1)
            .and_then(|kb| kb.parse::<f64>().ok())
            .unwrap_or(f64::NAN)
            / 1024.0
    }

    /// Measures the bytes per second and the share of a processor core, %, for the time `length`.
    fn measure(&self, length: Duration) -> (f64, f64) {
        thread::sleep(Duration::from_secs(1));
        let (bytes, processor, begin) = (self.sent(), self.processor_s(), Instant::now());
        thread::sleep(length);
        let seconds = begin.elapsed().as_secs_f64();
        let bytes = (self.sent() - bytes) as f64 / seconds;
        (bytes, (self.processor_s() - processor) / seconds * 100.0)
    }

    fn close(mut self) {
        self.press("q");
        self.child.wait().unwrap();
    }
}

fn main() {
    if std::env::args().any(|arg| arg == "presets") {
        return report_presets();
    }
    if std::env::args().any(|arg| arg == "edit") {
        return report_edit();
    }
    println!(
        "80x24, method-2 with the defaults, {} s each",
        MEASURED.as_secs()
    );
    for (fps, budget) in [("10", "3000"), ("15", "5000")] {
        let mut lab = Lab::open(&["--fps", fps], SMALL);
        let (bytes, core) = lab.measure(MEASURED);
        println!(
            "{fps} frames a second: {bytes:.0} bytes/s (budget {budget}), {core:.1} % of a core (budget 2)"
        );
        println!(
            "  first frame after {:.0} ms (budget 20)",
            lab.first_frame.as_secs_f64() * 1e3
        );
        lab.press(" ");
        let (paused_bytes, paused_core) = lab.measure(MEASURED);
        println!("  paused: {paused_bytes:.0} bytes/s (budget 0), {paused_core:.1} % of a core");
        println!("  memory {:.1} MB (budget 30)", lab.memory_mb());
        lab.close();
    }
    report_edit();
    report(
        "method-2 with the exact motion, 10 frames a second (budget 2 %)",
        &["--fps", "10", "--set", "motion.steps=100000"],
        "t",
        SMALL,
    );
    report(
        "cusps with the exact motion, 10 frames a second (budget 2 %)",
        &["cusps", "--fps", "10", "--set", "motion.steps=1000000"],
        "t",
        SMALL,
    );
    report(
        "cusps with the exact motion at 200x50, 10 frames a second (budget 2 %)",
        &["cusps", "--fps", "10", "--set", "motion.steps=1000000"],
        "t",
        LARGE,
    );
    report(
        "method-2 at top speed",
        &["--set", "motion.steps=1000000000"],
        "99+",
        SMALL,
    );
    report(
        "method-2 at top speed, exact motion",
        &["--set", "motion.steps=1000000000"],
        "99+t",
        SMALL,
    );
    report(
        "a wheel of 100000 points at top speed",
        &[
            "--set",
            "motion.steps=1000000000",
            "--set",
            "body.rim.points=99990",
        ],
        "99+",
        SMALL,
    );
}

/// Prints the time from nudging the initial tilt to the picture of the new run at step 100 000: the median and the maximum
/// of several nudges.
fn report_edit() {
    const STEP: &str = "step 100000 ";
    let args = ["method-2", "--set", "motion.steps=200000"];
    let mut lab = Lab::open(&args, SMALL);
    lab.press(" g100000\r");
    lab.wait_for_picture(|picture| picture.contains(STEP));
    lab.press("e\x1b[B\x1b[B\x1b[B\x1b[B");
    let tilt = |picture: &str| {
        let line = picture.lines().find(|line| line.contains("►tilt"));
        line.and_then(|line| line.split("►tilt").nth(1).map(str::to_owned))
    };
    let mut before = tilt(&lab.wait_for_picture(|picture| tilt(picture).is_some()));
    let (mut times, mut computing) = (Vec::new(), Vec::new());
    for _ in 0..11 {
        thread::sleep(Duration::from_millis(537));
        let (begin, spent) = (Instant::now(), lab.own_processor_ms());
        lab.press("\x1b[C");
        let picture = lab.wait_for_picture(|picture| {
            let new = tilt(picture);
            new.is_some() && new != before && picture.contains(STEP)
        });
        times.push(begin.elapsed().as_secs_f64() * 1e3);
        computing.push(lab.own_processor_ms() - spent);
        before = tilt(&picture);
    }
    times.sort_by(f64::total_cmp);
    computing.sort_by(f64::total_cmp);
    let (middle, steps_ms) = (computing[computing.len() / 2], bare_steps_ms());
    println!(
        "an edit of the start at step 100000: redrawn within {:.0} ms, at most {:.0} ms (budget 50)",
        times[times.len() / 2],
        times[times.len() - 1]
    );
    println!(
        "  {middle:.0} ms of its processor; the steps alone take {steps_ms:.0} ms: {:.1} times that",
        middle / steps_ms
    );
    lab.close();
}

/// Returns the time of 100 000 bare steps of method-2, ms: the minimum of several runs.
fn bare_steps_ms() -> f64 {
    const STEPS: u64 = 100_000;
    let scenario = Arc::new(
        Document::open("method-2")
            .and_then(|document| document.scenario())
            .unwrap(),
    );
    (0..20)
        .map(|_| {
            let mut run = Simulation::new(Arc::clone(&scenario));
            let begin = Instant::now();
            run.step_to(STEPS).unwrap();
            begin.elapsed().as_secs_f64() * 1e3
        })
        .fold(f64::INFINITY, f64::min)
}

/// Prints the cost of every preset at 10 frames per second: alone and with the exact motion, on a small and a large screen,
/// with a full-screen 3-D view, and at top speed.
fn report_presets() {
    println!("bytes/s and % of a core at 10 frames a second (budgets 3000 and 10000, 2 %)");
    for preset in PRESETS {
        print!("{:26}", preset.name);
        for (keys, size) in [("", SMALL), ("t", SMALL), ("d", SMALL), ("99+", SMALL)]
            .into_iter()
            .chain([("", LARGE), ("t", LARGE), ("d", LARGE), ("dt", LARGE)])
        {
            let args = [
                preset.name,
                "--fps",
                "10",
                "--set",
                "motion.steps=1000000000",
            ];
            let mut lab = Lab::open(&args, size);
            lab.press(keys);
            let (bytes, core) = lab.measure(MEASURED_OF_PRESET);
            print!("  {keys:3} {bytes:6.0} {core:4.1}");
            lab.close();
        }
        println!();
    }
}

fn report(what: &str, args: &[&str], keys: &str, size: (u16, u16)) {
    let mut lab = Lab::open(args, size);
    lab.press(keys);
    let (bytes, core) = lab.measure(MEASURED);
    let answer = lab.slowest_answer(20).as_secs_f64() * 1e3;
    let memory = lab.memory_mb();
    println!(
        "{what}: {bytes:.0} bytes/s, {core:.1} % of a core, {memory:.1} MB, keys within {answer:.0} ms (budget 50)"
    );
    lab.close();
}
