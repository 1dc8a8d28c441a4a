//! What the report leaves open, and how we read it; and the files of the folder.

use super::made::{FIGURES, Made};
use super::numbers::{Numbers, with_digits};
use crate::engine::text::number::significant;
use crate::report::document::{Block, Column, Document, Table, Text};

/// Adds the questions that the report leaves open, each with our answer and its reason.
pub(super) fn open_questions(document: &mut Document, numbers: &Numbers) {
    let top = &numbers.top;
    let hub = with_digits(top.hub_m, 6, "m");
    let [along, across] = [top.along, top.across].map(|moment| with_digits(moment, 3, "kg m2"));
    document.section("What the report leaves open");
    document.paragraph(
        "The report does not say everything that a program must know. [#open] lists the questions, our answers, and why we \
         chose them. Four of the answers decide what the runs show: the height of the wheel, the unit matrix E, the time step \
         of the push, and that its force does not add up. We chose them so that the method shows what the report describes. \
         The others change the numbers, but not the findings.",
    );
    let rows = [
        (
            "How high on the axle is the wheel, and how long is the axle?",
            format!("The hub is at {hub}, the radius divided by √2; the axle is twice as long."),
            format!(
                "The body then has the same moment of inertia along and across the axle ({along}, {across}). Only then does \
                 the report's method make the nutation neither smaller nor larger, and show what the report describes: an axle that \
                 comes back upright again and again, a circle that is almost nice, and a wobble that is periodic and lasts. \
                 We tried other heights, masses on the axle, and other readings of the formulas: only bodies with equal \
                 moments show all of it."
            ),
        ),
        (
            "Which are the 14 points of its program?",
            "1 to 10 are the masses, 11 the hub, 12 the upper end of the axle, 13 the foot, 14 the middle between foot and hub. The last four have no mass.".to_owned(),
            "The push acts on point 12, \"the axis top\". Ten masses of 0.5 kg are the report's \"sum of mass = 5 kg\".".to_owned(),
        ),
        (
            "About which point are the moments taken?",
            "About the foot.".to_owned(),
            "The report fixes \"the bottom of axis (center of spinning) at (0,0,0)\". Its remark that the center of mass is there too cannot be: it is the hub.".to_owned(),
        ),
        (
            "Section 3 prints the inertia tensor without the unit matrix E. Which formula is meant?",
            "With E, as in equation (2) of section 2.".to_owned(),
            "Without E the formula is not the inertia tensor, and no height of the wheel gives what the report shows.".to_owned(),
        ),
        (
            "What is L of Method 1 in its more tilted form?",
            "(800, 0, 2000) J s.".to_owned(),
            "The report says only that the part along x is increased.".to_owned(),
        ),
        (
            "What is the time step of Method 1?",
            "0.001 s.".to_owned(),
            "The report introduces 1e-3 in Method 2 as \"without changing time dt\".".to_owned(),
        ),
        (
            "How long do its runs last?",
            "2 s, 10 s and 230 s.".to_owned(),
            "Long enough for what the report describes.".to_owned(),
        ),
        (
            "With which time step does it push?",
            "0.1 s.".to_owned(),
            "The report uses 0.001 s and 0.1 s, and does not say which one here. With 0.001 s there is no wobble that a figure can show, and the report shows one.".to_owned(),
        ),
        (
            "Is t in the condition of the push the time at the beginning or at the end of the step?",
            "At the end: the push acts on the steps 1 to 200.".to_owned(),
            "The other reading moves the push by one step, which is not seen.".to_owned(),
        ),
        (
            "Is the force built anew in each step?",
            "Yes.".to_owned(),
            "Otherwise the line F = F − 100 would add up to 20 000 N and topple the gyroscope. (`gyrolab run wobble-push-accumulating` shows it.)".to_owned(),
        ),
    ];
    document.blocks.push(Block::Table(Table {
        label: Some("open".to_owned()),
        caption: Text::plain("Questions that the report leaves open."),
        columns: ["question", "our answer", "why"].map(Column::text).into(),
        rows: rows
            .into_iter()
            .map(|(question, answer, why)| {
                vec![
                    Text::plain(question),
                    Text::marked(&answer),
                    Text::marked(&why),
                ]
            })
            .collect(),
    }));
    other_heights(document, numbers);
}

/// Says that the wobble of the push does not depend on the height of the wheel.
fn other_heights(document: &mut Document, numbers: &Numbers) {
    document.paragraph(
        "Does the wobble depend on the height of the wheel that we chose? [#other-heights] has the push with four others. In \
         the exact motion the swing of z is small at every height. In the report's method with its long time step it is large \
         at every height. If the wheel is low, the method makes the nutation larger even with the short time step, until \
         the wheel tips over and its upper end hangs below the foot: there a short time step alone is not enough. If the \
         wheel is high, the method makes the nutation smaller.",
    );
    let rows = numbers.heights.iter().map(|wheel| {
        let swings = [wheel.z_m, wheel.finer_z_m, wheel.exact_z_m];
        let cells = swings.map(|z_m| Text::number(&significant(z_m.size_mm(), 3)));
        let height = Text::number(&significant(wheel.height_m, 3));
        [vec![height], cells.to_vec()].concat()
    });
    document.blocks.push(Block::Table(Table {
        label: Some("other-heights".to_owned()),
        caption: Text::plain(
            "The push with the wheel at other heights: by how much z of the axle's upper end swings.",
        ),
        columns: [
            "height (m)",
            "report, 0.1 s (mm)",
            "report, 0.001 s (mm)",
            "exact (mm)",
        ]
        .map(Column::number)
        .into(),
        rows: rows.collect(),
    }));
}

/// Says what is in the folder, and how to make it again.
pub(super) fn files(document: &mut Document) {
    document.section("This folder, and how to make it again");
    document.paragraph(
        "gyrolab wrote every file of this folder. The words are part of the program. The numbers and figures were computed \
         when it ran:",
    );
    document.code("sh", "gyrolab reproduce -o FOLDER\ngyrolab verify FOLDER");
    document.paragraph(
        "The second command computes everything again, and says of each file whether it is the same. This page is also in \
         `report.tex`, with `refs.bib`, for pdflatex. In the folder `data` are \
         the five runs step by step and the tables of numbers, as CSV. In `figures` are the figures as SVG and PDF. \
         `claims.json` has the claims for a program. Each figure is drawn by a command of its own:",
    );
    let commands: Vec<String> = FIGURES.iter().map(Made::command).collect();
    document.code("sh", &commands.join("\n"));
    document.paragraph(
        "`gyrolab wobble-push` opens the push in a lab in the terminal, where the time step can be changed while it runs. \
         `gyrolab lesson is-the-wobble-real` is a lesson about it.",
    );
}
