//! Commands written as TOML, as the [table](super::COMMANDS) reads them.

use super::{Command, CursorTo, Force, NEXT_TURN, NONE, Place, PushChoice, TURN_BEFORE};
use crate::lab::view::Pane;
use crate::observe::pace::Speed;
use crate::observe::recording::Curve;
use crate::scenario::file::Choice;
use crate::scenario::screen::{ALL_ROWS, AUTO, TRACES};
use toml::{Table, Value};

pub(super) fn written(command: &Command) -> (&'static str, Value) {
    match command {
        Command::Open(name) => ("open", name.clone().into()),
        Command::Set(table) => ("set", table.clone().into()),
        Command::Nudge { key, times } => (
            "nudge",
            map([("key", key.clone().into()), ("times", (*times).into())]),
        ),
        Command::Push(choice) if *choice == PushChoice::default() => ("push", true.into()),
        Command::Push(choice) => ("push", push_written(choice)),
        Command::NextPush(choice) => ("next_push", push_written(choice)),
        Command::Step(steps) => ("step", (*steps).into()),
        Command::GoTo(place) => ("go_to", place_written(*place)),
        Command::RunUntil(condition) => ("run_until", condition.text().into()),
        Command::Run => ("run", true.into()),
        Command::Pause => ("pause", true.into()),
        Command::Wait(seconds) => ("wait_s", (*seconds).into()),
        Command::Undo(times) => ("undo", i64::from(*times).into()),
        Command::Redo(times) => ("redo", i64::from(*times).into()),
        Command::Export {
            path,
            layout,
            to_step,
            force,
        } => {
            let mut table = file_written(path, *to_step, *force);
            table.extend(toml::Table::try_from(layout.file()).unwrap_or_default());
            ("export", short(table))
        }
        Command::Figure {
            path,
            kind,
            exact,
            to_step,
            force,
        } => {
            let mut table = file_written(path, *to_step, *force);
            if kind != TRACES {
                table.insert("kind".to_owned(), kind.as_str().into());
            }
            if *exact {
                table.insert("exact".to_owned(), true.into());
            }
            ("figure", short(table))
        }
        Command::Save {
            path,
            from_here,
            to_step,
            force,
        } => {
            let mut table = file_written(path, *to_step, *force);
            if *from_here {
                table.insert("from_here".to_owned(), true.into());
            }
            ("save", short(table))
        }
        Command::Speed(Speed::Times(speed)) => ("speed", (*speed).into()),
        Command::Speed(Speed::Top) => ("speed", "top".into()),
        Command::Chapter(title) => ("chapter", title.clone().into()),
        Command::LookAt(text) => ("look_at", text.clone().into()),
        Command::Next(text) => ("next", text.clone().into()),
        Command::Bare(bare) => ("bare", (*bare).into()),
        Command::Detail(detail_s) => ("detail_s", (*detail_s).into()),
        Command::DetailOf(curve) => ("detail_of", curve.map_or(AUTO, Curve::name).into()),
        Command::Since(Some(since_s)) => ("since_s", (*since_s).into()),
        Command::Since(None) => ("since_s", NONE.into()),
        Command::Magnify(times) => ("magnify", (*times).into()),
        Command::Cursor(to) => ("cursor", cursor_written(*to)),
        Command::Window(window_s) => ("window_s", (*window_s).into()),
        Command::Exact(shown) => ("exact", (*shown).into()),
        Command::Measured(name) => ("measured", name.as_deref().unwrap_or(NONE).into()),
        Command::Residuals(shown) => ("residuals", (*shown).into()),
        Command::TakeAdvice => ("take_advice", true.into()),
        Command::Pin(pinned) => ("pin", (*pinned).into()),
        Command::Show(panes) => ("show", words(panes.iter().map(|pane| pane.id()))),
        Command::Hide(parts) => ("hide", words(parts.iter().map(|part| part.id()))),
        Command::Fill(pane) => ("fill", pane.map_or("none", Pane::id).into()),
        Command::PointAt(pane) => ("point_at", pane.map_or("none", Pane::id).into()),
        Command::Phase(page) => (
            "phase",
            match page.choice() {
                Choice::Number(number) => large(number),
                Choice::Word(word) => word.into(),
            },
        ),
        Command::SumTo(None) => ("sum_to", ALL_ROWS.into()),
        Command::SumTo(Some(rows)) => ("sum_to", large(*rows as u64)),
        Command::Camera(camera) => (
            "camera",
            map([
                ("yaw_deg", camera.yaw_deg.into()),
                ("pitch_deg", camera.pitch_deg.into()),
            ]),
        ),
        Command::Zoom(zoom) => (
            "zoom",
            map([("above", zoom.above.into()), ("3d", zoom.three_d.into())]),
        ),
    }
}

pub(super) fn map<const N: usize>(entries: [(&str, Value); N]) -> Value {
    let entries = entries
        .into_iter()
        .map(|(name, value)| (name.to_owned(), value));
    Value::Table(entries.collect())
}

fn words(list: impl Iterator<Item = &'static str>) -> Value {
    Value::Array(list.map(Value::from).collect())
}

fn large(number: u64) -> Value {
    Value::Integer(i64::try_from(number).unwrap_or(i64::MAX))
}

fn file_written(path: &str, to_step: Option<u64>, force: bool) -> Table {
    let mut table = Table::from_iter([("path".to_owned(), path.into())]);
    if let Some(step) = to_step {
        table.insert("to_step".to_owned(), large(step));
    }
    if force {
        table.insert("force".to_owned(), true.into());
    }
    table
}

/// The path alone, where the table has no other entry.
fn short(mut table: Table) -> Value {
    match table.len() {
        1 => table.remove("path").unwrap_or(Value::Table(table)),
        _ => Value::Table(table),
    }
}

fn push_written(choice: &PushChoice) -> Value {
    let mut table = Table::new();
    let mut insert = |name: &str, value: Option<Value>| {
        if let Some(value) = value {
            table.insert(name.to_owned(), value);
        }
    };
    insert("point", choice.point.clone().map(Value::from));
    insert(
        "force_N",
        choice.force_N.map(|force| match force {
            Force::Size(size) => size.into(),
            Force::Vector(vector) => vector.to_vec().into(),
        }),
    );
    insert("toward", choice.toward.map(|toward| toward.shown().into()));
    insert("for_s", choice.for_s.map(Value::from));
    Value::Table(table)
}

fn cursor_written(to: CursorTo) -> Value {
    match to {
        CursorTo::Place(place) => place_written(place),
        CursorTo::NextTurn => NEXT_TURN.into(),
        CursorTo::TurnBefore => TURN_BEFORE.into(),
        CursorTo::Nowhere => NONE.into(),
    }
}

fn place_written(place: Place) -> Value {
    match place {
        Place::Step(step) => large(step),
        Place::Time(time_s) => format!("{time_s} s").into(),
        Place::Start => "start".into(),
        Place::End => "end".into(),
    }
}
