//! Finds where the columns of a picture cannot resolve the swings of a curve, and computes the envelope that is drawn
//! there.

/// Minimum reversal of a curve that counts as a turning point, dots. Slow motion is excluded, because it does not turn
/// back.
const MIN_SWING_DOTS: f64 = 2.0;
/// Columns on either side in which turning points are counted.
///
/// Swings are unresolved if half of the columns have a turning point: the swings are then shorter than four columns.
const NEIGHBORS: usize = 5;
/// Minimum length of a gap in the envelope, columns. A shorter gap is closed. A piece of the envelope below
/// `SHORTEST_PIECE` columns is drawn as a line.
const SHORTEST_GAP: usize = 8;
const SHORTEST_PIECE: usize = 6;
/// Columns on either side over which the envelope takes the minimum and the maximum.
const REACH: usize = 2;

/// The upper and the lower end of a curve in a column, in dots from the top.
pub type Rows = (f64, f64);

/// Returns the upper and the lower edge of the envelope for each column in which the swings of `columns` are
/// unresolved; `None` for the other columns.
pub fn envelope(columns: &[Option<Rows>]) -> Vec<Option<Rows>> {
    let turning = turning_points(columns);
    let mut is_unresolved: Vec<bool> = (0..columns.len())
        .map(|index| {
            let near = index.saturating_sub(NEIGHBORS)..(index + NEIGHBORS).min(columns.len());
            let drawn = columns[near.clone()].iter().flatten().count();
            let turns = turning[near].iter().filter(|turns| **turns).count();
            columns[index].is_some() && 2 * turns >= drawn && turns > 1
        })
        .collect();
    fill_short(&mut is_unresolved, false, SHORTEST_GAP);
    fill_short(&mut is_unresolved, true, SHORTEST_PIECE);
    (0..columns.len())
        .map(|index| {
            let near = index.saturating_sub(REACH)..(index + REACH + 1).min(columns.len());
            let all = columns[near].iter().flatten().copied();
            all.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
                .filter(|_| is_unresolved[index] && columns[index].is_some())
        })
        .collect()
}

/// Returns true for each column in which the curve turns back by more than [`MIN_SWING_DOTS`].
///
/// In each column the curve is assumed to start from the end nearer to its previous position and to go to the other
/// end.
fn turning_points(columns: &[Option<Rows>]) -> Vec<bool> {
    let mut turning = vec![false; columns.len()];
    // The position of the curve, the farthest point in its direction, and that point's column. `is_down` is the
    // direction.
    let mut position: Option<f64> = None;
    let (mut farthest, mut farthest_column, mut is_down) = (0.0, 0, true);
    for (index, column) in columns.iter().enumerate() {
        let Some((upper, lower)) = *column else {
            continue;
        };
        let from = position.unwrap_or(upper);
        let ends = if (from - upper).abs() <= (from - lower).abs() {
            [upper, lower]
        } else {
            [lower, upper]
        };
        for row in ends {
            let ahead = if is_down {
                row - farthest
            } else {
                farthest - row
            };
            if position.is_none() || ahead >= 0.0 {
                (farthest, farthest_column) = (row, index);
            } else if -ahead > MIN_SWING_DOTS {
                turning[farthest_column] = true;
                is_down = !is_down;
                (farthest, farthest_column) = (row, index);
            }
            position = Some(row);
        }
    }
    turning
}

/// Flips each sequence of `value` that is shorter than `shortest` and has the other value on both sides.
fn fill_short(values: &mut [bool], value: bool, shortest: usize) {
    let mut begin = 0;
    while begin < values.len() {
        let rest = &values[begin..];
        let length = rest.iter().take_while(|other| **other == rest[0]).count();
        let end = begin + length;
        let is_inside = begin > 0 && end < values.len();
        if values[begin] == value && is_inside && length < shortest {
            values[begin..end].fill(!value);
        }
        begin = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns 200 columns of a sine with a period of `period` columns and `height` dots, which drifts by `drift` dots
    /// per column.
    fn columns(period: f64, height: f64, drift: f64) -> Vec<Option<Rows>> {
        let row =
            |at: f64| 0.5 * height * libm::sin(at / period * std::f64::consts::TAU) + drift * at;
        (0..200)
            .map(|column| {
                let rows = (0..=40).map(|part| row(f64::from(column) + f64::from(part) / 40.0));
                rows.map(|at| (at, at))
                    .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            })
            .collect()
    }

    #[test]
    fn an_envelope_is_drawn_only_for_visible_unresolved_swings() {
        for (period, height, drift, count) in [
            (0.3, 20.0, 0.0, 200),
            (3.0, 20.0, 0.0, 200),
            (3.0, 20.0, 1.0, 200),
            (10.0, 20.0, 0.0, 0),
            (5.0, 20.0, 0.0, 0),
            (0.3, 1.5, 0.0, 0),
            (0.3, 1.5, 4.0, 0),
            (400.0, 30.0, 0.0, 0),
        ] {
            let envelope = envelope(&columns(period, height, drift));
            let drawn = envelope.iter().flatten().count();
            assert!(
                drawn.abs_diff(count) <= 6,
                "{period} {height} {drift}: {drawn}"
            );
        }
    }

    #[test]
    fn the_envelope_reaches_from_minimum_to_maximum() {
        let envelope = envelope(&columns(0.7, 20.0, 0.0));
        for (upper, lower) in envelope.into_iter().flatten() {
            assert!(upper < -9.8 && lower > 9.8, "{upper} {lower}");
        }
    }
}
