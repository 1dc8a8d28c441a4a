//! The result of the comparison as a verdict and in words.

use super::explain::{Explanation, MOST_FOR_PAIRS, SLIP_COUNT};
use super::follow::{RowDifference, Worst};
use super::rows::{COMPARED_COLUMNS, ProgramColumn, SINGLE_DIGITS};
use super::slips::ANOTHER_READING;
use super::{CheckOutcome, Explanations, Precision, Verdict};
use crate::engine::run::pushes;
use crate::engine::text::number::{counted, short, shortest, significant};
use crate::engine::text::printable::brief;
use nalgebra::Vector3;

/// The preset whose body and push reveal every slip.
const EVERY_SLIP: &str = "every-slip";
const TRY_EVERY_SLIP: &str =
    "run your program on the preset every-slip and verify its rows with --against every-slip";
const COLUMN_UNITS: [&str; 2] = ["m", "J s"];
/// Relative change of a point's distance from the pivot that rounding errors alone cannot cause.
const LENGTHENED: f64 = 1e-3;
/// Digits shown of values that differ.
const DIFFERENCE_DIGITS: usize = 12;

impl CheckOutcome<'_> {
    pub(super) fn verdict(&self) -> Verdict {
        let (rows, beside) = (self.rows, &self.beside);
        let agrees = beside.differs.is_none() && rows.not_finite.is_none();
        let differing = self.differing();
        Verdict {
            agrees,
            precision: self.precision,
            digits: self.digits(),
            rows: if agrees { beside.agreeing } else { rows.count },
            rows_compared: self.rows_compared(),
            offset: beside.offset,
            first_step: beside.differs.map(|differs| differs.step),
            columns: differing.iter().map(|(column, ..)| column.name()).collect(),
            yours: differing.iter().map(|(_, yours, _)| *yours).collect(),
            scheme: differing.iter().map(|(.., scheme)| *scheme).collect(),
            worst_m: beside.worst[0].map(|worst| worst.off),
            explanations: match self.explanations[..] {
                [] => Explanations::None,
                _ if self.is_proved => Explanations::Unique,
                _ => Explanations::Several,
            },
            slips: self.explanations.iter().map(Explanation::names).collect(),
            unseen: self.unseen.clone(),
            lines: self.lines(agrees),
            is_unexplained: beside.differs.is_some() && self.is_unexplained(),
            trial: None,
        }
    }

    fn rows_compared(&self) -> usize {
        let beside = &self.beside;
        match (self.explanations.first(), beside.differs) {
            (Some(explanation), _) => explanation.followed.agreeing,
            (None, Some(differs)) => differs.row + 1,
            (None, None) => beside.agreeing,
        }
    }

    /// Returns the columns of the first difference, with the file's and the scheme's values.
    fn differing(&self) -> Vec<(&ProgramColumn, f64, f64)> {
        self.beside
            .differs
            .into_iter()
            .flat_map(|differs: RowDifference| {
                let values = self.rows.columns.iter().map(move |column| {
                    let (yours, scheme) =
                        (column.values[differs.row], differs.scheme[column.place]);
                    (column, yours, scheme)
                });
                values.filter(|(column, yours, scheme)| !column.agrees(*yours, *scheme, 0.0))
            })
            .collect()
    }

    fn lines(&self, agrees: bool) -> Vec<String> {
        let (rows, name, dt) = (self.rows, self.name, self.scenario.motion.time_step_s);
        let mut lines = Vec::new();
        if let Some(own) = rows.times.own_s {
            let [own, dt] = [own, dt].map(shortest);
            lines.push(format!(
                "its times imply a time step of {own} s, but {name} has {dt} s"
            ));
        }
        if agrees {
            lines.push(self.agreement());
            lines.extend(self.too_few_digits("small differences cannot be detected"));
            lines.extend(self.not_reached());
        } else {
            lines.push(self.difference());
        }
        if let Some((line, column)) = rows.not_finite {
            lines.push(format!(
                "In line {line}, {column} is not finite: only the rows before it are compared."
            ));
        }
        let shift = shifted(self.beside.offset);
        lines.extend(shift.map(|shift| format!("The rows are {shift}.")));
        lines.extend(self.beside.parted.map(|step| format!(
            "From step {step} on, rounding errors take over in this scenario: these rows are not compared."
        )));
        if agrees {
            lines.extend(self.hidden());
        } else if self.beside.differs.is_some() {
            lines.extend(self.explained());
        }
        lines.extend(self.left_out());
        lines
    }

    fn agreement(&self) -> String {
        let (name, rows) = (self.name, counted(self.beside.agreeing as u64, "row"));
        let [of_points, of_momentum] = self.beside.worst;
        let mut worst = worst_of([of_points, of_momentum]);
        let as_far = match self.precision {
            Precision::Single => " within single precision: compute in double",
            Precision::Unknown if self.has_few_digits() => " to the digits written",
            _ => "",
        };
        if self.is_lenient && of_points.is_some() && of_momentum.is_some() {
            worst += &format!(", {}", worst_of([None, of_momentum]).replace("worst ", ""));
        }
        format!("agrees with {name} in {rows}{as_far}; {worst}")
    }

    /// Explains the consequence `problem` of too few digits, and how many are needed.
    fn too_few_digits(&self, problem: &str) -> Option<String> {
        let coarsest = self.coarsest().filter(|_| self.has_few_digits())?;
        let name = coarsest.name();
        let digits = if coarsest.is_fixed {
            counted(coarsest.decimals.max(0) as u64, "decimal")
        } else {
            counted(coarsest.digits() as u64, "digit")
        };
        Some(format!(
            "With {digits} {problem}: write {SINGLE_DIGITS} or more ({name})."
        ))
    }

    /// Describes the part of the run that the rows do not reach.
    fn not_reached(&self) -> Option<String> {
        let steps = &self.rows.times.steps;
        let last = steps.of_rows.last()? + self.beside.offset * steps.stride;
        let all = self.scenario.steps as i64;
        if last >= all || self.beside.parted.is_some() {
            return None;
        }
        let mut beyond = Vec::new();
        for push in self.scenario.pushes.iter() {
            let (begin, end) = pushes::acts_s(push, self.scenario);
            for (what, time_s) in [("begin", begin), ("end", end)] {
                let step = (time_s / self.scenario.motion.time_step_s).round() as i64;
                if time_s.is_finite() && step > last {
                    beyond.push(format!("the push's {what}, at step {step}, is missing"));
                }
            }
        }
        let rest = match &beyond[..] {
            [] => format!("they end at step {last}"),
            beyond => brief(&beyond.join("; "), 200),
        };
        let rows = self.beside.agreeing;
        Some(format!("{rows} of {} rows: {rest}", all + 1))
    }

    fn difference(&self) -> String {
        let Some(differs) = self.beside.differs else {
            return "has numbers that are not finite, unlike the scheme".to_owned();
        };
        let differing = self.differing();
        let mut whose = match self.scenario.motion.scheme.name {
            "report" => "the report's scheme gives ".to_owned(),
            other => format!("the scheme {other} gives "),
        };
        let off = differing
            .iter()
            .map(|(column, yours, scheme)| {
                let [yours, scheme] =
                    [yours, scheme].map(|value| significant(*value, DIFFERENCE_DIGITS));
                let (name, unit) = (bare(column.place), COLUMN_UNITS[column.place / 3]);
                format!(
                    "{name} is {yours} {unit}, {}{scheme}",
                    std::mem::take(&mut whose)
                )
            })
            .collect::<Vec<_>>()
            .join("; ");
        let places = self.rows.columns.iter().map(|column| column.place);
        let same = places.filter(|place| differing.iter().all(|(it, ..)| it.place != *place));
        let same = match &same.map(bare).collect::<Vec<_>>()[..] {
            [] => String::new(),
            [one] => format!("; {one} agrees"),
            [most @ .., last] => format!("; {} and {last} agree", most.join(", ")),
        };
        format!("differs at step {}: {off}{same}", differs.step)
    }

    /// Describes the slips that explain the rows.
    fn explained(&self) -> Vec<String> {
        if !self.has_plan {
            let words = "Mistakes are searched for only in runs of the report's scheme (--set motion.scheme=report) without friction, rotor, edits and pushes in seconds.";
            return vec![words.to_owned()];
        }
        if let Some(other) = self.other {
            return vec![format!(
                "These rows are {other}'s: compare them with {other}."
            )];
        }
        if self.is_unexplained() {
            return vec![self.unexplained()];
        }
        let mut lines: Vec<_> = self.about_top().into_iter().collect();
        if self.explanations.iter().any(|it| it.is_single) && self.precision == Precision::Single {
            lines.push("The program computes in single precision: compute in double.".to_owned());
        }
        if self.is_proved {
            lines.extend(self.explanations.first().map(stated));
            return lines;
        }
        lines.push("These rows are also produced by:".to_owned());
        lines.extend(self.explanations.iter().map(listed));
        let too_few = self.too_few_digits("other causes may produce the same rows");
        let why = match (self.explanations.len(), too_few) {
            (_, Some(words)) => format!("This is not a proof. {words}"),
            (1, None) if self.explanations[0].names().len() > 1 && self.name != EVERY_SLIP => format!("Other differences may produce them too, because this scenario hides mistakes: {TRY_EVERY_SLIP}."),
            (1, None) => "Other differences may produce them too: these rows are too few, or differ too little. Write every row from the start.".to_owned(),
            (_, None) if self.name == EVERY_SLIP => "These rows cannot distinguish them.".to_owned(),
            (_, None) => {
                format!("These rows cannot distinguish them: {TRY_EVERY_SLIP}.")
            }
        };
        lines.push(why);
        lines
    }

    fn is_unexplained(&self) -> bool {
        self.has_plan && self.other.is_none() && self.explanations.is_empty()
    }

    fn unexplained(&self) -> String {
        let mut text =
            format!("None of {SLIP_COUNT} known mistakes, alone or in pairs, explains these rows.");
        if !self.has_pairs {
            text = format!(
                "None of {SLIP_COUNT} known mistakes explains these rows. Pairs are tried only if the rows differ by step {MOST_FOR_PAIRS}: write the first steps too."
            );
        }
        if let Some(closest) = &self.closest {
            let step = closest.followed.differs.map_or(0, |differs| differs.step);
            let (names, words) = (closest.names().join(" + "), closest.words());
            text += &format!("\nThe closest is {names}, up to step {step}: {words}");
        }
        if let Some(words) = self.about_top() {
            text += &format!("\n{words}");
        }
        text
    }

    /// Describes a wrong start of the top, or a changing distance from the pivot.
    fn about_top(&self) -> Option<String> {
        let [x, y, z, ..] = &self.rows.columns[..] else {
            return None;
        };
        let differs = self.beside.differs.filter(|_| z.place == 2)?;
        let at = |row: usize| Vector3::new(x.values[row], y.values[row], z.values[row]);
        let [own, right] = [at(0), Vector3::from_column_slice(&differs.scheme[..3])].map(|point| {
            let tilt = libm::acos(point.z / point.norm()).to_degrees();
            let [radius, tilt] = [point.norm(), tilt].map(short);
            format!("{radius} m from the pivot, tilted by {tilt} degrees")
        });
        if differs.step == 0 && own != right {
            return Some(format!(
                "Its top starts {own}; the scenario's starts {right}."
            ));
        }
        let lost = (1..self.rows.count).find(|row| {
            let [first, now] = [0, *row].map(|row| at(row).norm());
            let room: f64 = [x, y, z].map(|column| column.room(now)).iter().sum();
            (now - first).abs() > 2.0 * room + LENGTHENED * first
        })?;
        let [first, now] = [0, lost].map(|row| {
            let length = at(row).norm();
            significant(if length < 1e-12 { 0.0 } else { length }, 7)
        });
        let [begin, step] = [0, lost].map(|row| self.rows.times.steps.of_rows[row]);
        Some(format!(
            "The rotation matrix is not a rotation: the top is {first} m from the pivot at step {begin} and {now} m at step {step}."
        ))
    }

    fn left_out(&self) -> Option<String> {
        let names = self.rows.left_out.iter().map(|name| brief(name, 40));
        let names = brief(&names.collect::<Vec<_>>().join(", "), 200);
        let columns = COMPARED_COLUMNS.join(", ");
        (!names.is_empty()).then(|| {
            format!("Ignored columns: {names} (compared are {columns}; --map gives a column one of these names).")
        })
    }

    /// Lists the slips that these rows cannot reveal.
    fn hidden(&self) -> Option<String> {
        let (count, names) = (self.unseen.len() as u64, self.unseen.join(", "));
        let remedy = if self.name == EVERY_SLIP {
            "write more rows, columns or digits"
        } else {
            TRY_EVERY_SLIP
        };
        let slips = counted(count, "mistake");
        (count > 0)
            .then(|| format!("These rows would hide {slips}: {names}. To reveal them, {remedy}."))
    }
}

/// Describes the largest difference, preferably of x, y, z.
fn worst_of(worst: [Option<Worst>; 2]) -> String {
    worst
        .into_iter()
        .flatten()
        .next()
        .map_or(String::new(), |worst| {
            let (off, column, step) = (short(worst.off), bare(worst.place), worst.step);
            let unit = COLUMN_UNITS[worst.place / 3];
            format!("worst {off} {unit} in {column} at step {step}")
        })
}

/// Describes the only explanation.
fn stated(explanation: &Explanation) -> String {
    let begin = match &explanation.names()[..] {
        [name] if *name == ANOTHER_READING => {
            "another interpretation of the report's push, not a mistake"
        }
        [_] => "the report's scheme with one difference",
        _ => "the report's scheme with two differences",
    };
    let names = explanation.names().join(" + ");
    let (words, rows) = (explanation.words(), compared(explanation));
    format!("This is {begin} ({names}): {words}\nWith this change, {rows}.")
}

fn listed(explanation: &Explanation) -> String {
    let (names, words) = (explanation.names().join(" + "), explanation.words());
    format!("  {names} ({}): {words}", compared(explanation))
}

/// Describes how many rows agree with an explanation.
fn compared(explanation: &Explanation) -> String {
    let followed = &explanation.followed;
    let rows = match followed.agreeing {
        1 => "1 row agrees".to_owned(),
        count => format!("{count} rows agree"),
    };
    let worst = worst_of(followed.worst);
    let mut text = match followed.parted {
        None => format!("all {rows}, {worst}"),
        Some(step) => {
            format!("{rows}, {worst}; from step {step} on, rounding errors take over")
        }
    };
    if let Some(shift) = shifted(followed.offset) {
        text += &format!("; {shift}");
    }
    text
}

/// Describes the offset at which the rows were compared.
fn shifted(offset: i64) -> Option<&'static str> {
    match offset {
        0 => None,
        1.. => Some(
            "compared one row later: the file starts after the first step, or its row numbers are too low by one",
        ),
        _ => Some(
            "compared one row earlier: the file contains the start twice, or its row numbers are too high by one",
        ),
    }
}

/// Returns the name of a column without its unit.
fn bare(place: usize) -> &'static str {
    let name = COMPARED_COLUMNS[place];
    name.split('_').next().unwrap_or(name)
}
