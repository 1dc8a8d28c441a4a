//! Figures and write-ups of runs, and figures of the tables of [`studies`](crate::studies).
//!
//! It uses [`plot`](crate::plot) to draw, and [`studies`](crate::studies) and the [`engine`](crate::engine) to compute. A new
//! kind of figure, or a new part of a write-up, belongs here.
//!
//! - [`document`]: documents of text, tables and figures, written as Markdown and as TeX.
//! - [`figure`]: pictures of runs and of tables, and the same pictures drawn again from their files.
//! - [`reproduce`]: the report's computations and claims, with the exact motion, as one document.
//! - [`writeup`]: a run as a folder of files for a write-up.

pub mod document;
pub mod figure;
pub mod reproduce;
pub mod writeup;
