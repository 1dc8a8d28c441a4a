//! The names of phases, by which files and commands choose one.

/// Every name that a phase has, whatever the scheme: those of the report's scheme first, in its order.
pub const NAMES: [&str; 19] = [
    "inertia",
    "angular velocity",
    "axis and angle",
    "rotation",
    "new positions",
    "torque",
    "new momentum",
    "friction",
    "kick",
    "free motion",
    "spin about the axle",
    "rounding taken out",
    "new orientation",
    "slope 1: at the beginning",
    "slope 2: half way by slope 1",
    "slope 3: half way by slope 2",
    "slope 4: at the end by slope 3",
    "theta functions",
    "Taylor series",
];
