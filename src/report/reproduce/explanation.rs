//! The first pages: what was found, what a gyroscope does, how the report computes it, and how a time step makes a wobble.

use super::figure;
use super::numbers::{Numbers, Run, chord, with_decimals, with_digits};
use crate::engine::text::number::{fixed, significant};
use crate::report::document::{Column, Document, Text};
use std::f64::consts::TAU;

/// Says in one page what was found.
pub(super) fn summary(document: &mut Document, numbers: &Numbers) {
    document.section("In one page");
    document.paragraph(
        "A student's report [@report] computes a gyroscope with a program in MATLAB: a wheel on an axle that leans and \
         stands on its lower end. Its figures show how the upper end of the axle moves, and the report draws conclusions \
         from them.",
    );
    document.paragraph(
        "This document repeats the report's five computations with the report's own method and time steps. With each it \
         draws the *exact motion*. For this gyroscope the laws of motion have a solution in formulas, with elliptic \
         functions. They give the position at any time at once, without time steps. Where the two agree, the report saw the \
         gyroscope. Where they differ, it saw its time step.",
    );
    document.list(findings(numbers));
    document.paragraph(
        "The report's text does not fix everything that a program must know. The height of the wheel and the time step of \
         the push are *our reading*: we chose them so that the method shows what the report describes. [#open] lists all \
         such choices. With the wheel at other heights, the exact gyroscope does not wobble either ([#other-heights]).",
    );
    document.paragraph(
        "The report starts its gyroscope in two ways. In *Method 1* the wheel stands upright and is given an angular momentum \
         that is tilted, in a second run more tilted. In *Method 2* axle and angular momentum are tilted together. It is run \
         with short time steps, with long ones, and with a push.",
    );
    document.table(
        "The report's five computations: how often the body turns in a time step, at the start; by how much the height z of the axle's \
         upper end swings, by the report's method and in the exact motion; and how far the two are apart at most.",
        [
            Column::text("run"),
            Column::number("time step (s)"),
            Column::number("turns per step"),
            Column::number("z, report (mm)"),
            Column::number("z, exact (mm)"),
            Column::number("apart (mm)"),
        ],
        numbers.runs().map(|(name, run)| summary_row(name, run)),
    );
    document.paragraph(
        "The next three sections explain this with first-year mechanics. Then the document follows the report section by \
         section, and gives a verdict on each of its claims. At the end it says what the report leaves open, and how to make \
         every number and figure again.",
    );
}

fn findings(numbers: &Numbers) -> [String; 4] {
    let push = &numbers.push;
    let [swing, true_swing] =
        [push.report, push.exact].map(|it| with_digits(it.z_m.size_mm(), 3, "mm"));
    let times = with_digits(push.report.z_m.size() / push.exact.z_m.size(), 2, "");
    let turns = with_decimals(push.exact.turns_per_step, 2, "");
    let slow = &numbers.method_2_slow;
    let turn_s = slow.exact.turn_s();
    let (turn, steps) = (
        with_digits(turn_s, 4, "s"),
        with_digits(turn_s / slow.time_step_s, 4, ""),
    );
    let slower = with_digits(numbers.method_2.slower_percent(), 2, "%");
    [
        format!(
            "**The wobble in the report's last figure is made by its time step** ([#wobble-push-traces]). During and after a \
             push, the upper end of the axle rises and falls by {swing} in the report's computation. In the exact motion it \
             rises and falls by {true_swing}, {times} times less. The wheel turns {turns} times in every time step, but the \
             method applies the forces only once per step."
        ),
        "**The oscillation in its first figures is real** ([#method-1-traces]). The report takes it for an error. But if a \
         gyroscope starts with its axle at an angle to its angular momentum, the axle circles around it. This is called \
         *nutation*. The exact motion has it too."
            .to_owned(),
        format!(
            "**The gyroscope that seems to stand still does go around.** The animation of the report shows no rotation \
             around the center. But its plot shows that x and y change slowly, and that is right. One turn takes {turn}, or \
             {steps} of its short time steps: the animation was too short."
        ),
        format!(
            "**The precession, its slow turn about the vertical, is nearly right.** Even with the long time step, the upper \
             end goes around on almost the right circle, and in Method 2 a turn takes only {slower} too long."
        ),
    ]
}

fn summary_row(name: &str, run: &Run) -> [Text; 6] {
    [
        Text::plain(name),
        Text::number(&significant(run.time_step_s, 3)),
        Text::number(&fixed(run.exact.turns_per_step, 3)),
        Text::number(&fixed(run.report.z_m.size_mm(), 2)),
        Text::number(&fixed(run.exact.z_m.size_mm(), 2)),
        Text::number(&significant(1000.0 * run.most_distance_m, 2)),
    ]
}

/// Explains torque, precession and nutation.
pub(super) fn gyroscope(document: &mut Document, numbers: &Numbers) {
    let top = &numbers.top;
    document.section("What a gyroscope does");
    let mass = with_digits(top.mass_kg, 3, "kg");
    let [hub, arm] = [top.hub_m, top.arm_m].map(|length| with_digits(length, 3, "m"));
    document.paragraph(&format!(
        "The report's gyroscope is a wheel of ten equal masses, {mass} in all, on an axle without mass. The lower end of \
         the axle, the *foot*, is fixed. The wheel is {hub} up the axle. The upper end, whose path the figures show, is at \
         {arm}. The axle leans by the *tilt* $θ$ from the vertical, in Method 2 at first to the side of negative y. (A wheel \
         on such an axle is also called a top.)"
    ));
    document.paragraph(
        "**Precession.** The wheel spins, so it has an angular momentum $L$ along the axle. The weight $M g$ acts at the \
         center of the wheel, at the distance $h$ from the foot, and has the torque $M g h sin θ$ about the foot. A torque \
         is the rate at which $L$ changes. This one is horizontal and at right angles to $L$. It does not make $L$ longer or \
         shorter; it turns $L$ about the vertical. The tip of the arrow $L$ moves on a circle of the radius $L sin θ$, with \
         the speed $M g h sin θ$. So it goes around at the rate",
    );
    document.formula("Ω_p = (M g h sin θ) / (L sin θ) = M g h / L");
    let torque = with_digits(top.weight_torque(), 4, "N m");
    let momentum = with_digits(top.momentum, 4, "J s");
    let rate = with_digits(top.precession(), 3, "rad/s");
    let turn = with_digits(TAU / top.precession(), 4, "s");
    document.paragraph(&format!(
        "The tilt cancels. With $M g h =$ {torque} and the $L =$ {momentum} of Method 2 (J s is kg m²/s), the rate is {rate}, and one turn \
         takes {turn}. A faster spin makes the precession slower, because $L$ is in the denominator."
    ));
    nutation(document, numbers);
}

fn nutation(document: &mut Document, numbers: &Numbers) {
    let top = &numbers.top;
    let inertia = with_digits(top.across, 3, "kg m2");
    let spin = with_digits(top.spin_s(), 3, "s");
    document.paragraph(&format!(
        "**Nutation.** If the axle does not point exactly along $L$, it circles $L$ on a narrow cone, while $L$ itself \
         hardly moves. One round takes $2 π I/L$, where $I$ is the moment of inertia about an axis across the axle. A turn of \
         the wheel takes $2 π I_3/L$, with the moment of inertia $I_3$ about the axle. With the height of the wheel that we \
         chose, both are the same, {inertia}. So the axle makes one round per turn of the wheel. In Method 2 that takes \
         {spin}. Once per round, the upper end of the axle rises and falls."
    ));
    let swing = with_decimals(numbers.method_2.exact.z_m.size_mm(), 2, "mm");
    document.paragraph(&format!(
        "How wide the cone is depends on the start. Method 2 lets the gyroscope go with the axle along $L$. The axle begins to \
         fall, is turned aside at once, and circles, while $L$ moves on: together this is a chain of tiny arcs. The upper end \
         rises and falls by only {swing}, because $L$ is large. The textbooks have the full theory [@goldstein]."
    ));
}

/// Explains the report's method.
pub(super) fn method(document: &mut Document, numbers: &Numbers) {
    let run = &numbers.method_2;
    document.section("How the report computes it");
    document.paragraph(
        "The report knows the positions of the masses and the angular momentum $L$ at one time, and computes them a *time \
         step* $Δt$ later:",
    );
    document.numbered_list([
        "From the positions it computes the inertia tensor $I$, which says how hard the body is to turn about each axis. From \
         $L = I Ω$ it computes the angular velocity $Ω$: the axis about which the body turns now, and how fast.",
        "It turns all masses about the direction of $Ω$ by the angle $ψ = |Ω| Δt$.",
        "From the new positions it computes the torque $τ$ of the weight.",
        "It adds $τ Δt$ to $L$. Then the next step begins.",
    ]);
    let psi = with_digits(TAU * run.exact.turns_per_step, 4, "rad");
    let turns = with_decimals(run.exact.turns_per_step, 2, "");
    document.paragraph(&format!(
        "So the program turns the body as if no torque acted during the step. Then it changes $L$ all at once, as by a *kick*. \
         In nature the torque acts all the time, while the wheel turns. The difference is small if $ψ$ is small. With the report's long time step, 0.1 s, $ψ$ is {psi}: \
         the wheel turns {turns} times between two kicks."
    ));
}

/// Explains how a time step makes a wobble.
pub(super) fn sampling(document: &mut Document, numbers: &Numbers) {
    document.section("How a time step makes a wobble");
    looks(document, numbers);
    kicks(document, numbers);
    offset(document, numbers);
    let turns = numbers.method_2.exact.turns_per_step;
    let (all_turns, number) = (
        with_decimals(turns, 2, ""),
        with_digits(turns.round(), 2, ""),
    );
    figure(
        document,
        ["comb"],
        &format!(
            "How far the tilt swings in Method 2, computed with many different time steps. The axis below counts how often \
             the wheel turns per step. Points: the report's method. Solid: twice the offset by the formula above, where it \
             holds. Dashed: the exact motion. The report's long time step, {all_turns} turns, is close to peak number \
             {number}. The scale of the swing is logarithmic. The height of a peak only says how near the time step of a point comes to a whole number of \
             turns."
        ),
    );
    document.subsection("How to find out");
    document.paragraph(
        "One need not know the theory to find such a wobble. *Halve the time step and compute again, until nothing changes \
         any more.* What belongs to the gyroscope stays. What belongs to the time step changes. [#push-finer], in the section \
         on the push, does this. As a rule, the body should turn by about a tenth of a turn per step, or less.",
    );
}

fn looks(document: &mut Document, numbers: &Numbers) {
    document.subsection("Looking at a circle now and then");
    let run = &numbers.method_2;
    let turns = run.exact.turns_per_step;
    let missing = turns.round() - turns;
    let all_turns = with_decimals(turns, 2, "");
    let part = with_digits(missing, 2, "");
    let count = with_digits(1.0 / missing, 2, "");
    document.paragraph(&format!(
        "Paint a spot on a wheel, and look at it only now and then. If the wheel turns {all_turns} times between two looks, \
         whole turns are not seen. The spot seems to have gone *back* by {part} of a turn. After {count} looks it seems to \
         have gone around once, slowly and backward. In films, the wheels of a coach seem to turn backward for the same \
         reason. The slow turn is not in the wheel. It is made by looking too rarely. [#sampling] shows it for a real run."
    ));
    figure(
        document,
        ["sampling"],
        "A circle, seen too rarely. Dashed: x of the upper end of the axle in Method 1 without weight, which circles about 100 \
         times in a second. Solid: the same, looked at after every 0.9 of a round, and the looks joined by straight lines. x \
         seems to swing nine times as slowly.",
    );
    let slow = with_digits(run.time_step_s / missing, 2, "s");
    let seen = with_digits(run.report.nutation_s, 3, "s");
    let real = with_digits(numbers.top.spin_s(), 3, "s");
    document.paragraph(&format!(
        "With its long time step, the report looks at its gyroscope every 0.1 s. The axle needs {real} for a round, so it \
         makes {all_turns} rounds between two looks. What is seen is a round in about {slow}. And so it is: in the report's \
         computation, the height swings with a period of {seen}."
    ));
}

fn kicks(document: &mut Document, numbers: &Numbers) {
    let turns = numbers.method_2.exact.turns_per_step;
    let all_turns = with_decimals(turns, 2, "");
    let half = with_digits((0.5 / (turns.round() - turns)).round(), 2, "");
    document.subsection("Kicks in time");
    document.paragraph(&format!(
        "Looking too rarely makes the swing slow, but not large. It is large because the method also *kicks* too rarely. \
         Think of a child on a swing. Many small pushes at random moments cancel: some are with the motion, some against it. \
         Pushes at the same moment of every swing add up. The weight of a real gyroscope acts all the time, at all places of \
         the small circle of the axle. Its effects on this circle cancel, and what remains is the precession. In the program \
         there is one kick per step. Between two kicks the axle makes {all_turns} rounds, nearly a whole number. Every kick \
         finds the axle at almost the same place of its circle, and the kicks add up. After about {half} steps the place is \
         the opposite one, and the next kicks undo what the first ones did. So the swing grows and shrinks again and again."
    ));
}

/// Compares the offset of the axle from L by the method with the true one. Readouts call it the lag.
fn offset(document: &mut Document, numbers: &Numbers) {
    let (lag, run) = (&numbers.lag, &numbers.method_2);
    let kick_deg = numbers.top.kick_deg(run.time_step_s);
    let kick = with_digits(kick_deg, 3, "deg");
    document.paragraph(&format!(
        "How large is the swing? A kick turns $L$ by the angle $δ = |τ| Δt/L$, here {kick}. The axle can go \
         around with $L$ without swinging, if it leans away from $L$ by one small angle $r$, the *offset*. Seen from $L$, the \
         tip of the axle is a point on a circle of radius $r$. In a step it goes around by $ψ$, and ends at the distance \
         $2 r |sin(ψ/2)|$ from where it was. The kick moves $L$, the center of the circle, by $δ$. If the two moves are \
         equal, the offset does not change:"
    ));
    document.formula("r = δ / (2 |sin(ψ/2)|)");
    let sine = with_digits(chord(run.exact.turns_per_step), 3, "");
    let true_offset_deg = kick_deg / (TAU * run.exact.turns_per_step);
    let [offset_deg, true_offset] =
        [lag.offset_deg, true_offset_deg].map(|angle| with_digits(angle, 2, "deg"));
    let [predicted, found] =
        [lag.predicted_swing_deg, lag.swing_deg].map(|swing| with_digits(swing, 3, "deg"));
    let swing = with_digits(run.report.z_m.size_mm(), 3, "mm");
    document.paragraph(&format!(
        "If $ψ$ is small, the distance is $r ψ$, and the offset is the true one, $δ/ψ$. If $ψ$ is a whole number of turns, the \
         sine is zero, and the offset grows without limit. With the report's long time step, $2 |sin(ψ/2)|$ is {sine}, and \
         the offset is {offset_deg}. The true one is {true_offset}. Method 2 begins without an offset, so its axle swings \
         about this position, from no offset to twice the offset: by {predicted} after this formula, and by {found}, or \
         {swing} in height, in the run. In the exact motion the offset is downward. In the program it is upward: just below a \
         whole number of turns, each step looks like a small turn backward, so the same kick needs the offset on the other \
         side."
    ));
}
