//! The presets that are compiled into the program. [`PRESETS`] lists them.

/// A scenario that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Name on the command line. The file is `presets/NAME.toml` in the source.
    pub name: &'static str,
    pub text: &'static str,
    /// Suggestion for a next experiment, one line. It is not in the file, because the file is in the header of every
    /// CSV of the run.
    pub next: &'static str,
}

macro_rules! presets {
    ($($name:literal: $next:literal)*) => {
        &[$(Preset {
            name: $name,
            text: include_str!(concat!("../../../presets/", $name, ".toml")),
            next: $next,
        }),*]
    };
}

/// All presets: first the report's, in the report's order, then the textbook's, then famous motions of solid bodies.
pub const PRESETS: &[Preset] = presets![
    "method-1": "o opens method-1-steeper: L further from the axle, and a wider circle."
    "method-1-steeper": "t draws the exact motion: how far apart are the two at the end?"
    "method-2-slow": "o opens method-2: the same start at dt 0.1 s, where the precession shows."
    "method-2": "t draws the exact motion: how much of the swing in z is the time step's?"
    "wobble-push": "t draws the exact motion: does it wobble under the same push?"
    "wobble-push-accumulating": "o opens wobble-push: the same push, which does not grow."
    "every-slip": "t: the exact motion. At this time step the scheme is 7 cm off it in 2 s."
    "fast-top": "e, then |L|: half of it doubles the precession and makes the nutation larger."
    "cusps": "o opens waves and loops: the same top, started with and against its precession."
    "loops": "o opens waves: the same top, started with its precession and not against it."
    "waves": "o opens steady-slow: the same top, started with all of the precession it needs."
    "steady-slow": "o opens steady-fast: the same tilt and spin, 10.76 times as fast around."
    "steady-fast": "o opens steady-slow: the same tilt and spin, 10.76 times slower around."
    "sleeping": "o opens sleeping-unstable: a little less spin, and it sinks."
    "sleeping-unstable": "e, then |L|: at 40 J s it stays up."
    "falling": "e, then |L|: at 30 J s it falls less far, at 60 much less."
    "torque-free": "e, then gravity: at 9.8 m/s2 a torque acts, and the tilt no longer stays."
    "life-of-a-top": "e, then viscous under friction: ten times as much, and how soon does it fall?"
    "first-dip": "e, then on swing under friction: at 0 the dips last, at 10 there is almost none."
    "lab-gyroscope": "e, then dry under friction: at 0.004 the wheel stops and the axle falls."
    "heavy-top": "e, then scheme; t draws the exact motion: which schemes keep to it at this dt?"
    "wing-nut": "e, then tilt: at 0.1 degrees it waits longer, and then turns over as fast."
    "phone": "e, then wy: at 0 nothing slips, and it comes round flat."
    "thrown-phone": "e, then wx: about which of its three axes does a turn last?"
    "rugby-pass": "e, then wx: a larger slip of the wrist widens the circle, its time stays."
    "earth": "e, then tilt: does the pole go round faster when it leans less?"
    "heidelberg": "gyrolab lesson a-real-gyroscope goes through what was measured on it."
    "poinsot": "o opens wing-nut: a free body again, about its middle axis."
];

pub fn find(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}
