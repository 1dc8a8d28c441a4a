//! `gyrolab cast`: records the lab while it executes a file of commands, in the format of asciinema.
//!
//! The recording has its own clock, which advances by the same amount from picture to picture, independent of the
//! computer's speed. Settings and the environment are ignored, so that a file of commands always gives the same
//! recording.

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
/// Maximum duration of a recording, so that a mistyped number cannot fill the disk.
const LONGEST_RECORDING: Duration = Duration::from_secs(3600);
/// Interval between checks for a finished export. The recording's clock is stopped meanwhile.
const CAST_EXPORT_POLL: Duration = Duration::from_millis(2);

#[derive(Debug, Args)]
#[command(after_help = CAST_HELP)]
pub(super) struct CastArgs {
    /// The file of commands: [[do]] tables, or - for stdin; gyrolab man lists them
    #[arg(value_name = "FILE")]
    pub(super) commands: PathBuf,

    /// Write the recording to this file (asciicast v3, for asciinema 3), or to stdout for -
    #[arg(short, long, value_name = "FILE.cast")]
    pub(super) output: PathBuf,

    /// Columns and rows of the lab
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "100x30", value_parser = size)]
    pub(super) size: (u16, u16),

    /// The recording's title
    #[arg(long, value_name = "TITLE")]
    pub(super) title: Option<String>,

    /// Replace the file if it exists
    #[arg(long)]
    pub(super) force: bool,
}

const CAST_HELP: &str = "\
Time passes only at run, run_until and wait_s. A recording ends with its last command, so end it with wait_s to show \
the last picture for some time. chapter adds a marker. The same commands give the same bytes on every machine.

Play a recording with asciinema play, version 3 or later. Version 2, as in Debian 12, plays only the older formats v1 and \
v2: convert the recording with asciinema convert of version 3.";

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

/// A recording: a line of JSON for the header, and one for each event.
struct Cast {
    recorder: ScreenRecorder,
    text: String,
    now: Duration,
    /// Time of the last event.
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

    /// Advances the time until all commands are executed.
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
                "the recording is longer than an hour, the maximum: shorten its waits, or raise its speed"
            );
            self.now += CAST_FRAME;
            self.advance_lab(lab, interruption);
        }
    }

    /// Lets the lab take all steps up to the current time. Only a signal interrupts it.
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

    /// Records the current picture, and the chapters that begin with it.
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

    /// Adds an event: the time since the previous one, s, its kind and its data.
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
