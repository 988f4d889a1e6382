//! Scenes by name: the set-ups of the paper's figures, one for fits, and two that test transport.

use crate::camera::Camera;
use crate::geometry::{Bounds, Flattening, Groom, HEAD, Kind, Strands};
use crate::lights::{Rectangle, RectangleSampling, Sky};
use crate::material::Hair;
use crate::portrait::{self, Portrait};
use crate::scene::{Ellipsoid, Head, Scene};
use crate::transport::Integrator;
use crate::tree::Tree;
use clap::ValueEnum;
use glam::Vec3;
use hairis_instruments::error::Error;
use hairis_instruments::light::{self, Environment};

/// The scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Name {
    /// A patch of parallel strands under a large light along them, glossy hair: Figure 6A
    Area,
    /// Glossy patch of the model's default hair
    AreaSoft,
    /// A head under an area light, direct light: Figure 7A
    AreaHead,
    /// A head under an environment map, or a clear sky: Figures 6B and 7B
    Env,
    /// A head in a Cornell box, hair that scatters light once: Figure 6C
    BoxSingle,
    /// Cornell box with multiple scattering: Figure 6D
    Box,
    /// A head under an area light, with multiple scattering: Figure 1
    Head,
    /// A head under four lamps, with multiple scattering: pictures whose hair `fit` recovers
    Lamps,
    /// One strand in a white sphere
    FurnaceOne,
    /// A patch that absorbs nothing in a white sphere
    FurnaceIso,
    /// Three heads in a studio: wavy blond, curly brown and straight black hair
    Portraits,
    /// The head with wavy blond hair alone
    Wavy,
    /// The head with curly brown hair alone
    Curly,
    /// The head with straight black hair alone
    Straight,
}

/// Default settings of a scene, which flags may replace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defaults {
    /// Integrator that estimates the light.
    pub integrator: Integrator,
    /// Name of the preset of the hair.
    pub preset: &'static str,
    /// Samples per pixel.
    pub samples: u32,
    /// Strands of procedural hair, of each head if there are several.
    pub strands: usize,
    /// Whether hair passes light on to hair.
    pub multiple: bool,
}

impl Name {
    /// Returns the name of the scene on the command line.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Area => "area",
            Self::AreaSoft => "area-soft",
            Self::AreaHead => "area-head",
            Self::Env => "env",
            Self::BoxSingle => "box-single",
            Self::Box => "box",
            Self::Head => "head",
            Self::Lamps => "lamps",
            Self::FurnaceOne => "furnace-one",
            Self::FurnaceIso => "furnace-iso",
            Self::Portraits => "portraits",
            Self::Wavy => "wavy",
            Self::Curly => "curly",
            Self::Straight => "straight",
        }
    }

    /// Returns the default settings of the scene, which flags may replace.
    #[must_use]
    pub fn defaults(self) -> Defaults {
        let gather = |preset| Defaults {
            integrator: Integrator::Gather,
            preset,
            samples: 64,
            strands: 30_000,
            multiple: true,
        };
        let paths = Defaults {
            integrator: Integrator::Path,
            preset: "blond",
            samples: 64,
            strands: 30_000,
            multiple: true,
        };
        match self {
            Self::Area => gather(crate::hair::GLOSSY),
            Self::AreaSoft => gather("default"),
            Self::AreaHead | Self::Env => gather("blond"),
            Self::BoxSingle => Defaults {
                multiple: false,
                ..paths
            },
            Self::Box | Self::Head | Self::Lamps | Self::FurnaceOne | Self::FurnaceIso => paths,
            Self::Portraits | Self::Wavy | Self::Curly | Self::Straight => Defaults {
                samples: 256,
                strands: 80_000,
                ..paths
            },
        }
    }

    /// Returns the heads of the scene if they are portraits, or else none.
    #[must_use]
    pub fn portraits(self) -> &'static [Portrait] {
        match self {
            Self::Portraits => &[portrait::WAVY, portrait::CURLY, portrait::STRAIGHT],
            Self::Wavy => &[portrait::WAVY],
            Self::Curly => &[portrait::CURLY],
            Self::Straight => &[portrait::STRAIGHT],
            _ => &[],
        }
    }

    /// Returns the kind of procedural hair that grows in the scene, or `None` for portraits, whose heads have hairstyles.
    #[must_use]
    pub fn kind(self) -> Option<Kind> {
        match self {
            Self::Area | Self::AreaSoft | Self::FurnaceIso => Some(Kind::Patch),
            Self::AreaHead | Self::Env => Some(Kind::Straight),
            Self::BoxSingle | Self::Box | Self::Head | Self::Lamps => Some(Kind::Wavy),
            Self::FurnaceOne => Some(Kind::Single),
            Self::Portraits | Self::Wavy | Self::Curly | Self::Straight => None,
        }
    }
}

/// Grows the hair of a scene, of `count` strands if the kind has many, or on each head of portraits.
///
/// # Errors
///
/// Returns a usage error if the count of strands is out of its range.
pub fn grow(name: Name, count: usize) -> Result<Strands, Error> {
    match groom(name, count) {
        Some(groom) => groom.grow(&Flattening::default()),
        None => portrait::grow(name.portraits(), count),
    }
    .map_err(|problem| Error::Usage(problem.to_string()))
}

/// Estimates how many segments [`grow`] will make, without growing all strands.
///
/// # Errors
///
/// Returns a usage error if the count of strands is out of its range.
pub fn estimate_segments(name: Name, count: usize) -> Result<u64, Error> {
    match groom(name, count) {
        Some(groom) => groom
            .estimate_segments(&Flattening::default())
            .map_err(|problem| Error::Usage(problem.to_string())),
        None => Ok(portrait::most_segments(name.portraits(), count)),
    }
}

/// Returns the settings of the hair of a scene, or `None` for portraits.
fn groom(name: Name, count: usize) -> Option<Groom> {
    let groom = Groom::new(name.kind()?, count);
    Some(if groom.kind == Kind::Single {
        Groom {
            length: 400.0,
            radius: 10.0,
            ..groom
        }
    } else {
        groom
    })
}

/// Positions of the four lamps, in cm: behind, to the sides and above.
const LAMPS: [[f32; 3]; 4] = [
    [-30.0, 40.0, -75.0],
    [60.0, 30.0, 50.0],
    [-70.0, -20.0, 30.0],
    [10.0, 80.0, 20.0],
];

/// Parts of which a scene is built, beside its name.
#[derive(Debug)]
pub struct Parts {
    /// Fibres of the hair.
    pub strands: Strands,
    /// Whether the fibres were read from a file, so that camera and lights depend on the extent of the
    /// hair, and of a mesh under it.
    pub imported: bool,
    /// Head under hair from a file; procedural hair has its own.
    pub head: Option<Head>,
    /// Material of the hair.
    pub hair: Hair,
    /// Environment map in place of the scene's light.
    pub env: Option<Environment>,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Degrees by which the camera goes around the hair.
    pub turn: f32,
}

/// Builds a scene from its parts: the tree, the lights, the camera and the head.
///
/// # Errors
///
/// Returns a usage error if the strands are too thin for their extent.
pub fn build(name: Name, parts: Parts) -> Result<Scene, Error> {
    let Parts {
        strands,
        imported,
        head,
        hair,
        env,
        size,
        turn,
    } = parts;
    let tree = Tree::build(&strands).map_err(|problem| Error::Usage(problem.to_string()))?;
    // A mesh counts, but not a fitted ellipsoid, which extends to where there is no hair.
    let beside = match &head {
        Some(head) if head.triangles() > 0 => head.bounds(),
        _ => Bounds::EMPTY,
    };
    let bounds = strands.bounds().union(&beside);
    let extent = bounds.size().length().max(1e-3);
    // Set-ups are for a head at the origin, 26 cm wide with its hair.
    let (scale, centre) = if imported {
        (extent / 40.0, bounds.centre())
    } else {
        (1.0, Vec3::ZERO)
    };
    let at = |x: f32, y: f32, z: f32| centre + scale * Vec3::new(x, y, z);
    let lamp = |corner: Vec3, a: Vec3, b: Vec3, radiance: f32| {
        Rectangle::light(corner, scale * a, scale * b, Vec3::splat(radiance)).facing(centre)
    };
    let (x, z) = (Vec3::X, Vec3::Z);
    let mut sky = Sky::BLACK;
    let mut rectangles = Vec::new();
    match name {
        Name::Area | Name::AreaSoft => {
            rectangles.push(lamp(at(-100.0, 22.0, -25.0), 200.0 * x, 50.0 * z, 1.0))
        }
        Name::AreaHead | Name::Head => {
            rectangles.push(lamp(at(-20.0, 30.0, -10.0), 40.0 * x, 40.0 * z, 6.0))
        }
        Name::Lamps => rectangles.extend(LAMPS.map(|[x, y, z]| {
            let place = Vec3::new(x, y, z);
            let (a, b) = place.normalize().any_orthonormal_pair();
            let corner = place - 6.0 * (a + b);
            lamp(at(corner.x, corner.y, corner.z), 12.0 * a, 12.0 * b, 60.0)
        })),
        Name::Env => sky = light::Sky::default().environment().into(),
        Name::BoxSingle | Name::Box => rectangles = cornell_box(centre, scale),
        Name::FurnaceOne | Name::FurnaceIso => sky = light::Constant.into(),
        Name::Portraits | Name::Wavy | Name::Curly | Name::Straight => {
            rectangles = portrait::studio(centre, scale)
        }
    }
    if let Some(env) = env {
        sky = env.into();
        rectangles.clear();
    }
    let camera = match name {
        _ if imported => Camera::new(at(0.0, 9.0, 52.0), centre, 42.0, size),
        Name::Area | Name::AreaSoft => {
            Camera::new(at(6.0, 14.0, 26.0), at(-0.5, -1.5, 0.0), 34.0, size)
        }
        Name::BoxSingle | Name::Box => {
            Camera::new(at(0.0, 3.0, 85.0), at(0.0, -1.0, 0.0), 42.0, size)
        }
        Name::FurnaceOne => Camera::new(at(0.0, 0.0, 100.0), centre, 8.0, size),
        Name::FurnaceIso => Camera::new(at(6.0, 14.0, 26.0), centre, 30.0, size),
        Name::AreaHead | Name::Env | Name::Head | Name::Lamps => {
            Camera::new(at(0.0, 6.0, 68.0), at(0.0, -2.0, 0.0), 36.0, size)
        }
        Name::Portraits | Name::Wavy | Name::Curly | Name::Straight => portrait::camera(size),
    };
    let camera = camera.orbit(centre, turn);
    let head = match name.kind() {
        _ if imported => head,
        Some(Kind::Straight | Kind::Wavy) => Some(Head::ellipsoid(Ellipsoid {
            centre: Vec3::ZERO,
            radii: 0.995 * HEAD,
        })),
        Some(_) => head,
        None => Some(Head {
            albedo: portrait::ALBEDO,
            ..Head::mesh(portrait::busts(name.portraits()).map_err(Error::Usage)?)
        }),
    };
    let rectangle_sampling = RectangleSampling::default();
    let gap = 1e-3 * scale;
    Ok(Scene {
        strands,
        tree,
        hair,
        others: Vec::new(),
        head,
        rectangles,
        rectangle_sampling,
        sky,
        backdrop: None,
        camera,
        gap,
    })
}

/// Returns a box of 60 cm with a light below its ceiling, open towards the camera.
fn cornell_box(centre: Vec3, scale: f32) -> Vec<Rectangle> {
    let at = |x: f32, y: f32, z: f32| centre + scale * Vec3::new(x, y, z);
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| 60.0 * scale * axis);
    let (white, red, green) = (
        Vec3::splat(0.73),
        Vec3::new(0.65, 0.05, 0.05),
        Vec3::new(0.12, 0.45, 0.15),
    );
    let lo = at(-30.0, -30.0, -30.0);
    vec![
        Rectangle::wall(lo, x, z, white),
        Rectangle::wall(lo, x, y, white),
        Rectangle::wall(lo + y, x, z, white),
        Rectangle::wall(lo, y, z, red),
        Rectangle::wall(lo + x, y, z, green),
        Rectangle::light(at(-12.0, 29.95, -12.0), 0.4 * x, 0.4 * z, Vec3::splat(14.0))
            .facing(centre),
    ]
}
