//! The elementary functions on every level: each is evaluated by a model of its own, as a user's would.

use core::fmt::Debug;
use hairis::{Broadcast, Drawn, Eval, Hit, Lanes, LobeEval, LobeMask, Model, PerLobe, Vec3x, math};

/// A function of two numbers with two results, on the kernel's lanes and on `libm`.
pub trait Function: Copy + Default + Debug {
    /// Its name in [`hairis::math`].
    const NAME: &'static str;
    /// The ranges of its arguments.
    const RANGE: [[f32; 2]; 2];
    /// The function.
    fn lanes<L: Lanes>(x: L, y: L) -> [L; 2];
    /// The same on `libm`.
    fn libm(x: f32, y: f32) -> [f32; 2];
    /// The same in `f64`.
    fn truth(x: f64, y: f64) -> [f64; 2];
}

macro_rules! functions {
    ($($(#[$meta:meta])* $name:ident, $text:literal, [$x:expr, $y:expr];
        |$a:ident, $b:ident| $lanes:expr; $libm:expr; $truth:expr;)*) => { $(
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default)]
        pub struct $name;

        impl Function for $name {
            const NAME: &'static str = $text;
            const RANGE: [[f32; 2]; 2] = [$x, $y];
            #[inline(always)]
            fn lanes<L: Lanes>($a: L, $b: L) -> [L; 2] {
                $lanes
            }
            #[inline(always)]
            fn libm($a: f32, $b: f32) -> [f32; 2] {
                $libm
            }
            fn truth($a: f64, $b: f64) -> [f64; 2] {
                $truth
            }
        }
    )* };
}

functions! {
    /// `exp(-s/2)`.
    Bell, "gaussian", [[0.0, 40.0], [0.0, 1.0]];
    |s, zero| [math::gaussian(s), zero]; [libm::expf(-0.5 * s), zero]; [(-0.5 * s).exp(), zero];
    /// `atan t`, `|t| <= 1`.
    AtanUnit, "atan_unit", [[-1.0, 1.0], [0.0, 1.0]];
    |t, zero| [math::atan_unit(t), zero]; [libm::atanf(t), zero]; [t.atan(), zero];
    /// `atan2(y, x)`, `y >= 0`.
    Atan2Upper, "atan2_upper", [[0.0, 1.0], [-1.0, 1.0]];
    |y, x| [math::atan2_upper(y, x), x]; [libm::atan2f(y, x), x]; [y.atan2(x), x];
    /// `(sin 2x, cos 2x)`.
    SinCosTwice, "sin_cos_twice", [[-0.785, 0.785], [0.0, 1.0]];
    |x, _y| { let (sin, cos) = math::sin_cos_twice(x); [sin, cos] };
    libm::sincosf(x + x).into(); (2.0 * x).sin_cos().into();
    /// `(sin x, cos x)`.
    SinCosAbsolute, "sin_cos_absolute", [[-1.57, 1.57], [0.0, 1.0]];
    |x, _y| { let (sin, cos) = math::sin_cos_absolute(x); [sin, cos] };
    libm::sincosf(x).into(); x.sin_cos().into();
}

/// A function as a model: its arguments are the first two components of `wi`, its results the first two channels.
#[derive(Clone, Copy, Debug, Default)]
pub struct AsModel<F>(pub F);

/// Neither materials nor gather points have constants.
#[derive(Clone, Copy, Debug)]
pub struct Nothing;

impl<F: Function> Model for AsModel<F> {
    type Params = ();
    type Material<C: Copy + Debug> = Nothing;
    type Gather<C: Copy + Debug> = Nothing;

    const LOBES: &'static [&'static str] = &[F::NAME];

    fn material(&self, (): &()) -> Nothing {
        Nothing
    }
    fn pack(_: [&Nothing; 8]) -> Nothing {
        Nothing
    }
    fn lane(_: &Nothing, _: usize) -> Nothing {
        Nothing
    }
    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L> + Debug>(_: &Nothing, _: Hit<L>) -> Nothing
    where
        L::Stored: Debug,
    {
        Nothing
    }
    #[inline(always)]
    fn restrict<C: Lanes + Debug>(_: &Nothing, _: LobeMask) -> Nothing {
        Nothing
    }
    #[inline(always)]
    fn eval<L: Lanes, C: Broadcast<L> + Debug>(_: &Nothing, wi: Vec3x<L>) -> Eval<L> {
        let zero = L::splat(0.0);
        let [first, second] = F::lanes(wi.x, wi.y);
        Eval { value: [first, second, zero], pdf: zero }
    }
    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L> + Debug>(_: &Nothing, _: Vec3x<L>) -> PerLobe<LobeEval<L>> {
        let zero = L::splat(0.0);
        PerLobe([LobeEval { value: zero, color: [zero; 3], pdf: zero }; 4])
    }
    #[inline(always)]
    fn sample<L: Lanes, C: Broadcast<L> + Debug>(_: &Nothing, _: [L; 3]) -> Drawn<L> {
        let zero = L::splat(0.0);
        let none = [zero; 3];
        Drawn { wi: Vec3x::new(zero, zero, zero), value: none, pdf: zero, weight: none, slot: -L::splat(1.0) }
    }
    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L> + Debug>(_: &Nothing) -> PerLobe<[L; 3]> {
        PerLobe([[L::splat(0.0); 3]; 4])
    }
}
