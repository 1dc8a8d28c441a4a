//! What outlasts the screen: the session that can be come back to, exports, and the farewell that brings both home
//! whatever ends the process.

pub mod exporting;
pub mod farewell;
pub mod session;
