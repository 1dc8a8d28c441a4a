//! Takes over the terminal, draws on it, receives its events, and restores it exactly once, whatever happens.
//!
//! Before it restores the terminal, it runs the hooks of [`at_exit`].
//!
//! Only this module and the recorder use crossterm, for drawing. [`keyboard`] reads the input. Nothing here waits for
//! an answer from the terminal: on a slow line or in a bare pty there may be none.

use crate::lab::storage::at_exit::{self, Release};
use crate::tui::decoder::Typed;
use crate::tui::keyboard::{self, Keyboard};
use crossterm::cursor::{Hide, Show};
use crossterm::event::{DisableBracketedPaste, EnableBracketedPaste};
use crossterm::terminal::{self, Clear, ClearType, EnterAlternateScreen, LeaveAlternateScreen};
use crossterm::{execute, style};
use ratatui::backend::{self, Backend, CrosstermBackend};
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::{Terminal, TerminalOptions, Viewport};
use rustix::process::{Signal, kill_current_process_group};
use signal_hook::consts::{SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP, SIGWINCH, SIGXFSZ};
use signal_hook::flag;
use signal_hook::iterator::Signals;
use std::cell::Cell;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::mem::ManuallyDrop;
use std::os::fd::AsFd;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, Once, OnceLock, PoisonError, TryLockError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// True while this process has taken over the terminal.
static ENTERED: AtomicBool = AtomicBool::new(false);
/// True if the terminal should report the mouse.
static MOUSE: AtomicBool = AtomicBool::new(false);
/// Asks for presses, the wheel, and moves with a button held, with coordinates of any size.
///
/// Moves without a button are not requested: a slow line would carry them for nothing.
const MOUSE_ON: &[u8] = b"\x1b[?1000h\x1b[?1002h\x1b[?1006h";
/// Turns the reports of [`MOUSE_ON`] off, in reverse order.
const MOUSE_OFF: &[u8] = b"\x1b[?1006l\x1b[?1002l\x1b[?1000l";
/// Lock of the thread that writes to the terminal.
static WRITING: Mutex<()> = Mutex::new(());
/// True while a signal is ending the process.
static ENDING: AtomicBool = AtomicBool::new(false);
/// The last of SIGTSTP and SIGCONT that has not been handled: [`NEITHER`], [`SUSPEND`] or [`RESUMED`].
///
/// The signal handlers store it. A SIGCONT directly after a SIGTSTP therefore cancels it, as for a program without
/// handlers.
static LAST_JOB_SIGNAL: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);
const NEITHER: usize = 0;
/// SIGTSTP has asked to suspend the process.
const SUSPEND: usize = 1;
/// The shell has resumed the process.
const RESUMED: usize = 2;
/// True if the size of the screen has changed since the last check.
static RESIZED: AtomicBool = AtomicBool::new(false);

/// Signals that have handlers, until a thread receives them.
static SIGNALS: Mutex<Option<Signals>> = Mutex::new(None);

/// The thread that draws. If it panics, the lab ends.
static DRAWING: OnceLock<ThreadId> = OnceLock::new();
/// Panic messages of other threads. They are printed at the end, because the next frame would overwrite them.
static PANICS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Longest time by which a terminal that accepts no bytes may delay the end of the process.
const TERMINAL_EXIT_LIMIT: Duration = Duration::from_millis(500);
/// Time within which a SIGCONT cancels a request to suspend.
///
/// Once the process has stopped, the shell takes the terminal away from it, and SIGCONT alone does not return it.
const CANCELED_WITHIN: Duration = Duration::from_millis(50);
/// Longest time for the handler of SIGCONT to run after the process is resumed.
const HEARD_WITHIN: Duration = Duration::from_millis(200);
/// Maximum number of events returned at once. A held key on a slow line may send many.
const MOST_EVENTS: usize = 256;

/// Maximum columns and lines that are drawn. A client may report any size, and each cell takes memory. The rest stays
/// empty.
pub const MOST_SCREEN_CELLS: (u16, u16) = (1000, 500);

/// Returns the drawn part of a screen of this `size`.
fn drawn_of(size: Size) -> Rect {
    let (columns, lines) = MOST_SCREEN_CELLS;
    Rect::new(0, 0, size.width.min(columns), size.height.min(lines))
}

/// An event from the terminal or the shell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    Typed(Typed),
    Resized,
    Suspend,
    /// The shell has resumed the program, and the screen may show anything.
    Resumed,
}

/// The terminal, taken over by this program.
pub struct Screen {
    /// Never dropped, because ratatui's drop prints to a stderr that may be closed.
    terminal: ManuallyDrop<Terminal<CrosstermBackend<Counted>>>,
    keyboard: Keyboard,
    /// Bytes of all frames.
    sent: Rc<Cell<usize>>,
}

impl Screen {
    /// Takes over the terminal.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no terminal, or if it cannot be written to. It is then restored.
    pub fn enter() -> io::Result<Self> {
        guard()?;
        // crossterm's own handling of NO_COLOR would also remove the reversed selection; the theme honors NO_COLOR
        // instead.
        style::force_color_output(true);
        let screen = take_over().and_then(|()| {
            let sent = Rc::default();
            let backend = CrosstermBackend::new(Counted {
                writer: BufWriter::with_capacity(1 << 16, stdout()?),
                count: Rc::clone(&sent),
            });
            let viewport = Viewport::Fixed(drawn_of(backend.size()?));
            let terminal = Terminal::with_options(backend, TerminalOptions { viewport })?;
            Ok(Self {
                terminal: ManuallyDrop::new(terminal),
                keyboard: Keyboard::new()?,
                sent,
            })
        });
        screen.inspect_err(|_| give_back())
    }

    /// Draws a frame and sends only the cells that differ from the previous frame. Returns the number of bytes sent.
    pub fn draw(&mut self, picture: impl FnOnce(Rect, &mut Buffer)) -> io::Result<usize> {
        let _lock = lock_screen();
        let before = self.sent.get();
        if self.terminal.get_frame().area() != self.size()? {
            self.forget()?;
        }
        self.terminal
            .draw(|frame| picture(frame.area(), frame.buffer_mut()))?;
        Ok(self.sent.get() - before)
    }

    /// Turns mouse reports on or off. While they are off, the terminal itself handles the mouse.
    pub fn set_mouse(&mut self, listens: bool) -> io::Result<()> {
        if MOUSE.load(Ordering::SeqCst) == listens {
            return Ok(());
        }
        let _lock = lock_screen();
        MOUSE.store(listens, Ordering::SeqCst);
        stdout()?.write_all(if listens { MOUSE_ON } else { MOUSE_OFF })
    }

    /// Asks the terminal for its background color. The answer, if any, arrives as [`Typed::Background`].
    pub fn ask_background(&mut self) -> io::Result<()> {
        let _lock = lock_screen();
        stdout()?.write_all(b"\x1b]11;?\x1b\\")
    }

    /// Returns the drawn part of the screen, cells.
    pub fn size(&self) -> io::Result<Rect> {
        self.terminal.size().map(drawn_of)
    }

    /// Makes the next frame a complete one.
    pub fn forget(&mut self) -> io::Result<()> {
        let size = self.size()?;
        self.terminal
            .backend_mut()
            .clear_region(backend::ClearType::All)?;
        self.terminal.resize(size) // not clear(), which asks for the cursor position
    }

    /// Restores the terminal for the shell until it resumes the program.
    ///
    /// With `whole_job`, a script that runs the program stops with it, like after Ctrl-Z outside raw mode. If the
    /// program has already been resumed, it does not stop. A program that no shell started would never resume: see
    /// [`can_be_resumed`](super::job_control::can_be_resumed).
    pub fn suspend(&mut self, whole_job: bool) -> io::Result<()> {
        let begin = Instant::now();
        at_exit::run_hooks(Release::Suspend);
        while !is_resumed() && begin.elapsed() < CANCELED_WITHIN {
            thread::sleep(Duration::from_millis(1));
        }
        give_back();
        if !is_resumed() {
            if whole_job {
                kill_current_process_group(Signal::TSTP)?; // this process only records another request
            }
            signal_hook::low_level::emulate_default_handler(SIGTSTP)?;
        }
        // If the handler of SIGCONT ran only after this, the terminal would be taken over twice.
        let stopped = Instant::now();
        while LAST_JOB_SIGNAL.swap(NEITHER, Ordering::SeqCst) != RESUMED
            && stopped.elapsed() < HEARD_WITHIN
        {
            thread::sleep(Duration::from_millis(1));
        }
        self.resume()
    }

    pub fn resume(&mut self) -> io::Result<()> {
        take_over()?;
        self.forget()
    }

    /// Waits at most `wait` for the first event, and returns all that have arrived.
    pub fn events(&mut self, wait: Duration) -> io::Result<Vec<Event>> {
        self.keyboard.wait(wait)?;
        listen_without_thread();
        let typed = std::iter::from_fn(|| self.keyboard.take_typed()).take(MOST_EVENTS);
        let is_resized = RESIZED.swap(false, Ordering::Relaxed);
        let of_job = match LAST_JOB_SIGNAL.swap(NEITHER, Ordering::SeqCst) {
            SUSPEND => Some(Event::Suspend),
            RESUMED => Some(Event::Resumed),
            _ => None,
        };
        Ok(typed
            .map(Event::Typed)
            .chain(is_resized.then_some(Event::Resized))
            .chain(of_job)
            .collect())
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        leave();
    }
}

/// A writer that counts its bytes.
struct Counted {
    writer: BufWriter<File>,
    count: Rc<Cell<usize>>,
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.writer.write(bytes)?;
        self.count.set(self.count.get() + written);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for the lock on the terminal.
///
/// Waits for ever if a signal is ending the process, because nothing may be drawn after the terminal is restored.
fn lock_screen() -> MutexGuard<'static, ()> {
    let pen = locked(&WRITING);
    while ENDING.load(Ordering::SeqCst) {
        thread::park();
    }
    pen
}

/// Returns a second handle of standard output, without Rust's lock.
///
/// A frame that hangs in a stopped terminal would hold that lock, and restoring the terminal would hang too.
fn stdout() -> io::Result<File> {
    io::stdout().as_fd().try_clone_to_owned().map(File::from)
}

fn take_over() -> io::Result<()> {
    ENTERED.store(true, Ordering::SeqCst);
    terminal::enable_raw_mode()?;
    // A lab that was killed may have left its picture on the alternate screen.
    execute!(
        stdout()?,
        EnterAlternateScreen,
        Clear(ClearType::All),
        Hide,
        EnableBracketedPaste
    )?;
    if MOUSE.load(Ordering::SeqCst) {
        stdout()?.write_all(MOUSE_ON)
    } else {
        Ok(())
    }
}

/// Releases the terminal, whatever the reason: runs the exit hooks, restores the terminal, and prints the panic
/// messages of other threads.
pub fn leave() {
    at_exit::run_hooks(Release::Exit);
    give_back();
    print_panics();
}

fn print_panics() {
    let panics = std::mem::take(&mut *locked(&PANICS));
    for panic in panics {
        let _ = writeln!(io::stderr(), "gyrolab: in the background, {panic}");
    }
}

/// Returns true if the last job signal was SIGCONT.
fn is_resumed() -> bool {
    LAST_JOB_SIGNAL.load(Ordering::SeqCst) == RESUMED
}

/// Restores the terminal once. Errors are ignored, because there is nowhere left to report them.
fn give_back() {
    if !ENTERED.swap(false, Ordering::SeqCst) {
        return;
    }
    if let Ok(mut stdout) = stdout() {
        if MOUSE.load(Ordering::SeqCst) {
            let _ = stdout.write_all(MOUSE_OFF);
        }
        let _ = execute!(stdout, DisableBracketedPaste, LeaveAlternateScreen, Show);
    }
    let _ = terminal::disable_raw_mode();
}

/// Installs, once per process, the panic hook and the signal handlers that restore the terminal.
fn guard() -> io::Result<()> {
    static GUARD: Once = Once::new();
    let mut result = Ok(());
    let _ = DRAWING.set(thread::current().id()); // keeps the first one
    GUARD.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if DRAWING.get() == Some(&thread::current().id()) {
                leave();
                before(panic);
            } else if ENTERED.load(Ordering::SeqCst) {
                locked(&PANICS).push(panic.to_string());
            } else {
                before(panic);
            }
        }));
        result = install_handlers();
    });
    result
}

fn install_handlers() -> io::Result<()> {
    // Register these before the thread that wakes the loop, so that the loop finds the stored value.
    for (signal, is_last) in [(SIGTSTP, SUSPEND), (SIGCONT, RESUMED)] {
        flag::register_usize(signal, Arc::clone(&LAST_JOB_SIGNAL), is_last)?;
    }
    let handled = [
        SIGHUP, SIGTERM, SIGINT, SIGQUIT, SIGTSTP, SIGCONT, SIGWINCH, SIGXFSZ,
    ];
    *locked(&SIGNALS) = Some(Signals::new(handled)?);
    // If the system provides no thread, the loop handles signals: see listen_without_thread().
    let _ = thread::Builder::new()
        .name("signals".to_owned())
        .spawn(listen);
    Ok(())
}

/// Handles signals on a separate thread. It ends the process without the main loop, which may hang or fail on a
/// terminal that has hung up.
fn listen() {
    let mut signals = locked(&SIGNALS).take();
    for signal in signals.iter_mut().flat_map(Signals::forever) {
        handle(signal);
        keyboard::wake();
    }
}

/// Handles pending signals if no thread runs [`listen`].
fn listen_without_thread() {
    let mut signals = locked(&SIGNALS);
    let pending: Vec<_> = signals.iter_mut().flat_map(Signals::pending).collect();
    drop(signals);
    pending.into_iter().for_each(handle);
}

fn handle(signal: i32) {
    match signal {
        SIGTSTP | SIGCONT => {} // stored in LAST_JOB_SIGNAL; the loop is woken
        SIGWINCH => RESIZED.store(true, Ordering::Relaxed),
        SIGXFSZ => {} // a file exceeds `ulimit -f`: the write fails, as on a full disk
        end => {
            at_exit::run_hooks(Release::Exit);
            ENDING.store(true, Ordering::SeqCst);
            let _lock = try_lock_screen();
            leave_in_time();
            std::process::exit(128 + end);
        }
    }
}

/// Waits until no frame is being drawn. Returns `None` if a frame hangs in a terminal that accepts no bytes.
fn try_lock_screen() -> Option<MutexGuard<'static, ()>> {
    let begin = Instant::now();
    while begin.elapsed() < TERMINAL_EXIT_LIMIT {
        match WRITING.try_lock() {
            Ok(pen) => return Some(pen),
            Err(TryLockError::Poisoned(pen)) => return Some(pen.into_inner()),
            Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(2)),
        }
    }
    None
}

/// Restores the terminal on another thread, and waits at most [`TERMINAL_EXIT_LIMIT`] for it.
fn leave_in_time() {
    let (done, left) = mpsc::channel();
    let spawned = thread::Builder::new().spawn(move || {
        give_back();
        print_panics();
        let _ = done.send(());
    });
    match spawned {
        Ok(_) => drop(left.recv_timeout(TERMINAL_EXIT_LIMIT)),
        Err(_) => {
            give_back();
            print_panics();
        }
    }
}
