//! Draws lines, marks and words on a page.

use super::letters::{self, SetLabel};
pub use super::scene::at;
use super::scene::{
    Color, PageScene, Paint, Point, SceneItem, Segment, StrokeStyle, TextAnchor, TextItem,
    VectorPath,
};

pub const TITLE_PT: f64 = 8.0;
pub const LABEL_PT: f64 = 7.0;
pub const MARK_PT: f64 = 1.6;

pub const BLACK: Color = Color([0; 3]);
pub const WHITE: Color = Color([255; 3]);

pub const fn grey(level: u8) -> Color {
    Color([level; 3])
}

/// Mixes `color` with white; `white` is the fraction of white.
pub fn paler(Color(parts): Color, white: f64) -> Color {
    Color(parts.map(|part| (f64::from(part) + white * (255.0 - f64::from(part))).round() as u8))
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PageRectangle {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl PageRectangle {
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub fn grown(&self, by: f64) -> Self {
        Self {
            left: self.left - by,
            top: self.top - by,
            right: self.right + by,
            bottom: self.bottom + by,
        }
    }

    pub fn holds(&self, point: Point) -> bool {
        (self.left..=self.right).contains(&point.x) && (self.top..=self.bottom).contains(&point.y)
    }

    /// Returns the point of the rectangle that is closest to `point`. A NaN coordinate gives the right or the lower edge.
    pub fn nearest(&self, point: Point) -> Point {
        at(
            point.x.min(self.right).max(self.left),
            point.y.min(self.bottom).max(self.top),
        )
    }

    pub fn corners(&self) -> [Point; 2] {
        [at(self.left, self.top), at(self.right, self.bottom)]
    }

    pub fn outline(&self) -> VectorPath {
        let corners = [
            at(self.left, self.top),
            at(self.right, self.top),
            at(self.right, self.bottom),
            at(self.left, self.bottom),
        ];
        VectorPath::polygon(corners)
    }
}

pub fn circle(middle: Point, radius_pt: f64) -> VectorPath {
    /// Distance of the control points of a quarter circle from its ends, in radii.
    const BEND: f64 = 0.552_285;
    let (r, b) = (radius_pt, BEND * radius_pt);
    let quarters = [
        [(r, b), (b, r), (0.0, r)],
        [(-b, r), (-r, b), (-r, 0.0)],
        [(-r, -b), (-b, -r), (0.0, -r)],
        [(b, -r), (r, -b), (r, 0.0)],
    ];
    let mut path = vec![Segment::Move(off(middle, (r, 0.0)))];
    path.extend(quarters.map(|quarter| {
        let [first, second, end] = quarter.map(|by| off(middle, by));
        Segment::Cubic(first, second, end)
    }));
    path.push(Segment::Close);
    VectorPath(path)
}

/// Creates a polygon with these `corners` relative to `middle`, pt.
fn polygon(middle: Point, corners: &[(f64, f64)]) -> VectorPath {
    VectorPath::polygon(corners.iter().map(|corner| off(middle, *corner)))
}

/// Returns the point `x` to the right of and `y` below `from`, pt.
fn off(from: Point, (x, y): (f64, f64)) -> Point {
    at(from.x + x, from.y + y)
}

pub fn pen(width_pt: f64, color: Color) -> StrokeStyle {
    StrokeStyle {
        width_pt,
        color,
        dash_pt: Vec::new(),
        is_round: false,
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointMark {
    Dot,
    Square,
    Triangle,
    Diamond,
    /// A triangle that points down.
    Tip,
    Star,
    Ring,
    OpenSquare,
    OpenTriangle,
    OpenDiamond,
    OpenTip,
    OpenStar,
    Cross,
    Plus,
    Speck,
}

impl PointMark {
    /// Returns true if the mark shows values that can have an error, neither theory nor exactly known numbers.
    pub fn is_of_measured(self) -> bool {
        !matches!(self, Self::Cross | Self::Plus | Self::Speck)
    }
}

pub fn width(markup: &str, size_pt: f64) -> f64 {
    letters::label(markup, size_pt).width_pt
}

/// Returns the height of a digit 0 at this font size, pt.
pub fn height(size_pt: f64) -> f64 {
    letters::label("0", size_pt).ascent_pt
}

impl PageScene {
    pub fn new(width_pt: f64, height_pt: f64, title: &str) -> Self {
        Self {
            width_pt,
            height_pt,
            title: title.to_owned(),
            caveats: Vec::new(),
            items: Vec::new(),
            decimal_comma: false,
        }
    }

    pub fn fill(&mut self, path: VectorPath, color: Color) {
        self.fill_in(path, color, None);
    }

    pub fn fill_in(&mut self, path: VectorPath, color: Color, clip: Option<&PageRectangle>) {
        self.put(path, Paint::Fill(color), clip, None);
    }

    pub fn stroke(&mut self, path: VectorPath, pen: StrokeStyle, clip: Option<&PageRectangle>) {
        self.put(path, Paint::Stroke(pen), clip, None);
    }

    pub fn line(&mut self, ends: [Point; 2], width_pt: f64, color: Color) {
        self.stroke(VectorPath::polyline(ends), pen(width_pt, color), None);
    }

    /// Writes `markup` on a baseline through `place`, positioned by its `anchor`.
    pub fn write(&mut self, markup: &str, size_pt: f64, place: Point, anchor: TextAnchor) {
        let label = letters::label(&self.with_comma(markup), size_pt);
        let left = place.x - anchor.share() * label.width_pt;
        self.letters(label, anchor, false, |p| at(left + p.x, place.y + p.y));
    }

    /// Writes `markup` upward, with its baseline centered at `middle`.
    pub fn write_up(&mut self, markup: &str, size_pt: f64, middle: Point) {
        let label = letters::label(&self.with_comma(markup), size_pt);
        let bottom = middle.y + 0.5 * label.width_pt;
        let to = |p: Point| at(middle.x + p.y, bottom - p.x);
        self.letters(label, TextAnchor::Middle, true, to);
    }

    /// Returns `markup` with the decimal sign of this page in its numbers. Both signs have the same width.
    fn with_comma(&self, markup: &str) -> String {
        let letters: Vec<char> = markup.chars().collect();
        let is_digit = |place: Option<usize>| {
            place.is_some_and(|place| letters.get(place).is_some_and(char::is_ascii_digit))
        };
        let is_sign = |place: usize| {
            self.decimal_comma
                && letters[place] == '.'
                && is_digit(place.checked_sub(1))
                && is_digit(place.checked_add(1))
        };
        (0..letters.len())
            .map(|place| if is_sign(place) { ',' } else { letters[place] })
            .collect()
    }

    fn letters(
        &mut self,
        label: SetLabel,
        anchor: TextAnchor,
        is_upward: bool,
        to: impl Fn(Point) -> Point,
    ) {
        let words = TextItem {
            text: label.words,
            letters: label.letters,
            is_upward,
            place: at(anchor.share() * label.width_pt, 0.0),
            anchor,
        };
        let item = SceneItem {
            path: label.path,
            paint: Paint::Fill(BLACK),
            clip: None,
            words: Some(words),
        };
        self.items.push(item.mapped(to));
    }

    pub fn mark(&mut self, mark: PointMark, middle: Point, color: Color) {
        self.mark_of_size(mark, MARK_PT, middle, color);
    }

    /// Draws a mark in the size that corresponds to a dot of radius `r`, pt.
    pub fn mark_of_size(&mut self, mark: PointMark, r: f64, middle: Point, color: Color) {
        let (x, y) = (1.2 * r, 0.9 * r);
        let (path, is_filled) = match mark {
            PointMark::Cross => {
                let d = 1.1 * r;
                let lines = [[(-d, d), (d, -d)], [(-d, -d), (d, d)]];
                return self.thin_lines(middle, lines, color);
            }
            PointMark::Plus => {
                let d = 1.4 * r;
                let lines = [[(-d, 0.0), (d, 0.0)], [(0.0, -d), (0.0, d)]];
                return self.thin_lines(middle, lines, color);
            }
            PointMark::Speck => (circle(middle, 0.5 * r), true),
            PointMark::Dot => (circle(middle, r), true),
            PointMark::Ring => (circle(middle, r), false),
            PointMark::Square | PointMark::OpenSquare => {
                let r = 0.92 * r;
                let corners = [(-r, -r), (r, -r), (r, r), (-r, r)];
                (polygon(middle, &corners), mark == PointMark::Square)
            }
            PointMark::Triangle | PointMark::OpenTriangle => {
                let corners = [(0.0, -1.3 * r), (x, y), (-x, y)];
                (polygon(middle, &corners), mark == PointMark::Triangle)
            }
            PointMark::Tip | PointMark::OpenTip => {
                let corners = [(0.0, 1.3 * r), (x, -y), (-x, -y)];
                (polygon(middle, &corners), mark == PointMark::Tip)
            }
            PointMark::Diamond | PointMark::OpenDiamond => {
                let r = 1.35 * r;
                let corners = [(0.0, -r), (r, 0.0), (0.0, r), (-r, 0.0)];
                (polygon(middle, &corners), mark == PointMark::Diamond)
            }
            PointMark::Star | PointMark::OpenStar => {
                let (far, near) = (1.7 * r, 0.5 * r);
                let corners = [
                    (0.0, -far),
                    (near, -near),
                    (far, 0.0),
                    (near, near),
                    (0.0, far),
                    (-near, near),
                    (-far, 0.0),
                    (-near, -near),
                ];
                (polygon(middle, &corners), mark == PointMark::Star)
            }
        };
        if is_filled {
            return self.fill(path, color);
        }
        self.fill(path.clone(), WHITE);
        self.stroke(path, pen(0.6 * r / MARK_PT, color), None);
    }

    /// Draws the two lines of a mark around `middle`.
    fn thin_lines(&mut self, middle: Point, lines: [[(f64, f64); 2]; 2], color: Color) {
        for line in lines {
            self.line(line.map(|end| off(middle, end)), 0.5, color);
        }
    }

    fn put(
        &mut self,
        path: VectorPath,
        paint: Paint,
        clip: Option<&PageRectangle>,
        words: Option<TextItem>,
    ) {
        self.items.push(SceneItem {
            path,
            paint,
            clip: clip.map(PageRectangle::corners),
            words,
        });
    }
}
