//! What has come out of the comparison of own code with the scheme, as a verdict and in words.

use super::explain::{COUNT, Explanation, MOST_FOR_PAIRS, Variant};
use super::follow::Worst;
use super::rows::COLUMNS;
use super::slips::ANOTHER_READING;
use super::{Found, Verdict};
use crate::run::pushes;
use crate::text::number::{counted, short, shortest, significant};
use crate::text::printable::brief;

/// The preset whose body and push show every slip.
const EVERY_SLIP: &str = "every-slip";
/// The most explanations that are printed.
const MOST: usize = 4;
const UNITS: [&str; 2] = ["m", "J s"];
/// Digits of the values that differ.
const DIGITS: usize = 12;

impl Found<'_> {
    pub(super) fn verdict(&self) -> Verdict {
        let differs = self.beside.differs;
        let agrees = differs.is_none() && self.rows.not_finite.is_none();
        let differing = self.differing();
        Verdict {
            agrees,
            precision: if self.is_single { "single" } else { "double" },
            rows: if agrees {
                self.beside.agreeing
            } else {
                self.rows.values.len()
            },
            offset: self.beside.offset,
            first_step: differs.map(|differs| differs.step),
            columns: differing
                .iter()
                .map(|(place, ..)| COLUMNS[*place])
                .collect(),
            yours: differing.iter().map(|(_, yours, _)| *yours).collect(),
            scheme: differing.iter().map(|(.., scheme)| *scheme).collect(),
            worst_m: self.beside.worst[0].map(|worst| worst.off),
            slips: self.explanations.iter().map(Explanation::names).collect(),
            unseen: self.unseen.clone(),
            lines: self.lines(agrees),
        }
    }

    /// The places of the columns that differ first, with the values of the file and of the scheme.
    fn differing(&self) -> Vec<(usize, f64, f64)> {
        let Some(differs) = self.beside.differs else {
            return Vec::new();
        };
        let values = self.rows.columns.iter().zip(&self.rows.values[differs.row]);
        let differing = values.filter_map(|(column, yours)| {
            let scheme = differs.scheme[column.place];
            let agrees = column.agrees(*yours, scheme, 0.0);
            (!agrees).then_some((column.place, *yours, scheme))
        });
        differing.collect()
    }

    fn lines(&self, agrees: bool) -> Vec<String> {
        let mut lines: Vec<String> = self.time_step().into_iter().collect();
        if agrees {
            lines.push(self.agreement());
            lines.extend(self.not_reached());
        } else {
            lines.push(self.difference());
            lines.extend(self.not_finite());
        }
        lines.extend(self.offset());
        lines.extend(self.beside.parted.map(|step| format!(
            "From step {step} on rounding decides about the motion of this scenario: the rows there are not compared."
        )));
        if agrees {
            lines.extend(self.hidden());
        } else {
            lines.extend(self.explained());
        }
        lines.extend(self.left_out());
        lines
    }

    /// Says that the file has another time step.
    fn time_step(&self) -> Option<String> {
        let [own, scenario] =
            [self.rows.times.own_s?, self.scenario.motion.time_step_s].map(shortest);
        let name = self.name;
        Some(format!(
            "its time step is {own} s by its times, that of {name} is {scenario} s"
        ))
    }

    fn agreement(&self) -> String {
        let (name, rows) = (self.name, counted(self.beside.agreeing as u64, "row"));
        let worst = self.worst_of(self.beside.worst);
        let single = if self.is_single {
            " as far as single precision can: compute in double"
        } else {
            ""
        };
        format!("agrees with {name} in {rows}{single}; {worst}")
    }

    /// The largest difference, of x, y, z where there is one of these columns.
    fn worst_of(&self, worst: [Option<Worst>; 2]) -> String {
        let Some(worst) = worst.into_iter().flatten().next() else {
            return String::new();
        };
        let (place, step) = (self.rows.columns[worst.column].place, worst.step);
        let (off, unit, column) = (short(worst.off), UNITS[place / 3], bare(place));
        format!("worst {off} {unit} in {column} at step {step}")
    }

    /// What the rows do not reach.
    fn not_reached(&self) -> Option<String> {
        let steps = &self.rows.times.steps;
        let last = steps.of_rows.last()? + self.beside.offset * steps.stride;
        let all = self.scenario.steps as i64;
        if last >= all || self.beside.parted.is_some() {
            return None;
        }
        let ends = self.scenario.pushes.iter().flat_map(|push| {
            let (begin, end) = pushes::acts_s(push, self.scenario);
            [("begin", begin), ("end", end)]
        });
        let step_of = |time_s: f64| (time_s / self.scenario.motion.time_step_s).round() as i64;
        let beyond = ends.filter(|(_, time_s)| time_s.is_finite() && step_of(*time_s) > last);
        let beyond = beyond.map(|(what, time_s)| {
            format!(
                "the push's {what}, at step {}, is not among them",
                step_of(time_s)
            )
        });
        let mut rest = brief(&beyond.collect::<Vec<_>>().join("; "), 200);
        if rest.is_empty() {
            rest = format!("they end at step {last}");
        }
        Some(format!(
            "{} of {} rows: {rest}",
            self.beside.agreeing,
            all + 1
        ))
    }

    fn difference(&self) -> String {
        let Some(differs) = self.beside.differs else {
            return "its numbers are not finite, the scheme's are".to_owned();
        };
        let differing = self.differing();
        let whose = match self.scenario.motion.scheme.name {
            "report" => "the report's scheme gives ".to_owned(),
            other => format!("the scheme {other} gives "),
        };
        let off = differing
            .iter()
            .enumerate()
            .map(|(number, (place, yours, scheme))| {
                let whose = if number == 0 { &*whose } else { "" };
                let [yours, scheme] = [yours, scheme].map(|value| significant(*value, DIGITS));
                format!(
                    "{} is {yours} {}, {whose}{scheme}",
                    bare(*place),
                    UNITS[place / 3]
                )
            });
        let off = off.collect::<Vec<_>>().join("; ");
        let places = self.rows.columns.iter().map(|column| column.place);
        let same = places.filter(|place| differing.iter().all(|(other, ..)| other != place));
        let same = match &same.map(bare).collect::<Vec<_>>()[..] {
            [] => String::new(),
            [one] => format!("; {one} agrees"),
            [most @ .., last] => format!("; {} and {last} agree", most.join(", ")),
        };
        format!("differs at step {}: {off}{same}", differs.step)
    }

    fn not_finite(&self) -> Option<String> {
        let (line, column) = self.rows.not_finite.as_ref()?;
        let column = brief(column, 40);
        Some(format!(
            "In line {line} {column} is no finite number: the rows are compared up to there."
        ))
    }

    /// Says at which offset the rows were compared.
    fn offset(&self) -> Option<String> {
        let words = match self.beside.offset {
            0 => return None,
            1.. => "The file begins one row after the start, or numbers its rows one too low",
            _ => "The file has the start twice, or numbers its rows one too high",
        };
        Some(format!("{words}: compared so."))
    }

    /// Which slips explain the rows, or that none does.
    fn explained(&self) -> Vec<String> {
        if !self.has_plan {
            let words = "Slips are looked for in runs of the report's scheme alone (--set motion.scheme=report), without friction, rotor, edits and pushes in seconds.";
            return vec![words.to_owned()];
        }
        if self.explanations.is_empty() {
            return vec![self.unexplained()];
        }
        let all = self.explanations.iter().take(MOST);
        let mut lines: Vec<_> = all
            .map(|explanation| self.explanation(explanation))
            .collect();
        for line in &mut lines[1..] {
            line.insert_str(0, "The same rows come out another way. ");
        }
        if self.explanations.len() > MOST {
            let more = self.explanations.len() - MOST;
            lines.push(format!("And in {more} more ways (--json names all)."));
        }
        lines
    }

    fn explanation(&self, explanation: &Explanation) -> String {
        let followed = &explanation.followed;
        let begin = match &explanation.names()[..] {
            [name] if *name == ANOTHER_READING => {
                "This is another reading of the report's push, and no slip"
            }
            [_] => "This is the report's scheme with one difference",
            _ => "This is the report's scheme with two differences",
        };
        let (names, sentences) = (explanation.names().join(" + "), self.sentences(explanation));
        let rows = counted(followed.agreeing as u64, "row");
        let up_to = followed.parted.map_or(String::new(), |step| {
            format!(" before step {step}, from which on rounding decides about its motion,")
        });
        let worst = self.worst_of(followed.worst);
        format!("{begin} ({names}): {sentences}\nWith that all {rows}{up_to} agree ({worst}).")
    }

    /// What the program does, and what the report does.
    fn sentences(&self, explanation: &Explanation) -> String {
        let sentence = |variant: &Variant| {
            let Some(slip) = variant.slip else {
                let (own, dt) = (&variant.note, shortest(self.scenario.motion.time_step_s));
                return format!("its time step is {own}. The scenario's is {dt} s.");
            };
            let note = match variant.note.as_str() {
                "" => String::new(),
                note => format!(" ({note})"),
            };
            format!("{}{note}. The report {}.", slip.program, slip.report)
        };
        let sentences: Vec<_> = explanation.variants.iter().map(sentence).collect();
        sentences.join(" Second: ")
    }

    fn unexplained(&self) -> String {
        let mut none = format!("None of {COUNT} slips, nor two together, makes this file.");
        if !self.has_pairs {
            none = format!(
                "None of {COUNT} slips makes this file. Two together are tried where rows differ from step {MOST_FOR_PAIRS} or sooner: write the first steps too."
            );
        }
        let Some(closest) = &self.closest else {
            return none;
        };
        let step = closest.followed.differs.map_or(0, |differs| differs.step);
        let (names, sentences) = (closest.names().join(" + "), self.sentences(closest));
        format!("{none}\n{names} comes closest, up to step {step}: {sentences}")
    }

    fn left_out(&self) -> Option<String> {
        let names = self.rows.left_out.iter().map(|name| brief(name, 40));
        let names = brief(&names.collect::<Vec<_>>().join(", "), 200);
        let columns = COLUMNS.join(", ");
        (!names.is_empty()).then(|| {
            format!("Left out: {names} (compared are {columns}; --map gives a column one of these names).")
        })
    }

    /// Which slips these rows cannot show.
    fn hidden(&self) -> Option<String> {
        let (slips, names) = (
            counted(self.unseen.len() as u64, "slip"),
            self.unseen.join(", "),
        );
        let remedy = if self.name == EVERY_SLIP {
            "Write more rows, columns or digits"
        } else {
            "Try --against every-slip"
        };
        (!names.is_empty()).then(|| format!("These rows would hide {slips}: {names}. {remedy}."))
    }
}

/// The name of a column without its unit.
fn bare(place: usize) -> &'static str {
    let name = COLUMNS[place];
    name.split('_').next().unwrap_or(name)
}
