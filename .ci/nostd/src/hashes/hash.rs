//! Hashes of results.

use crate::system;
use glam::Vec3;
use hairis::model::{LobeEval, SampleLanes};
use hairis::simd::f32x8;
use hairis::{Eval, PerLobe, Sample};

/// FNV-1a over the bits of floats. NaN has one hash: its sign and payload are not part of IEEE arithmetic.
#[derive(Clone, Copy)]
pub struct Hash(u64);

impl Hash {
    pub const NEW: Self = Self(0xcbf2_9ce4_8422_2325);

    pub fn number(&mut self, x: f32) {
        let bits = if x.is_nan() { 0x7fc0_0000 } else { x.to_bits() };
        for byte in bits.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    pub fn numbers(&mut self, x: &[f32]) {
        x.iter().for_each(|x| self.number(*x));
    }

    pub fn lanes(&mut self, x: &[f32x8]) {
        x.iter().for_each(|x| self.numbers(x.as_array()));
    }

    pub fn vec3(&mut self, v: Vec3) {
        self.numbers(&[v.x, v.y, v.z]);
    }

    pub fn eval(&mut self, eval: Eval) {
        self.numbers(&eval.value);
        self.number(eval.pdf);
    }

    pub fn eval8(&mut self, eval: &Eval<f32x8>) {
        self.lanes(&eval.value);
        self.lanes(&[eval.pdf]);
    }

    pub fn sample(&mut self, sample: Option<Sample>) {
        let Some(Sample {
            wi,
            value,
            pdf,
            weight,
            lobe,
        }) = sample
        else {
            return self.number(-1.0);
        };
        self.vec3(wi);
        self.numbers(&value);
        self.numbers(&weight);
        self.numbers(&[pdf, f32::from(lobe.index() as u8)]);
    }

    pub fn sample8(&mut self, drawn: &SampleLanes<f32x8>) {
        self.lanes(&[drawn.wi.x, drawn.wi.y, drawn.wi.z, drawn.pdf, drawn.slot]);
        self.lanes(&drawn.value);
        self.lanes(&drawn.weight);
    }

    pub fn lobes(&mut self, lobes: &PerLobe<LobeEval>) {
        for LobeEval { value, color, pdf } in &lobes.0 {
            self.numbers(color);
            self.numbers(&[*value, *pdf]);
        }
    }

    pub fn lobes8(&mut self, lobes: &PerLobe<LobeEval<f32x8>>) {
        for LobeEval { value, color, pdf } in &lobes.0 {
            self.lanes(color);
            self.lanes(&[*value, *pdf]);
        }
    }

    /// Prints the line of an entry point.
    pub fn print(self, rounding: &str, entry: &str, model: &str, level: &str) {
        let mut digits = [0; 16];
        for (place, digit) in digits.iter_mut().rev().enumerate() {
            *digit = b"0123456789abcdef"[(self.0 >> (4 * place)) as usize & 15];
        }
        for text in [rounding, " ", entry, "/", model, " "] {
            system::write(text.as_bytes());
        }
        system::write(&digits);
        system::write(b" ");
        // One word.
        for byte in level.bytes() {
            system::write(&[if byte == b' ' { b'-' } else { byte }]);
        }
        system::write(b"\n");
    }
}
