//! Files and folders that two accounts share through a group, such as the teacher's and the class's. Their modes are set
//! explicitly, whatever the umask is. A file is read only if it belongs to the user or to the owner of its folder: others
//! may be able to write in that folder too.

use super::private_files::{self, refused};
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::Path;
use std::time::SystemTime;

/// Creates the folder with this mode if it does not exist; returns whether it did. One that exists keeps its mode.
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

/// Reads the text of the file at `path`; `None` where there is none. A file of more than `most` bytes is refused.
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

/// As [`read`], whoever owns the file: for files that both accounts write, in a folder that either may have made.
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

/// Replaces the file at `path` by one that contains `text`. The file is complete at any moment; where the new one cannot be
/// written, the old one stays.
pub fn replace(path: &Path, text: &str) -> io::Result<()> {
    private_files::replace_with_mode(path, text, 0o640)
}

/// Sets the time of the user's own file at `path` to now. It needs no room on the disk.
pub fn touch(path: &Path) -> io::Result<()> {
    private_files::open(path, OpenOptions::new().write(true))?.set_modified(SystemTime::now())
}

/// Returns when the file was written or touched last; `None` where it is not there.
pub fn modified(path: &Path) -> Option<SystemTime> {
    fs::symlink_metadata(path).ok()?.modified().ok()
}
