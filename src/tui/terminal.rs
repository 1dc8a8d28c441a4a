//! Takes the terminal over, draws on it, receives its events, and gives it back exactly once, whatever happens.
//!
//! Before it gives the terminal back it runs the hooks of [`at_exit`].
//!
//! Only this module and the recorder use crossterm, which draws; [`keyboard`] reads what is typed. Nothing here waits for
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

/// Whether this process has taken the terminal over.
static ENTERED: AtomicBool = AtomicBool::new(false);
/// Whether the mouse is asked for while the terminal is taken over.
static MOUSE: AtomicBool = AtomicBool::new(false);
/// Asks for presses, the wheel and moves with a button held, with numbers of any size; moves without a button, which a slow
/// line would have to carry for nothing, are not asked for.
const MOUSE_ON: &[u8] = b"\x1b[?1000h\x1b[?1002h\x1b[?1006h";
/// The same in the other order, and off.
const MOUSE_OFF: &[u8] = b"\x1b[?1006l\x1b[?1002l\x1b[?1000l";
/// Locked by the thread that writes to the terminal.
static WRITING: Mutex<()> = Mutex::new(());
/// A signal is ending the process.
static ENDING: AtomicBool = AtomicBool::new(false);
/// Which of SIGTSTP and SIGCONT came last and has not been handled: [`NEITHER`], [`SUSPEND`] or [`RESUMED`]. The signal
/// handlers store it, so that a SIGCONT that follows a SIGTSTP at once cancels it, as it does for a program without handlers.
static LAST_JOB_SIGNAL: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);
const NEITHER: usize = 0;
/// SIGTSTP has asked to suspend the process.
const SUSPEND: usize = 1;
/// The shell has resumed the process.
const RESUMED: usize = 2;
/// The size of the screen has changed.
static RESIZED: AtomicBool = AtomicBool::new(false);

/// The signals that the process has handlers for, until a thread takes them.
static SIGNALS: Mutex<Option<Signals>> = Mutex::new(None);

/// The thread that draws: when it panics, the lab ends.
static DRAWING: OnceLock<ThreadId> = OnceLock::new();
/// Panic messages of other threads. They are printed at the end: on the screen the next frame would overwrite them.
static PANICS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// How long a terminal that accepts no bytes may delay the end of the process.
const TERMINAL_EXIT_LIMIT: Duration = Duration::from_millis(500);
/// A SIGCONT that follows the request to suspend so soon cancels it. Once the process has stopped, the shell takes the
/// terminal away from it, and SIGCONT alone does not bring that back.
const CANCELED_WITHIN: Duration = Duration::from_millis(50);
/// How long the handler of SIGCONT may take to run after the process is resumed.
const HEARD_WITHIN: Duration = Duration::from_millis(200);
/// The most events taken at once; a held key on a slow line may send many.
const MOST_EVENTS: usize = 256;

/// The most columns and lines that are drawn on: a client may say any size, and each cell takes memory. The rest stays empty.
pub const MOST_SCREEN_CELLS: (u16, u16) = (1000, 500);

/// The part that is drawn on of a screen of that `size`.
fn drawn_of(size: Size) -> Rect {
    let (columns, lines) = MOST_SCREEN_CELLS;
    Rect::new(0, 0, size.width.min(columns), size.height.min(lines))
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    Typed(Typed),
    Resized,
    Suspend,
    /// The program has been resumed, and the screen may hold anything.
    Resumed,
}

pub struct Screen {
    /// Never dropped, because ratatui's drop prints to a stderr that may be closed.
    terminal: ManuallyDrop<Terminal<CrosstermBackend<Counted>>>,
    keyboard: Keyboard,
    /// The bytes of all frames.
    sent: Rc<Cell<usize>>,
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

    /// Draws a frame; only what differs from the previous one is sent. Returns how many bytes that were.
    pub fn draw(&mut self, picture: impl FnOnce(Rect, &mut Buffer)) -> io::Result<usize> {
        let _pen = pen();
        let before = self.sent.get();
        if self.terminal.get_frame().area() != self.size()? {
            self.forget()?;
        }
        self.terminal
            .draw(|frame| picture(frame.area(), frame.buffer_mut()))?;
        Ok(self.sent.get() - before)
    }

    /// Asks the terminal for the mouse, or leaves the mouse to it.
    pub fn set_mouse(&mut self, listens: bool) -> io::Result<()> {
        if MOUSE.load(Ordering::SeqCst) == listens {
            return Ok(());
        }
        let _pen = pen();
        MOUSE.store(listens, Ordering::SeqCst);
        stdout()?.write_all(if listens { MOUSE_ON } else { MOUSE_OFF })
    }

    /// Asks the terminal for the color of its background. The answer, if any, comes as [`Typed::Background`].
    pub fn ask_background(&mut self) -> io::Result<()> {
        let _pen = pen();
        stdout()?.write_all(b"\x1b]11;?\x1b\\")
    }

    /// The part of the screen that is drawn on, cells.
    pub fn size(&self) -> io::Result<Rect> {
        self.terminal.size().map(drawn_of)
    }

    /// Makes the next frame be sent completely.
    pub fn forget(&mut self) -> io::Result<()> {
        let size = self.size()?;
        self.terminal
            .backend_mut()
            .clear_region(backend::ClearType::All)?;
        self.terminal.resize(size) // not clear(), which asks where the cursor is
    }

    /// Gives the terminal back to the shell until it resumes the program. `whole_job`: a script that runs the program stops
    /// with it, as if Ctrl-Z was typed outside raw mode. If the program has been resumed already, it does not stop. A program
    /// that no shell started would stop for good: see [`can_be_resumed`](super::job_control::can_be_resumed).
    pub fn suspend(&mut self, whole_job: bool) -> io::Result<()> {
        let begin = Instant::now();
        at_exit::run_hooks(Release::Suspend);
        while !is_resumed() && begin.elapsed() < CANCELED_WITHIN {
            thread::sleep(Duration::from_millis(1));
        }
        give_back();
        if !is_resumed() {
            if whole_job {
                kill_current_process_group(Signal::TSTP)?; // for this process it is one more request
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

    /// The events that have arrived; waits for the first at most `wait`.
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

/// Waits for the pen; for ever where a signal is ending the process: nothing may be drawn after the terminal is given back.
fn pen() -> MutexGuard<'static, ()> {
    let pen = locked(&WRITING);
    while ENDING.load(Ordering::SeqCst) {
        thread::park();
    }
    pen
}

/// A second handle of standard output, without Rust's lock: a frame that hangs in a stopped terminal would hold that lock,
/// and giving the terminal back would hang too.
fn stdout() -> io::Result<File> {
    io::stdout().as_fd().try_clone_to_owned().map(File::from)
}

fn take_over() -> io::Result<()> {
    ENTERED.store(true, Ordering::SeqCst);
    terminal::enable_raw_mode()?;
    // A lab that was killed has left its picture on the alternate screen.
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

/// Ends the use of the terminal, whatever the reason: it runs the exit hooks, gives the terminal back, and prints the panic
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

/// Gives the terminal back, once. Errors are ignored, because there is no place left to report them.
/// Whether the last signal about the job was SIGCONT.
fn is_resumed() -> bool {
    LAST_JOB_SIGNAL.load(Ordering::SeqCst) == RESUMED
}

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

/// Installs, once per process, the panic hook and the signal handlers that give the terminal back.
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
    // Before the thread is woken, so that the loop finds what was stored.
    for (signal, is_last) in [(SIGTSTP, SUSPEND), (SIGCONT, RESUMED)] {
        flag::register_usize(signal, Arc::clone(&LAST_JOB_SIGNAL), is_last)?;
    }
    let handled = [
        SIGHUP, SIGTERM, SIGINT, SIGQUIT, SIGTSTP, SIGCONT, SIGWINCH, SIGXFSZ,
    ];
    *locked(&SIGNALS) = Some(Signals::new(handled)?);
    // If the system gives no thread, the loop handles signals: see listen_without_thread().
    let _ = thread::Builder::new()
        .name("signals".to_owned())
        .spawn(listen);
    Ok(())
}

/// Handles signals on a thread of its own. It ends the process without the loop, which may hang or fail on a terminal that
/// has hung up.
fn listen() {
    let mut signals = locked(&SIGNALS).take();
    for signal in signals.iter_mut().flat_map(Signals::forever) {
        handle(signal);
        keyboard::wake();
    }
}

/// Handles pending signals, if there is no thread for [`listen`].
fn listen_without_thread() {
    let mut signals = locked(&SIGNALS);
    let pending: Vec<_> = signals.iter_mut().flat_map(Signals::pending).collect();
    drop(signals);
    pending.into_iter().for_each(handle);
}

fn handle(signal: i32) {
    match signal {
        SIGTSTP | SIGCONT => {} // it is in LAST_JOB_SIGNAL, and the loop is woken
        SIGWINCH => RESIZED.store(true, Ordering::Relaxed),
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

/// Waits until no frame is being drawn; `None` if a frame hangs in a terminal that accepts no bytes.
fn take_pen() -> Option<MutexGuard<'static, ()>> {
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
