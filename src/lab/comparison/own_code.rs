//! Measured data that are rows of the user's own program of the report's scheme. The verdict of `gyrolab verify
//! --against` about the present run is computed in the background.

use crate::engine::data::quantity::TIME_COLUMN;
use crate::engine::data::{self, ColumnOptions, MeasuredData};
use crate::engine::scenario::csv::Renaming;
use crate::engine::scenario::{Problems, Scenario};
use crate::engine::text::printable::printable_lines;
use crate::lab::playback::background::BackgroundJob;
use crate::studies::own_code::{self, SlipTrial, Verdict, rows};
use crate::studies::verify::Unverified;
use std::path::Path;
use std::sync::Arc;

type VerdictResult = Result<Verdict, String>;

/// The rows of a program, and the verdict about them.
pub struct OwnCode {
    text: Arc<str>,
    map: Arc<[Renaming]>,
    /// The run with which the rows are compared, and the computation of the verdict.
    judged: Option<(Arc<Scenario>, BackgroundJob<VerdictResult>)>,
    /// True if the first verdict was reported. Further verdicts, about edited runs, are not reported.
    is_told: bool,
}

impl OwnCode {
    /// Reads the data in `text`, the file `name`, for comparison with the run of `scenario`.
    ///
    /// Rows as a program of the report's scheme writes them need no times. They are returned as well.
    pub(super) fn read(
        name: &str,
        text: &str,
        options: &ColumnOptions,
        scenario: &Scenario,
    ) -> Result<(MeasuredData, Option<Self>), Problems> {
        let time_step_s = scenario.motion.time_step_s;
        let (measured, map) = (data::read_with(name, text, options), &options.map);
        let has_times = measured.as_ref().is_ok_and(|it| it.series().is_ok());
        if scenario.motion.scheme.name != "report" {
            return Ok((measured?, None));
        }
        let rows = match rows::read(text, map, None, time_step_s) {
            // Rows of a program have no uncertainties.
            Ok(rows) if rows.left_out.iter().any(|it| it.contains("uncertainty")) => {
                return Ok((measured?, None));
            }
            Ok(rows) => rows,
            // The text is neither a time series nor a scenario.
            Err(problems)
                if measured.is_err() && ![TIME_COLUMN, "="].iter().any(|it| text.contains(it)) =>
            {
                return Err(problems.in_file(name));
            }
            Err(_) => return Ok((measured?, None)),
        };
        let own = Self {
            text: text.into(),
            map: map.as_slice().into(),
            judged: None,
            is_told: false,
        };
        let measured = measured.ok().filter(|_| has_times);
        let measured = match measured {
            Some(measured) => measured,
            None => MeasuredData {
                left_out: rows.left_out.clone(),
                ..data::read(name, &rows.to_csv(time_step_s))?
            },
        };
        Ok((measured, Some(own)))
    }

    /// Starts comparing the rows with the run of `scenario`, called `name`, unless that has started already. Returns
    /// true if a verdict has just been found.
    pub(super) fn judge(&mut self, name: &str, scenario: &Arc<Scenario>) -> bool {
        if let Some((judged, job)) = &mut self.judged
            && Arc::ptr_eq(judged, scenario)
        {
            return job.take_news();
        }
        let (text, map) = (Arc::clone(&self.text), Arc::clone(&self.map));
        let (name, against) = (name.to_owned(), Arc::clone(scenario));
        let job = BackgroundJob::begin("own code", move |is_wanted| {
            let read = rows::read(&text, &map, None, against.motion.time_step_s);
            let checked = read.map_err(Unverified::from);
            match checked.and_then(|rows| own_code::compare(&rows, &name, &against, is_wanted)) {
                Ok(verdict) => Some(Ok(verdict)),
                Err(Unverified::Refused(problems)) => Some(Err(problems.in_one_line())),
                Err(Unverified::Stopped) => None,
            }
        });
        self.judged = Some((Arc::clone(scenario), job));
        false
    }

    fn outcome(&self) -> Option<&VerdictResult> {
        self.judged.as_ref()?.1.answer()
    }

    pub fn verdict(&self) -> Option<&Verdict> {
        self.outcome()?.as_ref().ok()
    }

    pub fn trial(&self) -> Option<&SlipTrial> {
        self.verdict()?.trial.as_ref()
    }

    /// Returns the verdict in words, if it is the first.
    pub(super) fn first_told(&mut self, name: &str) -> Option<String> {
        let is_told = std::mem::replace(&mut self.is_told, true);
        (!is_told).then(|| self.told(name))
    }

    /// Returns the verdict in words.
    pub(super) fn told(&self, name: &str) -> String {
        let name = Path::new(name)
            .file_name()
            .unwrap_or_default()
            .to_string_lossy();
        let words = match self.outcome() {
            None => format!("{name} is being compared with the run"),
            Some(Err(why)) => format!("{name}: {why}"),
            Some(Ok(verdict)) => match (verdict.first_step, &verdict.trial) {
                (Some(step), Some(SlipTrial { words, .. })) => {
                    format!("{name} differs at step {step} (M goes there). It has {words}")
                }
                (Some(step), None) => {
                    let more = verdict.lines[1..].join(" ");
                    format!("{name} differs at step {step} (M goes there). {more}")
                }
                (None, _) => format!("{name}: {}", verdict.lines.join(" · ")),
            }
            .replace('\n', " "),
        };
        printable_lines(&words).into_owned()
    }
}
