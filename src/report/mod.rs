//! Pictures and pages for a write-up.
//!
//! - [`figure`]: pictures of runs and of tables, and the same pictures drawn again from their files.
//! - [`writeup`]: a run as a folder of files for a write-up.
//!
//! What draws (axes, curves, letters, the formats of files) belongs to [`plot`](crate::plot); what computes, to
//! [`studies`](crate::studies) and the [`engine`](crate::engine).

pub mod figure;
pub mod writeup;
