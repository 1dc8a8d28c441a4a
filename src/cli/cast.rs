//! `gyrolab cast`: a recording of the lab while it carries out a file of commands, in the format of asciinema.
//!
//! The lab's own clock tells the time: it goes on by the same step from picture to picture, however long the computer needs
//! for one. Neither settings nor the environment are read, so that a file of commands has one recording.

use super::args::SetArgs;
use super::argument_values::size;
use super::new_lab::{DEFAULT, open_lab};
use super::progress::{self, Interrupted, Interruption};
use super::tell;
use crate::engine::text::number::counted;
use crate::engine::text::printable::{PrintablePath, printable};
use crate::lab::Lab;
use crate::lab::command;
use crate::lab::view::theme::Marker;
use crate::lab::view::theme::{Background, Palette, Theme};
use crate::tui::screen::ScreenRecorder;
use anyhow::{bail, ensure};
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::process::ExitCode;
use std::thread;
use std::time::Duration;

const CAST_FRAME: Duration = Duration::from_millis(50);
/// The longest recording: a slip in a number must not fill the disk.
const LONGEST_RECORDING: Duration = Duration::from_secs(3600);
/// How often to look whether an export is complete: the recording's clock stands still meanwhile.
const CAST_EXPORT_POLL: Duration = Duration::from_millis(2);

#[derive(Debug, Args)]
#[command(after_help = WHAT_PASSES)]
pub(super) struct CastArgs {
    /// The file of commands: [[do]] tables, or - for stdin; gyrolab man lists them
    #[arg(value_name = "FILE")]
    pub(super) commands: PathBuf,

    /// Write the recording to this file (asciicast v3, for asciinema 3), or to stdout for -
    #[arg(short, long, value_name = "FILE.cast")]
    pub(super) output: PathBuf,

    /// Columns and lines of the lab
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "100x30", value_parser = size)]
    pub(super) size: (u16, u16),

    /// The recording's title
    #[arg(long, value_name = "TITLE")]
    pub(super) title: Option<String>,

    /// Replace the file if it exists
    #[arg(long)]
    pub(super) force: bool,
}

const WHAT_PASSES: &str = "\
Time passes at run, run_until and wait_s; a recording ends with the last command, so that one of wait_s at its end \
shows the last picture for so long. chapter makes a marker. The same commands give the same bytes, on every machine.

asciinema play shows a recording, from asciinema 3 on; version 2, as Debian 12 has it, plays only the older formats v1 and \
v2, of which asciinema convert of version 3 makes one.";

pub(super) fn cast(args: &CastArgs) -> anyhow::Result<ExitCode> {
    let commands = command::open(&args.commands)?;
    let theme = Theme {
        palette: Palette::Xterm256,
        background: Background::Dark,
    };
    let (marker, unchanged) = (Some(Marker::Braille), SetArgs::default());
    let mut lab = open_lab(DEFAULT, &unchanged, marker, theme, false)?;
    let (output, interruption) = progress::open_for(&args.output, args.force)?;
    let mut cast = Cast::begin(args, &mut lab)?;
    lab.take_commands(commands);
    cast.record(&mut lab, &interruption)?;
    let (length, markers) = (cast.now.as_secs_f64(), cast.markers);
    interruption.keep(output, cast.text.as_bytes())?;
    tell(format_args!(
        "gyrolab: {length:.1} s with {} in {}",
        counted(markers, "chapter"),
        PrintablePath(&args.output)
    ));
    Ok(ExitCode::SUCCESS)
}

/// A recording: a line of JSON for its head and one for each event.
struct Cast {
    recorder: ScreenRecorder,
    text: String,
    now: Duration,
    /// The time of the last event.
    written: Duration,
    markers: u64,
}

impl Cast {
    fn begin(args: &CastArgs, lab: &mut Lab) -> anyhow::Result<Self> {
        let (columns, lines) = args.size;
        let mut head = json!({
            "version": 3,
            "term": { "cols": columns, "rows": lines, "type": "xterm-256color" },
        });
        if let Some(title) = &args.title {
            head["title"] = Value::from(printable(title).into_owned());
        }
        Ok(Self {
            recorder: ScreenRecorder::new(lab, args.size)?,
            text: format!("{head}\n"),
            now: Duration::ZERO,
            written: Duration::ZERO,
            markers: 0,
        })
    }

    /// Lets time pass until all commands are carried out.
    fn record(&mut self, lab: &mut Lab, interruption: &Interruption) -> anyhow::Result<()> {
        loop {
            self.look(lab)?;
            if interruption.has_come() {
                bail!(Interrupted);
            }
            if let Some(failure) = lab.script().failure() {
                bail!("{}", printable(failure));
            }
            if lab.script().is_done() {
                self.event("x", "0");
                return Ok(());
            }
            ensure!(
                self.now < LONGEST_RECORDING,
                "the recording is longer than an hour, the most there may be: shorten its waits, or raise its speed"
            );
            self.now += CAST_FRAME;
            self.advance_lab(lab, interruption);
        }
    }

    /// Lets the lab take its steps up to now, as many as there are to take. Only a signal cuts them short.
    fn advance_lab(&self, lab: &mut Lab, interruption: &Interruption) {
        let mut is_first = true;
        lab.advance(&mut || {
            let is_late = !std::mem::take(&mut is_first) && interruption.has_come();
            self.now
                + if is_late {
                    LONGEST_RECORDING
                } else {
                    Duration::ZERO
                }
        });
        while lab.files().is_exporting() && !interruption.has_come() {
            thread::sleep(CAST_EXPORT_POLL);
            lab.advance(&mut || self.now);
        }
    }

    /// Records what there is to see now, and the chapters that begin with it.
    fn look(&mut self, lab: &mut Lab) -> anyhow::Result<()> {
        for title in lab.script_mut().take_chapters() {
            self.markers += 1;
            self.event("m", &title);
        }
        let sent = self.recorder.draw(lab)?;
        if !sent.is_empty() {
            self.event("o", &sent);
        }
        Ok(())
    }

    /// An event is the time since the one before, s, its kind and its data.
    fn event(&mut self, kind: &str, data: &str) {
        let since = (self.now - self.written).as_millis();
        self.written = self.now;
        self.text += &format!(
            "[{}.{:03}, \"{kind}\", {}]\n",
            since / 1000,
            since % 1000,
            Value::from(data)
        );
    }
}
