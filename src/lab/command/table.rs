//! The one table of commands: the name of each, its value, and what it does.

use super::form::{self, Form};
use crate::scenario::keys::Kind;
use Form::{Is, View};

pub struct CommandRow {
    /// Its name in a `[[do]]` table.
    pub name: &'static str,
    /// Examples of its value, as TOML.
    pub value: &'static str,
    pub about: &'static str,
    pub(super) form: Form,
}

const fn row(
    name: &'static str,
    value: &'static str,
    about: &'static str,
    form: Form,
) -> CommandRow {
    CommandRow {
        name,
        value,
        about,
        form,
    }
}

#[rustfmt::skip]
pub static COMMANDS: &[CommandRow] = &[
    row("open", "\"wobble-push\"", "open a preset or a file, SCENARIO as on the command line; it stands still at step 0", form::OPEN),
    row("set", "{ \"motion.time_step_s\" = 0.05 }", "set dotted keys of the scenario, from the next step on; of body or start in a new run", Form::Keys),
    row("nudge", "{ key = \"motion.time_step_s\", times = -1 }", "nudge a value up, or down where times is negative", form::NUDGE),
    row("push", "true, or { point = \"top\", force_N = [0, 0, -50], for_s = 2 }", "give the push to come, or one of one's own; force_N can be a size beside toward = \"down\"", form::PUSH),
    row("next_push", "{ point = \"top\", force_N = 50, toward = \"down\", for_s = 2 }", "choose the push to come, or a part of it", form::NEXT_PUSH),
    row("step", "10", "take so many time steps, or go so many back", form::STEPS),
    row("go_to", "400, \"60 s\", \"start\" or \"end\"", "go to a step or a time at most 10000000 steps away and stop there", form::PLACE),
    row("run_until", "\"t_s >= 60\"", "play at the speed that is set until this holds, and stop; given up after 10000000 steps", form::CONDITION),
    row("run", "true", "let the run go on", form::TRUE),
    row("pause", "true", "stop the run", form::TRUE),
    row("wait_s", "2.5", "let so many seconds pass on the clock before the next command", form::WAIT),
    row("chapter", "\"one line\"", "say this line; a recording (gyrolab cast) has a marker there", Is(Kind::Line)),
    row("undo", "1", "take back so many of the things done last", form::COUNT),
    row("redo", "1", "bring so many of them again", form::COUNT),
    row("export", "\"run.csv\", or { path = \"run.csv\", every = 10, force = true }", "write the run up to here, or to_step, as CSV; force replaces a file; columns, from_s, to_s, points and excel are those of gyrolab run", form::EXPORT),
    row("figure", "\"run.pdf\", or { path = \"run.svg\", kind = \"above\", exact = true, force = true }", "draw the run up to here, or to_step; kind as in gyrolab figure, and the file's end says .svg, .pdf or .png", form::FIGURE),
    row("save", "\"run.toml\", or { path = \"run.toml\", from_here = true, force = true }", "write the run up to here, or to_step, as a run file; from_here: the present state as a scenario", form::SAVE),
    row("speed", "20 or \"top\"", "how fast the run is played, simulated seconds a second", form::SPEED),
    row("look_at", "\"one line\"", "what the lab says of what there is to see", View("look_at")),
    row("next", "\"one line\"", "what the lab says at the end of the run of what to try next", View("next")),
    row("window_s", "60", "length of time that the traces show, s", View("window_s")),
    row("detail_s", "0.5", "length of time that the strip of the fast motion shows, s", View("detail_s")),
    row("detail_of", "\"z\"", "what that strip shows: x, y, z, tilt or auto, the tilt, or x where the tilt does not swing", View("detail_of")),
    row("since_s", "12.5, or \"none\"", "time at the left edge of the traces, s; none: they follow the run", form::SINCE),
    row("magnify", "4", "how many times the values of the traces are magnified, 1 to 1000000", form::MAGNIFY),
    row("cursor", "400, \"60 s\", \"next turn\", \"turn before\" or \"none\"", "the step at which the traces are read off; turns are those of the tilt", form::CURSOR),
    row("exact", "true or false", "whether the exact motion is drawn beside the run", View("exact")),
    row("measured", "\"heidelberg-spin-decay\", \"data.csv\" or \"none\"", "put measured data beside the run: data that come with gyrolab, or a CSV file with a column t_s", View("measured")),
    row("residuals", "true or false", "whether measured data are shown less what the run says", View("residuals")),
    row("pin", "true or false", "pin the present run as the reference, which stays in view; false: none is pinned", Is(Kind::Flag)),
    row("take_advice", "true", "begin the run anew at the time step, or by the scheme, that mends doubtful numbers, up to the same time", form::TRUE),
    row("show", "[\"traces\", \"3d\"]", "the panes that share the screen, of traces, above, 3d, parameters, step; none: as many as there is room for, without step", View("show")),
    row("hide", "[\"health\"]", "what is not shown: panes, health, predicted, look_at", View("hide")),
    row("fill", "\"above\"", "the pane that fills the screen, or \"none\"", View("fill")),
    row("phase", "3, \"torque\", \"last\" or \"why\"", "the phase of the time step that the pane step shows; why: why sideways, not down?", View("phase")),
    row("sum_to", "4, or \"all\"", "how many rows of a phase's table the pane step adds up", View("sum_to")),
    row("point_at", "\"above\"", "the pane that is pointed at, by a heavy frame, or \"none\"", View("fill")),
    row("bare", "true or false", "whether the screen is bare: two panes, or one, with title and time, and nothing else", View("bare")),
    row("camera", "{ yaw_deg = 30, pitch_deg = 20 }", "from where the 3-D view is seen", View("camera")),
    row("zoom", "{ above = 4, 3d = 2 }", "how much larger than the whole the path from above and the 3-D view are shown", View("zoom")),
];
