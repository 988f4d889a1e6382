//! Sound model of two lobes, and copies of it with one fault each. Only this file and `slow` of these tests implement [`Model`].

mod slow;
mod subject;

pub(crate) use slow::Slow;
pub(crate) use subject::Broken;

use core::f32::consts::{FRAC_1_PI, PI};
use core::ops::Deref;
use hairis::model::math::{atan2_upper, sin_cos_half_turn};
use hairis::model::{GRAZING, LobeEval, Model, SampleLanes};
use hairis::simd::{Broadcast, LaneStruct, Lanes, Path, Scalar, Vec3x, lanes3, store3};
use hairis::{Eval, Hit, Lobe, LobeMask, PerLobe};

/// Bits of the number 1. Compilers load constants in vectors, and compute with a fault beside them. Other bits, or padding, would now and
/// then be a number that overflows.
const ONE: u32 = 1.0_f32.to_bits();

/// Faults of a model, by number. They are constants of a material, because a type per fault would be compiled for each.
pub(crate) const SOUND: u32 = ONE;
pub(crate) const DENSITY_TOO_HIGH: u32 = ONE + 1;
pub(crate) const WRONG_LANE: u32 = ONE + 2;
pub(crate) const WRONG_PROBABILITY: u32 = ONE + 3;
pub(crate) const NAN_AT_THE_POLE: u32 = ONE + 4;
pub(crate) const NOT_RECIPROCAL: u32 = ONE + 5;
pub(crate) const WIDE_SLICES_DIFFER: u32 = ONE + 6;
pub(crate) const MASK_LEAKS: u32 = ONE + 7;
pub(crate) const HEAVY_WEIGHT: u32 = ONE + 8;
pub(crate) const SKEWED_LOBE: u32 = ONE + 9;
pub(crate) const LOBE_MISSING: u32 = ONE + 10;
pub(crate) const ALBEDO_TOO_LOW: u32 = ONE + 11;
pub(crate) const DISCARDS: u32 = ONE + 12;
pub(crate) const WEIGHT_WITHOUT_COSINE: u32 = ONE + 13;
pub(crate) const LONG_DIRECTION: u32 = ONE + 14;
pub(crate) const READS_H: u32 = ONE + 15;
pub(crate) const PACKET_DIFFERS: u32 = ONE + 16;
pub(crate) const WRONG_PACK: u32 = ONE + 17;
pub(crate) const NEGATIVE: u32 = ONE + 18;
pub(crate) const AZIMUTH_UNEVEN: u32 = ONE + 19;
pub(crate) const NAN_IS_A_NUMBER: u32 = ONE + 20;
pub(crate) const DIVIDES_BY_ZERO: u32 = ONE + 21;
pub(crate) const NEGATIVE_ROUNDED_DOWN: u32 = ONE + 22;

/// Fibre with a diffuse lobe, uniform on the sphere, and a cone of mirror directions.
///
/// `S = kd / pi^2 + ks c(sin theta_i + sin theta_o) / (2 pi)`, with `c` the Cauchy density of width `w`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fiber;

const DIFFUSE: Lobe = Lobe::slot(0);
const CONE: Lobe = Lobe::slot(1);

#[derive(Clone, Copy, Debug)]
pub(crate) struct Params {
    pub(crate) fault: u32,
    pub(crate) kd: [f32; 3],
    pub(crate) ks: [f32; 3],
    /// Width of the cone in `sin theta`.
    pub(crate) width: f32,
}

hairis::simd::lane_struct! {
    /// Constants of a material of the fibre.
    pub struct Material {
        /// Colour of the diffuse lobe in linear RGB.
        pub kd: [C; 3],
        /// Colour of the cone in linear RGB.
        pub ks: [C; 3],
        /// Width of the cone in `sin theta`.
        pub width: C,
        /// Probability of each lobe.
        pub selection: [C; 2],
    }
}

hairis::simd::lane_struct! {
    /// Constants of a shading point of the fibre.
    pub struct Point {
        /// Colour of the diffuse lobe, as in the material.
        pub kd: [C; 3],
        /// Colour of the cone, as in the material.
        pub ks: [C; 3],
        /// Width of the cone, as in the material.
        pub width: C,
        /// Probability of each lobe, as in the material.
        pub selection: [C; 2],
        /// Sine of `theta_o`.
        pub sin_theta_o: C,
        /// Angle that the sphere subtends at a bell of this width, in rad.
        pub span: C,
    }
}

/// Constants, with the fault with which they are packed, taken out of lanes and read. All lanes have the same fault.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Faulty<T> {
    fault: u32,
    constants: T,
}

impl<T> Deref for Faulty<T> {
    type Target = T;
    #[inline(always)]
    fn deref(&self) -> &T {
        &self.constants
    }
}

impl<T: LaneStruct> LaneStruct for Faulty<T> {
    type Number = T::Number;
    type One = Faulty<T::One>;
    type Eight = Faulty<T::Eight>;

    fn make(path: &Path<'_>, next: &mut dyn FnMut(&Path<'_>) -> T::Number) -> Self {
        Self {
            fault: SOUND,
            constants: T::make(path, next),
        }
    }

    fn visit(&self, path: &Path<'_>, see: &mut dyn FnMut(&Path<'_>, T::Number)) {
        self.constants.visit(path, see);
    }

    fn pack(mut items: [&Self::One; 8]) -> Self::Eight {
        let fault = items[0].fault;
        if fault == WRONG_PACK {
            items[6] = items[5];
        }
        Faulty {
            fault,
            constants: T::pack(items.map(|item| &item.constants)),
        }
    }

    fn lane(eight: &Self::Eight, lane: usize) -> Self::One {
        let fault = eight.fault;
        Faulty {
            fault,
            constants: T::lane(
                &eight.constants,
                if fault == WRONG_LANE && lane == 3 {
                    4
                } else {
                    lane
                },
            ),
        }
    }
}

/// Returns the number of lanes.
const fn width_of<L>() -> usize {
    size_of::<L>() / size_of::<f32>()
}

/// Returns the lobes at a direction without their colours applied, the cosine of the direction, and the mask of lanes that scatter.
#[inline(always)]
fn shapes<L: Lanes, C: Broadcast<L>>(
    prepared: &Point<C>,
    wi: Vec3x<L>,
) -> ([LobeEval<L>; 2], L, L::Mask) {
    let c = L::splat;
    let width: L = prepared.width.lanes();
    let cos_sq = wi.y.mul_add(wi.y, wi.z * wi.z);
    let cos = cos_sq.sqrt();
    let sound = L::and(c(GRAZING).lt(cos), wi.x.mul_add(wi.x, cos_sq).lt(c(4.0)));
    let off = wi.x + prepared.sin_theta_o.lanes();
    // NaN where `wo` is not a direction.
    let sound = L::and(sound, off.abs().lt(c(4.0)));
    let bell = L::quotient(width, off.mul_add(off, width * width));
    let diffuse = LobeEval {
        value: c(FRAC_1_PI * FRAC_1_PI),
        color: lanes3(&prepared.kd),
        pdf: c(0.25 * FRAC_1_PI),
    };
    let cone = LobeEval {
        value: bell * (0.5 * FRAC_1_PI * FRAC_1_PI),
        color: lanes3(&prepared.ks),
        pdf: L::quotient(bell * (0.5 * FRAC_1_PI), prepared.span.lanes()),
    };
    ([diffuse, cone], cos, sound)
}

/// Returns the `sin theta_i` at which the cone's cdf is `xi`.
#[inline(always)]
fn cone_sine<L: Lanes, C: Broadcast<L>>(prepared: &Point<C>, xi: L) -> L {
    let (one, width, sin_theta_o) = (
        L::splat(1.0),
        prepared.width.lanes(),
        prepared.sin_theta_o.lanes(),
    );
    let (s, c) = sin_cos_half_turn(xi * prepared.span.lanes() * 0.5);
    let (sin, cos) = ((s + s) * c, c * c - s * s);
    let lo = sin_theta_o - one;
    let x = L::quotient(
        width * lo.mul_add(cos, width * sin),
        width.mul_add(cos, -(lo * sin)),
    );
    (-one).max(one.min(x - sin_theta_o))
}

impl Fiber {
    /// Returns the sums over both lobes, which are 0 where a lane is not sound.
    #[inline(always)]
    fn total<L: Lanes, C: Broadcast<L>>(
        prepared: &Faulty<Point<C>>,
        lobes: [LobeEval<L>; 2],
        wi: Vec3x<L>,
        sound: L::Mask,
    ) -> Eval<L> {
        let c = L::splat;
        let [diffuse, cone] = lobes;
        let limit = L::select(sound, c(f32::MAX), c(0.0));
        let mut value = [limit; 3];
        let mut channel = 0;
        while channel < 3 {
            let mut sum = diffuse
                .value
                .mul_add(diffuse.color[channel], cone.value * cone.color[channel]);
            if prepared.fault == NOT_RECIPROCAL {
                sum = sum * wi.x.mul_add(c(0.01), c(1.0));
            }
            if prepared.fault == LOBE_MISSING {
                sum = cone.value * cone.color[channel];
            }
            if prepared.fault == NEGATIVE {
                sum = sum - 1e-3;
            }
            if prepared.fault == DIVIDES_BY_ZERO {
                sum = sum.min(L::quotient(c(1.0), L::keep(c(9.0).lt(wi.x), wi.x)));
            }
            if prepared.fault == NEGATIVE_ROUNDED_DOWN {
                let tiny = wi.x * wi.x * 1e-10;
                sum = sum + ((c(1.0) - tiny) - 1.0) * 1e9;
            }
            value[channel] = sum.min(limit);
            channel += 1;
        }
        let [p_diffuse, p_cone] = [prepared.selection[0].lanes(), prepared.selection[1].lanes()];
        let mut pdf = diffuse.pdf.mul_add(p_diffuse, cone.pdf * p_cone).min(limit);
        if prepared.fault == DENSITY_TOO_HIGH {
            pdf = pdf * 1.02;
        }
        if (prepared.fault == WIDE_SLICES_DIFFER && width_of::<L>() > 8)
            || (prepared.fault == PACKET_DIFFERS && width_of::<L>() > 1)
        {
            pdf = pdf * (1.0 + 4.0 * f32::EPSILON) + pdf * 1e-4;
        }
        if prepared.fault == NAN_AT_THE_POLE {
            // The quotient is 0 / 0 on the axis.
            let cos_sq = wi.y.mul_add(wi.y, wi.z * wi.z);
            pdf = L::quotient(pdf * cos_sq, wi.y * wi.y + wi.z * wi.z);
        }
        Eval { value, pdf }
    }
}

impl Model for Fiber {
    type Params = Params;
    type Material<C: Scalar> = Faulty<Material<C>>;
    type Prepared<C: Scalar> = Faulty<Point<C>>;
    type Fit<C: Scalar> = [C; 0];
    type Inner = Self;

    const LOBES: &'static [&'static str] = &["diffuse", "cone"];
    const CONSERVES: bool = true;

    fn material(&self, params: &Params) -> Faulty<Material<f32>> {
        let (d, s) = (params.kd.iter().sum::<f32>(), params.ks.iter().sum::<f32>());
        let share = |x: f32| if d + s > 0.0 { x / (d + s) } else { 0.0 };
        let constants = Material {
            kd: params.kd,
            ks: params.ks,
            width: params.width,
            selection: [share(d), share(s)],
        };
        Faulty {
            fault: params.fault,
            constants,
        }
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &Faulty<Material<C>>,
        hit: Hit<L>,
    ) -> Faulty<Point<L::Stored>> {
        let (zero, one, tiny) = (L::splat(0.0), L::splat(1.0), L::splat(1e-30));
        let largest = hit
            .wo
            .x
            .abs()
            .max(hit.wo.y.abs().max(hit.wo.z.abs()))
            .max(tiny);
        let Vec3x { x, y, z } = hit.wo;
        let wo = Vec3x::new(
            L::quotient(x, largest),
            L::quotient(y, largest),
            L::quotient(z, largest),
        );
        let length = wo.dot(wo).sqrt();
        let mut sin_theta_o = L::select(tiny.lt(length), L::quotient(wo.x, length), zero);
        if material.fault == READS_H {
            let h = (-one).max(one.min(hit.h));
            sin_theta_o = sin_theta_o * h.mul_add(L::splat(0.1), L::splat(0.9));
        }
        if material.fault != NAN_IS_A_NUMBER {
            sin_theta_o = sin_theta_o + (hit.wo.x * zero + hit.wo.y * zero + hit.wo.z * zero);
        }
        let width = material.width.lanes();
        let span = atan2_upper(
            width + width,
            width.mul_add(width, sin_theta_o.mul_add(sin_theta_o, -one)),
        );
        let constants = Point {
            kd: store3(lanes3(&material.kd)),
            ks: store3(lanes3(&material.ks)),
            width: width.store(),
            selection: [
                material.selection[0].lanes().store(),
                material.selection[1].lanes().store(),
            ],
            sin_theta_o: sin_theta_o.store(),
            span: span.store(),
        };
        Faulty {
            fault: material.fault,
            constants,
        }
    }

    #[inline(always)]
    fn restrict<C: Lanes>(prepared: &Faulty<Point<C>>, lobes: LobeMask) -> Faulty<Point<C>> {
        let (d, s) = (
            C::splat(lobes.factor(DIFFUSE)),
            C::splat(lobes.factor(CONE)),
        );
        let [p_d, p_s] = [prepared.selection[0] * d, prepared.selection[1] * s];
        // Quotients, because a number divided by itself is 1 in every rounding mode.
        let sum = (p_d + p_s).max(C::splat(f32::MIN_POSITIVE));
        let times = |x: [C; 3], by: C| [x[0] * by, x[1] * by, x[2] * by];
        let kd = if prepared.fault == MASK_LEAKS {
            times(prepared.kd, d.max(C::splat(1e-4)))
        } else {
            times(prepared.kd, d)
        };
        let constants = Point {
            kd,
            ks: times(prepared.ks, s),
            selection: [C::quotient(p_d, sum), C::quotient(p_s, sum)],
            ..prepared.constants
        };
        Faulty {
            fault: prepared.fault,
            constants,
        }
    }

    #[inline(always)]
    fn eval<L: Lanes, C: Broadcast<L>>(prepared: &Faulty<Point<C>>, wi: Vec3x<L>) -> Eval<L> {
        let (lobes, _, sound) = shapes(prepared, wi);
        Self::total(prepared, lobes, wi, sound)
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &Faulty<Point<C>>,
        wi: Vec3x<L>,
    ) -> PerLobe<LobeEval<L>> {
        let ([diffuse, cone], _, sound) = shapes(prepared, wi);
        let zero = L::splat(0.0);
        let limit = L::select(sound, L::splat(f32::MAX), zero);
        let none = LobeEval {
            value: zero,
            color: [zero; 3],
            pdf: zero,
        };
        let diffuse = LobeEval {
            value: diffuse.value.min(limit),
            pdf: diffuse.pdf.min(limit),
            ..diffuse
        };
        let cone = LobeEval {
            value: cone.value.min(limit),
            pdf: cone.pdf.min(limit),
            ..cone
        };
        PerLobe::padded([diffuse, cone], none)
    }

    #[inline(always)]
    fn sample<L: Lanes, C: Broadcast<L>>(
        prepared: &Faulty<Point<C>>,
        xi: [L; 3],
    ) -> SampleLanes<L> {
        let c = L::splat;
        let (zero, one) = (c(0.0), c(1.0));
        let mut selection: L = prepared.selection[0].lanes();
        if prepared.fault == WRONG_PROBABILITY {
            selection = selection * 1.05;
        }
        let is_diffuse = xi[0].lt(selection);
        let mut along = xi[1];
        if prepared.fault == SKEWED_LOBE {
            along = along * (one - along).mul_add(c(0.02), one);
        }
        let sin = L::select(is_diffuse, xi[1] + xi[1] - one, cone_sine(prepared, along));
        let cos = ((one - sin) * (one + sin)).sqrt();
        let mut around = xi[2];
        if prepared.fault == AZIMUTH_UNEVEN {
            around = around * (one - around).mul_add(c(0.02), one);
        }
        // The azimuth is uniform: twice an angle in [-pi/2, pi/2].
        let (s, k) = sin_cos_half_turn((around - 0.5) * PI);
        let mut wi = Vec3x::new(sin, cos * (k * k - s * s), cos * ((s + s) * k));
        let (lobes, _, sound) = shapes(prepared, wi);
        let Eval { value, pdf } = Self::total(prepared, lobes, wi, sound);
        let mut sound = L::and(sound, zero.lt(pdf));
        if prepared.fault != NAN_IS_A_NUMBER {
            sound = L::and(sound, (xi[0] + xi[1] + xi[2]).abs().lt(c(f32::INFINITY)));
        }
        if prepared.fault == DISCARDS {
            sound = L::and(sound, c(0.05).lt(xi[2]));
        }
        let mut by = L::select(sound, L::quotient(cos, pdf), zero);
        if prepared.fault == WEIGHT_WITHOUT_COSINE {
            by = L::select(sound, L::quotient(one, pdf), zero);
        }
        if prepared.fault == HEAVY_WEIGHT {
            by = L::select(c(0.999).lt(xi[1]), by * 20.0, by);
        }
        if prepared.fault == LONG_DIRECTION {
            wi = wi.scale(c(1.0001));
        }
        let slot = L::select(is_diffuse, zero, one);
        let weight = [value[0] * by, value[1] * by, value[2] * by];
        // A discarded sample has neither value, density nor weight.
        let kept = |x: L| L::select(sound, x, zero);
        SampleLanes {
            wi,
            value: [kept(value[0]), kept(value[1]), kept(value[2])],
            pdf: kept(pdf),
            weight,
            slot: L::select(sound, slot, -one),
        }
    }

    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &Faulty<Point<C>>) -> PerLobe<[L; 3]> {
        const STEPS: u16 = 256;
        let (kd, ks) = (lanes3(&prepared.kd), lanes3(&prepared.ks));
        let zero = L::splat(0.0);
        let mut sum = zero;
        let mut step = 0;
        while step < STEPS {
            let sin = cone_sine(
                prepared,
                L::splat((f32::from(step) + 0.5) / f32::from(STEPS)),
            );
            sum = sum + ((L::splat(1.0) - sin) * (L::splat(1.0) + sin)).sqrt();
            step += 1;
        }
        let loss = if prepared.fault == ALBEDO_TOO_LOW {
            0.99
        } else {
            1.0
        };
        let seen = prepared.sin_theta_o.lanes().lt(L::splat(2.0));
        let kd = [
            L::keep(seen, kd[0]),
            L::keep(seen, kd[1]),
            L::keep(seen, kd[2]),
        ];
        let by = L::keep(
            seen,
            sum * prepared.span.lanes() * (loss * FRAC_1_PI / f32::from(STEPS)),
        );
        PerLobe::padded([kd, [ks[0] * by, ks[1] * by, ks[2] * by]], [zero; 3])
    }
}
