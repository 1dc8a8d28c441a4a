//! Helpers that several test modules share.

#![allow(dead_code, reason = "no test program needs all of it")]

pub mod desk;
pub mod dice;
pub mod ground;
pub mod pty;
pub mod scenarios;
pub mod stage;
pub mod tex;
pub mod words;
