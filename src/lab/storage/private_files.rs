//! Opens files safely in a folder to which other users may be able to write: only regular files that belong to the
//! user. It follows no symbolic link and does not wait for a FIFO.

use crate::engine::export::temporary;
use rustix::fs::OFlags;
use rustix::io::Errno;
use std::fs::{DirBuilder, File, OpenOptions, Permissions};
use std::io::{self, Read, Write};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::Path;

/// Opens the file at `path`.
///
/// # Errors
/// Returns an error if the file belongs to another user or is not a regular file.
pub(super) fn open(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    let file = open_regular(path, options)?;
    if file.metadata()?.uid() != rustix::process::geteuid().as_raw() {
        return Err(refused("it belongs to another user"));
    }
    Ok(file)
}

/// Opens the file at `path`, whoever owns it.
///
/// # Errors
/// Returns an error if it is not a regular file.
pub(super) fn open_regular(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
    let opened = options.custom_flags(flags.bits() as i32).open(path);
    let file = opened.map_err(|error| match Errno::from_io_error(&error) {
        Some(Errno::LOOP) => refused("it is a symbolic link"),
        Some(Errno::NXIO | Errno::ISDIR) => refused("it is not a file"),
        _ => error,
    })?;
    if !file.metadata()?.is_file() {
        return Err(refused("it is not a file"));
    }
    Ok(file)
}

pub(super) fn refused(reason: &str) -> io::Error {
    io::Error::new(io::ErrorKind::PermissionDenied, reason)
}

/// Reads the file at `path`.
///
/// # Errors
/// Returns an error as [`open`] does, or if the file has more than `most` bytes.
pub(super) fn read(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    read_at_most(open(path, OpenOptions::new().read(true))?, most)
}

/// Reads the rest of `file`.
///
/// # Errors
/// Returns an error if it has more than `most` bytes. Reading stops there.
pub(super) fn read_at_most(file: File, most: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(most as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > most {
        return Err(io::Error::other(format!("it is longer than {most} bytes")));
    }
    Ok(bytes)
}

/// Replaces the file at `path` by one that contains `text` and that only the user can access. The file is complete at
/// any moment. If the new one cannot be written, the old one stays.
pub(super) fn replace(path: &Path, text: &str) -> io::Result<()> {
    replace_with_mode(path, text, 0o600)
}

/// Does the same with `mode`, whatever the umask is.
pub(super) fn replace_with_mode(path: &Path, text: &str, mode: u32) -> io::Result<()> {
    let permissions = Permissions::from_mode(mode);
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut file = temporary::file_in(folder, &permissions)?;
    file.as_file().set_permissions(permissions)?;
    file.as_file_mut().write_all(text.as_bytes())?; // its errors do not name the temporary file
    file.persist(path)?;
    Ok(())
}

/// Creates the folder if it does not exist, accessible only to the user.
pub(super) fn make_folder(folder: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).mode(0o700).create(folder)
}
