//! Heads as meshes, read from PLY and Wavefront OBJ.

use super::bytes::Bytes;
use super::ply::{self, Ply};
use super::ply_strands::Vertices;
use super::polygon::{Parts, fan};
use super::{ImportError, Problem, Up, Wrong, check_option, obj, read};
use crate::geometry::Mesh;
use crate::part::digest;
use std::path::Path;

/// Options by which the mesh of a head is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// Centimetres per unit of the file.
    pub scale: f32,
    /// Axis of the file that points up.
    pub up: Up,
}

/// Reads a mesh of triangles or polygons, PLY or OBJ by its content, and returns the mesh with a
/// digest of the bytes that were read, as [`import`](super::import) does.
///
/// # Errors
///
/// Returns an error if the file cannot be read, or if anything that is needed is not as its format
/// has it; see [`Problem`].
pub fn import_head(path: &Path, options: &Head) -> Result<(Mesh, u64), ImportError> {
    let data = read(path)?;
    Ok((import_head_bytes(path, &data, options)?, digest(&data)))
}

/// Reads a mesh from the content of a file with this name.
///
/// # Errors
///
/// Returns the errors of [`import_head`], except those of reading the file.
pub fn import_head_bytes(path: &Path, data: &[u8], options: &Head) -> Result<Mesh, ImportError> {
    let refuse = |offset, problem| ImportError {
        path: path.to_owned(),
        offset,
        problem,
    };
    check_option("head-scale", Some(options.scale)).map_err(|problem| refuse(None, problem))?;
    let bytes = Bytes(data);
    let parts = if ply::fits(bytes) {
        of_ply(bytes)
    } else {
        obj::parse(bytes)
    };
    let (mut places, triangles) =
        parts.map_err(|(offset, problem)| refuse(Some(offset), problem))?;
    for place in &mut places {
        *place = options.up.turn(options.scale * *place);
    }
    Mesh::new(places, triangles).map_err(|problem| refuse(None, Problem::Text(problem)))
}

fn of_ply(bytes: Bytes<'_>) -> Result<Parts, Wrong> {
    let ply = Ply::new(bytes)?;
    let (vertex, columns) = Vertices::new(&ply)?;
    let faces = ply.elements.iter().find_map(|one| {
        let lists = ["vertex_indices", "vertex_index", "indices"];
        Some((
            one,
            one.column(&lists, true).filter(|_| one.name == "face")?,
        ))
    });
    let Some((face, column)) = faces else {
        let problem = "a head must be a mesh: an element `face` with `vertex_indices`";
        return Err((0, Problem::Text(problem.to_owned())));
    };
    let (mut places, mut triangles) = (Vec::new(), Vec::new());
    ply.rows(|element, row| {
        if core::ptr::eq(element, vertex) {
            places.push(columns.place(row)?);
        } else if core::ptr::eq(element, face) {
            let corners = row.columns[column]
                .iter()
                .map(|value| row.index(*value, vertex.count))
                .collect::<Result<Vec<u32>, Wrong>>()?;
            triangles.extend(fan(&corners));
        }
        Ok(())
    })?;
    Ok((places, triangles))
}
