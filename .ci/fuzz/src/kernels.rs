//! Every entry point on numbers of any bits: nothing but NaN directions may be anything but finite and at least 0.
//!
//! Models are those of the list, whose handles have the bits of the raw types: `.ci/hosts.sh` compares them.

use glam::Vec3;
use hairis::columns::{EvalColumns, SampleColumns};
use hairis::model::DynBsdf;
use hairis::resample::{CandidateColumns, Counts, Partition, Resample, WeightColumns};
use hairis::simd::{Level, f32x8};
use hairis::{Eval, Hit, Lobe, LobeMask, Vec3x8};
use hairis_variants::{AnyMaterial, ModelId};

/// Numbers from bytes, zeros at their end.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    fn byte(&mut self) -> u8 {
        let Some((byte, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        *byte
    }

    /// A float of any bits.
    fn any(&mut self) -> f32 {
        f32::from_bits(u32::from_le_bytes([
            self.byte(),
            self.byte(),
            self.byte(),
            self.byte(),
        ]))
    }

    /// A number in [0, 1).
    fn unit(&mut self) -> f32 {
        let bits = u32::from_le_bytes([self.byte(), self.byte(), self.byte(), 0]);
        bits as f32 * (1.0 / 16_777_216.0)
    }

    /// A direction: unit or, once in a while, any three numbers.
    fn direction(&mut self) -> Vec3 {
        match self.byte() {
            0..=15 => Vec3::new(self.any(), self.any(), self.any()),
            16..=31 => Vec3::new(1.0, 1e-4 * self.unit(), 1e-4 * self.unit()).normalize(),
            _ => (2.0 * Vec3::new(self.unit(), self.unit(), self.unit()) - Vec3::ONE)
                .normalize_or_zero(),
        }
    }
}

pub fn fuzz(data: &[u8]) {
    let numbers = &mut Numbers(data);
    let byte = usize::from(numbers.byte());
    let id = ModelId::ALL[byte % ModelId::ALL.len()];
    // Half of the fields of a preset become any numbers: those within range are taken.
    let presets: Vec<_> = id.presets().collect();
    let mut values = presets[usize::from(numbers.byte()) % presets.len()].1;
    let mut material = id.material(&values).expect("a preset is legal");
    for field in id.fields() {
        let kind = numbers.byte();
        if kind > 127 {
            continue;
        }
        let mut new = [0.0; 4];
        let new = &mut new[..field.kind.width()];
        for (new, old) in new.iter_mut().zip(values.numbers(field.name)) {
            *new = if kind < 32 {
                numbers.any()
            } else {
                old * (0.25 + 4.0 * numbers.unit())
            };
        }
        let changed = values.with(field.name, new);
        if let Ok(legal) = id.material(&changed) {
            (values, material) = (changed, legal);
        }
    }
    // Energy is conserved by the material, by the hit or by nothing.
    match byte / ModelId::ALL.len() % 3 {
        0 => calls(&material, false, numbers),
        1 => calls(&material.conserving(), false, numbers),
        _ => calls(&material, true, numbers),
    }
}

fn calls(material: &AnyMaterial, conserving_hit: bool, numbers: &mut Numbers<'_>) {
    let mut bsdf = material.prepare(Hit::new(numbers.direction(), 2.0 * numbers.unit() - 1.0));
    if numbers.byte() < 64 {
        bsdf.set_lobes(LobeMask::of(&[Lobe::slot(numbers.byte() % 4)]));
    }
    if conserving_hit {
        bsdf.set_conserving();
    }
    let wi: [Vec3; 8] = core::array::from_fn(|_| numbers.direction());
    let xi: [[f32; 3]; 8] =
        core::array::from_fn(|_| [numbers.unit(), numbers.unit(), numbers.unit()]);
    for (wi, xi) in wi.iter().zip(xi) {
        sound_eval(bsdf.eval_pdf(*wi));
        bsdf.lobes(*wi).0.iter().for_each(|lobe| {
            sound(&[
                lobe.value,
                lobe.pdf,
                lobe.color[0],
                lobe.color[1],
                lobe.color[2],
            ])
        });
        if let Some(sample) = bsdf.sample(xi) {
            sound(&sample.value);
            sound(&sample.weight);
            sound(&[sample.pdf]);
            assert!(
                sample.wi.is_finite() && (sample.wi.length() - 1.0).abs() < 1e-5,
                "{sample:?}"
            );
        }
    }
    bsdf.albedo().0.iter().for_each(|lobe| sound(lobe));
    let (wi8, xi8) = (
        Vec3x8::from(wi),
        core::array::from_fn(|row| f32x8::new(xi.map(|xi| xi[row]))),
    );
    let columns = |vectors: [[f32; 3]; 8]| -> [[f32; 8]; 3] {
        core::array::from_fn(|row| vectors.map(|v| v[row]))
    };
    let (wi, xi) = (columns(wi.map(Vec3::into)), columns(xi));
    let len = usize::from(numbers.byte()) % 9;
    let [wi, xi] = [&wi, &xi].map(|rows| rows.each_ref().map(|row| &row[..len]));
    let light: [[f32; 8]; 4] = [(); 4].map(|()| [(); 8].map(|()| numbers.any()));
    let [r, g, b, pdf_light] = light.each_ref().map(|row| &row[..len]);
    let candidates = CandidateColumns {
        wi,
        radiance: [r, g, b],
        pdf_light,
    };
    let counts = Counts {
        bsdf: numbers.byte().into(),
        light: numbers.byte().into(),
    };
    let partition =
        [Partition::All, Partition::Balance, Partition::Power][usize::from(numbers.byte()) % 3];
    for level in Level::available() {
        let eval = bsdf.with_level(level).eval_pdf8(&wi8);
        let samples = bsdf.with_level(level).sample8(&xi8);
        let points = material.with_level(level).prepare8(&wi8);
        for lane in 0..8 {
            sound_eval(eval.lane(lane));
            if let Some(sample) = samples.lane(lane) {
                sound(&sample.weight);
                sound(&[sample.pdf]);
            }
            sound_eval(points.with_level(level).eval_pdf8(&wi8).lane(lane));
        }
        let (mut value, mut pdf) = ([[0.0; 8]; 3], [0.0; 8]);
        let [r, g, b] = value.each_mut().map(|row| &mut row[..len]);
        let out = EvalColumns {
            value: Some([r, g, b]),
            pdf: Some(&mut pdf[..len]),
        };
        bsdf.with_level(level)
            .eval_columns(wi, out)
            .expect("one length");
        for i in 0..len {
            let Eval {
                value: expected,
                pdf: density,
            } = eval.lane(i);
            let same = value.map(|row| row[i].to_bits()) == expected.map(f32::to_bits)
                && pdf[i].to_bits() == density.to_bits();
            assert!(same, "entry {i} of {len} on {level}");
        }
        let mut rows = [[0.0; 8]; 11];
        let [u, v, w, r, g, b, pdf, x, y, z, slot] = rows.each_mut().map(|row| &mut row[..len]);
        let out = SampleColumns {
            wi: Some([u, v, w]),
            value: Some([r, g, b]),
            pdf: Some(pdf),
            weight: Some([x, y, z]),
            slot: Some(slot),
        };
        bsdf.with_level(level)
            .sample_columns(xi, out)
            .expect("one length");
        rows[3..10].iter().for_each(|row| sound(row));
        let mut weights = [[0.0; 8]; 7];
        let [u, v, w, pdf, x, y, z] = weights.each_mut().map(|row| &mut row[..len]);
        let out = SampleColumns {
            wi: Some([u, v, w]),
            pdf: Some(pdf),
            weight: Some([x, y, z]),
            ..SampleColumns::default()
        };
        bsdf.with_level(level)
            .sample_columns(xi, out)
            .expect("one length");
        let same = weights
            .iter()
            .zip([0, 1, 2, 6, 7, 8, 9])
            .all(|(row, n)| row.map(bits) == rows[n].map(bits));
        assert!(same, "{len} weights on {level}");
        let mut weighed = [[0.0; 8]; 4];
        let [r, g, b, weight] = weighed.each_mut().map(|row| &mut row[..len]);
        let out = WeightColumns {
            contribution: [r, g, b],
            weight,
        };
        let at_level = bsdf.with_level(level);
        let object: &dyn DynBsdf = &*at_level;
        object
            .weigh_columns(candidates, counts, partition, out)
            .expect("one length");
        weighed.iter().for_each(|row| sound(row));
    }
}

/// Bits of a number, those of one NaN for all: the direction of a discarded sample is NaN where that to the viewer is, and Rust leaves open
/// which NaN an operation returns.
fn bits(x: f32) -> u32 {
    if x.is_nan() { f32::NAN } else { x }.to_bits()
}

fn sound_eval(Eval { value, pdf }: Eval) {
    sound(&value);
    sound(&[pdf]);
}

fn sound(numbers: &[f32]) {
    assert!(
        numbers.iter().all(|x| x.is_finite() && *x >= 0.0),
        "{numbers:?}"
    );
}
