//! A rigid body that turns about a fixed point: its exact motion, and numerical schemes that step it.
//!
//! A computation has five parts:
//!
//! - a [`Body`] of point masses, or of solids ([`PlacedSolid`]);
//! - [`Loads`]: gravity, constant forces on points, [`Friction`];
//! - a [`State`] to begin with: time, orientation, and angular momentum;
//! - a motion: [`SteppedMotion`] computes it by one of the [`SCHEMES`](scheme::SCHEMES), [`ExactMotion`] without error;
//! - [`observables`]: positions, tilt, azimuth, and energy of a state.
//!
//! [`SymmetricTop`] has the theory of the symmetric top. [`workings`] are all the numbers of one time step. The exact motion
//! has a closed form ([`LagrangeTop`]) if the body is symmetric about its axle and every force acts on the axle. If not, a
//! Taylor series computes it to rounding ([`AccurateMotion`](exact::AccurateMotion)).
//!
//! This crate uses no other crate of gyrolab. A new scheme, force or observable belongs here. Files, edits, and measurements
//! of a whole run belong to the crate `gyrolab-engine`.
//!
//! # Frames, units, numbers
//! *World*: the origin is the pivot, +z is up. *Body*: fixed in the body, equal to the world frame in the upright pose; its
//! z axis is the axle. An orientation is the rotation matrix from body components to world components. Units are SI and
//! radians; a name that ends in `_deg` is in degrees.
//!
//! No result depends on the processor or on the C library: sine, cosine and arc tangent are compiled in, sums have a fixed
//! order, and no multiply-add is fused. If an argument is infinite or NaN, so is the result. Only the index of a point that
//! the body does not have panics; the documentation of each function that can panic says so.
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
//! The same top as a body of points, stepped for 10 s by a scheme of order 6:
//!
//! ```
//! use gyrolab_physics::{Body, ExactMotion, Loads, PointMass, State, SteppedMotion};
//! use gyrolab_physics::{nalgebra::Vector3, rotation};
//! use std::f64::consts::{FRAC_PI_4, PI};
//!
//! let at = |j| rotation::about(&Vector3::z(), 0.2 * PI * f64::from(j)) * Vector3::new(0.8, 0.0, 1.0);
//! let body = Body::new((0..10).map(|j| PointMass { at: at(j), mass: 0.5 }).collect())?;
//! let loads = Loads { gravity: 9.8, ..Loads::default() };
//! let start = State::spinning(&body, rotation::about(&Vector3::x(), FRAC_PI_4), 31.25); // rad/s
//!
//! let mut motion = SteppedMotion::new("srkn11b", &body, &loads, &start)?;
//! (0..1000).for_each(|_| motion.step(0.01));
//! let exact = ExactMotion::new(&body, &loads, &start).at(10.0);
//! assert!((motion.state().axle() - exact.axle()).norm() < 1e-10);
//! assert!(motion.energy_error().abs() < 1e-9 * motion.energy());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A body of parts: a wheel on a rod.
//!
//! ```
//! use gyrolab_physics::{Body, PlacedSolid, Shape, SymmetricTop, nalgebra::Vector3};
//!
//! let axle = Vector3::z();
//! let wheel = PlacedSolid::new(Shape::Cylinder { radius: 0.1, length: 0.02 }, 1.2, 0.5 * axle, &axle)?;
//! let rod = PlacedSolid::new(Shape::Rod { length: 0.6 }, 0.1, 0.3 * axle, &axle)?;
//! let body = Body::from_solids(&[wheel, rod])?;
//! let top = SymmetricTop::from_body(&body).unwrap();
//! assert!((top.along - 1.2 * 0.1 * 0.1 / 2.0).abs() < 1e-15); // kg m^2: a thin rod has none
//! assert!((top.first_moment - (1.2 * 0.5 + 0.1 * 0.3)).abs() < 1e-15); // kg m
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The folder `examples` has whole programs: `cargo run -p gyrolab-physics --example schemes` compares the schemes, `slowing`
//! has friction, and `wobble` shows what a long time step does.

#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod body;
pub mod exact;
pub mod friction;
pub mod loads;
mod motion;
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
pub use motion::{MotionError, SteppedMotion};
pub use nalgebra;
pub use part::{PlacedSolid, Shape};
pub use scheme::SchemeInfo;
pub use state::State;
pub use stepping::Scheme;
pub use symmetry::SymmetricTop;
pub use workings::Workings;
