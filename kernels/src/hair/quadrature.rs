//! Quadrature rules on `[0, 1]`.

/// Nodes and weights on `[0, 1]` of the 32-point Gauss-Legendre rule, exact for polynomials up to degree 63.
pub const GAUSS_LEGENDRE_32: [(f32, f32); 32] = [
    (0.00136806907526, 0.00350930500474),
    (0.00719424422737, 0.00813719736545),
    (0.0176188722062, 0.0126960326546),
    (0.0325469620311, 0.0171369314565),
    (0.051839422117, 0.0214179490111),
    (0.0753161931337, 0.0254990296312),
    (0.102758102016, 0.0293420467393),
    (0.13390894063, 0.0329111113882),
    (0.168477866535, 0.0361728970544),
    (0.20614212138, 0.0390969478935),
    (0.246550045534, 0.0416559621135),
    (0.289324361935, 0.0438260465022),
    (0.334065698859, 0.0455869393479),
    (0.380356318874, 0.0469221995404),
    (0.427764019209, 0.0478193600396),
    (0.475846167156, 0.0482700442574),
    (0.524153832844, 0.0482700442574),
    (0.572235980791, 0.0478193600396),
    (0.619643681126, 0.0469221995404),
    (0.665934301141, 0.0455869393479),
    (0.710675638065, 0.0438260465022),
    (0.753449954466, 0.0416559621135),
    (0.79385787862, 0.0390969478935),
    (0.831522133465, 0.0361728970544),
    (0.86609105937, 0.0329111113882),
    (0.897241897984, 0.0293420467393),
    (0.924683806866, 0.0254990296312),
    (0.948160577883, 0.0214179490111),
    (0.967453037969, 0.0171369314565),
    (0.982381127794, 0.0126960326546),
    (0.992805755773, 0.00813719736545),
    (0.998631930925, 0.00350930500474),
];

/// Rule whose nodes crowd towards both ends, as `v^5 / (v^5 + (1 - v)^5)` does for even `v`. Each entry holds the node, 1 less the
/// node, and its weight.
///
/// For integrands that change on any scale next to an end: the nodes next to an end are 2e-11 away from it.
pub(crate) const GRADED: [[f32; 3]; 72] = graded();

/// Rule with two thirds of the nodes of [`GRADED`], which has a digit less.
pub(crate) const COARSE: [[f32; 3]; 48] = graded();

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "rounding to a float is the purpose"
)]
const fn graded<const NODES: usize>() -> [[f32; 3]; NODES] {
    let mut nodes = [[0.0; 3]; NODES];
    let mut k = 0;
    while k < NODES {
        let v = (k as f64 + 0.5) / NODES as f64;
        let rest = 1.0 - v;
        let (up, down) = (v * v * v * v * v, rest * rest * rest * rest * rest);
        let sum = up + down;
        let both = v * rest;
        let slope = 5.0 * (both * both * both * both) / (sum * sum);
        nodes[k] = [
            (up / sum) as f32,
            (down / sum) as f32,
            (slope / NODES as f64) as f32,
        ];
        k += 1;
    }
    nodes
}
