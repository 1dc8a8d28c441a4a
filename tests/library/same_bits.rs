//! The same run gives the same bits everywhere: what could differ between processors or C libraries is not used.

use std::fs;
use std::path::{Path, PathBuf};

/// Functions of the standard library that call the C library's, whose last bits differ from system to system, and the
/// fused multiply-add, which rounds once where two operations round twice.
const FOREIGN: [&str; 18] = [
    ".sin()",
    ".cos()",
    ".tan()",
    ".sin_cos()",
    ".asin()",
    ".acos()",
    ".atan()",
    ".atan2(",
    ".sinh()",
    ".cosh()",
    ".exp()",
    ".exp2()",
    ".ln()",
    ".log10()",
    ".log2()",
    ".powf(",
    ".hypot(",
    ".mul_add(",
];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn no_room_that_makes_numbers_uses_the_c_library() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    for room in ["physics", "scenario", "run"] {
        sources(&root.join(room), &mut files);
    }
    assert!(files.len() > 30, "the rooms are where they were");
    let mut uses = Vec::new();
    for file in files.iter().filter(|file| !file.ends_with("tests.rs")) {
        let text = fs::read_to_string(file).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap();
        for (number, line) in code.lines().enumerate() {
            let code = line.split("//").next().unwrap();
            for name in FOREIGN.iter().filter(|name| code.contains(*name)) {
                uses.push(format!("{}:{}: {name}", file.display(), number + 1));
            }
        }
    }
    assert!(uses.is_empty(), "{}", uses.join("\n"));
}
