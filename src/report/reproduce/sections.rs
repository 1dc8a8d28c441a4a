//! The report section by section: each set-up, its figures, and what they show.

use super::figure;
use super::numbers::{Both, Finer, Numbers, TILTS_DEG, with_decimals, with_digits};
use crate::engine::text::number::{fixed, significant};
use crate::report::document::{Block, Column, Document, Table, Text};
use std::f64::consts::TAU;

pub(super) fn sections(document: &mut Document, numbers: &Numbers) {
    document.section("The report, section by section");
    document.paragraph(
        "The report's own figures are lost. Its text says what they showed: the coordinates of the axle's upper end over \
         time, and its path in space. In the figures here, the solid line is the report's method with the report's time \
         step. The dashed line is the exact motion. What is set off is quoted from the report; [...] marks words that are left \
         out.",
    );
    first_sections(document, numbers);
    method_1(document, numbers);
    more_tilted(document, numbers);
    short_steps(document, numbers);
    long_steps(document, numbers);
    push(document, numbers);
    push_finer(document, numbers);
    slow_tops(document, numbers);
    conclusions(document, numbers);
}

fn first_sections(document: &mut Document, numbers: &Numbers) {
    document.subsection("Sections 1 to 3: the model");
    document.paragraph(
        "The report derives the laws that it uses: a torque is the rate of change of the angular momentum, $L = I Ω$, and \
         $I$ is a sum over the masses. They are right. One sentence of section 1 is not: the weight does not *sustain* the \
         rotation (claim 1 in [#claims]). A wheel without friction spins on by itself. The weight makes it precess.",
    );
    let inertia = with_digits(numbers.top.along, 2, "kg m2");
    let momentum = with_digits(numbers.top.along * TAU, 3, "J s");
    document.paragraph(&format!(
        "Section 3 chooses the numbers: ten masses of 0.5 kg, a radius of 0.8 m, one turn per second. This gives $I =$ \
         {inertia} and $L =$ {momentum}, which the report rounds to 3 and 20. Then it multiplies $L$ by 100, \"for \
         simulated object to move faster\". The wheel does turn 100 times as fast. But the precession becomes 100 times \
         slower (claim 2). This is why Method 2 later seems to stand still."
    ));
}

fn method_1(document: &mut Document, numbers: &Numbers) {
    let run = &numbers.method_1;
    document.subsection("Section 4, Method 1");
    let lag = with_digits(run.start_lag_deg, 3, "deg");
    document.paragraph(&format!(
        "*Set-up.* The body stands upright. Its angular momentum is $L = (400, 0, 2000)$ J s, at an angle of {lag} to the \
         axle. The time step is 0.001 s."
    ));
    document.quote(
        "The spinning trace is restricted to the positive x domain. [...] There is an angle between the angular momentum and \
         axis, this will cause difference between the matlab simulation and real physics phenomenon. [...] The axis top is not \
         stable as it has a little oscillation in the z direction as well.",
    );
    let round = with_digits(run.report.nutation_s * 1000.0, 3, "ms");
    let swing = with_digits(run.report.z_m.size_mm(), 3, "mm");
    document.paragraph(&format!(
        "The axle circles $L$ on a cone. It is upright at the start and after every round, {round} later. In between it \
         leans to the other side of $L$, and its upper end is {swing} lower. This is the oscillation in z. It is the \
         nutation, and real physics: the exact motion has it too. In [#method-1-traces] the two lines cannot be told apart."
    ));
    figure(
        document,
        ["method-1-traces", "method-1-3d"],
        "Method 1, the first 0.1 s: the coordinates of the axle's upper end, and its path in space. The end goes around ten times on the same circle.",
    );
    let later = numbers.later_x_m.report.markup(3);
    document.paragraph(&format!(
        "The trace stays at positive x only at first, because $L$ points to positive x. But the weight turns $L$ about the vertical, as it does with any top. After half a turn $L$ points \
         to negative x, and so does the trace: x runs from {later} m ([#method-1-longer])."
    ));
    figure(
        document,
        ["method-1-longer"],
        "Method 1 for 480 s, about one turn of the precession. Left: the rounds are too fast to be told apart, so the area \
         between the least and the greatest x is filled. Right: the first of them.",
    );
}

fn more_tilted(document: &mut Document, numbers: &Numbers) {
    let [before, run] = [&numbers.method_1, &numbers.method_1_steeper];
    document.subsection("Section 4, Method 1, more tilted");
    document.paragraph(
        "*Set-up.* The same with \"a more tilted angular moment\". The report gives no numbers. We take \
         $L = (800, 0, 2000)$ J s.",
    );
    document.quote(
        "The results show more change in both x,y and z position for same time, means the gyro spinning faster and therefore \
         result more error in z position. The circular trace becomes larger since we decrease the angle.",
    );
    let [tilt, tilt_before] =
        [run, before].map(|run| with_digits(run.report.highest_tilt_deg, 3, "deg"));
    let [swing, swing_before] =
        [run, before].map(|run| with_digits(run.report.z_m.size_mm(), 3, "mm"));
    document.paragraph(&format!(
        "The circle is larger: the axle leans by up to {tilt} instead of {tilt_before}, and z swings by \
         {swing} instead of {swing_before}. Again this is the nutation, and no error."
    ));
    let faster = 100.0 * (run.report.momentum / before.report.momentum - 1.0);
    let faster = with_digits(faster, 2, "%");
    let spin = with_digits(run.report.spin_rpm, 4, "rpm");
    document.paragraph(&format!(
        "That it spins faster is half right. $L$ is longer by {faster}, and the body turns faster by as much. Its \
         spin about the axle is the same in both runs, {spin}."
    ));
    figure(
        document,
        ["method-1-steeper-traces", "method-1-steeper-3d"],
        "Method 1, more tilted, the first 0.1 s: the coordinates of the axle's upper end, and its path in space.",
    );
}

fn short_steps(document: &mut Document, numbers: &Numbers) {
    let run = &numbers.method_2_slow;
    document.subsection("Section 4, Method 2, time step 0.001 s");
    let momentum = with_digits(numbers.top.momentum, 4, "J s");
    let tilt = with_digits(numbers.top.tilt_rad.to_degrees(), 3, "deg");
    let duration = with_digits(run.duration_s, 3, "s");
    document.paragraph(&format!(
        "*Set-up.* Body and angular momentum are tilted together by {tilt}, with $L =$ {momentum} along the axle. The report \
         does not say how long it ran. We take {duration}."
    ));
    document.quote(
        "We can observe no change in the z direction. [...] The animation appears only rotation around the axis but no \
         rotation around the center. The plot below implies xy position are still changing but in an extreme slow rate. So we \
         need to decrease the time step to speed up animation.",
    );
    let around = with_digits(run.goes_around_deg(&run.report), 3, "deg");
    let turn = with_digits(run.report.turn_s(), 4, "s");
    let steps = with_digits(run.report.turn_s() / run.time_step_s, 3, "");
    document.paragraph(&format!(
        "The plot was right: x and y do change. In {duration} the axle goes around the center by {around}. A whole turn takes \
         {turn}, or {steps} steps. Nothing is wrong with this time step. The animation ended too soon."
    ));
    let swing = with_decimals(run.report.z_m.size_mm(), 2, "mm");
    document.paragraph(&format!(
        "The height does change. z swings by {swing}, and so does the exact motion. It is the nutation. The scale of z in the \
         figures is stretched so that it can be seen."
    ));
    figure(
        document,
        ["method-2-slow-traces"],
        "Method 2 with the time step 0.001 s: the coordinates of the axle's upper end. Left: 10 s. Right: the beginning. \
         Where z swings too fast to be seen on the left, two lines are its least and its greatest value.",
    );
    figure(
        document,
        ["method-2-slow-3d"],
        "Method 2 with the time step 0.001 s, the first 0.2 s: the path of the axle's upper end in space. The axle falls, is \
         turned aside, rises and stops, and falls again.",
    );
}

fn long_steps(document: &mut Document, numbers: &Numbers) {
    let run = &numbers.method_2;
    document.subsection("Section 4, Method 2, time step 0.1 s");
    let duration = with_digits(run.duration_s, 3, "s");
    let longer = with_digits(run.time_step_s / numbers.method_2_slow.time_step_s, 3, "");
    document.paragraph(&format!(
        "*Set-up.* The same with a time step of 0.1 s. We run it for {duration}, about one turn."
    ));
    document.quote(
        "After shrinking the time step (dt=1e-1) we have the following result. The animation looks more smooth and natural as \
         the trace is almost a nice circle and the change of height is almost a constant shown by a straight line. And the \
         spinning rate around the axis is faster than the spinning rate around the center.",
    );
    let [turn, true_turn] = [run.report, run.exact].map(|it| with_digits(it.turn_s(), 4, "s"));
    let slower = with_digits(run.slower_percent(), 2, "%");
    document.paragraph(&format!(
        "The report calls this shrinking, but it has made the time step {longer} times longer. The trace is almost a nice \
         circle, and the circle is the gyroscope's. A turn takes {turn}. In the exact \
         motion it takes {true_turn}, so the report's is {slower} too long."
    ));
    let [swing, true_swing] =
        [run.report, run.exact].map(|it| with_digits(it.z_m.percent(), 2, "%"));
    document.paragraph(&format!(
        "The height is not quite constant: it swings by {swing}. In the exact motion it swings by {true_swing}. Here the time \
         step begins to show. This is the swing about the lag that was computed above."
    ));
    figure(
        document,
        ["method-2-traces"],
        "Method 2 with the time step 0.1 s: the coordinates of the axle's upper end. The scale of z is stretched.",
    );
    figure(
        document,
        ["method-2-3d"],
        "Method 2 with the time step 0.1 s: the path of the axle's upper end in space. The scale of z is stretched.",
    );
}

fn push(document: &mut Document, numbers: &Numbers) {
    let run = &numbers.push;
    document.subsection("Section 4, the push");
    document.paragraph(
        "*Set-up.* Method 2 with the time step 0.1 s. During the first 200 steps, 20 s, a force of 100 N presses the upper \
         end of the axle straight down.",
    );
    document.quote(
        "In this plot, we can see the wobble in z direction is periodic; the radius of the circle in the trace is increasing as \
         the height of the axis is dropping showing there is an error.",
    );
    let [z, true_z] = [run.report, run.exact].map(|it| it.z_m.markup(4));
    document.paragraph(&format!(
        "In the report's computation, z runs from {z} m. In the exact \
         motion it runs from {true_z} m, which is a straight line in [#wobble-push-traces]. The push makes the exact top go \
         around faster as long as it lasts. It does not make it wobble."
    ));
    figure(
        document,
        ["wobble-push-traces"],
        "The push, time step 0.1 s: the coordinates of the axle's upper end.",
    );
    figure(
        document,
        ["wobble-push-3d"],
        "The push, time step 0.1 s: the path of the axle's upper end in space. The scale of z is stretched.",
    );
    let torque = with_digits(numbers.push_torque, 2, "");
    let [turns, later_turns] =
        [run.exact, run.report].map(|it| with_decimals(it.turns_per_step, 2, ""));
    document.paragraph(&format!(
        "Why so large? Weight and push together have {torque} times the torque of the weight. So the kicks, the lag and the \
         swing about it are {torque} times as large as before. Such a large swing also changes the spin in the computation, \
         which in truth stays the same: at the end the wheel turns {later_turns} times per step, and not {turns} times. On \
         the way it passes a whole number of turns."
    ));
    let length = numbers.length_m.markup(6);
    document.paragraph(&format!(
        "That the radius grows as the height drops is no error. The axle is rigid, so its upper end keeps its distance from the foot: in all rows of the \
         run, $√(x^2 + y^2 + z^2)$ runs from {length} m. Whoever lowers the end of a leaning pole moves it outward. In every \
         swing the radius grows while the height drops, and shrinks while it rises."
    ));
}

fn push_finer(document: &mut Document, numbers: &Numbers) {
    let [_, second, third, ..] = &numbers.finer;
    let [second_s, third_s] = [second, third].map(|it| with_digits(it.time_step_s, 2, "s"));
    let [second_turns, third_turns] =
        [second, third].map(|it| with_digits(it.turns_per_step, 2, ""));
    let true_from = numbers.finer.iter().find(|it| it.is_true());
    let true_from = true_from.map_or(f64::NAN, |it| it.time_step_s);
    let true_from = with_digits(true_from, 2, "s");
    document.paragraph(&format!(
        "The wobble does not survive a shorter time step. [#push-finer] has the same push, 20 s long, with seven of them. At \
         {second_s} the wheel turns {second_turns} times per step. Kicks then meet the axle on opposite sides of its circle \
         and cancel, and the wobble is small. At {third_s} the wheel turns about {third_turns} times per step, a whole \
         number, and the wobble is back. From {true_from} on, z swings no more than in the exact motion, or hardly more."
    ));
    document.blocks.push(Block::Table(Table {
        label: Some("push-finer".to_owned()),
        caption: Text::marked(
            "The push with shorter and shorter time steps: the turns of the wheel per step at the end of the run, by how \
             much z swings, and how far the report's method is from the exact motion at most.",
        ),
        columns: vec![
            Column::number("time step (s)"),
            Column::number("turns per step"),
            Column::number("swing, report (mm)"),
            Column::number("swing, exact (mm)"),
            Column::number("apart (mm)"),
        ],
        rows: numbers.finer.iter().map(finer_row).collect(),
    }));
    let z = numbers.push.report.z_m.markup(2);
    figure(
        document,
        ["wobble-push-finer"],
        &format!(
            "The same push with the time step 0.002 s. At 0.1 s, z ran from {z} m. Now it stays on the dashed line."
        ),
    );
}

fn finer_row(finer: &Finer) -> Vec<Text> {
    vec![
        Text::number(&significant(finer.time_step_s, 2)),
        Text::number(&fixed(finer.turns_per_step, 3)),
        Text::number(&significant(finer.z_m.report.size_mm(), 3)),
        Text::number(&significant(finer.z_m.exact.size_mm(), 3)),
        Text::number(&significant(1000.0 * finer.most_distance_m, 2)),
    ]
}

/// Says which tops do wobble.
fn slow_tops(document: &mut Document, numbers: &Numbers) {
    document.paragraph(
        "For a real wobble the top must spin slowly. [#slow-tops] lets the top of Method 2 go with less and less angular \
         momentum, and a time step that is short enough. Then the report's method shows the true nutation, and with little \
         $L$ it is large.",
    );
    let rows = numbers.slow_tops.iter().map(|top| {
        let Both { report, exact } = top.tilt_deg;
        vec![
            Text::number(&significant(top.momentum, 4)),
            Text::number(&significant(report.size(), 3)),
            Text::number(&significant(exact.size(), 3)),
        ]
    });
    document.blocks.push(Block::Table(Table {
        label: Some("slow-tops".to_owned()),
        caption: Text::marked(
            "How far the tilt swings when the top of Method 2 is let go at 45 degrees. The time step is 0.0005 s, and the \
             runs last 10 s.",
        ),
        columns: vec![
            Column::number("$L$ (J s)"),
            Column::number("swing, report (deg)"),
            Column::number("swing, exact (deg)"),
        ],
        rows: rows.collect(),
    }));
}

fn conclusions(document: &mut Document, numbers: &Numbers) {
    document.subsection("Section 4, the last paragraph");
    document.quote(
        "Overall, our experiment shows matlab can accurately simulate the precession in physics world. [...] The larger the \
         angle from the axis to the ground the faster the precession motion is.",
    );
    document.paragraph(
        "A fast top precesses at \
         $M g h/L$ at any tilt. Looked at closely, the rate does depend on the tilt, a little for a fast top and more for a \
         slow one, and in the sense that the report gives. The report's own method shows the opposite at 0.1 s ([#tilt]): \
         the effect of its time step is larger than the true one.",
    );
    let tops = numbers.of_fast_top.iter().zip(&numbers.of_slow_top);
    let rows = TILTS_DEG.iter().zip(tops).map(|(tilt_deg, (fast, slow))| {
        let to_ground = Text::marked(&with_digits(90.0 - tilt_deg, 2, "deg"));
        let rates = [fast.report, fast.exact, slow.report, slow.exact];
        let cells = rates.map(|rate| Text::number(&fixed(rate, 6)));
        [vec![to_ground], cells.to_vec()].concat()
    });
    document.blocks.push(Block::Table(Table {
        label: Some("tilt".to_owned()),
        caption: Text::marked(
            "The precession (rad/s) at three angles from the axle to the ground. Fast: the top of Method 2, with the time \
             step 0.1 s. Slow: the same with $L =$ {40 J s}, with the time step 0.0005 s.",
        ),
        columns: vec![
            Column::text("angle to the ground"),
            Column::number("fast, report"),
            Column::number("fast, exact"),
            Column::number("slow, report"),
            Column::number("slow, exact"),
        ],
        rows: rows.collect(),
    }));
    document.paragraph(
        "Is the simulation accurate? For the precession it nearly is. For the wobble it is not. No figure of the report could have shown the \
         difference: that takes a second run with a shorter time step, or the exact motion.",
    );
}
