//! The vector layer by itself, and what hits are made of: work that no model does.

use crate::support::Draws;
use glam::Vec3;
use hairis::model::{Direction, Model};
use hairis::simd::{Broadcast, Choice, Kernel, LaneStruct, Lanes, Level, Path, Row, Vec3x, f32x8};
use hairis::{FiberFrame, Gaussian, HairParams, Hit, Matched, Published};
use std::collections::HashSet;

/// Search of eight numbers among three bounds, and the entries of tables there.
struct Search<'a, C> {
    x: &'a f32x8,
    bounds: [f32; 3],
    table: &'a [C; 4],
    count: usize,
}

macro_rules! search {
    ($($C:ty)*) => { $(
        impl Kernel for Search<'_, $C> {
            type Output = [f32x8; 4];

            #[inline(always)]
            fn run<L: Lanes<Stored = f32x8>>(self) -> [f32x8; 4] {
                let [a, b, c] = self.bounds;
                let index = L::Index::search(
                    self.x.lanes(),
                    [a.lanes(), b.lanes(), c.lanes()],
                    self.count,
                );
                let [first, second, third, _] = *self.table;
                let table = [first, second, third, third];
                [
                    index.to_number().store(),
                    <$C as Broadcast<L>>::look_up(self.table, index).store(),
                    <$C as Broadcast<L>>::look_up_three(&table, index).store(),
                    <$C as Broadcast<L>>::look_up_half(&[first, second], index).store(),
                ]
            }
        }
    )* };
}
search! { f32 f32x8 }

#[test]
fn search_counts_bounds_and_tables_answer_by_index() {
    let numbers = [-1.0, 0.0, 0.1, 0.25, 0.5, 0.75, 0.9, f32::NAN];
    let bounds = [0.1, 0.5, 0.9];
    let one = [3.0_f32, 5.0, 7.0, 11.0];
    let eight = one.map(|x| f32x8::new(core::array::from_fn(|lane| x + 100.0 * lane as f32)));
    for level in Level::available() {
        for count in 0..4 {
            let x = f32x8::new(numbers);
            let alike = level.run(Search {
                x: &x,
                bounds,
                table: &one,
                count,
            });
            let apart = level.run(Search {
                x: &x,
                bounds,
                table: &eight,
                count,
            });
            for (lane, x) in numbers.into_iter().enumerate() {
                let index = bounds
                    .iter()
                    .take(count)
                    .filter(|bound| x >= **bound)
                    .count();
                let want = [index as f32, one[index], one[index.min(2)], one[index / 2]];
                let place = format!("{level}, {x} among {count} bounds");
                assert_eq!(alike.map(|a| a.to_array()[lane]), want, "{place}");
                let offset = [0.0, 100.0, 100.0, 100.0].map(|step| step * lane as f32);
                assert_eq!(
                    apart.map(|a| a.to_array()[lane]),
                    [0, 1, 2, 3].map(|k| want[k] + offset[k]),
                    "{place}"
                );
            }
        }
    }
}

/// Sums and differences of three columns.
#[derive(Clone, Copy)]
struct Sums;

impl Row<3, 2> for Sums {
    #[inline(always)]
    fn row<L: Lanes>(self, [a, b, c]: [L; 3]) -> [L; 2] {
        [a + b + c, a - b - c]
    }
}

#[test]
fn choices_of_one_lane_are_those_of_its_masks() {
    let table = [1.0_f32, 2.0, 3.0, 4.0];
    for index in 0..4_usize {
        let masks: [bool; 3] = Choice::<f32>::masks(index);
        assert_eq!(masks, [index >= 1, index >= 2, index >= 3]);
        let three = [table[0], table[1], table[2], table[2]];
        let half = [table[0], table[2]];
        assert_eq!(index.choose(table), f32::look_up(&table, index));
        assert_eq!(
            index.choose_three([1.0, 2.0, 3.0]),
            index.look_up_three(&three)
        );
        assert_eq!(index.choose_half(half), index.look_up_half(&half));
    }
}

/// Divides four numbers, and takes their roots.
struct Four;

impl Kernel for Four {
    type Output = [[f32x8; 4]; 2];

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> Self::Output {
        let c = L::splat;
        let (a, b) = (
            [c(1.0), c(2.0), c(3.0), c(0.7)],
            [c(3.0), c(-7.0), c(0.1), c(1e-3)],
        );
        let [quotients, roots] = [L::four_quotients(a, b), L::four_roots(a)];
        [
            [
                quotients[0].store(),
                quotients[1].store(),
                quotients[2].store(),
                quotients[3].store(),
            ],
            [
                roots[0].store(),
                roots[1].store(),
                roots[2].store(),
                roots[3].store(),
            ],
        ]
    }
}

#[test]
fn four_numbers_have_the_quotients_and_roots_of_each() {
    let (a, b) = ([1.0, 2.0, 3.0, 0.7_f32], [3.0, -7.0, 0.1, 1e-3]);
    let [quotients, roots] = [f32::four_quotients(a, b), f32::four_roots(a)];
    for place in 0..4 {
        assert_eq!(quotients[place], a[place] / b[place]);
        assert_eq!(roots[place], a[place].sqrt());
    }
    for level in Level::available() {
        let [of_level, roots_of_level] = level.run(Four);
        for place in 0..4 {
            assert_eq!(of_level[place], f32x8::splat(quotients[place]), "{level}");
            assert_eq!(roots_of_level[place], f32x8::splat(roots[place]), "{level}");
        }
    }
}

#[test]
fn rows_of_any_length_are_computed_once_each_and_nothing_else_is_written() {
    let mut draws = Draws(5);
    let columns: [Vec<f32>; 3] = core::array::from_fn(|_| (0..100).map(|_| draws.xi()).collect());
    for level in Level::available() {
        for len in 0..=97 {
            let [a, b, c] = [
                &columns[0][..len],
                &columns[1][1..][..len],
                &columns[2][2..][..len],
            ];
            let mut out = [vec![-1.0_f32; 110], vec![-1.0_f32; 110]];
            let [first, second] = &mut out;
            level.run_rows(
                Sums,
                [a, b, c],
                &mut [&mut first[3..][..len], &mut second[5..][..len]],
            );
            for i in 0..len {
                assert_eq!(
                    out[0][3 + i],
                    a[i] + b[i] + c[i],
                    "{level}, row {i} of {len}"
                );
                assert_eq!(
                    out[1][5 + i],
                    a[i] - b[i] - c[i],
                    "{level}, row {i} of {len}"
                );
            }
            let rest = out[0]
                .iter()
                .enumerate()
                .filter(|(i, _)| !(3..3 + len).contains(i));
            assert!(
                rest.into_iter().all(|(_, x)| *x == -1.0),
                "{level}: written beyond {len} rows"
            );
        }
    }
}

#[test]
fn offsets_have_the_sign_of_the_turn_from_the_normal_to_wo() {
    let mut draws = Draws(6);
    for _ in 0..1000 {
        let mut vector = || Vec3::new(draws.xi() - 0.5, draws.xi() - 0.5, draws.xi() - 0.5);
        let (frame, normal, wo) = (FiberFrame::from_tangent(vector()), vector(), vector());
        let h = frame.offset(normal, wo);
        let across = |v: Vec3| (v - frame.u * v.dot(frame.u)).normalize();
        let want = frame.u.dot(across(normal).cross(across(wo)));
        assert!(
            (h - want).abs() < 1e-5,
            "{frame:?}, normal {normal}, wo {wo}: {h}, not {want}"
        );
        assert!(
            (frame.offset(normal * 1e30, wo * 1e-30) - want).abs() < 1e-5,
            "any length"
        );
        assert!(
            (frame.offset(wo, normal) + want).abs() < 1e-5,
            "the other way round"
        );
    }
    let frame = FiberFrame {
        u: Vec3::X,
        v: Vec3::Y,
        w: Vec3::Z,
    };
    for odd in [Vec3::ZERO, Vec3::X, Vec3::NAN, Vec3::INFINITY] {
        assert_eq!(
            (frame.offset(odd, Vec3::Y), frame.offset(Vec3::Y, odd)),
            (0.0, 0.0),
            "{odd}"
        );
    }
}

#[test]
fn hits_clamp_their_offset() {
    for (h, want) in [
        (0.3, 0.3),
        (-1.0, -1.0),
        (7.0, 1.0),
        (-f32::INFINITY, -1.0),
        (f32::INFINITY, 1.0),
        (f32::NAN, 0.0),
    ] {
        assert_eq!(Hit::new(Vec3::Y, h).h, want, "{h}");
        let wo = hairis::Vec3x8::splat(Vec3::Y);
        assert_eq!(
            Hit::new(wo, f32x8::splat(h)).h,
            f32x8::splat(want),
            "{h}, eight lanes"
        );
    }
}

#[test]
fn any_finite_vector_has_a_direction() {
    let mut draws = Draws(7);
    for _ in 0..20_000 {
        let scale = 10.0_f32.powf(76.0 * draws.xi() - 38.0);
        let mut number = || (2.0 * draws.xi() - 1.0) * if draws.xi() < 0.3 { 1e-6 } else { 1.0 };
        let v = [number(), number(), number()];
        let truth = v.map(|x| f64::from(x * scale));
        let length = truth.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length < 1e-36 {
            continue;
        }
        let Direction {
            vector,
            sin_theta,
            cos_theta,
            ..
        } = Direction::normalized(Vec3x::from(Vec3::from(v) * scale));
        let got = [vector.x, vector.y, vector.z].map(f64::from);
        for (got, want) in got.into_iter().zip(truth) {
            // The length, its inverse and the product are rounded.
            assert!(
                (got - want / length).abs() < 1.8e-7,
                "{v:?} times {scale}: {got}, not {}",
                want / length
            );
        }
        let cos = truth[1].hypot(truth[2]) / length;
        // Three roundings.
        assert!(
            (f64::from(cos_theta) - cos).abs() < 1.8e-7 && sin_theta == vector.x,
            "{v:?} times {scale}"
        );
    }
    let zero = Direction::normalized(Vec3x::<f32>::from(Vec3::ZERO));
    assert_eq!(
        (Vec3::from(zero.vector), zero.cos_theta),
        (Vec3::Y, 1.0),
        "zero counts as v"
    );
    assert_eq!(
        Direction::normalized(Vec3x::<f32>::from(Vec3::X)).cos_theta,
        0.0,
        "along the fibre"
    );
}

/// Hands a function of its lanes out of the call.
struct Escape;

impl Kernel for Escape {
    type Output = fn([f32; 8]) -> [f32; 8];

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> Self::Output {
        |x| {
            let x: L = f32x8::new(x).lanes();
            (x * 2.0 - 1.0).sqrt().store().to_array()
        }
    }
}

#[test]
fn lanes_work_outside_the_call_that_they_came_from() {
    // A level is found on this CPU: its instructions are there for good, on every thread, if slow
    // in a plain build.
    for level in Level::available() {
        let function = level.run(Escape);
        let roots = std::thread::spawn(move || function([5.0; 8])).join();
        assert_eq!(roots.expect("no panic"), [3.0; 8], "{level}");
    }
}

/// Flattens the constants of a default material at a hit, and builds them again. Their number.
fn flatten<M: Model<Params = HairParams>>(model: M) -> usize {
    let material = model.material(&HairParams::default());
    let prepared = M::prepare_one(&material, Vec3::new(0.6, 0.8, 0.0).into());
    let (mut names, mut numbers) = (HashSet::new(), Vec::new());
    prepared.visit(&Path::Root, &mut |path, number| {
        assert!(names.insert(path.to_string()), "{path} is there twice");
        numbers.push(number);
    });
    assert!(names.contains("view.lobes.color_tt[2]"), "{names:?}");
    let mut next = numbers.iter();
    let again = M::Prepared::<f32>::make(&Path::Root, &mut |path| {
        assert!(names.remove(&path.to_string()), "{path} was not visited");
        *next.next().expect("as many as were visited")
    });
    assert!(names.is_empty(), "{names:?} were left out");
    assert_eq!(format!("{again:?}"), format!("{prepared:?}"), "the same");
    numbers.len()
}

#[test]
fn constants_are_rebuilt_from_their_numbers() {
    let floats = |bytes: usize| bytes / size_of::<f32>();
    type Prepared<M> = <M as Model>::Prepared<f32>;
    assert_eq!(
        flatten(Published(Gaussian)),
        floats(size_of::<Prepared<Published<Gaussian>>>())
    );
    assert_eq!(
        flatten(Matched::<_, 5>(Gaussian)),
        floats(size_of::<Prepared<Matched<Gaussian, 5>>>())
    );
}
