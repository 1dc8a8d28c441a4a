//! The options for the rows and columns of a CSV.

use super::argument_values::{one_or_more, time};
use super::refuse;
use crate::engine::export::CsvLayout;
use crate::engine::export::layout::{LAYOUT_KEYS, LayoutFile};
use crate::engine::scenario::kind::ValueKind;
use crate::engine::scenario::schema::SchemaRow;
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use std::num::NonZeroU64;
use toml::{Table, Value};

const ROWS_HEADING: &str = "Rows and columns of the CSV";

/// Rows, columns and number format of a CSV, with one option for each row of [`LAYOUT_KEYS`].
#[derive(Debug)]
pub(super) struct LayoutArgs(LayoutFile);

impl Args for LayoutArgs {
    fn augment_args(command: Command) -> Command {
        command.args(LAYOUT_KEYS.iter().map(layout_option))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for LayoutArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let values = LAYOUT_KEYS
            .iter()
            .filter_map(|row| Some((row.path.to_owned(), given_value(row, matches)?)));
        let file = Table::from_iter(values).try_into::<LayoutFile>();
        file.map(Self)
            .map_err(|error| clap::Error::raw(ErrorKind::ValueValidation, error))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Returns the value of the option for a row of [`LAYOUT_KEYS`] if the command line sets it. A default does not count,
/// because the header of a CSV may have another one.
fn given_value(row: &SchemaRow, matches: &ArgMatches) -> Option<Value> {
    let name = layout_option_name(row);
    if matches.value_source(name) != Some(ValueSource::CommandLine) {
        return None;
    }
    Some(match row.kind {
        ValueKind::Flag => matches.get_flag(name).into(),
        ValueKind::Lines => {
            let columns = matches.get_many::<Value>(name)?;
            Value::Array(columns.cloned().collect())
        }
        _ => matches.get_one::<Value>(name)?.clone(),
    })
}

/// Creates the option for a row of [`LAYOUT_KEYS`]. An option without a default needs an output.
fn layout_option(row: &SchemaRow) -> Arg {
    let name = layout_option_name(row);
    let arg = Arg::new(name).long(name).help(row.about);
    let arg = match row.kind {
        ValueKind::Flag => arg.action(ArgAction::SetTrue),
        ValueKind::Lines => arg
            .value_name("A,B")
            .value_delimiter(',')
            .action(ArgAction::Append)
            .value_parser(|text: &str| Ok::<_, String>(Value::from(text))),
        ValueKind::Whole(..) => arg
            .value_name("N")
            .allow_negative_numbers(true)
            .value_parser(|text: &str| one_or_more(text).map(whole)),
        _ => arg
            .value_name("SECONDS")
            .allow_negative_numbers(true)
            .value_parser(|text: &str| time(text).map(Value::from)),
    };
    match row.default {
        Some(default) => arg.default_value(default.to_string()),
        None => arg.requires("output").help_heading(ROWS_HEADING),
    }
}

fn layout_option_name(row: &SchemaRow) -> &'static str {
    row.path.trim_end_matches("_s")
}

fn whole(number: NonZeroU64) -> Value {
    i64::try_from(number.get()).unwrap_or(i64::MAX).into()
}

impl LayoutArgs {
    /// Combines these options with the layout in the header of a CSV, `of_header`. The options take precedence. Ends
    /// the process with a message, as clap does, if the layout is not valid.
    pub(super) fn layout(&self, of_header: LayoutFile) -> CsvLayout {
        self.0
            .clone()
            .or(of_header)
            .check()
            .unwrap_or_else(|error| {
                let option = error.key.trim_end_matches("_s");
                let message = format!("--{option}: {}", error.rule);
                refuse("run", ErrorKind::ValueValidation, &message)
            })
    }
}
