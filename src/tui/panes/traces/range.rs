//! The range of values that a strip shows.

use super::Traces;
use super::content::Content;
use crate::observe::recording::{Curve, Extent, Recording};
use crate::observe::scale::Scale;
use crate::observe::strip::Strip;

/// Least range of z, as a share of the distance between pivot and traced point: a smaller swing is drawn small.
const Z_LEAST: f64 = 0.05;
/// Least range of the tilt, degrees. Below it there is only rounding error, and the labels would have too many digits.
const TILT_LEAST: f64 = 0.02;
/// Least range of other quantities, as a share of their size.
const SHARE_LEAST: f64 = 1e-3;
/// Least reach of x and y, as a share of the distance between pivot and traced point.
const PLANE_LEAST: f64 = 1e-4;

impl Traces<'_> {
    /// The range of values of a strip, magnified as the view wants it: that of the whole run, or of the time of `strip`
    /// alone.
    pub(super) fn scale(&self, content: Content, strip: Option<&Strip>) -> Scale {
        let scale = self.whole_scale(content, strip);
        if self.view.magnified <= 1.0 {
            return scale;
        }
        let about = match (self.cursor, content) {
            (Some(cursor), Content::Curve(curve)) => curve.at(cursor),
            _ => self.value_now(content),
        };
        scale.zoomed(self.view.magnified, about)
    }

    /// The same without magnification: x and y of the whole run share one about 0, the others have their own.
    fn whole_scale(&self, content: Content, strip: Option<&Strip>) -> Scale {
        let extent = |curve| self.extent(Content::Curve(curve), strip);
        let arm_m = self.run.scenario().arm_m();
        match content {
            Content::Curve(curve @ (Curve::X | Curve::Y)) if strip.is_some() => {
                Scale::around(extent(curve), PLANE_LEAST * arm_m)
            }
            Content::Curve(Curve::X | Curve::Y) => {
                let both = extent(Curve::X).and(extent(Curve::Y));
                Scale::about_zero(both.max.max(-both.min).max(PLANE_LEAST * arm_m))
            }
            Content::Curve(Curve::Z) => Scale::around(extent(Curve::Z), Z_LEAST * arm_m),
            Content::Curve(Curve::Tilt) => Scale::around(extent(Curve::Tilt), TILT_LEAST),
            Content::Measured(_) => {
                let extent = self.extent(content, strip);
                let size = extent.max.abs().max(extent.min.abs());
                Scale::around(extent, (SHARE_LEAST * size).max(f64::MIN_POSITIVE))
            }
        }
    }

    /// The extent of all that the strip of `content` shows: the run, the points, and, where they are shown, the exact
    /// motion, the run before and the pinned one. These count as a whole, so that the scale stays while the run catches
    /// up with them.
    fn extent(&self, content: Content, strip: Option<&Strip>) -> Extent {
        let of_every_run = |recording| match content {
            Content::Curve(curve) => Some((recording, curve)),
            Content::Measured(_) => None,
        };
        let exact = self.run.overlay().map(|overlay| &overlay.recording);
        let pinned = self.pinned.map(|ghost| &ghost.recording);
        let recordings = [
            self.recorded(content),
            self.recorded_before(content),
            exact.and_then(of_every_run),
            pinned.and_then(of_every_run),
        ];
        let extent = |(recording, curve): (&Recording, Curve)| match strip {
            Some(strip) => recording.extent_between(strip.begin_s, strip.end_s(), curve),
            None => recording.whole().map(|block| block.extent(curve)),
        };
        let extents = recordings.into_iter().flatten().filter_map(extent);
        let extents = extents.chain(self.extent_of_points(content, strip));
        extents.reduce(Extent::and).unwrap_or(Extent::of(0.0))
    }
}
