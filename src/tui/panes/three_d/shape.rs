//! The body as it is drawn: rim, axle, free points and solid parts.

use super::solids::Solid;
use crate::observe::live::LiveRun;
use nalgebra::Vector3;

const MOST_FREE: usize = 60;

/// The body as it is drawn, upright: distances from the axle and heights.
pub struct Shape {
    /// Radius, height and number of points of the rim.
    pub rim: Option<(f64, f64, usize)>,
    /// Heights between which there is an axle.
    pub axle: (f64, f64),
    /// Distance from the axle and height of the rim and of each free point that is drawn.
    pub corners: Vec<(f64, f64)>,
    /// The free points that have a mass.
    pub free: Vec<Vector3<f64>>,
    pub solids: Vec<Solid>,
}

impl Shape {
    pub fn of(run: &LiveRun) -> Self {
        let scenario = run.scenario();
        let points = scenario.body.mechanics.points();
        let rim = scenario.file.body.rim.as_ref();
        let rim = rim.map(|rim| (rim.radius_m, rim.height_m, rim.points));
        let after = rim.map_or(0, |(_, _, points)| points);
        let count = scenario.file.body.point.len().min(MOST_FREE);
        let free: Vec<_> = points.iter().skip(after).take(count).collect();
        let traced = points[scenario.trace].at;
        let mut corners: Vec<_> = rim
            .iter()
            .map(|&(radius, height, _)| (radius, height))
            .collect();
        let corner = |at: &Vector3<f64>| (at.xy().norm(), at.z);
        corners.extend(free.iter().map(|point| corner(&point.at)));
        corners.push(corner(&traced));
        let solids = Solid::of(&scenario.body.parts);
        corners.extend(solids.iter().flat_map(Solid::corners));
        let heights = || corners.iter().map(|(_, height)| *height);
        let axle = (heights().fold(0.0, f64::min), heights().fold(0.0, f64::max));
        let has_mass = free.iter().filter(|point| point.mass > 0.0);
        let free = has_mass.map(|point| point.at).collect();
        Self {
            rim,
            axle,
            corners,
            free,
            solids,
        }
    }

    /// The distance of the farther end of the axle from the pivot, m.
    pub fn arm(&self) -> f64 {
        self.axle.0.abs().max(self.axle.1.abs())
    }

    /// The size of the body, m.
    pub fn reach(&self) -> f64 {
        let reaches = self
            .corners
            .iter()
            .map(|(across, height)| across.hypot(*height));
        reaches.fold(f64::MIN_POSITIVE, f64::max)
    }
}
