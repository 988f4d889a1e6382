//! Procedural hair of several kinds, grown strand by strand.

mod head;
pub(crate) mod random;
mod sheet;

use super::spline::{Basis, Flattening, Spline};
use super::strands::{GeometryError, Strands};
use glam::Vec3;
use rayon::prelude::*;

/// Kinds of procedural hair that [`Groom::new`] has settings for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Long straight hair on a head.
    Straight,
    /// Long wavy hair on a head.
    Wavy,
    /// Long curly hair on a head.
    Curly,
    /// Short fur on a head.
    Fur,
    /// A sheet of parallel strands along x, 20 by 12 cm and 1 cm deep, below the plane y = 0.
    Patch,
    /// One straight strand along x through the origin, of one radius.
    Single,
}

impl Kind {
    /// All kinds, in the order of their declaration.
    pub const ALL: [Self; 6] = [
        Self::Straight,
        Self::Wavy,
        Self::Curly,
        Self::Fur,
        Self::Patch,
        Self::Single,
    ];

    /// Returns the name of the kind, in lower case.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Wavy => "wavy",
            Self::Curly => "curly",
            Self::Fur => "fur",
            Self::Patch => "patch",
            Self::Single => "single",
        }
    }
}

/// Settings of a head of procedural hair. Strand `i` depends on these settings and on `i` alone, so that its bits are the same
/// for any number of threads.
///
/// ```
/// use hairis_render::geometry::{Flattening, Groom, Kind};
/// let strands = Groom::new(Kind::Curly, 100).grow(&Flattening::default())?;
/// assert_eq!(strands.strands(), 100);
/// # Ok::<(), hairis_render::geometry::GeometryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groom {
    /// Kind of hair.
    pub kind: Kind,
    /// Number of strands.
    pub strands: usize,
    /// Mean length, in centimetres.
    pub length: f32,
    /// Standard deviation of the length, relative to the length; cut at two deviations.
    pub length_spread: f32,
    /// Radius at the root, in centimetres.
    pub radius: f32,
    /// Share of the radius that is lost at the tip: `radius (1 - taper s^3)`.
    pub taper: f32,
    /// Number of clumps.
    pub clumps: usize,
    /// Degree to which tips are drawn to the guide of their clump, from 0 to 1.
    pub clump: f32,
    /// Radius of curls, in centimetres.
    pub curl_radius: f32,
    /// Length of a curl, in centimetres.
    pub curl_length: f32,
    /// Twice the standard deviation of nodes at the tip, in centimetres.
    pub frizz: f32,
    /// Rate at which strands bend down, per centimetre.
    pub gravity: f32,
    /// Uprightness of strands at the root: 1 along the head's normal, 0 along its surface, combed away from a parting.
    pub lift: f32,
    /// Nodes per strand.
    pub nodes: usize,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// Semi-axes of the head, an ellipsoid about the origin, in centimetres.
pub const HEAD: Vec3 = Vec3::new(7.5, 10.0, 8.8);

/// Taper of hair, as in [`Groom::taper`].
const TAPER: f32 = 0.6;

impl Groom {
    /// Returns the settings of a kind. The radius is such that any number of strands covers as much as 100,000 hairs 80 um thick,
    /// except for [`Kind::Single`], whose one strand has a fixed radius.
    #[must_use]
    pub fn new(kind: Kind, strands: usize) -> Self {
        let strands = if kind == Kind::Single { 1 } else { strands };
        let straight = Self {
            kind,
            strands,
            length: 14.0,
            length_spread: 0.15,
            radius: Self::covering_radius(strands),
            taper: TAPER,
            clumps: strands / 60 + 1,
            clump: 0.5,
            curl_radius: 0.0,
            curl_length: 4.0,
            frizz: 0.05,
            gravity: 0.22,
            lift: 0.2,
            nodes: 16,
            seed: 1,
        };
        match kind {
            Kind::Straight => straight,
            Kind::Wavy => Self {
                curl_radius: 0.25,
                clump: 0.7,
                frizz: 0.1,
                nodes: 24,
                ..straight
            },
            Kind::Curly => Self {
                length: 16.0,
                curl_radius: 0.55,
                curl_length: 1.8,
                clump: 0.85,
                frizz: 0.12,
                gravity: 0.16,
                nodes: 64,
                ..straight
            },
            Kind::Fur => Self {
                length: 3.0,
                gravity: 0.05,
                lift: 1.0,
                clump: 0.3,
                frizz: 0.08,
                nodes: 8,
                ..straight
            },
            Kind::Patch => Self {
                length: 18.0,
                frizz: 0.03,
                nodes: 12,
                ..straight
            },
            Kind::Single => Self {
                length: 10.0,
                radius: 0.1,
                taper: 0.0,
                frizz: 0.0,
                nodes: 2,
                ..straight
            },
        }
    }

    /// Returns the radius at which this many strands cover as much as 100,000 hairs 80 um thick.
    #[must_use]
    pub fn covering_radius(strands: usize) -> f32 {
        0.004 * (100_000.0 / strands.max(1) as f32).sqrt()
    }

    /// Returns the radius at a part `s` of a strand, from root to tip, with the taper that grooms have.
    pub(crate) fn tapered(radius: f32, s: f32) -> f32 {
        radius * (1.0 - TAPER * s * s * s)
    }

    /// Grows the hair strand by strand, in parallel, and flattens it to segments.
    ///
    /// # Errors
    ///
    /// Returns an error if a setting is out of its range.
    pub fn grow(&self, flattening: &Flattening) -> Result<Strands, GeometryError> {
        self.check()?;
        let polylines: Vec<_> = (0..self.strands)
            .into_par_iter()
            .map(self.polylines(flattening))
            .collect();
        let mut builder = Strands::builder();
        for polyline in polylines {
            builder.push(polyline)?;
        }
        Ok(builder.finish())
    }

    /// Estimates how many segments the hair will have from some of its strands, without growing the rest.
    ///
    /// # Errors
    ///
    /// Returns an error if a setting is out of its range.
    pub fn estimate_segments(&self, flattening: &Flattening) -> Result<u64, GeometryError> {
        self.check()?;
        let strands = self.strands.min(256);
        let nodes: usize = (0..strands)
            .map(self.polylines(flattening))
            .map(|polyline| polyline.len())
            .sum();
        Ok(nodes as u64 * self.strands as u64 / strands as u64)
    }

    /// Returns a function that grows a strand and flattens it to nodes, each with its radius.
    fn polylines<'a>(
        &'a self,
        flattening: &'a Flattening,
    ) -> impl Fn(usize) -> Vec<(Vec3, f32)> + Send + Sync + 'a {
        // Doubled ends shorten the curve by a sixth of the distance of two nodes at either end.
        let grow: Box<dyn Fn(usize) -> Vec<Vec3> + Send + Sync + 'a> = match self.kind {
            Kind::Straight | Kind::Wavy | Kind::Curly | Kind::Fur => {
                let head = head::HeadGroom::new(*self);
                Box::new(move |strand| head.strand(strand))
            }
            Kind::Patch => Box::new(move |strand| sheet::strand(self, strand)),
            Kind::Single => Box::new(move |_| {
                [Vec3::NEG_X, Vec3::X]
                    .map(|end| 0.75 * self.length * end)
                    .to_vec()
            }),
        };
        let radius = move |s: f32| self.radius * (1.0 - self.taper * s * s * s);
        move |strand: usize| {
            let nodes = grow(strand);
            let mut polyline = Vec::with_capacity(4 * nodes.len());
            if let Some(spline) = Spline::new(&nodes, Basis::BSpline) {
                flattening.append(&spline, radius, &mut polyline);
            }
            polyline
        }
    }

    fn check(&self) -> Result<(), GeometryError> {
        GeometryError::check_counts([
            ("strands", self.strands, 1, 1 << 24),
            ("nodes", self.nodes, 2, 1024),
            ("clumps", self.clumps, 1, 1 << 24),
        ])?;
        GeometryError::check_settings([
            ("length", self.length, 1e-3, 1e4),
            ("length_spread", self.length_spread, 0.0, 0.4),
            ("radius", self.radius, 1e-6, 1e3),
            ("taper", self.taper, 0.0, 1.0),
            ("clump", self.clump, 0.0, 1.0),
            ("curl_radius", self.curl_radius, 0.0, 1e3),
            ("curl_length", self.curl_length, 1e-3, 1e4),
            ("frizz", self.frizz, 0.0, 1e3),
            ("gravity", self.gravity, 0.0, 1e2),
            ("lift", self.lift, 0.0, 1.0),
        ])
    }
}
