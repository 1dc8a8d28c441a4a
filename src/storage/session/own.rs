//! Opens, reads and writes the user's own files in a folder to which other users may be able to write. It follows no
//! symbolic link, never waits for a FIFO, and accepts only regular files that belong to the user and have no second hard
//! link.

use rustix::fs::OFlags;
use rustix::io::Errno;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Read, Seek, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;

/// Opens the file at `path` with `options`, if it is the user's own.
///
/// # Errors
/// When it cannot be opened, belongs to another user, is not a regular file, or has a second hard link.
pub(super) fn open(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
    let file = options
        .custom_flags(flags.bits() as i32)
        .open(path)
        .map_err(explained)?;
    check(&file.metadata()?)?;
    Ok(file)
}

/// The metadata of `path`, if it is the user's own; a symbolic link is not followed.
///
/// # Errors
/// When there is nothing at `path`, or it belongs to another user.
pub(super) fn metadata(path: &Path) -> io::Result<Metadata> {
    let there = fs::symlink_metadata(path)?;
    check_owner(&there)?;
    Ok(there)
}

/// Checks that files may be kept in the folder `path`: it must not be another user's symbolic link.
///
/// # Errors
/// When it is such a link.
pub(super) fn check_folder(path: &Path) -> io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(there) if there.is_symlink() => check_owner(&there),
        _ => Ok(()),
    }
}

/// Whether there is anything at `path`; a symbolic link to nothing counts too.
pub(in crate::storage) fn exists(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// Replaces the file at `path` by one that contains `parts`. It writes a temporary file and renames it, so that a file at
/// `path` is always complete.
///
/// # Errors
/// When the new file cannot be written; the old one is then unchanged.
pub(in crate::storage) fn replace(path: &Path, parts: &[&str]) -> io::Result<()> {
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".new");
    let temporary = Path::new(&temporary);
    let written = write(temporary, parts).and_then(|()| fs::rename(temporary, path));
    if written.is_err() {
        let _ = fs::remove_file(temporary); // a partial file would take space on a full disk
    }
    written
}

/// Writes a new file, and reads it back to check that the disk has it.
fn write(path: &Path, parts: &[&str]) -> io::Result<()> {
    let _ = fs::remove_file(path); // left by a process that was killed
    let mut options = OpenOptions::new();
    options.read(true).write(true).create_new(true).mode(0o600);
    let mut file = open(path, &mut options)?;
    parts
        .iter()
        .try_for_each(|part| file.write_all(part.as_bytes()))?;
    file.rewind()?;
    let mut back = Vec::new();
    file.read_to_end(&mut back)?;
    if back == parts.concat().as_bytes() {
        Ok(())
    } else {
        Err(io::Error::other(
            "the disk gives back other bytes than were written",
        ))
    }
}

/// Reads the text of the file at `path`.
///
/// # Errors
/// Why it cannot be read.
pub(in crate::storage) fn read(path: &Path) -> Result<String, String> {
    let mut text = String::new();
    let read = open(path, OpenOptions::new().read(true))
        .and_then(|mut file| file.read_to_string(&mut text));
    match read {
        Ok(_) => Ok(text),
        Err(error) if error.kind() == io::ErrorKind::InvalidData => {
            Err("it is not UTF-8 text".to_owned())
        }
        Err(error) => Err(format!("it cannot be read: {error}")),
    }
}

fn check(there: &Metadata) -> io::Result<()> {
    if !there.is_file() {
        return Err(refused("it is not a file"));
    }
    check_owner(there)?;
    if there.nlink() > 1 {
        Err(refused("it has a second name elsewhere"))
    } else {
        Ok(())
    }
}

fn check_owner(there: &Metadata) -> io::Result<()> {
    if there.uid() == rustix::process::geteuid().as_raw() {
        Ok(())
    } else {
        Err(refused("it belongs to another user"))
    }
}

fn refused(reason: &str) -> io::Error {
    io::Error::new(io::ErrorKind::PermissionDenied, reason)
}

/// `error` with a reason in words where the system's own message would not say what is at the path.
fn explained(error: io::Error) -> io::Error {
    match error.raw_os_error().map(Errno::from_raw_os_error) {
        Some(Errno::LOOP) => refused("it is a symbolic link"),
        Some(Errno::NXIO | Errno::ISDIR) => refused("it is not a file"),
        _ => error,
    }
}
