//! Reads and writes files and folders that two accounts share through a group, such as the teacher's and the class's.
//!
//! Their modes are set explicitly, whatever the umask is. A file is read only if it belongs to the user or to the owner
//! of its folder, because others may be able to write in that folder too.

use super::private_files::{self, refused};
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::Path;
use std::time::SystemTime;

/// Creates the folder with `mode` if it does not exist. Returns true if it did. An existing folder keeps its mode.
pub fn make_folder(path: &Path, mode: u32) -> io::Result<bool> {
    match fs::create_dir(path) {
        Ok(()) => fs::set_permissions(path, Permissions::from_mode(mode)).map(|()| true),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            if fs::symlink_metadata(path)?.is_dir() {
                Ok(false)
            } else {
                Err(refused("it is not a folder"))
            }
        }
        Err(error) => Err(error),
    }
}

/// Reads the text of the file at `path`; `None` if it does not exist.
///
/// # Errors
/// Returns an error if the file has more than `most` bytes or a wrong owner, or if it cannot be read.
pub fn read(path: &Path, most: usize) -> io::Result<Option<String>> {
    let Some(file) = opened(path)? else {
        return Ok(None);
    };
    let folder = fs::metadata(path.parent().unwrap_or(Path::new(".")))?;
    let owners = [rustix::process::geteuid().as_raw(), folder.uid()];
    if !owners.contains(&file.metadata()?.uid()) {
        return Err(refused("it belongs to another user"));
    }
    text_of(file, most).map(Some)
}

/// Does the same as [`read`] for a file with any owner. It is for files that both accounts write, in a folder that
/// either may have created.
pub fn read_of_anyone(path: &Path, most: usize) -> io::Result<Option<String>> {
    opened(path)?.map(|file| text_of(file, most)).transpose()
}

fn opened(path: &Path) -> io::Result<Option<File>> {
    match private_files::open_regular(path, OpenOptions::new().read(true)) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        file => file.map(Some),
    }
}

fn text_of(file: File, most: usize) -> io::Result<String> {
    String::from_utf8(private_files::read_at_most(file, most)?).map_err(io::Error::other)
}

/// Replaces the file at `path` by one that contains `text`. The file is complete at any moment. If the new one cannot
/// be written, the old one stays.
pub fn replace(path: &Path, text: &str) -> io::Result<()> {
    private_files::replace_with_mode(path, text, 0o640)
}

/// Sets the modification time of the user's own file at `path` to now. This needs no disk space.
pub fn touch(path: &Path) -> io::Result<()> {
    private_files::open(path, OpenOptions::new().write(true))?.set_modified(SystemTime::now())
}

/// Returns the time at which the file was last written or touched; `None` if it does not exist.
pub fn modified(path: &Path) -> Option<SystemTime> {
    fs::symlink_metadata(path).ok()?.modified().ok()
}
