//! The exact motion: against motions known to many digits, an independent integration, and the laws it must keep.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, dead_code)]

mod common;
mod laws;
mod reference;
mod taylor;
