//! The rows of a sweep, computed again on all cores.

use super::lines::{Held, Lines, comments};
use super::{Difference, Field, Kind, Verified, What};
use crate::scenario::head::Head;
use crate::study::sweep::Sweep;
use crate::study::sweep::in_order::in_order;
use crate::text::printable::brief;
use std::io::{self, Read, Write};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

/// The most characters of a point that are shown.
const MOST_SHOWN: usize = 120;

/// Holds the rows in `lines`, whose head is `head`, against those of `sweep`; `None` where `watch`, which is told the rows
/// computed so far, of how many, stopped it. Of the sweep file above the rows only the ends of the lines are held.
///
/// # Errors
/// When the file cannot be read.
pub(super) fn verify<R: Read>(
    sweep: &Sweep,
    head: &Head,
    lines: Lines<R>,
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
) -> io::Result<Option<Verified>> {
    let (done, total) = (AtomicU64::new(0), sweep.rows());
    let watched = || watch(done.load(Ordering::Relaxed), total).is_continue();
    let mut held = Held::new(lines, ',');
    held.write_all(&comments(head.bytes()))?;
    held.write_all(sweep.names().as_bytes())?;
    let differs = held.differs();
    let (mut failures, mut written) = (0, Ok(()));
    let of = |row: u64, goes_on: &dyn Fn() -> bool| sweep.row(row, &|| goes_on() && watched());
    let end = if differs.get() { 0 } else { total };
    in_order(0..end, of, |rows| {
        for row in rows {
            failures += u64::from(row.failure.is_some());
            written = held.write_all(row.line.as_bytes());
            if written.is_err() || differs.get() {
                return ControlFlow::Break(());
            }
            done.fetch_add(1, Ordering::Relaxed);
        }
        ControlFlow::Continue(())
    });
    written?;
    if !differs.get() && done.load(Ordering::Relaxed) < total {
        return Ok(None);
    }
    let (rows, difference) = held.end()?;
    Ok(Some(Verified {
        kind: Kind::Sweep { failures },
        rows,
        difference: difference.map(|difference| with_point(difference, sweep, rows)),
        written_by: None,
        verdict: String::new(),
        not_finite: None,
    }))
}

/// `difference`, which is in the `row`-th row, from 0, where it is one of a field: the row is told by all that varies.
fn with_point(difference: Difference, sweep: &Sweep, row: u64) -> Difference {
    let told = |field: Field| Field {
        row_name: "the point".to_owned(),
        row: brief(&sweep.point_in_words(row), MOST_SHOWN),
        ..field
    };
    let what = match difference.what {
        What::Field(field) => What::Field(told(field)),
        What::FirstRow(field) => What::FirstRow(told(field)),
        what => what,
    };
    Difference { what, ..difference }
}
