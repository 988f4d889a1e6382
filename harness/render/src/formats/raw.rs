//! Strands as a file has them, and the steps that make hair of them.

use super::{Curve, Import, Imported, Problem, Wrong};
use crate::geometry::{Basis, Builder, Flattening, Groom, Spline, Strands};
use crate::tree;
use glam::Vec3;

/// Share of dropped strands or nodes above which a remark is a warning.
const MANY: f64 = 0.01;
/// Ratio of radius to length of a strand above which there is a warning.
const THICK: f32 = 0.1;
/// Usual extents of hair in centimetres; hair of another extent is likely to be in another unit.
const EXTENTS: core::ops::RangeInclusive<f32> = 1.0..=1000.0;
/// Largest number of halvings of a span between nodes, which gives at most 2^4 segments ...
const HALVINGS: i32 = 4;
/// ... and fewer if the hair would take more than this many times the bytes of the file ...
const GROWTH: u64 = 64;
/// ... where a node takes this many bytes: 16, while their vector grows to twice that, and 12 for its
/// tangent.
const NODE_BYTES: u64 = 2 * 16 + 12;

/// Strands as a file has them: positions in its units, and offsets in the file.
pub(super) struct Raw<'a> {
    /// Centimetres per unit, unless the options state another scale.
    pub(super) scale: f32,
    pub(super) strands: Box<dyn Iterator<Item = RawStrand<'a>> + 'a>,
    /// Number of strands.
    pub(super) count: usize,
    /// Number of nodes of all strands.
    pub(super) nodes: u64,
    /// Offset of the radii in the file, if it has any that are wanted.
    pub(super) radii: Option<u64>,
    /// Lines for the log that are known so far.
    pub(super) remarks: Vec<String>,
}

/// Nodes from root to tip: position, radius, and offset in the file. Radii are 0 if the file has none.
pub(super) struct RawStrand<'a> {
    /// Number of the strand in the file, from 0.
    pub(super) number: usize,
    pub(super) offset: u64,
    pub(super) nodes: Box<dyn Iterator<Item = (Vec3, f32)> + 'a>,
}

/// Counts of unusual strands in a file.
#[derive(Default)]
struct Seen {
    nodes: usize,
    repeated: usize,
    /// Strands that have length but no thickness.
    invisible: usize,
    /// Strands whose radius exceeds [`THICK`] of their length, the largest such radius, and its
    /// strand's length.
    thick: (usize, f32, f32),
    lengths: Vec<f32>,
}

impl Raw<'_> {
    /// Scales, turns, smooths and checks the strands of a file of `length` bytes.
    pub(super) fn build(self, options: &Import, length: u64) -> Result<Imported, Wrong> {
        let scale = options.scale.unwrap_or(self.scale);
        let about = options.follow.strands as usize + 1;
        let covering = self
            .radii
            .is_none()
            .then(|| Groom::covering_radius(about.saturating_mul(self.count)));
        let root_radius = options.radius.or(covering);
        let flattening = Flattening::default().at_most(halvings(length, self.nodes));
        let mut builder = Strands::builder();
        // Number, in the file, of the strand that each strand is about.
        let mut guides = Vec::new();
        let mut seen = Seen::default();
        for (guide, strand) in self.strands.enumerate() {
            let place = |(position, radius): (Vec3, f32)| {
                (options.up.turn(scale * position), scale * radius)
            };
            let mut nodes: Vec<(Vec3, f32)> = strand.nodes.map(place).collect();
            // Drop nodes that coincide, because curves through them have loops.
            let before = nodes.len();
            nodes.dedup_by(|node, last| Builder::coincide(node.0, last.0));
            seen.nodes += before;
            seen.repeated += before - nodes.len();
            if let Some(radius) = root_radius {
                let last = nodes.len().saturating_sub(1).max(1) as f32;
                nodes
                    .iter_mut()
                    .enumerate()
                    .for_each(|(k, node)| node.1 = Groom::tapered(radius, k as f32 / last));
            }
            seen.strand(&nodes);
            for nodes in options.follow.about(guide, &nodes) {
                let before = builder.strands();
                let wrong = |error| {
                    let (offset, strand) = (strand.offset, strand.number);
                    (offset, Problem::Geometry { strand, error })
                };
                builder
                    .push(options.curve.polyline(nodes, &flattening))
                    .map_err(wrong)?;
                guides.extend((before < builder.strands()).then_some(strand.number));
            }
        }
        let mut remarks = self.remarks;
        remarks.extend(seen.remarks(&builder, about * self.count));
        let mut strands = builder.finish();
        if strands.segments() > 0 && strands.thickest() == 0.0 {
            return Err((self.radii.unwrap_or(0), Problem::NoRadius));
        }
        remarks.extend(clamp(&mut strands, &guides, &mut seen.lengths)?);
        let extent = strands.bounds().size().max_element();
        if strands.strands() > 0 && !EXTENTS.contains(&extent) {
            remarks.push(format!(
                "warning: the hair is {extent} cm across: --scale sets centimetres per unit of the file (here {scale})"
            ));
        }
        Ok(Imported {
            strands,
            scale,
            remarks,
        })
    }
}

/// Returns how often spans may be halved, so that the hair of a file of `length` bytes stays within
/// its memory.
fn halvings(length: u64, nodes: u64) -> i32 {
    let most = GROWTH.saturating_mul(length) / nodes.saturating_mul(NODE_BYTES).max(1);
    let fits = |halvings: &i32| most >= 1 << halvings;
    (1..=HALVINGS).rev().find(fits).unwrap_or(0)
}

impl Seen {
    /// Counts a strand that is invisible or thick, and keeps its length.
    fn strand(&mut self, nodes: &[(Vec3, f32)]) {
        let steps = nodes.windows(2).map(|pair| pair[0].0.distance(pair[1].0));
        let length: f32 = steps.sum();
        let radius = nodes.iter().map(|node| node.1).fold(0.0, f32::max);
        if nodes.len() < 2 {
            return;
        }
        self.lengths.push(length);
        self.invisible += usize::from(radius == 0.0);
        if radius > THICK * length {
            self.thick.0 += 1;
            if radius > self.thick.1 {
                (self.thick.1, self.thick.2) = (radius, length);
            }
        }
    }

    /// Returns lines for the log.
    fn remarks(&self, builder: &Builder, strands: usize) -> Vec<String> {
        let mut remarks = Vec::new();
        let mut dropped = |what: &str, count: usize, of: usize| {
            let many = count as f64 > MANY * of as f64;
            if count > 0 {
                let warning = if many { "warning: " } else { "" };
                remarks.push(format!("{warning}dropped {count} of {of} {what}"));
            }
        };
        dropped(
            "strands, which have no segment",
            builder.dropped_strands(),
            strands,
        );
        dropped(
            "nodes, which repeat the one before",
            self.repeated + builder.dropped_nodes(),
            self.nodes,
        );
        let all = self.lengths.len();
        if self.invisible > 0 {
            let invisible = self.invisible;
            remarks.push(format!(
                "warning: {invisible} of {all} strands have thickness 0 and do not show: --radius gives them one"
            ));
        }
        let (thick, radius, length) = self.thick;
        if thick > 0 {
            remarks.push(format!(
                "warning: radii of {thick} of {all} strands exceed a tenth of their lengths (up to {radius} cm, along {length} \
                 cm): --radius sets radii in cm"
            ));
        }
        remarks
    }
}

/// Widens strands that are too thin for the extent of the scene, and returns a warning.
fn clamp(
    strands: &mut Strands,
    guides: &[usize],
    lengths: &mut [f32],
) -> Result<Option<String>, Wrong> {
    let size = strands.bounds().size().length();
    let least = tree::thinnest(size);
    let thickness = |strands: &Strands, strand: u32| {
        strands
            .nodes_of(strand)
            .map(|node| strands.node_radius(node))
            .fold(0.0, f32::max)
    };
    let all = strands.strands();
    let thin: Vec<(u32, f32)> = (0..)
        .take(all)
        .map(|strand| (strand, thickness(strands, strand)))
        .filter(|&(_, radius)| radius > 0.0 && radius < least)
        .collect();
    let Some(&(thinnest, radius)) = thin.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Ok(None);
    };
    let middle = lengths.len() / 2;
    let length = *lengths.select_nth_unstable_by(middle, f32::total_cmp).1;
    if least > THICK * length {
        let strand = guides[farthest(strands)];
        let problem = Problem::Scattered {
            size,
            length,
            strand,
        };
        return Err((0, problem));
    }
    for &(strand, radius) in &thin {
        strands.widen(strand, least / radius);
    }
    let number = guides[thinnest as usize];
    Ok(Some(format!(
        "warning: widened {} of {all} strands to a radius of {least} cm, the least in a scene of {size} cm (strand {number} had \
         {radius} cm)",
        thin.len()
    )))
}

/// Returns the strand that reaches farthest from the middle of all roots.
fn farthest(strands: &Strands) -> usize {
    let roots: Vec<Vec3> = (0..)
        .take(strands.strands())
        .map(|strand| strands.nodes_of(strand))
        .map(|nodes| strands.node_position(nodes.start))
        .collect();
    let middle = [0, 1, 2].map(|axis| {
        let mut places: Vec<f32> = roots.iter().map(|root| root[axis]).collect();
        let middle = places.len() / 2;
        *places.select_nth_unstable_by(middle, f32::total_cmp).1
    });
    let reach = |strand: u32| {
        strands
            .nodes_of(strand)
            .map(|node| strands.node_position(node).distance(Vec3::from(middle)))
            .fold(0.0, f32::max)
    };
    let of = (0..).take(strands.strands()).map(reach).enumerate();
    of.max_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |most| most.0)
}

impl Curve {
    /// Flattens the strand to a polyline, with radii interpolated from node to node.
    fn polyline(self, nodes: Vec<(Vec3, f32)>, flattening: &Flattening) -> Vec<(Vec3, f32)> {
        let basis = match self {
            Self::Linear => return nodes,
            Self::Smooth => Basis::CatmullRom,
            Self::BSpline => Basis::PinnedBSpline,
        };
        let positions: Vec<Vec3> = nodes.iter().map(|node| node.0).collect();
        let Some(spline) = Spline::new(&positions, basis) else {
            return nodes;
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
}
