//! Direct light by resampling: rays are traced for the candidates that would bring the most light.

use crate::lights::{LightSample, Seen};
use crate::material::{Prepared, cosine};
use crate::numbers::Numbers;
use crate::scene::Scene;
use glam::Vec3;
use hairis::resample::{Counts, Partition, Weighed8, choose};
use hairis::wide::f32x8;
use hairis::{FiberFrame8, Vec3x8};

/// Candidates of each technique per ray, where one shading point has many.
const PER_RAY: u32 = 2;
/// Candidates of the lights for one ray of a path.
const OF_LIGHTS: usize = 8;

/// A direction that may be worth a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Unit direction.
    pub(super) direction: Vec3,
    /// Cosine of its inclination.
    pub(super) cos: f32,
    /// Distance to the light.
    pub(super) distance: f32,
}

/// Candidates of one shading point by column. Allocated once per tile.
#[derive(Debug, Default)]
pub(super) struct Candidates {
    candidates: Vec<Candidate>,
    contribution: [Vec<f32>; 3],
    weight: Vec<f32>,
    u: f32,
}

/// Point `i` of a sequence that fills the cube evenly (Roberts's generalised golden ratio), shifted.
///
/// Candidates need not be independent for the estimate to be unbiased, each is to be uniform; one random shift for all of
/// them does it, and costs less than numbers of the picture's sequence.
#[inline]
fn shifted(shift: [f32; 3], i: u32) -> [f32; 3] {
    const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];
    core::array::from_fn(|axis| {
        let x = f64::from(shift[axis]) + f64::from(i) * STEPS[axis];
        #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is the purpose")]
        let x = (x - x.floor()) as f32;
        x.min(1.0 - f32::EPSILON / 2.0)
    })
}

impl Candidates {
    /// Draws and weighs [`PER_RAY`] candidates of each technique per ray.
    pub(super) fn draw(
        &mut self,
        scene: &Scene,
        origin: Vec3,
        frame: &FiberFrame8,
        prepared: &Prepared,
        numbers: &mut Numbers,
        rays: u32,
    ) {
        self.candidates.clear();
        self.contribution.iter_mut().for_each(Vec::clear);
        self.weight.clear();
        let each = PER_RAY * rays;
        let counts = Counts { bsdf: each, light: each };
        let [x, y, choice, u] = numbers.four();
        self.u = u;
        for first in (0..each).step_by(8) {
            let lights: [Option<LightSample>; 8] = core::array::from_fn(|lane| {
                let index = first + u32::try_from(lane).unwrap_or(0);
                (index < each).then(|| scene.sample_light(origin, shifted([x, y, choice], index))).flatten()
            });
            let directions = lights.map(|light| light.map_or(Vec3::ZERO, |light| light.direction));
            let wi = frame.to_local(&Vec3x8::from(directions));
            let seen = lights.map(|light| {
                let light = light?;
                Some((Seen { radiance: light.radiance, pdf: light.pdf }, light.distance))
            });
            self.push(prepared, directions, &wi, seen, counts);
        }
        let [lobe, theta, phi, _] = numbers.four();
        for first in (0..each).step_by(8) {
            let mut xi = [[0.0; 8]; 3];
            for (lane, index) in (first..each).take(8).enumerate() {
                let number = shifted([lobe, theta, phi], index);
                (0..3).for_each(|axis| xi[axis][lane] = number[axis]);
            }
            let sample = prepared.sample8(&xi);
            let world = frame.to_world(&sample.wi);
            let directions = core::array::from_fn(|lane| world.lane(lane).normalize_or(Vec3::Y));
            let along = scene.lights_along(origin, &directions);
            let seen = core::array::from_fn(|lane| {
                let drawn = sample.pdf.as_array()[lane] > 0.0 && first + u32::try_from(lane).unwrap_or(8) < each;
                along[lane].filter(|_| drawn)
            });
            self.push(prepared, directions, &sample.wi, seen, counts);
        }
    }

    /// Weighs eight directions, those of no light excepted.
    fn push(
        &mut self,
        prepared: &Prepared,
        directions: [Vec3; 8],
        wi: &Vec3x8,
        seen: [Option<(Seen, f32)>; 8],
        counts: Counts,
    ) {
        if seen.iter().all(Option::is_none) {
            return;
        }
        let cos = cosine(wi);
        let weighed = weigh(prepared, wi, &cos, &seen.map(|seen| seen.map(|(seen, _)| seen)), counts, Partition::All);
        for (lane, seen) in seen.iter().enumerate() {
            let Some((_, distance)) = *seen else { continue };
            let cos = cos.as_array()[lane];
            self.candidates.push(Candidate { direction: directions[lane], cos, distance });
            for (column, contribution) in self.contribution.iter_mut().zip(&weighed.contribution) {
                column.push(contribution.as_array()[lane]);
            }
            self.weight.push(weighed.weight.as_array()[lane]);
        }
    }

    /// The candidates that are worth a ray, and the radiance that each brings unless it is blocked.
    pub(super) fn choose(&self, rays: u32) -> impl Iterator<Item = (Candidate, Vec3)> {
        let contribution = self.contribution.each_ref().map(|column| &column[..]);
        choose(contribution, &self.weight, rays, self.u)
            .map(|choice| (self.candidates[choice.index], Vec3::from_array(choice.contribution)))
    }
}

/// Weighs a direction per lane; those that see no light weigh nothing.
fn weigh(
    prepared: &Prepared,
    wi: &Vec3x8,
    cos: &f32x8,
    seen: &[Option<Seen>; 8],
    counts: Counts,
    partition: Partition,
) -> Weighed8 {
    let lanes = |of: fn(&Seen) -> f32| f32x8::new(seen.each_ref().map(|seen| seen.as_ref().map_or(0.0, of)));
    let radiance = [lanes(|seen| seen.radiance.x), lanes(|seen| seen.radiance.y), lanes(|seen| seen.radiance.z)];
    Weighed8::new(&prepared.eval8(wi), cos, &radiance, &lanes(|seen| seen.pdf), counts, partition)
}

/// One of [`OF_LIGHTS`] candidates of the lights for each of eight hits, and the radiance that it brings unless it is
/// blocked: the lights' share by the power heuristic, whose rest is the path's next ray's.
pub(super) fn of_lights(
    scene: &Scene,
    origins: &[Vec3; 8],
    frames: &FiberFrame8,
    prepared: &Prepared,
    numbers: &[[f32; 4]; 8],
    hits: usize,
) -> [Option<(Candidate, Vec3)>; 8] {
    let counts = Counts { bsdf: 0, light: 8 };
    let mut candidates = [[Candidate { direction: Vec3::ZERO, cos: 0.0, distance: 0.0 }; OF_LIGHTS]; 8];
    let mut contribution = [[[0.0; OF_LIGHTS]; 3]; 8];
    let mut weight = [[0.0; OF_LIGHTS]; 8];
    for (k, i) in (0..OF_LIGHTS).zip(0..) {
        let lights: [Option<LightSample>; 8] = core::array::from_fn(|lane| {
            let [x, y, choice, _] = numbers[lane];
            (lane < hits).then(|| scene.sample_light(origins[lane], shifted([x, y, choice], i))).flatten()
        });
        let directions = lights.map(|light| light.map_or(Vec3::ZERO, |light| light.direction));
        let wi = frames.to_local(&Vec3x8::from(directions));
        let cos = cosine(&wi);
        let seen = lights.map(|light| light.map(|light| Seen { radiance: light.radiance, pdf: light.pdf }));
        let weighed = weigh(prepared, &wi, &cos, &seen, counts, Partition::Power);
        for lane in 0..8 {
            let distance = lights[lane].map_or(0.0, |light| light.distance);
            candidates[lane][k] = Candidate { direction: directions[lane], cos: cos.as_array()[lane], distance };
            (0..3).for_each(|c| contribution[lane][c][k] = weighed.contribution[c].as_array()[lane]);
            weight[lane][k] = weighed.weight.as_array()[lane];
        }
    }
    core::array::from_fn(|lane| {
        let contribution = contribution[lane].each_ref().map(|column| &column[..]);
        let choice = choose(contribution, &weight[lane], 1, numbers[lane][3]).next()?;
        Some((candidates[lane][choice.index], Vec3::from_array(choice.contribution)))
    })
}
