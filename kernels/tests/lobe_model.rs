//! Albedos that the library provides for a model given by its lobes.

use core::f32::consts::FRAC_1_PI;
use glam::Vec3;
use hairis::model::{Direction, LobeEval, LobeModel};
use hairis::simd::{Broadcast, Lanes, Scalar, lane_struct, lanes3};
use hairis::{Material, PerLobe};

/// Fibre that is drawn evenly: `S cos theta_i = color (1 + u + v + u^2) / (4 pi)`.
#[derive(Clone, Copy)]
struct Sided;

lane_struct! {
    /// Material and shading point alike: the colour, linear RGB.
    pub struct Color {
        /// Red, green and blue.
        pub rgb: [C; 3],
    }
}

impl LobeModel for Sided {
    type Params = [f32; 3];
    type Material<C: Scalar> = Color<C>;
    type Prepared<C: Scalar> = Color<C>;

    const LOBES: &'static [&'static str] = &["sided"];

    fn material(&self, rgb: &[f32; 3]) -> Color<f32> {
        Color { rgb: *rgb }
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &Color<C>,
        _hit: hairis::Hit<L>,
    ) -> Color<L::Stored> {
        material.spread::<L>()
    }

    #[inline(always)]
    fn weights<L: Lanes, C: Broadcast<L>>(_prepared: &Color<C>) -> PerLobe<L> {
        PerLobe::padded([L::splat(1.0)], L::splat(0.0))
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &Color<C>,
        wi: &Direction<L>,
    ) -> PerLobe<LobeEval<L>> {
        let pdf = L::splat(0.25 * FRAC_1_PI);
        let u = wi.vector.x;
        let sum = (u + 1.0) * u + wi.vector.y + 1.0;
        let value = L::quotient(pdf * L::splat(0.0).max(sum), wi.cos_theta);
        PerLobe::padded(
            [LobeEval::new(value, lanes3(&prepared.rgb), pdf)],
            LobeEval::none(),
        )
    }

    #[inline(always)]
    fn sample_lobe<L: Lanes, C: Broadcast<L>>(
        _: &Color<C>,
        _: L::Index,
        xi: [L; 3],
    ) -> Direction<L> {
        let (one, u) = (L::splat(1.0), xi[1]);
        let sin = L::select(xi[0].lt(L::splat(0.5)), u, -u);
        Direction::with_uniform_azimuth([sin, ((one - u) * (one + u)).sqrt()], xi[2])
    }
}

/// The first number gives the side of the normal plane, the second the inclination, and the third the azimuth: the mean over the sphere is
/// 4/3 if each is spread over its range.
#[test]
fn the_provided_albedo_is_a_mean_over_all_three_numbers() {
    let hair = Material::new(&Sided, &[0.75, 0.3, 0.0]).prepare(Vec3::Y);
    let [r, g, b] = hair.albedo().0[0];
    // Measured: 3.6e-3, as the first number makes S jump.
    assert!((r - 1.0).abs() < 5e-3 && (g - 0.4).abs() < 2e-3, "{r} {g}");
    assert_eq!(b, 0.0);
    let wi = Vec3::new(0.6, 0.0, 0.8);
    let (all, lobes) = (hair.eval_pdf(wi), hair.lobes(wi).0);
    assert_eq!(
        [lobes[0].pdf, lobes[0].value * 0.3],
        [all.pdf, all.value[1]]
    );
}
