//! The lines that draw solid parts.

use crate::physics::part::{PlacedSolid, Shape};
use nalgebra::Vector3;
use std::f64::consts::TAU;

const OUTLINE_PARTS: usize = 48;
/// Number of lines along a round solid, from end to end.
const SIDES: usize = 4;
/// Relative difference below which lengths are drawn as equal.
const SAME_SHARE: f64 = 0.02;

#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// Its points, body frame, m. There are at least two.
    pub points: Vec<Vector3<f64>>,
    pub kind: LineKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineKind {
    /// A line on a round part.
    Outline,
    /// The single line that shows the rotation of a round part about its axis.
    Mark,
    /// An edge of a block.
    Edge {
        /// The outward normals of the two faces that meet there, unit vectors in the body frame.
        faces: [Vector3<f64>; 2],
        /// True if the edge distinguishes the two ends of the block.
        is_marked: bool,
    },
}

/// Returns the lines of `part`. A part given by its moments is drawn as the block with these moments if the three
/// differ, or else as the thin ellipsoid.
pub fn lines(part: &PlacedSolid) -> Vec<Polyline> {
    let mut lines = own_lines(part);
    for line in &mut lines {
        for point in &mut line.points {
            *point = part.center + part.directions * *point;
        }
        if let LineKind::Edge { faces, .. } = &mut line.kind {
            *faces = faces.map(|normal| part.directions * normal);
        }
    }
    lines
}

fn own_lines(part: &PlacedSolid) -> Vec<Polyline> {
    match part.shape {
        Shape::Ring { radius } => vec![circle(radius, 0.0), mark(0.0, radius, 0.0)],
        Shape::Cylinder { radius, length } => {
            round([(radius, -0.5 * length), (radius, 0.5 * length)], None)
        }
        Shape::Tube {
            inner,
            outer,
            length,
        } => round([(outer, -0.5 * length), (outer, 0.5 * length)], Some(inner)),
        Shape::Rod { length } => vec![straight([
            Vector3::new(0.0, 0.0, -0.5 * length),
            Vector3::new(0.0, 0.0, 0.5 * length),
        ])],
        Shape::Ball { radius } | Shape::Shell { radius } => ellipsoid([radius; 3]),
        Shape::Cone { radius, length } => {
            let base = 0.25 * length;
            round([(0.0, base - length), (radius, base)], None)
        }
        Shape::Block { size } => block(&size),
        Shape::Moments(_) if are_distinct(&part.distances) => {
            let side = libm::sqrt(12.0);
            block(&Vector3::from(
                part.distances.map(|distance| side * distance),
            ))
        }
        Shape::Moments(_) => ellipsoid(part.distances),
    }
}

/// Returns true if all pairs of `distances` differ by more than [`SAME_SHARE`] of the largest.
fn are_distinct(distances: &[f64; 3]) -> bool {
    let [a, b, c] = *distances;
    let least = SAME_SHARE * a.max(b).max(c);
    [a - b, b - c, c - a]
        .iter()
        .all(|apart| apart.abs() > least)
}

fn ellipsoid([x, y, z]: [f64; 3]) -> Vec<Polyline> {
    [
        [Vector3::new(x, 0.0, 0.0), Vector3::new(0.0, y, 0.0)],
        [Vector3::new(x, 0.0, 0.0), Vector3::new(0.0, 0.0, z)],
        [Vector3::new(0.0, y, 0.0), Vector3::new(0.0, 0.0, z)],
    ]
    .map(|[right, up]| Polyline {
        points: circle(1.0, 0.0)
            .points
            .iter()
            .map(|at| at.x * right + at.y * up)
            .collect(),
        kind: LineKind::Outline,
    })
    .to_vec()
}

/// Returns the lines of a round solid between two circles, each given by radius and height, with the radius of its
/// hole. A mark is on top.
///
/// A flat solid has only one circle. A circle of radius 0 is omitted.
fn round(ends: [(f64, f64); 2], hole: Option<f64>) -> Vec<Polyline> {
    let [(lower, bottom), (upper, top)] = ends;
    let is_flat = bottom == top;
    let mut lines: Vec<_> = ends
        .into_iter()
        .skip(usize::from(is_flat))
        .filter(|(radius, _)| *radius > 0.0)
        .map(|(radius, z)| circle(radius, z))
        .collect();
    if !is_flat {
        lines.extend((0..SIDES).map(|side| {
            let (sin, cos) = libm::sincos(TAU * side as f64 / SIDES as f64);
            straight([
                Vector3::new(lower * cos, lower * sin, bottom),
                Vector3::new(upper * cos, upper * sin, top),
            ])
        }));
    }
    lines.extend(hole.map(|inner| circle(inner, top)));
    lines.push(mark(hole.unwrap_or(0.0), upper, top));
    lines
}

fn circle(radius: f64, z: f64) -> Polyline {
    Polyline {
        points: (0..=OUTLINE_PARTS)
            .map(|part| {
                let (sin, cos) =
                    libm::sincos(TAU * (part % OUTLINE_PARTS) as f64 / OUTLINE_PARTS as f64);
                Vector3::new(radius * cos, radius * sin, z)
            })
            .collect(),
        kind: LineKind::Outline,
    }
}

fn mark(inner: f64, outer: f64, z: f64) -> Polyline {
    Polyline {
        kind: LineKind::Mark,
        ..straight([Vector3::new(inner, 0.0, z), Vector3::new(outer, 0.0, z)])
    }
}

fn straight(ends: [Vector3<f64>; 2]) -> Polyline {
    Polyline {
        points: ends.to_vec(),
        kind: LineKind::Outline,
    }
}

/// Returns the edges of a block. The edges at the +y end (the upper edges of a phone) are marked.
fn block(size: &Vector3<f64>) -> Vec<Polyline> {
    let half = 0.5 * size;
    let mut edges = Vec::new();
    for along in 0..3 {
        let across = [(along + 1) % 3, (along + 2) % 3];
        for sides in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
            let faces = [0, 1].map(|face| {
                let mut normal = Vector3::zeros();
                normal[across[face]] = sides[face];
                normal
            });
            let middle = (faces[0] + faces[1]).component_mul(&half);
            let mut reach = Vector3::zeros();
            reach[along] = half[along];
            edges.push(Polyline {
                kind: LineKind::Edge {
                    faces,
                    is_marked: along == 0 && middle.y > 0.0,
                },
                ..straight([middle - reach, middle + reach])
            });
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(shape: Shape) -> PlacedSolid {
        let center = Vector3::new(0.1, 0.2, 0.3);
        PlacedSolid::new(shape, 2.0, center, &Vector3::new(1.0, 2.0, -2.0)).unwrap()
    }

    /// Returns the extent of a solid's lines along its own x, y and axis, from minimum to maximum.
    fn extents(shape: Shape) -> [(f64, f64); 3] {
        let part = part(shape);
        let lines = lines(&part);
        let points = lines.iter().flat_map(|line| &line.points);
        let own = points.map(|at| part.directions.tr_mul(&(at - part.center)));
        let none = [(f64::INFINITY, f64::NEG_INFINITY); 3];
        own.fold(none, |reach, at| {
            std::array::from_fn(|i| (reach[i].0.min(at[i]), reach[i].1.max(at[i])))
        })
    }

    #[test]
    fn outlines_have_the_extent_of_the_solid() {
        let (radius, length) = (0.5, 0.8);
        let (inner, outer) = (0.2, 0.5);
        let size = Vector3::new(0.2, 0.4, 0.6);
        let both = |half: [f64; 3]| half.map(|half| (-half, half));
        // A shell of radius R has three moments of 2 R²/3: they are drawn as the thin ellipsoid with these moments.
        let moments = Vector3::repeat(2.0 / 3.0 * 0.25);
        for (shape, expected) in [
            (Shape::Ring { radius }, both([0.5, 0.5, 0.0])),
            (Shape::Cylinder { radius, length }, both([0.5, 0.5, 0.4])),
            (
                Shape::Tube {
                    inner,
                    outer,
                    length,
                },
                both([0.5, 0.5, 0.4]),
            ),
            (Shape::Rod { length }, both([0.0, 0.0, 0.4])),
            (Shape::Ball { radius }, both([0.5; 3])),
            (Shape::Block { size }, both([0.1, 0.2, 0.3])),
            (Shape::Moments(moments), both([0.5; 3])),
            // The apex of a cone points against its axis, three quarters of its length from the center.
            (
                Shape::Cone { radius, length },
                [(-0.5, 0.5), (-0.5, 0.5), (-0.6, 0.2)],
            ),
        ] {
            for ((least, most), (low, high)) in extents(shape).into_iter().zip(expected) {
                let is_near = (most - high).abs() < 1e-15 && (least - low).abs() < 1e-15;
                assert!(is_near, "{shape:?}: {least} to {most}");
            }
        }
    }
}
