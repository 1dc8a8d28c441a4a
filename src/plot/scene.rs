//! A page as filled and stroked paths, from back to front.
//!
//! Lengths are in points (1/72 inch). The origin is the upper left corner, with x to the right and y down. Text is a
//! path too: the outlines of its letters, so that a page looks the same without an installed font.

use thiserror::Error;

/// The largest coordinate on a page, pt: far beyond any sheet, and exact to a hundredth in every file format.
pub(super) const LARGEST_PT: f64 = 20_000.0;

#[derive(Clone, Debug, Error, PartialEq)]
pub enum Unwritable {
    /// The file name does not give a known format.
    #[error(
        "{0}: a figure is written as .svg, .pdf or .png, and the file's name must end with one of them"
    )]
    Ending(String),
    /// The page is empty, or too large for a file.
    #[error(
        "a page of {width_pt} pt x {height_pt} pt cannot be written: each side must be above 0 and at most {LARGEST_PT} pt"
    )]
    Size { width_pt: f64, height_pt: f64 },
    /// An item on the page has an invalid position or one that is out of range.
    #[error(
        "item {0} of the page is farther than {LARGEST_PT} pt from the corner, or has a coordinate or line width that is not a number"
    )]
    Place(usize),
    /// The picture does not fit into memory, or its format cannot hold it.
    #[error(
        "a picture of {width} x {height} dots cannot be written: {reason}; make the figure smaller, or write SVG or PDF"
    )]
    Picture {
        width: u32,
        height: u32,
        reason: String,
    },
    #[error(
        "the runs and texts of this figure are too long to be embedded in the file: draw fewer runs, or use shorter texts"
    )]
    Origin,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
}

pub const fn at(x: f64, y: f64) -> Point {
    Point { x, y }
}

/// Rounds `pt` to hundredths.
pub fn hundredths(pt: f64) -> f64 {
    libm::round(pt * 100.0) / 100.0 + 0.0
}

/// A letter with its position on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedLetter {
    pub letter: char,
    pub is_italic: bool,
    pub origin: Point,
    pub size_pt: f64,
}

impl PlacedLetter {
    /// Returns the position along and across the line of text, pt, in the directions in which letters advance and
    /// descend.
    pub fn along_and_across(&self, is_upward: bool) -> (f64, f64) {
        let Point { x, y } = self.origin;
        if is_upward { (-y, x) } else { (x, y) }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    Move(Point),
    Line(Point),
    /// A parabola: control point and end point.
    Quadratic(Point, Point),
    /// A cubic curve: two control points and the end point.
    Cubic(Point, Point, Point),
    Close,
}

impl Segment {
    /// Returns the end point; `None` for [`Close`](Self::Close), which ends at the start of its line.
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
    /// Creates a closed polygon with these corners.
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

    /// Maps all points, including control points, with `to`.
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

    /// Returns the points of the path, including control points. The path lies within their convex hull.
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
    /// True for round corners, and round ends of solid lines; false for sharp corners and flat ends.
    pub is_round: bool,
}

impl StrokeStyle {
    /// Returns true if the ends of lines are round. Ends of dashes are flat, so that dashes have their exact length.
    pub fn has_round_ends(&self) -> bool {
        self.is_round && self.dash_pt.is_empty()
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Paint {
    /// Fills the inside, by the non-zero rule.
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
    /// The clip rectangle, as upper left and lower right corner; `None` for the whole page.
    pub clip: Option<[Point; 2]>,
    pub words: Option<TextItem>,
}

/// Which part of a text is at its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextAnchor {
    #[default]
    Start,
    Middle,
    End,
}

impl TextAnchor {
    /// Returns the part of a text's length before its place.
    pub fn share(self) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5,
            Self::End => 1.0,
        }
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextItem {
    pub text: String,
    pub letters: Vec<PlacedLetter>,
    pub is_upward: bool,
    /// The point to which the text is aligned, on its baseline, and which part of it is there.
    pub place: Point,
    pub anchor: TextAnchor,
}

impl SceneItem {
    /// Maps all points of the item with `to`. The clip rectangle is not changed.
    #[must_use]
    pub fn mapped(mut self, to: impl Fn(Point) -> Point) -> Self {
        if let Some(words) = &mut self.words {
            words.place = to(words.place);
            for letter in &mut words.letters {
                letter.origin = to(letter.origin);
            }
        }
        self.path = self.path.mapped(to);
        self
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct PageScene {
    pub width_pt: f64,
    pub height_pt: f64,
    /// The title in the file's metadata, which is not drawn.
    pub title: String,
    /// What its readers must know of the runs on it, such as that one is not reliable; not drawn, but kept in the file.
    pub caveats: Vec<String>,
    pub items: Vec<SceneItem>,
    /// Whether numbers that are written on it have a decimal comma.
    pub decimal_comma: bool,
}

impl PageScene {
    /// Moves each point of the page to where `to` says, clip rectangles included.
    pub fn map(&mut self, to: impl Fn(Point) -> Point) {
        for item in &mut self.items {
            *item = item.clone().mapped(&to);
            item.clip = item.clip.map(|corners| corners.map(&to));
        }
    }

    /// Magnifies the page and everything on it by `factor`.
    pub fn magnify(&mut self, factor: f64) {
        if factor == 1.0 {
            return;
        }
        self.width_pt *= factor;
        self.height_pt *= factor;
        self.map(|point| at(factor * point.x, factor * point.y));
        for item in &mut self.items {
            if let Paint::Stroke(pen) = &mut item.paint {
                pen.width_pt *= factor;
                pen.dash_pt.iter_mut().for_each(|length| *length *= factor);
            }
            for letter in item.words.iter_mut().flat_map(|words| &mut words.letters) {
                letter.size_pt *= factor;
            }
        }
    }

    /// Groups consecutive items with the same paint and clip rectangle.
    pub fn groups(&self) -> impl Iterator<Item = &[SceneItem]> {
        self.items
            .chunk_by(|a, b| a.paint == b.paint && a.clip == b.clip)
    }
}
