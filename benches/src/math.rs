//! Elementary functions on every level, as kernels on eight lanes and as rows of columns.

use core::fmt::Debug;
use hairis::model::math;
use hairis::simd::{Broadcast, Kernel, Lanes, Row, f32x8};

/// Function of two numbers with two results, on the kernel's lanes, with `libm` and in double precision.
pub trait Function: Copy + Default + Debug {
    /// Name of the function in [`hairis::model::math`].
    const NAME: &'static str;
    /// Ranges of both arguments.
    const RANGE: [[f32; 2]; 2];
    /// Evaluates the function on the kernel's lanes.
    fn lanes<L: Lanes>(x: L, y: L) -> [L; 2];
    /// Evaluates the function with `libm`.
    fn libm(x: f32, y: f32) -> [f32; 2];
    /// Evaluates the function in `f64`.
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

/// Kernel that evaluates a function on eight pairs of arguments.
#[derive(Clone, Copy, Debug)]
pub struct Eight<'a, F: Function> {
    /// First and second arguments.
    pub arguments: &'a [f32x8; 2],
    /// Function to evaluate.
    pub function: F,
}

impl<F: Function> Kernel for Eight<'_, F> {
    type Output = [f32x8; 2];

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> [f32x8; 2] {
        let [x, y] = self.arguments;
        let [first, second] = F::lanes::<L>(x.lanes(), y.lanes());
        [first.store(), second.store()]
    }
}

/// Row that evaluates a function over columns of first and second arguments, and passes the third column through.
#[derive(Clone, Copy, Debug)]
pub struct Columns<F: Function>(pub F);

impl<F: Function> Row<3, 3> for Columns<F> {
    #[inline(always)]
    fn row<L: Lanes>(self, [x, y, zero]: [L; 3]) -> [L; 3] {
        let [first, second] = F::lanes(x, y);
        [first, second, zero]
    }
}
