//! The exact motion, compared with reference motions and an independent integration, and its conservation laws.

mod common;
mod laws;
mod near;
mod reference;
mod taylor;
