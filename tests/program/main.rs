//! The program itself: its commands, and the lab in a pty.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
// Tests may use the mathematics of the C library.
#![allow(clippy::disallowed_methods)]
// Expected words may be borrowed or owned.
#![allow(clippy::needless_borrows_for_generic_args)]

#[path = "../support/mod.rs"]
mod support;

mod cast;
mod class;
mod class_answers;
mod classes;
mod cli;
mod commands;
mod compare;
mod data_files;
mod escapes;
mod examples;
mod figures;
mod fit;
mod journeys;
mod lessons;
mod manual;
mod measured;
mod messages;
mod mouse;
mod readme;
mod reproduce;
mod sessions;
mod settings;
mod sweep;
mod terminal;
mod travel;
mod verify;
mod writeups;
