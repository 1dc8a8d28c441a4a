//! The one folder in which a lab reads and writes, where the command line names one: for a login that several people
//! share, and that may do nothing but this.

use crate::text::printable::{Shown, printable};
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// The folder in a confined lab's folder in which its sessions are kept.
const SESSIONS: &str = ".gyrolab";

/// A folder that is not left, whatever is typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Confined {
    /// Its full name, without links.
    root: PathBuf,
}

impl Confined {
    /// Makes `folder` the present folder of this process.
    ///
    /// # Errors
    /// When there is no such folder, or it cannot be entered.
    pub fn enter(folder: &Path) -> io::Result<Self> {
        let confined = Self::within(folder)?;
        std::env::set_current_dir(&confined.root)?;
        Ok(confined)
    }

    /// Confined to `folder`, which has to be the present folder wherever a path is checked.
    ///
    /// # Errors
    /// When there is no such folder.
    pub fn within(folder: &Path) -> io::Result<Self> {
        let root = fs::canonicalize(folder)?;
        if !root.is_dir() {
            return Err(io::Error::from(io::ErrorKind::NotADirectory));
        }
        Ok(Self { root })
    }

    /// Where sessions are kept.
    ///
    /// # Errors
    /// When a link or a file is in the way.
    pub fn sessions(&self) -> Result<PathBuf, String> {
        let folder = self.root.join(SESSIONS);
        match fs::symlink_metadata(&folder) {
            Ok(there) if !there.is_dir() => Err(format!(
                "sessions cannot be kept in {}: it is not a folder",
                Shown(&folder)
            )),
            _ => Ok(folder),
        }
    }

    /// Whether the file `path` is in the folder, or would be: a name relative to it, that no link leads out of it.
    ///
    /// # Errors
    /// Why it may be neither read nor written.
    pub fn check(&self, path: &Path) -> Result<(), String> {
        let mut so_far = self.root.clone();
        for component in path.components() {
            match component {
                Component::CurDir => {}
                Component::Normal(name) if name == "-" => {
                    return Err("- is no name for a file here".to_owned());
                }
                Component::Normal(name) => so_far.push(name),
                Component::ParentDir | Component::RootDir | Component::Prefix(_) => {
                    return Err(
                        "this lab stays in its folder: a name must not begin with / or contain .."
                            .to_owned(),
                    );
                }
            }
        }
        self.check_full(&so_far)?;
        match fs::symlink_metadata(&so_far) {
            Ok(there) if there.is_symlink() => {
                self.check_full(&fs::canonicalize(&so_far).map_err(|_| leads_out(&so_far))?)
            }
            _ => Ok(()),
        }?;
        let folder = so_far.parent().unwrap_or(&self.root);
        if let Ok(folder) = fs::canonicalize(folder) {
            self.check_full(&folder)?;
        }
        match fs::metadata(&so_far) {
            Ok(there) if !there.is_file() && !there.is_dir() => {
                Err("this lab reads and writes regular files alone".to_owned())
            }
            _ => Ok(()),
        }
    }

    /// The same of a full path that no link is in.
    fn check_full(&self, path: &Path) -> Result<(), String> {
        let inside = path.strip_prefix(&self.root).map_err(|_| leads_out(path))?;
        let is_hidden = |part: Component<'_>| part.as_os_str().as_encoded_bytes().starts_with(b".");
        if inside.components().any(is_hidden) {
            Err("names that begin with a dot are the lab's own".to_owned())
        } else {
            Ok(())
        }
    }
}

fn leads_out(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    format!(
        "this lab stays in its folder: {} leads out of it",
        printable(&name)
    )
}
