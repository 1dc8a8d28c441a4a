//! The row of one point, as it stands in the file.

use serde::Serialize;

/// One row of a sweep's CSV.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepRow {
    /// The row as it stands in the file, with its line end.
    pub line: String,
    /// Why it holds no readouts.
    pub failure: Option<String>,
}

/// `cells` as one line of CSV.
pub(super) fn line(cells: &impl Serialize) -> String {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    // Writing plain values to memory does not fail.
    let written = writer.serialize(cells).is_ok();
    let bytes = writer.into_inner().unwrap_or_default();
    debug_assert!(written);
    String::from_utf8(bytes).unwrap_or_default()
}
