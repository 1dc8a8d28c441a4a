//! What outlasts the screen: the session that can be come back to, exports, and the hooks that bring both home
//! whatever ends the process.

pub mod at_exit;
pub mod confined;
pub mod exporting;
pub mod session;
