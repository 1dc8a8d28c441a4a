//! What the report claims, what its scheme shows, what is true, and the commands that compute the numbers.

use super::made::{Made, TABLES};
use super::numbers::{Flight, Measured, Numbers, Range, Run, with_decimals, with_digits};
use crate::report::document::{Block, Column, Document, Table, Text};
use serde_json::json;
use std::fmt;

pub(super) struct Claim {
    /// The section of the report.
    section: &'static str,
    /// The report's own words.
    quote: &'static str,
    /// What the report's scheme shows, as markup.
    scheme: String,
    /// What is true of the exact motion, as markup.
    truth: String,
    verdict: Verdict,
    /// The names of the tables with its numbers.
    tables: &'static [&'static str],
}

#[derive(Clone, Copy)]
enum Verdict {
    True,
    TrueInPart,
    False,
    /// What the report saw is in its run, and not in the exact motion.
    TimeStep,
    /// What the report took for an error is the motion of the gyroscope.
    NoError,
    /// What the report took for the sign of an error would be there without one.
    NoSign,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::True => "true",
            Self::TrueInPart => "true in part",
            Self::False => "false",
            Self::TimeStep => "made by the time step",
            Self::NoError => "no error",
            Self::NoSign => "no sign of an error",
        })
    }
}

/// Returns the claims in the order of the report.
pub(super) fn claims(numbers: &Numbers) -> Vec<Claim> {
    let mut claims = vec![weight_sustains(numbers), hundredfold(numbers)];
    claims.extend(of_method_1(numbers));
    claims.extend(of_more_tilted(numbers));
    claims.extend(of_short_steps(numbers));
    claims.extend(of_long_steps(numbers));
    claims.extend(of_push(numbers));
    claims.extend(of_end(numbers));
    claims
}

fn weight_sustains(numbers: &Numbers) -> Claim {
    let (run, without) = (&numbers.method_2_slow, &numbers.without_weight);
    let exact = spins(run, &run.exact, &without.exact);
    Claim {
        section: "1",
        quote: "There is a constant gravitation force F acts on the system to sustain the rotation",
        scheme: spins(run, &run.report, &without.report),
        truth: format!(
            "{exact} The wheel needs no force to go on spinning. The weight makes the precession."
        ),
        verdict: Verdict::False,
        tables: &["method-2-slow-numbers", "no-weight"],
    }
}

fn spins(run: &Run, with: &Measured, without: &Flight) -> String {
    let [spin, free_spin] = [with.spin_rpm, without.spin_rpm].map(|rpm| with_digits(rpm, 5, "rpm"));
    let free_deg = without.azimuth_deg - run.start_azimuth_deg;
    let [around, free] =
        [run.goes_around_deg(with), free_deg].map(|deg| with_decimals(deg, 1, "deg"));
    format!(
        "After 10 s the spin is {spin}, and without weight {free_spin}. The axle has gone around by {around}, and without \
         weight by {free}."
    )
}

fn hundredfold(numbers: &Numbers) -> Claim {
    let [slow, fast] = &numbers.spins;
    let exact = times_as_fast(&slow.exact, &fast.exact);
    Claim {
        section: "3",
        quote: "we increase the value of the vector 100 times for simulated object to move faster",
        scheme: times_as_fast(&slow.report, &fast.report),
        truth: format!("{exact} The precession is $M g h/L$."),
        verdict: Verdict::TrueInPart,
        tables: &["faster-spin"],
    }
}

fn times_as_fast(slow: &Flight, fast: &Flight) -> String {
    let faster = with_digits(fast.spin_rpm / slow.spin_rpm, 3, "");
    let slower = with_digits(slow.precession / fast.precession, 3, "");
    format!(
        "With $L =$ {{20000 J s}} instead of {{200 J s}}, the wheel turns {faster} times as fast, and the axle goes around {slower} times as slowly."
    )
}

fn of_method_1(numbers: &Numbers) -> [Claim; 5] {
    let [run, more_tilted] = [&numbers.method_1, &numbers.method_1_steeper];
    let early = numbers.first_x_m.markup(3);
    let later = numbers.later_x_m.report.markup(3);
    let true_later = numbers.later_x_m.exact.markup(3);
    let [back_up, arm] =
        [numbers.back_up_z_m, numbers.top.arm_m].map(|length| with_decimals(length, 4, ""));
    let apart = with_digits(run.most_distance_m * 1000.0, 2, "mm");
    let swings = z_swings(&run.report, &more_tilted.report);
    let true_swings = z_swings(&run.exact, &more_tilted.exact);
    [
        Claim {
            section: "4, Method 1",
            quote: "the spinning trace is restricted to the positive x domain",
            scheme: format!(
                "In the first 2 s, x runs from {early} m; half a turn of the precession later, from {later} m."
            ),
            truth: format!(
                "The trace is on the side to which $L$ points, and the weight turns $L$. Half a turn later, x runs from {true_later} m."
            ),
            verdict: Verdict::TrueInPart,
            tables: &["method-1", "half-a-turn-later", "half-a-turn-later-exact"],
        },
        Claim {
            section: "4, Method 1",
            quote: "the axis would become perpendicular to the ground when it goes close and above to the origin position",
            scheme: format!(
                "After a second, z still comes up to {back_up} m. The axle is {arm} m long."
            ),
            truth: "The axle is upright again after every round about $L$.".to_owned(),
            verdict: Verdict::True,
            tables: &["method-1"],
        },
        Claim {
            section: "4, Method 1",
            quote: "This situation the model is correct in terms of physics",
            scheme: format!("In 2 s it is nowhere farther than {apart} from the exact motion."),
            truth: "The exact motion with this start is the same.".to_owned(),
            verdict: Verdict::True,
            tables: &["method-1-numbers"],
        },
        Claim {
            section: "4, Method 1",
            quote: "there is an angle between the angular momentum and axis, this will cause difference between the matlab simulation and real physics phenomenon",
            scheme: format!("In 2 s it is nowhere farther than {apart} from the exact motion."),
            truth: "A top may start with an angle between axle and $L$. The axle then circles $L$."
                .to_owned(),
            verdict: Verdict::False,
            tables: &["method-1-numbers"],
        },
        Claim {
            section: "4, Method 1",
            quote: "the axis top is not stable as it has a little oscillation in the z direction” and “result more error in z position",
            scheme: swings,
            truth: format!("{true_swings} It is the nutation."),
            verdict: Verdict::NoError,
            tables: &["method-1-numbers", "method-1-steeper-numbers"],
        },
    ]
}

fn z_swings(run: &Measured, more_tilted: &Measured) -> String {
    let [swing, more] = [run, more_tilted].map(|it| with_digits(it.z_m.size_mm(), 3, "mm"));
    format!("z swings by {swing}, and with the more tilted $L$ by {more}.")
}

fn of_more_tilted(numbers: &Numbers) -> [Claim; 2] {
    let [run, more_tilted] = [&numbers.method_1, &numbers.method_1_steeper];
    [
        Claim {
            section: "4, Method 1",
            quote: "means the gyro spinning faster",
            scheme: turns_faster(&run.report, &more_tilted.report),
            truth: turns_faster(&run.exact, &more_tilted.exact),
            verdict: Verdict::TrueInPart,
            tables: &["method-1-numbers", "method-1-steeper-numbers"],
        },
        Claim {
            section: "4, Method 1",
            quote: "The circular trace becomes larger since we decrease the angle",
            scheme: leans(&run.report, &more_tilted.report),
            truth: leans(&run.exact, &more_tilted.exact),
            verdict: Verdict::True,
            tables: &["method-1-numbers", "method-1-steeper-numbers"],
        },
    ]
}

fn turns_faster(run: &Measured, more_tilted: &Measured) -> String {
    let faster = with_digits(100.0 * (more_tilted.momentum / run.momentum - 1.0), 2, "%");
    let [before, after] = [run, more_tilted].map(|it| with_digits(it.spin_rpm, 4, ""));
    format!(
        "$L$ is {faster} longer, and the body turns faster by as much. The spin about the axle is {before} rpm before, and {after} rpm with the more tilted $L$."
    )
}

fn leans(run: &Measured, more_tilted: &Measured) -> String {
    let [before, after] = [run, more_tilted].map(|it| with_digits(it.highest_tilt_deg, 3, "deg"));
    format!(
        "$L$ has a smaller angle to the ground, and a larger one to the axle. The axle leans by up to {after} instead of {before}."
    )
}

fn of_short_steps(numbers: &Numbers) -> [Claim; 2] {
    let run = &numbers.method_2_slow;
    let true_way = goes_around(run, &run.exact);
    [
        Claim {
            section: "4, Method 2",
            quote: "The animation appears only rotation around the axis but no rotation around the center. The plot below implies xy position are still changing but in an extreme slow rate.",
            scheme: goes_around(run, &run.report),
            truth: format!("{true_way} The plot is right; the animation was too short."),
            verdict: Verdict::True,
            tables: &["method-2-slow-numbers"],
        },
        Claim {
            section: "4, Method 2",
            quote: "We can observe no change in the z direction",
            scheme: swings_mm(&run.report),
            truth: format!(
                "{} A plot of 0 to 1 m cannot show it.",
                swings_mm(&run.exact)
            ),
            verdict: Verdict::True,
            tables: &["method-2-slow-numbers"],
        },
    ]
}

fn goes_around(run: &Run, measured: &Measured) -> String {
    let around = with_digits(run.goes_around_deg(measured), 3, "deg");
    let turn = with_digits(measured.turn_s(), 4, "s");
    let steps = with_digits(measured.turn_s() / run.time_step_s, 4, "");
    format!("In 10 s the axle goes around by {around}. A turn takes {turn}, or {steps} steps.")
}

fn swings_mm(measured: &Measured) -> String {
    format!(
        "z swings by {}.",
        with_decimals(measured.z_m.size_mm(), 2, "mm")
    )
}

fn of_long_steps(numbers: &Numbers) -> [Claim; 4] {
    let (slow, run) = (&numbers.method_2_slow, &numbers.method_2);
    let longer = with_digits(run.time_step_s / slow.time_step_s, 3, "");
    let steps = with_digits(run.report.turn_s() / run.time_step_s, 4, "");
    let turns = with_decimals(run.exact.turns_per_step, 2, "");
    let true_swing = swings_percent(run.exact.z_m);
    [
        Claim {
            section: "4, Method 2",
            quote: "we need to decrease the time step to speed up animation [...] After shrinking the time step (dt=1e-1)",
            scheme: format!("The time step became {longer} times *longer*. A turn then takes {steps} steps, and the wheel turns {turns} times per step."),
            truth: "A longer time step makes the animation faster, but it also changes the motion. An animation gets faster, too, when it shows more steps per second, or leaves steps out.".to_owned(),
            verdict: Verdict::TrueInPart,
            tables: &["method-2-slow-numbers", "method-2-numbers"],
        },
        Claim {
            section: "4, Method 2",
            quote: "the trace is almost a nice circle",
            scheme: circle(numbers, &run.report),
            truth: circle(numbers, &run.exact),
            verdict: Verdict::True,
            tables: &["method-2-numbers"],
        },
        Claim {
            section: "4, Method 2",
            quote: "the change of height is almost a constant shown by a straight line",
            scheme: swings_percent(run.report.z_m),
            truth: format!("{true_swing} What the report's method swings more is made by the time step."),
            verdict: Verdict::True,
            tables: &["method-2-numbers", "comb"],
        },
        Claim {
            section: "4, Method 2",
            quote: "the spinning rate around the axis is faster than the spinning rate around the center",
            scheme: turn_times(&run.report),
            truth: turn_times(&run.exact),
            verdict: Verdict::True,
            tables: &["method-2-numbers"],
        },
    ]
}

fn circle(numbers: &Numbers, measured: &Measured) -> String {
    let z_m = measured.z_m;
    let radius_m = Range {
        low: numbers.top.radius_m(z_m.high),
        high: numbers.top.radius_m(z_m.low),
    };
    format!(
        "From z and the length of the axle follows a radius from {} m.",
        radius_m.markup(4)
    )
}

fn swings_percent(z_m: Range) -> String {
    format!("z swings by {}.", with_digits(z_m.percent(), 2, "%"))
}

fn turn_times(measured: &Measured) -> String {
    let spin = with_digits(measured.spin_s(), 3, "s");
    let turn = with_digits(measured.turn_s(), 4, "s");
    format!("The wheel turns once in {spin}, the axle goes around once in {turn}.")
}

fn of_push(numbers: &Numbers) -> [Claim; 2] {
    let run = &numbers.push;
    let [z, true_z] = [run.report, run.exact].map(|it| it.z_m.markup(4));
    let period = with_digits(run.report.nutation_s, 3, "s");
    let length = numbers.length_m.markup(6);
    let [first, second] = numbers.radii_m.map(|radius| with_decimals(radius, 4, "m"));
    [
        Claim {
            section: "4, the push",
            quote: "we can see the wobble in z direction is periodic",
            scheme: format!("z runs from {z} m, after the push with a period of {period}."),
            truth: format!("z runs from {true_z} m. With time steps that are short enough the report's method agrees."),
            verdict: Verdict::TimeStep,
            tables: &["wobble-push-numbers", "push-finer"],
        },
        Claim {
            section: "4, the push",
            quote: "the radius of the circle in the trace is increasing as the height of the axis is dropping showing there is an error",
            scheme: format!(
                "The length of the axle, $√(x^2 + y^2 + z^2)$, runs from {length} m: it stays the same. In the first half \
                 of the time after the push, the greatest radius is {first}, and in the second half {second}."
            ),
            truth: "The axle is rigid: where its end is lower, it is farther out. This happens in every swing, and the \
                    radius does not grow from swing to swing. The error is that there is a swing at all."
                .to_owned(),
            verdict: Verdict::NoSign,
            tables: &["wobble-push"],
        },
    ]
}

fn of_end(numbers: &Numbers) -> [Claim; 2] {
    let run = &numbers.method_2;
    let [fast, slow] = [numbers.of_fast_top, numbers.of_slow_top];
    let by_scheme = compared(fast.map(|rate| rate.report));
    let [by_fast, by_slow] = [fast, slow].map(|rates| compared(rates.map(|rate| rate.exact)));
    let [slower, slower_pushed] =
        [run, &numbers.push].map(|run| with_digits(run.slower_percent(), 2, "%"));
    let times = with_digits(
        numbers.push.report.z_m.size() / numbers.push.exact.z_m.size(),
        2,
        "",
    );
    [
        Claim {
            section: "4, the end",
            quote: "The larger the angle from the axis to the ground the faster the precession motion is",
            scheme: format!("With the time step of 0.1 s, the precession at 75 degrees to the ground is {by_scheme} than at 15 degrees."),
            truth: format!("It is {by_fast}: with a large $L$, the rate is $M g h/L$ at any angle. With $L =$ {{40 J s}}, it is {by_slow}."),
            verdict: Verdict::TrueInPart,
            tables: &["tilt-fast-top", "tilt-slow-top"],
        },
        Claim {
            section: "4, the end",
            quote: "our experiment shows matlab can accurately simulate the precession in physics world",
            scheme: format!("With the time step of 0.1 s, a turn of the precession takes {slower} too long, and {slower_pushed} too long with the push. The wobble after the push is {times} times too large."),
            truth: "A program computes what its method and its time step allow. Whether it is accurate must be tested, for example with half the time step.".to_owned(),
            verdict: Verdict::TrueInPart,
            tables: &["method-2-numbers", "wobble-push-numbers"],
        },
    ]
}

/// Returns by how much the first of these rates is faster or slower than the last.
fn compared(rates: [f64; 3]) -> String {
    let percent = 100.0 * (rates[0] / rates[2] - 1.0);
    let word = if percent < 0.0 { "slower" } else { "faster" };
    format!("{} {word}", with_digits(percent.abs(), 2, "%"))
}

/// Adds the table of the claims, and the commands that compute its numbers.
pub(super) fn table(document: &mut Document, claims: &[Claim]) {
    document.section("The claims of the report");
    document.paragraph(
        "*Scheme* is the report's method with the report's time step. What is true is read from the exact motion. The sign \
         [...] marks words of the report that are left out. What no computation can test is not in the table, such as that \
         Method 1 is \"hard to observe in real life\". Below the table are the commands that compute each line.",
    );
    let rows = (1..).zip(claims).map(|(number, claim): (usize, _)| {
        vec![
            Text::plain(&format!("{number}")),
            Text::plain(&format!("“{}” (section {})", claim.quote, claim.section)),
            Text::marked(&claim.scheme),
            Text::marked(&claim.truth),
            Text::plain(&claim.verdict.to_string()),
        ]
    });
    document.blocks.push(Block::Table(Table {
        label: Some("claims".to_owned()),
        caption: Text::plain("The claims of the report, in its order."),
        columns: [
            "no.",
            "the report says",
            "its scheme shows",
            "what is true",
            "verdict",
        ]
        .map(Column::text)
        .into(),
        rows: rows.collect(),
    }));
    document.subsection("The commands");
    document.paragraph(
        "Each of these commands writes one file of the folder `data`, byte by byte as it is here, if a folder of that name is \
         there. The comment says for which claims it holds numbers.",
    );
    document.code("sh", &commands(claims));
}

/// Returns the commands of the tables, each below a comment with its claims.
fn commands(claims: &[Claim]) -> String {
    let mut lines = Vec::new();
    for made in TABLES {
        let all = (1..).zip(claims);
        let of: Vec<String> = all
            .filter(|(_, claim): &(usize, &Claim)| claim.tables.contains(&made.name))
            .map(|(number, _)| number.to_string())
            .collect();
        lines.push(match &of[..] {
            [] => "# for the text".to_owned(),
            [one] => format!("# claim {one}"),
            several => format!("# claims {}", several.join(", ")),
        });
        lines.push(made.command());
    }
    lines.join("\n")
}

/// Returns the claims as JSON.
pub(super) fn json(claims: &[Claim]) -> String {
    let list = (1..).zip(claims).map(|(number, claim): (usize, _)| {
        let tables = TABLES
            .iter()
            .filter(|made| claim.tables.contains(&made.name));
        let commands: Vec<String> = tables.map(Made::command).collect();
        json!({
            "number": number,
            "section": claim.section,
            "claim": claim.quote,
            "verdict": claim.verdict.to_string(),
            "commands": commands,
        })
    });
    let all = json!({
        "gyrolab": env!("CARGO_PKG_VERSION"),
        "claims": list.collect::<Vec<_>>(),
    });
    format!("{all:#}\n")
}
