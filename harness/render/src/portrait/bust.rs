//! Head, neck and shoulders as one implicit surface, a smooth union of simple bodies, and its mesh.

use crate::geometry::Mesh;
use glam::Vec3;
use rayon::prelude::*;

/// Box of the mesh in centimetres. The shoulders go on below it, and pictures must not show its lower end.
const LO: Vec3 = Vec3::new(-17.0, -36.0, -15.0);
const HI: Vec3 = Vec3::new(17.0, 11.0, 12.5);

/// Body on the right half of the head, in centimetres. The left half is its mirror image.
#[derive(Clone, Copy, Debug)]
enum Body {
    /// Centre and half axes.
    Ellipsoid(Vec3, Vec3),
    /// Round cone: its ends, and the radius at each.
    Cone([Vec3; 2], [f32; 2]),
}

/// Step of the construction: a body, and the width in centimetres over which it blends with the bodies before it.
#[derive(Clone, Copy, Debug)]
enum Step {
    Add(Body, f32),
    Carve(Body, f32),
}

const fn ellipsoid(centre: [f32; 3], radii: [f32; 3]) -> Body {
    Body::Ellipsoid(Vec3::from_array(centre), Vec3::from_array(radii))
}

const fn cone(from: [f32; 3], to: [f32; 3], radii: [f32; 2]) -> Body {
    Body::Cone([Vec3::from_array(from), Vec3::from_array(to)], radii)
}

/// Centre of the cranium, from which directions to the scalp are measured.
pub(super) const CRANIUM: Vec3 = Vec3::new(0.0, 1.0, -1.2);

/// Head without ears, after the measures of an adult: 15 cm wide and 19 cm deep.
const HEAD: [Step; 16] = [
    Step::Add(Body::Ellipsoid(CRANIUM, Vec3::new(7.5, 8.4, 9.4)), 0.0),
    // Face, cheekbone, jaw, chin.
    Step::Add(ellipsoid([0.0, -4.8, 2.6], [6.0, 7.6, 5.9]), 2.5),
    Step::Add(ellipsoid([4.2, -3.2, 5.2], [1.9, 1.3, 2.0]), 1.6),
    Step::Add(cone([5.2, -6.6, -0.8], [1.2, -11.3, 5.8], [1.5, 1.3]), 2.0),
    Step::Add(ellipsoid([0.0, -11.3, 6.2], [1.9, 1.5, 1.7]), 1.4),
    // Brow, socket, closed eye, nose, lips.
    Step::Add(cone([0.8, 0.5, 7.6], [4.3, 0.6, 6.0], [0.9, 0.7]), 1.4),
    Step::Carve(ellipsoid([3.1, -1.2, 9.0], [2.0, 1.2, 1.9]), 1.0),
    Step::Add(ellipsoid([3.0, -1.3, 6.5], [1.35, 1.1, 1.2]), 0.5),
    Step::Add(cone([0.0, -1.0, 8.0], [0.0, -4.4, 9.6], [0.7, 0.95]), 1.0),
    Step::Add(ellipsoid([1.0, -4.8, 8.8], [0.7, 0.6, 0.8]), 0.6),
    Step::Add(ellipsoid([0.0, -7.3, 8.0], [2.2, 0.5, 0.8]), 0.6),
    Step::Add(ellipsoid([0.0, -8.3, 7.8], [1.9, 0.6, 0.8]), 0.5),
    // Neck, trapezius, shoulder, chest and back.
    Step::Add(cone([0.0, -6.0, -2.6], [0.0, -20.0, -3.8], [5.2, 5.6]), 2.0),
    Step::Add(
        cone([1.5, -14.0, -5.0], [9.0, -21.0, -4.5], [2.6, 3.0]),
        4.0,
    ),
    Step::Add(
        cone([5.0, -23.5, -4.0], [11.0, -25.0, -4.0], [3.8, 4.6]),
        3.0,
    ),
    Step::Add(ellipsoid([0.0, -39.0, -3.0], [13.0, 17.5, 8.8]), 4.0),
];

/// Ear: plate, rim from the lobe to the front, and the hollow.
const EAR: [Step; 7] = [
    Step::Add(ellipsoid([7.5, -1.7, -1.4], [0.6, 2.4, 1.5]), 0.5),
    Step::Add(cone([7.3, -4.4, -0.4], [7.9, -2.8, -2.4], [0.6, 0.4]), 0.3),
    Step::Add(cone([7.9, -2.8, -2.4], [8.5, -0.5, -3.0], [0.4, 0.4]), 0.2),
    Step::Add(cone([8.5, -0.5, -3.0], [8.3, 0.9, -1.8], [0.4, 0.4]), 0.2),
    Step::Add(cone([8.3, 0.9, -1.8], [7.6, 0.5, -0.1], [0.4, 0.35]), 0.2),
    Step::Add(cone([7.6, 0.5, -0.1], [7.5, -1.2, -0.5], [0.35, 0.3]), 0.2),
    Step::Carve(ellipsoid([8.3, -1.6, -1.2], [0.6, 1.1, 0.7]), 0.3),
];

impl Body {
    /// Returns the distance from the body, which for ellipsoids is exact on the surface alone.
    fn distance(&self, point: Vec3) -> f32 {
        match *self {
            Self::Ellipsoid(centre, radii) => {
                let scaled = (point - centre) / radii;
                let depth = scaled.length();
                // At the centre the quotient below has no limit.
                let slope = (scaled / radii).length().max(1e-6);
                if depth < 1e-3 {
                    -radii.min_element()
                } else {
                    depth * (depth - 1.0) / slope
                }
            }
            Self::Cone([from, to], radii) => {
                let along = to - from;
                let part = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                point.distance(from + part * along) - (radii[0] + part * (radii[1] - radii[0]))
            }
        }
    }
}

/// Returns the smaller of two distances, blended over a width where they are equal.
fn smooth_min(a: f32, b: f32, width: f32) -> f32 {
    if width <= 0.0 {
        return a.min(b);
    }
    let overlap = (1.0 - (a - b).abs() / width).max(0.0);
    a.min(b) - 0.25 * width * overlap * overlap
}

fn build(steps: &[Step], point: Vec3, start: f32) -> f32 {
    let mirrored = Vec3::new(point.x.abs(), point.y, point.z);
    steps.iter().fold(start, |distance, step| match step {
        Step::Add(body, width) => smooth_min(distance, body.distance(mirrored), *width),
        Step::Carve(body, width) => -smooth_min(-distance, body.distance(mirrored), *width),
    })
}

/// Returns the approximate distance from the head without its ears, negative inside.
pub(super) fn without_ears(point: Vec3) -> f32 {
    build(&HEAD, point, f32::INFINITY)
}

/// Returns the approximate distance from the body over which hair falls, which has bumps in place of ears.
pub(super) fn under_hair(point: Vec3) -> f32 {
    let bump = Step::Add(ellipsoid([7.4, -1.8, -1.5], [1.3, 3.4, 2.6]), 2.5);
    build(&[bump], point, without_ears(point))
}

/// Returns the approximate distance from head, neck and shoulders in centimetres, negative inside.
///
/// - Accuracy: exact to first order near the surface of a single body. Where bodies blend, the surface bulges.
#[must_use]
pub fn distance(point: Vec3) -> f32 {
    build(&EAR, point, without_ears(point))
}

/// Returns the unit normal of the surface on which `distance` has the value that it has at a point.
pub(super) fn normal(distance: impl Fn(Vec3) -> f32, point: Vec3) -> Vec3 {
    const STEP: f32 = 0.01;
    // Corners of a tetrahedron: four values give all three derivatives.
    let corners = [
        Vec3::new(1.0, -1.0, -1.0),
        Vec3::new(-1.0, -1.0, 1.0),
        Vec3::new(-1.0, 1.0, -1.0),
        Vec3::ONE,
    ];
    corners
        .into_iter()
        .map(|corner| corner * distance(point + STEP * corner))
        .sum::<Vec3>()
        .normalize_or(Vec3::Y)
}

/// Returns the mesh of the surface with a normal per corner, by surface nets over cells of a width in centimetres.
///
/// # Errors
///
/// Returns a line of text if the cells are too wide for the surface to show.
pub fn mesh(cell: f32) -> Result<Mesh, String> {
    let grid = Grid::new(cell);
    // A vertex for each cell that the surface passes: the mean of the places where it meets the edges.
    let mut places = Vec::new();
    let mut vertices = vec![u32::MAX; grid.values.len()];
    for at in grid.cells() {
        let mut sum = Vec3::ZERO;
        let mut met = 0;
        for axis in 0..3 {
            let [along, a, b] = [0, 1, 2].map(|k| (axis + k) % 3);
            for from in [at, next(at, a), next(at, b), next(next(at, a), b)] {
                let [low, high] = [from, next(from, along)].map(|corner| grid.value(corner));
                if (low < 0.0) != (high < 0.0) {
                    sum += grid.place(from) + cell * low / (low - high) * Vec3::AXES[along];
                    met += 1;
                }
            }
        }
        if met > 0 {
            #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^31 cells")]
            let vertex = places.len() as u32;
            vertices[grid.index(at)] = vertex;
            places.push(sum / met as f32);
        }
    }

    // Two triangles for each edge of the grid that the surface crosses, between the vertices of the four cells around the edge.
    let mut triangles = Vec::new();
    for at in grid.cells() {
        for axis in 0..3 {
            let [along, a, b] = [0, 1, 2].map(|k| (axis + k) % 3);
            let [low, high] = [at, next(at, along)].map(|corner| grid.value(corner));
            if (low < 0.0) == (high < 0.0) || at[a] == 0 || at[b] == 0 {
                continue;
            }
            let [beside, below] = [before(at, a), before(at, b)];
            let [p, q, r, s] =
                [at, beside, before(beside, b), below].map(|cell| vertices[grid.index(cell)]);
            triangles.extend(if low < 0.0 {
                [[p, q, r], [p, r, s]]
            } else {
                [[p, r, q], [p, s, r]]
            });
        }
    }
    let normals = places
        .par_iter()
        .map(|place| normal(distance, *place))
        .collect();
    Mesh::new(places, triangles)?.with_normals(normals)
}

/// Distances from the surface at the corners of cubic cells.
struct Grid {
    cell: f32,
    /// Number of corners along each axis.
    counts: [usize; 3],
    values: Vec<f32>,
}

impl Grid {
    fn new(cell: f32) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small count; the cast saturates"
        )]
        let counts = ((HI - LO) / cell)
            .to_array()
            .map(|cells| cells.ceil() as usize + 1);
        let mut grid = Self {
            cell,
            counts,
            values: Vec::new(),
        };
        let [x, y, z] = counts;
        grid.values = (0..x * y * z)
            .into_par_iter()
            .map(|index| distance(grid.place([index % x, index / x % y, index / (x * y)])))
            .collect();
        grid
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    fn value(&self, corner: [usize; 3]) -> f32 {
        self.values[self.index(corner)]
    }

    fn place(&self, corner: [usize; 3]) -> Vec3 {
        LO + self.cell * Vec3::from_array(corner.map(|k| k as f32))
    }

    /// Iterates over the cells by their lowest corners.
    fn cells(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [x, y, z] = self.counts.map(|count| count - 1);
        (0..x * y * z).map(move |index| [index % x, index / x % y, index / (x * y)])
    }
}

/// Returns the next corner along an axis.
fn next(mut corner: [usize; 3], axis: usize) -> [usize; 3] {
    corner[axis] += 1;
    corner
}

/// Returns the corner before a corner along an axis.
fn before(mut corner: [usize; 3], axis: usize) -> [usize; 3] {
    corner[axis] -= 1;
    corner
}
