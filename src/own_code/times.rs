//! Which time step each row of a file is: by its number, else by its time, else by its place.

use crate::scenario::problem::at_line;
use crate::scenario::{Problem, Problems};
use crate::text::number::{rounded, shortest};

/// The columns that say which step a row is.
pub const STEP: &str = "step";
pub const TIME: &str = "t_s";
/// The last step that is computed.
const MOST_STEPS: f64 = 1e6;
/// By how much of it a time step may seem to differ, as times in single precision do.
const SAME_WITHIN: f64 = 1e-3;
/// How many steps of its own a program may have taken between two rows that a file has.
const STEPS_A_ROW: [u32; 7] = [1, 2, 5, 10, 20, 50, 100];
/// Other time steps that are tried where a file has no times, as multiples of the scenario's.
const OTHERS: [f64; 8] = [0.1, 10.0, 0.01, 100.0, 0.5, 2.0, 0.2, 5.0];

/// The steps of the rows.
#[derive(Clone, Debug)]
pub struct Steps {
    pub of_rows: Vec<i64>,
    /// From one row to the next: by so many steps a row may be off.
    pub stride: i64,
}

#[derive(Clone, Debug)]
pub struct Times {
    pub steps: Steps,
    /// The time step that the file itself states, s, where that is another one than the scenario's.
    pub own_s: Option<f64>,
    /// Other time steps, s, that the program may have used, and the steps that the rows are then.
    pub others: Vec<(f64, Steps)>,
}

/// The times of `count` rows. `time` has the times with the unit of their last digit.
pub(super) fn of(
    count: usize,
    step: Option<Vec<f64>>,
    time: Option<(Vec<f64>, f64)>,
    every: Option<u64>,
    time_step_s: f64,
    line: &dyn Fn(usize) -> u64,
) -> Result<Times, Problems> {
    let every = every.map(|every| every.min(MOST_STEPS as u64) as i64);
    let times = match (step, time) {
        (Some(step), time) => by_step(&step, time, time_step_s, line),
        (None, Some((times, unit))) => by_time(&times, unit, every, time_step_s, line),
        (None, None) => Ok(in_order(count, every.unwrap_or(1), time_step_s)),
    };
    let times = times.map_err(|problem| vec![problem])?;
    let last = times.steps.of_rows.last().copied().unwrap_or(0);
    if last as f64 > MOST_STEPS {
        let rule = format!("is step {last}: steps up to {MOST_STEPS:e} are computed");
        return Err(vec![at_line(line(count - 1), Problem::at("its row", rule))].into());
    }
    Ok(times)
}

fn in_order(count: usize, every: i64, time_step_s: f64) -> Times {
    let steps = evenly(count, 0, every);
    Times {
        others: others(&steps, time_step_s),
        steps,
        own_s: None,
    }
}

fn evenly(count: usize, first: i64, stride: i64) -> Steps {
    let of_rows = (0..count as i64).map(|row| first.saturating_add(row.saturating_mul(stride)));
    Steps {
        of_rows: of_rows.collect(),
        stride,
    }
}

fn others(steps: &Steps, time_step_s: f64) -> Vec<(f64, Steps)> {
    let other = |factor: f64| (rounded(time_step_s * factor, 12), steps.clone());
    OTHERS.into_iter().map(other).collect()
}

fn by_step(
    numbers: &[f64],
    time: Option<(Vec<f64>, f64)>,
    time_step_s: f64,
    line: &dyn Fn(usize) -> u64,
) -> Result<Times, Problem> {
    for (row, number) in numbers.iter().enumerate() {
        let rule = if number.fract() != 0.0 || number.abs() > MOST_STEPS {
            "must be the number of a step: 0, 1, 2 and so on, to 1e6"
        } else if row > 0 && *number <= numbers[row - 1] {
            "must be greater than in the row above: one run in a file"
        } else {
            continue;
        };
        return Err(refused(line(row), STEP, *number, rule.to_owned()));
    }
    let steps = Steps::of(numbers.iter().map(|number| *number as i64).collect());
    let Some((times, unit)) = time else {
        let others = others(&steps, time_step_s);
        return Ok(Times {
            steps,
            own_s: None,
            others,
        });
    };
    let last = numbers.len() - 1;
    let count = numbers[last] - numbers[0];
    let (own, off) = ((times[last] - times[0]) / count, unit / count);
    let is_other = count > 0.0 && own > 0.0 && !is_same(own, time_step_s, off);
    let own_s = is_other.then(|| plain(own, off));
    let others = own_s.map(|own| (own, steps.clone())).into_iter().collect();
    Ok(Times {
        steps,
        own_s,
        others,
    })
}

fn refused(line: u64, column: &str, value: f64, rule: String) -> Problem {
    let value = shortest(value);
    at_line(
        line,
        Problem {
            value,
            ..Problem::at(column, rule)
        },
    )
}

impl Steps {
    fn of(of_rows: Vec<i64>) -> Self {
        let gaps = of_rows.windows(2).map(|pair| pair[1] - pair[0]);
        let stride = gaps.min().unwrap_or(1);
        Self { of_rows, stride }
    }
}

fn by_time(
    times: &[f64],
    unit: f64,
    every: Option<i64>,
    time_step_s: f64,
    line: &dyn Fn(usize) -> u64,
) -> Result<Times, Problem> {
    let Some((gap, off)) = even_gap(times, unit) else {
        return unevenly(times, unit, time_step_s, line);
    };
    let ratio = gap / time_step_s;
    let stride = every.unwrap_or_else(|| (ratio.round() as i64).max(1));
    let is_own = is_same(gap / stride as f64, time_step_s, off / stride as f64);
    let first = |dt: f64| (times[0] / dt).round() as i64;
    let of_own = |steps: u32| {
        let own = plain(gap / f64::from(steps), off / f64::from(steps));
        (own, evenly(times.len(), first(own), steps.into()))
    };
    let counts = STEPS_A_ROW.into_iter();
    let counts: Vec<u32> = match every {
        Some(every) => vec![u32::try_from(every).unwrap_or(u32::MAX)],
        None => counts.collect(),
    };
    let mut others: Vec<_> = counts.into_iter().map(of_own).collect();
    others.retain(|(own, _)| !is_same(*own, time_step_s, 0.0));
    let steps = evenly(
        times.len(),
        if is_own { first(time_step_s) } else { 0 },
        stride,
    );
    let own_s = (!is_own)
        .then(|| others.first().map(|(own, _)| *own))
        .flatten();
    Ok(Times {
        steps,
        own_s,
        others,
    })
}

/// The time from one row to the next, and by how much it may be off; `None` where the rows do not follow evenly.
fn even_gap(times: &[f64], unit: f64) -> Option<(f64, f64)> {
    let last = times.len() - 1;
    let gap = (times[last] - times[0]) / last as f64;
    let is_even =
        |(row, time): (usize, &f64)| (time - times[0] - row as f64 * gap).abs() <= 0.3 * gap + unit;
    let even = gap > 0.0 && times.iter().enumerate().all(is_even);
    even.then_some((gap, unit / last as f64))
}

/// Rows at times between which there are different numbers of steps.
fn unevenly(
    times: &[f64],
    unit: f64,
    time_step_s: f64,
    line: &dyn Fn(usize) -> u64,
) -> Result<Times, Problem> {
    let mut of_rows: Vec<i64> = Vec::new();
    for (row, time_s) in times.iter().enumerate() {
        let (steps, unit) = (time_s / time_step_s, unit / time_step_s);
        let rule = if (steps - steps.round()).abs() > 0.1 + unit {
            format!("is no time of a step of {} s", shortest(time_step_s))
        } else if of_rows
            .last()
            .is_some_and(|before| steps.round() as i64 <= *before)
        {
            "must be later than in the row above: one run in a file, each step once".to_owned()
        } else {
            of_rows.push(steps.round() as i64);
            continue;
        };
        return Err(refused(line(row), TIME, *time_s, rule));
    }
    Ok(Times {
        steps: Steps::of(of_rows),
        own_s: None,
        others: Vec::new(),
    })
}

fn is_same(own: f64, other: f64, off: f64) -> bool {
    (own - other).abs() <= SAME_WITHIN * other + 2.0 * off
}

/// The number with the fewest digits that is within `off` of `number`.
fn plain(number: f64, off: f64) -> f64 {
    let off = off.max(1e-12 * number.abs());
    let mut plainer = (1..17).map(|digits| rounded(number, digits));
    plainer
        .find(|plain| (plain - number).abs() <= off)
        .unwrap_or(number)
}
