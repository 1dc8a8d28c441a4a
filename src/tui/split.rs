//! Splits an area of the screen in two.

use ratatui::layout::Rect;

/// Returns the first `height` rows of `area`, and the rest.
pub fn split_rows(area: Rect, height: u16) -> [Rect; 2] {
    let above = Rect {
        height: height.min(area.height),
        ..area
    };
    let below = Rect {
        y: above.bottom(),
        height: area.height - above.height,
        ..area
    };
    [above, below]
}

/// Returns the first `width` columns of `area`, and the rest.
pub fn split_columns(area: Rect, width: u16) -> [Rect; 2] {
    let width = width.min(area.width);
    let right = Rect {
        x: area.x + width,
        width: area.width - width,
        ..area
    };
    [Rect { width, ..area }, right]
}
