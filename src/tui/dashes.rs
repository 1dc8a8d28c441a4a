//! Which dots are drawn of a path that is not the run's own: dashes and dots tell the runs apart without colours.

use crate::lab::view::markers::Marker;

/// Dots that are drawn, and out of how many.
pub type Dashes = (usize, usize);

/// The exact motion.
pub const EXACT: Dashes = (2, 4);
/// The pinned run: long dashes.
pub const PINNED: Dashes = (5, 7);
const DOTTED: Dashes = (1, 3);
const LARGE_DOTTED: Dashes = (1, 2);

/// The run before an edit: single dots, closer where the dots of `marker` are as large as cells.
pub fn before(marker: Marker) -> Dashes {
    match marker {
        Marker::Braille => DOTTED,
        _ => LARGE_DOTTED,
    }
}

/// The first `drawn` of every `out_of` dots of the screen that a path goes through one after the other.
pub fn on_and_off(
    path: impl Iterator<Item = (f64, f64)>,
    (drawn, out_of): Dashes,
) -> impl Iterator<Item = (f64, f64)> {
    let (mut passed, mut last) = (0, None);
    path.filter(move |&(x, y)| {
        let dot = (x.floor(), y.floor());
        passed += usize::from(last.replace(dot) != Some(dot));
        passed % out_of < drawn
    })
}
