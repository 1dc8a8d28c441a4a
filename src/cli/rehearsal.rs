//! `gyrolab class --rehearse`: a class with simulated players, for a teacher to practice.

use super::args::ClassArgs;
use super::class::{ensure_terminal, teach};
use super::sessions;
use crate::class::ClassFolder;
use crate::class::rehearsal::Players;
use crate::class::teacher::Rehearsal;
use crate::engine::scenario::presets;
use crate::engine::text::number::counted;
use crate::engine::text::printable::PrintablePath;
use crate::lab::command::Command;
use crate::lab::storage::at_exit::{self, Release};
use crate::lessons::opening;
use anyhow::{Context, ensure};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::thread::sleep;
use std::time::Duration;

/// Opens the teacher's lab with players in the seats, in the given folder or in a temporary one.
pub(super) fn rehearse(args: &ClassArgs, players: u64) -> anyhow::Result<ExitCode> {
    ensure_terminal()?;
    let own = match &args.folder {
        Some(_) => None,
        None => Some(
            tempfile::Builder::new()
                .prefix("gyrolab-rehearsal-")
                .tempdir()?,
        ),
    };
    let dir = match (&args.folder, &own) {
        (Some(dir), _) => {
            std::fs::create_dir_all(dir).with_context(|| sessions::named(dir))?;
            let mut files = dir.read_dir().with_context(|| sessions::named(dir))?;
            ensure!(
                files.next().is_none(),
                "{}: is not empty; name an empty folder for the rehearsal, or omit --folder",
                sessions::named(dir)
            );
            dir.canonicalize()?
        }
        (None, own) => own
            .as_ref()
            .map(|own| own.path().to_owned())
            .unwrap_or_default(),
    };
    let lesson = args.lesson.clone().unwrap_or_default(); // clap ensures that it is given
    let lesson = if opening::is_file_name(&lesson) {
        copy_lesson(Path::new(&lesson), &dir)?
    } else {
        lesson
    };
    let folder = ClassFolder::open(&dir).map_err(anyhow::Error::msg)?;
    folder.make_teacher().map_err(anyhow::Error::msg)?;
    let seats = Players::start(&folder, players).map_err(anyhow::Error::msg)?;
    let removed = own.as_ref().map(|own| own.path().to_owned());
    // A signal ends the process without running destructors.
    let _hook = removed.map(|path| {
        at_exit::hook(move |release| {
            if release == Release::Exit {
                remove(&path);
            }
        })
    });
    let path = PrintablePath(&dir);
    let rehearsal = Rehearsal {
        about: format!(
            "A rehearsal with {}. On another terminal: gyrolab class --board --folder {path}, or --projector.",
            counted(players, "player")
        ),
        at_end: match &own {
            Some(_) => "The rehearsal is over. Its files are deleted.".to_owned(),
            None => format!("The rehearsal is over. Its seats and votes are in {path}"),
        },
    };
    let code = teach(args, &dir, Some(&lesson), Some(rehearsal));
    drop(seats);
    if let Some(own) = own {
        remove(own.path());
    }
    code
}

/// Removes the folder of a rehearsal. Retries, because a lab may still be writing in it.
fn remove(path: &Path) {
    for _ in 0..20 {
        if std::fs::remove_dir_all(path).is_ok() || !path.exists() {
            return;
        }
        sleep(Duration::from_millis(50));
    }
}

/// Copies the lesson `path` into `dir`, with the files next to it that it opens. Returns the path of the copy.
fn copy_lesson(path: &Path, dir: &Path) -> anyhow::Result<String> {
    let lesson = opening::read_file(path)?;
    let from = path.parent().unwrap_or(Path::new(""));
    let name = path.file_name().unwrap_or_default();
    let mut files = vec![PathBuf::from(name)];
    let setups = lesson
        .pages
        .iter()
        .flat_map(|page| page.lab().into_iter().chain(page.task()));
    for placed in setups.flat_map(|setup| &setup.commands) {
        if let Command::Open(opened) = &placed.command
            && let Ok(inside) = Path::new(opened).strip_prefix(from)
            && presets::find(opened).is_none()
        {
            files.push(inside.to_owned());
        }
    }
    for file in files {
        let to = dir.join(&file);
        std::fs::create_dir_all(to.parent().unwrap_or(dir))?;
        std::fs::copy(from.join(&file), &to)
            .with_context(|| PrintablePath(&from.join(&file)).to_string())?;
    }
    Ok(dir.join(name).display().to_string())
}
