//! Detects whether a shell could resume this process after it stops.

use nix::unistd::{Pid, getpgid, getpgrp, getppid, getsid};
use std::fs;

/// Message when Ctrl-Z does nothing because [`can_be_resumed`] is false.
pub const NO_SHELL: &str = "no shell to return to; press q to quit and keep the session";

/// Returns true if a shell with job control started this process and is still running.
///
/// A process group has such a shell if the parent of one of its processes is in the same session but in another group.
/// A group without one is orphaned. The system ignores SIGTSTP there, because nobody would resume a stopped process.
/// This function follows the parents of this process upward until they leave the group.
///
/// In a container, the session, the group and the parent may belong to a process outside it. Their number is then 0.
pub fn can_be_resumed() -> bool {
    let (group, session) = (getpgrp(), getsid(None));
    let mut parent = Some(getppid());
    while let Some(process) = parent.filter(|process| process.as_raw() > 0) {
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

/// Returns the parent of `process`, or `None` if `/proc` does not name it.
fn parent_of(process: Pid) -> Option<Pid> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let (_, after_name) = stat.rsplit_once(')')?; // the name may contain blanks and brackets
    let parent = after_name.split_whitespace().nth(1)?;
    Some(Pid::from_raw(parent.parse().ok()?))
}
