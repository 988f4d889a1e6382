//! Portraits: hairstyles on busts, with the material of each head, the lights and the camera of a studio.

pub mod bust;
mod guides;
mod scalp;
mod strands;
mod style;

pub use style::Style;

use crate::camera::Camera;
use crate::geometry::{GeometryError, Mesh, Strands};
use crate::hair::{Choice, default_sampler};
use crate::lights::Rectangle;
use glam::{Quat, Vec3};
use hairis_instruments::error::Error;

/// Share of the light that the busts reflect: grey, with a little of the colour of skin.
pub const ALBEDO: Vec3 = Vec3::new(0.34, 0.29, 0.26);
/// Distance between the heads of a picture in centimetres.
const DISTANCE: f32 = 29.0;
/// Width of the cells of the busts' mesh in centimetres.
const CELL: f32 = 0.25;
/// Distance of the camera from the heads in centimetres, as of a long lens.
const CAMERA: f32 = 320.0;
/// Height of the middle of the picture above the ears, and the height that is seen, in centimetres.
const MIDDLE: f32 = -5.2;
const SEEN: f32 = 41.0;

/// Model of the hair.
const MODEL: &str = "chiang";

/// Head of a picture: its hairstyle, the melanin of its hair, and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Portrait {
    /// Hairstyle.
    pub style: Style,
    /// Values of the hair's parameters in the model of Chiang et al., as `--set` takes them.
    pub material: &'static [&'static str],
    /// Degrees by which the head is turned from the camera, to the right.
    pub turn: f32,
}

/// Wavy blond hair.
pub const WAVY: Portrait = Portrait {
    style: Style::WAVY,
    material: &["beta_m=0.3", "beta_n=0.8", "melanin_amount=0.24,0.4"],
    turn: 128.0,
};
/// Curly brown hair.
pub const CURLY: Portrait = Portrait {
    style: Style::CURLY,
    material: &["beta_m=0.3", "beta_n=0.7", "melanin_amount=0.7,0.35"],
    turn: 155.0,
};
/// Straight black hair.
pub const STRAIGHT: Portrait = Portrait {
    style: Style::STRAIGHT,
    material: &["beta_m=0.22", "beta_n=0.4", "melanin_amount=0.995,0.05"],
    turn: 232.0,
};

impl Portrait {
    /// Returns the material of the hair, sampled as `sampler` says or else by the best sampler of the model.
    ///
    /// # Errors
    ///
    /// Returns a usage error if the model has no such sampler.
    pub fn hair(&self, sampler: Option<&str>) -> Result<Choice, Error> {
        let sampler = sampler.unwrap_or_else(|| default_sampler(MODEL));
        let values: Vec<String> = self
            .material
            .iter()
            .map(|value| (*value).to_owned())
            .collect();
        let hair = Choice::find(MODEL, sampler, "default")?.set(&values)?;
        Ok(Choice {
            name: self.style.name.to_owned(),
            ..hair
        })
    }
}

/// Returns the place of a head among several: the angle about the vertical axis in rad, and the shift.
fn place(portraits: &[Portrait], index: usize) -> (f32, Vec3) {
    let middle = 0.5 * (portraits.len() as f32 - 1.0);
    let shift = DISTANCE * (index as f32 - middle) * Vec3::X;
    (portraits[index].turn.to_radians(), shift)
}

/// Grows the hair of all heads, `count` strands on each, head by head.
///
/// # Errors
///
/// Returns an error if a measure of a style is out of its range, or the count of strands.
pub fn grow(portraits: &[Portrait], count: usize) -> Result<Strands, GeometryError> {
    let most = (1 << 24) / portraits.len().max(1);
    if !(1..=most).contains(&count) {
        return Err(GeometryError::Count {
            name: "strands",
            value: count,
            least: 1,
            most,
        });
    }
    let mut builder = Strands::builder();
    for (index, portrait) in portraits.iter().enumerate() {
        portrait.style.check()?;
        let (angle, shift) = place(portraits, index);
        let turn = Quat::from_rotation_y(angle);
        for strand in strands::strands(&portrait.style, count) {
            builder.push(
                strand
                    .into_iter()
                    .map(|(node, radius)| (shift + turn * node, radius)),
            )?;
        }
    }
    Ok(builder.finish())
}

/// Iterates over the first strands of all heads but the first head, for `count` strands on each: see
/// [`Scene::others`](crate::scene::Scene::others).
pub fn firsts(count: usize) -> impl Iterator<Item = u32> {
    let count = u32::try_from(count).unwrap_or(u32::MAX);
    (1..).map(move |head: u32| head.saturating_mul(count))
}

/// Returns a bound of the segments that [`grow`] makes.
#[must_use]
pub fn most_segments(portraits: &[Portrait], count: usize) -> u64 {
    let nodes = portraits.iter().map(|Portrait { style, .. }| {
        f64::from(style.length * (1.0 + 2.0 * style.length_spread) / style.step()).ceil()
    });
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the cast saturates"
    )]
    let most = (nodes.sum::<f64>() * count as f64) as u64;
    most
}

/// Returns the busts under the hair of all heads.
///
/// # Errors
///
/// Returns a line of text if a mesh cannot be made, which does not happen for a few heads.
pub fn busts(portraits: &[Portrait]) -> Result<Mesh, String> {
    let bust = bust::mesh(CELL)?;
    Mesh::join((0..portraits.len()).map(|index| {
        let (angle, shift) = place(portraits, index);
        (bust.clone(), angle, shift)
    }))
}

/// Returns the camera of a picture of all heads.
#[must_use]
pub fn camera(size: [u32; 2]) -> Camera {
    let view = 2.0 * libm::atanf(0.5 * SEEN / CAMERA).to_degrees();
    let at = MIDDLE * Vec3::Y;
    Camera::new(at + Vec3::new(0.0, 45.0, CAMERA), at, view, size)
}

/// Returns the studio: a large key light to the upper left, a weak fill to the right, rim lights behind the heads, and the wall. `scale` is
/// that of the studio about `origin`.
#[must_use]
pub fn studio(origin: Vec3, scale: f32) -> Vec<Rectangle> {
    let light = |centre: [f32; 3], [width, height]: [f32; 2], radiance: [f32; 3]| {
        let centre = Vec3::from_array(centre);
        let towards = -centre.normalize();
        let (centre, width, height) = (origin + scale * centre, scale * width, scale * height);
        let across = towards.cross(Vec3::Y).normalize();
        let up = across.cross(towards);
        let corner = centre - 0.5 * (width * across + height * up);
        Rectangle::light(
            corner,
            width * across,
            height * up,
            Vec3::from_array(radiance),
        )
        .facing(origin)
    };
    vec![
        light([-170.0, 150.0, 170.0], [220.0, 200.0], [3.6, 3.5, 3.35]),
        light([250.0, 30.0, 150.0], [200.0, 200.0], [0.9, 0.96, 1.1]),
        light([-140.0, 120.0, -110.0], [100.0, 120.0], [7.0, 7.0, 7.4]),
        light([140.0, 120.0, -110.0], [100.0, 120.0], [7.0, 7.0, 7.4]),
        Rectangle::wall(
            origin + scale * Vec3::new(-600.0, -300.0, -160.0),
            scale * 1200.0 * Vec3::X,
            scale * 900.0 * Vec3::Y,
            Vec3::new(0.11, 0.117, 0.13),
        )
        .facing(origin),
    ]
}
