//! Effect of rounded inputs on results, which is the difference allowed between two evaluations of one formula.

use crate::erased::{ErasedBsdf, NamedMaterial};
use crate::probe::{Direction, cos_theta, distance, narrow, rounded};
use hairis::{Eval, Hit, Sample};

/// Rounding of an angle, or of a uniform number, as it accumulates in single-precision arithmetic.
const ROUNDING: f64 = 4e-7;

/// Values and densities below this floor are compared absolutely.
const FLOOR: f64 = 1e-20;

/// Shading point, with the hits that rounding may turn its hit into.
pub(crate) struct Nearby<'a> {
    material: NamedMaterial<'a>,
    hit: Hit,
    near_field: bool,
    bsdf: Box<dyn ErasedBsdf>,
}

impl<'a> Nearby<'a> {
    pub(crate) fn new(material: NamedMaterial<'a>, hit: Hit, near_field: bool) -> Self {
        Self {
            material,
            hit,
            near_field,
            bsdf: material.prepare(hit),
        }
    }

    pub(crate) fn bsdf(&self) -> &dyn ErasedBsdf {
        &*self.bsdf
    }

    /// Returns the shading points of rounded hits.
    fn bsdfs(&self) -> impl Iterator<Item = Box<dyn ErasedBsdf>> {
        let Hit { wo, h } = self.hit;
        let moved = rounded(wo.into(), ROUNDING).map(|wo| Hit { wo: wo.into(), h });
        let by = if self.near_field {
            narrow(ROUNDING)
        } else {
            0.0
        };
        let across = [h + by, h - by].map(|h| Hit { wo, h });
        moved
            .into_iter()
            .chain(across)
            .map(|hit| self.material.prepare(hit))
    }

    /// Returns the largest change of value and density as `wi` and the hit are rounded.
    fn spread(&self, wi: Direction) -> [f64; 4] {
        let numbers = |e: Eval| [e.value[0], e.value[1], e.value[2], e.pdf].map(f64::from);
        let centre = numbers(self.bsdf.eval_pdf(wi));
        let moved = rounded(wi, ROUNDING).map(|wi| self.bsdf.eval_pdf(wi));
        let mut spread = [0.0; 4];
        for e in moved
            .into_iter()
            .chain(self.bsdfs().map(|bsdf| bsdf.eval_pdf(wi)))
        {
            for ((most, x), c) in spread.iter_mut().zip(numbers(e)).zip(centre) {
                *most = f64::max(*most, (x - c).abs());
            }
        }
        spread
    }

    /// Returns the largest relative error of value and density, less the change that rounding the directions causes.
    pub(crate) fn error(&self, got: Eval, want: Eval, wi: Direction) -> f64 {
        let numbers = |e: Eval| [e.value[0], e.value[1], e.value[2], e.pdf].map(f64::from);
        let (got, want) = (numbers(got), numbers(want));
        if got == want {
            return 0.0;
        }
        let errors = got.into_iter().zip(want).zip(self.spread(wi));
        let beyond = |((got, want), by): ((f64, f64), f64)| {
            ((got - want).abs() - by).max(0.0) / want.abs().max(FLOOR)
        };
        // A maximum ignores NaN, which is always an error.
        if got.iter().any(|x| x.is_nan()) {
            f64::NAN
        } else {
            errors.map(beyond).fold(0.0, f64::max)
        }
    }
}

/// Returns true if a sample is that of one lane, or could be with rounded numbers and a rounded hit.
pub(crate) fn sample_is_near(
    got: Option<Sample>,
    want: Option<Sample>,
    nearby: &Nearby<'_>,
    xi: [f32; 3],
    direction: f64,
) -> bool {
    let near = |want: Option<Sample>, by: f64| match (got, want) {
        (None, None) => true,
        (Some(a), Some(b)) => a.lobe == b.lobe && distance(a.wi, b.wi) <= by,
        // Next to the axis, either sample may be discarded.
        (Some(s), None) | (None, Some(s)) => cos_theta(s.wi) < 1e-4,
    };
    if near(want, direction) {
        return true;
    }
    let mut moved = Vec::new();
    for axis in 0..3 {
        for by in [-2.0, -1.0, -0.5, 0.5, 1.0, 2.0] {
            let mut xi = xi;
            xi[axis] = (xi[axis] + by * narrow(ROUNDING)).clamp(0.0, 1.0 - f32::EPSILON / 2.0);
            moved.push(nearby.bsdf().sample(xi));
        }
    }
    moved.extend(nearby.bsdfs().map(|bsdf| bsdf.sample(xi)));
    // Largest distance by which rounding moves the sample of a lobe.
    let reach = moved.iter().flatten().filter_map(|a| {
        let of_lobe = |b: &Sample| b.lobe == a.lobe;
        want.filter(of_lobe)
            .or_else(|| moved.iter().flatten().copied().find(of_lobe))
            .map(|b| distance(a.wi, b.wi))
    });
    let reach = reach.fold(direction, f64::max);
    moved.push(want);
    moved.into_iter().any(|m| near(m, reach))
}
