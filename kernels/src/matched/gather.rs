//! What a matched sampler keeps of a material, and of a material seen from one direction.

use super::warp::{END_SHARE, NEAR_END, Side, node};
use super::{MatchedBell, Truncated};
use crate::hair::albedo::residual;
use crate::hair::{Shapes, prepare_point, selection, times};
use crate::lanes::{store3, store4};
use crate::{Broadcast, HairLobes, HairParams, HairPoint, Lanes, Lobe, LobeMask, Vec3x};
use core::f32::consts::{FRAC_PI_4, PI};
use wide::f32x8;

/// Energies below this share of the largest are none: next to denormals their reciprocal would have no digits.
const LEAST_ENERGY: f32 = 1e-36;

/// Intensities below this share of the largest are none to the sampler.
const LEAST_IMPORTANCE: f64 = 1e-25;

/// Heights are at least this share of W at a third of the way to the other pole.
const LEAST_HEIGHT: f32 = 1e-5;

crate::lane_struct! {
    /// The constants of a material with a matched sampler.
    ///
    /// Arrays of two are TT and the glints, of four in the order of [`Lobe`].
    pub struct MatchedMaterial {
        /// Its lobes.
        pub lobes: (HairLobes<C>),
        /// Intensity of each lobe, the mean of its RGB, to the scale of the largest.
        pub importance: [C; 4],
        /// The same times what a lobe integrates to for each unit of its longitude's mass.
        pub capacity: [C; 4],
        /// Mass of the azimuth's bell on one side.
        pub azimuth_mass: [C; 2],
        /// The first of that distribution's own numbers.
        pub azimuth_end_0: [C; 2],
        /// The second.
        pub azimuth_end_1: [C; 2],
    }
}

/// The constants of a gather point with a matched sampler of `N` segments a side.
///
/// Arrays of four are in the order of [`Lobe`], of three R, TT and TRT, of two TT and the glints; in those of sides the
/// lower end is first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchedGather<C, const N: usize> {
    /// The lobes as seen from `wo`.
    pub point: HairPoint<C>,
    /// Mass of the longitude's bell on the sphere.
    pub mass: [C; 4],
    /// `1 / mass`, or 0.
    pub inv_mass: [C; 4],
    /// That distribution's own two numbers.
    pub ends: [[C; 4]; 2],
    /// Heights of the warp: by side, by node from the end inwards, by lobe.
    pub outer: [[[C; 4]; N]; 2],
    /// Heights in the middle.
    pub middle: [C; 4],
    /// Area below the warp: the mean of W over the lobe.
    pub area: [C; 4],
    /// The part of it on the lower side.
    pub area_lower: [C; 4],
    /// Factor on `M N h` of each lobe in the mixture density, but for `scale`.
    pub weight: [C; 4],
    /// Factor on all of them.
    pub scale: C,
    /// Probability of choosing each lobe.
    pub selection: [C; 4],
    /// Where the next lobe begins in `xi_lobe`.
    pub bounds: [C; 3],
    /// Mass of the azimuth's bell on one side.
    pub azimuth_mass: [C; 2],
    /// That distribution's own two numbers.
    pub azimuth_ends: [[C; 2]; 2],
}

/// What each lobe integrates to, but for its colour, for each unit of its longitude's mass and of the mean of W.
#[inline(always)]
fn extent<B: MatchedBell, L: Lanes, C: Broadcast<L>>(hair: &HairLobes<C>, azimuth_mass: [L; 2]) -> [L; 4] {
    // dtheta_i is two widths for each of x; the azimuth of R and TRT-g has an area of 4, and bells have two sides.
    let unit = L::splat(2.0 * B::UNIT);
    let [r, tt, trt] = [hair.beta[0].lanes() * unit, hair.beta[1].lanes() * unit, hair.beta[2].lanes() * unit];
    let sides = L::splat(4.0 * B::UNIT);
    let azimuth_tt = hair.half_gamma[0].lanes() * azimuth_mass[0] * sides;
    let azimuth_g = hair.half_gamma[1].lanes() * azimuth_mass[1] * sides;
    let four = L::splat(4.0);
    [r * four, tt * azimuth_tt, trt * four, trt * azimuth_g]
}

impl MatchedMaterial<f32> {
    /// The material of checked parameters.
    #[inline]
    #[must_use]
    pub(super) fn of<B: MatchedBell>(bell: B, params: &HairParams) -> Self {
        let lobes = HairLobes::of(bell, params);
        let phi_g = params.desc().phi_g;
        let [inv_gamma_tt, inv_gamma_g] = lobes.inv_half_gamma.map(|inv| 0.5 * inv);
        let tt = B::truncate(0.0, PI * inv_gamma_tt);
        let glint = B::truncate(-phi_g * inv_gamma_g, (PI - phi_g) * inv_gamma_g);
        let azimuth_mass = [tt.mass, glint.mass];
        let importance = importance(params);
        Self {
            lobes,
            importance,
            capacity: times(extent::<B, f32, f32>(&lobes, azimuth_mass), importance),
            azimuth_mass,
            azimuth_end_0: [tt.ends[0], glint.ends[0]],
            azimuth_end_1: [tt.ends[1], glint.ends[1]],
        }
    }
}

/// Intensity of each lobe to the scale of the largest.
///
/// In double precision: the product of two of the largest legal intensities overflows a float.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "shares of the largest, in [0, 1]")]
fn importance(params: &HairParams) -> [f32; 4] {
    let d = params.desc();
    let mean = |rgb: [f32; 3]| rgb.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
    let trt = mean(d.intensity_trt);
    let all = [mean(d.intensity_r), mean(d.intensity_tt), trt, trt * f64::from(d.intensity_g)];
    let largest = all.iter().fold(0.0, |a: f64, i| a.max(*i));
    all.map(|i| if i > largest * LEAST_IMPORTANCE { (i / largest) as f32 } else { 0.0 })
}

/// The longitude of R, TT or TRT.
#[derive(Clone, Copy)]
struct Longitude<L, const N: usize> {
    cut: Truncated<L>,
    sides: [Side<L, N>; 2],
    area: L,
    area_lower: L,
}

/// Longitude `l` of a gather point; `theta_o` by half its sine and half its cosine.
#[inline(always)]
fn longitude<B: MatchedBell, L: Lanes, C: Broadcast<L>, const N: usize>(
    hair: &HairLobes<C>,
    l: usize,
    shift: L,
    theta_o: [L; 2],
) -> Longitude<L, N> {
    let c = L::splat;
    let (beta, inv_beta, quarter) = (hair.beta[l].lanes(), hair.inv_beta[l].lanes(), c(FRAC_PI_4));
    let cut = B::truncate((shift - quarter) * inv_beta, (shift + quarter) * inv_beta);
    let least = c(LEAST_HEIGHT) * mode_scale(theta_o[1]);
    let [x, _] = B::invert_both(&cut, 0.5);
    let middle = least.max(residual(x.mul_add(beta, -shift), theta_o));
    let (mut lower, mut upper) = (Side { outer: [middle; N], middle }, Side { outer: [middle; N], middle });
    let mut j = 1;
    while j < N {
        let [below, above] = B::invert_both(&cut, node(N, j));
        lower.outer[j] = least.max(residual(below.mul_add(beta, -shift), theta_o));
        upper.outer[j] = least.max(residual(above.mul_add(beta, -shift), theta_o));
        j += 1;
    }
    // The end has a height of its own: W is 0 there.
    let [below, above] = B::invert_both(&cut, NEAR_END);
    let share = c(END_SHARE);
    lower.outer[0] = (lower.outer[1] * share).max(residual(below.mul_add(beta, -shift), theta_o));
    upper.outer[0] = (upper.outer[1] * share).max(residual(above.mul_add(beta, -shift), theta_o));
    let area_lower = lower.area();
    Longitude { cut, sides: [lower, upper], area: area_lower + upper.area(), area_lower }
}

/// The gather point of a material seen from `wo`.
#[inline(always)]
pub(super) fn prepare<B: MatchedBell, L: Lanes, C: Broadcast<L>, const N: usize>(
    m: &MatchedMaterial<C>,
    wo: Vec3x<L>,
) -> MatchedGather<L::Stored, N> {
    let c = L::splat;
    let zero = c(0.0);
    let point = prepare_point(&m.lobes, wo);
    let theta_o = [point.half_sin_theta_o.lanes(), point.half_cos_theta_o.lanes()];
    let r = longitude::<B, L, C, N>(&m.lobes, 0, point.shift[0].lanes(), theta_o);
    let tt = longitude::<B, L, C, N>(&m.lobes, 1, point.shift[1].lanes(), theta_o);
    let trt = longitude::<B, L, C, N>(&m.lobes, 2, point.shift[2].lanes(), theta_o);
    // The glints share the longitude of TRT.
    let mass = [r.cut.mass, tt.cut.mass, trt.cut.mass, trt.cut.mass];
    let area = [r.area, tt.area, trt.area, trt.area];

    // Energies to the scale of the largest mass, which may be next to nothing where all lobes lie off the sphere.
    let capacity = [m.capacity[0].lanes(), m.capacity[1].lanes(), m.capacity[2].lanes(), m.capacity[3].lanes()];
    let mut largest = zero;
    let mut l = 0;
    while l < 4 {
        largest = largest.max(L::keep(zero.lt(capacity[l]), mass[l]));
        l += 1;
    }
    let scale = L::select(zero.lt(largest), c(1.0) / largest, zero);
    let mut energy = [zero; 4];
    l = 0;
    while l < 4 {
        let e = capacity[l] * (mass[l] * scale) * area[l];
        energy[l] = L::keep(c(LEAST_ENERGY).lt(e), e);
        l += 1;
    }
    let (p, bounds, inv_total) = selection(energy);
    let mut weight = [zero; 4];
    l = 0;
    while l < 4 {
        weight[l] = L::keep(zero.lt(energy[l]), m.importance[l].lanes() * inv_total);
        l += 1;
    }

    let mut outer = [[[r.area.store(); 4]; N]; 2];
    let mut j = 0;
    while j < N {
        outer[0][j] = shared4(r.sides[0].outer[j], tt.sides[0].outer[j], trt.sides[0].outer[j]);
        outer[1][j] = shared4(r.sides[1].outer[j], tt.sides[1].outer[j], trt.sides[1].outer[j]);
        j += 1;
    }
    MatchedGather {
        point,
        mass: store4(mass),
        inv_mass: shared4(r.cut.inv_mass, tt.cut.inv_mass, trt.cut.inv_mass),
        ends: [
            shared4(r.cut.ends[0], tt.cut.ends[0], trt.cut.ends[0]),
            shared4(r.cut.ends[1], tt.cut.ends[1], trt.cut.ends[1]),
        ],
        outer,
        middle: shared4(r.sides[0].middle, tt.sides[0].middle, trt.sides[0].middle),
        area: store4(area),
        area_lower: shared4(r.area_lower, tt.area_lower, trt.area_lower),
        weight: store4(weight),
        scale: scale.store(),
        selection: store4(p),
        bounds: store3(bounds),
        azimuth_mass: spread2::<L, C>(&m.azimuth_mass),
        azimuth_ends: [spread2::<L, C>(&m.azimuth_end_0), spread2::<L, C>(&m.azimuth_end_1)],
    }
}

/// R, TT, TRT, and for the glints TRT again.
#[inline(always)]
fn shared4<L: Lanes>(r: L, tt: L, trt: L) -> [L::Stored; 4] {
    store4([r, tt, trt, trt])
}

/// Two numbers of a material, a lane each.
#[inline(always)]
fn spread2<L: Lanes, C: Broadcast<L>>(x: &[C; 2]) -> [L::Stored; 2] {
    [x[0].lanes().store(), x[1].lanes().store()]
}

/// W a third of the way to the other pole, `(cos(theta_o / 3) / cos(2 theta_o / 3))^2`, roughly: 1 in the normal plane and 3
/// at the poles.
#[inline(always)]
fn mode_scale<L: Lanes>(half_cos_theta_o: L) -> L {
    half_cos_theta_o.mul_add(L::splat(-4.0), L::splat(3.0))
}

impl<C, const N: usize> MatchedGather<C, N> {
    /// The warp's height for longitude `l` (R, TT or TRT) at a place.
    #[inline(always)]
    pub(super) fn height<B: MatchedBell, L: Lanes>(&self, l: usize, shapes: &Shapes<L>) -> L
    where
        C: Broadcast<L>,
    {
        let cut = Truncated {
            mass: self.mass[l].lanes(),
            inv_mass: self.inv_mass[l].lanes(),
            ends: [self.ends[0][l].lanes(), self.ends[1][l].lanes()],
        };
        let (lower, v) = B::locate(&cut, shapes.offset[l], shapes.longitude[l]);
        let mut side = Side { outer: [v; N], middle: self.middle[l].lanes() };
        let mut j = 0;
        while j < N {
            side.outer[j] = L::select(lower, self.outer[0][j][l].lanes(), self.outer[1][j][l].lanes());
            j += 1;
        }
        side.at(v)
    }

    /// Factor on `M N h` of a lobe drawn alone, but for its mass.
    #[inline(always)]
    pub(super) fn lone_density<B: MatchedBell, L: Lanes>(&self) -> [L; 4]
    where
        C: Broadcast<L>,
    {
        let azimuth_mass = [self.azimuth_mass[0].lanes(), self.azimuth_mass[1].lanes()];
        let mut scale = extent::<B, L, C>(&self.point.lobes, azimuth_mass);
        let mut l = 0;
        while l < 4 {
            scale[l] = L::splat(1.0) / (scale[l] * self.area[l].lanes());
            l += 1;
        }
        scale
    }
}

impl<C: Lanes, const N: usize> MatchedGather<C, N> {
    /// The gather point with only some of its lobes.
    #[inline(always)]
    pub(super) fn restrict(&self, lobes: LobeMask) -> Self {
        let factor = Lobe::ALL.map(|lobe| C::splat(lobes.factor(lobe)));
        let (p, bounds, inv_total) = selection(times(self.selection, factor));
        let weight = times(times(self.weight, factor), [inv_total; 4]);
        Self { point: self.point.restrict(lobes), weight, selection: p, bounds, ..*self }
    }
}

impl<const N: usize> MatchedGather<f32x8, N> {
    /// The numbers of one lane.
    ///
    /// # Panics
    ///
    /// If `lane` is above 7.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize) -> MatchedGather<f32, N> {
        let at = |x: f32x8| x.as_array()[lane];
        MatchedGather {
            point: self.point.lane(lane),
            mass: self.mass.map(at),
            inv_mass: self.inv_mass.map(at),
            ends: self.ends.map(|x| x.map(at)),
            outer: self.outer.map(|side| side.map(|x| x.map(at))),
            middle: self.middle.map(at),
            area: self.area.map(at),
            area_lower: self.area_lower.map(at),
            weight: self.weight.map(at),
            scale: at(self.scale),
            selection: self.selection.map(at),
            bounds: self.bounds.map(at),
            azimuth_mass: self.azimuth_mass.map(at),
            azimuth_ends: self.azimuth_ends.map(|x| x.map(at)),
        }
    }
}
