//! Lines that read a run's CSV and plot its z, for the languages in which write-ups are made.

/// A language, and lines in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lines {
    /// The language's name.
    pub language: &'static str,
    /// The name by which Markdown knows it.
    pub tag: &'static str,
    /// The lines.
    pub code: String,
}

/// For the CSV `file`, whose rows and the line of their names stand below `header` lines; `t` and `z` are the numbers of
/// these columns, from 1.
pub fn lines(file: &str, header: usize, t: usize, z: usize) -> [Lines; 4] {
    [
        Lines {
            language: "Python with pandas",
            tag: "python",
            code: format!(
                "import pandas as pd\n\nrun = pd.read_csv(\"{file}\", skiprows={header})\nrun.plot(x=\"t_s\", y=\"z_m\")\n"
            ),
        },
        Lines {
            language: "R",
            tag: "r",
            code: format!(
                "run <- read.csv(\"{file}\", skip = {header})\nplot(run$t_s, run$z_m, type = \"l\")\n"
            ),
        },
        Lines {
            language: "MATLAB",
            tag: "matlab",
            code: format!(
                "run = readtable(\"{file}\", \"NumHeaderLines\", {header});\nplot(run.t_s, run.z_m)\n"
            ),
        },
        Lines {
            language: "Octave, which knows the columns by number",
            tag: "octave",
            code: format!(
                "run = dlmread(\"{file}\", \",\", {}, 0);\nplot(run(:, {t}), run(:, {z}))\n",
                header + 1
            ),
        },
    ]
}
