//! The rows of a sweep, computed again.

use super::{Difference, Kind, Unverified, Verified, What};
use crate::study::sweep::recompute::{self, Verdict};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Holds the rows in `path` against the sweep in its header. `watch` is told the rows computed so far, of how many.
///
/// # Errors
/// When it is no sweep's CSV, or when `watch` said no.
pub(super) fn verify(
    path: &Path,
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
) -> Result<Verified, Unverified> {
    let (done, of) = (AtomicU64::new(0), AtomicU64::new(0));
    let goes_on = || watch(done.load(Ordering::Relaxed), of.load(Ordering::Relaxed)).is_continue();
    let verified = recompute::verify(path, &goes_on, |rows, total| {
        done.store(rows, Ordering::Relaxed);
        of.store(total, Ordering::Relaxed);
    });
    let verified = verified.map_err(Unverified::Refused)?;
    let (rows, difference) = match verified.verdict {
        Verdict::Stopped => return Err(Unverified::Stopped),
        Verdict::Same => (verified.rows, None),
        Verdict::Differs(difference) => (difference.row.saturating_sub(1), Some(told(difference))),
    };
    Ok(Verified {
        kind: Kind::Sweep {
            failures: verified.failures,
        },
        rows,
        difference,
        written_by: None,
        verdict: String::new(),
        not_finite: None,
    })
}

fn told(difference: recompute::Difference) -> Difference {
    let what = match (difference.there, difference.here) {
        (Some(stands), Some(computed)) => What::Line { stands, computed },
        (None, computed) => What::Missing {
            computed: computed.unwrap_or_default(),
        },
        (Some(stands), None) => What::Extra { stands },
    };
    Difference {
        line: difference.line,
        what,
    }
}
