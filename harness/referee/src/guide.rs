//! Guide to the command `hairis referee`.
//!
//! | chapter | question |
//! |---|---|
//! | [`referee`] | What is wrong with the hair of another program? |

#[doc = include_str!("guide/referee.md")]
pub mod referee {}
