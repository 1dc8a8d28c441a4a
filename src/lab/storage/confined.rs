//! The only folder in which a lab may read and write, if the command line names one with `--folder`. It is meant for a
//! login that several people share and that may run only the lab.

use crate::engine::text::printable::{PrintablePath, printable};
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// Name of the subfolder for the sessions of a confined lab, and for its class.
pub const SESSIONS: &str = ".gyrolab";
/// Maximum total size of the files of a seat, bytes.
pub const MOST_OF_SEAT: u64 = 20_000_000;

/// A folder that the lab's reads and writes never leave.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Confined {
    root: PathBuf,
    sessions: PathBuf,
    /// The folder of the class to which this seat belongs. The lab may read its lessons and scenarios, but writes
    /// nothing there.
    class: Option<PathBuf>,
}

impl Confined {
    /// Confines the lab to `folder` and makes it the working directory of this process.
    pub fn enter(folder: &Path) -> io::Result<Self> {
        let confined = Self::within(folder)?;
        std::env::set_current_dir(&confined.root)?;
        Ok(confined)
    }

    /// Confines the lab to `folder`, which must be the working directory whenever a path is checked.
    pub fn within(folder: &Path) -> io::Result<Self> {
        let root = fs::canonicalize(folder)?;
        if !root.is_dir() {
            return Err(io::Error::from(io::ErrorKind::NotADirectory));
        }
        Ok(Self {
            sessions: root.join(SESSIONS),
            class: None,
            root,
        })
    }

    /// Stores the sessions in `sessions`, for example in a folder of the teacher.
    pub fn keeping_in(self, sessions: PathBuf) -> Self {
        Self { sessions, ..self }
    }

    /// Makes this the folder of a seat of the class in `folder`.
    pub fn as_seat_of(self, folder: &Path) -> Self {
        let class = Some(folder.to_owned());
        Self { class, ..self }
    }

    pub fn class(&self) -> Option<PathBuf> {
        self.class.clone()
    }

    pub fn is_seat(&self) -> bool {
        self.class.is_some()
    }

    /// Returns the folder whose lessons are listed: the class's folder, or its own.
    pub fn lessons(&self) -> &Path {
        self.class.as_deref().unwrap_or(&self.root)
    }

    /// Returns the folder for sessions, which may not exist yet.
    ///
    /// # Errors
    /// Returns an error if it exists and is not a folder.
    pub fn sessions(&self) -> Result<PathBuf, String> {
        match fs::symlink_metadata(&self.sessions) {
            Ok(there) if !there.is_dir() => Err(format!(
                "sessions cannot be saved in {}: it is not a folder",
                PrintablePath(&self.sessions)
            )),
            _ => Ok(self.sessions.clone()),
        }
    }

    /// Checks that the file `path` may be read: it must be in the folder, or in the class's folder. A full path is
    /// allowed.
    ///
    /// # Errors
    /// Returns an error if it may not be read.
    pub fn check_reading(&self, path: &Path) -> Result<(), String> {
        for root in [Some(&self.root), self.class.as_ref()]
            .into_iter()
            .flatten()
        {
            if let Ok(rest) = path.strip_prefix(root) {
                let mut there = self.clone();
                there.root.clone_from(root);
                return there.check(rest);
            }
        }
        self.check(path)
    }

    /// Checks that the file `path` may be written: [`check`](Self::check) must succeed, and a seat must have space
    /// left.
    ///
    /// # Errors
    /// Returns an error if it may not be written.
    pub fn check_writing(&self, path: &Path) -> Result<(), String> {
        self.check(path)?;
        if self.is_seat() && size_of(&self.root) >= MOST_OF_SEAT {
            let most = MOST_OF_SEAT / 1_000_000;
            return Err(format!(
                "the files of this seat take {most} MB, the maximum: ask your teacher to remove some"
            ));
        }
        Ok(())
    }

    /// Checks that the file `path`, existing or not, is inside the folder.
    ///
    /// The path must be relative and contain no `..`, and no symbolic link in it may lead out of the folder.
    ///
    /// # Errors
    /// Returns an error if a rule is broken.
    pub fn check(&self, path: &Path) -> Result<(), String> {
        let mut full = self.root.clone();
        for component in path.components() {
            match component {
                Component::CurDir => {}
                Component::Normal(name) if name == "-" => {
                    return Err("- cannot be the name of a file here".to_owned());
                }
                Component::Normal(name) => full.push(name),
                Component::ParentDir | Component::RootDir | Component::Prefix(_) => {
                    return Err(
                        "this lab stays in its folder: a name must not begin with / or contain .."
                            .to_owned(),
                    );
                }
            }
        }
        self.check_full(&full)?;
        if fs::symlink_metadata(&full).is_ok_and(|there| there.is_symlink()) {
            let target = fs::canonicalize(&full).map_err(|_| leads_out(&full))?;
            self.check_full(&target)?;
        }
        if let Ok(folder) = fs::canonicalize(full.parent().unwrap_or(&self.root)) {
            self.check_full(&folder)?;
        }
        match fs::metadata(&full) {
            Ok(there) if !there.is_file() && !there.is_dir() => {
                Err("this lab reads and writes only regular files".to_owned())
            }
            _ => Ok(()),
        }
    }

    /// Checks an absolute path, without following links in it.
    fn check_full(&self, path: &Path) -> Result<(), String> {
        let inside = path.strip_prefix(&self.root).map_err(|_| leads_out(path))?;
        for name in inside {
            if name.as_encoded_bytes().starts_with(b".") {
                return Err("names that begin with a dot are reserved for the lab".to_owned());
            }
        }
        Ok(())
    }
}

/// Returns the total size of the files in `folder`, bytes.
fn size_of(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries
        .map(|entry| match entry.metadata() {
            Ok(there) if there.is_dir() => size_of(&entry.path()),
            there => there.map_or(0, |there| there.len()),
        })
        .sum()
}

fn leads_out(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    format!(
        "this lab stays in its folder: {} leads out of it",
        printable(&name)
    )
}
