//! Files of hair: read with every number checked, and written for other renderers.

mod bytes;
mod cyhair;
mod error;
mod follow;
mod mitsuba;
mod tressfx;

pub use error::{ImportError, Problem};
pub use follow::Follow;
pub use mitsuba::write_mitsuba;

use crate::geometry::{Basis, Builder, Flattening, Groom, Spline, Strands};
use bytes::Bytes;
use glam::Vec3;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Files are at most this long, in bytes.
const LONGEST_FILE: u64 = 1 << 31;
/// Spans between nodes become at most 2^4 segments, so that no file grows to more than 64 times its length.
const HALVINGS: i32 = 4;
/// More dropped strands or nodes than this part are a warning.
const MANY: f64 = 0.01;

/// The axis of a file that points up. The renderer's is y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
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

/// How a file of hair is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Import {
    /// Radius at the roots in centimetres, instead of the file's; strands then taper as procedural ones do.
    pub radius: Option<f32>,
    /// Centimetres per unit of the file. Without it, `.hair` is taken to be in centimetres and `.tfx` in metres.
    pub scale: Option<f32>,
    /// The axis that points up.
    pub up: Up,
    /// How finely smooth curves through the nodes are flattened; without it, nodes are joined by straight segments.
    pub smooth: Option<Flattening>,
    /// Strands beside those of the file.
    pub follow: Follow,
}

impl Default for Import {
    fn default() -> Self {
        Self {
            radius: None,
            scale: None,
            up: Up::Y,
            smooth: Some(Flattening::default()),
            follow: Follow::default(),
        }
    }
}

/// Hair out of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The hair.
    pub strands: Strands,
    /// Lines for the log: what was dropped, what was not used.
    pub remarks: Vec<String>,
}

/// Reads a file of hair, `.hair` (cyHair) or `.tfx` (`TressFX`), by the ending of its name.
///
/// # Errors
///
/// If the file cannot be read, or anything in it is not as its format has it; see [`Problem`]. No file makes this panic, or
/// take more memory than 64 times its length, times the strands that follow each.
pub fn import(path: &Path, options: &Import) -> Result<Imported, ImportError> {
    let unread = |source| ImportError {
        path: path.to_owned(),
        offset: None,
        problem: Problem::Read(source),
    };
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
        let problem = Problem::TooLong { most: LONGEST_FILE };
        return Err(ImportError {
            path: path.to_owned(),
            offset: None,
            problem,
        });
    }
    import_bytes(path, &data, options)
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
    let parse = match path.extension().and_then(|ending| ending.to_str()) {
        Some(ending) if ending.eq_ignore_ascii_case("hair") => cyhair::parse,
        Some(ending) if ending.eq_ignore_ascii_case("tfx") => tressfx::parse,
        _ => return Err(refuse(Problem::Ending)),
    };
    for (name, value) in [
        ("radius", options.radius),
        ("scale", options.scale),
        ("spread", Some(options.follow.spread)),
    ] {
        if let Some(value) = value.filter(|value| !(1e-6..=1e6).contains(value)) {
            return Err(refuse(Problem::Option { name, value }));
        }
    }
    let wrong = |(offset, problem)| ImportError {
        path: path.to_owned(),
        offset: Some(offset),
        problem,
    };
    parse(Bytes(data))
        .and_then(|raw| raw.build(options))
        .map_err(wrong)
}

/// A problem, and the byte that shows it.
type Wrong = (u64, Problem);

/// Strands as a file has them: places in its units, and where in it they are.
struct Raw<'a> {
    /// Centimetres per unit, if nothing else is said.
    scale: f32,
    strands: Box<dyn Iterator<Item = RawStrand<'a>> + 'a>,
    /// How many strands the file says that it has.
    count: usize,
    /// Whether it has radii.
    radii: bool,
    /// Contents of the file that are not used.
    unused: Vec<&'static str>,
}

/// Nodes from root to tip: place, radius, and offset in the file. Radii are 0 if the file has none.
struct RawStrand<'a> {
    offset: u64,
    nodes: Box<dyn Iterator<Item = (Vec3, f32)> + 'a>,
}

impl Raw<'_> {
    /// Scaled, turned, smoothed and checked.
    fn build(self, options: &Import) -> Result<Imported, Wrong> {
        let scale = options.scale.unwrap_or(self.scale);
        let about = options.follow.strands as usize + 1;
        let covering =
            (!self.radii).then(|| Groom::covering_radius(about.saturating_mul(self.count)));
        let root_radius = options.radius.or(covering);
        let mut builder = Strands::builder();
        let (mut total, mut repeated) = (0, 0);
        for (guide, strand) in self.strands.enumerate() {
            let place = |(position, radius): (Vec3, f32)| {
                (options.up.turn(scale * position), scale * radius)
            };
            let mut nodes: Vec<(Vec3, f32)> = strand.nodes.map(place).collect();
            total += nodes.len();
            // Curves through nodes that coincide have loops.
            let before = nodes.len();
            nodes.dedup_by(|node, last| Builder::coincide(node.0, last.0));
            repeated += before - nodes.len();
            if let Some(radius) = root_radius {
                let last = nodes.len().saturating_sub(1).max(1) as f32;
                nodes
                    .iter_mut()
                    .enumerate()
                    .for_each(|(k, node)| node.1 = Groom::tapered(radius, k as f32 / last));
            }
            for nodes in options.follow.about(guide, &nodes) {
                let added = match options.smooth {
                    Some(flattening) => builder.push(smooth(&nodes, &flattening.at_most(HALVINGS))),
                    None => builder.push(nodes),
                };
                added.map_err(|error| (strand.offset, Problem::Geometry(error)))?;
            }
        }
        let mut remarks = Vec::new();
        let mut dropped = |what: &str, count: usize, of: usize| {
            let warning = if count as f64 > MANY * of as f64 {
                "warning: "
            } else {
                ""
            };
            if count > 0 {
                remarks.push(format!("{warning}dropped {count} of {of} {what}"));
            }
        };
        dropped(
            "strands, which have no segment",
            builder.dropped_strands(),
            about * self.count,
        );
        dropped(
            "nodes, which repeat the one before",
            repeated + builder.dropped_nodes(),
            total,
        );
        if !self.unused.is_empty() {
            remarks.push(format!("not used: {}", self.unused.join(", ")));
        }
        let strands = builder.finish();
        if strands.segments() > 0 && strands.thickest() == 0.0 {
            return Err((cyhair::THICKNESS_AT, Problem::NoRadius));
        }
        Ok(Imported { strands, remarks })
    }
}

/// A smooth curve through the nodes, as a polyline; radii go from node to node.
fn smooth(nodes: &[(Vec3, f32)], flattening: &Flattening) -> Vec<(Vec3, f32)> {
    let positions: Vec<Vec3> = nodes.iter().map(|node| node.0).collect();
    let Some(spline) = Spline::new(&positions, Basis::CatmullRom) else {
        return nodes.to_vec();
    };
    let radius = |part: f32| {
        let place = part * spline.spans() as f32;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "cut to a whole number, from 0"
        )]
        let span = (place as usize).min(spline.spans() - 1);
        let (from, to) = (nodes[span].1, nodes[span + 1].1);
        (from + (place - span as f32) * (to - from)).max(0.0)
    };
    let mut polyline = Vec::new();
    flattening.append(&spline, radius, &mut polyline);
    polyline
}
