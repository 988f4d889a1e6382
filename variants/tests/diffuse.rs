//! Models with a diffuse part, as the suites take them.

use crate::support::Draws;
use hairis::{Hit, LobeMask};
use hairis_conformance::proptest::prelude::*;
use hairis_conformance::{
    AnyMaterial, Claims, Expected, Materials, ParamsOf, Subject, Tolerance, strategies,
};
use hairis_reference::{Formulas, Reference};
use hairis_variants::{DiffusePresets, WithDiffuse, WithDiffuseDesc, WithDiffuseParams};

/// Model of a subject with a diffuse part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Diffuse<S>(pub(crate) S);

/// Diffuse parts: their share and colour.
const PARTS: [(f32, [f32; 3]); 5] = [
    (0.2, [0.5, 0.35, 0.25]),
    (0.0, [1.0; 3]),
    (0.6, [0.9, 0.5, 0.0]),
    (0.05, [0.1, 0.2, 0.9]),
    (1.0, [0.7, 0.8, 0.9]),
];

/// Diffuse parts at the ends of their ranges.
const ENDS: [(f32, [f32; 3]); 4] = [
    (1.0, [1.0; 3]),
    (1.0, [0.0; 3]),
    (1e-38, [1e-38, 1.0, 0.0]),
    (0.5, [0.0; 3]),
];

pub(crate) fn with<P: Copy>(
    fiber: P,
    (diffuse, diffuse_color): (f32, [f32; 3]),
) -> WithDiffuseParams<P> {
    WithDiffuseParams::new(&WithDiffuseDesc {
        fiber,
        diffuse,
        diffuse_color,
    })
    .unwrap()
}

type Of<S> = <S as Subject>::Model;

/// Returns the formulas at a hit.
pub(crate) fn formulas<M: Formulas<Params: DiffusePresets>>(
    params: &WithDiffuseParams<M::Params>,
    hit: &Hit,
) -> <WithDiffuse<M> as Formulas>::Point<f64> {
    let wo = [hit.wo.x, hit.wo.y, hit.wo.z].map(f64::from);
    let constants = <WithDiffuse<M> as Formulas>::formulas::<f64>(params);
    <WithDiffuse<M> as Formulas>::point(&constants, wo, f64::from(hit.h))
}

impl<S: Subject> Subject for Diffuse<S>
where
    S::Model: Formulas<Params: DiffusePresets>,
{
    type Model = WithDiffuse<S::Model>;

    fn model(&self) -> Self::Model {
        WithDiffuse(self.0.model())
    }

    fn materials(&self) -> Materials<Self> {
        let parts = PARTS.into_iter().cycle();
        let each = self.0.materials().into_iter().zip(parts);
        each.map(|((name, fiber), part)| (name, with(fiber, part)))
            .collect()
    }

    fn extremes(&self) -> Materials<Self> {
        let all = [self.0.extremes(), self.0.materials()].concat();
        let each = all.into_iter().zip(ENDS.into_iter().cycle());
        each.map(|((name, fiber), part)| (name, with(fiber, part)))
            .collect()
    }

    fn white(&self) -> Materials<Self> {
        let each = self
            .0
            .white()
            .into_iter()
            .zip([0.3, 0.0, 1.0, 0.05].into_iter().cycle());
        each.map(|((name, fiber), share)| (name, with(fiber, (share, [1.0; 3]))))
            .collect()
    }

    fn any_material(&self) -> Option<BoxedStrategy<AnyMaterial<ParamsOf<Self>>>> {
        let share = || strategies::range([0.0, 1.0]);
        let parts = (share(), [share(), share(), share()]);
        // One of the subject's materials: its own strategies keep the parameters that they draw to themselves.
        let fibers: Vec<_> = [self.0.materials(), self.0.extremes()].concat();
        let fiber = (0..fibers.len()).prop_map(move |index| fibers[index].1);
        let material = |(fiber, (diffuse, color)): (ParamsOf<S>, (f32, [f32; 3]))| {
            let code = format!("with({fiber:?}, ({diffuse:?}, {color:?}))");
            AnyMaterial::new(with(fiber, (diffuse, color)), code)
        };
        Some((fiber, parts).prop_map(material).boxed())
    }

    fn claims(&self) -> Claims {
        let claims = self.0.claims();
        // The azimuth of the cylinder takes all three numbers. Of n even points in a cube a surface crosses n^(2/3) of the boxes that hold
        // one each: they are left to chance, n^(1/3) of n. The bound is that of other models with a cylinder. Here it has more hits to
        // hold for, and four times as many points, whose own error is half as large.
        let inversion = 1.8 * f64::from(Claims::default().points).powf(-2.0 / 3.0);
        Claims {
            inversion: claims.inversion.max(inversion),
            // The fibre keeps half or more at the extremes, or nothing, and seldom less than a thousandth of a random share.
            most: 1e-3 * f64::from(f32::MAX),
            points: 4 * claims.points,
            ..claims
        }
    }

    fn edges(&self, params: &ParamsOf<Self>, hit: &Hit) -> [Vec<f64>; 2] {
        let [theta, mut phi] = self.0.edges(&params.desc().fiber, hit);
        let phi_o = f64::from(hit.wo.z).atan2(f64::from(hit.wo.y));
        phi.extend([
            phi_o,
            (phi_o + core::f64::consts::PI).sin().atan2(-phi_o.cos()),
        ]);
        [theta, phi]
    }

    fn weight_bound(&self, params: &ParamsOf<Self>, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        // A channel has at most three times the mean of the channels.
        let bound = formulas::<Of<S>>(params, hit).weight_bound(lobes)?;
        (bound > 0.0).then_some(3.0 * bound * (1.0 + 1e-5))
    }

    fn reference(&self, params: &ParamsOf<Self>, hit: &Hit) -> Option<Expected> {
        let of_fiber = self.0.reference(&params.desc().fiber, hit)?.tolerance;
        let tolerance = Tolerance {
            value: of_fiber.value.max(1e-5),
            pdf: of_fiber.pdf.max(1e-5),
            lobes: of_fiber.lobes.map(|bound| bound.max(1e-5)),
            rounding: of_fiber.rounding.max(5e-7),
            ..of_fiber
        };
        Some(Expected {
            reference: Box::new(formulas::<Of<S>>(params, hit)),
            tolerance,
        })
    }

    fn random_materials(&self) -> Vec<ParamsOf<Self>> {
        let mut draws = Draws(0xd1f);
        let fibers = self.0.random_materials().into_iter();
        let mut part = || (draws.xi() * draws.xi(), draws.xi3());
        fibers.map(|fiber| with(fiber, part())).collect()
    }
}
