//! Cubic splines, and the polylines to which they are flattened.

use glam::Vec3;

/// Rule by which nodes make a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Basis {
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
pub(crate) struct Spline<'a> {
    nodes: &'a [Vec3],
    basis: Basis,
}

impl<'a> Spline<'a> {
    /// Creates a curve, or returns `None` for fewer than two nodes.
    pub(crate) fn new(nodes: &'a [Vec3], basis: Basis) -> Option<Self> {
        (nodes.len() >= 2).then_some(Self { nodes, basis })
    }

    /// Returns the number of spans between nodes.
    pub(crate) fn spans(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Returns the point and the derivative at `x` in `[0, 1]` of a span.
    fn at(&self, span: usize, x: f32) -> (Vec3, Vec3) {
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
    pub(crate) fn append(
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

#[cfg(test)]
mod tests {
    use super::*;
    use hairis_instruments::sequence::{Independent, XiSource as _};

    fn helix() -> Vec<Vec3> {
        (0..20)
            .map(|k| 0.6 * k as f32)
            .map(|a| Vec3::new(0.2 * a, libm::cosf(a), libm::sinf(a)))
            .collect()
    }

    #[test]
    fn derivatives_are_those_of_points() {
        let nodes = helix();
        for basis in [Basis::BSpline, Basis::PinnedBSpline, Basis::CatmullRom] {
            let spline = Spline::new(&nodes, basis).expect("twenty nodes");
            for (span, x) in [(0, 0.3), (7, 0.0), (7, 0.5), (18, 0.9)] {
                let step = 0.01;
                let numeric =
                    (spline.at(span, x + step).0 - spline.at(span, x - step).0) / (2.0 * step);
                let (_, exact) = spline.at(span, x);
                assert!(
                    numeric.distance(exact) < 2e-4,
                    "{basis:?} at {span} + {x}: {numeric} and {exact}"
                );
            }
            let (ends, starts) = (spline.at(6, 1.0), spline.at(7, 0.0));
            assert!(
                ends.0.distance(starts.0) < 1e-5 && ends.1.distance(starts.1) < 1e-5,
                "{basis:?} has a gap"
            );
        }
    }

    #[test]
    fn catmull_rom_passes_through_its_nodes() {
        let nodes = helix();
        let spline = Spline::new(&nodes, Basis::CatmullRom).expect("twenty nodes");
        for span in 0..19 {
            for (x, node) in [(0.0, nodes[span]), (1.0, nodes[span + 1])] {
                let point = spline.at(span, x).0;
                assert!(
                    point.distance(node) < 1e-6,
                    "span {span}: {point} for {node}"
                );
            }
        }
    }

    #[test]
    fn straight_strands_stay_straight_whatever_their_spans() {
        let mut random = Independent::new(3, 0);
        let mut strands = vec![vec![0.0, 4.0, 4.01, 8.0, 8.02, 8.03, 12.0]];
        strands.extend((0..200).map(|_| {
            let steps = (0..12).map(|_| libm::powf(10.0, -5.0 * random.next_xi_f32::<1>()[0]));
            steps
                .scan(0.0, |y, step| {
                    *y += step;
                    Some(*y)
                })
                .collect()
        }));
        for strand in strands {
            let nodes: Vec<Vec3> = strand.iter().map(|y| Vec3::new(1.0, *y, 0.0)).collect();
            for basis in [Basis::PinnedBSpline, Basis::CatmullRom] {
                let spline = Spline::new(&nodes, basis).expect("nodes");
                let (mut last, end) = (strand[0], strand[strand.len() - 1]);
                for (span, x) in (0..spline.spans()).flat_map(|k| (0..=32).map(move |i| (k, i))) {
                    let (point, along) = spline.at(span, x as f32 / 32.0);
                    assert!(
                        point.y >= last - 1e-6 * end && along.y > 0.0 && along.x == 0.0,
                        "{basis:?} of {strand:?}: {point} after {last} along {along}"
                    );
                    last = point.y;
                }
                assert!((last - end).abs() <= 1e-6 * end, "{basis:?}: {last}");
            }
        }
    }

    #[test]
    fn uneven_spans_turn_no_further_than_their_corners() {
        // A right angle between spans of very different length: no loop, so the direction stays
        // between those of the legs.
        for short in [1e-4, 0.01, 0.3, 1.0] {
            let nodes = [-1.0, -0.5, 0.0].map(|x| Vec3::new(x, 0.0, 0.0));
            let leg = [1.0, 2.0, 40.0].map(|k| Vec3::new(0.0, k * short, 0.0));
            let nodes: Vec<Vec3> = nodes.into_iter().chain(leg).collect();
            let spline = Spline::new(&nodes, Basis::CatmullRom).expect("six nodes");
            let back = Vec3::new(-1.0, -1.0, 0.0);
            for (span, x) in (0..5).flat_map(|k| (0..=64).map(move |i| (k, i))) {
                let along = spline.at(span, x as f32 / 64.0).1.normalize();
                assert!(
                    along.dot(back) < 0.35,
                    "{short}: {along} at {span} + {x}/64"
                );
            }
        }
    }

    #[test]
    fn segments_keep_to_tolerance_and_turn() {
        let nodes = helix();
        let spline = Spline::new(&nodes, Basis::BSpline).expect("twenty nodes");
        for (flattening, worst) in [
            (
                Flattening {
                    radii: 1.0,
                    centimetres: 1.0,
                    turn: 9.0,
                    halvings: 8,
                },
                0.01,
            ),
            (
                Flattening {
                    radii: 1.0,
                    centimetres: 0.001,
                    turn: 9.0,
                    halvings: 8,
                },
                0.001,
            ),
            (
                Flattening {
                    radii: 99.0,
                    centimetres: 1.0,
                    turn: 0.1,
                    halvings: 8,
                },
                0.1,
            ),
        ] {
            let mut polyline = Vec::new();
            flattening.append(&spline, |_| 0.01, &mut polyline);
            let segments: Vec<Vec3> = polyline
                .windows(2)
                .map(|ends| ends[1].0 - ends[0].0)
                .collect();
            let turn = segments
                .windows(2)
                .map(|pair| pair[0].angle_between(pair[1]))
                .fold(0.0, f32::max);
            assert!(
                turn <= flattening.turn + 1e-3,
                "{flattening:?}: turns by {turn}"
            );
            let off = (0..19 * 64)
                .map(|i| spline.at(i / 64, (i % 64) as f32 / 64.0).0)
                .map(|point| {
                    let nearest = |ends: &[(Vec3, f32)]| {
                        let edge = ends[1].0 - ends[0].0;
                        let s =
                            ((point - ends[0].0).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
                        point.distance(ends[0].0 + s * edge)
                    };
                    polyline
                        .windows(2)
                        .map(nearest)
                        .fold(f32::INFINITY, f32::min)
                });
            let off = off.fold(0.0, f32::max);
            assert!(
                off <= 1.1 * worst && off > 0.05 * worst.min(0.01),
                "{flattening:?}: off by {off}"
            );
        }
    }
}
