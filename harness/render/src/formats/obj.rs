//! Wavefront OBJ, and of its statements only `v x y z` and `f a b c ...`. Each `a` is the number of a vertex,
//! from 1 or back from -1, and may have other numbers behind slashes.
//!
//! Own code, because `tobj` rejects meshes for normals and colours, which are not used, and names no line.

use super::bytes::{Bytes, position};
use super::polygon::{Parts, fan};
use super::text::{Lines, data, excerpt};
use super::{Problem, Wrong};
use glam::Vec3;
use std::borrow::Cow;

/// Reads the mesh of a file.
pub(super) fn parse(bytes: Bytes<'_>) -> Result<Parts, Wrong> {
    let (mut places, mut triangles) = (Vec::new(), Vec::new());
    for (offset, statement) in statements(bytes) {
        let mut words = statement.split_ascii_whitespace();
        let wrong = |problem: String| {
            let problem = format!("{problem} in {}", excerpt(&statement));
            (offset, Problem::Text(problem))
        };
        match words.next() {
            Some("v") => {
                let place = vertex(words).map_err(wrong)?;
                places.push(position(place, offset)?);
            }
            Some("f") => {
                let corners = face(words, places.len()).map_err(wrong)?;
                triangles.extend(fan(&corners));
            }
            _ => {}
        }
    }
    if places.is_empty() {
        let problem = "a head must be a mesh, PLY or OBJ, got no vertex".to_owned();
        return Err((0, Problem::Text(problem)));
    }
    Ok((places, triangles))
}

/// Iterates over statements and their offsets: lines without comments, each joined with the next if a backslash ends it.
fn statements(bytes: Bytes<'_>) -> impl Iterator<Item = (u64, Cow<'_, str>)> {
    let mut lines = Lines::new(bytes);
    core::iter::from_fn(move || {
        let (offset, line) = lines.next()?;
        let mut statement = data(line);
        while let Some(length) = statement.trim_end().strip_suffix('\\').map(str::len) {
            let statement = statement.to_mut();
            statement.truncate(length);
            statement.push(' ');
            statement.extend(lines.next().map(|(_, line)| data(line)));
        }
        Some((offset, statement))
    })
}

/// Parses a position from the words behind `v`.
fn vertex<'a>(words: impl Iterator<Item = &'a str>) -> Result<Vec3, String> {
    let number = |word: &str| {
        let number = word.parse::<f32>();
        number.map_err(|_| format!("a coordinate must be a number, got {}", excerpt(word)))
    };
    let numbers: Vec<f32> = words.take(3).map(number).collect::<Result<_, _>>()?;
    match numbers[..] {
        [x, y, z] => Ok(Vec3::new(x, y, z)),
        _ => Err(format!(
            "a vertex must have three coordinates, got {}",
            numbers.len()
        )),
    }
}

/// Parses the indices of vertices from the words behind `f`, below `count` vertices.
fn face<'a>(words: impl Iterator<Item = &'a str>, count: usize) -> Result<Vec<u32>, String> {
    let corner = |word: &str| {
        let number = word.split('/').next().unwrap_or_default();
        let digits = number.strip_prefix(['+', '-']).unwrap_or(number);
        if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(format!(
                "a corner must begin with the whole number of a vertex, got {}",
                excerpt(word)
            ));
        }
        // A number too long for the type is of no vertex.
        let number = number.parse().unwrap_or(i64::MAX);
        let index = if number < 0 {
            number + count as i64
        } else {
            number - 1
        };
        let index = u32::try_from(index)
            .ok()
            .filter(|index| (*index as usize) < count);
        index.ok_or_else(|| {
            format!(
                "a corner must be one of the {count} vertices before the face, got {}",
                excerpt(word)
            )
        })
    };
    let corners: Vec<u32> = words.map(corner).collect::<Result<_, _>>()?;
    match corners.len() {
        0..3 => Err(format!(
            "a face must have at least three corners, got {}",
            corners.len()
        )),
        _ => Ok(corners),
    }
}
