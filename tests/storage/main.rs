//! Tests of sessions and of exports in the background. They are a separate test program, because a test that starts a
//! process briefly keeps the locks of all files that other tests have open.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
// Tests may use the mathematics of the C library.
#![allow(clippy::disallowed_methods)]
// Expected words may be borrowed or owned.
#![allow(clippy::needless_borrows_for_generic_args)]

#[path = "../support/mod.rs"]
mod support;

mod exporting;
mod hostile;
mod session;
