//! The words about each phase of a time step, for every scheme.

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Words {
    pub name: &'static str,
    /// What happens in it, in one sentence.
    pub happens: &'static str,
    /// What it changes, and what for.
    pub changes: &'static str,
    /// Where that is to be seen in the 3-D view; empty where nothing is.
    pub seen: &'static str,
}

const fn words(
    name: &'static str,
    happens: &'static str,
    changes: &'static str,
    seen: &'static str,
) -> Words {
    Words {
        name,
        happens,
        changes,
        seen,
    }
}

#[rustfmt::skip]
const TABLE: &[Words] = &[
    words("inertia", "How the masses lie about the pivot, added up point by point.", "nothing yet; gives I", "the body before the step (°)"),
    words("angular velocity", "The axis about which the body turns now, and how fast: L divided by the inertia.", "nothing yet; gives Ω", "the arrow Ω"),
    words("axis and angle", "The line u along Ω, and the angle about it in one time step.", "nothing yet; gives u and the angle", "the line u through the pivot"),
    words("rotation", "The matrix that turns any point about u by that angle.", "nothing yet; gives R", "the body before (°) and after"),
    words("new positions", "R turns every point to its new place.", "where the points are", "the body before (°) and after"),
    words("torque", "How the forces turn the body about the pivot: each where its point is now.", "nothing yet; gives τ", "the arrow τ; forces: g and F"),
    words("new momentum", "In the time dt the forces change L. The next step begins with the new L.", "L, and nothing else", "the arrow L, and dL at its tip"),
    words("friction", "Friction slows the spin, and the swing of the axle: it takes from L while the body stands still.", "L, and nothing else", "the arrow L"),
    words("kick", "The forces act for the time h: they change L while the body stands still.", "L, and nothing else", "the arrow L, and dL at its tip"),
    words("free motion", "The body moves for the time h as if there were no forces: L stays.", "how the body stands", "the body before (°) and after"),
    words("spin about the axle", "The body turns about its own axle, once for the whole step.", "how the body stands about its axle", "the body before (°) and after"),
    words("rounding taken out", "Rounding has bent the orientation a little: it is made a rotation again.", "how the body stands, by a rounding", ""),
    words("new orientation", "How the body stands at the end of the step.", "how the body stands", "the body before (°) and after"),
    words("slope 1: at the beginning", "How fast orientation and momentum change as the step begins.", "nothing yet; four slopes make a step", "the arrow Ω"),
    words("slope 2: half way by slope 1", "The same after half the step, if slope 1 held so long.", "nothing yet; four slopes make a step", "the arrow Ω"),
    words("slope 3: half way by slope 2", "The same once more, with slope 2: better than slope 2.", "nothing yet; four slopes make a step", "the arrow Ω"),
    words("slope 4: at the end by slope 3", "How fast they change as the step ends, if slope 3 held for all of it.", "nothing yet; four slopes make a step", "the arrow Ω"),
    words("theta functions", "Two complex numbers that hold the orientation at the time t: exact, whatever the time step.", "nothing yet; gives α and β", ""),
    words("Taylor series", "Orientation and momentum at the time t, from a series that is exact to the last digits.", "how the body stands, and L", "the body before (°) and after"),
];

/// The words about the phase of this `name`; empty where there are none.
pub fn of(name: &str) -> Words {
    let found = TABLE.iter().find(|row| row.name == name);
    found.copied().unwrap_or_default()
}
