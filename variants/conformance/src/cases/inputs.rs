//! Strategies for the inputs of properties.

use super::case::{Choice, Choices};
use crate::probe::{Direction, LAST, direction, hits, masks, narrow};
use crate::strategies::vectors;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::{Hit, LobeMask};
use proptest::array::{uniform3, uniform8};
use proptest::prelude::*;
use proptest::sample::select;

/// Direction itself, or the direction sampled with these numbers if that sample is kept.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Aim {
    At(Direction),
    Lobe([f32; 3], Direction),
}

/// Rows whose directions are not sampled yet, lobes, and order of lanes.
pub(crate) type Drawn = ([(Choice, Hit, Aim, [f32; 3]); 8], LobeMask, [usize; 8]);

/// Kinds of inputs, from everyday ones to non-finite ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Inputs {
    /// Unit directions, uniform in their angles, and numbers in [0, 1).
    Everyday,
    /// Everyday directions, and numbers at the ends of their range more often than chance.
    Ends,
    /// Unit directions and numbers, with the axes, grazing hits and the ends of every range more often than chance.
    Awkward,
    /// Finite vectors and numbers at which arithmetic tends to fail.
    Finite,
    /// Vectors and numbers with at least one component that is NaN or infinite.
    NotNumbers,
}

/// Components at which arithmetic tends to fail.
const COMPONENTS: [f32; 22] = [
    0.0,
    -0.0,
    1e-45,
    -1e-40,
    f32::MIN_POSITIVE,
    -1e-30,
    1e-20,
    -1e-19,
    1e-10,
    9.9e-6,
    -1.01e-5,
    1e-3,
    0.6,
    -0.8,
    LAST,
    1.0,
    -1.0,
    1.0 + f32::EPSILON,
    2.0,
    -1e19,
    1e30,
    f32::MAX,
];

/// Uniform numbers at the ends and the middle of their range. The last number is beyond the range, but rounding may produce it.
const NUMBERS: [f32; 12] = [
    0.0,
    1e-45,
    1e-30,
    f32::EPSILON / 2.0,
    1e-4,
    0.25,
    0.5 - f32::EPSILON / 4.0,
    0.5,
    0.5 + f32::EPSILON / 2.0,
    0.9999,
    LAST,
    1.0,
];

/// Draws a multiple of `2^-24` in `[0, 1)`.
fn uniform() -> impl Strategy<Value = f32> {
    (0..1_u32 << 24).prop_map(|n| n as f32 / 16_777_216.0)
}

/// Draws any direction, uniform in its angles: as many next to the axis as elsewhere.
fn any_direction() -> impl Strategy<Value = Direction> {
    (-FRAC_PI_2..FRAC_PI_2, -PI..PI).prop_map(|(theta, phi)| direction(theta, phi))
}

/// Draws a direction next to the axis.
fn grazing() -> impl Strategy<Value = Direction> {
    let off = select(vec![
        0.0, 1e-20, 1e-12, 1e-7, 0.99e-5, 1.01e-5, 1e-4, 1e-2_f32,
    ]);
    let [sign, other, along] = [0, 1, 2].map(|_| any::<bool>());
    (off, sign, other, along).prop_map(|(off, sign, other, along)| {
        let x = (1.0 - off * off).sqrt();
        let (x, y) = (if along { -x } else { x }, if sign { -off } else { off });
        if other {
            Direction::new(x, 0.0, y)
        } else {
            Direction::new(x, y, 0.0)
        }
    })
}

/// Draws a direction along an axis, or in a plane of two.
fn axes() -> impl Strategy<Value = Direction> {
    let vectors = [
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [-0.6, 0.0, -0.8],
        [0.6, 0.8, 0.0],
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
    ];
    select(vectors.map(Direction::from_array).to_vec())
}

/// Draws a finite vector of any length.
fn vector() -> impl Strategy<Value = Direction> {
    let component = || select(COMPONENTS.to_vec());
    let around = select(vec![0.0, 0.5 * PI, PI]);
    prop_oneof![
        1 => any_direction(),
        1 => grazing(),
        1 => (-1.6..1.6, around).prop_map(|(theta, phi)| direction(theta, phi)),
        2 => uniform3(component()).prop_map(Direction::from_array),
        2 => vectors(),
    ]
}

/// Replaces one or more of three numbers by other values.
fn spoilt(
    sound: impl Strategy<Value = [f32; 3]> + 'static,
    values: &[f32],
) -> BoxedStrategy<[f32; 3]> {
    let places =
        uniform3(prop_oneof![2 => Just(None), 1 => select(values.to_vec()).prop_map(Some)]);
    let first = (0..3_usize, select(values.to_vec()));
    let spoil = |(mut v, (place, value), places): ([f32; 3], _, [Option<f32>; 3])| {
        for (x, other) in v.iter_mut().zip(places) {
            *x = other.unwrap_or(*x);
        }
        v[place] = value;
        v
    };
    (sound, first, places).prop_map(spoil).boxed()
}

impl Inputs {
    fn direction(self) -> BoxedStrategy<Direction> {
        match self {
            Self::Everyday | Self::Ends => {
                let tilted = hits().map(|hit| Direction::from(hit.wo)).to_vec();
                prop_oneof![6 => any_direction(), 1 => select(tilted)].boxed()
            }
            Self::Awkward => prop_oneof![6 => any_direction(), 1 => axes(), 1 => grazing()].boxed(),
            Self::Finite => vector().boxed(),
            Self::NotNumbers => {
                let by = select(vec![1.0, 0.0, 1e-35, 1e37_f32]);
                let sound = (any_direction(), by).prop_map(|(v, by)| (v * by).to_array());
                let odd = [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
                spoilt(sound, &odd).prop_map(Direction::from_array).boxed()
            }
        }
    }

    fn offset(self) -> BoxedStrategy<f32> {
        let any = || (-1.0..1.0).prop_map(narrow);
        match self {
            Self::Everyday | Self::Ends | Self::NotNumbers => any().boxed(),
            Self::Awkward => {
                prop_oneof![4 => any(), 1 => select(vec![0.0, -0.0, 1.0, -1.0, LAST])].boxed()
            }
            Self::Finite => {
                select(vec![0.0, -0.0, 1.0, -1.0, 1e-40, 0.3, LAST, -1.5, 1e30]).boxed()
            }
        }
    }

    fn numbers(self) -> BoxedStrategy<[f32; 3]> {
        let within = NUMBERS[..NUMBERS.len() - 1].to_vec();
        match self {
            Self::Everyday => uniform3(uniform()).boxed(),
            Self::Ends | Self::Awkward => {
                uniform3(prop_oneof![4 => uniform(), 1 => select(within)]).boxed()
            }
            Self::Finite => uniform3(prop_oneof![uniform(), select(NUMBERS.to_vec())]).boxed(),
            Self::NotNumbers => spoilt(uniform3(uniform()), &[f32::NAN]),
        }
    }

    /// Aims half of the unit directions at the lobes.
    fn aim(self) -> BoxedStrategy<Aim> {
        let anywhere = self.direction().prop_map(Aim::At);
        match self {
            Self::Everyday | Self::Ends | Self::Awkward => {
                let lobe = (self.numbers(), any_direction());
                prop_oneof![anywhere, lobe.prop_map(|(xi, wi)| Aim::Lobe(xi, wi))].boxed()
            }
            Self::Finite | Self::NotNumbers => anywhere.boxed(),
        }
    }

    /// Draws cases with these materials.
    pub(crate) fn cases(self, choices: Choices) -> impl Strategy<Value = Drawn> {
        let hit = (self.direction(), self.offset()).prop_map(|(wo, h)| Hit { wo: wo.into(), h });
        let row = (choices, hit, self.aim(), self.numbers());
        let lobes = prop_oneof![Just(LobeMask::ALL), select(masks())];
        let order = Just([0, 1, 2, 3, 4, 5, 6, 7]).prop_shuffle();
        (uniform8(row), lobes, order)
    }
}
