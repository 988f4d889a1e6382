//! Materials, hits and calls for the tests.

use hairis::columns::HitColumns;
use hairis::simd::Level;
use hairis_gradients::{AnyGradients, GradColumns, Weights};
use hairis_variants::{Kind, ModelId, Values};

/// Generator of random numbers, `SplitMix64`.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    #[expect(clippy::cast_precision_loss, reason = "24 bits fit a float")]
    pub(crate) fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * ((self.bits() >> 40) as f32 / 16_777_216.0)
    }

    pub(crate) fn choose<T: Copy>(&mut self, of: &[T]) -> T {
        of[usize::try_from(self.bits() % of.len() as u64).expect("an index")]
    }

    pub(crate) fn sphere(&mut self) -> [f32; 3] {
        let (u, phi) = (self.range(-1.0, 1.0), self.range(-3.2, 3.2));
        let cos = (1.0 - u * u).max(0.0).sqrt();
        [u, cos * phi.cos(), cos * phi.sin()]
    }

    /// Draws a unit direction: at random, along or across an axis, or grazing.
    pub(crate) fn edge(&mut self) -> [f32; 3] {
        let [_, y, z] = self.sphere();
        match self.bits() % 8 {
            0 => [self.choose(&[-1.0, 1.0]), 0.0, 0.0],
            1 => [0.0, self.choose(&[-1.0, 1.0]), 0.0],
            2 => [0.0, 0.0, self.choose(&[-1.0, 1.0])],
            3 | 4 => {
                let angle = self.range(-20.0, -1.0).exp2();
                let (cos, sin) = (angle * y, angle * z);
                let along = (1.0 - cos * cos - sin * sin).sqrt();
                [along * self.choose(&[-1.0, 1.0]), cos, sin]
            }
            _ => self.sphere(),
        }
    }

    /// Draws the values of random parameters of a model, with narrow lobes if `is_narrow`.
    pub(crate) fn values(&mut self, model: ModelId, is_narrow: bool) -> Values {
        loop {
            let mut values = model.defaults();
            for field in model.fields() {
                // A tilt by another name leaves the draws of other fields as they are.
                let is_tilt = field.instead_of == Some("tilt");
                let bits = if is_tilt {
                    Random(!self.0).bits()
                } else if field.instead_of.is_some() {
                    self.bits()
                } else {
                    1
                };
                if bits.is_multiple_of(2) {
                    continue;
                }
                match (field.kind, field.draw) {
                    (Kind::Word(words), _) => {
                        values = values.with_word(field.name, self.choose(words));
                    }
                    (kind, Some(draw)) => {
                        let mut numbers = vec![0.0; kind.width()];
                        for number in &mut numbers {
                            *number = draw.unit
                                * if draw.log {
                                    self.range(draw.least.ln(), draw.most.ln()).exp()
                                } else {
                                    self.range(draw.least, draw.most)
                                };
                        }
                        if let Some(narrow) = field.narrow.filter(|_| is_narrow) {
                            numbers.fill(narrow);
                        }
                        values = values.with(field.name, &numbers);
                    }
                    // Random materials do not draw fields in place of others.
                    (kind, None) if field.instead_of.is_some() => {
                        let mut own = Random(self.0);
                        let numbers = (0..kind.width()).map(|_| own.range(0.02, 0.98));
                        values = values.with(field.name, &numbers.collect::<Vec<_>>());
                    }
                    // Nor those that are left out as a rule, of which a half get less than their default.
                    (_, None) if field.optional && Random(self.0).bits().is_multiple_of(2) => {
                        let mut own =
                            Random(self.0 ^ field.name.bytes().map(u64::from).sum::<u64>());
                        let numbers = values.numbers(field.name).iter();
                        let numbers = numbers.map(|x| x * own.range(0.5, 0.98));
                        values = values.with(field.name, &numbers.collect::<Vec<_>>());
                    }
                    _ => {}
                }
            }
            if AnyGradients::new(model, &values).is_ok() {
                return values;
            }
        }
    }
}

/// Hits, each with a direction and weights.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hits {
    pub(crate) wo: [Vec<f32>; 3],
    pub(crate) h: Vec<f32>,
    pub(crate) wi: [Vec<f32>; 3],
    pub(crate) weights: [Vec<f32>; 4],
}

impl Hits {
    pub(crate) fn push(&mut self, wo: [f32; 3], h: f32, wi: [f32; 3], weights: [f32; 4]) {
        for k in 0..3 {
            self.wo[k].push(wo[k]);
            self.wi[k].push(wi[k]);
        }
        self.h.push(h);
        for (column, weight) in self.weights.iter_mut().zip(weights) {
            column.push(weight);
        }
    }

    /// Draws one hit with its weights: two directions of the whole sphere, and an offset away from the edges.
    pub(crate) fn one(random: &mut Random) -> Self {
        let (wo, h, wi) = (random.sphere(), random.range(-0.95, 0.95), random.sphere());
        let weights = [(); 4].map(|()| random.range(-1.0, 1.0));
        let mut hits = Self::default();
        hits.push(wo, h, wi, weights);
        hits
    }

    pub(crate) fn len(&self) -> usize {
        self.h.len()
    }

    /// Returns the numbers of a hit: `wo`, `h`, `wi` and the weights.
    pub(crate) fn numbers(&self, hit: usize) -> Vec<f32> {
        let columns = self.wo.iter().chain([&self.h]).chain(&self.wi);
        let columns = columns.chain(&self.weights);
        columns.map(|column| column[hit]).collect()
    }

    pub(crate) fn hits(&self) -> HitColumns<'_> {
        HitColumns {
            wo: slices(&self.wo),
            h: Some(&self.h),
        }
    }
}

pub(crate) fn slices<const N: usize>(columns: &[Vec<f32>; N]) -> [&[f32]; N] {
    columns.each_ref().map(|column| &column[..])
}

/// Results of a call, collected from all of its columns.
#[derive(Debug)]
pub(crate) struct Found {
    /// Rows per hit: results, derivatives by the material, derivatives by the hit.
    pub(crate) rows: Vec<Vec<f32>>,
    pub(crate) sums: Vec<f64>,
    pub(crate) parameters: Values<f64>,
}

/// Calls the derivatives with all columns, and without the density unless `has_pdf`.
pub(crate) fn call(gradients: &AnyGradients, hits: &Hits, level: Level, has_pdf: bool) -> Found {
    let (len, numbers) = (hits.len(), gradients.material().len());
    let mut columns = vec![vec![f32::NAN; len]; numbers + 11];
    let mut sums = vec![0.0; numbers];
    let [value_r, value_g, value_b, pdf] = slices(&hits.weights);
    let weights = Weights {
        value: Some([value_r, value_g, value_b]),
        pdf: Some(pdf),
    };
    {
        let mut all: Vec<&mut [f32]> = columns.iter_mut().map(|column| &mut column[..]).collect();
        let mut hit = all.split_off(4 + numbers).into_iter();
        let mut each = all.split_off(4);
        let mut results = all.into_iter();
        let mut next = || results.next().expect("four results");
        let value = [next(), next(), next()];
        let pdf = next();
        let mut next = || hit.next().expect("seven arguments");
        let (d_wo, d_h) = ([next(), next(), next()], next());
        let d_wi = [next(), next(), next()];
        let out = GradColumns {
            value: Some(value),
            pdf: Some(pdf),
            d_wo: Some(d_wo),
            d_h: Some(d_h),
            d_wi: Some(d_wi),
            d_material: Some(&mut sums),
            d_material_of_hits: Some(&mut each),
        };
        let (gradients, wi) = (gradients.with_level(level), slices(&hits.wi));
        let done = if has_pdf {
            gradients.eval_pdf_grad(hits.hits(), wi, weights, out)
        } else {
            gradients.eval_grad(hits.hits(), wi, weights, out)
        };
        done.expect("columns of one length");
    }
    let row = |hit: usize| columns.iter().map(|column| column[hit]).collect();
    Found {
        rows: (0..len).map(row).collect(),
        parameters: gradients.by_parameters(&sums),
        sums,
    }
}

/// Returns the median, and the 999th of a thousand.
pub(crate) fn quantiles(errors: &mut [f64]) -> [f64; 2] {
    errors.sort_by(f64::total_cmp);
    [
        errors[errors.len() / 2],
        errors[errors.len() - 1 - errors.len() / 1000],
    ]
}
