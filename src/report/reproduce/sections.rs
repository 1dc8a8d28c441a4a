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
         time, and its path in space. In the figures here, the report's method with the report's time step (\"the report's \
         scheme\") is a solid line, or a point for each step. The exact motion is a dashed line. What is set off is quoted \
         from the report; [...] marks words that are left out.",
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
         $I$ is a sum over the masses. These are the right laws, although some lines are misprinted: the inertia tensor in \
         section 3 lacks a term, and $g$ is in m/s², not kg/m². Two sentences are wrong. The weight does not act \"to sustain \
         the rotation\" (claim 1 in [#claims]): a wheel without friction spins on by itself, and the weight makes it precess. \
         And there is no \"conservation of angular moment\" while the weight turns $L$.",
    );
    let inertia = with_digits(numbers.top.along, 2, "kg m2");
    let momentum = with_digits(numbers.top.along * TAU, 3, "J s");
    document.paragraph(&format!(
        "Section 3 chooses the numbers: ten masses of 0.5 kg, a radius of 0.8 m, one turn per second. This gives $I =$ \
         {inertia} and $L =$ {momentum}, which the report rounds to 3 and 20. Then it multiplies $L$ by 100, \"for \
         simulated object to move faster\". The wheel does turn 100 times as fast. But the precession becomes 100 times \
         slower (claim 2). With the large $L$ that the report uses from here on, it is hard to see."
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
        "[...] the spinning trace is restricted to the positive x domain. This means the axis would become perpendicular to \
         the ground when it goes close and above to the origin position. [...] For method 1, there is an angle between the \
         angular momentum and axis, this will cause difference between the matlab simulation and real physics phenomenon. \
         [...] the axis top is not stable as it has a little oscillation in the z direction as well.",
    );
    let round = with_digits(run.report.nutation_s * 1000.0, 3, "ms");
    let swing = with_digits(run.report.z_m.size_mm(), 3, "mm");
    document.paragraph(&format!(
        "The axle circles $L$ on a cone. It is upright (\"perpendicular to the ground\") at the start and after every round, \
         {round} later. In between it leans to the other side of $L$, and its upper end is {swing} lower. This is the \
         oscillation in z. It is the nutation, and real physics: the exact motion has it too. In [#method-1-traces] the two \
         lines cannot be told apart."
    ));
    figure(
        document,
        ["method-1-traces", "method-1-3d"],
        "Method 1, the first 0.1 s: the coordinates of the axle's upper end, and its path in space, with a point for each \
         step. The end goes around ten times on the same circle. Below it is its shadow on the floor. The scale of z is \
         stretched.",
    );
    let later = numbers.later_x_m.report.markup(3);
    document.paragraph(&format!(
        "The trace stays at positive x only at first, because $L$ points to positive x. But the weight turns $L$ about the vertical, as it does with any top. After half a turn $L$ points \
         to negative x, and so does the trace: x runs from {later} m ([#method-1-longer])."
    ));
    figure(
        document,
        ["method-1-longer"],
        "Method 1 for 480 s, about one turn of the precession. Left: the rounds are too fast to be told apart; x runs up and \
         down between the two lines. Right: the first rounds.",
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
    let percent = 100.0 * (run.report.momentum / before.report.momentum - 1.0);
    let faster = with_digits(percent, 2, "%");
    let spin = with_digits(run.report.spin_rpm, 4, "rpm");
    document.paragraph(&format!(
        "That it spins faster is half right. $L$ is longer by {faster}, and the body turns faster by as much. But its spin \
         about the axle is the same in both runs, {spin}."
    ));
    figure(
        document,
        ["method-1-steeper-traces", "method-1-steeper-3d"],
        "Method 1, more tilted, the first 0.1 s: the coordinates of the axle's upper end, and its path in space, with a point \
         for each step. The scale of z is stretched.",
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
    let steps = with_digits(run.report.turn_s() / run.time_step_s, 4, "");
    document.paragraph(&format!(
        "The plot is right: x and y do change. In {duration} the axle goes around the center by {around}. A whole turn takes \
         {turn}, or {steps} steps. Nothing is wrong with this time step. The animation was too short."
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
         On the left, z swings too fast to be seen; it runs up and down between two lines.",
    );
    figure(
        document,
        ["method-2-slow-3d"],
        "Method 2 with the time step 0.001 s, the first 0.2 s: the path of the axle's upper end in space. The end falls, is \
         turned aside, rises and stops, and falls again. The scale of z is stretched.",
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
    let offset = with_digits(numbers.lag.offset_deg, 2, "deg");
    let less = with_digits(numbers.weaker_torque_percent(), 2, "%");
    document.paragraph(&format!(
        "The report calls this shrinking, but it has made the time step {longer} times longer. The trace is almost a nice \
         circle, and the circle is the gyroscope's. A turn takes {turn}. In the exact motion it takes {true_turn}, so the \
         report's is {slower} too long. This comes from the offset: on average the axle is {offset} more upright than $L$, \
         so that the torque of the weight is {less} too small."
    ));
    let [swing, true_swing] =
        [run.report, run.exact].map(|it| with_digits(it.z_m.percent(), 2, "%"));
    document.paragraph(&format!(
        "The height is almost constant: it swings by {swing}. In the exact motion it swings by {true_swing}. Here the time \
         step begins to show. This is the swing about the offset that was computed above. It is upward, as the offset is. A \
         plot that begins at z = 0 shows it as a nearly straight line."
    ));
    figure(
        document,
        ["method-2-traces"],
        "Method 2 with the time step 0.1 s: the coordinates of the axle's upper end. The scale of z is stretched.",
    );
    figure(
        document,
        ["method-2-3d"],
        "Method 2 with the time step 0.1 s: the path of the axle's upper end in space. The scale of z is stretched. The \
         shadow on the floor is almost a circle.",
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
    let period = with_digits(run.report.nutation_s, 3, "s");
    document.paragraph(&format!(
        "In the report's computation, z runs from {z} m. In the exact motion it runs from {true_z} m, which is a straight \
         line in [#wobble-push-traces]. The push makes the exact gyroscope go around faster as long as it lasts. It does not \
         make it wobble. In the report's computation, the upper end makes humps and deep dips during the push. After the push \
         it swings on, with a period of {period}."
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
    let expected = with_digits(
        numbers.push_torque * numbers.lag.predicted_swing_deg,
        2,
        "deg",
    );
    let found = with_digits(numbers.top.tilt_swing_deg(run.report.z_m), 2, "deg");
    let percent = 100.0 * (run.report.momentum / run.exact.momentum - 1.0);
    let longer = with_digits(percent, 2, "%");
    let [turns, later_turns] =
        [run.exact, run.report].map(|it| with_decimals(it.turns_per_step, 3, ""));
    document.paragraph(&format!(
        "Why so large? Weight and push together have {torque} times the torque of the weight. So the kicks and the offset are \
         {torque} times as large as before. A swing from no offset to twice the offset would be {expected}. But the tilt \
         swings by {found}. The kicks are so large that they make $L$ longer, by {longer} in all (a straight step at right \
         angles to $L$ ends a little outside the circle), and the wheel faster: at the end it turns {later_turns} times per step, and not {turns} times. On the way it passes a whole number of turns, \
         the peak in [#comb]. When the push ends, the large swing stays. In the exact motion, the push does not make the \
         wheel faster."
    ));
    let length = numbers.length_m.markup(6);
    document.paragraph(&format!(
        "That the radius grows as the height drops is no sign of an error. The axle is rigid, so its upper end keeps its \
         distance from the foot: in all rows of the run, $√(x^2 + y^2 + z^2)$ runs from {length} m. If you lower the \
         end of a leaning pole, it moves outward. In every swing the radius grows while the height drops, and shrinks while it \
         rises. The error is that there is a swing at all."
    ));
}

fn push_finer(document: &mut Document, numbers: &Numbers) {
    let [_, second, third, ..] = &numbers.finer;
    let [second_s, third_s] = [second, third].map(|it| with_digits(it.time_step_s, 2, "s"));
    let [second_turns, third_turns] =
        [second, third].map(|it| with_digits(it.turns_per_step, 3, ""));
    let first_true = numbers.finer.iter().find(|it| it.is_true());
    let from_s = first_true.map_or(f64::NAN, |it| it.time_step_s);
    let true_from = with_digits(from_s, 2, "s");
    document.paragraph(&format!(
        "The wobble does not survive a time step that is short enough. [#push-finer] has the same push, 20 s long, with seven \
         time steps. At {second_s} the wheel turns {second_turns} times per step. Kicks then meet the axle on opposite sides of its circle \
         and cancel, and the wobble is small. At {third_s} the wheel turns {third_turns} times per step, nearly a whole \
         number, and the wobble is back: to halve the time step once can mislead. With {true_from} or less, z swings hardly \
         more than in the exact motion."
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
            Column::number("z, report (mm)"),
            Column::number("z, exact (mm)"),
            Column::number("apart (mm)"),
        ],
        rows: numbers.finer.iter().map(finer_row).collect(),
    }));
    figure(
        document,
        ["wobble-push-finer"],
        "The same push with the report's time step of 0.1 s, and with 0.002 s. With the short one, z stays on the dashed line \
         of the exact motion.",
    );
}

fn finer_row(finer: &Finer) -> Vec<Text> {
    vec![
        Text::number(&significant(finer.time_step_s, 2)),
        Text::number(&fixed(finer.turns_per_step, 3)),
        Text::number(&fixed(finer.z_m.report.size_mm(), 2)),
        Text::number(&fixed(finer.z_m.exact.size_mm(), 2)),
        Text::number(&significant(1000.0 * finer.most_distance_m, 2)),
    ]
}

/// Says which tops do wobble.
fn slow_tops(document: &mut Document, numbers: &Numbers) {
    document.paragraph(
        "Is there a real wobble? A gyroscope that is let go with its axle along $L$ wobbles visibly only if $L$ is small. \
         [#slow-tops] lets the one of Method 2 go with less and less angular momentum, and with a time step that is short \
         enough. The report's method then shows the true nutation.",
    );
    let rows = numbers.slow_tops.iter().map(|top| {
        let Both { report, exact } = top.tilt_deg;
        vec![
            Text::number(&significant(top.momentum, 4)),
            Text::number(&fixed(report.size(), 3)),
            Text::number(&fixed(exact.size(), 3)),
        ]
    });
    document.blocks.push(Block::Table(Table {
        label: Some("slow-tops".to_owned()),
        caption: Text::marked(
            "How far the tilt swings when the gyroscope of Method 2 is let go at 45 degrees. The time step is 0.0005 s, and the \
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
        "A gyroscope with a large $L$ precesses at $M g h/L$ at any tilt. Looked at closely, the rate does depend on the \
         tilt, a little if $L$ is large and more if it is small, and in the direction that the report gives. The report's own \
         method shows the opposite at 0.1 s ([#tilt]): the effect of its time step is larger than the true one.",
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
            "The precession (rad/s) at three angles from the axle to the ground. Large: Method 2 with $L =$ {1000 J s} and the \
             time step 0.1 s. Small: the same with $L =$ {40 J s} and the time step 0.0005 s.",
        ),
        columns: vec![
            Column::text("angle to the ground"),
            Column::number("large, report"),
            Column::number("large, exact"),
            Column::number("small, report"),
            Column::number("small, exact"),
        ],
        rows: rows.collect(),
    }));
    let [short, long] = [&numbers.method_2_slow, &numbers.method_2]
        .map(|run| with_digits(run.report.z_m.size_mm(), 3, "mm"));
    document.paragraph(&format!(
        "Is the simulation accurate? For the precession it nearly is. For the wobble it is not. The report could have seen \
         this in Method 2, where z swings by {short} with short time steps and by {long} with long ones. With the push it \
         made one run only, and one run cannot show what its time step does."
    ));
}
