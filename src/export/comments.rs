//! The comments above the rows of a CSV: lines that begin with `#`.

/// The comments above the run file, without their marks. `header` is the header of a CSV whose lines have lost their `# `.
pub fn above_run_file(header: &str) -> String {
    let comments = header.lines().map_while(|line| line.strip_prefix('#'));
    comments.flat_map(|line| [line, "\n"]).collect()
}

/// `text` with `# ` before every line, as the run file is written above the rows.
pub fn commented(text: &str) -> String {
    text.lines().flat_map(|line| ["# ", line, "\n"]).collect()
}
