//! `gyrolab class` and `gyrolab --seat`: a class in a folder.

use super::args::{ClassArgs, DisplayArgs, WorkbenchArgs};
use super::lesson::admit;
use super::new_lab::{DEFAULT, of_workbench};
use super::workbench::{furnish, open_at};
use super::{answers, print, rehearsal, sessions, settings, tell, warn};
use crate::class::folder::{ClassFolder, ClassState};
use crate::class::projector::Projector;
use crate::class::student::Student;
use crate::class::teacher::{Rehearsal, Teacher};
use crate::class::votes::{self, SeatStatus, seat_statuses};
use crate::class::{Seat, board, login, table};
use crate::engine::text::printable::{PrintablePath, printable};
use crate::lab::storage::confined::{Confined, MOST_OF_SEAT};
use crate::lab::storage::session;
use crate::lessons::clock::unix_s;
use crate::lessons::{Lessons, opening};
use crate::tui;
use anyhow::{Context, bail, ensure};
use chrono::Local;
use rustix::process::{Pid, Resource, Signal};
use std::fs::{File, TryLockError};
use std::io::{self, BufRead, IsTerminal, Read, Write};
use std::path::Path;
use std::process::ExitCode;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Width of a printed board, in columns.
const BOARD_WIDTH: usize = 80;
/// Maximum length of a line typed for a seat, bytes.
const LONGEST_SEAT_LINE: u64 = 200;
/// Delay after a wrong word.
const WRONG_WORD_DELAY: Duration = Duration::from_secs(1);

pub(super) fn class(args: &ClassArgs) -> anyhow::Result<ExitCode> {
    if let Some(players) = args.rehearse {
        return rehearsal::rehearse(args, players);
    }
    // clap ensures that a folder is given.
    let dir = args.folder.as_deref().unwrap_or(Path::new("."));
    let at = || ClassFolder::at(dir).map_err(anyhow::Error::msg);
    if args.votes {
        return print_csv(&at()?, votes::csv);
    }
    if args.table {
        return print_csv(&at()?, table::csv);
    }
    if args.board {
        return show_board(&at()?);
    }
    if let (true, Some(output)) = (args.answers, &args.output) {
        return answers::write_all(&at()?, output, args.force, args.look);
    }
    if args.projector {
        return project(at()?, args.look);
    }
    if args.new {
        start_new_group(dir)?;
    }
    match &args.lesson {
        None if args.new => Ok(ExitCode::SUCCESS),
        lesson => teach(args, dir, lesson.as_deref(), None),
    }
}

pub(super) fn ensure_terminal() -> anyhow::Result<()> {
    ensure!(
        io::stdin().is_terminal() && io::stdout().is_terminal(),
        "a class needs a terminal for the teacher's lab; --board, --votes, --table and --answers do not"
    );
    Ok(())
}

/// Locks the teacher's folder, which only one lab may have open. The lock lasts as long as the returned file is open.
fn lock_class(folder: &ClassFolder) -> anyhow::Result<File> {
    folder.make_teacher().map_err(anyhow::Error::msg)?;
    let turn = File::open(folder.teacher())?;
    ensure!(
        !matches!(turn.try_lock(), Err(TryLockError::WouldBlock)),
        "a class is running in {}: show its board with gyrolab class --board --folder DIR",
        PrintablePath(&folder.root)
    );
    Ok(turn)
}

/// Archives the seats and votes in `dir`, so that a new group starts without any.
fn start_new_group(dir: &Path) -> anyhow::Result<()> {
    let folder = ClassFolder::open(dir).map_err(anyhow::Error::msg)?;
    let _turn = lock_class(&folder)?;
    let name = Local::now().format("%Y-%m-%d_%H-%M-%S").to_string();
    match folder.keep_as_earlier(&name).map_err(anyhow::Error::msg)? {
        None => tell(format_args!(
            "gyrolab: there is no earlier group in {} to archive",
            PrintablePath(dir)
        )),
        Some(group) => tell(format_args!(
            "gyrolab: the previous group is archived in {group}\n\
             gyrolab: to see its votes, run gyrolab class --votes --folder {group}",
            group = PrintablePath(&group)
        )),
    }
    Ok(())
}

/// Returns an error if the class, whose state was `before`, already has votes in the lesson `name`. After a crash,
/// starting it again would return everyone to page 1.
fn refuse_restart(folder: &ClassFolder, before: &ClassState, name: &str) -> anyhow::Result<()> {
    let seats = seat_statuses(folder).map_err(anyhow::Error::msg)?;
    let has_voted = |seat: &SeatStatus| {
        let place = seat.lessons.get(name);
        place.is_some_and(|place| !place.predictions.is_empty())
    };
    ensure!(
        before.lesson != name || before.page < 2 || !seats.iter().any(has_voted),
        "{}: the class has reached page {}: --resume without the lesson continues there, --new starts another group",
        printable(folder.short(name)),
        before.page
    );
    Ok(())
}

/// Opens the teacher's lab of the class in `dir`, or of a rehearsal.
pub(super) fn teach(
    args: &ClassArgs,
    dir: &Path,
    lesson: Option<&str>,
    rehearsal: Option<Rehearsal>,
) -> anyhow::Result<ExitCode> {
    ensure_terminal()?;
    let folder = ClassFolder::open(dir).map_err(anyhow::Error::msg)?;
    let _turn = lock_class(&folder)?; // held until the lab is closed
    let confined = Confined::enter(dir)
        .with_context(|| sessions::named(dir))?
        .keeping_in(folder.teacher());
    let sessions = session::list(&folder.teacher())?;
    let before = match folder.state() {
        Err(reason) if args.resume => bail!(reason),
        state => state.ok().flatten().unwrap_or_default(),
    };
    let (name, page) = match lesson {
        Some(name) => (opening::full_name(name), 1),
        None if before.lesson.is_empty() => {
            bail!("no class has begun here: start one with gyrolab class LESSON --folder DIR")
        }
        None => (before.lesson.clone(), before.page.max(1)),
    };
    if lesson.is_some() && rehearsal.is_none() {
        refuse_restart(&folder, &before, &name)?;
    }
    admit(&name, &confined).context("the lesson of a class must be in its folder")?;
    let opened = opening::open(&name)?;
    let workbench = WorkbenchArgs {
        paused: true,
        look: args.look,
        resume: (args.resume && !sessions.is_empty()).then(String::new),
        ..WorkbenchArgs::default()
    };
    let page = Some((&opened, page.min(opened.pages.len())));
    let teacher = Teacher::new(folder, before);
    let teacher = match rehearsal {
        Some(rehearsal) => teacher.rehearsing(rehearsal),
        None => teacher,
    };
    open_at(
        &workbench,
        DEFAULT,
        Some(confined),
        page,
        Some(Box::new(teacher)),
    )
}

/// Shows the class in `folder` on a projector.
fn project(folder: ClassFolder, look: DisplayArgs) -> anyhow::Result<ExitCode> {
    ensure!(
        io::stdin().is_terminal() && io::stdout().is_terminal(),
        "--projector needs a terminal"
    );
    let args = WorkbenchArgs {
        paused: true,
        look,
        ..WorkbenchArgs::default()
    };
    let settings_in = sessions::folder_of(None);
    let chosen = settings::read(settings_in.as_deref().ok(), false);
    let args = chosen.complete(&args);
    let mut lab = of_workbench(&args, DEFAULT)?;
    furnish(&mut lab, &args, None)?;
    let mut projector = Projector::new(folder);
    tui::projector::run(&mut lab, &mut Lessons::default(), &mut projector)
        .context("the terminal cannot be used")?;
    Ok(ExitCode::SUCCESS)
}

/// Prints the CSV that `csv` makes of the seats in `folder`.
fn print_csv(
    folder: &ClassFolder,
    csv: fn(&ClassFolder, &[SeatStatus]) -> Result<String, csv::Error>,
) -> anyhow::Result<ExitCode> {
    let seats = seat_statuses(folder).map_err(anyhow::Error::msg)?;
    print(&csv(folder, &seats)?)?;
    Ok(unread(&seats))
}

/// Prints the files of `seats` that cannot be read. Returns the exit code.
pub(super) fn unread(seats: &[SeatStatus]) -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for trouble in seats.iter().filter_map(|seat| seat.trouble.as_ref()) {
        warn(format_args!("gyrolab: {}", printable(trouble)));
        code = ExitCode::FAILURE;
    }
    code
}

fn show_board(folder: &ClassFolder) -> anyhow::Result<ExitCode> {
    if io::stdin().is_terminal() && io::stdout().is_terminal() {
        tui::board::run(|width| board::lines(folder, width))
            .context("the terminal cannot be used")?;
        return Ok(ExitCode::SUCCESS);
    }
    print(&(board::lines(folder, BOARD_WIDTH).join("\n") + "\n"))?;
    Ok(unread(&seat_statuses(folder).map_err(anyhow::Error::msg)?))
}

/// Asks for a seat in the class in `dir`, and opens its lab.
pub(super) fn seat(args: &WorkbenchArgs, dir: &Path) -> anyhow::Result<ExitCode> {
    // sshd sets this variable if the student's ssh command names a command.
    if let Ok(command) = std::env::var("SSH_ORIGINAL_COMMAND") {
        let folder = ClassFolder::open(dir).map_err(anyhow::Error::msg)?;
        return answers::fetch(&folder, &command, args.look);
    }
    ensure!(
        io::stdin().is_terminal() && io::stdout().is_terminal(),
        "--seat needs a terminal: it asks for a name"
    );
    // Only the teacher can read the seat's files, and no file may exceed the limit for a seat.
    rustix::process::umask(rustix::fs::Mode::from_raw_mode(0o027));
    let mut limit = rustix::process::getrlimit(Resource::Fsize);
    let now = limit.current.unwrap_or(MOST_OF_SEAT);
    limit.current = Some(now.min(MOST_OF_SEAT));
    rustix::process::setrlimit(Resource::Fsize, limit)?;
    let folder = ClassFolder::open(dir).map_err(anyhow::Error::msg)?;
    let Some(seat) = ask_for_seat(&folder)? else {
        return Ok(ExitCode::SUCCESS);
    };
    let lock_token = seat.hold().map_err(anyhow::Error::msg)?;
    let confined = Confined::enter(&seat.folder)?.as_seat_of(&folder.root);
    let sessions = confined.sessions().map_err(anyhow::Error::msg)?;
    take_over(&sessions);
    // A file that this version cannot read is not changed.
    let record = seat
        .record()
        .map_err(anyhow::Error::msg)
        .with_context(|| format!("the file of the seat {}", seat.word))?;
    let has_session = session::list(&sessions).is_ok_and(|sessions| !sessions.is_empty());
    let args = WorkbenchArgs {
        resume: has_session.then(String::new),
        paused: true, // the class's run or its waiting page replaces this run
        ..args.clone()
    };
    let student = Box::new(Student::new(folder, seat, lock_token, record));
    open_at(&args, DEFAULT, Some(confined), None, Some(student))
}

/// Asks for a name or the word of a seat until one is accepted. Returns `None` at the end of the input.
fn ask_for_seat(folder: &ClassFolder) -> anyhow::Result<Option<Seat>> {
    loop {
        let mut stdout = io::stdout();
        write!(stdout, "{}", login::ASKS)?;
        stdout.flush()?;
        let Some(line) = line()? else {
            writeln!(stdout)?;
            return Ok(None);
        };
        match login::claim(folder, &line, unix_s()) {
            Ok((seat, false)) => return Ok(Some(seat)),
            Ok((seat, true)) => {
                let word = &seat.word;
                writeln!(
                    stdout,
                    "Your seat is {word}: type this word to return.\nPress Enter to continue."
                )?;
                return Ok(self::line()?.map(|_| seat));
            }
            Err(reason) => {
                sleep(WRONG_WORD_DELAY);
                writeln!(stdout, "{reason}")?;
            }
        }
    }
}

/// Reads a typed line, shortened if it is too long. Returns `None` at the end of the input.
fn line() -> io::Result<Option<String>> {
    let mut stdin = io::stdin().lock();
    let mut bytes = Vec::new();
    if (&mut stdin)
        .take(LONGEST_SEAT_LINE)
        .read_until(b'\n', &mut bytes)?
        == 0
    {
        return Ok(None);
    }
    if bytes.len() as u64 == LONGEST_SEAT_LINE {
        stdin.skip_until(b'\n')?;
    }
    Ok(Some(String::from_utf8_lossy(&bytes).into_owned()))
}

/// Waits until no other lab uses a session in the folder `sessions`. A lab that does not end is killed: its connection
/// may be dead, so that its output blocks.
fn take_over(sessions: &Path) {
    let holder = || {
        let sessions = session::list(sessions).unwrap_or_default();
        let held = sessions.into_iter().find(|session| session.is_in_use)?;
        Pid::from_raw(i32::try_from(held.owner?).ok()?)
    };
    for signal in [None, Some(Signal::TERM), Some(Signal::KILL)] {
        if let (Some(signal), Some(process)) = (signal, holder()) {
            let _ = rustix::process::kill_process(process, signal); // it may have ended already
        }
        let begin = Instant::now();
        while holder().is_some() && begin.elapsed() < Duration::from_secs(2) {
            sleep(Duration::from_millis(50));
        }
    }
}
