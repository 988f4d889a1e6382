//! Tests of the command, which is run as scripts run it.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod cli;
