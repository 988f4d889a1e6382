//! Cubic splines, and the polylines to which they are flattened.

use glam::Vec3;

/// Rule by which nodes make a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Uniform cubic B-spline with doubled ends: smooth to the second derivative, near its nodes.
    BSpline,
    /// Uniform cubic B-spline with ends pinned to the first and the last node, as USD's curves of this name
    /// have it.
    PinnedBSpline,
    /// Centripetal Catmull-Rom spline: through its nodes, with a continuous direction.
    ///
    /// The parameters of two nodes differ by the square root of their distance. No other power keeps spans
    /// free of cusps and loops (Yuksel et al. 2011). With even spans, the spline is the uniform one.
    CatmullRom,
}

/// Curve of at least two nodes, over `[0, spans]`.
#[derive(Clone, Copy, Debug)]
pub struct Spline<'a> {
    nodes: &'a [Vec3],
    basis: Basis,
}

impl<'a> Spline<'a> {
    /// Creates a curve, or returns `None` for fewer than two nodes.
    #[must_use]
    pub fn new(nodes: &'a [Vec3], basis: Basis) -> Option<Self> {
        (nodes.len() >= 2).then_some(Self { nodes, basis })
    }

    /// Returns the number of spans between nodes.
    #[must_use]
    pub fn spans(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Returns the point and the derivative at `x` in `[0, 1]` of a span.
    ///
    /// # Panics
    ///
    /// Panics if `span` is not below [`spans`](Self::spans).
    #[must_use]
    pub fn at(&self, span: usize, x: f32) -> (Vec3, Vec3) {
        let last = self.nodes.len() - 1;
        let [mut a, b, c, mut d] =
            [span.saturating_sub(1), span, span + 1, (span + 2).min(last)].map(|k| self.nodes[k]);
        let y = 1.0 - x;
        if self.basis == Basis::CatmullRom {
            let (from, to) = (slope(a, b, c), -slope(d, c, b));
            let (chord, shift) = (c - b, x * x * (3.0 - 2.0 * x));
            let point = b + chord * shift + from * (x * y * y) - to * (x * x * y);
            let along = chord * (6.0 * x * y) + from * (y * (1.0 - 3.0 * x));
            return (point, along - to * (x * (2.0 - 3.0 * x)));
        }
        if self.basis == Basis::PinnedBSpline {
            a = if span == 0 { 2.0 * b - c } else { a };
            d = if span + 1 == last { 2.0 * c - b } else { d };
        }
        let inner = |x: f32| (3.0 * x - 6.0) * x * x + 4.0;
        let point = (a * (y * y * y) + b * inner(x) + c * inner(y) + d * (x * x * x)) / 6.0;
        let slope = |x: f32| (1.5 * x - 2.0) * x;
        let along = d * (0.5 * x * x) - a * (0.5 * y * y) + b * slope(x) - c * slope(y);
        (point, along)
    }
}

/// Returns the derivative of the centripetal spline at `node`, per span to `after`. At an end, where
/// `before` is the node itself, the derivative is half of the way to the neighbour.
fn slope(before: Vec3, node: Vec3, after: Vec3) -> Vec3 {
    let (back, ahead) = (node - before, after - node);
    let [p, q] = [back, ahead].map(|chord| chord.length().sqrt());
    if p == 0.0 || q == 0.0 {
        return 0.5 * ahead;
    }
    // Use the quotient of p and q alone, because the square of a small distance may underflow.
    let ratio = q / p;
    (ratio * ratio * back + ahead) / (1.0 + ratio)
}

/// Tolerances with which curves are flattened to segments.
///
/// A finer flattening than the default costs more than it shows, because the shading tangent is interpolated and hides the corners. At
/// a quarter of a radius, a wavy strand has 3.4 times the segments, and rays take 1.4 times as long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flattening {
    /// Largest distance of the curve from the segment, in radii at the root.
    pub radii: f32,
    /// Largest distance of the curve from the segment, in centimetres. The smaller of both bounds holds.
    pub centimetres: f32,
    /// Largest turn of the curve along a segment, in rad.
    pub turn: f32,
    /// Largest number of halvings of a span between two nodes, because nodes that coincide may turn by any angle.
    pub halvings: i32,
}

impl Default for Flattening {
    fn default() -> Self {
        Self {
            radii: 3.0,
            centimetres: 0.02,
            turn: 15_f32.to_radians(),
            halvings: 8,
        }
    }
}

impl Flattening {
    /// Limits the number of halvings.
    pub(crate) fn at_most(self, halvings: i32) -> Self {
        Self {
            halvings: self.halvings.min(halvings),
            ..self
        }
    }

    /// Appends the curve as nodes of a polyline. `radius` returns the radius at a part of the curve, from 0 at the root to 1.
    pub fn append(
        &self,
        spline: &Spline,
        radius: impl Fn(f32) -> f32,
        nodes: &mut Vec<(Vec3, f32)>,
    ) {
        let tolerance = (self.radii * radius(0.0)).min(self.centimetres);
        let shortest = 0.5_f32.powi(self.halvings);
        let part = |span: usize, x: f32| (span as f32 + x) / spline.spans() as f32;
        nodes.push((spline.at(0, 0.0).0, radius(0.0)));
        for span in 0..spline.spans() {
            let mut stack = vec![(0.0_f32, 1.0_f32)];
            while let Some((from, to)) = stack.pop() {
                let middle = 0.5 * (from + to);
                if to - from <= shortest
                    || self.is_flat([from, middle, to].map(|x| spline.at(span, x)), tolerance)
                {
                    nodes.push((spline.at(span, to).0, radius(part(span, to))));
                } else {
                    stack.extend([(middle, to), (from, middle)]);
                }
            }
        }
    }

    /// Returns true if one segment can replace a piece, given by points and derivatives at its ends and its middle.
    fn is_flat(&self, [from, middle, to]: [(Vec3, Vec3); 3], tolerance: f32) -> bool {
        let chord = to.0 - from.0;
        let to_middle = middle.0 - from.0;
        let along = to_middle.dot(chord) / chord.length_squared().max(1e-20);
        let off = to_middle.distance(along.clamp(0.0, 1.0) * chord);
        let turn = |a: Vec3, b: Vec3| libm::atan2f(a.cross(b).length(), a.dot(b));
        off <= tolerance && turn(from.1, middle.1) + turn(middle.1, to.1) <= self.turn
    }
}
