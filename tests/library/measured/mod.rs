//! Measured data: files that are read, files that are refused, and what a run says at the measured times.

mod broken;
mod of_run;
mod read;
mod spellings;
