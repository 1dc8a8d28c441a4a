//! A page as filled and stroked paths, in order from the back to the front.
//!
//! Lengths are points (1/72 inch); the origin is the upper left corner, x to the right, y down. Text is a path too: the
//! outlines of its letters, so that a page looks the same where no font is installed.

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
    #[error(
        "the runs and the words of this figure are too long to travel with it: draw fewer runs, or give shorter words"
    )]
    Origin,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
}

pub const fn at(x: f64, y: f64) -> Point {
    Point { x, y }
}

/// `pt` in whole hundredths.
pub fn hundredths(pt: f64) -> f64 {
    libm::round(pt * 100.0) / 100.0 + 0.0
}

/// A letter in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedLetter {
    pub letter: char,
    pub is_italic: bool,
    pub origin: Point,
    pub size_pt: f64,
}

impl PlacedLetter {
    /// Returns its place along its line of text and across it, pt, in the directions in which the letters run and descend.
    pub fn along_and_across(&self, is_upward: bool) -> (f64, f64) {
        let Point { x, y } = self.origin;
        if is_upward { (-y, x) } else { (x, y) }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    Move(Point),
    Line(Point),
    /// A parabola: its control point, its end.
    Quadratic(Point, Point),
    /// A cubic curve: its two control points, its end.
    Cubic(Point, Point, Point),
    Close,
}

impl Segment {
    /// Where it ends; `None` for [`Close`](Self::Close), which ends where its line began.
    pub fn end(&self) -> Option<Point> {
        match *self {
            Self::Move(end)
            | Self::Line(end)
            | Self::Quadratic(_, end)
            | Self::Cubic(_, _, end) => Some(end),
            Self::Close => None,
        }
    }
}

/// Lines and curves that are filled or stroked together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VectorPath(pub Vec<Segment>);

impl VectorPath {
    /// Straight lines from corner to corner, and back to the first.
    pub fn polygon(corners: impl IntoIterator<Item = Point>) -> Self {
        let mut path = Self::polyline(corners);
        path.0.push(Segment::Close);
        path
    }

    pub fn polyline(points: impl IntoIterator<Item = Point>) -> Self {
        Self(
            points
                .into_iter()
                .enumerate()
                .map(|(index, point)| match index {
                    0 => Segment::Move(point),
                    _ => Segment::Line(point),
                })
                .collect(),
        )
    }

    /// The path with each of its points, control points too, moved to where `to` says.
    pub fn mapped(self, to: impl Fn(Point) -> Point) -> Self {
        Self(
            self.0
                .into_iter()
                .map(|segment| match segment {
                    Segment::Move(end) => Segment::Move(to(end)),
                    Segment::Line(end) => Segment::Line(to(end)),
                    Segment::Quadratic(control, end) => Segment::Quadratic(to(control), to(end)),
                    Segment::Cubic(first, second, end) => {
                        Segment::Cubic(to(first), to(second), to(end))
                    }
                    Segment::Close => Segment::Close,
                })
                .collect(),
        )
    }

    /// The points of the path, control points among them: what it covers lies inside of their hull.
    pub fn points(&self) -> impl Iterator<Item = Point> {
        self.0
            .iter()
            .flat_map(|segment| match *segment {
                Segment::Move(end) | Segment::Line(end) => [Some(end), None, None],
                Segment::Quadratic(control, end) => [Some(control), Some(end), None],
                Segment::Cubic(first, second, end) => [Some(first), Some(second), Some(end)],
                Segment::Close => [None; 3],
            })
            .flatten()
    }
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Color(pub [u8; 3]);

impl Color {
    pub fn is_grey(self) -> bool {
        let Self([red, green, blue]) = self;
        red == green && green == blue
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct StrokeStyle {
    pub width_pt: f64,
    pub color: Color,
    /// Lengths of strokes and gaps in turn, pt; empty for a solid line.
    pub dash_pt: Vec<f64>,
    /// Whether corners and the ends of solid lines are round; else corners are sharp and ends flat.
    pub is_round: bool,
}

impl StrokeStyle {
    /// Whether the ends of lines are round: those of dashes are flat, so that they are as long as they are said to be.
    pub fn has_round_ends(&self) -> bool {
        self.is_round && self.dash_pt.is_empty()
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Paint {
    /// Its inside, by the non-zero rule.
    Fill(Color),
    Stroke(StrokeStyle),
}

impl Paint {
    pub fn color(&self) -> Color {
        match self {
            Self::Fill(color) | Self::Stroke(StrokeStyle { color, .. }) => *color,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct SceneItem {
    pub path: VectorPath,
    pub paint: Paint,
    /// What it is cut off at: upper left and lower right corner; `None` for the page.
    pub clip: Option<[Point; 2]>,
    pub words: Option<TextItem>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextItem {
    pub text: String,
    pub letters: Vec<PlacedLetter>,
    pub is_upward: bool,
}

impl SceneItem {
    /// The item with each of its points moved to where `to` says; what it is cut off at stays.
    #[must_use]
    pub fn mapped(mut self, to: impl Fn(Point) -> Point) -> Self {
        for letter in self.words.iter_mut().flat_map(|words| &mut words.letters) {
            letter.origin = to(letter.origin);
        }
        self.path = self.path.mapped(to);
        self
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct PageScene {
    pub width_pt: f64,
    pub height_pt: f64,
    /// Its title, for readers of the file; it is not drawn.
    pub title: String,
    pub items: Vec<SceneItem>,
}

impl PageScene {
    /// The items in their order; those of one slice are drawn and cut off alike.
    pub fn groups(&self) -> impl Iterator<Item = &[SceneItem]> {
        self.items
            .chunk_by(|a, b| a.paint == b.paint && a.clip == b.clip)
    }
}
