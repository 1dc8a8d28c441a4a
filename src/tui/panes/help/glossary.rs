//! The words that the lab uses, each in one sentence.

/// Every word, those of the motion first, then those of the numbers and of the screen.
pub(super) const GLOSSARY: &[(&str, &str)] = &[
    (
        "precession",
        "the slow turn of the axle about the vertical: gravity's torque carries L around",
    ),
    (
        "nutation",
        "the fast nodding of the axle about its slow way; for a fast top its period is 2 pi I1/L, I1 the inertia across the axle",
    ),
    (
        "nutation?",
        "the question mark: what seems to nod is strobed, and not the nutation of the motion",
    ),
    (
        "axle",
        "the direction in the body that was upright before the start turned it; tilt and azimuth are the axle's",
    ),
    ("tilt", "the angle of the axle from the vertical z, now"),
    (
        "azimuth",
        "the direction of the axle as seen from above, counted on over full turns",
    ),
    (
        "axle top",
        "the point of the body whose path is drawn, unless the scenario traces another: x, y and z are its",
    ),
    (
        "trace",
        "the path of the traced point, or a curve over time",
    ),
    (
        "pivot",
        "the foot of the axle, which stands still; L and torque are about it",
    ),
    (
        "L",
        "angular momentum about the pivot, in J s; given in the \"world\" as it stands, or in the \"body\", turned with it",
    ),
    (
        "Omega",
        "angular velocity: the axis about which the body turns just now, and how fast",
    ),
    (
        "lag",
        "the angle between axle and L; a scheme with too long a time step makes it too large, and the axle then swings about it",
    ),
    (
        "lags",
        "\"axle lags L 198 times too far\": their mean angle is so many times that of the exact motion; the one shown is that of now",
    ),
    (
        "run",
        "a scenario and what was done to it, played from step 0",
    ),
    (
        "time step",
        "dt, the simulated time of one round of the scheme; the playback speed changes nothing about it",
    ),
    (
        "step",
        "the number of a time step, counted from 0, which is the start",
    ),
    (
        "wobble",
        "a fast swing of the axle after a push; one that the exact motion (t) does not have is the time step's",
    ),
    (
        "scheme",
        "the numerical method that takes the body from one step to the next",
    ),
    (
        "exact motion",
        "the true motion from the same start under the same pushes, in closed form or to 1e-12; t shows it",
    ),
    (
        "turn",
        "one revolution of the body about its axle, as in \"5 turns a step\"; of the tilt: where it is least or greatest",
    ),
    (
        "strobed",
        "as under a strobe light, a fast swing between steps seems slow; where only the body's picture seems to turn wrongly, no number suffers",
    ),
    (
        "predicted",
        "what the theory of the heavy symmetric top says of this motion, without the scheme",
    ),
    (
        "measured",
        "what is read off this run, as the scheme made it",
    ),
    (
        "drift",
        "the energy that the scheme has gained or lost, the work of pushes taken off; it should be 0",
    ),
    (
        "friction",
        "what slows the spin or the swing of the axle: [friction] of a scenario; e shows it, gyrolab man friction explains it",
    ),
    (
        "mgl",
        "M g |c| of the summary: mass, gravity and the distance of the centre of mass from the pivot; unit of the drift",
    ),
    (
        "kappa",
        "I3/I1, the inertia about the axle by that across it: below 1 a long body, above 1 a flat one",
    ),
    (
        "steady",
        "the angle between axle and L in steady precession, which does not nod; the exact motion's",
    ),
    (
        "Ekin",
        "the kinetic energy at the start: the unit of the drift where there is no mgl",
    ),
    (
        "off exact",
        "how far the traced point is from where the exact motion has it at the same time",
    ),
    (
        "mends it",
        "this time step or scheme was tried: the traced point keeps within 1 % of the exact motion, and the tilt swings as it does there",
    ),
    (
        "band",
        "swings too fast to be drawn one by one: a hatched band from the lowest values to the highest",
    ),
    (
        "phase",
        "a part of a time step, as the scheme takes it; v shows them one by one, with the numbers of the step",
    ),
    (
        "torque",
        "X × F summed over the forces, about the pivot: in the time dt it adds dL = dt τ to L",
    ),
    (
        "inertia",
        "I, how hard the body is to turn about each axis: the masses times their squared distances from it",
    ),
    (
        "segment",
        "a part of a run between edits of dt, scheme or gravity; a CSV numbers them from 0",
    ),
    (
        "edit",
        "a value that was changed during a run; it acts from the next step on, and a dotted line marks it",
    ),
    (
        "push",
        "a force on a point of the body, for some steps or seconds; the arrow F shows it",
    ),
    (
        "ghost",
        "the run before the last edit, dotted: what did the edit change?",
    ),
    (
        "other run",
        "the ghost, or where a run is pinned the pinned one: it lies behind the present run",
    ),
    (
        "pinned",
        "the run that i keeps as the reference: in long and short dashes, through edits and other presets",
    ),
    (
        "dotted",
        "the run before the last edit; from above the path before the last swings",
    ),
    (
        "dashes",
        "the exact motion beside the run; a - in the place of a number: nothing is known or measured yet",
    ),
    (
        "precession none",
        "an axle that swings through the vertical goes round L and not round z: it has no precession to tell",
    ),
    (
        "both *",
        "from above: the run's place o and that of the exact motion e are the same point of the screen",
    ),
    (
        "zoom",
        "the upper strip of the traces: some swings, enlarged (Up, Down: of another curve); a bar with this word marks their time below",
    ),
    (
        "held",
        "\"zoom, held\": the strip is drawn once a second and stands still meanwhile; its time would pass before anyone had seen it",
    ),
    (
        "timeline",
        "the line below the panes: the run from its start to its end; a click on it, or g, goes there",
    ),
    (
        "─ · ═ : │ █",
        "on the timeline: the way so far, what lies ahead, a push, an edit, the scenario's end, where the run stands",
    ),
    (
        "┤",
        "on the timeline: how far the pinned run has been; beside a strip of the traces: the height of the value before it",
    ),
    (
        "~0",
        "in the step pane: zero but for rounding, less than 4e-15 of the largest number beside it",
    ),
    (
        "×20",
        "the playback speed, simulated seconds in one second: + and - change it, and never the time step",
    ),
    (
        "session",
        "the lab as it was left; gyrolab --resume comes back to it",
    ),
];
