//! Tests of values, densities and lobes against the reference in double precision, on one lane and eight, on every level.

use super::Tested;
use super::support::{Kind, for_each_point, packet};
use crate::comparison::{LargestError, over};
use crate::size::cases;
use hairis::simd::Level;
use hairis::{Eval, Lobe};

/// Share of 1 per steradian below which a Gaussian is compared absolutely: it is cut to 0 at `2^-115` of its peak.
pub(super) const FLOOR: f64 = 1e-20;

/// Returns the largest errors of S and of the density, of the whole and of lobes, over those of `Reference::error_bound`.
fn scan(tested: &Tested, kind: Kind, per_point: usize) -> [LargestError; 4] {
    let mut worst: [LargestError; 4] = Default::default();
    for_each_point(tested, kind, |material, reference, point| {
        let bsdf = material.prepare(point.wo);
        for eight in point.directions(per_point).chunks(8) {
            let wi = packet(eight);
            let wide: Vec<_> = Level::available()
                .map(|level| {
                    (
                        level,
                        material.prepare(point.wo).with_level(level).eval_pdf8(&wi),
                    )
                })
                .collect();
            let wide_lobes = bsdf.lobes8(&wi);
            for (lane, wi) in eight.iter().enumerate() {
                let d = super::support::double(*wi);
                let (value, pdf) = (reference.eval(d), reference.pdf(d));
                let (lobe_values, lobe_pdfs) = (reference.lobe_values(d), reference.lobe_pdfs(d));
                let (allowed, allowed_pdf) = reference.error_bound(d).unwrap();
                let of_lobes = reference.lobe_errors(d).unwrap();
                let mut see = |got: Eval, level: &str| {
                    let at = || format!("{level} wo {:?} wi {wi:?} {:?}", point.wo, point.params);
                    for (c, got) in got.value.into_iter().enumerate() {
                        worst[0].see(over(got, value[c], allowed[c], FLOOR), at);
                    }
                    worst[1].see(over(got.pdf, pdf, allowed_pdf, tested.pdf_floor), at);
                };
                see(bsdf.eval_pdf(*wi), "scalar");
                for (level, eval) in &wide {
                    see(eval.lane(lane), level.name());
                }
                let scalar = bsdf.lobes(*wi);
                for lobe in Lobe::FOUR {
                    let eight = &wide_lobes[lobe];
                    let wide = [eight.value.as_array()[lane], eight.pdf.as_array()[lane]];
                    // Normalised, a lobe of the last few powers of two of a Gaussian would show where the Gaussian is cut.
                    let cut = lobe_values[lobe] < tested.pdf_floor;
                    for [value, pdf] in [[scalar[lobe].value, scalar[lobe].pdf], wide] {
                        let at =
                            || format!("{lobe:?} wo {:?} wi {wi:?} {:?}", point.wo, point.params);
                        let [of_value, of_pdf] = of_lobes[lobe];
                        let want = lobe_values[lobe];
                        worst[2].see(over(value, want, want * of_value, FLOOR), at);
                        if cut {
                            continue;
                        }
                        let want = lobe_pdfs[lobe];
                        worst[3].see(over(pdf, want, want * of_pdf, tested.pdf_floor), at);
                    }
                }
            }
        }
    });
    worst
}

fn check(tested: &Tested, kind: Kind, per_point: usize) {
    let names = ["S", "pdf", "S of a lobe", "pdf of a lobe"];
    for (name, worst) in names.into_iter().zip(scan(tested, kind, per_point)) {
        worst.check(&format!("{kind:?} {name} over its bound"), 1.0);
    }
}

pub fn values_on_the_grid(tested: &Tested) {
    check(tested, Kind::Grid, 64);
}

pub fn values_of_narrow_lobes(tested: &Tested) {
    check(tested, Kind::Narrow, cases(4096));
}

pub fn values_of_wide_lobes(tested: &Tested) {
    check(tested, Kind::Wide, cases(4096));
}
