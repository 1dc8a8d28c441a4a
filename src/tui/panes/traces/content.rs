//! The contents of the strips: the curves that every run has, and the measured quantities that are none of these.

use super::Traces;
use super::shared::Shared;
use crate::lab::measured::Shown;
use crate::observe::recording::{Curve, Recording};
use crate::observe::strip::Column;
use crate::text::number::fixed;
use crate::tui::theme::Role;

/// Digits after the point of a value at the cursor.
const DECIMALS: usize = 6;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content {
    /// A curve that every run has.
    Curve(Curve),
    /// The quantity of this index among those that were measured, where it is none of those curves.
    Measured(usize),
}

pub(super) fn of_every_run() -> impl Iterator<Item = Content> + Clone {
    Curve::ALL.into_iter().map(Content::Curve)
}

impl Traces<'_> {
    /// What was measured, the curves that every run has before the others.
    pub(super) fn measured_contents(&self) -> Vec<Content> {
        let Some(beside) = self.measured else {
            return Vec::new();
        };
        let others = 0..beside.quantities().count();
        let is_other = |index: &usize| beside.recorded(*index).is_some();
        let others = others.filter(is_other).map(Content::Measured);
        let curves = of_every_run().filter(|content| self.index(*content).is_some());
        curves.chain(others).collect()
    }

    /// The index of what `content` shows among the measured quantities.
    fn index(&self, content: Content) -> Option<usize> {
        match content {
            Content::Measured(index) => Some(index),
            Content::Curve(curve) => {
                let mut quantities = self.measured?.quantities();
                quantities.position(|quantity| quantity.name == curve.column())
            }
        }
    }

    /// The measured values of what `content` shows; `None` where it was not measured.
    pub(super) fn points(&self, content: Content) -> Option<&[Shown]> {
        let index = self.index(content)?;
        let curves = &self.measured?.compared.curves;
        curves.get(index).map(Vec::as_slice)
    }

    /// Whether a strip of `content` shows what was measured less what the run says.
    pub(super) fn is_residual(&self, content: Content, is_detail: bool) -> bool {
        self.view.residuals && !is_detail && self.index(content).is_some()
    }

    pub(super) fn named(&self, content: Content) -> (String, &'static str) {
        let quantity = match content {
            Content::Curve(curve) => return (curve.name().to_owned(), curve.unit()),
            Content::Measured(index) => self
                .measured
                .and_then(|beside| beside.quantities().nth(index)),
        };
        quantity.map_or((String::new(), ""), |quantity| {
            (quantity.words(), quantity.unit())
        })
    }

    pub(super) fn role(content: Content) -> Role {
        match content {
            Content::Curve(Curve::X) => Role::X,
            Content::Curve(Curve::Y) => Role::Y,
            Content::Curve(Curve::Z) => Role::Z,
            Content::Curve(Curve::Tilt) | Content::Measured(_) => Role::Path,
        }
    }

    /// The recording of the run that has what `content` shows, and which of its curves that is.
    pub(super) fn recorded(&self, content: Content) -> Option<(&Recording, Curve)> {
        match content {
            Content::Curve(curve) => Some((self.run.recording(), curve)),
            Content::Measured(index) => self.measured?.recorded(index),
        }
    }

    /// The same of the run before, where that is shown.
    pub(super) fn recorded_before(&self, content: Content) -> Option<(&Recording, Curve)> {
        let ghost = self.ghost?;
        match content {
            Content::Curve(curve) => Some((&ghost.recording, curve)),
            Content::Measured(index) => self.measured?.recorded_before(index),
        }
    }

    /// The run's curve of `content` in the columns of its strip, up to where the run stands. No line crosses a time of `cuts`.
    pub(super) fn columns_of_run<'s>(
        &'s self,
        content: Content,
        shared: &mut Shared<'s>,
        cuts: &[f64],
    ) -> Vec<Option<Column>> {
        let Some((recording, curve)) = self.recorded(content) else {
            return Vec::new();
        };
        let mut columns = shared.columns(recording, curve, cuts);
        if let Content::Measured(_) = content {
            // What follows the run may have been further than where it stands.
            let now_s = self.run.now().time_s;
            let end = shared.strip.shown(shared.strip.begin_s, now_s).end;
            columns
                .iter_mut()
                .skip(end)
                .for_each(|column| *column = None);
        }
        columns
    }

    /// What `content` has where the run stands.
    pub(super) fn value_now(&self, content: Content) -> f64 {
        match content {
            Content::Curve(curve) => self.run.now().value(curve),
            Content::Measured(_) => self.value_at(content, self.run.now().time_s).unwrap_or(0.0),
        }
    }

    /// What was recorded of `content` at a step at `time_s`.
    fn value_at(&self, content: Content, time_s: f64) -> Option<f64> {
        let (recording, curve) = self.recorded(content)?;
        let block = recording.between(time_s, time_s).last()?;
        (block.moments() == 1).then(|| block.extent(curve).max)
    }

    /// What `content` has at the cursor, with its unit; `None` where there is no cursor, or that is not known.
    pub(super) fn words_at_cursor(&self, content: Content) -> Option<String> {
        let cursor = self.cursor?;
        let value = match content {
            Content::Curve(curve) => curve.at(cursor),
            Content::Measured(_) => self.value_at(content, cursor.time_s)?,
        };
        Some(format!(
            "{} {}",
            fixed(value, DECIMALS),
            self.named(content).1
        ))
    }
}
