//! Property that slices of hits give the bits of packets, for every length, alignment, material and choice of columns.

use crate::environment::{DOWN, with_mode};
use crate::erased::hits::{Columns, HitMaterials, HitsCall, HitsSet, HitsSubject};
use crate::erased::{COLUMNS, MaterialSet, NamedMaterial};
use crate::failure::{Failure, Outcome};
use crate::lanes::{eval_bits, sample_bits};
use crate::probe::{Direction, Draws, hits8, packet, triples};
use crate::size::lengths;
use crate::slices::{Room, UNTOUCHED};
use hairis::Hit;
use hairis::columns::{EvalColumns, HitColumns, HitsError, LengthError, SampleColumns};
use hairis::simd::Level;

const NAME: &str = "slices of hits give the bits of packets";
/// Length of the longest slices: two packets of the widest level, and a few rows more.
const LONGEST: usize = 69;
/// Requested columns: value and density of an evaluation, or direction, value, density, weight and slot of a sample.
const EVAL_CHOICES: [[bool; 2]; 3] = [[true, true], [true, false], [false, true]];
const SAMPLE_CHOICES: [[bool; 5]; 4] = [
    [true; 5],
    [true, false, true, true, false], // a path tracer
    [false, true, false, false, true],
    [false; 5],
];

/// Checks that slices of hits give the bits of [`Material8::prepare8`](hairis::Material8::prepare8) followed by eight lanes. They are
/// evaluated, sampled, or both in one call, on one material and on a table of materials in runs and at random.
///
/// Without `h`, hits are on the axis. Columns that are left out are not written, nor is anything beyond a slice. Slices of different
/// lengths and indices beyond the table are rejected, and then nothing is written. If the host rounds down and takes denormals for 0,
/// results are finite and not negative.
///
/// # Errors
///
/// Returns the first entry that differs.
pub fn hits_equal_packets(subject: &dyn HitsSubject) -> Outcome {
    let mut draws = Draws(0x417);
    let set = &*subject.hits();
    let materials: Vec<_> = (set as &dyn MaterialSet).iter().collect();
    for level in Level::available() {
        for (len, one) in lengths(LONGEST).zip((0..materials.len()).cycle()) {
            let rows: Vec<Row> = (0..len).map(|_| Row::new(&mut draws)).collect();
            let at = format!("{len} hits on {level}");
            let slices = Slices::new(&rows, len % 8, len % 3 != 1);
            let expected = Expected::new(&vec![materials[one]; len], level, &slices.rows);
            slices.check(&expected, len, &format!("one material, {at}"), |out| {
                set.call(HitMaterials::Shared(one), level, slices.call(out))
            })?;
            let index = indices(&mut draws, len, materials.len());
            let each: Vec<_> = index.iter().map(|i| materials[*i as usize]).collect();
            let expected = Expected::new(&each, level, &slices.rows);
            slices.check(
                &expected,
                len,
                &format!("materials {index:?}, {at}"),
                |out| set.call(HitMaterials::PerHit(&index), level, slices.call(out)),
            )?;
        }
    }
    with_mode(DOWN, || any_rounding_is_finite(set))?;
    arguments_are_checked(set)
}

/// Checks that values, densities and weights are finite and not negative if the host rounds down.
fn any_rounding_is_finite(set: &dyn HitsSet) -> Outcome {
    let mut draws = Draws(0x418);
    let rows: Vec<Row> = (0..LONGEST).map(|_| Row::new(&mut draws)).collect();
    let index = indices(&mut draws, LONGEST, set.len());
    let slices = Slices::new(&rows, 0, true);
    for level in Level::available() {
        let mut all = [[[0.0; LONGEST]; 8]; 2];
        let [alone, both] = all.each_mut().map(|columns| {
            let [r, g, b, pdf, wr, wg, wb, density] =
                columns.each_mut().map(|column| &mut column[..]);
            let evals = EvalColumns {
                value: Some([r, g, b]),
                pdf: Some(pdf),
            };
            let samples = SampleColumns {
                weight: Some([wr, wg, wb]),
                pdf: Some(density),
                ..SampleColumns::default()
            };
            (evals, samples)
        });
        let call = |out| set.call(HitMaterials::PerHit(&index), level, slices.call(out));
        let lengths = call(Columns::Eval(alone.0))
            .and(call(Columns::Sample(alone.1)))
            .and(call(Columns::Both(both.0, both.1)));
        if lengths.is_err()
            || !all
                .iter()
                .flatten()
                .flatten()
                .all(|x| x.is_finite() && *x >= 0.0)
        {
            return Err(Failure::new(
                NAME,
                format!("rounded down on {level}: {all:?}"),
            ));
        }
    }
    Ok(())
}

/// Draws indices of materials in runs of every length up to 20.
fn indices(draws: &mut Draws, len: usize, materials: usize) -> Vec<u32> {
    let mut index = Vec::new();
    while index.len() < len {
        let run = 1 + draws.bits() % *draws.pick(&[3, 20]);
        let one = u32::try_from(draws.bits() % materials as u64).unwrap_or(0);
        index.extend((0..run).map(|_| one));
    }
    index.truncate(len);
    index
}

/// Hit with its queries.
#[derive(Clone, Copy)]
struct Row {
    hit: Hit,
    wi: Direction,
    xi: [f32; 3],
}

impl Row {
    fn new(draws: &mut Draws) -> Self {
        Self {
            hit: draws.hit(),
            wi: draws.direction(),
            xi: draws.xi3(),
        }
    }
}

/// Rows by column: `wo`, `h`, `wi` and `xi`, each with some room before it.
struct Slices {
    rows: Vec<Row>,
    columns: [Vec<f32>; 10],
    offset: usize,
    has_h: bool,
}

impl Slices {
    fn new(rows: &[Row], offset: usize, has_h: bool) -> Self {
        let row = |row: &Row| Row {
            hit: Hit {
                h: if has_h { row.hit.h } else { 0.0 },
                ..row.hit
            },
            ..*row
        };
        let rows: Vec<_> = rows.iter().map(row).collect();
        let of =
            |Row {
                 hit: Hit { wo, h },
                 wi,
                 xi,
             }: &Row| [wo.x, wo.y, wo.z, *h, wi.x, wi.y, wi.z, xi[0], xi[1], xi[2]];
        let columns = core::array::from_fn(|n| {
            let room = core::iter::repeat_n(9.0, offset);
            room.chain(rows.iter().map(|row| of(row)[n])).collect()
        });
        Self {
            rows,
            columns,
            offset,
            has_h,
        }
    }

    fn three(&self, from: usize) -> [&[f32]; 3] {
        [0, 1, 2].map(|n| &self.columns[from + n][self.offset..])
    }

    /// Returns the arguments of a call for these results.
    fn call<'a>(&'a self, out: Columns<'a>) -> HitsCall<'a> {
        let hits = HitColumns {
            wo: self.three(0),
            h: self.has_h.then(|| &self.columns[3][self.offset..]),
        };
        let (wi, xi) = (self.three(4), self.three(7));
        HitsCall { hits, wi, xi, out }
    }

    fn check(
        &self,
        expected: &Expected,
        len: usize,
        at: &str,
        call: impl Fn(Columns<'_>) -> Result<(), HitsError>,
    ) -> Outcome {
        let refused = |e: HitsError| Failure::new(NAME, format!("{e}: {at}"));
        // Each choice alone, and each evaluation together with each sample.
        let alone = EVAL_CHOICES.map(|evals| (Some(evals), None));
        let samples = SAMPLE_CHOICES.map(|samples| (None, Some(samples)));
        let evals = EVAL_CHOICES.into_iter().chain([[false; 2]]);
        let both = evals.zip(SAMPLE_CHOICES.into_iter().cycle().skip(2));
        let both = both.map(|(evals, samples)| (Some(evals), Some(samples)));
        for (evals, samples) in alone.into_iter().chain(samples).chain(both) {
            let mut eval_room = Room::<4>::new(self.offset, len);
            let mut sample_room = Room::<COLUMNS>::new(self.offset, len);
            let out = match (evals, samples) {
                (Some(choice), None) => Columns::Eval(evaluated(&mut eval_room, choice)),
                (None, Some(choice)) => Columns::Sample(sampled(&mut sample_room, choice)),
                (evals, samples) => Columns::Both(
                    evaluated(&mut eval_room, evals.unwrap_or_default()),
                    sampled(&mut sample_room, samples.unwrap_or_default()),
                ),
            };
            call(out).map_err(refused)?;
            let [value, pdf] = evals.unwrap_or_default();
            let asked = [value, value, value, pdf];
            eval_room.check(&chosen(&expected.evals, asked), "value and density", at)?;
            let [wi, value, pdf, weight, slot] = samples.unwrap_or_default();
            let asked = [
                wi, wi, wi, value, value, value, pdf, weight, weight, weight, slot,
            ];
            sample_room.check(&chosen(&expected.samples, asked), "samples", at)?;
        }
        Ok(())
    }
}

/// Returns room for the requested columns of an evaluation.
fn evaluated(room: &mut Room<4>, [value, pdf]: [bool; 2]) -> EvalColumns<'_> {
    let [r, g, b, density] = room.slices();
    EvalColumns {
        value: value.then_some([r, g, b]),
        pdf: pdf.then_some(density),
    }
}

/// Returns room for the requested columns of samples.
fn sampled(
    room: &mut Room<COLUMNS>,
    [wi, value, pdf, weight, slot]: [bool; 5],
) -> SampleColumns<'_> {
    let [u, v, w, r, g, b, density, wr, wg, wb, lobe] = room.slices();
    SampleColumns {
        wi: wi.then_some([u, v, w]),
        value: value.then_some([r, g, b]),
        pdf: pdf.then_some(density),
        weight: weight.then_some([wr, wg, wb]),
        slot: slot.then_some(lobe),
    }
}

/// Returns the expected results, in which the columns that are not requested are untouched.
fn chosen<const N: usize>(results: &[[u32; N]], asked: [bool; N]) -> Vec<[u32; N]> {
    let row = |row: &[u32; N]| {
        core::array::from_fn(|n| {
            if asked[n] {
                row[n]
            } else {
                UNTOUCHED.to_bits()
            }
        })
    };
    results.iter().map(row).collect()
}

/// Results of packets for some rows.
struct Expected {
    evals: Vec<[u32; 4]>,
    samples: Vec<[u32; COLUMNS]>,
}

impl Expected {
    fn new(materials: &[NamedMaterial<'_>], level: Level, rows: &[Row]) -> Self {
        let mut all = Self {
            evals: Vec::new(),
            samples: Vec::new(),
        };
        for (materials, rows) in materials.chunks(8).zip(rows.chunks(8)) {
            let lane = |lane: usize| lane % rows.len();
            let packed = core::array::from_fn(|i| materials[lane(i)]);
            let row: [Row; 8] = core::array::from_fn(|i| rows[lane(i)]);
            let bsdf = NamedMaterial::prepare_packed(packed, level, hits8(&row.map(|row| row.hit)));
            let evals = bsdf
                .with_level(level)
                .eval_pdf8(&packet(&row.map(|row| row.wi)));
            let samples = bsdf
                .with_level(level)
                .sample8(&triples(&row.map(|row| row.xi)));
            for lane in 0..rows.len() {
                all.evals.push(eval_bits(evals.lane(lane)));
                all.samples.push(sample_bits(&samples, lane));
            }
        }
        all
    }
}

/// Checks that a slice of another length is rejected by its name and an index by its place, and that nothing is written.
fn arguments_are_checked(set: &dyn HitsSet) -> Outcome {
    const NAMES: [&str; 8] = ["index", "wo.v", "wo.w", "h", "wi.u", "wi.v", "wi.w", "pdf"];
    let refused_as = |want: HitsError, lens: [usize; 8], index: u32| {
        let columns = lens.map(|len| vec![0.5; len]);
        let [_, v, w, h, x, y, z, _] = columns.each_ref().map(|column| &column[..]);
        let (u, mut pdf) = (vec![0.5; EXPECTED], vec![UNTOUCHED; lens[7]]);
        let mut all = vec![0; lens[0]];
        if let Some(last) = all.last_mut() {
            *last = index;
        }
        let out = EvalColumns {
            pdf: Some(&mut pdf),
            ..EvalColumns::default()
        };
        let got = set.eval_each(
            &all,
            HitColumns {
                wo: [&u, v, w],
                h: Some(h),
            },
            [x, y, z],
            out,
        );
        if got == Err(want) && pdf.iter().all(|x| *x == UNTOUCHED) {
            return Ok(());
        }
        Err(Failure::new(
            NAME,
            format!("{got:?} for {want:?}, densities {pdf:?}"),
        ))
    };
    const EXPECTED: usize = 5;
    for (wrong, field) in NAMES.into_iter().enumerate() {
        for len in [0, 4, 6] {
            let mut lens = [EXPECTED; 8];
            lens[wrong] = len;
            refused_as(
                LengthError {
                    field,
                    len,
                    expected: EXPECTED,
                }
                .into(),
                lens,
                0,
            )?;
        }
    }
    let (materials, most) = (set.len(), u32::MAX);
    for index in [u32::try_from(materials).unwrap_or(most), most] {
        refused_as(
            HitsError::Material {
                hit: EXPECTED - 1,
                index,
                materials,
            },
            [EXPECTED; 8],
            index,
        )?;
    }
    Ok(())
}
