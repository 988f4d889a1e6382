//! Files of hair and of heads: read with every number checked. Hair is written for other renderers,
//! too.

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
mod ply;
mod ply_strands;
mod raw;
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

/// Files are at most this long, in bytes.
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

/// How a file of hair is read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Import {
    /// Radius at the roots in centimetres, instead of the file's, which is not looked at; strands
    /// then taper as procedural ones do.
    pub radius: Option<f32>,
    /// Centimetres per unit of the file. Without it, they depend on the format.
    pub scale: Option<f32>,
    /// The axis that points up.
    pub up: Up,
    /// How nodes make a strand.
    pub curve: Curve,
    /// Strands beside those of the file.
    pub follow: Follow,
}

/// Hair out of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The hair.
    pub strands: Strands,
    /// Centimetres per unit of the file.
    pub scale: f32,
    /// Lines for the log: what was dropped, changed or not used.
    pub remarks: Vec<String>,
}

/// Reads a file of hair, and returns the hair with a digest of the bytes that were read: a pipe can
/// be read only once. Its format is that of the content; the ending of the name decides where the
/// content fits several.
///
/// # Errors
///
/// If the file cannot be read, or anything that is needed is not as its format has it; see
/// [`Problem`]. No file makes this panic, or take more memory than 64 times its length, times the
/// strands that follow each.
pub fn import(path: &Path, options: &Import) -> Result<(Imported, u64), ImportError> {
    let data = read(path)?;
    Ok((import_bytes(path, &data, options)?, digest(&data)))
}

/// Reads what a file of this name holds.
///
/// # Errors
///
/// See [`import`].
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

/// Refuses a number that is not finite, not above 0, or out of all reason.
fn check_option(name: &'static str, value: Option<f32>) -> Result<(), Problem> {
    match value.filter(|value| !(1e-6..=1e6).contains(value)) {
        Some(value) => Err(Problem::Option { name, value }),
        None => Ok(()),
    }
}

/// The bytes of a file that is not too long.
fn read(path: &Path) -> Result<Vec<u8>, ImportError> {
    let refuse = |problem| ImportError {
        path: path.to_owned(),
        offset: None,
        problem,
    };
    let unread = |source| refuse(Problem::Read(source));
    let file = File::open(path).map_err(unread)?;
    let mut data = Vec::new();
    // One byte more than allowed shows that there are more.
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

/// A problem, and the byte that shows it.
type Wrong = (u64, Problem);
