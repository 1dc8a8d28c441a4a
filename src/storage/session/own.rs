//! Opening, reading and writing the files of a folder that others may be able to write to: no symbolic link is followed, nothing is waited
//! for, and only a regular file counts that is the user's own and has no other name.

use rustix::fs::OFlags;
use rustix::io::Errno;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Read, Seek, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;

/// Opens `path` as `options` say, if what is there is the user's own file.
///
/// # Errors
/// When it cannot be opened, or belongs to another, or is no regular file.
pub(super) fn open(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
    let file = options
        .custom_flags(flags.bits() as i32)
        .open(path)
        .map_err(in_words)?;
    check(&file.metadata()?)?;
    Ok(file)
}

/// What is at `path` itself, if it is the user's own: a link is not followed.
///
/// # Errors
/// When there is nothing, or it belongs to another.
pub(super) fn look(path: &Path) -> io::Result<Metadata> {
    let there = fs::symlink_metadata(path)?;
    check_owner(&there)?;
    Ok(there)
}

/// Whether files may be kept in the folder `path`: another user's link to one is not followed.
///
/// # Errors
/// When it is such a link.
pub(super) fn check_folder(path: &Path) -> io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(there) if there.is_symlink() => check_owner(&there),
        _ => Ok(()),
    }
}

/// Whether there is anything at `path`, be it a link that leads nowhere.
pub(super) fn is_there(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// Gives the file at `path` these `parts`: under another name first, so that it is always whole.
///
/// # Errors
/// When they cannot be written; what was there before is still there.
pub(super) fn replace(path: &Path, parts: &[&str]) -> io::Result<()> {
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".new");
    let temporary = Path::new(&temporary);
    let written = write(temporary, parts).and_then(|()| fs::rename(temporary, path));
    if written.is_err() {
        let _ = fs::remove_file(temporary); // on a full disk it would be in the way
    }
    written
}

/// Writes a new file, and reads it back: what the disk does not give again has not been written.
fn write(path: &Path, parts: &[&str]) -> io::Result<()> {
    let _ = fs::remove_file(path); // a process that was killed has left it
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

/// The text of the file at `path`.
///
/// # Errors
/// Why it cannot be had.
pub(super) fn read(path: &Path) -> Result<String, String> {
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

fn in_words(error: io::Error) -> io::Error {
    match error.raw_os_error().map(Errno::from_raw_os_error) {
        Some(Errno::LOOP) => refused("it is a symbolic link"),
        Some(Errno::NXIO | Errno::ISDIR) => refused("it is not a file"),
        _ => error,
    }
}
