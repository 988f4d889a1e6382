//! The energy-conserving fibre, as the suites take it.

use crate::support::Draws;
use hairis::{Hit, LobeMask};
use hairis_conformance::proptest::{self, prelude::*};
use hairis_conformance::{
    AnyMaterial, Claims, Expected, Materials, Subject, Tolerance, strategies,
};
use hairis_reference::{ChiangReference, Reference, Selection};
use hairis_variants::chiang::{Chiang, ChiangDesc, ChiangParams, Shifts};

/// The model with one of its selections.
pub(crate) struct ChiangFibers<const BY_CHANNEL: bool>;

pub(crate) fn params(desc: ChiangDesc) -> ChiangParams {
    ChiangParams::new(&desc).unwrap()
}

pub(crate) fn rough(beta_m: f32, beta_n: f32) -> ChiangDesc {
    ChiangDesc {
        beta_m,
        beta_n,
        ..ChiangDesc::default()
    }
}

/// Tints the lobes, and makes each wider or narrower by up to a factor of two.
pub(crate) fn vary(desc: ChiangDesc, draws: &mut Draws) -> ChiangDesc {
    let [tint_r, tint_tt, tint_trt] = [(); 3].map(|()| draws.xi3());
    let mut widths = |widths: [f32; 3]| {
        widths.map(|width| width * crate::support::narrow(draws.scale(0.5, 2.0)))
    };
    ChiangDesc {
        tint_r,
        tint_tt,
        tint_trt,
        width_m: widths(desc.width_m),
        width_n: widths(desc.width_n),
        ..desc
    }
}

fn double(hit: &Hit) -> [f64; 3] {
    [hit.wo.x, hit.wo.y, hit.wo.z].map(f64::from)
}

impl<const BY_CHANNEL: bool> ChiangFibers<BY_CHANNEL> {
    fn formulas(params: &ChiangParams, hit: &Hit) -> ChiangReference<f64> {
        let h = f64::from(hit.h);
        ChiangReference::prepare(
            &params.desc().map(f64::from),
            Selection::of(BY_CHANNEL),
            double(hit),
            h,
        )
    }
}

impl<const BY_CHANNEL: bool> Subject for ChiangFibers<BY_CHANNEL> {
    type Model = Chiang<BY_CHANNEL>;

    fn model(&self) -> Chiang<BY_CHANNEL> {
        Chiang
    }

    fn materials(&self) -> Materials<Self> {
        vec![
            ("brown", ChiangParams::brown()),
            ("narrow", params(rough(0.1, 0.1))),
            (
                "wide",
                params(ChiangDesc {
                    tilt: -0.35,
                    eta: 1.3,
                    ..rough(1.0, 0.7)
                }),
            ),
            (
                "red, even",
                params(ChiangDesc {
                    sigma_a: ChiangParams::red().desc().sigma_a,
                    ..rough(0.6, 1.0)
                }),
            ),
            (
                "tinted, each lobe of its own width",
                params(ChiangDesc {
                    tint_r: [1.0, 0.8, 0.5],
                    tint_tt: [0.3, 0.6, 0.9],
                    tint_trt: [0.9, 0.0, 1.0],
                    width_m: [0.7, 0.9, 1.4],
                    width_n: [1.5, 0.6, 0.9],
                    ..rough(0.3, 0.3)
                }),
            ),
        ]
    }

    fn extremes(&self) -> Materials<Self> {
        let desc = ChiangDesc::default();
        let quarter = core::f32::consts::FRAC_PI_4;
        vec![
            ("narrowest", params(rough(1e-3, 1e-3))),
            ("no refraction", params(ChiangDesc { eta: 1.0, ..desc })),
            (
                "ink",
                params(ChiangDesc {
                    sigma_a: [f32::MAX, 1e6, 0.0],
                    ..desc
                }),
            ),
            (
                "ink without a surface",
                params(ChiangDesc {
                    sigma_a: [f32::MAX; 3],
                    eta: 1.0,
                    ..desc
                }),
            ),
            (
                "tilted",
                params(ChiangDesc {
                    tilt: quarter,
                    eta: 4.0,
                    sigma_a: [0.0; 3],
                    ..rough(0.01, 1.0)
                }),
            ),
            (
                "black by tints",
                params(ChiangDesc {
                    tint_r: [0.0; 3],
                    tint_tt: [0.0; 3],
                    tint_trt: [0.0; 3],
                    ..desc
                }),
            ),
            (
                "narrowest and widest lobes",
                params(ChiangDesc {
                    width_m: [0.1, 10.0, 0.1],
                    width_n: [10.0, 0.1, 10.0],
                    ..rough(1e-3, 1e-3)
                }),
            ),
            (
                "flat",
                params(ChiangDesc {
                    width_m: [10.0; 3],
                    width_n: [10.0; 3],
                    ..rough(1.0, 1.0)
                }),
            ),
        ]
    }

    fn white(&self) -> Materials<Self> {
        let clear = |beta_m, beta_n, tilt, eta| {
            params(ChiangDesc {
                sigma_a: [0.0; 3],
                tilt,
                eta,
                ..rough(beta_m, beta_n)
            })
        };
        vec![
            ("everyday", clear(0.3, 0.3, 0.035, 1.55)),
            ("narrow", clear(1e-3, 0.05, -0.35, 1.55)),
            ("wide", clear(1.0, 1e-3, 0.35, 1.2)),
            ("dense", clear(0.7, 0.7, 0.0, 4.0)),
            (
                "each lobe of its own width",
                params(ChiangDesc {
                    width_m: [2.0, 1.0, 0.5],
                    width_n: [0.5, 1.0, 2.0],
                    ..*clear(0.3, 0.3, 0.035, 1.55).desc()
                }),
            ),
        ]
    }

    fn any_material(&self) -> Option<BoxedStrategy<AnyMaterial<ChiangParams>>> {
        let quarter = core::f32::consts::FRAC_PI_4;
        let roughness = || strategies::range([1e-3, 1.0]);
        let fields = (
            (roughness(), roughness()),
            strategies::range([-quarter, quarter]),
            strategies::range([1.0, 4.0]),
            strategies::intensities(f32::MAX),
            proptest::sample::select(vec![Shifts::DEon, Shifts::SmallAngle]),
            proptest::bool::ANY,
            0_u64..1 << 32,
        );
        let material = |((beta_m, beta_n), tilt, eta, sigma_a, shifts, varies, seed)| {
            let desc = ChiangDesc {
                beta_m,
                beta_n,
                tilt,
                eta,
                sigma_a,
                shifts,
                ..ChiangDesc::default()
            };
            let desc = if varies {
                vary(desc, &mut Draws(seed))
            } else {
                desc
            };
            let code = format!("{desc:?}").replace("shifts: ", "shifts: Shifts::");
            AnyMaterial::new(params(desc), format!("params({code})"))
        };
        Some(fields.prop_map(material).boxed())
    }

    fn claims(&self) -> Claims {
        // The inclination takes two numbers. Of n even points in a square a curve crosses n^(1/2) of the rectangles that hold
        // one each: they are left to chance, n^(1/4) of n. 2.4e-4 was seen with 2^17 points, below 1e-4 with 2^20.
        let inversion = 2.0 * f64::from(Claims::default().points).powf(-0.75);
        Claims {
            // 1.1e-6 was found uphill.
            furnace: Some(1.5e-6),
            near_field: true,
            albedo: 1e-5,
            inversion,
            ..Claims::default()
        }
    }

    /// The cones, and the kinks of the azimuthal terms.
    fn edges(&self, params: &ChiangParams, hit: &Hit) -> [Vec<f64>; 2] {
        let (formulas, [_, v, w]) = (Self::formulas(params, hit), double(hit));
        let lobes = [hairis::Lobe::R, hairis::Lobe::TT, hairis::Lobe::TRT];
        let wrap = |phi: f64| phi.sin().atan2(phi.cos());
        let azimuths = lobes.into_iter().flat_map(|lobe| {
            let phi = w.atan2(v) + formulas.centre(lobe);
            [wrap(phi), wrap(phi + core::f64::consts::PI)]
        });
        [
            lobes.map(|lobe| formulas.cone(lobe)).to_vec(),
            azimuths.collect(),
        ]
    }

    fn weight_bound(&self, params: &ChiangParams, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        let albedo = Self::formulas(params, hit).albedo();
        let lit = hairis::Lobe::ALL
            .into_iter()
            .filter(|lobe| lobes.contains(*lobe));
        let sum = lit.fold([0.0; 3], |sum, lobe| {
            core::array::from_fn(|c| sum[c] + albedo[lobe][c])
        });
        let most = if BY_CHANNEL {
            sum.into_iter().fold(0.0, f64::max)
        } else {
            sum.iter().sum::<f64>() / 3.0
        };
        // Shares by channel are those of all lobes: of some of them they bound nothing but by the least share.
        (!BY_CHANNEL || lobes == LobeMask::ALL).then_some(3.0 * most * (1.0 + 1e-6))
    }

    fn reference(&self, params: &ChiangParams, hit: &Hit) -> Option<Expected> {
        let tolerance = Tolerance {
            // Lobes with next to no energy in a channel are not sampled for it.
            floor: 1e-17,
            direction: Some(1e-5),
            ..Tolerance::default()
        };
        Some(Expected {
            reference: Box::new(Self::formulas(params, hit)),
            tolerance,
        })
    }

    fn random_materials(&self) -> Vec<ChiangParams> {
        let mut draws = Draws(0xc41a);
        let one = |_| {
            let beta = [draws.scale(0.02, 1.0), draws.scale(0.02, 1.0)].map(crate::support::narrow);
            let sigma_a = draws.xi3().map(|x| 6.0 * x * x);
            let (tilt, eta) = (
                0.7 * (draws.xi() - 0.5),
                1.0 + 3.0 * draws.xi() * draws.xi(),
            );
            params(ChiangDesc {
                sigma_a,
                tilt,
                eta,
                ..rough(beta[0], beta[1])
            })
        };
        let plain: Vec<ChiangParams> = (0..40).map(one).collect();
        let mut draws = Draws(0x7147);
        let varied = plain.iter().step_by(2);
        let varied: Vec<_> = varied
            .map(|one| params(vary(*one.desc(), &mut draws)))
            .collect();
        [plain, varied].concat()
    }
}
