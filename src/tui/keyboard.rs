//! The terminal's bytes as they come, and the word that there will be no more.

use super::decoder::{Decoder, Typed};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::{Errno, read};
use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Keys that are decoded before the first of them is handed on: the others stay with the system.
const MOST_AHEAD: usize = 256;
/// Bytes taken at once.
const CHUNK: usize = 4096;

/// The other end of what [`Keyboard::wait`] listens to beside the terminal.
static BELL: OnceLock<UnixStream> = OnceLock::new();

/// Ends the [`wait`](Keyboard::wait) that is under way, or the next one. From any thread.
pub fn wake() {
    if let Some(mut bell) = BELL.get() {
        let _ = bell.write(&[0]); // a full pipe wakes as well
    }
}

/// Stdin, where it is a terminal in raw mode.
#[derive(Debug)]
pub struct Keyboard {
    decoder: Decoder,
    bell: UnixStream,
}

impl Keyboard {
    /// Made once a process: a later one is woken by nobody.
    ///
    /// # Errors
    /// When the system has no pipe left.
    pub fn new() -> io::Result<Self> {
        let (ours, others) = UnixStream::pair()?;
        ours.set_nonblocking(true)?;
        others.set_nonblocking(true)?;
        let _ = BELL.set(others); // the first one stays
        Ok(Self {
            decoder: Decoder::default(),
            bell: ours,
        })
    }

    /// What was typed next, if it has come.
    pub fn take_typed(&mut self) -> Option<Typed> {
        self.decoder.take_typed()
    }

    /// Waits at most `wait` until something was typed, a signal came, or somebody called [`wake`]; takes all that has
    /// come by then, up to a few hundred keys.
    ///
    /// # Errors
    /// [`UnexpectedEof`](io::ErrorKind::UnexpectedEof) when the terminal is gone, with or without a signal that says so.
    pub fn wait(&mut self, wait: Duration) -> io::Result<()> {
        let end = Instant::now() + wait;
        while self.decoder.ready() < MOST_AHEAD {
            let now = Instant::now();
            self.decoder.expire(now);
            let until = match self.decoder.ready() {
                0 => self.decoder.deadline().map_or(end, |due| due.min(end)),
                _ => now,
            };
            let came = self.poll(until.saturating_duration_since(now))?;
            if came.typed {
                self.read()?;
            }
            let has_all = self.decoder.ready() > 0 && !came.typed;
            if has_all || came.woken || Instant::now() >= end {
                break;
            }
        }
        self.decoder.expire(Instant::now());
        Ok(())
    }

    fn poll(&mut self, wait: Duration) -> io::Result<Came> {
        let stdin = io::stdin();
        let mut both = [
            PollFd::new(&stdin, PollFlags::IN),
            PollFd::new(&self.bell, PollFlags::IN),
        ];
        let wait = Timespec {
            tv_sec: i64::try_from(wait.as_secs()).unwrap_or(i64::MAX),
            tv_nsec: wait.subsec_nanos().into(),
        };
        match poll(&mut both, Some(&wait)) {
            Ok(_) => {}
            Err(Errno::INTR) => {
                return Ok(Came {
                    woken: true,
                    ..Came::default()
                });
            }
            Err(error) => return Err(error.into()),
        }
        let [terminal, bell] = both.map(|one| one.revents());
        if !terminal.is_empty() && !terminal.contains(PollFlags::IN) {
            return Err(gone()); // it has hung up, and what was typed before is taken
        }
        let woken = !bell.is_empty();
        if woken {
            while matches!(self.bell.read(&mut [0; 64]), Ok(64)) {}
        }
        Ok(Came {
            typed: !terminal.is_empty(),
            woken,
        })
    }

    /// Takes bytes that are known to be there.
    fn read(&mut self) -> io::Result<()> {
        let mut bytes = [0; CHUNK];
        match read(io::stdin(), &mut bytes) {
            // A terminal in raw mode has an end only where it is gone.
            Ok(0) | Err(Errno::IO) => Err(gone()),
            Ok(length) => {
                self.decoder.feed(&bytes[..length], Instant::now());
                Ok(())
            }
            Err(Errno::INTR | Errno::AGAIN) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }
}

/// What a poll found.
#[derive(Clone, Copy, Debug, Default)]
struct Came {
    typed: bool,
    woken: bool,
}

fn gone() -> io::Error {
    io::Error::new(io::ErrorKind::UnexpectedEof, "it has been closed")
}
