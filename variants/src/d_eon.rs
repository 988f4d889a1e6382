#![doc = include_str!("guide/d_eon.md")]

mod fields;
mod lobes;
mod params;
mod prepare;
mod sampling;
mod trt;

pub use params::{DEonDesc, DEonParams};
use prepare::DEonMaterial;
pub use prepare::DEonPrepared;

use core::f32::consts::FRAC_PI_2;
use hairis::model::math::{GAUSS_LEGENDRE_32, gaussian, sin_cos_half_turn};
use hairis::model::{Direction, LobeEval, LobeModel};
use hairis::simd::{Broadcast, Lanes, Scalar, lanes3};
use hairis::{Hit, PerLobe};

/// D'Eon's far field, which RTXCR renders, with exact densities and all light.
///
/// `S = sum of A_p M_p N_p / cos theta_i` over R, TT, TRT and a diffuse cylinder. The [module](self) derives each term.
///
/// - Lobes: "r", "tt", "trt", which stands for all further paths, and "diffuse", in slots 0 to 3.
/// - Far field: the model does not read [`Hit::h`].
/// - Energy: `S cos theta_i` integrates to 1 without absorption, for every `wo`, roughness, tilt and index. The model is not reciprocal,
///   because widths and attenuations depend on `theta_o` alone, so that light tracing has to use the adjoint.
/// - Sampling: exact. Weights are at most 5 times the sum of the lobes' shares, which is at most 1: see the
///   [bound](self#sampling-and-its-bound).
/// - Source: d'Eon 2022 as RTXCR has it; d'Eon et al. 2011 (`M_p`) and 2013 (its sampling); `ERRATA.md` of this package.
/// - Accuracy: value, density and each lobe are accurate to `1e-5 + 5e-7 / w`, with `w` the width of the narrowest lobe, further than 1e-3 rad
///   from the axis. The narrowest lobe is R at its edge, as wide as .14 roughnesses. TT has fewer digits next to the azimuth at which it
///   ends, and TRT next to inclinations of .525 and 1.1 rad, at which it jumps: `Reference::error_bound` of `hairis-reference` has both.
///
/// ```
/// use glam::Vec3;
/// use hairis::Material;
/// use hairis_variants::{DEon, DEonParams};
/// let hair = Material::new(&DEon, &DEonParams::white());
/// let sample = hair.prepare(Vec3::new(0.6, 0.8, 0.0)).sample([0.5, 0.25, 0.75]).expect("not along the fibre");
/// assert!(sample.weight.iter().all(|w| *w > 0.5 && *w < 1.5)); // hardly any absorption
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DEon;

impl LobeModel for DEon {
    type Params = DEonParams;
    type Material<C: Scalar> = DEonMaterial<C>;
    type Prepared<C: Scalar> = DEonPrepared<C>;

    const LOBES: &'static [&'static str] = &["r", "tt", "trt", "diffuse"];
    const CONSERVES: bool = true;

    #[inline]
    fn material(&self, params: &DEonParams) -> DEonMaterial<f32> {
        DEonMaterial::new::<f64>(params.desc())
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &DEonMaterial<C>,
        hit: Hit<L>,
    ) -> DEonPrepared<L::Stored> {
        prepare::prepare(material, hit.wo)
    }

    #[inline(always)]
    fn weights<L: Lanes, C: Broadcast<L>>(prepared: &DEonPrepared<C>) -> PerLobe<L> {
        let [r, tt, trt, diffuse] = &prepared.weights;
        PerLobe([
            r.lanes(),
            tt.lanes(),
            trt.lanes(),
            diffuse.lanes(),
            L::splat(0.0),
        ])
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &DEonPrepared<C>,
        wi: &Direction<L>,
    ) -> PerLobe<LobeEval<L>> {
        PerLobe::padded(lobes::lobes(prepared, wi), LobeEval::none())
    }

    #[inline(always)]
    fn first_four<L: Lanes, C: Broadcast<L>>(
        prepared: &DEonPrepared<C>,
        wi: &Direction<L>,
    ) -> [LobeEval<L>; 4] {
        lobes::lobes(prepared, wi)
    }

    #[inline(always)]
    fn sample_lobe<L: Lanes, C: Broadcast<L>>(
        prepared: &DEonPrepared<C>,
        lobe: L::Index,
        xi: [L; 3],
    ) -> Direction<L> {
        sampling::sample(prepared, lobe, xi)
    }

    /// Returns closed forms for R, TRT and the diffuse lobe, and for TT a quadrature of 32 nodes over the width of the fibre, with an error
    /// of 1e-6.
    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &DEonPrepared<C>) -> PerLobe<[L; 3]> {
        let (zero, q) = (L::splat(0.0), prepared.q.lanes());
        let mut passed = [zero; 3];
        for (x, weight) in GAUSS_LEGENDRE_32 {
            let (sin, cos) = sin_cos_half_turn(L::splat(FRAC_PI_2 * x));
            let inside = (L::splat(1.0) - q * sin * (q * sin)).sqrt();
            let clear = lobes::clear_passage(prepared, cos) * (cos * (FRAC_PI_2 * weight));
            let mut c = 0;
            while c < 3 {
                let depth: L = prepared.twice_depth[c].lanes();
                passed[c] = clear.mul_add(gaussian(depth * inside), passed[c]);
                c += 1;
            }
        }
        let r = prepared.kept.lanes() * prepared.reflectance.lanes();
        let albedo = [
            [r; 3],
            passed,
            lanes3(&prepared.attenuation_trt),
            lanes3(&prepared.diffuse),
        ];
        PerLobe::padded(albedo, [zero; 3])
    }
}
