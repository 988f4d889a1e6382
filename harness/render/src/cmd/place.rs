//! Scene that the flags describe: hair, head, light and camera.

use crate::args::{Looks, Place};
use crate::environment::environment;
use crate::formats::{self, Follow, Import, Imported, import, import_head};
use crate::geometry::Strands;
use crate::hair::{Choice, default_sampler};
use crate::material::Hair;
use crate::memory;
use crate::scalp;
use crate::scene::{Head, Scene};
use crate::scenes::{self, Parts};
use hairis_instruments::error::Error;
use hairis_instruments::light::Environment;
use hairis_instruments::program::say;
use hairis_materials::files;
use std::path::Path;

/// Model of presets if the flags name none.
const MODEL: &str = "gaussian";

/// Hair, head and environment map of a scene.
pub(super) struct Ground {
    pub(super) strands: Strands,
    head: Option<Head>,
    /// Digests of the files of hair and head, 0 without a file.
    pub(super) digests: [u64; 2],
    pub(super) env: Option<Environment>,
}

impl Ground {
    /// Reads the files of a scene, or grows its hair if no file is given, for a picture of `pixels` pixels.
    ///
    /// # Errors
    ///
    /// Returns an error if a file cannot be read, or if there is not enough memory.
    pub(super) fn read(flags: &Place, pixels: usize) -> Result<Self, Error> {
        let pixels = pixels as u64;
        let read = |path| environment(path, flags.layer.as_deref());
        let env = flags.env.as_deref().map(read).transpose()?;
        let (strands, head, digests) = match &flags.import {
            Some(path) => {
                let (Imported { strands, scale, .. }, hair_digest) = read_hair(flags, path)?;
                let (head, head_digest) = read_head(flags, &strands, scale)?;
                let triangles = head.as_ref().map_or(0, Head::triangles);
                memory::check((strands.segments() + triangles) as u64, pixels)?;
                (strands, head, [hair_digest, head_digest])
            }
            None => {
                let count = strands(flags);
                memory::check(scenes::estimate_segments(flags.scene, count)?, pixels)?;
                (scenes::grow(flags.scene, count)?, None, [0; 2])
            }
        };
        Ok(Self {
            strands,
            head,
            digests,
            env,
        })
    }

    /// Returns the scene with this hair, for a picture of `size` pixels.
    ///
    /// # Errors
    ///
    /// Returns an error if the strands are too thin for their extent.
    pub(super) fn scene(self, flags: &Place, hair: Hair, size: [u32; 2]) -> Result<Scene, Error> {
        let parts = Parts {
            strands: self.strands,
            imported: flags.import.is_some(),
            head: self.head,
            hair,
            env: self.env,
            size,
            turn: flags.turn,
        };
        let scene = scenes::build(flags.scene, parts)?;
        Ok(Scene {
            backdrop: flags.backdrop.map(glam::Vec3::splat),
            rectangle_sampling: flags.rectangles,
            tree: scene.tree.with_meet(flags.meet),
            ..scene
        })
    }
}

/// Returns the number of strands of procedural hair, of each head if there are several.
pub(super) fn strands(flags: &Place) -> usize {
    flags.strands.unwrap_or(flags.scene.defaults().strands)
}

/// Returns true if the heads of portraits keep their own materials, because the flags name none.
pub(super) fn has_own_materials(looks: &Looks, place: &Place) -> bool {
    let is_named = looks.hair.is_some() || looks.model.is_some() || !looks.material.is_empty();
    !place.scene.portraits().is_empty() && place.import.is_none() && !is_named
}

/// Returns the materials that the flags select, at least one: of portraits without a named material one for each head.
///
/// # Errors
///
/// Returns an error if a file cannot be read, or if a name or a value is rejected.
pub(super) fn choices(flags: &Looks, place: &Place) -> Result<Vec<Choice>, Error> {
    let mut choices = Vec::new();
    if has_own_materials(flags, place) {
        for portrait in place.scene.portraits() {
            choices.push(portrait.hair(flags.sampler.as_deref())?);
        }
    } else if flags.material.is_empty() {
        let preset = place.scene.defaults().preset;
        let preset = flags.hair.as_deref().unwrap_or(preset);
        let model = flags.model.as_deref().unwrap_or(MODEL);
        let sampler = flags.sampler.as_deref();
        let sampler = sampler.unwrap_or_else(|| default_sampler(model));
        choices.push(Choice::find(model, sampler, preset)?);
    }
    for (name, material) in files::read(&flags.material)
        .map_err(|problem| Error::Usage(format!("--material {problem}")))?
    {
        let sampler = flags.sampler.as_deref();
        choices.push(Choice::of_material(&name, &material, sampler)?);
    }
    choices
        .into_iter()
        .map(|choice| choice.set(&flags.set))
        .collect()
}

/// Reads hair with the digest of its file, and logs what is odd about it.
fn read_hair(flags: &Place, path: &Path) -> Result<(Imported, u64), Error> {
    let follow = Follow {
        strands: flags.follow,
        spread: flags.spread,
    };
    let options = Import {
        radius: flags.radius,
        scale: flags.scale,
        up: flags.up,
        curve: flags.curve,
        follow,
    };
    let (imported, digest) =
        import(path, &options).map_err(|problem| Error::Usage(problem.to_string()))?;
    for remark in &imported.remarks {
        say(&format!("{}: {remark}", path.display()));
    }
    if imported.strands.strands() == 0 {
        return Err(Error::Usage(format!(
            "{}: there is no strand to render",
            path.display()
        )));
    }
    Ok((imported, digest))
}

/// Returns the head under hair from a file of this scale, if the flags select one, with the digest of its file.
fn read_head(flags: &Place, strands: &Strands, scale: f32) -> Result<(Option<Head>, u64), Error> {
    if flags.scalp.is_some() {
        let fit = scalp::fit(strands).map_err(Error::Usage)?;
        say(&fit.to_string());
        return Ok((Some(Head::ellipsoid(fit.ellipsoid)), 0));
    }
    let Some(path) = &flags.head else {
        return Ok((None, 0));
    };
    let options = formats::Head {
        scale: flags.head_scale.unwrap_or(scale),
        up: flags.up,
    };
    let (mesh, digest) =
        import_head(path, &options).map_err(|problem| Error::Usage(problem.to_string()))?;
    let [head, hair] = [mesh.bounds(), strands.bounds()].map(|bounds| bounds.size().length());
    if !(0.1..=10.0).contains(&(head / hair)) {
        say(&format!(
            "{}: warning: the head is {head} cm across and the hair {hair} cm: --head-scale sets centimetres per unit of the \
             head (here {})",
            path.display(),
            options.scale
        ));
    }
    Ok((Some(Head::mesh(mesh)), digest))
}
