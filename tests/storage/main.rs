//! What outlasts the screen: sessions and exports in the background. A program of its own, because a test that starts
//! a process holds the locks of all files open beside it for a moment.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod exporting;
mod hostile;
mod session;
