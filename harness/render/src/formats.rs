//! Files of hair and of heads, which are read with every number checked. Hair is also written for
//! other renderers.

mod bytes;
mod counted;
mod cyhair;
mod error;
mod export;
mod follow;
mod format;
mod mesh;
mod mitsuba;
mod monohair;
mod obj;
mod ply;
mod ply_strands;
mod polygon;
mod raw;
mod text;
mod tressfx;

pub use error::{ImportError, Problem};
pub use export::write_hair;
pub use follow::Follow;
pub use mesh::{Head, import_head, import_head_bytes};
pub use mitsuba::write_mitsuba;

use crate::geometry::Strands;
use crate::part::digest;
use bytes::Bytes;
use clap::ValueEnum;
use format::Format;
use glam::Vec3;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Largest length of a file in bytes.
const LONGEST_FILE: u64 = 1 << 31;

/// The axis of a file that points up. The renderer's is y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Up {
    /// x becomes y, and y becomes -x
    X,
    /// Axes stay as they are
    #[default]
    Y,
    /// z becomes y, and y becomes -z
    Z,
}

impl Up {
    fn turn(self, v: Vec3) -> Vec3 {
        match self {
            Self::X => Vec3::new(-v.y, v.x, v.z),
            Self::Y => v,
            Self::Z => Vec3::new(v.x, v.z, -v.y),
        }
    }
}

/// How the nodes of a file make a strand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Curve {
    /// Straight segments from node to node
    Linear,
    /// A smooth curve through the nodes: centripetal Catmull-Rom, without loops or cusps
    #[default]
    Smooth,
    /// A uniform cubic B-spline near the nodes, from the first to the last
    #[value(name = "bspline")]
    BSpline,
}

/// Options by which a file of hair is read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Import {
    /// Radius at the roots in centimetres, instead of the radii of the file, which are then not read.
    /// Strands taper as procedural ones do.
    pub radius: Option<f32>,
    /// Centimetres per unit of the file. Without a value, they depend on the format.
    pub scale: Option<f32>,
    /// Axis of the file that points up.
    pub up: Up,
    /// Curve that the nodes of a strand make.
    pub curve: Curve,
    /// Strands that are added beside those of the file.
    pub follow: Follow,
}

/// Hair that was read from a file, with remarks on what was changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Strands of the hair.
    pub strands: Strands,
    /// Centimetres per unit of the file.
    pub scale: f32,
    /// Lines for the log, which state what was dropped, changed or not used.
    pub remarks: Vec<String>,
}

/// Reads a file of hair, and returns the hair with a digest of the bytes, because a pipe can be read
/// only once. The content decides the format; if it fits several, the ending of the name decides.
///
/// # Errors
///
/// Returns an error if the file cannot be read, or if anything that is needed is not as its format
/// has it; see [`Problem`]. No file causes a panic, or takes more memory than 64 times its length,
/// times the strands that follow each.
pub fn import(path: &Path, options: &Import) -> Result<(Imported, u64), ImportError> {
    let data = read(path)?;
    Ok((import_bytes(path, &data, options)?, digest(&data)))
}

/// Reads hair from the content of a file with this name.
///
/// # Errors
///
/// Returns the errors of [`import`], except those of reading the file.
pub fn import_bytes(path: &Path, data: &[u8], options: &Import) -> Result<Imported, ImportError> {
    let refuse = |problem| ImportError {
        path: path.to_owned(),
        offset: None,
        problem,
    };
    for (name, value) in [
        ("radius", options.radius),
        ("scale", options.scale),
        ("spread", Some(options.follow.spread)),
    ] {
        check_option(name, value).map_err(refuse)?;
    }
    let bytes = Bytes(data);
    let format = Format::of(bytes, path).map_err(refuse)?;
    let wrong = |(offset, problem)| ImportError {
        path: path.to_owned(),
        offset: Some(offset),
        problem,
    };
    let mut raw = format
        .parse(bytes, options.radius.is_none())
        .map_err(wrong)?;
    raw.remarks.splice(0..0, format.remark(path));
    raw.build(options, bytes.len()).map_err(wrong)
}

/// Rejects a number that is not finite, not above 0, or out of all reason.
fn check_option(name: &'static str, value: Option<f32>) -> Result<(), Problem> {
    match value.filter(|value| !(1e-6..=1e6).contains(value)) {
        Some(value) => Err(Problem::Option { name, value }),
        None => Ok(()),
    }
}

/// Reads the bytes of a file that is not too long.
fn read(path: &Path) -> Result<Vec<u8>, ImportError> {
    let refuse = |problem| ImportError {
        path: path.to_owned(),
        offset: None,
        problem,
    };
    let unread = |source| refuse(Problem::Read(source));
    let file = File::open(path).map_err(unread)?;
    let mut data = Vec::new();
    // Reading one byte more than allowed shows whether the file is too long.
    let too_long = file.metadata().map_err(unread)?.len() > LONGEST_FILE;
    if !too_long {
        file.take(LONGEST_FILE + 1)
            .read_to_end(&mut data)
            .map_err(unread)?;
    }
    if too_long || data.len() as u64 > LONGEST_FILE {
        return Err(refuse(Problem::TooLong { most: LONGEST_FILE }));
    }
    Ok(data)
}

/// Problem with a file, after the offset of the byte that shows it.
type Wrong = (u64, Problem);
