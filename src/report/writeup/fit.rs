//! The write-up of a fit: what was measured, what was free and what was held, the values with their uncertainties, how well
//! the model fits, and the data with their residuals.

use super::figures::WriteupFigure;
use super::page::{GUM, add_code, gyrolab};
use super::{AGAIN, DocumentFormats};
use crate::engine::data::{DataKind, MeasuredPoint};
use crate::engine::text::number::{counted, shortest, significant, uncertain};
use crate::engine::text::unit::Unit;
use crate::plot::{COLUMN_PT, Unwritable};
use crate::report::document::{Column, Document, Span, Text, escape};
use crate::report::figure::{FigureSource, FigureSpec};
use crate::studies::fit::free::shown;
use crate::studies::fit::report::FitReport;
use crate::studies::fit::solution::student;
use crate::studies::table::TableSource;
use std::ops::ControlFlow;
use toml::{Table, Value};

pub const FIT_CSV: &str = "fit.csv";
/// The scenario in which the search began.
pub const SCENARIO_FILE: &str = "scenario.toml";
pub const FIT_JSON: &str = "fit.json";
const FIT_FIGURE: &str = "fit";

/// Keys of a scenario on which no number of a run depends.
const WORDS: [&str; 6] = ["title", "about", "source", "gyrolab", "view", "expected"];
/// Tables with more rows are not printed.
const MOST_HELD_VALUES: usize = 40;
const MOST_DATA_ROWS: usize = 40;
/// In a cell for which there is nothing.
const NOTHING: &str = "–";

/// A fit with its files.
pub struct FitWriteup<'a> {
    pub report: FitReport<'a>,
    /// The scenario in which the search began.
    pub scenario: Table,
    /// The CSV of the fit.
    pub csv: Vec<u8>,
    pub drawings: Vec<WriteupFigure>,
}

impl<'a> FitWriteup<'a> {
    /// Draws the figures of the fit `report`, whose CSV is `csv`. `None` if `watch` breaks.
    ///
    /// # Errors
    /// When a figure cannot be drawn.
    pub fn new(
        report: FitReport<'a>,
        scenario: Table,
        csv: Vec<u8>,
        watch: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<Option<Self>, String> {
        let text = String::from_utf8_lossy(&csv).into_owned();
        let table = TableSource::from_csv(FIT_CSV, text).map_err(|error| error.to_string())?;
        let source = FigureSource {
            spec: FigureSpec {
                width_pt: Some(COLUMN_PT),
                ..FigureSpec::default()
            },
            table,
            ..FigureSource::default()
        };
        let Some(drawn) = source.draw(watch)? else {
            return Ok(None);
        };
        let caption = format!(
            "Above: the data `{}` and the fitted model. Below: the residuals, data less model.",
            report.model.measured.origin
        );
        let figure = WriteupFigure {
            name: FIT_FIGURE,
            caption,
            remark: None,
            scene: drawn.scene,
            source,
        };
        Ok(Some(Self {
            report,
            scenario,
            csv,
            drawings: vec![figure],
        }))
    }

    /// All files but the data and the scenario, each with its name and its bytes.
    ///
    /// # Errors
    /// When a figure is too large for its form.
    pub fn files(&self, formats: DocumentFormats) -> Result<Vec<(String, Vec<u8>)>, Unwritable> {
        let json = serde_json::to_value(self.report).unwrap_or_default();
        let mut files = vec![
            (FIT_CSV.to_owned(), self.csv.clone()),
            (FIT_JSON.to_owned(), format!("{json:#}\n").into_bytes()),
        ];
        files.extend(formats.files(&self.document()));
        for drawing in &self.drawings {
            files.extend(drawing.files()?);
        }
        Ok(files)
    }

    pub fn document(&self) -> Document {
        let model = self.report.model;
        let name = &model.measured.origin;
        let title = format!("{}, fitted to {name}", model.title);
        let mut document = Document::new(Text::plain(&title));
        document.references = vec![gyrolab(), GUM];
        document.section("What was measured");
        self.add_data(&mut document);
        document.section("What was fitted");
        self.add_values(&mut document);
        self.add_held(&mut document);
        document.section("How well the model fits");
        self.add_quality(&mut document);
        document.section("Data and residuals");
        for drawing in &self.drawings {
            document.figure(drawing.name, drawing.width_mm(), &drawing.caption);
        }
        self.add_residuals(&mut document);
        document.section("How to make it again");
        add_commands(&mut document);
        document
    }

    /// Adds the table of the measured quantities.
    fn add_data(&self, document: &mut Document) {
        let measured = &self.report.model.measured;
        for paragraph in measured.about.split("\n\n") {
            let words: Vec<&str> = paragraph.split_whitespace().collect();
            if !words.is_empty() {
                document.paragraph(&escape(&words.join(" ")));
            }
        }
        let lines = counted(measured.lines.len() as u64, "row");
        document.paragraph(&format!(
            "`{}` has {lines}, and {} that were fitted.",
            measured.origin,
            counted(self.report.model.data.len() as u64, "measured value")
        ));
        let quantities = self.report.model.columns.iter().enumerate();
        let rows = quantities.map(|(column, measurand)| {
            let data = self.report.model.data.iter();
            let points: Vec<MeasuredPoint> = data
                .filter(|datum| datum.column == column)
                .map(|datum| datum.point)
                .collect();
            let with_sigma = points.iter().filter(|point| point.sigma.is_some()).count();
            [
                Text::code(measurand.readout.name),
                Text::plain(measurand.readout.meaning),
                Text::unit(measurand.readout.unit),
                Text::number(&points.len().to_string()),
                Text::number(&with_sigma.to_string()),
            ]
        });
        document.table(
            "The measured quantities.",
            [
                Column::text("quantity"),
                Column::text("meaning"),
                Column::text("unit"),
                Column::number("values"),
                Column::number("with uncertainty"),
            ],
            rows,
        );
    }

    /// Adds the table of the fitted values.
    fn add_values(&self, document: &mut Document) {
        let model = self.report.model;
        document.paragraph(&format!(
            "The data are compared with runs of the scenario “{}” with the scheme `{}`. The fit minimizes the sum of the \
             squared residuals{} by the method of Levenberg and Marquardt.",
            escape(&model.title),
            model.scheme,
            if self.report.fit.quality.chi_squared.is_some() {
                " in units of their uncertainties"
            } else {
                ""
            }
        ));
        let rows = self.report.fit.keys.iter().enumerate().map(|(index, key)| {
            let free = &key.free;
            let [from, to] = [free.from, free.to].map(shown);
            let bounds = match (free.from.is_finite(), free.to.is_finite()) {
                (true, true) => format!("{from} to {to}"),
                (true, false) => format!("at least {from}"),
                (false, true) => format!("at most {to}"),
                (false, false) => String::new(),
            };
            let stated = key.stated();
            [
                Text::code(&free.key),
                if stated.contains(' ') {
                    Text::plain(&stated)
                } else {
                    Text::number(&stated)
                },
                Text::unit(unit_of(&free.key)),
                Text::plain(&shortest(free.start)),
                Text::plain(&bounds),
                Text::plain(&self.report.remark(index)),
            ]
        });
        document.table(
            "The fitted values.",
            [
                Column::text("free key"),
                Column::number("value"),
                Column::text("unit"),
                Column::text("start"),
                Column::text("bounds"),
                Column::text("remark"),
            ],
            rows,
        );
        document.paragraph(
            "Digits in parentheses are one standard uncertainty, in units of the last digits [@gum]. “Start” is the value from \
             which the search began.",
        );
    }

    /// Adds the values that were not fitted.
    fn add_held(&self, document: &mut Document) {
        let mut held = Vec::new();
        for (key, value) in &self.scenario {
            if !WORDS.contains(&key.as_str()) {
                flatten(key, value, &mut held);
            }
        }
        let free: Vec<&String> = self
            .report
            .fit
            .keys
            .iter()
            .flat_map(|key| &key.free.keys)
            .collect();
        held.retain(|(key, _)| !free.contains(&key));
        if held.len() > MOST_HELD_VALUES {
            document.paragraph(&format!(
                "The other {} values of `{SCENARIO_FILE}` were held.",
                held.len()
            ));
            return;
        }
        let rows = held.iter().map(|(key, value)| {
            let is_free_in_part = free.iter().any(|it| it.starts_with(&format!("{key}.")));
            let note = if is_free_in_part {
                " (a component is free)"
            } else {
                ""
            };
            [
                Text::code(key),
                Text(vec![
                    Span::Code(value.clone()),
                    Span::Plain(note.to_owned()),
                ]),
                Text::unit(unit_of(key)),
            ]
        });
        document.table(
            &format!("The values that were held, of `{SCENARIO_FILE}`. What it does not name has its default."),
            [Column::text("key"), Column::text("value"), Column::text("unit")],
            rows,
        );
    }

    fn add_quality(&self, document: &mut Document) {
        let (fit, quality) = (self.report.fit, self.report.fit.quality);
        document.paragraph(&escape(&fit.sentence(self.report.model)));
        let freedom = quality.degrees_of_freedom;
        let mut rows = vec![
            ["fitted values".to_owned(), fit.keys.len().to_string()],
            ["degrees of freedom".to_owned(), freedom.to_string()],
        ];
        if let Some(sum) = quality.chi_squared {
            rows.push(["$χ^2$".to_owned(), significant(sum, 4)]);
            if freedom > 0 {
                let each = significant(sum / freedom as f64, 3);
                rows.push(["$χ^2$ per degree of freedom".to_owned(), each]);
            }
        }
        if let Some(probability) = quality.probability {
            let label = "probability of this $χ^2$ or a larger one, if the model is right";
            rows.push([label.to_owned(), significant(probability, 2)]);
        }
        if let Some(scatter) = quality.scatter {
            let label = "scatter of the data about the model, in their unit";
            rows.push([label.to_owned(), significant(scatter, 3)]);
            if fit.variance.is_some() {
                let factor = significant(student(freedom), 4);
                rows.push(["Student's factor, in the uncertainties".to_owned(), factor]);
            }
        }
        let rows = rows
            .iter()
            .map(|[label, number]| [Text::marked(label), Text::number(number)]);
        document.table(
            "Goodness of the fit.",
            [Column::text("quantity"), Column::number("value")],
            rows,
        );
        for remark in self.report.remarks() {
            document.paragraph(&escape(&remark));
        }
        self.add_correlations(document);
    }

    /// Adds the correlations of the fitted values, if there are two or more.
    fn add_correlations(&self, document: &mut Document) {
        let keys = &self.report.fit.keys;
        if keys.len() < 2 {
            return;
        }
        let pairs = (0..keys.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
        let rows = pairs.map(|(j, i)| {
            let correlation = self.report.fit.solution.correlation(i, j);
            let cell =
                correlation.map_or(Text::plain(NOTHING), |it| Text::number(&format!("{it:.4}")));
            [
                Text::code(&keys[j].free.key),
                Text::code(&keys[i].free.key),
                cell,
            ]
        });
        document.table(
            "Correlations of the fitted values; – means that the data do not say one of the two.",
            [
                Column::text("of"),
                Column::text("and"),
                Column::number("correlation"),
            ],
            rows,
        );
    }

    /// Adds the data with their residuals: all of them, or those that are farthest off.
    fn add_residuals(&self, document: &mut Document) {
        let all = self.report.by_size();
        let is_all = all.len() <= MOST_DATA_ROWS;
        let mut shown: Vec<usize> = all.into_iter().take(MOST_DATA_ROWS).collect();
        shown.sort_unstable();
        let caption = if is_all {
            format!(
                "The data and their residuals, {}as in `{FIT_CSV}`.",
                self.single_quantity()
            )
        } else {
            let count = self.report.fit.residuals.len();
            format!(
                "The {MOST_DATA_ROWS} of {count} data that are farthest from the model; `{FIT_CSV}` has all of them."
            )
        };
        let mut columns: Vec<Column> = match &self.report.model.measured.data {
            DataKind::Series(_) => vec![Column::number("$t$ (s)")],
            DataKind::Table(table) => {
                let settings = table.settings.iter();
                let settings = settings.map(|it| Column::number(&format!("`{}`", it.key)));
                std::iter::once(Column::number("row"))
                    .chain(settings)
                    .collect()
            }
        };
        columns.extend([
            Column::text("quantity"),
            Column::number("measured"),
            Column::number("model"),
            Column::number("residual"),
            Column::number("in uncertainties"),
        ]);
        let rows = shown.into_iter().map(|index| self.residual_row(index));
        document.any_table(None, &caption, columns, rows.collect());
    }

    /// Names the measured quantity if there is only one.
    fn single_quantity(&self) -> String {
        match &self.report.model.columns[..] {
            [only] => format!("`{}`, ", only.readout.name),
            _ => String::new(),
        }
    }

    fn residual_row(&self, index: usize) -> Vec<Text> {
        let model = self.report.model;
        let residual = &self.report.fit.residuals[index];
        let mut row = match &model.measured.data {
            DataKind::Series(series) => vec![Text::number(&shortest(series.times_s[residual.row]))],
            DataKind::Table(table) => {
                let settings = table.settings.iter();
                let values = settings.map(|setting| match &setting.values[residual.row] {
                    Some(Value::Float(value)) => Text::number(&shortest(*value)),
                    Some(value) => Text::plain(value.to_string().trim_matches('"')),
                    None => Text::plain(NOTHING),
                });
                let number = Text::number(&(residual.row + 1).to_string());
                std::iter::once(number).chain(values).collect()
            }
        };
        let quantity = model.columns[model.data[index].column].readout.name;
        // A single quantity is named above the table.
        row.push(Text::code(if model.columns.len() > 1 {
            quantity
        } else {
            ""
        }));
        let stated = residual
            .sigma
            .and_then(|sigma| uncertain(residual.measured, sigma));
        row.extend(match stated {
            Some(stated) => [
                Text::number(&stated.to_string()),
                Text::number(&stated.to_the_same_digit(residual.model)),
            ],
            None => [residual.measured, residual.model]
                .map(|value| Text::number(&significant(value, 6))),
        });
        row.push(Text::number(&significant(residual.value(), 3)));
        row.push(residual.in_sigmas().map_or(Text::plain(""), |sigmas| {
            Text::number(&format!("{sigmas:+.1}"))
        }));
        row
    }
}

fn add_commands(document: &mut Document) {
    let commands = [
        ("verify .".to_owned(), "fit again and compare".to_owned()),
        (
            format!("figure {FIT_CSV} -o {FIT_FIGURE}.pdf --force"),
            "the figure".to_owned(),
        ),
        (
            format!("run {FIT_CSV} -o {AGAIN}"),
            "the run with the fitted values".to_owned(),
        ),
        (
            FIT_CSV.to_owned(),
            "the same, live in the terminal".to_owned(),
        ),
    ];
    let version = env!("CARGO_PKG_VERSION");
    document.paragraph(&format!(
        "In this folder, with gyrolab {version} [@gyrolab]:"
    ));
    add_code(document, &commands);
    document.paragraph(&format!(
        "The header of `{FIT_CSV}` has the command of the fit. `{FIT_JSON}` has all digits, the covariances and the residuals."
    ));
}

/// Adds the values in `value`, the value of `key`, under their dotted keys.
fn flatten(key: &str, value: &Value, values: &mut Vec<(String, String)>) {
    match value {
        Value::Table(table) => {
            for (name, inner) in table {
                flatten(&format!("{key}.{name}"), inner, values);
            }
        }
        Value::Array(items) if items.iter().any(Value::is_table) => {
            for (index, item) in items.iter().enumerate() {
                flatten(&format!("{key}.{index}"), item, values);
            }
        }
        other => values.push((key.to_owned(), other.to_string())),
    }
}

/// Returns the unit in the name of `key`; empty if there is none.
fn unit_of(key: &str) -> &'static str {
    let mut names = key.split('+').next().unwrap_or_default().rsplit('.');
    let name = names.find(|name| name.parse::<usize>().is_err());
    let unit = name.and_then(Unit::from_name);
    unit.map_or("", |unit| unit.name)
}
