//! The files that the document needs, and the command that writes each.

/// A file, and the command that writes it.
#[derive(Debug)]
pub struct Made {
    /// The name of the file, without folder and ending.
    pub name: &'static str,
    /// What follows `gyrolab` on the command line, without the option for the output.
    pub arguments: &'static str,
    folder: &'static str,
    ending: &'static str,
}

/// The width of a figure as wide as the text, and of one of two side by side, mm.
pub(super) const WIDTHS_MM: [f64; 2] = [160.0, 86.0];

const FIGURE_FOLDER: &str = "figures";

impl Made {
    const fn table(name: &'static str, arguments: &'static str) -> Self {
        Self {
            name,
            arguments,
            folder: "data",
            ending: "csv",
        }
    }

    const fn figure(name: &'static str, arguments: &'static str) -> Self {
        Self {
            name,
            arguments,
            folder: FIGURE_FOLDER,
            ending: "svg",
        }
    }

    /// The path of the file, from the folder of the document on.
    pub fn path(&self) -> String {
        format!("{}/{}.{}", self.folder, self.name, self.ending)
    }

    /// The command as a user types it in the folder of the document.
    pub fn command(&self) -> String {
        format!("gyrolab {} -o {}", self.arguments, self.path())
    }
}

/// The path of a picture without its ending.
pub(super) fn picture(name: &str) -> String {
    format!("{FIGURE_FOLDER}/{name}")
}

/// The arguments that run the preset by the report's scheme and by the exact motion, with what is read off each of the
/// report's runs.
macro_rules! by_both {
    ($preset:literal) => {
        concat!(
            "sweep ",
            $preset,
            " --vary motion.scheme=report,exact --measure measured_lowest_z_m,measured_highest_z_m,\
             measured_highest_tilt_deg,azimuth_deg,measured_precession_rad_per_s,measured_nutation_period_s,\
             turns_per_step,spin_rpm,L_Js,most_distance_m"
        )
    };
}

/// The tables of the document: the report's five runs step by step, and the numbers behind its claims.
pub const TABLES: &[Made] = &[
    Made::table("method-1", "run method-1 --columns t_s,x_m,y_m,z_m"),
    Made::table(
        "method-1-steeper",
        "run method-1-steeper --columns t_s,x_m,y_m,z_m",
    ),
    Made::table(
        "method-2-slow",
        "run method-2-slow --columns t_s,x_m,y_m,z_m",
    ),
    Made::table("method-2", "run method-2 --columns t_s,x_m,y_m,z_m"),
    Made::table("wobble-push", "run wobble-push --columns t_s,x_m,y_m,z_m"),
    Made::table("method-1-numbers", by_both!("method-1")),
    Made::table("method-1-steeper-numbers", by_both!("method-1-steeper")),
    Made::table("method-2-slow-numbers", by_both!("method-2-slow")),
    Made::table("method-2-numbers", by_both!("method-2")),
    Made::table("wobble-push-numbers", by_both!("wobble-push")),
    Made::table(
        "half-a-turn-later",
        "run method-1 --duration 236 --from 235 --columns t_s,x_m",
    ),
    Made::table(
        "half-a-turn-later-exact",
        "run method-1 --scheme exact --duration 236 --from 235 --columns t_s,x_m",
    ),
    Made::table(
        "no-weight",
        "sweep method-2-slow --vary motion.gravity_m_per_s2=9.8,0 --vary motion.scheme=report,exact \
         --measure spin_rpm,azimuth_deg",
    ),
    Made::table(
        "faster-spin",
        "sweep method-2-slow --set motion.time_step_s=0.0001 --duration 10 --vary start.momentum_Js.2=200,20000 \
         --vary motion.scheme=report,exact --measure spin_rpm,measured_precession_rad_per_s",
    ),
    Made::table(
        "tilt-fast-top",
        "sweep method-2 --vary start.tilt_deg=15,45,75 --vary motion.scheme=report,exact \
         --measure measured_precession_rad_per_s",
    ),
    Made::table(
        "tilt-slow-top",
        "sweep method-2 --set motion.time_step_s=0.0005 --duration 10 --set start.momentum_Js.2=40 \
         --vary start.tilt_deg=15,45,75 --vary motion.scheme=report,exact --measure measured_precession_rad_per_s",
    ),
    Made::table(
        "slow-tops",
        "sweep method-2 --set motion.time_step_s=0.0005 --duration 10 --vary start.momentum_Js.2=20,40,60,1000 \
         --vary motion.scheme=report,exact --measure measured_lowest_tilt_deg,measured_highest_tilt_deg",
    ),
    Made::table(
        "push-finer",
        "sweep wobble-push --vary motion.time_step_s=0.1,0.05,0.02,0.01,0.005,0.002,0.001 \
         --vary motion.scheme=report,exact \
         --measure turns_per_step,measured_lowest_z_m,measured_highest_z_m,most_distance_m",
    ),
    Made::table(
        "other-heights",
        "sweep wobble-push --vary body.rim.height_m=0.4,0.5,0.65,0.8 --vary motion.time_step_s=0.1,0.001 \
         --vary motion.scheme=report,exact --measure measured_lowest_z_m,measured_highest_z_m",
    ),
    Made::table("comb", "sweep wobble-over-time-step"),
];

/// The figures of the document. Each is also written as PDF.
pub const FIGURES: &[Made] = &[
    Made::figure("comb", "figure data/comb.csv --width 160mm"),
    Made::figure(
        "sampling",
        "figure method-1 --set motion.gravity_m_per_s2=0 --time-step 0.00887 --duration 0.18 --exact --kind x_m \
         --width 160mm",
    ),
    Made::figure("method-1-traces", "figure method-1 --exact --to 0.1"),
    Made::figure("method-1-3d", "figure method-1 --exact --to 0.1 --kind 3d"),
    Made::figure(
        "method-1-longer",
        "figure method-1 --exact --duration 480 --kind x_m --width 160mm",
    ),
    Made::figure(
        "method-1-steeper-traces",
        "figure method-1-steeper --exact --to 0.1",
    ),
    Made::figure(
        "method-1-steeper-3d",
        "figure method-1-steeper --exact --to 0.1 --kind 3d",
    ),
    Made::figure(
        "method-2-slow-traces",
        "figure method-2-slow --exact --width 160mm",
    ),
    Made::figure(
        "method-2-slow-3d",
        "figure method-2-slow --exact --to 0.2 --kind 3d --width 160mm",
    ),
    Made::figure("method-2-traces", "figure method-2 --exact --width 160mm"),
    Made::figure(
        "method-2-3d",
        "figure method-2 --exact --kind 3d --width 160mm",
    ),
    Made::figure(
        "wobble-push-traces",
        "figure wobble-push --exact --width 160mm",
    ),
    Made::figure(
        "wobble-push-3d",
        "figure wobble-push --exact --kind 3d --width 160mm",
    ),
    Made::figure(
        "wobble-push-finer",
        "figure wobble-push --vary motion.time_step_s=0.1,0.002 --exact --kind z_m --to 60 --width 160mm",
    ),
];
