//! Eight lanes give the results of one, whatever their position and on every level.

use crate::erased::{Direction, ErasedBsdf8, ErasedSubject, NamedMaterial, Which};
use crate::failure::{Failure, Outcome, Worst};
use crate::near::{Nearby, sample_is_near};
use crate::probe::{Draws, cos_theta, hits8, packet, relative, triples};
use crate::subject::Claims;
use hairis::simd::{Level, f32x8};
use hairis::{Eval, Hit, Lobe, PerLobe, Sample8};

/// Packets of mixed materials.
const ROUNDS: usize = 2000;

/// Eight materials, each with its hit, a direction and three numbers.
struct Mixed<'a> {
    material: [NamedMaterial<'a>; 8],
    hits: [Hit; 8],
    wi: [Direction; 8],
    xi: [[f32; 3]; 8],
}

impl<'a> Mixed<'a> {
    fn new(materials: &[NamedMaterial<'a>], draws: &mut Draws) -> Self {
        let material: [_; 8] = core::array::from_fn(|_| *draws.pick(materials));
        let hits: [Hit; 8] = core::array::from_fn(|_| draws.hit());
        // Half of the directions where the lobes are, half anywhere.
        let wi = core::array::from_fn(|lane| {
            let any = draws.direction();
            let drawn = material[lane].prepare(hits[lane]).sample(draws.xi3());
            if lane % 2 == 0 {
                drawn.map_or(any, |s| s.wi)
            } else {
                any
            }
        });
        let xi = core::array::from_fn(|_| draws.xi3());
        Self {
            material,
            hits,
            wi,
            xi,
        }
    }

    fn permuted(&self, order: [usize; 8]) -> Self {
        Self {
            material: order.map(|i| self.material[i]),
            hits: order.map(|i| self.hits[i]),
            wi: order.map(|i| self.wi[i]),
            xi: order.map(|i| self.xi[i]),
        }
    }

    fn prepare(&self, level: Level) -> Box<dyn ErasedBsdf8> {
        NamedMaterial::prepare_packed(self.material, level, hits8(&self.hits))
    }

    fn at(&self, lane: usize, level: Level) -> String {
        let Self {
            material,
            hits,
            wi,
            xi,
        } = self;
        format!(
            "{} lane {lane} on {level} {:?} {:?} xi {:?}",
            material[lane].name(),
            hits[lane],
            wi[lane],
            xi[lane]
        )
    }
}

/// Eight materials of the subject at a time, `rounds` times.
fn each_mixed(
    subject: &dyn ErasedSubject,
    seed: u64,
    rounds: usize,
    mut see: impl FnMut(&Mixed<'_>, &mut Draws, usize) -> Outcome,
) -> Outcome {
    let set = subject.set(Which::WithExtremes);
    let materials: Vec<_> = set.iter().collect();
    let mut draws = Draws(seed);
    for round in 0..rounds {
        see(&Mixed::new(&materials, &mut draws), &mut draws, round)?;
    }
    Ok(())
}

/// Every number of one lane of a packet of samples.
pub(crate) fn sample_bits(s: &Sample8, lane: usize) -> [u32; 11] {
    let ([r, g, b], [wr, wg, wb]) = (s.value, s.weight);
    [s.wi.x, s.wi.y, s.wi.z, r, g, b, s.pdf, wr, wg, wb, s.slot]
        .map(|x| x.as_array()[lane].to_bits())
}

pub(crate) fn eval_bits(e: Eval) -> [u32; 4] {
    [e.value[0], e.value[1], e.value[2], e.pdf].map(f32::to_bits)
}

/// Whether a level has to give the bits of one lane.
fn same_bits(claims: &Claims, level: Level) -> bool {
    claims.same_bits && !level.fuses()
}

/// Each of eight lanes, with a material, hit, direction and numbers of its own, gives the results of one lane: the same
/// bits on levels that do not fuse, and close ones on those that do. So do eight lanes at one hit, and `lane` of eight
/// shading points.
///
/// # Errors
///
/// At the first lane that differs.
pub fn lanes_equal_scalar(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "eight lanes give the results of one";
    let claims = subject.claims();
    let mut worst = Worst::new(NAME, "value or density of a lane", claims.lanes);
    each_mixed(subject, 0x1a4e, ROUNDS, |m, _, _| {
        for level in Level::available() {
            let each = m.prepare(level);
            let (wi, xi) = (packet(&m.wi), triples(&m.xi));
            let (evals, samples) = (
                each.with_level(level).eval_pdf8(&wi),
                each.with_level(level).sample8(&xi),
            );
            for lane in 0..8 {
                let at = || m.at(lane, level);
                let nearby = Nearby::new(m.material[lane], m.hits[lane], claims.near_field);
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
                    } else if cos_theta(m.wi[lane]) > 1e-3 {
                        worst.see(nearby.error(got, want, m.wi[lane]), || {
                            format!("got {got:?}, one lane {want:?}: {}", at())
                        })?;
                    }
                }
                let want = one.sample(m.xi[lane]);
                let at_one = one.with_level(level).sample8(&xi);
                for got in [samples.lane(lane), at_one.lane(lane)] {
                    let close = if same_bits(&claims, level) {
                        got == want
                    } else {
                        sample_is_near(got, want, &nearby, m.xi[lane], claims.direction)
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
    })?;
    worst.report()
}

/// Permuting the lanes permutes the results, bit for bit: lanes do not mix, and none is special.
///
/// # Errors
///
/// At the first lane that differs.
pub fn lanes_permute(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "permuted lanes permute the results";
    each_mixed(subject, 0x9e44, ROUNDS, |m, draws, _| {
        let mut order = [0, 1, 2, 3, 4, 5, 6, 7];
        for last in (1..8).rev() {
            let all: Vec<usize> = (0..=last).collect();
            order.swap(last, *draws.pick(&all));
        }
        let p = m.permuted(order);
        for level in Level::available() {
            let (g, h) = (m.prepare(level), p.prepare(level));
            let (a, b) = (
                g.with_level(level).eval_pdf8(&packet(&m.wi)),
                h.with_level(level).eval_pdf8(&packet(&p.wi)),
            );
            let (s, t) = (
                g.with_level(level).sample8(&triples(&m.xi)),
                h.with_level(level).sample8(&triples(&p.xi)),
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

/// One material and hit in all eight lanes is the same as one shared by them, bit for bit, and levels that fuse alike give
/// the same bits.
///
/// # Errors
///
/// At the first lane that differs.
pub fn levels_agree(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "packed and shared materials, and levels that fuse alike, agree";
    each_mixed(subject, 0x1e7e, ROUNDS / 2, |m, _, round| {
        let (wi, xi) = (packet(&m.wi), triples(&m.xi));
        let mut by_level: Vec<(Level, Box<dyn ErasedBsdf8>)> = Vec::new();
        for level in Level::available() {
            let (material, hits) = (m.material[round % 8], hits8(&[m.hits[round % 8]; 8]));
            let packed = NamedMaterial::prepare_packed([material; 8], level, hits);
            let shared = material.prepare8(level, hits);
            let lane = packed.lane(3);
            let evals = [
                packed.with_level(level).eval_pdf8(&wi),
                shared.with_level(level).eval_pdf8(&wi),
                lane.with_level(level).eval_pdf8(&wi),
            ];
            let samples = [
                packed.with_level(level).sample8(&xi),
                shared.with_level(level).sample8(&xi),
                lane.with_level(level).sample8(&xi),
            ];
            for n in 0..8 {
                let e = evals.each_ref().map(|e| eval_bits(e.lane(n)));
                let s = samples.each_ref().map(|s| sample_bits(s, n));
                if e[0] != e[1] || e[0] != e[2] || s[0] != s[1] || s[0] != s[2] {
                    let message = format!(
                        "packed, shared and `lane` differ: {evals:?} {samples:?} {}",
                        m.at(n, level)
                    );
                    return Err(Failure::new(NAME, message));
                }
            }
            by_level.push((level, m.prepare(level)));
        }
        for pair in by_level
            .windows(2)
            .filter(|pair| pair[0].0.fuses() == pair[1].0.fuses())
        {
            let [a, b] = [&pair[0], &pair[1]].map(|(level, g)| {
                (
                    g.with_level(*level).eval_pdf8(&wi),
                    g.with_level(*level).sample8(&xi),
                )
            });
            for n in 0..8 {
                if eval_bits(a.0.lane(n)) != eval_bits(b.0.lane(n))
                    || sample_bits(&a.1, n) != sample_bits(&b.1, n)
                {
                    return Err(Failure::new(
                        NAME,
                        format!(
                            "{} and {} differ: {}",
                            pair[0].0,
                            pair[1].0,
                            m.at(n, pair[1].0)
                        ),
                    ));
                }
            }
        }
        Ok(())
    })
}

/// Lobes and albedos of eight lanes are those of one; a model that does not read [`Hit::h`] gives the same bits for every `h`.
///
/// # Errors
///
/// At the first lane that differs.
pub fn lobes_and_albedo_equal_scalar(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "lobes and albedo of eight lanes are those of one";
    let claims = subject.claims();
    let level = Level::detect();
    let mut worst = Worst::new(NAME, "albedo of a lane", claims.albedo);
    each_mixed(subject, 0x10be, ROUNDS / 4, |m, _, _| {
        let each = m.prepare(level);
        let wi = packet(&m.wi);
        let (lobes, albedo) = (each.lobes8(&wi), each.with_level(level).albedo8());
        for lane in 0..8 {
            let at = || m.at(lane, level);
            let one = each.lane(lane);
            let (alone, one_albedo) = (one.with_level(level).lobes8(&wi), one.albedo());
            for lobe in Lobe::ALL {
                let bits = |l: &PerLobe<hairis::model::LobeEval8>| {
                    let l = &l[lobe];
                    [l.value, l.pdf, l.color[0], l.color[1], l.color[2]]
                        .map(|x: f32x8| x.as_array()[lane].to_bits())
                };
                if bits(&lobes) != bits(&alone) {
                    return Err(Failure::new(
                        NAME,
                        format!("lobes {lobes:?}, one lane {alone:?}: {}", at()),
                    ));
                }
                let one_color = alone[lobe].color.map(|color| color.as_array()[lane]);
                for c in 0..3 {
                    let (got, want) = (
                        f64::from(albedo[lobe][c].as_array()[lane]),
                        f64::from(one_albedo[lobe][c]),
                    );
                    // A lobe that lies off the sphere returns next to nothing, with the digits of its tail.
                    let floor = 1e-4 * f64::from(one_color[c]).max(1e-20);
                    worst.see(relative(got, want, floor), || {
                        format!("{lobe:?} {got}, one lane {want}: {}", at())
                    })?;
                }
            }
            if !claims.near_field {
                let [a, b] =
                    [-0.9, 0.4].map(|h| m.material[lane].prepare(Hit { h, ..m.hits[lane] }));
                let same_eval =
                    eval_bits(a.eval_pdf(m.wi[lane])) == eval_bits(b.eval_pdf(m.wi[lane]));
                if !same_eval || a.sample(m.xi[lane]) != b.sample(m.xi[lane]) {
                    return Err(Failure::new(
                        NAME,
                        format!("h changes the results, but is not claimed to: {}", at()),
                    ));
                }
            }
        }
        Ok(())
    })?;
    worst.report()
}
