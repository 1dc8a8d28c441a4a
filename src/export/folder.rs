//! A folder of output that appears only once all its files are complete.

use super::destination::{DestinationError, folder_of};
use super::temporary;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder that is being written, under a temporary name beside the place that it will have.
#[derive(Debug)]
pub struct Folder {
    temporary: TempDir,
    path: PathBuf,
    replace: bool,
    _lock: File,
}

impl Folder {
    /// Begins a folder that will be at `path`. One that is there already must be empty, unless `replace` is true: then its
    /// files of the same names are replaced, and its others stay.
    ///
    /// # Errors
    /// When something other than a folder is at `path`, when it holds files and `replace` is false, or when the system
    /// reports an error.
    pub fn begin(path: &Path, replace: bool) -> Result<Self, DestinationError> {
        let path: PathBuf = path.components().collect(); // without a slash at its end
        let refused = |error| DestinationError::refused(&path, error);
        let in_folder = folder_of(&path);
        if !in_folder.is_dir() {
            return Err(DestinationError::NoFolder {
                path: path.clone(),
                folder: in_folder.to_owned(),
            });
        }
        may_be_written(&path, replace)?;
        let permissions = fs::Permissions::from_mode(0o777); // before the umask
        let (temporary, lock) = temporary::folder_in(in_folder, &permissions).map_err(refused)?;
        Ok(Self {
            temporary,
            path,
            replace,
            _lock: lock,
        })
    }

    pub fn path(&self) -> &Path {
        self.temporary.path()
    }

    /// Gives it its final name: the files written to it are complete. Returns the names of the files that were there before
    /// and are none of those, in their order.
    ///
    /// # Errors
    /// When files have come to be there meanwhile that may not be replaced, or when the system reports an error.
    pub fn keep(self) -> Result<Vec<String>, DestinationError> {
        let refused = |error| DestinationError::refused(&self.path, error);
        may_be_written(&self.path, self.replace)?;
        if fs::rename(self.temporary.path(), &self.path).is_ok() {
            let _ = self.temporary.keep(); // its old name is gone already
            return Ok(Vec::new());
        }
        // There are files: each new one replaces the file of its name.
        fs::create_dir_all(&self.path).map_err(refused)?;
        let names = |folder: &Path| -> io::Result<Vec<OsString>> {
            let files = fs::read_dir(folder)?;
            files.map(|file| Ok(file?.file_name())).collect()
        };
        let new = names(self.temporary.path()).map_err(refused)?;
        for name in &new {
            let (from, to) = (self.temporary.path().join(name), self.path.join(name));
            fs::rename(from, to).map_err(refused)?;
        }
        let mut others = names(&self.path).map_err(refused)?;
        others.retain(|name| !new.contains(name));
        others.sort();
        let others = others
            .iter()
            .map(|name| name.to_string_lossy().into_owned());
        Ok(others.collect())
    }
}

fn may_be_written(path: &Path, replace: bool) -> Result<(), DestinationError> {
    let there = match fs::metadata(path) {
        Ok(there) => there,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(DestinationError::refused(path, error)),
    };
    if !there.is_dir() {
        return Err(DestinationError::NotAFolder(path.to_owned()));
    }
    let mut files = fs::read_dir(path).map_err(|error| DestinationError::refused(path, error))?;
    match files.next() {
        Some(_) if !replace => Err(DestinationError::FolderInUse(path.to_owned())),
        _ => Ok(()),
    }
}
