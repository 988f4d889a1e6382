//! Measures of a hairstyle.

use crate::geometry::GeometryError;

/// Hairstyle on the head of a portrait. Strand `i` depends on these measures and on `i` alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Name of the style in messages.
    pub name: &'static str,
    /// Length from root to tip along the middle of waves and curls, in centimetres, in `[2, 60]`.
    pub length: f32,
    /// Standard deviation of the length relative to the length, in `[0, 0.3]`; cut at two deviations.
    pub length_spread: f32,
    /// Height, in centimetres above the ears, below which strands are cut, in `[-60, 20]`.
    pub hem: f32,
    /// Radius at the root in centimetres, in `[0.001, 0.05]`.
    pub radius: f32,
    /// Standard deviation of the radius from strand to strand, relative to the radius, in `[0, 0.3]`; cut at two deviations.
    pub radius_spread: f32,
    /// Share of the radius that is lost at the tip, in `[0, 0.95]`.
    pub taper: f32,
    /// Uprightness of strands at the root, in `[0, 1]`: 1 along the normal of the scalp, 0 combed along its surface.
    pub lift: f32,
    /// Rate at which strands bend down, per centimetre, in `[0, 2]`.
    pub gravity: f32,
    /// Depth of the layer of hair on the head, in centimetres, in `[0.1, 6]`.
    pub volume: f32,
    /// Azimuth of the front end of the parting in degrees, to the left of the face if positive, in `[-60, 60]`.
    pub parting: f32,
    /// Number of locks, which are clumps of clumps, in `[1, 10000]`.
    pub locks: usize,
    /// Number of clumps, in `[1, 100000]`.
    pub clumps: usize,
    /// Degree to which clumps are drawn to the guide of their lock at the tip, in `[0, 1]`.
    pub lock: f32,
    /// Degree to which strands are drawn to the guide of their clump at the tip, in `[0, 1]`.
    pub clump: f32,
    /// Radius of waves and curls in centimetres, in `[0, 3]`.
    pub curl_radius: f32,
    /// Length of a wave or of a turn of a curl in centimetres, in `[1, 30]`.
    pub curl_length: f32,
    /// Depth of a wave relative to its width, in `[0, 1]`: 0 waves in a plane, 1 winds curls.
    pub roundness: f32,
    /// Degree to which neighbouring clumps wave in step, in `[0, 1]`.
    pub coherence: f32,
    /// Standard deviation of the bends of single strands at the tip, in centimetres, in `[0, 2]`.
    pub frizz: f32,
    /// Share of strands that leave their clump, in `[0, 0.5]`.
    pub flyaways: f32,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Style {
    /// Long hair in loose waves.
    pub const WAVY: Self = Self {
        name: "wavy",
        length: 40.0,
        length_spread: 0.1,
        hem: -20.0,
        radius: 0.0042,
        radius_spread: 0.12,
        taper: 0.6,
        lift: 0.2,
        gravity: 0.3,
        volume: 1.8,
        parting: 25.0,
        locks: 220,
        clumps: 1000,
        lock: 0.5,
        clump: 0.85,
        curl_radius: 1.2,
        curl_length: 12.0,
        roundness: 0.4,
        coherence: 0.95,
        frizz: 0.06,
        flyaways: 0.02,
        seed: 1,
    };
    /// Hair in ringlets down to the shoulders.
    pub const CURLY: Self = Self {
        name: "curly",
        length: 24.0,
        length_spread: 0.15,
        hem: -60.0,
        radius: 0.0042,
        radius_spread: 0.12,
        taper: 0.6,
        lift: 0.4,
        gravity: 0.3,
        volume: 2.4,
        parting: 15.0,
        locks: 260,
        clumps: 480,
        lock: 0.1,
        clump: 0.97,
        curl_radius: 0.8,
        curl_length: 3.2,
        roundness: 1.0,
        coherence: 0.0,
        frizz: 0.06,
        flyaways: 0.04,
        seed: 2,
    };
    /// Long straight hair with a blunt hem.
    pub const STRAIGHT: Self = Self {
        name: "straight",
        length: 46.0,
        length_spread: 0.08,
        hem: -19.0,
        radius: 0.0045,
        radius_spread: 0.1,
        taper: 0.5,
        lift: 0.1,
        gravity: 0.4,
        volume: 1.2,
        parting: 0.0,
        locks: 160,
        clumps: 1800,
        lock: 0.25,
        clump: 0.45,
        curl_radius: 0.12,
        curl_length: 16.0,
        roundness: 0.5,
        coherence: 0.8,
        frizz: 0.06,
        flyaways: 0.015,
        seed: 3,
    };

    /// Checks that all measures lie within their ranges.
    ///
    /// # Errors
    ///
    /// Returns an error that names the first measure that does not, with its value and its range.
    pub fn check(&self) -> Result<(), GeometryError> {
        GeometryError::check_counts([
            ("locks", self.locks, 1, 10_000),
            ("clumps", self.clumps, 1, 100_000),
        ])?;
        GeometryError::check_settings([
            ("length", self.length, 2.0, 60.0),
            ("length_spread", self.length_spread, 0.0, 0.3),
            ("hem", self.hem, -60.0, 20.0),
            ("radius", self.radius, 0.001, 0.05),
            ("radius_spread", self.radius_spread, 0.0, 0.3),
            ("taper", self.taper, 0.0, 0.95),
            ("lift", self.lift, 0.0, 1.0),
            ("gravity", self.gravity, 0.0, 2.0),
            ("volume", self.volume, 0.1, 6.0),
            ("parting", self.parting, -60.0, 60.0),
            ("lock", self.lock, 0.0, 1.0),
            ("clump", self.clump, 0.0, 1.0),
            ("curl_radius", self.curl_radius, 0.0, 3.0),
            ("curl_length", self.curl_length, 1.0, 30.0),
            ("roundness", self.roundness, 0.0, 1.0),
            ("coherence", self.coherence, 0.0, 1.0),
            ("frizz", self.frizz, 0.0, 2.0),
            ("flyaways", self.flyaways, 0.0, 0.5),
        ])
    }

    /// Returns the distance of nodes along a strand in centimetres: a sixteenth of a turn of a curl, or less often in waves, whose
    /// bends are wider.
    pub(super) fn step(&self) -> f32 {
        (self.curl_length / (8.0 + 8.0 * self.roundness)).clamp(0.1, 0.8)
    }
}
