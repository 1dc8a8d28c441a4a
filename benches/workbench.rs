//! What the lab costs, measured on the program itself in a pty of 80x24: bytes over the line, processor, memory, and
//! how long until there is something to see. `cargo bench --bench workbench` prints the figures beside their budgets.

#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

use portable_pty::{Child, CommandBuilder, PtySize, native_pty_system};
use std::io::{Read, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::thread;
use std::time::{Duration, Instant};

const MEASURED: Duration = Duration::from_secs(10);
/// Clock ticks of /proc a second, the same on every Linux.
const TICKS: f64 = 100.0;

struct Lab {
    child: Box<dyn Child + Send + Sync>,
    keys: Box<dyn Write + Send>,
    bytes: Arc<AtomicU64>,
    first_frame: Duration,
    _pty: Box<dyn portable_pty::MasterPty + Send>,
}

impl Lab {
    fn open(args: &[&str]) -> Self {
        let size = PtySize {
            rows: 24,
            cols: 80,
            pixel_width: 0,
            pixel_height: 0,
        };
        let pty = native_pty_system().openpty(size).unwrap();
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_gyrolab"));
        command.args(args);
        command.env("TERM", "xterm");
        command.env("LANG", "C.UTF-8");
        let mut output = pty.master.try_clone_reader().unwrap();
        let keys = pty.master.take_writer().unwrap();
        let begin = Instant::now();
        let child = pty.slave.spawn_command(command).unwrap();
        let bytes = Arc::new(AtomicU64::new(0));
        let counted = Arc::clone(&bytes);
        let (seen, first) = mpsc::channel();
        thread::spawn(move || {
            let mut text = Vec::new();
            let mut buffer = [0; 65536];
            while let Ok(length @ 1..) = output.read(&mut buffer) {
                counted.fetch_add(length as u64, Ordering::Relaxed);
                // The first frame is there when its last line, the keys, is.
                if text.len() < 65536 {
                    text.extend_from_slice(&buffer[..length]);
                    if String::from_utf8_lossy(&text).contains("quit") {
                        let _ = seen.send(begin.elapsed());
                    }
                }
            }
        });
        let first_frame = first.recv_timeout(Duration::from_secs(10)).unwrap();
        Self {
            child,
            keys,
            bytes,
            first_frame,
            _pty: pty.master,
        }
    }

    fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).unwrap();
        self.keys.flush().unwrap();
    }

    fn proc(&self, file: &str) -> String {
        let id = self.child.process_id().unwrap();
        std::fs::read_to_string(format!("/proc/{id}/{file}")).unwrap_or_default()
    }

    /// Processor time so far, s.
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

    /// Bytes a second, and the share of a processor's core, while `MEASURED` passes.
    fn measure(&self) -> (f64, f64) {
        let (bytes, processor) = (self.bytes.load(Ordering::Relaxed), self.processor_s());
        let begin = Instant::now();
        thread::sleep(MEASURED);
        let seconds = begin.elapsed().as_secs_f64();
        let bytes = (self.bytes.load(Ordering::Relaxed) - bytes) as f64 / seconds;
        (bytes, (self.processor_s() - processor) / seconds * 100.0)
    }

    fn close(mut self) {
        self.press("q");
        self.child.wait().unwrap();
    }
}

fn main() {
    println!(
        "80x24, method-2 with the defaults, {} s each",
        MEASURED.as_secs()
    );
    for (fps, budget) in [("10", "3000"), ("15", "5000")] {
        let mut lab = Lab::open(&["--fps", fps]);
        thread::sleep(Duration::from_secs(1));
        let (bytes, core) = lab.measure();
        println!(
            "{fps} frames a second: {bytes:.0} bytes/s (budget {budget}), {core:.1} % of a core (budget 2)"
        );
        println!(
            "  first frame after {:.0} ms (budget 100)",
            lab.first_frame.as_secs_f64() * 1e3
        );
        lab.press(" ");
        thread::sleep(Duration::from_secs(1));
        let (bytes, core) = lab.measure();
        println!("  paused: {bytes:.0} bytes/s (budget 0), {core:.1} % of a core");
        println!("  memory {:.1} MB (budget 30)", lab.memory_mb());
        lab.close();
    }
    let mut lab = Lab::open(&["cusps"]);
    lab.press("t");
    thread::sleep(Duration::from_secs(1));
    let (bytes, core) = lab.measure();
    println!(
        "cusps with the exact motion: {bytes:.0} bytes/s, {core:.1} % of a core, {:.1} MB",
        lab.memory_mb()
    );
    lab.close();
    let mut lab = Lab::open(&[
        "--set",
        "motion.steps=1000000000",
        "--set",
        "view.speed=1e8",
    ]);
    lab.press("+++++++");
    thread::sleep(Duration::from_secs(1));
    let (bytes, core) = lab.measure();
    println!(
        "top speed: {bytes:.0} bytes/s, {core:.1} % of a core, {:.1} MB",
        lab.memory_mb()
    );
    lab.close();
}
