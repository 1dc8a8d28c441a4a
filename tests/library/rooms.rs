//! The order of the modules within a crate: no import leads upward. The compiler enforces the boundaries of the crates.

use std::fs;
use std::path::{Path, PathBuf};

/// The modules of the program from lowest to highest: each may import the earlier ones.
const PROGRAM: [&str; 10] = [
    "physics", "engine", "plot", "studies", "report", "lab", "lessons", "class", "tui", "cli",
];
/// The modules of the engine, in the same order.
const ENGINE: [&str; 11] = [
    "text",
    "cores",
    "provenance",
    "physics",
    "scenario",
    "run",
    "journal",
    "analysis",
    "recording",
    "export",
    "data",
];

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// Returns one line for each import in `folder` that leads upward in `order`.
fn upward(folder: &Path, order: &[&str]) -> Vec<String> {
    let place = |name: &str| order.iter().position(|module| *module == name);
    let mut found = Vec::new();
    for module in order {
        let mut files = Vec::from([folder.join(format!("{module}.rs"))]);
        if files[0].exists() {
            assert!(!folder.join(module).join("mod.rs").exists());
        } else {
            files.clear();
        }
        if folder.join(module).exists() {
            collect(&folder.join(module), &mut files);
        }
        let is_crate = folder.join(module).join("Cargo.toml").exists();
        for file in files.iter().filter(|_| !is_crate) {
            for line in fs::read_to_string(file).unwrap().lines() {
                let code = line.split("//").next().unwrap_or_default();
                for import in code.split("crate::").skip(1) {
                    let name = import
                        .split(|c: char| !c.is_alphanumeric() && c != '_')
                        .next();
                    if place(name.unwrap()).is_some_and(|there| Some(there) > place(module)) {
                        found.push(format!("{}: {}", file.display(), line.trim()));
                    }
                }
            }
        }
    }
    found
}

#[test]
fn no_import_leads_upward() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for (folder, order) in [(src.clone(), &PROGRAM[..]), (src.join("engine"), &ENGINE)] {
        let found = upward(&folder, order);
        assert!(found.is_empty(), "{found:#?}");
    }
}
