//! C interface of hairis: plain data that the caller owns, and every model of the registry by name.
//!
//! `include/hairis.h` documents the functions and the structs; structs and constants have the names of the header without their
//! prefix. Callers promise what the header states: pointers are valid and not null unless the header allows null, columns hold
//! `n` numbers, and outputs overlap no other column.
#![cfg_attr(not(feature = "std"), no_std)]
#![allow(unsafe_code, reason = "arguments are pointers of C")]
#![allow(
    clippy::missing_safety_doc,
    reason = "every function has the promise above"
)]

pub mod artist;
pub mod color;
pub mod columns;
pub mod dual;
mod handles;
pub mod hits;
pub mod layout;
mod models;
pub mod points;
pub mod setup;
mod text;
#[cfg(all(not(feature = "std"), not(test)))]
mod without_std;
