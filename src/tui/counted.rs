//! A writer whose bytes are counted.

use std::cell::Cell;
use std::io::{self, Write};
use std::rc::Rc;

/// Writes to what it holds, and counts the bytes.
#[derive(Debug)]
pub struct Counted<W> {
    writer: W,
    count: Rc<Cell<usize>>,
}

impl<W> Counted<W> {
    /// `writer`, and the number of bytes that are written to it from now on.
    pub fn new(writer: W) -> (Self, Rc<Cell<usize>>) {
        let count = Rc::new(Cell::new(0));
        let shared = Rc::clone(&count);
        (Self { writer, count }, shared)
    }
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.writer.write(bytes)?;
        self.count.set(self.count.get() + written);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_counted() {
        let (mut writer, count) = Counted::new(Vec::new());
        writer.write_all(b"frame").unwrap();
        write!(writer, " {}", 12).unwrap();
        assert_eq!(count.get(), 8);
        assert_eq!(writer.writer, b"frame 12");
    }
}
