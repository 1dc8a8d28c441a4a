//! Measured data: accepted files, rejected files, and the values of a run at the measured times.

mod broken;
mod of_run;
mod read;
mod spellings;
