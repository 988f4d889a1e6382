//! A model of two lobes: `S = kd / pi^2 + ks c(sin theta_i + sin theta_o) / (2 pi)`, with `c` the
//! Cauchy density of width `w`. The first is sampled uniformly, the cone by its density on the sphere.

use core::f32::consts::FRAC_1_PI;
use hairis::model::math::{atan2_upper, sin_cos_half_turn};
use hairis::model::{Direction, LobeEval, LobeModel};
use hairis::simd::{Broadcast, Choice, Lanes, Scalar, lane_struct, lanes3};
use hairis::{Hit, PerLobe};

#[derive(Clone, Copy, Debug)]
pub(crate) struct LambertFiber;

lane_struct! {
    /// A material: colours of the lobes, linear RGB, and width of the cone in `sin theta`. A real
    /// model would check them.
    pub(crate) struct Fiber { pub(crate) kd: [C; 3], pub(crate) ks: [C; 3], pub(crate) width: C, }
}
lane_struct! {
    /// A hit. The density of the cone is uniform over the angle `span`.
    pub(crate) struct Point { fiber: Fiber<C>, sin_theta_o: C, span: C, }
}

impl LobeModel for LambertFiber {
    type Params = Fiber<f32>;
    type Material<C: Scalar> = Fiber<C>;
    type Prepared<C: Scalar> = Point<C>;
    const LOBES: &'static [&'static str] = &["diffuse", "cone"];

    fn material(&self, fiber: &Fiber<f32>) -> Fiber<f32> {
        *fiber
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(f: &Fiber<C>, hit: Hit<L>) -> Point<L::Stored> {
        let (sin, width): (L, L) = (Direction::normalized(hit.wo).sin_theta, f.width.lanes());
        let along = width.mul_add(width, sin.mul_add(sin, L::splat(-1.0)));
        let (sin_theta_o, span) = (sin.store(), atan2_upper(width + width, along).store());
        let fiber = f.spread::<L>();
        Point {
            fiber,
            sin_theta_o,
            span,
        }
    }

    #[inline(always)]
    fn weights<L: Lanes, C: Broadcast<L>>(p: &Point<C>) -> PerLobe<L> {
        let ([r, g, b], [kr, kg, kb]) = (lanes3(&p.fiber.kd), lanes3(&p.fiber.ks));
        PerLobe::padded([r + g + b, kr + kg + kb], L::splat(0.0))
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(p: &Point<C>, wi: &Direction<L>) -> PerLobe<LobeEval<L>> {
        let (width, off) = (p.fiber.width.lanes(), wi.sin_theta + p.sin_theta_o.lanes());
        let bell = L::quotient(width, off.mul_add(off, width * width)) * (0.5 * FRAC_1_PI);
        let (flat, even) = (L::splat(FRAC_1_PI * FRAC_1_PI), L::splat(0.25 * FRAC_1_PI));
        let (kd, ks) = (lanes3(&p.fiber.kd), lanes3(&p.fiber.ks));
        let pdf = L::quotient(bell, p.span.lanes());
        let diffuse = LobeEval::new(flat, kd, even);
        let cone = LobeEval::new(bell * FRAC_1_PI, ks, pdf);
        PerLobe::padded([diffuse, cone], LobeEval::none())
    }

    #[inline(always)]
    fn sample_lobe<L: Lanes, C: Broadcast<L>>(
        p: &Point<C>,
        lobe: L::Index,
        xi: [L; 3],
    ) -> Direction<L> {
        let (one, width, sin_o) = (L::splat(1.0), p.fiber.width.lanes(), p.sin_theta_o.lanes());
        // The cone: width tan(lo + xi span) - sin theta_o, without a tangent.
        let (s, c) = sin_cos_half_turn(xi[1] * p.span.lanes() * 0.5);
        let (sin, cos, lo) = ((s + s) * c, c * c - s * s, sin_o - 1.0);
        let above = width * lo.mul_add(cos, width * sin);
        let x = L::quotient(above, width.mul_add(cos, -(lo * sin)));
        let cone = (-one).max(one.min(x - sin_o));
        let sin = L::select(lobe.equals(0), xi[1] + xi[1] - 1.0, cone);
        Direction::with_uniform_azimuth([sin, ((one - sin) * (one + sin)).sqrt()], xi[2])
    }
}
