//! The terminal: taken over, drawn on, listened to, and given back once, whatever happens.
//!
//! Before it is given back, whoever has something to bring home is told ([`at_exit`]).
//!
//! The one room that knows crossterm, which draws; what is typed is read by [`keyboard`]. Nothing here waits for an answer from the terminal: over slow lines, and in
//! bare ptys, there may be none.

use crate::storage::at_exit::{self, Release};
use crate::tui::decoder::Typed;
use crate::tui::keyboard::{self, Keyboard};
use crate::tui::keymap::Key;
use crossterm::cursor::{Hide, Show};
use crossterm::event::{DisableBracketedPaste, EnableBracketedPaste};
use crossterm::terminal::{self, Clear, ClearType, EnterAlternateScreen, LeaveAlternateScreen};
use crossterm::{execute, style};
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use signal_hook::consts::{SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP, SIGWINCH, SIGXFSZ};
use signal_hook::iterator::Signals;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::mem::ManuallyDrop;
use std::os::fd::AsFd;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::sync::{Mutex, MutexGuard, Once, OnceLock, PoisonError, TryLockError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// Whether the terminal is ours at the moment.
static ENTERED: AtomicBool = AtomicBool::new(false);
/// Whoever writes to the terminal holds it.
static PEN: Mutex<()> = Mutex::new(());
/// A signal is ending the process.
static ENDING: AtomicBool = AtomicBool::new(false);
/// Somebody asked from outside to stop until resumed.
static SUSPEND: AtomicBool = AtomicBool::new(false);
/// The screen has another size.
static RESIZED: AtomicBool = AtomicBool::new(false);
/// The shell resumed us.
static RESUMED: AtomicBool = AtomicBool::new(false);

/// The signals that the process has handlers for, until a thread takes them.
static SIGNALS: Mutex<Option<Signals>> = Mutex::new(None);

/// The thread that draws: when it panics, the lab ends.
static DRAWING: OnceLock<ThreadId> = OnceLock::new();
/// What other threads had to say when they panicked, for the end: on the picture it would be gone with the next frame.
static PANICS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// How long a terminal that takes no more bytes may hold up the end.
const PATIENCE: Duration = Duration::from_millis(500);
/// Events taken at once: held keys on a slow line are joined.
const MOST_EVENTS: usize = 256;

/// What comes from the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A key was pressed.
    Key(Key),
    /// A text was pasted.
    Paste(String),
    /// The screen has another size.
    Resized,
    /// The program is to stop until resumed.
    Suspend,
    /// The program has been resumed, and the screen may hold anything.
    Resumed,
}

/// The terminal while it is ours.
pub struct Screen {
    /// Not dropped: ratatui's own farewell prints to a stderr that may be gone.
    terminal: ManuallyDrop<Terminal<CrosstermBackend<BufWriter<File>>>>,
    keyboard: Keyboard,
}

impl Screen {
    /// Takes the terminal over.
    ///
    /// # Errors
    /// When there is none, or it cannot be written to; it is then as it was.
    pub fn enter() -> io::Result<Self> {
        guard()?;
        // crossterm's own reading of NO_COLOR would take the reversed selection away too; the theme honours it.
        style::force_color_output(true);
        let taken = take_over().and_then(|()| {
            let backend = CrosstermBackend::new(BufWriter::with_capacity(1 << 16, stdout()?));
            Ok((Terminal::new(backend)?, Keyboard::new()?))
        });
        match taken {
            Ok((terminal, keyboard)) => Ok(Self {
                terminal: ManuallyDrop::new(terminal),
                keyboard,
            }),
            Err(error) => {
                give_back();
                Err(error)
            }
        }
    }

    /// Draws a frame; only what differs from the one before goes over the line.
    ///
    /// # Errors
    /// When the terminal cannot be written to.
    pub fn draw(&mut self, picture: impl FnOnce(Rect, &mut Buffer)) -> io::Result<()> {
        let _pen = PEN.lock().unwrap_or_else(PoisonError::into_inner);
        while ENDING.load(Ordering::SeqCst) {
            thread::park(); // the process ends by a signal: nothing may follow the farewell
        }
        self.terminal
            .draw(|frame| picture(frame.area(), frame.buffer_mut()))
            .map(|_| ())
    }

    /// The size of the screen, cells.
    ///
    /// # Errors
    /// When the terminal does not tell.
    pub fn size(&self) -> io::Result<Rect> {
        self.terminal
            .size()
            .map(|size| Rect::new(0, 0, size.width, size.height))
    }

    /// Forgets what is on the screen: the next frame is drawn whole.
    ///
    /// # Errors
    /// When the terminal cannot be written to.
    pub fn forget(&mut self) -> io::Result<()> {
        let size = self.size()?;
        self.terminal.resize(size) // not clear(), which asks where the cursor is
    }

    /// Gives the terminal back to the shell until it resumes the program.
    ///
    /// # Errors
    /// When the terminal cannot be taken over again.
    pub fn suspend(&mut self) -> io::Result<()> {
        at_exit::run_hooks(Release::Suspend);
        give_back();
        signal_hook::low_level::emulate_default_handler(SIGTSTP)?;
        RESUMED.store(false, Ordering::Relaxed);
        self.resume()
    }

    /// Takes the terminal over again.
    ///
    /// # Errors
    /// When that fails.
    pub fn resume(&mut self) -> io::Result<()> {
        take_over()?;
        self.forget()
    }

    /// What came from the user; waits for it at most `wait`.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub fn events(&mut self, wait: Duration) -> io::Result<Vec<Event>> {
        self.keyboard.wait(wait)?;
        listen_without_thread();
        let typed = std::iter::from_fn(|| self.keyboard.take_typed()).take(MOST_EVENTS);
        let mut events: Vec<_> = typed
            .map(|typed| match typed {
                Typed::Key(key) => Event::Key(key),
                Typed::Paste(text) => Event::Paste(text),
            })
            .collect();
        let signals = [
            (&RESIZED, Event::Resized),
            (&SUSPEND, Event::Suspend),
            (&RESUMED, Event::Resumed),
        ];
        for (signal, event) in signals {
            if signal.swap(false, Ordering::Relaxed) {
                events.push(event);
            }
        }
        Ok(events)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        leave();
    }
}

/// Stdout by a handle of its own: a frame that hangs in a stopped terminal must not hold a lock that leaving needs.
fn stdout() -> io::Result<File> {
    io::stdout().as_fd().try_clone_to_owned().map(File::from)
}

fn take_over() -> io::Result<()> {
    ENTERED.store(true, Ordering::SeqCst);
    terminal::enable_raw_mode()?;
    // A lab that was killed has left its picture there.
    execute!(
        stdout()?,
        EnterAlternateScreen,
        Clear(ClearType::All),
        Hide,
        EnableBracketedPaste
    )
}

/// The one way out for every end there is: what others have to bring home first, then the terminal, then what
/// could not be said while it was ours.
pub fn leave() {
    at_exit::run_hooks(Release::Exit);
    give_back();
    tell_panics();
}

fn tell_panics() {
    let panics = std::mem::take(&mut *PANICS.lock().unwrap_or_else(PoisonError::into_inner));
    for panic in panics {
        let _ = writeln!(io::stderr(), "gyrolab: in the background, {panic}");
    }
}

/// Gives the terminal back, once. What fails here has nobody left to be told.
fn give_back() {
    if !ENTERED.swap(false, Ordering::SeqCst) {
        return;
    }
    if let Ok(mut stdout) = stdout() {
        let _ = execute!(stdout, DisableBracketedPaste, LeaveAlternateScreen, Show);
    }
    let _ = terminal::disable_raw_mode();
}

/// Leaves on panics and signals too; set up once a process.
fn guard() -> io::Result<()> {
    static GUARD: Once = Once::new();
    let mut result = Ok(());
    let _ = DRAWING.set(thread::current().id()); // the first one stays
    GUARD.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if DRAWING.get() == Some(&thread::current().id()) {
                leave();
                before(panic);
            } else if ENTERED.load(Ordering::SeqCst) {
                let mut panics = PANICS.lock().unwrap_or_else(PoisonError::into_inner);
                panics.push(panic.to_string());
            } else {
                before(panic);
            }
        }));
        let ends = [SIGHUP, SIGTERM, SIGINT, SIGQUIT];
        result = Signals::new(ends.iter().chain(&[SIGTSTP, SIGCONT, SIGWINCH, SIGXFSZ])).map(
            |signals| {
                *SIGNALS.lock().unwrap_or_else(PoisonError::into_inner) = Some(signals);
                // Where there is no thread to be had, the loop looks after them: see listen_without_thread().
                let _ = thread::Builder::new()
                    .name("signals".to_owned())
                    .spawn(listen);
            },
        );
    });
    result
}

/// The end by a signal comes from here, not from the loop: a terminal that has hung up answers the loop with errors
/// or not at all.
fn listen() {
    let mut signals = SIGNALS
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take();
    for signal in signals.iter_mut().flat_map(Signals::forever) {
        heed(signal);
        keyboard::wake();
    }
}

/// Heeds the signals that have come, where [`listen`] could not be given a thread.
fn listen_without_thread() {
    let mut signals = SIGNALS.lock().unwrap_or_else(PoisonError::into_inner);
    let pending: Vec<_> = signals.iter_mut().flat_map(Signals::pending).collect();
    drop(signals);
    pending.into_iter().for_each(heed);
}

fn heed(signal: i32) {
    match signal {
        SIGTSTP => SUSPEND.store(true, Ordering::Relaxed),
        SIGWINCH => RESIZED.store(true, Ordering::Relaxed),
        SIGCONT => RESUMED.store(true, Ordering::Relaxed),
        SIGXFSZ => {} // a file past `ulimit -f`: the write fails then, like one to a full disk
        end => {
            at_exit::run_hooks(Release::Exit);
            ENDING.store(true, Ordering::SeqCst);
            let _pen = take_pen();
            leave_in_time();
            std::process::exit(128 + end);
        }
    }
}

/// Waits until no frame is being drawn; `None` where one hangs in a terminal that takes no more bytes.
fn take_pen() -> Option<MutexGuard<'static, ()>> {
    let begin = Instant::now();
    while begin.elapsed() < PATIENCE {
        match PEN.try_lock() {
            Ok(pen) => return Some(pen),
            Err(TryLockError::Poisoned(pen)) => return Some(pen.into_inner()),
            Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(2)),
        }
    }
    None
}

fn leave_in_time() {
    let (done, left) = mpsc::channel();
    let spawned = thread::Builder::new().spawn(move || {
        give_back();
        tell_panics();
        let _ = done.send(());
    });
    match spawned {
        Ok(_) => drop(left.recv_timeout(PATIENCE)),
        Err(_) => {
            give_back();
            tell_panics();
        }
    }
}
