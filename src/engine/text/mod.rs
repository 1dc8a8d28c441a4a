//! Numbers and words as people read them. All other modules write with this one, and it knows nothing of gyroscopes.
//!
//! - [`ascii`]: formulas for terminals without UTF-8.
//! - [`checksum`]: the CRC-32 of a file's content.
//! - [`io_errors`]: why a file cannot be read or written.
//! - [`nice_numbers`]: the numbers 1, 2 and 5 times a power of ten.
//! - [`number`]: numbers in as few digits as a reader needs.
//! - [`printable`]: text with nothing in it that steers a terminal.
//! - [`shipped`]: files that come with the program.
//! - [`mod@unit`]: units at the end of names.
//! - [`wrap`]: text in lines of a width.

pub mod ascii;
pub mod checksum;
pub mod io_errors;
pub mod nice_numbers;
pub mod number;
pub mod printable;
pub mod shipped;
pub mod unit;
pub mod wrap;
