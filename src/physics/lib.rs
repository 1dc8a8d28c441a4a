//! A rigid body that turns about a fixed point: its exact motion, and numerical schemes that step it.
//!
//! It uses no other crate of gyrolab. A new scheme, force or observable belongs here. Files, edits, and measurements of a whole
//! run belong to the crate `gyrolab-engine`.
//!
//! What turns is a [`Body`] of point masses; a solid [`PlacedSolid`] stands for six of them. It has a [`State`] (time, orientation,
//! angular momentum), and [`Loads`] act on it: gravity, constant forces on points, [`Friction`].
//!
//! - [`ExactMotion`] is the true motion: in closed form ([`LagrangeTop`]) where the body is symmetric about its axle and
//!   every force acts on the axle, else by a Taylor series held to rounding ([`AccurateMotion`](exact::AccurateMotion)).
//! - [`SCHEMES`](scheme::SCHEMES) lists the schemes, each with order and source. They make a [`Scheme`], which steps a
//!   state, and explains a step with all its numbers ([`workings`]).
//! - [`observables`] and [`symmetry`]: what is read off a state, and the theory of the symmetric top.
//!
//! # Frames, units, numbers
//! *World*: the origin is the pivot, +z is up. *Body*: fixed in the body, equal to the world frame in the upright pose; its
//! z axis is the axle. An orientation is the rotation matrix from body components to world components. Units are SI and
//! radians; degrees stand in names that end in `_deg`.
//!
//! No result depends on the processor or on the C library: sine, cosine and arc tangent are compiled in, sums have a fixed
//! order, and no multiply-add is fused. Where a number that comes in is not finite, what comes out is not a number. Only the
//! index of a point that the body does not have panics; where a function does, its text says so.
//!
//! # Examples
//! The exact motion of a heavy top: a ring of 5 kg and 0.8 m across a light axle of 1 m, let go at a tilt of 45 degrees.
//!
//! ```
//! use gyrolab_physics::{LagrangeTop, nalgebra::Vector3, rotation};
//! use std::f64::consts::FRAC_PI_4;
//!
//! let (across, along, load) = (6.6, 3.2, Vector3::new(0.0, 0.0, -49.0)); // kg m^2, kg m^2, N m
//! let tilted = rotation::about(&Vector3::x(), FRAC_PI_4);
//! let momentum = tilted * Vector3::new(0.0, 0.0, 100.0); // J s, along the axle
//! let top = LagrangeTop::new(across, along, load, tilted, momentum);
//! let (least, greatest) = top.tilt_range();
//! assert!((least - FRAC_PI_4).abs() < 1e-15 && greatest > least);
//! let period_s = top.nutation_period().unwrap();
//! let (orientation, momentum) = top.at(1000.0 * period_s); // any time costs the same
//! assert!((orientation[(2, 2)] - least.cos()).abs() < 1e-12);
//! assert!((momentum.z - 100.0 * least.cos()).abs() < 1e-12);
//! ```
//!
//! The same top as a body of points, stepped for 10 s by a scheme of order 6, and how far that is off:
//!
//! ```
//! # use gyrolab_physics::{Body, ExactMotion, Loads, PointMass, SchemeInfo, State, nalgebra::Vector3, rotation};
//! # use std::f64::consts::{FRAC_PI_4, PI};
//! let at = |j| rotation::about(&Vector3::z(), 0.2 * PI * f64::from(j)) * Vector3::new(0.8, 0.0, 1.0);
//! let body = Body::new((0..10).map(|j| PointMass { at: at(j), mass: 0.5 }).collect())?;
//! let loads = Loads { gravity: 9.8, ..Loads::default() };
//! let orientation = rotation::about(&Vector3::x(), FRAC_PI_4);
//! let start = State { time_s: 0.0, orientation, momentum: 100.0 * orientation.column(2) };
//!
//! let mut scheme = SchemeInfo::find("srkn11b").unwrap().make(&body);
//! let mut state = start;
//! scheme.load(&loads);
//! scheme.start(&state);
//! (0..1000).for_each(|_| scheme.step(0.01, &mut state));
//! let exact = ExactMotion::new(&body, &loads, &start).at(10.0);
//! assert!((state.axle() - exact.axle()).norm() < 1e-10);
//! # Ok::<(), gyrolab_physics::BodyError>(())
//! ```
//!
//! A body of parts: a wheel on a rod.
//!
//! ```
//! # use gyrolab_physics::{Body, PlacedSolid, SymmetricTop, nalgebra::Vector3, part::Shape};
//! let axle = Vector3::z();
//! let wheel = PlacedSolid::new(Shape::Cylinder { radius: 0.1, length: 0.02 }, 1.2, 0.5 * axle, &axle)?;
//! let rod = PlacedSolid::new(Shape::Rod { length: 0.6 }, 0.1, 0.3 * axle, &axle)?;
//! let body = Body::new([wheel, rod].iter().flat_map(PlacedSolid::points).collect())?;
//! let top = SymmetricTop::from_body(&body).unwrap();
//! assert!((top.along - 1.2 * 0.1 * 0.1 / 2.0).abs() < 1e-15); // kg m^2: a thin rod has none
//! assert!((top.first_moment - (1.2 * 0.5 + 0.1 * 0.3)).abs() < 1e-15); // kg m
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod body;
pub mod exact;
pub mod friction;
pub mod loads;
pub mod observables;
pub mod part;
pub mod report;
pub mod rotation;
pub mod scheme;
mod splitting;
mod state;
mod stepping;
pub mod symmetry;
mod trig;
pub mod workings;

pub use body::{Body, BodyError, PointMass};
pub use exact::{ExactMotion, LagrangeTop};
pub use friction::Damping;
pub use loads::{Friction, Loads, PointForce};
pub use nalgebra;
pub use part::PlacedSolid;
pub use scheme::SchemeInfo;
pub use state::State;
pub use stepping::Scheme;
pub use symmetry::SymmetricTop;
pub use workings::Workings;
