//! Whether a shell could resume this process if it stopped.

use rustix::process::{Pid, getpgid, getpgrp, getppid, getsid};
use std::fs;

/// Why Ctrl-Z does nothing where [`can_be_resumed`] is false.
pub const NO_SHELL: &str = "there is no shell to go back to: q leaves, and keeps the session";

/// Returns whether a shell with job control started this process, and still runs.
///
/// A process group has such a shell if the parent of one of its processes is in the same session but in another group. A
/// group without one is orphaned: the system ignores SIGTSTP there, since nobody would resume a stopped process. From
/// this process the parents are followed upward until they leave the group.
pub fn can_be_resumed() -> bool {
    let (group, session) = (getpgrp(), getsid(None));
    let mut parent = getppid();
    while let Some(process) = parent {
        if session.is_err() || getsid(Some(process)) != session {
            return false;
        }
        if getpgid(Some(process)) != Ok(group) {
            return true;
        }
        parent = parent_of(process);
    }
    false
}

/// Returns the parent of `process`; `None` if there is none, or the system has no `/proc` that names it.
fn parent_of(process: Pid) -> Option<Pid> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let (_, after_name) = stat.rsplit_once(')')?; // the name may hold blanks and brackets
    let parent = after_name.split_whitespace().nth(1)?;
    Pid::from_raw(parent.parse().ok()?)
}
