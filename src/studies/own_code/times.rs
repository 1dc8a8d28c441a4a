//! The time step of each row in a program's file: from its step number, else from its time, else from its position.

use crate::engine::scenario::problem::at_line;
use crate::engine::scenario::{Problem, Problems};
use crate::engine::text::number::{rounded, shortest};

pub const STEP_NAME: &str = "step";
pub const TIME_NAME: &str = "t_s";
/// The last step that is computed.
const LAST_COMPUTED_STEP: f64 = 2e5;
/// Relative tolerance between time steps, for times in single precision.
const SAME_WITHIN: f64 = 1e-3;
/// Assumed numbers of time steps between two rows of a file.
const STEPS_A_ROW: [i64; 7] = [1, 2, 5, 10, 20, 50, 100];
/// Other time steps to try if a file has no times, as multiples of the scenario's time step.
const OTHER_TIME_STEPS: [f64; 8] = [0.1, 10.0, 0.01, 100.0, 0.5, 2.0, 0.2, 5.0];

/// The time steps of the rows.
#[derive(Clone, Debug)]
pub struct RowSteps {
    pub of_rows: Vec<i64>,
    /// Steps from one row to the next.
    pub stride: i64,
}

#[derive(Clone, Debug)]
pub struct Times {
    pub steps: RowSteps,
    /// Time step that the file's times imply, s, if it differs from the scenario's.
    pub own_s: Option<f64>,
    /// Other time steps that the program may have used, s, with the steps of the rows for each.
    pub others: Vec<(f64, RowSteps)>,
}

/// Finds the time step of each of `count` rows. `time` holds the times, and the unit of their last digit.
pub(super) fn find_steps(
    count: usize,
    step: Option<&[f64]>,
    time: Option<(&[f64], f64)>,
    every: Option<u64>,
    time_step_s: f64,
    line: &dyn Fn(usize) -> u64,
) -> Result<Times, Problems> {
    let stride = every.map(|every| every.min(LAST_COMPUTED_STEP as u64) as i64);
    let times = match (step, time) {
        (Some(step), time) => by_step(step, time, time_step_s, line)?,
        (None, Some((times, unit))) => by_time(times, unit, stride, time_step_s)?,
        (None, None) => Times::at(RowSteps::evenly(count, 0, stride.unwrap_or(1)), time_step_s),
    };
    let last = times.steps.of_rows.last().copied().unwrap_or(0);
    if last as f64 > LAST_COMPUTED_STEP {
        let rule =
            format!("is step {last}, but only steps up to {LAST_COMPUTED_STEP} are computed");
        return Err(vec![at_line(line(count - 1), Problem::at("its row", rule))].into());
    }
    Ok(times)
}

impl RowSteps {
    fn evenly(count: usize, first: i64, stride: i64) -> Self {
        let of_rows = (0..count as i64)
            .map(|row| first.saturating_add(row.saturating_mul(stride)))
            .collect();
        Self { of_rows, stride }
    }
}

impl Times {
    /// Creates times for rows with known `steps`, if the file does not give the times.
    fn at(steps: RowSteps, time_step_s: f64) -> Self {
        Self {
            others: OTHER_TIME_STEPS
                .into_iter()
                .map(|factor| (rounded(time_step_s * factor, 12), steps.clone()))
                .collect(),
            own_s: None,
            steps,
        }
    }
}

fn by_step(
    numbers: &[f64],
    time: Option<(&[f64], f64)>,
    time_step_s: f64,
    line: &dyn Fn(usize) -> u64,
) -> Result<Times, Problems> {
    for (row, number) in numbers.iter().enumerate() {
        let rule = if number.fract() != 0.0 || !(-1.0..=LAST_COMPUTED_STEP).contains(number) {
            "must be the number of a step: 0, 1, 2 and so on, to 200000"
        } else if row > 0 && *number <= numbers[row - 1] {
            "must be greater than in the row above: put only one run in a file"
        } else {
            continue;
        };
        let (value, problem) = (shortest(*number), Problem::at(STEP_NAME, rule));
        return Err(vec![at_line(line(row), Problem { value, ..problem })].into());
    }
    let of_rows: Vec<i64> = numbers.iter().map(|number| *number as i64).collect();
    let gaps = of_rows.windows(2).map(|pair| pair[1] - pair[0]);
    let stride = gaps.min().unwrap_or(1);
    let mut all = Times::at(RowSteps { of_rows, stride }, time_step_s);
    if let Some((times, unit)) = time {
        let last = numbers.len() - 1;
        let count = numbers[last] - numbers[0];
        let (own, off) = ((times[last] - times[0]) / count, unit / count);
        let is_other = count > 0.0 && own > 0.0 && !is_same(own, time_step_s, off);
        all.own_s = is_other.then(|| plain(own, off));
        if let Some(own_s) = all.own_s {
            all.others = vec![(own_s, all.steps.clone())];
        }
    }
    Ok(all)
}

fn by_time(
    times: &[f64],
    unit: f64,
    every: Option<i64>,
    time_step_s: f64,
) -> Result<Times, Problems> {
    let rule = "is not evenly spaced: print the number of the step too, as the column step";
    let even = even_gap(times, unit, time_step_s);
    let (gap, off) = even.ok_or_else(|| vec![Problem::at(TIME_NAME, rule)])?;
    let stride = every.unwrap_or_else(|| ((gap / time_step_s).round() as i64).max(1));
    let is_own = is_same(gap / stride as f64, time_step_s, off / stride as f64);
    let counts = every.map_or(STEPS_A_ROW.to_vec(), |every| vec![every]);
    let mut others: Vec<_> = counts
        .into_iter()
        .map(|steps| {
            let own = plain(gap / steps as f64, off / steps as f64);
            let begins = (times[0] / own).round() as i64;
            (own, RowSteps::evenly(times.len(), begins, steps))
        })
        .collect();
    others.retain(|(own, _)| !is_same(*own, time_step_s, 0.0));
    let begins = if is_own {
        (times[0] / time_step_s).round() as i64
    } else {
        0
    };
    let own = others.first().map(|(own, _)| *own);
    let steps = RowSteps::evenly(times.len(), begins, stride);
    if is_own {
        others.extend(Times::at(steps.clone(), time_step_s).others); // the printed times may be wrong
    }
    Ok(Times {
        own_s: own.filter(|_| !is_own),
        steps,
        others,
    })
}

/// Returns the time between rows and its uncertainty; `None` if the rows are not evenly spaced.
fn even_gap(times: &[f64], unit: f64, time_step_s: f64) -> Option<(f64, f64)> {
    let last = times.len() - 1;
    if last == 0 {
        return Some((time_step_s, unit));
    }
    let gap = (times[last] - times[0]) / last as f64;
    let even = gap > 0.0
        && times
            .iter()
            .enumerate()
            .all(|(row, time)| (time - times[0] - row as f64 * gap).abs() <= 0.3 * gap + unit);
    even.then_some((gap, unit / last as f64))
}

fn is_same(own: f64, other: f64, off: f64) -> bool {
    (own - other).abs() <= SAME_WITHIN * other + 2.0 * off
}

/// Returns the number with the fewest digits within `most_off` of `number`.
fn plain(number: f64, most_off: f64) -> f64 {
    let off = most_off.max(1e-12 * number.abs());
    let mut plainer = (1..17).map(|digits| rounded(number, digits));
    plainer
        .find(|plain| (plain - number).abs() <= off)
        .unwrap_or(number)
}
