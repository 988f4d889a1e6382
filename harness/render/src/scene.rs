//! Scene of a picture: hair, a head, walls and lights, and a camera.

mod head;

pub use head::{Ellipsoid, Head, Shape};

use crate::camera::Camera;
use crate::geometry::Strands;
use crate::lights::{LightSample, LightSample8, Rectangle, RectangleSampling, Seen, Sky, View};
use crate::material::Hair;
use crate::tree::{self, Meet, Ray, Tree};
use glam::Vec3;
use hairis::Vec3x8;
use hairis::simd::f32x8;
use hairis_instruments::light::Seen8;

/// Share of the distance to a light after which rays towards it end.
const SHORTER: f32 = 1.0 - 1e-4;

/// First object along a ray: a fibre, a surface, a light, or the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Met {
    /// Nothing, so that the ray reaches the sky.
    Nothing,
    /// Fibre, with the place of the hit.
    Hair(tree::Hit),
    /// Surface that reflects: the point, the normal on the side of the ray, and the albedo.
    Surface(Vec3, Vec3, Vec3),
    /// Light, as its index among the rectangles.
    Light(usize),
}

/// Scene in which rays are traced, made by [`scenes`](crate::scenes) or by hand.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Fibres of the hair.
    pub strands: Strands,
    /// Tree over the strands.
    pub tree: Tree,
    /// Material of the hair.
    pub hair: Hair,
    /// Materials of further heads of hair, each from a strand on, in ascending order of strands.
    pub others: Vec<(u32, Hair)>,
    /// Head on which the hair grows.
    pub head: Option<Head>,
    /// Walls and lights.
    pub rectangles: Vec<Rectangle>,
    /// Method that draws directions towards rectangles that emit.
    pub rectangle_sampling: RectangleSampling,
    /// Light from infinitely far away.
    pub sky: Sky,
    /// Radiance that the camera sees where there is nothing, in place of the sky.
    pub backdrop: Option<Vec3>,
    /// Camera of the picture.
    pub camera: Camera,
    /// Distance above a surface at which rays that leave it start, in centimetres.
    pub gap: f32,
}

impl Scene {
    /// Returns the material of a strand: its place among those of the scene, and the material itself.
    #[inline]
    #[must_use]
    pub fn hair_of(&self, strand: u32) -> (usize, &Hair) {
        let place = self.others.partition_point(|(first, _)| *first <= strand);
        let hair = place
            .checked_sub(1)
            .map_or(&self.hair, |other| &self.others[other].1);
        (place, hair)
    }

    /// Returns the indices of the pixels whose centre shows hair, row by row.
    #[must_use]
    pub fn pixels_of_hair(&self) -> Vec<usize> {
        let [width, height] = self.camera.size();
        let ray = |x: u32, y: u32| self.camera.ray(x as f32 + 0.5, y as f32 + 0.5);
        (0..)
            .zip((0..height).flat_map(|y| (0..width).map(move |x| (x, y))))
            .filter(|(_, (x, y))| matches!(self.closest(&ray(*x, *y)), Met::Hair(_)))
            .map(|(k, _)| k)
            .collect()
    }

    /// Finds the first object along a ray, among hair, head and rectangles.
    #[inline]
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Met {
        let mut ray = *ray;
        let mut met = Met::Nothing;
        if let Some(head) = &self.head
            && let Some((t, normal)) = head.meet(&ray)
        {
            ray.t_max = t;
            met = Met::Surface(ray.origin + t * ray.direction, normal, head.albedo);
        }
        for (index, rectangle) in self.rectangles.iter().enumerate() {
            let Some(t) = rectangle
                .meet(ray.origin, ray.direction, 0.0)
                .filter(|t| *t < ray.t_max)
            else {
                continue;
            };
            ray.t_max = t;
            met = if rectangle.emission == Vec3::ZERO {
                let towards = rectangle.normal().dot(ray.direction) < 0.0;
                let normal = if towards {
                    rectangle.normal()
                } else {
                    -rectangle.normal()
                };
                Met::Surface(ray.origin + t * ray.direction, normal, rectangle.albedo)
            } else {
                Met::Light(index)
            };
        }
        self.tree.closest(&ray).map_or(met, Met::Hair)
    }

    /// Returns the start of rays that leave the hair that a ray has hit.
    #[inline]
    pub(crate) fn origin(&self, ray: &Ray, hit: &tree::Hit) -> Vec3 {
        match self.tree.meet() {
            Meet::Axis => self.strands.position(hit.segment, hit.s),
            Meet::Surface => ray.origin + hit.t * ray.direction,
        }
    }

    /// Returns true if hair, the head or a rectangle blocks a ray to a light.
    #[inline]
    #[must_use]
    pub fn blocked(&self, ray: &Ray) -> bool {
        self.blocked_by_surfaces(ray) || self.tree.occluded(ray)
    }

    /// Returns true if the head or a rectangle blocks a ray to a light, whatever hair is in between.
    #[inline]
    #[must_use]
    pub fn blocked_by_surfaces(&self, ray: &Ray) -> bool {
        let t_max = ray.t_max * SHORTER;
        let short = |t: f32| t < t_max;
        self.head
            .as_ref()
            .is_some_and(|head| head.blocks(&Ray { t_max, ..*ray }))
            || self
                .rectangles
                .iter()
                .any(|one| one.meet(ray.origin, ray.direction, 0.0).is_some_and(short))
    }

    /// Removes the radiance from directions that an ellipsoidal head blocks. The test is so cheap that
    /// candidates for rays pass it first.
    #[inline]
    pub fn remove_blocked(&self, origin: Vec3, light: &mut LightSample8) {
        let Some(Shape::Ellipsoid(head)) = self.head.as_ref().map(|head| &head.shape) else {
            return;
        };
        let clear = !head.blocks8(
            origin,
            &light.direction,
            &(light.distance * f32x8::splat(SHORTER)),
        );
        light.radiance = light.radiance.map(|channel| channel & clear);
    }

    /// Iterates over the indices of the rectangles that emit.
    fn lamps(&self) -> impl Iterator<Item = usize> {
        self.rectangles
            .iter()
            .enumerate()
            .filter(|(_, one)| one.emission != Vec3::ZERO)
            .map(|(index, _)| index)
    }

    /// Returns the view of a lamp from a point, or `None` from behind.
    #[inline]
    fn view(&self, lamp: usize, origin: Vec3) -> Option<View> {
        self.rectangles[lamp].view(origin, self.rectangle_sampling)
    }

    /// Returns the probability of each light; all are equally likely.
    fn share(&self) -> f32 {
        let lights = self.lamps().count() + usize::from(!self.sky.is_black());
        1.0 / lights.max(1) as f32
    }

    /// Returns the lamp that a number selects, or `None` for the sky.
    fn lamp(&self, choice: f32) -> Option<usize> {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small count; the cast saturates"
        )]
        let index = (choice / self.share()) as usize;
        self.lamps().nth(index)
    }

    /// Draws a direction towards a light, from two numbers for the direction and one for the choice of the light.
    #[inline]
    #[must_use]
    pub fn sample_light(&self, origin: Vec3, [x, y, choice]: [f32; 3]) -> Option<LightSample> {
        let sample = match self.lamp(choice) {
            Some(lamp) => self.view(lamp, origin).map(|view| view.sample([x, y])),
            None => self.sky.sample([x, y]),
        }?;
        Some(LightSample {
            pdf: sample.pdf * self.share(),
            ..sample
        })
    }

    /// Draws eight directions towards lights from a point per lane, as [`sample_light`](Self::sample_light) draws one. If there is a
    /// `sky`, directions towards it are its lanes.
    #[inline]
    #[must_use]
    pub fn sample_lights8(
        &self,
        origin: impl Fn(usize) -> Vec3,
        xi: &[[f32; 8]; 3],
        sky: Option<&LightSample8>,
    ) -> LightSample8 {
        if self.lamps().next().is_none() {
            return sky
                .copied()
                .unwrap_or_else(|| self.sky.sample8(&[xi[0], xi[1]]));
        }
        let (share, mut views) = (self.share(), Views::default());
        LightSample8::from(core::array::from_fn(|lane| {
            let [x, y, choice] = xi.each_ref().map(|axis| axis[lane]);
            let sample = match (self.lamp(choice), sky) {
                (Some(lamp), _) => views.of(self, lamp, origin(lane))?.sample([x, y]),
                (None, Some(sky)) => return sky.lane(lane, share),
                (None, None) => self.sky.sample([x, y])?,
            };
            Some(LightSample {
                pdf: sample.pdf * share,
                ..sample
            })
        }))
    }

    /// Returns the lights in eight directions from a point: the lamp that a ray would meet if there were nothing else, or the sky. Nearer
    /// objects are not considered.
    #[must_use]
    pub fn lights_along(&self, origin: Vec3, direction: &Vec3x8) -> LightSample8 {
        if self.lamps().next().is_none() {
            let Seen8 { radiance, pdf } = self.sky.see8(direction);
            return LightSample8 {
                direction: *direction,
                distance: f32x8::splat(f32::INFINITY),
                radiance,
                pdf,
            };
        }
        let (share, mut views) = (self.share(), Views::default());
        LightSample8::from(core::array::from_fn(|lane| {
            let direction = direction.lane(lane);
            let (lamp, distance) = self.lamp_along(origin, direction);
            let Seen { radiance, pdf } = match lamp {
                Some(lamp) => views.of(self, lamp, origin)?.see(direction),
                None => self.sky.see(direction),
            };
            (pdf > 0.0).then_some(LightSample {
                direction,
                distance,
                radiance,
                pdf: pdf * share,
            })
        }))
    }

    /// Returns the light along a ray that met no hair and no surface, or `None` if there is none.
    #[inline]
    #[must_use]
    pub fn see(&self, ray: &Ray, met: &Met) -> Option<Seen> {
        let seen = match met {
            Met::Hair(_) | Met::Surface(..) => return None,
            Met::Nothing => self.sky.see(ray.direction),
            Met::Light(index) => self.view(*index, ray.origin)?.see(ray.direction),
        };
        (seen.pdf > 0.0).then_some(Seen {
            pdf: seen.pdf * self.share(),
            ..seen
        })
    }

    /// Returns the radiance along a ray from the camera that met no hair and no surface. If there is a backdrop, it takes the place of
    /// the sky.
    #[inline]
    #[must_use]
    pub fn see_from_camera(&self, ray: &Ray, met: &Met) -> Option<Vec3> {
        match (met, self.backdrop) {
            (Met::Nothing, Some(radiance)) => Some(radiance),
            _ => Some(self.see(ray, met)?.radiance),
        }
    }

    /// Returns the lamp that a ray would meet if there were nothing else, with its distance, or `None` for the sky.
    #[inline]
    fn lamp_along(&self, origin: Vec3, direction: Vec3) -> (Option<usize>, f32) {
        let mut nearest = (None, f32::INFINITY);
        for lamp in self.lamps() {
            if let Some(t) = self.rectangles[lamp]
                .meet(origin, direction, 0.0)
                .filter(|t| *t < nearest.1)
            {
                nearest = (Some(lamp), t);
            }
        }
        nearest
    }
}

/// View of the lamp that was last seen, and from where, because most directions from a point are towards the same lamp.
#[derive(Default)]
struct Views(Option<(usize, Vec3, Option<View>)>);

impl Views {
    #[inline]
    fn of(&mut self, scene: &Scene, lamp: usize, origin: Vec3) -> Option<View> {
        match self.0 {
            Some((last, from, view)) if last == lamp && from == origin => view,
            _ => {
                let view = scene.view(lamp, origin);
                self.0 = Some((lamp, origin, view));
                view
            }
        }
    }
}
