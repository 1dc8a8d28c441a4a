//! What is in a folder: files that may hold a scenario, folders, and the way up.

use std::path::{Path, PathBuf};

/// Files beyond this many are not listed, nor are folders.
const MOST_FILES: usize = 1000;

/// The files in `folder` that may hold a scenario, as SCENARIO names them, in the order of their names.
pub(super) fn files(folder: &Path) -> Vec<String> {
    let is_wanted = |name: &str| name.ends_with(".toml") || name.ends_with(".csv");
    names(folder, Path::is_file, is_wanted)
}

/// The folders in `folder`, in the order of their names, each with a `/` at its end. Those that the system hides are left
/// out.
pub(super) fn folders(folder: &Path) -> Vec<String> {
    let mut names = names(folder, Path::is_dir, |name| !name.starts_with('.'));
    names.iter_mut().for_each(|name| name.push('/'));
    names
}

/// The paths of what is in `folder`, is of a kind and has a name that is wanted.
fn names(
    folder: &Path,
    is_kind: fn(&Path) -> bool,
    is_wanted: impl Fn(&str) -> bool,
) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new(); // a folder that cannot be read has nothing to offer
    };
    let mut names: Vec<_> = entries
        .flatten()
        .filter(|entry| is_kind(&entry.path()))
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| is_wanted(name))
        .take(MOST_FILES)
        .map(|name| {
            if folder == Path::new(".") {
                name
            } else {
                folder.join(name).display().to_string()
            }
        })
        .collect();
    names.sort_unstable();
    names
}

pub(super) fn above(folder: &Path) -> Option<PathBuf> {
    let folder = std::fs::canonicalize(folder).ok()?;
    folder.parent().map(Path::to_owned)
}
