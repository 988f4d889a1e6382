//! Materials, directions and numbers at a point of the cube that is searched.

use core::f64::consts::{FRAC_PI_2, PI};
use core::fmt;
use glam::Vec3;
use hairis::simd::f32x8;
use hairis::{Hit, Hit8, Vec3x8};
use hairis_conformance::published::support::{direction, narrow};
use hairis_reference::{Reference, reference};
use hairis_variants::{AnyBsdf, AnyMaterial, Kind, ModelId, Values};

/// Largest uniform number below 1.
const LAST: f32 = 1.0 - f32::EPSILON / 2.0;

/// Coordinates of a point, which are taken one after the other; those that are missing are 0.5.
pub(crate) struct Coordinates<'a> {
    of: &'a [f32],
    taken: usize,
    /// Description of the coordinates taken so far, if it is asked for.
    notes: Option<String>,
}

impl<'a> Coordinates<'a> {
    pub(crate) const fn new(of: &'a [f32]) -> Self {
        Self {
            of,
            taken: 0,
            notes: None,
        }
    }

    /// Makes coordinates that keep what is noted.
    pub(crate) fn with_notes(of: &'a [f32]) -> Self {
        Self {
            notes: Some(String::new()),
            ..Self::new(of)
        }
    }

    /// Notes what the coordinates stand for.
    pub(crate) fn note(&mut self, name: &str, what: &impl fmt::Debug) {
        if let Some(notes) = &mut self.notes {
            notes.push_str(&format!("{name} {what:?} "));
        }
    }

    /// Returns what was noted.
    pub(crate) fn notes(self) -> String {
        self.notes.unwrap_or_default()
    }

    /// Returns the number of coordinates that have been taken.
    pub(crate) const fn taken(&self) -> usize {
        self.taken
    }

    fn number(&mut self) -> f32 {
        let x = self.of.get(self.taken).copied().unwrap_or(0.5);
        self.taken += 1;
        x
    }

    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * f64::from(self.number())
    }

    /// Returns a number whose logarithm is uniform.
    pub(crate) fn scale(&mut self, lo: f64, hi: f64) -> f64 {
        self.between(lo.ln(), hi.ln()).exp()
    }

    /// Returns a number of `[0, 1)`.
    fn xi(&mut self) -> f32 {
        self.number().min(LAST)
    }

    pub(crate) fn xi3(&mut self) -> [f32; 3] {
        let xi = [self.xi(), self.xi(), self.xi()];
        self.note("xi", &xi);
        xi
    }

    /// Returns the place of a number in a list of so many.
    fn place(&mut self, count: usize) -> f32 {
        (self.xi() * narrow(count as f64)).floor()
    }

    /// Returns values of the model's random materials: every number of the range that `Field::draw` has.
    pub(crate) fn values(&mut self, model: ModelId) -> Values {
        let mut values = model.measured();
        for field in model.fields() {
            let numbers: Option<Vec<f32>> = (0..field.kind.width())
                .map(|_| match (field.kind, field.draw) {
                    (Kind::Word(words), _) => Some(self.place(words.len())),
                    (_, Some(draw)) => {
                        let [least, most] = [draw.least, draw.most].map(f64::from);
                        let x = if draw.log {
                            self.scale(least, most)
                        } else {
                            self.between(least, most)
                        };
                        Some(narrow(x) * draw.unit)
                    }
                    _ => None,
                })
                .collect();
            if let Some(numbers) = numbers {
                self.note(field.name, &numbers);
                values = values.with(field.name, &numbers);
            }
        }
        values
    }

    /// Replaces the numbers of a field by numbers of this range, which are uniform, or whose logarithms are.
    pub(crate) fn numbers(
        &mut self,
        values: Values,
        name: &str,
        count: usize,
        [lo, hi]: [f64; 2],
        is_log: bool,
    ) -> Values {
        let draw = |_| {
            let x = if is_log {
                self.scale(lo, hi)
            } else {
                self.between(lo, hi)
            };
            narrow(x).clamp(narrow(lo), narrow(hi))
        };
        let numbers: Vec<f32> = (0..count).map(draw).collect();
        self.note(name, &numbers);
        values.with(name, &numbers)
    }

    /// Returns an inclination at least so far from the axis: half of the coordinate for 0.1 rad at either pole.
    pub(crate) fn inclination(&mut self, least: f64) -> f64 {
        const NEAR: f64 = 0.1;
        let side = self.between(-1.0, 1.0);
        let off = if side.abs() < 0.5 {
            FRAC_PI_2 - 2.0 * side.abs() * (FRAC_PI_2 - NEAR)
        } else {
            NEAR * (least / NEAR).powf(2.0 * side.abs() - 1.0)
        };
        (FRAC_PI_2 - off).copysign(side)
    }

    /// Returns an angle between azimuths: a quarter of the coordinate for 0.01 rad on either side of pi.
    fn turn(&mut self) -> f64 {
        const NEAR: f64 = 1e-2;
        let side = self.between(-1.0, 1.0);
        let off = if side.abs() < 0.75 {
            PI - side.abs() / 0.75 * (PI - NEAR)
        } else {
            NEAR * 1e-7_f64.powf(4.0 * side.abs() - 3.0)
        };
        (PI - off).copysign(side)
    }

    /// Returns a hit, seen from at least so far from the axis.
    pub(crate) fn hit(&mut self, least: f64) -> Hit {
        let wo = direction(self.inclination(least), self.between(-PI, PI));
        let h = narrow(self.between(-1.0, 1.0));
        self.note("wo", &wo);
        self.note("h", &h);
        Hit { wo: wo.into(), h }
    }

    /// Returns a direction at least so far from the axis.
    pub(crate) fn direction(&mut self, least: f64, hit: &Hit) -> Vec3 {
        let theta = self.inclination(least);
        let wi = direction(theta, azimuth(hit.wo.into()) - self.turn());
        self.note("wi", &wi);
        wi
    }
}

fn azimuth(v: Vec3) -> f64 {
    f64::from(v.z).atan2(f64::from(v.y))
}

/// Shading point of a model.
pub(crate) struct Point {
    pub(crate) model: ModelId,
    pub(crate) values: Values,
    pub(crate) material: AnyMaterial,
    pub(crate) hit: Hit,
}

impl Point {
    pub(crate) fn new(model: ModelId, values: Values, hit: Hit) -> Self {
        let material = model
            .material(&values)
            .unwrap_or_else(|error| panic!("{error}: {values:?}"));
        Self {
            model,
            values,
            material,
            hit,
        }
    }

    /// Returns the point of a random material.
    pub(crate) fn random(model: ModelId, at: &mut Coordinates<'_>, least: f64) -> Self {
        let values = at.values(model);
        Self::new(model, values, at.hit(least))
    }

    pub(crate) fn wo(&self) -> [f64; 3] {
        [self.hit.wo.x, self.hit.wo.y, self.hit.wo.z].map(f64::from)
    }

    pub(crate) fn reference(&self) -> Box<dyn Reference<f64>> {
        reference(self.model, &self.values, self.wo(), f64::from(self.hit.h))
            .unwrap_or_else(|error| panic!("{error}: {:?}", self.values))
    }

    pub(crate) fn prepare(&self) -> AnyBsdf {
        self.material.prepare(self.hit)
    }

    /// Returns the hit in each of eight lanes.
    pub(crate) fn hits(&self) -> Hit8 {
        let mut hits = Hit8::from(&Vec3x8::from([Vec3::from(self.hit.wo); 8]));
        hits.h = f32x8::splat(self.hit.h);
        hits
    }
}
