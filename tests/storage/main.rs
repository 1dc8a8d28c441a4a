//! Tests of sessions and of exports in the background. They are a separate test program, because a test that starts a
//! process briefly keeps the locks of all files that other tests have open.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
// What is only compared may come from the C library.
#![allow(clippy::disallowed_methods)]
// What a text is held against may be borrowed or not.
#![allow(clippy::needless_borrows_for_generic_args)]

#[path = "../support/mod.rs"]
mod support;

mod exporting;
mod hostile;
mod session;
