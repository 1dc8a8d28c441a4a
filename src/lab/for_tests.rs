//! What the tests of several files of the lab begin with.

use crate::scenario::{Document, Scenario};
use std::sync::Arc;

/// The scenario of the preset method-2.
pub(in crate::lab) fn scenario() -> Arc<Scenario> {
    let document = Document::open("method-2").unwrap();
    Arc::new(document.scenario().unwrap())
}
