//! Fibre as a subject of the suite.

use super::{CONE, DIFFUSE, Fiber, Params};
use hairis::{Hit, LobeMask};
use hairis_conformance::proptest::array::uniform3;
use hairis_conformance::proptest::prelude::*;
use hairis_conformance::{AnyMaterial, Claims, Materials, Subject, strategies};

/// Fibre with this fault, as its author would test it.
pub(crate) struct Broken(pub(crate) u32);

impl Subject for Broken {
    type Model = Fiber;

    fn model(&self) -> Fiber {
        Fiber
    }

    fn materials(&self) -> Materials<Self> {
        vec![
            (
                "everyday",
                Params {
                    fault: self.0,
                    kd: [0.4, 0.3, 0.2],
                    ks: [0.5, 0.4, 0.6],
                    width: 0.1,
                },
            ),
            (
                "narrow",
                Params {
                    fault: self.0,
                    kd: [0.1, 0.3, 0.2],
                    ks: [0.5, 0.9, 0.0],
                    width: 0.01,
                },
            ),
            (
                "black",
                Params {
                    fault: self.0,
                    kd: [0.0; 3],
                    ks: [0.0; 3],
                    width: 0.1,
                },
            ),
        ]
    }

    fn extremes(&self) -> Materials<Self> {
        vec![(
            "cone alone",
            Params {
                fault: self.0,
                kd: [0.0; 3],
                ks: [1e30, 0.0, 1e-30],
                width: 0.03,
            },
        )]
    }

    fn white(&self) -> Materials<Self> {
        vec![(
            "diffuse alone",
            Params {
                fault: self.0,
                kd: [1.0; 3],
                ks: [0.0; 3],
                width: 0.1,
            },
        )]
    }

    fn any_material(&self) -> Option<BoxedStrategy<AnyMaterial<Params>>> {
        let fault = self.0;
        let fields = (
            uniform3(strategies::range([0.0, 1.0])),
            uniform3(strategies::range([0.0, 1.0])),
            strategies::range([1e-2, 1.0]),
        );
        let params = move |(kd, ks, width)| Params {
            fault,
            kd,
            ks,
            width,
        };
        Some(fields.prop_map(move |fields| params(fields).into()).boxed())
    }

    fn claims(&self) -> Claims {
        Claims {
            reciprocal: Some(2e-6),
            furnace: Some(1e-5),
            albedo: 2e-3,
            direction: 2e-5,
            ..Claims::default()
        }
    }

    /// Returns the largest bound of a lobe, whose weight is `4 kd cos / (pi p)` or `ks cos span / (pi p)`, where `span <= pi` and `p` is
    /// the lobe's share.
    fn weight_bound(&self, params: &Params, _hit: &Hit, lobes: LobeMask) -> Option<f64> {
        let sum = |color: [f32; 3]| color.iter().map(|x| f64::from(*x)).sum::<f64>();
        let most = |color: [f32; 3]| f64::from(color.into_iter().fold(0.0, f32::max));
        let lit = |lobe, color: [f32; 3]| {
            if lobes.contains(lobe) {
                color
            } else {
                [0.0; 3]
            }
        };
        let (kd, ks) = (lit(DIFFUSE, params.kd), lit(CONE, params.ks));
        let total = sum(kd) + sum(ks);
        let ratio = |color, by: f64| {
            if sum(color) > 0.0 {
                by * most(color) * total / sum(color)
            } else {
                0.0
            }
        };
        (total > 0.0).then(|| ratio(kd, 4.0 / core::f64::consts::PI).max(ratio(ks, 1.0)))
    }
}
