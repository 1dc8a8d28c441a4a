//! The paths in the box: what is near is wide and dark.

use super::{Space, TALL, round_pen};
use crate::cores;
use crate::figure::chart::Style;
use crate::figure::chart::axis::Scale;
use crate::figure::chart::curve;
use crate::figure::chart::dashes::Ground;
use crate::figure::page::ink::grey;
use crate::figure::page::scene::{Color, Item, Pen, Point, Scene};
use crate::figure::request::Drawn;
use foldhash::fast::FixedState;
use std::collections::HashSet;

/// Degrees of depth.
const DEPTHS: usize = 6;
/// Width of the nearest and of the farthest line, pt, and the part of white in the farthest.
const WIDTHS: (f64, f64) = (0.95, 0.5);
const FARTHEST_WHITE: f64 = 0.58;

/// A path, or its shadow on the floor: places on the page and their depths, in pieces.
type Pieces = Vec<Vec<(Point, f64)>>;

/// Lines that are drawn together.
struct Layer {
    pieces: Vec<Vec<Point>>,
    pen: Pen,
    is_dots: bool,
    ground: Ground,
}

impl Space {
    /// The paths, the farthest parts first, and their shadows behind them.
    pub(super) fn paths(&self, drawn: &[Drawn], styles: &[Style], scene: &mut Scene) {
        let all = drawn.iter().zip(styles);
        let both = all.flat_map(|(drawn, style)| [(drawn, style, true), (drawn, style, false)]);
        let pieces = |&(drawn, style, is_shadow): &_| self.pieces(drawn, style, is_shadow);
        let pieces: Vec<Pieces> = cores::map(&both.collect::<Vec<_>>(), pieces);
        let (shadows, paths): (Vec<_>, Vec<_>) =
            pieces.chunks(2).map(|of| (&of[0], &of[1])).unzip();
        let shadows = shadows
            .into_iter()
            .zip(styles)
            .map(|(pieces, style)| Layer {
                pieces: pieces.iter().map(|piece| places(piece).collect()).collect(),
                pen: round_pen(0.45, grey(198)),
                is_dots: style.is_dots,
                ground: Ground::default(),
            });
        let layers: Vec<Layer> = shadows.chain(layers(&paths, styles)).collect();
        let items: Vec<Vec<Item>> = cores::map(&layers, Layer::items);
        scene.items.extend(items.into_iter().flatten());
    }

    /// The path of `drawn`, or its shadow, without the lines that cover others.
    fn pieces(&self, drawn: &Drawn, style: &Style, is_shadow: bool) -> Pieces {
        let place = |point: &[f64; 3]| {
            let mut boxed = self.boxed(point);
            if is_shadow {
                boxed.z = -0.5 * TALL;
            }
            (self.place(&boxed), self.view.depth(&boxed))
        };
        let place_pt = match is_shadow || style.dash_pt.is_empty() {
            true => PLACE_PT,
            false => DASHED_PLACE_PT,
        };
        fresh(drawn.course.path.iter().map(place), place_pt)
    }
}

fn places(piece: &[(Point, f64)]) -> impl Iterator<Item = Point> {
    piece.iter().map(|(place, _)| *place)
}

/// The parts of `paths` by their depth, the farthest first.
fn layers(paths: &[&Pieces], styles: &[Style]) -> Vec<Layer> {
    let depths = || {
        paths
            .iter()
            .copied()
            .flatten()
            .flatten()
            .map(|(_, depth)| *depth)
    };
    let (near, far) = (
        depths().fold(f64::INFINITY, f64::min),
        depths().fold(f64::NEG_INFINITY, f64::max),
    );
    let share = Scale {
        range: (far, near),
        is_log: false,
        places: (0.0, DEPTHS as f64),
    };
    let degree = |depth: f64| (share.place(depth).max(0.0) as usize).min(DEPTHS - 1);
    let mut by_degree: Vec<_> = paths.iter().map(|path| by_degree(path, degree)).collect();
    let grounds: Vec<_> = paths.iter().zip(styles).map(ground).collect();
    let mut layers = Vec::new();
    for nearness in 0..DEPTHS {
        let part = nearness as f64 / (DEPTHS - 1) as f64;
        let width = WIDTHS.1 + part * (WIDTHS.0 - WIDTHS.1);
        for ((by_degree, style), ground) in by_degree.iter_mut().zip(styles).zip(&grounds) {
            let color = paler(style.color, FARTHEST_WHITE * (1.0 - part));
            layers.push(Layer {
                pieces: std::mem::take(&mut by_degree[nearness]),
                pen: Pen {
                    dash_pt: style.dash_pt.to_vec(),
                    ..round_pen(width, color)
                },
                is_dots: style.is_dots,
                ground: *ground,
            });
        }
    }
    layers
}

/// The ground of a dashed path, which is not to lie in its own gaps; of others none is needed.
fn ground((path, style): (&&Pieces, &Style)) -> Ground {
    if style.dash_pt.is_empty() {
        return Ground::default();
    }
    let mut ground = Ground::of(path.iter().map(|piece| places(piece)));
    // In more than one piece it has been where it is before.
    ground.is_covered |= path.len() > 1;
    ground
}

impl Layer {
    fn items(&self) -> Vec<Item> {
        let mut scene = Scene::new(0.0, 0.0, "");
        let dots;
        let pieces = match self.is_dots {
            true => {
                dots = curve::dots(self.pieces.iter().flatten().copied());
                &dots
            }
            false => &self.pieces,
        };
        curve::draw_plane_curve(&self.ground, pieces, &self.pen, None, &mut scene);
        scene.items
    }
}

/// From so many points on, a path leaves out the lines that it has drawn before.
const MANY: usize = 50_000;
/// Two points within a square of this side stand at one place, pt: a sixth of a line's width.
const PLACE_PT: f64 = 0.1;
/// The same of a dashed line, the strokes of which are cut piece by piece: a third of its width.
const DASHED_PLACE_PT: f64 = 0.3;

/// `path` in pieces: where it has many points, without the lines between places of that size (pt) that a line connects already.
fn fresh(path: impl ExactSizeIterator<Item = (Point, f64)>, place_pt: f64) -> Pieces {
    if path.len() < MANY {
        return vec![path.collect()];
    }
    let place = |point: &Point| {
        let number = |length: f64| u64::from((length / place_pt).floor() as i32 as u32);
        number(point.x) << 32 | number(point.y)
    };
    let mut drawn = HashSet::with_hasher(FixedState::default());
    let mut pieces = Vec::new();
    let mut piece: Vec<(Point, f64)> = Vec::new();
    for here in path {
        let Some((last, _)) = piece.last() else {
            piece.push(here);
            continue;
        };
        let (from, to) = (place(last), place(&here.0));
        if from == to {
            continue;
        }
        if drawn.insert((from.min(to), from.max(to))) {
            piece.push(here);
        } else if piece.len() > 1 {
            pieces.push(std::mem::replace(&mut piece, vec![here]));
        } else {
            piece[0] = here;
        }
    }
    pieces.push(piece);
    pieces
}

/// A path's lines by the degree of depth at which they begin: those that follow each other are one piece.
fn by_degree(
    path: &[Vec<(Point, f64)>],
    degree: impl Fn(f64) -> usize,
) -> [Vec<Vec<Point>>; DEPTHS] {
    let mut pieces: [Vec<Vec<Point>>; DEPTHS] = Default::default();
    for path in path {
        let mut last = None;
        for pair in path.windows(2) {
            let degree = degree(pair[0].1);
            let pieces = &mut pieces[degree];
            match pieces.last_mut() {
                Some(piece) if last == Some(degree) => piece.push(pair[1].0),
                _ => pieces.push(vec![pair[0].0, pair[1].0]),
            }
            last = Some(degree);
        }
    }
    pieces
}

/// `color` with that part of white in it.
fn paler(color: Color, white: f64) -> Color {
    let mixed = |part: u8| (f64::from(part) + white * (255.0 - f64::from(part))).round() as u8;
    Color(color.0.map(mixed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::page::ink::at;

    fn circle(points: usize) -> Vec<(Point, f64)> {
        let angle = |number: usize| 0.01 * number as f64;
        let place = |number| {
            at(
                50.0 * libm::cos(angle(number)),
                50.0 * libm::sin(angle(number)),
            )
        };
        (0..points).map(|number| (place(number), 0.0)).collect()
    }

    #[test]
    fn a_path_is_drawn_over_itself_once() {
        assert_eq!(fresh(circle(2000).into_iter(), PLACE_PT), [circle(2000)]);
        let pieces = fresh(circle(200_000).into_iter(), PLACE_PT);
        let points: usize = pieces.iter().map(Vec::len).sum();
        assert!(points < 20_000, "{points}");
        // Nothing is missing of the first time around.
        assert!(pieces[0].len() >= 600);
    }
}
