//! Studies: cells, views, parts and checks.

mod cell;
mod check;
mod equal_time;
mod grid;
mod part;
mod tables;
mod view;
