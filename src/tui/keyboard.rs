//! Reads the terminal's bytes as they arrive, and reports when the terminal is closed.

use super::decoder::{Decoder, Typed};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::{Errno, read};
use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Maximum number of keys decoded ahead. Further bytes stay in the system's buffer.
const MOST_AHEAD: usize = 256;
const CHUNK: usize = 4096;

/// Socket that wakes [`Keyboard::wait`] when a byte is written to it.
static WAKE_SOCKET: OnceLock<UnixStream> = OnceLock::new();

/// Ends the [`wait`](Keyboard::wait) in progress, or the next one. Any thread may call it.
pub fn wake() {
    if let Some(mut bell) = WAKE_SOCKET.get() {
        let _ = bell.write(&[0]); // a full pipe wakes as well
    }
}

/// Standard input of a terminal in raw mode.
#[derive(Debug)]
pub struct Keyboard {
    decoder: Decoder,
    bell: UnixStream,
}

impl Keyboard {
    /// Creates the keyboard. Call it once per process: [`wake`] wakes only the first keyboard.
    pub fn new() -> io::Result<Self> {
        let (ours, others) = UnixStream::pair()?;
        ours.set_nonblocking(true)?;
        others.set_nonblocking(true)?;
        let _ = WAKE_SOCKET.set(others); // keeps the first one
        Ok(Self {
            decoder: Decoder::default(),
            bell: ours,
        })
    }

    pub fn take_typed(&mut self) -> Option<Typed> {
        self.decoder.take_typed()
    }

    /// Waits until something is typed, a signal arrives or [`wake`] is called, but at most `wait`.
    ///
    /// Then reads everything that has arrived, up to a few hundred keys.
    ///
    /// # Errors
    ///
    /// Returns [`UnexpectedEof`](io::ErrorKind::UnexpectedEof) if the terminal is closed, with or without a signal.
    pub fn wait(&mut self, wait: Duration) -> io::Result<()> {
        let end = Instant::now() + wait;
        while self.decoder.ready() < MOST_AHEAD {
            let now = Instant::now();
            self.decoder.expire(now);
            let until = match self.decoder.ready() {
                0 => self.decoder.deadline().map_or(end, |due| due.min(end)),
                _ => now,
            };
            let (typed, woken) = self.poll(until.saturating_duration_since(now))?;
            if typed {
                self.read()?;
            }
            let has_all = self.decoder.ready() > 0 && !typed;
            if has_all || woken || Instant::now() >= end {
                break;
            }
        }
        self.decoder.expire(Instant::now());
        Ok(())
    }

    /// Waits at most `wait`.
    ///
    /// The first result is true if there is input, the second if a signal or [`wake`] ended the wait.
    fn poll(&mut self, wait: Duration) -> io::Result<(bool, bool)> {
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
            Err(Errno::INTR) => return Ok((false, true)),
            Err(error) => return Err(error.into()),
        }
        let [terminal, bell] = both.map(|one| one.revents());
        if !terminal.is_empty() && !terminal.contains(PollFlags::IN) {
            return Err(closed_error()); // hung up, and all earlier input has been read
        }
        let woken = !bell.is_empty();
        if woken {
            while matches!(self.bell.read(&mut [0; 64]), Ok(64)) {}
        }
        Ok((!terminal.is_empty(), woken))
    }

    /// Reads bytes after a poll has reported some.
    fn read(&mut self) -> io::Result<()> {
        let mut bytes = [0; CHUNK];
        match read(io::stdin(), &mut bytes) {
            // A terminal in raw mode reports the end of input only when it is closed.
            Ok(0) | Err(Errno::IO) => Err(closed_error()),
            Ok(length) => {
                self.decoder.feed(&bytes[..length], Instant::now());
                Ok(())
            }
            Err(Errno::INTR | Errno::AGAIN) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }
}

fn closed_error() -> io::Error {
    io::Error::new(io::ErrorKind::UnexpectedEof, "it has been closed")
}
