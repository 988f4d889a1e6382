//! The fibre with a fake medulla under the suite that every model passes, and properties of its widths.

use crate::fiber::{ChiangFibers, params, rough};
use crate::support::{Draws, direction};
use hairis::{Hit, LobeMask, Material};
use hairis_conformance::proptest::prelude::*;
use hairis_conformance::{
    AnyMaterial, AsConserving, Claims, Expected, Materials, Subject, conformance, strategies,
};
use hairis_reference::{ChiangReference, Formulas};
use hairis_variants::chiang::{ScatteringChiang, ScatteringDesc, ScatteringParams};
use hairis_variants::{Chiang, ChiangDesc, ChiangParams};

conformance!(fibers, AsConserving(Fibers));

const FIBERS: ChiangFibers<false> = ChiangFibers;

/// Fibres of the suite of Chiang's model, with scattering.
struct Fibers;

fn with(fiber: ChiangParams, scattering: f32) -> ScatteringParams {
    ScatteringParams::new(&ScatteringDesc { fiber, scattering }).unwrap()
}

fn each(fibers: Materials<ChiangFibers<false>>, scattering: &[f32]) -> Materials<Fibers> {
    let each = fibers.into_iter().zip(scattering.iter().cycle());
    each.map(|((name, fiber), scattering)| (name, with(fiber, *scattering)))
        .collect()
}

fn formulas(params: &ScatteringParams, hit: &Hit) -> ChiangReference<f64> {
    let wo = [hit.wo.x, hit.wo.y, hit.wo.z].map(f64::from);
    let constants = ScatteringChiang::formulas::<f64>(params);
    ScatteringChiang::point(&constants, wo, f64::from(hit.h))
}

impl Subject for Fibers {
    type Model = ScatteringChiang;

    fn model(&self) -> ScatteringChiang {
        ScatteringChiang
    }

    fn materials(&self) -> Materials<Self> {
        each(FIBERS.materials(), &[0.4, 0.1, 0.7, 0.0, 0.9])
    }

    fn extremes(&self) -> Materials<Self> {
        let all = [FIBERS.extremes(), FIBERS.extremes()].concat();
        each(all, &[1.0, 1e-3, 0.995, f32::MIN_POSITIVE, 0.5])
    }

    fn white(&self) -> Materials<Self> {
        each(FIBERS.white(), &[0.3, 0.05, 1.0, 0.6])
    }

    fn any_material(&self) -> Option<BoxedStrategy<AnyMaterial<ScatteringParams>>> {
        // One of the fibres above: their own strategies keep the parameters that they draw to themselves.
        let fibers: Vec<_> = [FIBERS.materials(), FIBERS.extremes()].concat();
        let fiber = (0..fibers.len()).prop_map(move |index| fibers[index].1);
        let material = |(fiber, scattering): (ChiangParams, f32)| {
            let code = format!("with({fiber:?}, {scattering:?})");
            AnyMaterial::new(with(fiber, scattering), code)
        };
        Some(
            (fiber, strategies::range([0.0, 1.0]))
                .prop_map(material)
                .boxed(),
        )
    }

    fn claims(&self) -> Claims {
        FIBERS.claims()
    }

    fn edges(&self, params: &ScatteringParams, hit: &Hit) -> [Vec<f64>; 2] {
        FIBERS.edges(&params.desc().fiber, hit)
    }

    fn weight_bound(&self, params: &ScatteringParams, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        FIBERS.weight_bound(&params.desc().fiber, hit, lobes)
    }

    fn reference(&self, params: &ScatteringParams, hit: &Hit) -> Option<Expected> {
        let expected = FIBERS.reference(&params.desc().fiber, hit)?;
        Some(Expected {
            reference: Box::new(formulas(params, hit)),
            ..expected
        })
    }

    fn random_materials(&self) -> Vec<ScatteringParams> {
        let mut draws = Draws(0x5ca7);
        let fibers = FIBERS.random_materials().into_iter();
        fibers.map(|fiber| with(fiber, draws.xi())).collect()
    }
}

#[test]
fn without_scattering_the_model_is_chiangs() {
    let mut draws = Draws(0x5ca8);
    for (_, fiber) in FIBERS.materials() {
        let own = Material::new(&Chiang::MEAN, &fiber);
        let plain = Material::new(&ScatteringChiang, &with(fiber, 0.0));
        for _ in 0..200 {
            let wo = direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1));
            let hit = Hit::new(wo, crate::support::narrow(draws.between(-1.0, 1.0)));
            let (own, plain) = (own.prepare(hit), plain.prepare(hit));
            let wi = direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1));
            assert_eq!(own.eval_pdf(wi), plain.eval_pdf(wi), "{hit:?} {wi}");
            let xi = draws.xi3();
            assert_eq!(own.sample(xi), plain.sample(xi), "{hit:?} {xi:?}");
        }
    }
}

/// Roughnesses that reach 1 scatter no further, and a lobe that is wider already stays as it is.
#[test]
fn lobes_widen_up_to_a_roughness_of_1() {
    let hit = Hit::new(direction(0.4, 0.3), 0.2);
    let at = |beta, scattering| {
        let fiber = ChiangDesc {
            sigma_a: [0.0; 3],
            ..rough(beta, beta)
        };
        let material = Material::new(&ScatteringChiang, &with(params(fiber), scattering));
        let bsdf = material
            .prepare(hit)
            .with_lobes(LobeMask::of(&[hairis::Lobe::TT]));
        [0.1, 0.7, 1.3, 2.6].map(|phi| bsdf.pdf(direction(-0.3, phi)))
    };
    let flat = at(1.0, 0.0);
    assert_eq!(at(1.0, 0.9), at(1.0, 0.4), "at a roughness of 1");
    for (flat, most) in flat.into_iter().zip(at(0.7, 0.95)) {
        assert!((most / flat - 1.0).abs() < 1e-5, "{most} {flat}");
    }
    let narrow = at(0.2, 0.0);
    assert!(at(0.2, 0.3)[0] > narrow[0], "a tail rises");
}
