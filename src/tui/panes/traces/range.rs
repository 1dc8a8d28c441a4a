//! The range of values that a strip shows.

use super::Traces;
use crate::observe::ghost::Ghost;
use crate::observe::overlay::Overlay;
use crate::observe::recording::{Curve, Extent, Recording};
use crate::observe::scale::Scale;
use crate::observe::strip::Strip;

/// Least range of z, of the distance between pivot and traced point: a swing below it is small, and shall look small.
const Z_LEAST: f64 = 0.05;
/// Least range of the tilt, degrees: below it there is rounding to see, and no end to the digits of its ends.
const TILT_LEAST: f64 = 0.02;
/// Least reach of x and y, of the same distance.
const PLANE_LEAST: f64 = 1e-4;

impl Traces<'_> {
    /// `scale`, magnified as it is looked at.
    pub(super) fn magnified(&self, curve: Curve, scale: Scale) -> Scale {
        if self.view.magnified <= 1.0 {
            return scale;
        }
        let about = match self.cursor {
            Some(cursor) => curve.at(cursor),
            None => self.run.now().value(curve),
        };
        scale.zoomed(self.view.magnified, about)
    }

    /// The range of values a strip shows: x and y share one about 0, z and tilt have their own. It is that of the whole
    /// run, or of the time of `strip` alone.
    pub(super) fn scale(&self, curve: Curve, strip: Option<&Strip>) -> Scale {
        let extent = |curve| self.extent(curve, strip);
        let arm_m = self.run.scenario().arm_m();
        match curve {
            Curve::X | Curve::Y => {
                let both = extent(Curve::X).and(extent(Curve::Y));
                Scale::about_zero(both.max.max(-both.min).max(PLANE_LEAST * arm_m))
            }
            Curve::Z => Scale::around(extent(curve), Z_LEAST * arm_m),
            Curve::Tilt => Scale::around(extent(curve), TILT_LEAST),
        }
    }

    /// Everything the strip of `curve` has to show: the run, and where they are shown the exact motion, the run before
    /// and the pinned one: the whole of it at once, so that the picture stays while the run comes after it.
    fn extent(&self, curve: Curve, strip: Option<&Strip>) -> Extent {
        let exact = self.run.overlay().map(Overlay::recording);
        let before = self.ghost.map(Ghost::recording);
        let pinned = self.pinned.map(Ghost::recording);
        let recordings = [Some(self.run.recording()), exact, before, pinned];
        let extent = |recording: &Recording| match strip {
            Some(strip) => recording
                .between(strip.begin_s, strip.end_s())
                .map(|block| block.extent(curve))
                .reduce(Extent::and),
            None => recording.whole().map(|block| block.extent(curve)),
        };
        let extents = recordings.into_iter().flatten().filter_map(extent);
        extents.reduce(Extent::and).unwrap_or(Extent::of(0.0))
    }
}
