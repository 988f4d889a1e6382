//! Figures drawn from the kernels alone: the paper's figures 4 and 5, and the scattering function around the fibre.

mod looks;

pub use looks::{polar, scatter};

use core::f64::consts::{PI, SQRT_2};
use glam::Vec3;
use hairis::{Gaussian, HairParams, Lobe, LobeMask, Material, Published};
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::plot::{Axis, ScatterPanel, Series, SphereGrid, lines, scatter_maps};
use hairis_instruments::report::Drawing;
use hairis_variants::{AnyBsdf, AnyMaterial};

/// Widths of the bells shown, in degrees.
const WIDTHS: [f64; 3] = [5.0, 10.0, 20.0];

/// Name of a bell, its value at a distance from the centre in units of the width, and its area between plus and minus as many widths.
type Bell = (&'static str, fn(f64) -> f64, fn(f64) -> f64);

/// Bells of the two models.
pub const BELLS: [Bell; 2] = [
    (
        "Gaussian",
        |x| (-0.5 * x * x).exp(),
        |x| (2.0 * PI).sqrt() * libm::erf(x / SQRT_2),
    ),
    ("Cauchy", |x| 1.0 / (x * x + 1.0), |x| 2.0 * x.atan()),
];

/// Draws the bells, each divided by the result of `scale` for the bell and its width.
fn bells_over(title: &str, y: &str, scale: fn(&Bell, f64) -> f64) -> String {
    let x = Axis::linear("distance from the centre (°)")
        .range(-90.0, 90.0)
        .step(15.0);
    let mut series = Vec::new();
    for (dash, bell) in BELLS.iter().enumerate() {
        for (color, width) in WIDTHS.into_iter().enumerate() {
            let points = (-360..=360)
                .map(|i| f64::from(i) / 4.0)
                .map(|x| (x, bell.1(x / width) / scale(bell, width)));
            series.push(Series::curve(format!("{} {width}°", bell.0), points).styled(color, dash));
        }
    }
    lines(title, x, Axis::linear(y), &series)
}

/// Draws Gaussians and Cauchys of the same widths: of area 1 on `[-pi/2, pi/2]` each, as the paper's figure 4, then of peak 1, as the
/// scattering function has them.
#[must_use]
pub fn bells() -> [Drawing; 2] {
    let title = "Gaussian and Cauchy of the same width, area 1";
    let of_area_1 = bells_over(title, "density (1/rad)", |(_, _, area), width| {
        width.to_radians() * area(90.0 / width)
    });
    let of_peak_1 = bells_over(
        "Gaussian and Cauchy of the same width, peak 1",
        "bell (no unit)",
        |_, _| 1.0,
    );
    [
        Drawing::new(
            "bells-of-area-1",
            of_area_1,
            "Gaussian (unbroken) and Cauchy (dashed) distributions of the same width and offset, both normalised on \
             [−90°, 90°], as figure 4 of the paper: these are the densities that the sampler draws from and those it \
             stands in for. The Cauchy's tails are wider and its peak is lower.",
        ),
        Drawing::new(
            "bells-of-peak-1",
            of_peak_1,
            "The same bells with peak 1, as the lobes of the published model (Gaussian) and of the all-Cauchy variant \
             use them. At the same width parameter the Cauchy is narrower at half height (1 width against 1.177) and \
             far higher in the tails: 1/10 against 1/90 three widths out.",
        ),
    ]
}

/// Returns `S cos theta_i` as the mean of the channels.
fn reflected(bsdf: &AnyBsdf, theta: f64, phi: f64) -> f64 {
    let [r, g, b] = bsdf
        .eval(fibre_direction(theta, phi).as_vec3())
        .map(f64::from);
    (r + g + b) / 3.0 * theta.cos()
}

/// Returns inclination and azimuth of a direction.
fn angles_of(wi: Vec3) -> [f64; 2] {
    let [u, v, w] = wi.as_dvec3().to_array();
    [u.atan2(v.hypot(w)), w.atan2(v)]
}

/// Draws the paper's figure 5: samples of uniform sampling, of the mixture and of each lobe alone, over `S cos theta_i`, seen from the
/// inclination `theta_o` (radians) at azimuth 0.
///
/// The six maps share the points `xi` of the unit cube, which are a Halton sequence in the paper.
#[must_use]
pub fn sample_distributions(params: &HairParams, theta_o: f64, xi: &[[f32; 3]]) -> Drawing {
    let bsdf = AnyMaterial::from(Material::new(&Published(Gaussian), params))
        .prepare(fibre_direction(theta_o, 0.0).as_vec3());
    let panel = |(title, lobes, is_uniform): (&str, LobeMask, bool)| {
        let bsdf = bsdf.with_lobes(lobes);
        let angles = |xi: &[f32; 3]| {
            let [_, a, b] = xi.map(f64::from);
            let uniform = [(2.0 * a - 1.0).asin(), 2.0 * PI * b];
            if is_uniform {
                Some(uniform)
            } else {
                Some(angles_of(bsdf.sample(*xi)?.wi))
            }
        };
        let density = SphereGrid::sample((80, 160), &mut |theta, phi| reflected(&bsdf, theta, phi));
        ScatterPanel {
            title: title.to_owned(),
            points: xi.iter().filter_map(angles).collect(),
            density,
        }
    };
    let panels = [
        ("(a) uniform", LobeMask::ALL, true),
        ("(b) all lobes", LobeMask::ALL, false),
        ("(c) R", LobeMask::of(&[Lobe::R]), false),
        ("(d) TT", LobeMask::of(&[Lobe::TT]), false),
        ("(e) TRT without glint", LobeMask::of(&[Lobe::TRT]), false),
        ("(f) glint", LobeMask::of(&[Lobe::GLINT]), false),
    ]
    .map(panel);
    let mark = format!("direction to the viewer, θₒ = {:.0}°", theta_o.to_degrees());
    let maps = scatter_maps(
        "Sample distributions over S cos θᵢ",
        &panels,
        &mark,
        [theta_o, 0.0],
    );
    let caption = format!(
        "{} samples a map in equal-area maps of the sphere, as figure 5 of the paper: (a) uniform sampling, (b) the \
         mixture, (c) to (f) each lobe alone. The background is S cos θᵢ of the same lobes (square root; darker is \
         more), so samples should lie where it is dark. TT surrounds φ = ±180°, the direction away from the viewer.",
        xi.len()
    );
    Drawing::new("sample-distributions", maps, caption)
}
