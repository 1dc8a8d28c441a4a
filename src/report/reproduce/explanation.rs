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
         draws the *exact motion*. For this gyroscope the laws of motion can be solved in formulas, with elliptic functions, so \
         that no time step is needed. Where the two agree, the report saw the gyroscope. Where they differ, it saw its time \
         step.",
    );
    document.list(findings(numbers));
    document.table(
        "The report's five computations: how often the wheel turns in a time step; by how much the height z of the axle's \
         upper end swings, by the report's method and in the exact motion; and how far the two are apart at most.",
        [
            Column::text("run"),
            Column::number("time step (s)"),
            Column::number("turns per step"),
            Column::number("swing, report (mm)"),
            Column::number("swing, exact (mm)"),
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
        with_digits(turn_s / slow.time_step_s, 3, ""),
    );
    let slower = with_digits(numbers.method_2.slower_percent(), 2, "%");
    [
        format!(
            "**The wobble in the report's last figure is made by its time step** ([#wobble-push-traces]). After a push, the upper end of the axle \
             rises and falls by {swing} in the report's computation. In the exact motion it rises and falls by {true_swing}, \
             {times} times less. The wheel turns {turns} times in every time step, and the method takes no account of what \
             happens meanwhile."
        ),
        "**The oscillation in its first figures is real** ([#method-1-traces]). The report takes it for an error. It is the nutation of a top \
         that starts with its axle at an angle to its angular momentum. The exact motion has it too."
            .to_owned(),
        format!(
            "**The top that seems to stand still does precess.** One turn takes {turn}, or {steps} of the report's short \
             time steps. The report stopped long before."
        ),
        format!(
            "**The precession is nearly right.** Even with the long time step, the upper end goes around on almost the right \
             circle, and a turn takes only {slower} too long."
        ),
    ]
}

fn summary_row(name: &str, run: &Run) -> [Text; 6] {
    [
        Text::plain(name),
        Text::number(&significant(run.time_step_s, 3)),
        Text::number(&fixed(run.exact.turns_per_step, 3)),
        Text::number(&significant(run.report.z_m.size_mm(), 3)),
        Text::number(&significant(run.exact.z_m.size_mm(), 3)),
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
         {arm}. The axle leans by the *tilt* $θ$ from the vertical."
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
        "The tilt cancels. With $M g h =$ {torque} and the $L =$ {momentum} of Method 2, the rate is {rate}, and one turn \
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
         hardly moves. One round takes $2 π I/L$, where $I$ is the moment of inertia about an axis across the axle. This \
         body has the same moment of inertia about every axis through the foot, {inertia}. So one round takes exactly as \
         long as one turn of the wheel. In Method 2 that is {spin}. The upper end of the axle rises and falls once per round."
    ));
    let swing = with_decimals(numbers.method_2.exact.z_m.size_mm(), 2, "mm");
    document.paragraph(&format!(
        "How wide the cone is depends on the start. Method 2 lets the top go with the axle along $L$. The axle begins to \
         fall, is turned aside at once, and moves on in a chain of tiny arcs. Its upper end rises and falls by {swing}: the \
         spin is fast, and $L$ is large. The textbooks have the full theory [@goldstein]."
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
        "In steps 2 and 4 the program treats as constant what is not. It turns the body as if no torque acted meanwhile. \
         Then it adds the torque of a whole time step at once, like a kick. In nature the torque acts all the time, while \
         the wheel turns. The difference is small if $ψ$ is small. With the report's long time step, 0.1 s, $ψ$ is {psi}: \
         the wheel turns {turns} times between two kicks."
    ));
}

/// Explains how a time step makes a wobble.
pub(super) fn sampling(document: &mut Document, numbers: &Numbers) {
    document.section("How a time step makes a wobble");
    document.subsection("Looking at a circle now and then");
    let run = &numbers.method_2;
    let turns = run.exact.turns_per_step;
    let missing = turns.round() - turns;
    let all_turns = with_decimals(turns, 2, "");
    let part = with_digits(missing, 2, "");
    let looks = with_digits(1.0 / missing, 2, "");
    document.paragraph(&format!(
        "Paint a spot on a wheel, and look at it only now and then. If the wheel turns {all_turns} times between two looks, \
         whole turns are not seen. The spot seems to have gone *back* by {part} of a turn. After {looks} looks it seems to \
         have gone around once, slowly and backward. In films, the wheels of a coach seem to turn backward for the same \
         reason. The slow turn is not in the wheel. It is made by looking too rarely. [#sampling] shows it for a real run."
    ));
    figure(
        document,
        ["sampling"],
        "A point on a circle, seen too rarely. Dashed: a coordinate of the upper end of the axle in Method 1 without weight, \
         which circles about 100 times in a second. Black: the same, looked at after every 0.9 of a round. The points seem \
         to lie on a circle that is nine times slower.",
    );
    let slow = with_digits(run.time_step_s / missing, 2, "s");
    let seen = with_digits(run.report.nutation_s, 3, "s");
    let real = with_digits(numbers.top.spin_s(), 3, "s");
    document.paragraph(&format!(
        "With its long time step, the report looks at its gyroscope every 0.1 s. The axle needs {real} for a round, so it \
         makes {all_turns} rounds between two looks. What is seen is a round in about {slow}. And so it is: in the report's \
         computation, the height swings with a period of {seen}."
    ));
    document.subsection("Kicks in time");
    document.paragraph(&format!(
        "Looking too rarely changes only the picture. But the method also *kicks* too rarely. Think of a child on a swing. \
         Many small pushes at random moments cancel: some are with the motion, some against it. Pushes at the same moment of \
         every swing add up. The weight of a real top pushes all the time, at all places of the small circle of the axle, \
         and its pushes cancel. In the program there is one kick per step. Between two kicks the axle makes {all_turns} \
         rounds, nearly a whole number. Every kick finds the axle at almost the same place of its circle, and the kicks add \
         up."
    ));
    lag(document, numbers);
    let number = with_digits(turns.round(), 2, "");
    figure(
        document,
        ["comb"],
        &format!(
            "How far the tilt swings in Method 2, computed with many different time steps. The axis below counts how often \
             the wheel turns per step. Points: the report's method. Solid: the formula above, where it holds. Dashed: the \
             exact motion. The report's long time step, at {all_turns} turns, is just before peak number {number}."
        ),
    );
    document.subsection("How to find out");
    document.paragraph(
        "One need not know the theory to find such a wobble. *Halve the time step and compute again, until nothing changes \
         any more.* What belongs to the gyroscope stays. What belongs to the time step changes. [#push-finer], in the section \
         on the push, does this. To be safe, the wheel should make less than a tenth of a turn per step.",
    );
}

/// Compares the lag of the axle behind L by the method with the true one.
fn lag(document: &mut Document, numbers: &Numbers) {
    let (lag, run) = (&numbers.lag, &numbers.method_2);
    let kick = with_digits(numbers.top.kick_deg(run.time_step_s), 3, "deg");
    document.paragraph(&format!(
        "How large is the wobble? A kick turns $L$ by the angle $δ = |τ| Δt/L$, which is {kick} here. The axle follows $L$ \
         around, but not exactly: it stays behind by an angle, the *lag*. In the exact motion the lag is $δ/ψ$. In the \
         program, the axle stays at the same distance from $L$ only if a turn by $ψ$ and a kick cancel. This needs the lag"
    ));
    document.formula("δ / (2 |sin(ψ/2)|)");
    let sine = with_digits(chord(run.exact.turns_per_step), 2, "");
    let psi = TAU * run.exact.turns_per_step;
    let true_lag = numbers.top.kick_deg(run.time_step_s) / psi;
    let [lag_of_scheme, true_lag_text] =
        [lag.lag_deg, true_lag].map(|angle| with_digits(angle, 2, "deg"));
    let [predicted, found] =
        [lag.predicted_swing_deg, lag.swing_deg].map(|swing| with_digits(swing, 3, "deg"));
    document.paragraph(&format!(
        "If $ψ$ is a whole number of turns, the sine is zero, and the lag grows without limit. With the report's long time \
         step, $2 |sin(ψ/2)|$ is {sine}. The lag is then {lag_of_scheme}, and the true one is {true_lag_text}. Method 2 begins \
         without a lag. Its axle therefore swings about this lag, by twice as much: {predicted} by this formula, and {found} \
         in the run."
    ));
}
