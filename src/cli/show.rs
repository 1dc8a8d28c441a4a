//! `gyrolab show`: prints the lab's picture as plain text or SVG, at one step or after commands.

use super::args::{MeasuredArgs, SetArgs};
use super::argument_values::{size, steps};
use super::new_lab::{self, DEFAULT};
use super::{print, progress, tell};
use crate::engine::provenance::{self, File, Origin, Payload, SCREEN};
use crate::lab::storage::confined::Confined;
use crate::lab::view::theme::{Background, Marker, Palette, Theme};
use crate::lab::{Lab, command};
use crate::tui::screen;
use crate::tui::svg::svg;
use anyhow::Context;
use clap::Args;
use ratatui::layout::Rect;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Default, Args)]
pub(super) struct ShowArgs {
    /// A scenario, as for gyrolab run [default with --do: method-2]
    #[arg(required_unless_present = "commands")]
    pub(super) scenario: Option<String>,

    #[command(flatten)]
    pub(super) changes: SetArgs,

    /// Show this step instead of the run's end
    #[arg(long, value_name = "STEP", allow_negative_numbers = true, value_parser = steps)]
    pub(super) at: Option<u64>,

    /// Show the result of the commands in this file, or of stdin for -
    ///
    /// The file contains [[do]] tables, which gyrolab man lists. wait_s ends at once, and only step, go_to and
    /// run_until advance the run.
    #[arg(long = "do", value_name = "FILE")]
    pub(super) commands: Option<PathBuf>,

    #[command(flatten)]
    pub(super) beside: MeasuredArgs,

    /// Columns and rows of the picture
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "80x24", value_parser = size)]
    pub(super) size: (u16, u16),

    /// Characters used for dots [default: by locale and terminal]
    #[arg(long, value_enum, value_name = "KIND")]
    pub(super) markers: Option<Marker>,

    /// Print the picture as a color SVG, for example for a slide; the file contains the run, and gyrolab opens it
    #[arg(long)]
    pub(super) svg: bool,

    /// Background that the colors are chosen for [default: dark]
    #[arg(long, value_enum, value_name = "SCREEN", requires = "svg")]
    pub(super) background: Option<Background>,

    /// Write the picture to this file, or to stdout for -
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Replace an existing file
    #[arg(long, requires = "output")]
    pub(super) force: bool,
}

pub(super) fn show(args: &ShowArgs) -> anyhow::Result<ExitCode> {
    print_picture(args, None, None)
}

impl ShowArgs {
    fn picture(&self, lab: &Lab) -> Vec<u8> {
        if !self.svg {
            return screen::text(lab, false, self.size).into_bytes();
        }
        let picture = svg(lab, self.size, self.background.unwrap_or(Background::Dark)).into_bytes();
        let scenario = lab.player().run().scenario();
        let name = self.scenario.as_deref().unwrap_or(DEFAULT);
        let files = vec![File::new(Payload::Run, name, &scenario.to_toml())];
        let origin = Origin::new(&BTreeMap::from([(SCREEN, true)]), files);
        provenance::embed(&picture, &origin).unwrap_or(picture)
    }
}

/// Prints the lab's picture at the end of a run or after commands. Commands cannot leave the folder `confined`. `why`
/// explains why a picture is printed instead of opening the lab.
pub(super) fn print_picture(
    args: &ShowArgs,
    why: Option<&str>,
    confined: Option<Confined>,
) -> anyhow::Result<ExitCode> {
    let name = args.scenario.as_deref().unwrap_or(DEFAULT);
    let theme = Theme {
        palette: if args.svg {
            Palette::TrueColor
        } else {
            Palette::Plain
        },
        background: args.background.unwrap_or(Background::Dark),
    };
    let usual = args.svg.then_some(Marker::Braille); // independent of the terminal
    let mut lab = new_lab::open_lab(name, &args.changes, args.markers.or(usual), theme, false)?;
    screen::fit(&mut lab, Rect::new(0, 0, args.size.0, args.size.1));
    if let Some(folder) = confined {
        lab.files_mut().confine(folder);
    }
    let beside = &args.beside;
    lab.begin_with_measured(beside.measured.as_deref(), &beside.columns.options())?;
    // Missing files cause an error before this message. Commands on stdin may take time.
    why.iter().for_each(tell);
    let commands = args.commands.as_deref().map(command::open).transpose()?;
    let end = match commands {
        Some(_) => 0,
        None => lab.player().run().scenario().steps,
    };
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let ended = lab.begin_at(args.at.unwrap_or(end), interruption.meter());
    let mut done = Ok(());
    if let (Ok(()), Some(commands)) = (&ended, commands) {
        lab.take_commands(commands);
        done = lab.finish_script_while(interruption.meter());
    }
    lab.look_for_advice();
    let picture = args.picture(&lab);
    match output {
        Some(output) => interruption.keep(output, &picture)?,
        None => {
            interruption.may_act_at_once()?;
            print(&String::from_utf8_lossy(&picture))?;
        }
    }
    ended.with_context(|| name.to_owned())?; // the picture is printed even after an error
    done.map_err(anyhow::Error::msg)?;
    Ok(ExitCode::SUCCESS)
}
