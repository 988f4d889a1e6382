//! Properties of eight lanes: they give the results of one lane, whatever their position and on every level.

use crate::cases::inputs::Inputs;
use crate::cases::{Property, Trial};
use crate::comparison::relative;
use crate::erased::{ErasedBsdf8, ErasedSubject, NamedMaterial, Which};
use crate::failure::{Failure, Outcome, Worst};
use crate::near::{Nearby, sample_is_near};
use crate::probe::{cos_theta, hits8, packet, triples};
use crate::subject::Claims;
use hairis::model::LobeEval8;
use hairis::simd::{Level, f32x8};
use hairis::{Eval, Eval8, Hit, Lobe, PerLobe, Sample8};

const ORDER: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

/// Number of packets of mixed materials.
const ROUNDS: usize = 2000;

/// Makes a property of eight materials of the subject at a time.
fn mixed<'a>(
    name: &'static str,
    path: &'static str,
    subject: &'a dyn ErasedSubject,
    cases: usize,
) -> Property<'a> {
    Property {
        name,
        path,
        subject,
        which: Which::WithExtremes,
        inputs: Inputs::Awkward,
        tolerances: true,
        cases,
    }
}

/// Returns the bits of every number of one lane of a packet of samples.
pub(crate) fn sample_bits(s: &Sample8, lane: usize) -> [u32; 11] {
    let ([r, g, b], [wr, wg, wb]) = (s.value, s.weight);
    [s.wi.x, s.wi.y, s.wi.z, r, g, b, s.pdf, wr, wg, wb, s.slot]
        .map(|x| x.as_array()[lane].to_bits())
}

pub(crate) fn eval_bits(e: Eval) -> [u32; 4] {
    [e.value[0], e.value[1], e.value[2], e.pdf].map(f32::to_bits)
}

/// Returns true if a level has to give the bits of one lane.
fn same_bits(claims: &Claims, level: Level) -> bool {
    claims.same_bits && !level.fuses()
}

/// Checks that each of eight lanes, with its own material, hit, direction and numbers, gives the results of one lane. The bits are the
/// same on levels that do not fuse, and the results are close on those that do. The same holds for eight lanes at one hit, and for `lane`
/// of eight shading points.
///
/// # Errors
///
/// Returns a failure if a lane differs.
pub fn lanes_equal_scalar(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "eight lanes give the results of one";
    let claims = subject.claims();
    let quantity = ("value or density of a lane (`Claims::lanes`)", claims.lanes);
    let everyday = Property {
        inputs: Inputs::Everyday,
        ..mixed(NAME, "lanes::lanes_equal_scalar", subject, ROUNDS)
    };
    // Bits are the same at the ends of every range, but on other levels a rounding may discard a sample there.
    let awkward = Property {
        inputs: Inputs::Awkward,
        tolerances: false,
        ..everyday
    };
    let test = |m: &Trial<'_>, [worst]: &mut [Worst; 1]| {
        for level in Level::available() {
            let each = m.prepare(level, ORDER);
            let (wi, xi) = (packet(&m.wi), triples(&m.xi));
            let (evals, samples) = (
                each.with_level(level).eval_pdf8(&wi),
                each.with_level(level).sample8(&xi),
            );
            for lane in 0..8 {
                let at = || m.at(lane, level);
                let nearby = Nearby::new(m.material(lane), m.hits[lane], claims.near_field);
                let one = nearby.bsdf();
                let eight = one.with_level(level).eval_pdf8(&wi);
                let of_lane = each.lane(lane);
                let apart = of_lane.with_level(level).eval_pdf8(&wi);
                if eval_bits(apart.lane(lane)) != eval_bits(evals.lane(lane)) {
                    let message = format!(
                        "`lane` gives {:?}, the packet {:?}: {}",
                        apart.lane(lane),
                        evals.lane(lane),
                        at()
                    );
                    return Err(Failure::new(NAME, message));
                }
                let want = one.eval_pdf(m.wi[lane]);
                for got in [evals.lane(lane), eight.lane(lane)] {
                    if same_bits(&claims, level) {
                        if eval_bits(got) != eval_bits(want) {
                            return Err(Failure::new(
                                NAME,
                                format!("bits of {got:?}, one lane {want:?}: {}", at()),
                            ));
                        }
                    } else if m.tolerances[lane] && cos_theta(m.wi[lane]) > 1e-3 {
                        worst.see(nearby.error(got, want, m.wi[lane]), || {
                            format!("got {got:?}, one lane {want:?}: {}", at())
                        });
                    }
                }
                let want = one.sample(m.xi[lane]);
                let at_one = one.with_level(level).sample8(&xi);
                for got in [samples.lane(lane), at_one.lane(lane)] {
                    let close = if same_bits(&claims, level) {
                        got == want
                    } else {
                        !m.tolerances[lane]
                            || sample_is_near(got, want, &nearby, m.xi[lane], claims.direction)
                    };
                    if !close {
                        return Err(Failure::new(
                            NAME,
                            format!("sample {got:?}, one lane {want:?}: {}", at()),
                        ));
                    }
                }
            }
        }
        Ok(())
    };
    everyday.check([quantity], test)?;
    awkward.check([quantity], test)
}

/// Checks that permuting the lanes permutes the results, bit for bit: lanes do not mix, and none is special.
///
/// # Errors
///
/// Returns a failure if a lane differs.
pub fn lanes_permute(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "permuted lanes permute the results";
    let property = mixed(NAME, "lanes::lanes_permute", subject, ROUNDS);
    property.check([], |m, []| {
        let order = m.order;
        let (wi, xi) = (order.map(|lane| m.wi[lane]), order.map(|lane| m.xi[lane]));
        for level in Level::available() {
            let (g, h) = (m.prepare(level, ORDER), m.prepare(level, order));
            let (a, b) = (
                g.with_level(level).eval_pdf8(&packet(&m.wi)),
                h.with_level(level).eval_pdf8(&packet(&wi)),
            );
            let (s, t) = (
                g.with_level(level).sample8(&triples(&m.xi)),
                h.with_level(level).sample8(&triples(&xi)),
            );
            for (to, from) in order.into_iter().enumerate() {
                let same = eval_bits(a.lane(from)) == eval_bits(b.lane(to))
                    && sample_bits(&s, from) == sample_bits(&t, to);
                if !same {
                    let (a, b) = (a.lane(from), b.lane(to));
                    return Err(Failure::new(
                        NAME,
                        format!(
                            "moved to lane {to} {a:?} becomes {b:?}: {}",
                            m.at(from, level)
                        ),
                    ));
                }
            }
        }
        Ok(())
    })
}

/// Returns the bits of a lane of lobes.
fn lobe_bits(lobes: &PerLobe<LobeEval8>, lane: usize) -> [[u32; 5]; Lobe::COUNT] {
    lobes.0.map(|lobe| {
        let [r, g, b] = lobe.color;
        [lobe.value, lobe.pdf, r, g, b].map(|x| x.as_array()[lane].to_bits())
    })
}

/// Returns the bits of a lane of albedos.
fn albedo_bits(albedo: &PerLobe<[f32x8; 3]>, lane: usize) -> [[u32; 3]; Lobe::COUNT] {
    let bits = |x: f32x8| x.as_array()[lane].to_bits();
    albedo.0.map(|color| color.map(bits))
}

/// Bits of values, samples and lobes, by lane.
type AllBits = [([u32; 4], [u32; 11], [[u32; 5]; Lobe::COUNT]); 8];

fn all_bits(evals: &Eval8, samples: &Sample8, lobes: &PerLobe<LobeEval8>) -> AllBits {
    core::array::from_fn(|lane| {
        (
            eval_bits(evals.lane(lane)),
            sample_bits(samples, lane),
            lobe_bits(lobes, lane),
        )
    })
}

/// Checks that one material and hit repeated in all eight lanes gives the bits of one that the lanes share, and that levels that fuse
/// alike give the same bits.
///
/// # Errors
///
/// Returns a failure if a lane differs.
pub fn levels_agree(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "packed and shared materials, and levels that fuse alike, agree";
    let property = mixed(NAME, "lanes::levels_agree", subject, ROUNDS / 2);
    property.check([], |m, []| {
        let (wi, xi) = (packet(&m.wi), triples(&m.xi));
        let of_eight = |each: &dyn ErasedBsdf8, level| {
            let each = each.with_level(level);
            all_bits(&each.eval_pdf8(&wi), &each.sample8(&xi), &each.lobes8(&wi))
        };
        let differ = |what: String, lane: usize, level: Level| {
            Err(Failure::new(
                NAME,
                format!("{what} differ: {}", m.at(lane, level)),
            ))
        };
        let mut before: Option<(Level, Box<dyn ErasedBsdf8>)> = None;
        for level in Level::available() {
            let (material, hits) = (m.material(0), hits8(&[m.hits[0]; 8]));
            let packed = NamedMaterial::prepare_packed([material; 8], level, hits);
            let shared = of_eight(&*material.prepare8(level, hits), level);
            let lane = packed.lane(3).with_level(level);
            let lane = all_bits(&lane.eval_pdf8(&wi), &lane.sample8(&xi), &lane.lobes8(&wi));
            let packed = of_eight(&*packed, level);
            if let Some(n) = (0..8).find(|n| packed[*n] != shared[*n] || packed[*n] != lane[*n]) {
                return differ("packed, shared and `lane`".to_owned(), n, level);
            }
            let now = m.prepare(level, ORDER);
            if let Some((other, then)) = &before
                && other.fuses() == level.fuses()
            {
                let bits = [of_eight(&**then, *other), of_eight(&*now, level)];
                let albedos = [
                    then.with_level(*other).albedo8(),
                    now.with_level(level).albedo8(),
                ];
                let same = |n: &usize| {
                    bits[0][*n] == bits[1][*n]
                        && albedo_bits(&albedos[0], *n) == albedo_bits(&albedos[1], *n)
                };
                if let Some(n) = (0..8).find(|n| !same(n)) {
                    return differ(format!("{other} and {level}"), n, level);
                }
            }
            before = Some((level, now));
        }
        Ok(())
    })
}

/// Checks that lobes and albedos of eight lanes are those of one lane, and that a model that does not read [`Hit::h`] gives the same bits
/// for every `h`.
///
/// # Errors
///
/// Returns a failure if a lane differs.
pub fn lobes_and_albedo_equal_scalar(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "lobes and albedo of eight lanes are those of one";
    let claims = subject.claims();
    let level = Level::detect();
    let path = "lanes::lobes_and_albedo_equal_scalar";
    let quantity = ("albedo of a lane (`Claims::albedo`)", claims.albedo);
    let property = Property {
        inputs: Inputs::Everyday,
        ..mixed(NAME, path, subject, ROUNDS / 4)
    };
    property.check([quantity], |m, [worst]| {
        let each = m.prepare(level, ORDER);
        let wi = packet(&m.wi);
        let (lobes, albedo) = (each.lobes8(&wi), each.with_level(level).albedo8());
        let unfused = Level::available().filter(|level| same_bits(&claims, *level));
        let exact: Vec<_> = unfused
            .map(|level| (level, each.with_level(level).albedo8()))
            .collect();
        for lane in 0..8 {
            let at = || m.at(lane, level);
            let one = each.lane(lane);
            let (alone, one_albedo) = (one.with_level(level).lobes8(&wi), one.albedo());
            if lobe_bits(&lobes, lane) != lobe_bits(&alone, lane) {
                return Err(Failure::new(
                    NAME,
                    format!("lobes {lobes:?}, one lane {alone:?}: {}", at()),
                ));
            }
            let want = one_albedo.0.map(|color| color.map(f32::to_bits));
            for (level, albedo) in &exact {
                if albedo_bits(albedo, lane) != want {
                    let message = format!("bits of {albedo:?}, one lane {one_albedo:?}");
                    return Err(Failure::new(
                        NAME,
                        format!("{message}: {}", m.at(lane, level)),
                    ));
                }
            }
            for lobe in Lobe::ALL {
                let one_color = alone[lobe].color.map(|color| color.as_array()[lane]);
                for c in 0..3 {
                    let (got, want) = (
                        f64::from(albedo[lobe][c].as_array()[lane]),
                        f64::from(one_albedo[lobe][c]),
                    );
                    // A lobe that lies off the sphere returns next to nothing, with the accuracy of its tail.
                    let floor = 1e-4 * f64::from(one_color[c]).max(1e-20);
                    if m.tolerances[lane] {
                        worst.see(relative(got, want, floor), || {
                            format!("{} {got}, one lane {want}: {}", subject.lobe(lobe), at())
                        });
                    }
                }
            }
            if !claims.near_field {
                let [a, b] =
                    [-0.9, 0.4].map(|h| m.material(lane).prepare(Hit { h, ..m.hits[lane] }));
                let same_eval =
                    eval_bits(a.eval_pdf(m.wi[lane])) == eval_bits(b.eval_pdf(m.wi[lane]));
                if !same_eval || a.sample(m.xi[lane]) != b.sample(m.xi[lane]) {
                    return Err(Failure::new(
                        NAME,
                        format!("h changes the results, but is not claimed to (`Claims::near_field`): {}", at()),
                    ));
                }
            }
        }
        Ok(())
    })
}
