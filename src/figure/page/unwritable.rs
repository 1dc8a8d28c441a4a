//! Why a page cannot be written.

use thiserror::Error;

/// The largest number that a page can hold, pt: far beyond every sheet, and exact in a file to a hundredth.
pub(super) const LARGEST_PT: f64 = 20_000.0;

#[derive(Clone, Debug, Error, PartialEq)]
pub enum Unwritable {
    /// The file's name does not say which form it shall have.
    #[error(
        "{0}: a figure is written as .svg, .pdf or .png, and the file's name must end with one of them"
    )]
    Ending(String),
    /// The page is empty, or larger than a file can say.
    #[error(
        "a page of {width_pt} pt x {height_pt} pt cannot be written: each side must be above 0 and at most {LARGEST_PT} pt"
    )]
    Size { width_pt: f64, height_pt: f64 },
    /// Something on the page lies at no place, or at one that a file cannot say.
    #[error(
        "item {0} of the page lies farther than {LARGEST_PT} pt from its corner, or its place or its line is not a number"
    )]
    Place(usize),
    /// The picture would not fit into memory, or its form cannot hold it.
    #[error(
        "a picture of {width} x {height} dots cannot be written: {reason}; make the figure smaller, or write SVG or PDF"
    )]
    Picture {
        width: u32,
        height: u32,
        reason: String,
    },
}
