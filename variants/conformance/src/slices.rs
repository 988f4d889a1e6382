//! Property that slices give the bits of packets for every length and alignment, and that nothing is written beyond them.

use crate::erased::{COLUMNS, ErasedBsdf, ErasedSubject, WEIGHT_COLUMNS, Which};
use crate::failure::{Failure, Outcome};
use crate::lanes::{eval_bits, sample_bits};
use crate::probe::{Direction, Draws, packet, triples};
use crate::size::lengths;
use hairis::columns::LengthError;
use hairis::simd::Level;

const NAME: &str = "slices give the bits of packets";
/// Content of a slice that must not be written.
pub(crate) const UNTOUCHED: f32 = -77.0;
/// Room after the slice under test.
const MARGIN: usize = 9;
/// Length of the longest slices: two packets of the widest level, and a few rows more.
const LONGEST: usize = 69;

/// Room for `N` columns of `len` numbers at an offset, with margins.
pub(crate) struct Room<const N: usize> {
    columns: [Vec<f32>; N],
    offset: usize,
    len: usize,
}

impl<const N: usize> Room<N> {
    pub(crate) fn new(offset: usize, len: usize) -> Self {
        Self {
            columns: core::array::from_fn(|_| vec![UNTOUCHED; offset + len + MARGIN]),
            offset,
            len,
        }
    }

    pub(crate) fn slices(&mut self) -> [&mut [f32]; N] {
        let (offset, len) = (self.offset, self.len);
        self.columns
            .each_mut()
            .map(|column| &mut column[offset..offset + len])
    }

    /// Checks that the results are the expected ones, and that nothing is written beside them.
    pub(crate) fn check(&self, want: &[[u32; N]], what: &str, at: &str) -> Outcome {
        for (n, column) in self.columns.iter().enumerate() {
            let margins = column[..self.offset]
                .iter()
                .chain(&column[self.offset + self.len..]);
            if margins.into_iter().any(|x| *x != UNTOUCHED) {
                return Err(Failure::new(
                    NAME,
                    format!("{what}: column {n} is written beyond its end: {at}"),
                ));
            }
        }
        for (i, want) in want.iter().take(self.len).enumerate() {
            let got = self
                .columns
                .each_ref()
                .map(|column| column[self.offset + i].to_bits());
            if got != *want {
                let [got, want] = [got, *want].map(|bits| bits.map(f32::from_bits));
                return Err(Failure::new(
                    NAME,
                    format!("{what}, entry {i}: {got:?}, the packet {want:?}: {at}"),
                ));
            }
        }
        Ok(())
    }
}

/// Checks that slices of every length up to 69, at every offset up to 7, give the bits of packets on every level: values and densities
/// together and separately, and samples.
///
/// Nothing is written beyond the slices. Slices of different lengths are rejected, and then nothing is written at all.
///
/// # Errors
///
/// Returns the first entry that differs.
pub fn slices_equal_packets(subject: &dyn ErasedSubject) -> Outcome {
    let mut draws = Draws(0x511c);
    for (n, material) in subject.set(Which::WithExtremes).iter().enumerate() {
        let (name, bsdf) = (material.name(), material.prepare(draws.hit()));
        let rows: [(Direction, [f32; 3]); LONGEST] =
            core::array::from_fn(|_| (draws.direction(), draws.xi3()));
        for level in Level::available() {
            let expected = Expected::new(&*bsdf, level, &rows);
            for len in lengths(LONGEST) {
                // Every length occurs with each material, every alignment with some.
                for offset in (0..8).filter(|offset| n == 0 || (len + offset + n) % 8 == 0) {
                    expected.check(
                        &*bsdf,
                        level,
                        offset,
                        len,
                        &format!("{name} on {level}, {len} at {offset}"),
                    )?;
                }
            }
        }
        if n == 0 {
            lengths_are_checked(&*bsdf)?;
            found_level_is_default(
                &*bsdf,
                &Expected::new(&*bsdf, Level::detect(), &rows).inputs,
            )?;
        }
    }
    Ok(())
}

/// Results of packets for some rows.
struct Expected {
    inputs: [[Vec<f32>; 3]; 2],
    evals: Vec<[u32; 4]>,
    samples: Vec<[u32; COLUMNS]>,
}

impl Expected {
    fn new(bsdf: &dyn ErasedBsdf, level: Level, rows: &[(Direction, [f32; 3])]) -> Self {
        let components: [fn(&Direction) -> f32; 3] = [|v| v.x, |v| v.y, |v| v.z];
        let wi = components.map(|of| rows.iter().map(|(wi, _)| of(wi)).collect());
        let xi = [0, 1, 2].map(|axis| rows.iter().map(|(_, xi)| xi[axis]).collect::<Vec<f32>>());
        let mut all = Self {
            inputs: [wi, xi],
            evals: Vec::new(),
            samples: Vec::new(),
        };
        for eight in rows.chunks(8) {
            let padded: [_; 8] = core::array::from_fn(|lane| eight[lane % eight.len()]);
            let evals = bsdf
                .with_level(level)
                .eval_pdf8(&packet(&padded.map(|(wi, _)| wi)));
            let samples = bsdf
                .with_level(level)
                .sample8(&triples(&padded.map(|(_, xi)| xi)));
            for lane in 0..eight.len() {
                all.evals.push(eval_bits(evals.lane(lane)));
                all.samples.push(sample_bits(&samples, lane));
            }
        }
        all
    }

    fn check(
        &self,
        bsdf: &dyn ErasedBsdf,
        level: Level,
        offset: usize,
        len: usize,
        at: &str,
    ) -> Outcome {
        let refused = |e: LengthError| Failure::new(NAME, format!("{e}: {at}"));
        // Inputs are read at an alignment of their own.
        let from = (offset + len) % 8;
        let inputs = self.inputs.each_ref().map(|columns| {
            columns
                .each_ref()
                .map(|column| [&vec![9.0; from][..], &column[..len]].concat())
        });
        let [wi, xi] = inputs
            .each_ref()
            .map(|columns| columns.each_ref().map(|column| &column[from..]));
        let mut out = Room::<4>::new(offset, len);
        bsdf.with_level(level)
            .eval_array(wi, out.slices())
            .map_err(refused)?;
        out.check(&self.evals, "value and density", at)?;
        let mut values = Room::<3>::new(offset, len);
        bsdf.with_level(level)
            .value_array(wi, values.slices())
            .map_err(refused)?;
        let colors: Vec<_> = self.evals.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect();
        values.check(&colors, "value alone", at)?;
        let mut densities = Room::<1>::new(offset, len);
        let [pdf] = densities.slices();
        bsdf.with_level(level).pdf_array(wi, pdf).map_err(refused)?;
        let pdfs: Vec<_> = self.evals.iter().map(|[.., pdf]| [*pdf]).collect();
        densities.check(&pdfs, "density alone", at)?;
        let mut samples = Room::<COLUMNS>::new(offset, len);
        bsdf.with_level(level)
            .sample_array(xi, samples.slices())
            .map_err(refused)?;
        samples.check(&self.samples, "samples", at)?;
        let mut weights = Room::<{ WEIGHT_COLUMNS.len() }>::new(offset, len);
        bsdf.with_level(level)
            .weight_array(xi, weights.slices())
            .map_err(refused)?;
        let some: Vec<_> = self
            .samples
            .iter()
            .map(|sample| WEIGHT_COLUMNS.map(|column| sample[column]))
            .collect();
        weights.check(&some, "weights of samples", at)
    }
}

/// Names of the slices of an evaluation, and of samples.
const EVAL_SLICES: [&str; 7] = [
    "wi.u", "wi.v", "wi.w", "value.r", "value.g", "value.b", "pdf",
];
const SAMPLE_SLICES: [&str; 3 + COLUMNS] = [
    "xi.lobe", "xi.theta", "xi.phi", "wi.u", "wi.v", "wi.w", "value.r", "value.g", "value.b",
    "pdf", "weight.r", "weight.g", "weight.b", "slot",
];

/// Checks that a slice of another length is rejected by its name, and that nothing is written.
fn lengths_are_checked(bsdf: &dyn ErasedBsdf) -> Outcome {
    for level in Level::available() {
        for (expected, len) in [(5, 0), (5, 4), (5, 6), (5, 40), (16, 17)] {
            let length = |n: usize, wrong: usize| if n == wrong { len } else { expected };
            let check = |field: &'static str, got: Result<(), LengthError>, out: &[Vec<f32>]| {
                let want = Err(LengthError {
                    field,
                    len,
                    expected,
                });
                let written = out.iter().flatten().any(|x| *x != UNTOUCHED);
                if got == want && !written {
                    return Ok(());
                }
                let and = if written {
                    ", yet something is written"
                } else {
                    ""
                };
                Err(Failure::new(
                    NAME,
                    format!(
                        "slices of different lengths give {got:?} for {want:?}{and} on {level}"
                    ),
                ))
            };
            for (wrong, name) in EVAL_SLICES.into_iter().enumerate().skip(1) {
                let inputs = [0, 1, 2].map(|n| vec![0.5; length(n, wrong)]);
                let read = inputs.each_ref().map(|column| &column[..]);
                let room = || [3, 4, 5, 6].map(|n| vec![UNTOUCHED; length(n, wrong)]);
                let mut out = room();
                let got = bsdf
                    .with_level(level)
                    .eval_array(read, out.each_mut().map(|c| &mut c[..]));
                check(name, got, &out)?;
                // An evaluation of the value or the density alone has fewer slices.
                let mut out = room();
                let [r, g, b, pdf] = out.each_mut().map(|c| &mut c[..]);
                let (value, density) = (
                    bsdf.with_level(level).value_array(read, [r, g, b]),
                    bsdf.with_level(level).pdf_array(read, pdf),
                );
                if name != "pdf" {
                    check(name, value, &out[..3])?;
                }
                if !name.starts_with("value") {
                    check(name, density, &out[3..])?;
                }
            }
            for (wrong, name) in SAMPLE_SLICES.into_iter().enumerate().skip(1) {
                let inputs = [0, 1, 2].map(|n| vec![0.5; length(n, wrong)]);
                let read = inputs.each_ref().map(|column| &column[..]);
                let mut out: [Vec<f32>; COLUMNS] =
                    core::array::from_fn(|n| vec![UNTOUCHED; length(n + 3, wrong)]);
                let got = bsdf
                    .with_level(level)
                    .sample_array(read, out.each_mut().map(|c| &mut c[..]));
                check(name, got, &out)?;
                // A call for weights alone has fewer slices.
                if wrong < 3 || WEIGHT_COLUMNS.contains(&(wrong - 3)) {
                    let mut out = WEIGHT_COLUMNS.map(|n| vec![UNTOUCHED; length(n + 3, wrong)]);
                    let got = bsdf
                        .with_level(level)
                        .weight_array(read, out.each_mut().map(|c| &mut c[..]));
                    check(name, got, &out)?;
                }
            }
        }
    }
    Ok(())
}

/// Checks that slices run on the detected level if no level is selected.
fn found_level_is_default(bsdf: &dyn ErasedBsdf, inputs: &[[Vec<f32>; 3]; 2]) -> Outcome {
    let [wi, xi] = inputs
        .each_ref()
        .map(|columns| columns.each_ref().map(|column| &column[..13]));
    let refused =
        |e: LengthError| Failure::new(NAME, format!("{e}: 13 entries, at the level found"));
    let (mut found, mut default) = (Room::<4>::new(0, 13), Room::<4>::new(0, 13));
    bsdf.with_level(Level::detect())
        .eval_array(wi, found.slices())
        .map_err(refused)?;
    bsdf.eval_array(wi, default.slices()).map_err(refused)?;
    let (mut found_samples, mut samples) =
        (Room::<COLUMNS>::new(0, 13), Room::<COLUMNS>::new(0, 13));
    bsdf.with_level(Level::detect())
        .sample_array(xi, found_samples.slices())
        .map_err(refused)?;
    bsdf.sample_array(xi, samples.slices()).map_err(refused)?;
    let mut weights = Room::<{ WEIGHT_COLUMNS.len() }>::new(0, 13);
    bsdf.weight_array(xi, weights.slices()).map_err(refused)?;
    let same = WEIGHT_COLUMNS
        .iter()
        .zip(&weights.columns)
        .all(|(n, column)| samples.columns[*n] == *column);
    if found.columns == default.columns && found_samples.columns == samples.columns && same {
        return Ok(());
    }
    Err(Failure::new(
        NAME,
        "without a level they differ from those on the level found",
    ))
}

#[cfg(test)]
mod tests {
    use super::Room;

    #[test]
    fn entries_left_out_and_written_beyond_are_found() {
        const LEN: usize = 5;
        let want = [[1.0_f32.to_bits()]; LEN];
        let room = |writes: core::ops::Range<usize>| {
            let mut room = Room::<1>::new(2, LEN);
            room.columns[0][writes].fill(1.0);
            room.check(&want, "ones", "here")
        };
        assert!(room(2..7).is_ok(), "all and no more");
        for (writes, why) in [
            (2..6, "entry 4"),
            (3..7, "entry 0"),
            (1..7, "beyond"),
            (2..8, "beyond"),
        ] {
            let failure = room(writes.clone())
                .expect_err("too few or too many")
                .message;
            assert!(failure.contains(why), "{writes:?}: {failure}");
        }
    }
}
