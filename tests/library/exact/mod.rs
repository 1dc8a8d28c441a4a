//! The exact motion: against motions known to many digits, an independent integration, and the laws it must keep.

mod common;
mod laws;
mod near;
mod reference;
mod taylor;
