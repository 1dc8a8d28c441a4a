//! The line of a series on the page, without the points that nobody could see.

use super::dashes::{self, Ground, Strokes};
use super::layout::Placed;
use super::{Circles, Series};
use crate::figure::page::clip::clipped;
use crate::figure::page::ink::{Frame, at};
use crate::figure::page::scene::{Path, Pen, Point, Scene};
use crate::figure::page::thin::{Thinned, plane_curve};

/// Width of a column of which only first, lowest, highest and last point are drawn, pt. It is well below the width of a line,
/// and below a dot at 300 dpi.
const THINNED_PT: f64 = 0.2;
/// Swings of a dashed line that are lower than this are drawn as their middle, pt: they would take up its dashes.
const FLAT_PT: f64 = 0.4;
/// How far outside of its panel a line is followed, pt: half its width, which is cut off at the edge.
const BEYOND_PT: f64 = 2.0;

impl Placed {
    /// Where `point` stands on the page.
    pub fn place(&self, point: &[f64; 2]) -> Point {
        at(self.x.place(point[0]), self.y.place(point[1]))
    }

    /// Draws the line of `series` in this panel.
    pub fn draw_line(&self, series: &Series, scene: &mut Scene) {
        let places = series.points.iter().map(|point| self.place(point));
        let clip = self.frame.grown(BEYOND_PT);
        let pieces = match series.style.is_dots {
            true => dots(places.filter(|place| clip.holds(*place))),
            false => clipped(places, &clip),
        };
        draw_curve(&pieces, &series.style.pen(), Some(&self.frame), scene);
    }

    /// Whether a part of one of `circles` is drawn in `frame`.
    pub fn has_circle_in(&self, frame: &Frame, circles: &Circles) -> bool {
        let middle = self.place(&[0.0, 0.0]);
        let near = |low: f64, high: f64, at: f64| (low - at).max(at - high).max(0.0);
        let far = |low: f64, high: f64, at: f64| (at - low).abs().max((high - at).abs());
        let [nearest, farthest] = [&near as &dyn Fn(f64, f64, f64) -> f64, &far].map(|distance| {
            let across = distance(frame.left, frame.right, middle.x);
            across.hypot(distance(frame.top, frame.bottom, middle.y))
        });
        let mut radii = circles.radii.iter();
        radii.any(|radius| {
            let radius = self.x.place(*radius) - middle.x;
            (nearest..=farthest).contains(&radius)
        })
    }

    /// Whether something of `series` is drawn in `frame`.
    pub fn has_in(&self, frame: &Frame, series: &Series) -> bool {
        if series.style.width_pt > 0.0 {
            let places = series.points.iter().map(|point| self.place(point));
            if !clipped(places, frame).is_empty() {
                return true;
            }
        }
        let ends = series.points.iter().enumerate().map(|(index, point)| {
            let error = series.errors.get(index).copied().filter(|e| e.is_finite());
            [-1.0, 1.0].map(|sign| point[1] + sign * error.unwrap_or(0.0))
        });
        let bars = series.points.iter().zip(ends).map(|(point, ends)| {
            let bar = ends.map(|end| self.place(&[point[0], end]));
            clipped(bar.into_iter(), frame)
        });
        let across = series.points.iter().zip(&series.errors_across);
        let mut across = across.map(|(point, &error)| {
            let error = if error.is_finite() { error } else { 0.0 };
            let bar = [-1.0, 1.0].map(|sign| self.place(&[point[0] + sign * error, point[1]]));
            clipped(bar.into_iter(), frame)
        });
        series.style.mark.is_some()
            && (bars.into_iter().any(|bar| !bar.is_empty()) || across.any(|bar| !bar.is_empty()))
    }
}

/// A dot at each of `places`, as the shortest line that every program draws.
pub fn dots(places: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    const LENGTH_PT: f64 = 0.02;
    let dot = |place: Point| vec![place, at(place.x + LENGTH_PT, place.y)];
    places.map(dot).collect()
}

/// Draws a line that is cut off outside of `clip`, in fewer pieces that look the same.
pub fn draw_curve(pieces: &[Vec<Point>], pen: &Pen, clip: Option<&Frame>, scene: &mut Scene) {
    let runs_right = pieces.iter().flatten().is_sorted_by(|a, b| b.x >= a.x);
    let is_dashed = !pen.dash_pt.is_empty();
    if runs_right {
        let flat = if is_dashed { FLAT_PT } else { 0.0 };
        for line in pieces.iter().map(|piece| thinned(piece, flat)) {
            stroke(line, pen, dashes::by_width, clip, scene);
        }
        return;
    }
    draw_plane_curve(
        &Ground::of(pieces.iter().map(|piece| piece.iter().copied())),
        pieces,
        pen,
        clip,
        scene,
    );
}

/// The same of pieces of lines which may turn back; `ground` is that of all pieces of the line.
pub fn draw_plane_curve(
    ground: &Ground,
    pieces: &[Vec<Point>],
    pen: &Pen,
    clip: Option<&Frame>,
    scene: &mut Scene,
) {
    if pen.dash_pt.is_empty() {
        return draw_thinned(plane_curve(pieces, pen.width_pt), pen, clip, scene);
    }
    if !ground.is_covered
        && let Thinned::Lines(lines) = plane_curve(pieces, pen.width_pt)
    {
        for line in lines {
            stroke(line, pen, dashes::by_way, clip, scene);
        }
        return;
    }
    // It would fill its own gaps.
    let strokes = ground.strokes(pieces, &pen.dash_pt);
    let strokes = plane_curve(&strokes, pen.width_pt);
    draw_thinned(strokes, &solid(pen), clip, scene);
}

fn draw_thinned(thinned: Thinned, pen: &Pen, clip: Option<&Frame>, scene: &mut Scene) {
    match thinned {
        Thinned::Area(area) => scene.fill_in(area, pen.color, clip),
        Thinned::Lines(lines) => {
            for line in lines {
                scene.stroke(Path::polyline(line), pen.clone(), clip);
            }
        }
    }
}

/// Draws `line`; of a dashed one that `cut` has strokes of, these.
fn stroke(
    line: Vec<Point>,
    pen: &Pen,
    cut: fn(&[Point], &[f64]) -> Option<Strokes>,
    clip: Option<&Frame>,
    scene: &mut Scene,
) {
    let strokes = match pen.dash_pt.is_empty() {
        true => None,
        false => cut(&line, &pen.dash_pt),
    };
    match strokes {
        None => scene.stroke(Path::polyline(line), pen.clone(), clip),
        Some(strokes) => {
            for line in strokes {
                scene.stroke(Path::polyline(line), solid(pen), clip);
            }
        }
    }
}

/// `pen` without its dashes.
fn solid(pen: &Pen) -> Pen {
    Pen {
        dash_pt: Vec::new(),
        ..pen.clone()
    }
}

/// `points`, which run to the right, with their first, lowest, highest and last of each column alone; with one in the middle,
/// where all of a column's are no farther apart than `flat_pt`.
fn thinned(points: &[Point], flat_pt: f64) -> Vec<Point> {
    if points.len() < 8 {
        return points.to_vec();
    }
    let column = |point: &Point| (point.x / THINNED_PT).floor();
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |a: &&Point, b: &&Point| a.y.total_cmp(&b.y);
        let first = column.first();
        let lowest = column.iter().max_by(by_height);
        let highest = column.iter().min_by(by_height);
        let last = column.last();
        if let (Some(lowest), Some(highest)) = (lowest, highest)
            && column.len() > 1
            && lowest.y - highest.y < flat_pt
        {
            let x = 0.5 * (column[0].x + column[column.len() - 1].x);
            kept.push(at(x, 0.5 * (lowest.y + highest.y)));
            continue;
        }
        // In the order in which the line comes to them.
        let mut four: Vec<&Point> = [first, lowest, highest, last]
            .into_iter()
            .flatten()
            .collect();
        four.sort_by_key(|&point| std::ptr::from_ref(point));
        four.dedup_by(|a, b| std::ptr::eq(*a, *b));
        kept.extend(four.into_iter().copied());
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::chart::Style;
    use crate::figure::page::scene::{Item, Paint};
    use proptest::prelude::*;

    #[test]
    fn a_dashed_line_that_covers_itself_becomes_an_area_and_another_keeps_its_dashes() {
        let zigzag = |apart: f64| -> Vec<Point> {
            let place = |i: i32| at(f64::from(i % 2) * 40.0, f64::from(i) * apart);
            (0..6000).map(place).collect()
        };
        let drawn = |apart: f64| {
            let mut scene = Scene::new(100.0, 100.0, "");
            let pen = Style::exact().pen();
            draw_curve(&[zigzag(apart)], &pen, None, &mut scene);
            scene.items
        };
        let [area] = &drawn(0.01)[..] else {
            panic!("one area")
        };
        assert!(matches!(area.paint, Paint::Fill(_)) && area.path.0.len() < 1000);
        // It covers itself without becoming an area: its strokes are cut, and all of them are drawn.
        let strokes = drawn(1.5);
        assert!(strokes.len() > 1000, "{}", strokes.len());
        let is_solid =
            |item: &Item| matches!(&item.paint, Paint::Stroke(pen) if pen.dash_pt.is_empty());
        assert!(strokes.iter().all(is_solid));
        let circle = |i: i32| {
            at(
                50.0 * libm::cos(0.05 * f64::from(i)),
                50.0 * libm::sin(0.05 * f64::from(i)),
            )
        };
        let mut scene = Scene::new(100.0, 100.0, "");
        draw_curve(
            &[(0..120).map(circle).collect()],
            &Style::exact().pen(),
            None,
            &mut scene,
        );
        let [line] = &scene.items[..] else {
            panic!("one line")
        };
        assert!(!is_solid(line));
    }

    proptest! {
        #[test]
        fn thinning_keeps_every_extreme(values in prop::collection::vec(-1e3_f64..1e3, 8..4000), width in 1.0_f64..200.0) {
            let step = width / values.len() as f64;
            let points: Vec<_> = values.iter().enumerate().map(|(i, &y)| at(i as f64 * step, y)).collect();
            let kept = thinned(&points, 0.0);
            let columns = (width / THINNED_PT) as usize + 2;
            prop_assert!(kept.len() <= 4 * columns);
            for column in points.chunk_by(|a, b| (a.x / THINNED_PT).floor() == (b.x / THINNED_PT).floor()) {
                for wanted in [f64::min, f64::max] {
                    let extreme = column.iter().map(|p| p.y).reduce(wanted).unwrap();
                    let there = kept.iter().any(|p| p.y == extreme && column.iter().any(|c| c.x == p.x));
                    prop_assert!(there);
                }
            }
            prop_assert!(kept.windows(2).all(|pair| pair[0].x <= pair[1].x));
        }
    }
}
