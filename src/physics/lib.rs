//! The mechanics: a rigid body of point masses that turns about a fixed pivot.
//!
//! [`body`] says what turns ([`part`]: the points that stand for a solid), [`state`] how it stands and moves, [`loads`]
//! what pulls at it, [`friction`] what slows it down, [`stepping`] how a time step is taken (one file per scheme, [`scheme`] their table), [`workings`]
//! what is computed on its way, and [`observables`] what is read off a state. Nothing here knows where the numbers come
//! from or who looks at them, and nothing here depends on the processor or on the C library: sine, cosine and arc tangent
//! are compiled in, sums have a fixed order, and no multiply-add is fused.

#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod body;
pub mod exact;
pub mod friction;
pub mod loads;
pub mod observables;
pub mod part;
pub mod report;
mod rk4;
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
pub use friction::{Damping, Friction};
pub use loads::{Loads, PointForce};
pub use part::Part;
pub use scheme::SchemeInfo;
pub use state::State;
pub use stepping::Scheme;
pub use symmetry::SymmetricTop;
pub use workings::Workings;
