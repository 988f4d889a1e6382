//! Command-line flags as clap parses them, with the checks that clap cannot express.

use crate::film::Crop;
use crate::formats::{Curve, Up};
use crate::hair::Energy;
use crate::lights::RectangleSampling;
use crate::numbers::Sequence;
use crate::scalp::Scalp;
use crate::scenes::Name;
use crate::transport::{Integrator, Mis};
use crate::tree::Meet;
use clap::{ArgGroup, Parser, Subcommand};
use core::str::FromStr;
use hairis_instruments::error::Error;
use hairis_instruments::pixels::LayerFlag;
use hairis_instruments::shard::Shard;
use std::path::PathBuf;

/// Renders hair to measure scattering models and their samplers on images.
#[derive(Clone, Debug, Parser)]
#[command(name = "hairis-render", version, arg_required_else_help = false)]
pub struct Args {
    /// Subcommand to run.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands, each with its flags.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Render a scene: an EXR file and a PNG preview; a run that was stopped goes on
    Render(Render),
    /// Join the parts of a picture that was rendered in shards: the pixels and layers of one run
    Merge(Merge),
    /// Compare samplers on all scenes, at equal samples and at equal time: one page; a run that was stopped goes on
    Figures(Figures),
    /// Recover the material of hair from a picture: colours, widths and shifts
    Fit(Fit),
}

/// Flags of `hairis-render render`.
#[derive(Clone, Debug, clap::Args)]
pub struct Render {
    /// The scene
    #[command(flatten)]
    pub place: Place,
    /// The hair's material
    #[command(flatten)]
    pub looks: Looks,
    /// How light is estimated [default: that of the scene]
    #[arg(long, value_enum)]
    pub integrator: Option<Integrator>,
    /// Samples of a pixel; more than a finished picture has are added to it [default: that of the scene]
    #[arg(long, value_name = "N", conflicts_with = "time")]
    pub spp: Option<u32>,
    /// Seconds after which no further pass begins, in place of a count of samples
    #[arg(long, value_name = "S")]
    pub time: Option<f64>,
    /// Source of uniform numbers
    #[arg(long, value_enum, default_value_t = Sequence::Sobol)]
    pub xi: Sequence,
    /// Which samples count where both find a light
    #[arg(long, value_enum, default_value_t = Mis::Both)]
    pub mis: Mis,
    /// Most scatterings of a path [default: no limit]
    #[arg(long, value_name = "N")]
    pub depth: Option<u32>,
    /// End paths that come from hair where they meet hair
    #[arg(long)]
    pub no_multiple: bool,
    /// Camera rays of a pixel for --integrator gather
    #[arg(long, value_name = "K", default_value_t = 1)]
    pub aa: u32,
    /// Whether hair scatters as the model says [default: raw]
    #[arg(long, value_enum)]
    pub energy: Option<Energy>,
    /// Width and height in pixels
    #[arg(
        long,
        value_name = "WxH",
        default_value = "512x512",
        allow_hyphen_values = true
    )]
    pub size: Size,
    /// The part of the picture to render
    #[arg(long, value_name = "X,Y,W,H", allow_hyphen_values = true)]
    pub crop: Option<CropArg>,
    /// Write the hair, too: as .hair, .data, .bin or .ply, or else as Mitsuba's text
    #[arg(long, value_name = "FILE")]
    pub export: Option<PathBuf>,
    /// Seed of the samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Factor on radiance in the preview [default: by the picture's brightness]
    #[arg(long, value_name = "X")]
    pub exposure: Option<f64>,
    /// Measure where the time goes: rays, light, kernels, frames, numbers, the rest
    #[arg(long)]
    pub profile: bool,
    /// Render shard I of N only, I from 1 to N, into a .part file for `hairis-render merge` to join
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// The EXR file; the preview lies beside it [default: out/render/SCENE.exr]
    #[arg(long, value_name = "FILE.exr")]
    pub out: Option<PathBuf>,
}

/// Flags of `hairis-render fit`.
#[derive(Clone, Debug, clap::Args)]
pub struct Fit {
    /// The scene
    #[command(flatten)]
    pub place: Place,
    /// The hair's material
    #[command(flatten)]
    pub looks: Looks,
    /// The picture, .exr or .hdr, whose size and part of a larger picture are used
    #[arg(long, value_name = "FILE", group = "layered")]
    pub target: PathBuf,
    /// Layer of the .exr target; without --env, --layer names it as well [default: the only one with colour]
    #[arg(long, value_name = "NAME")]
    pub target_layer: Option<String>,
    /// Field of the start that stays as it is
    #[arg(long, value_name = "FIELD")]
    pub fix: Vec<String>,
    /// Field whose numbers are variables of their own
    #[arg(long, value_name = "FIELD")]
    pub free: Vec<String>,
    /// Most scatterings of a path, 1 or 2
    #[arg(long, value_name = "N", default_value_t = 2)]
    pub depth: u32,
    /// End paths that come from hair where they meet hair
    #[arg(long)]
    pub no_multiple: bool,
    /// Count of iterations
    #[arg(long, value_name = "N", default_value_t = 12)]
    pub iterations: u32,
    /// Samples of a pixel per iteration, an even number
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub spp: u32,
    /// Seed of the samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Factor on radiance in the pictures [default: by the brightness of the target]
    #[arg(long, value_name = "X")]
    pub exposure: Option<f64>,
    /// Folder for material.json, parameters.csv, parameters.svg and pictures.png; made if missing
    #[arg(long, value_name = "DIR", default_value = "out/fit")]
    pub out: PathBuf,
}

/// Flags of a scene without the looks of its hair.
#[derive(Clone, Debug, clap::Args)]
#[command(group(ArgGroup::new("layered").multiple(true)))]
pub struct Place {
    /// The scene
    #[arg(value_enum)]
    pub scene: Name,
    /// Strands of the procedural hair, on each head [default: that of the scene]
    #[arg(long, value_name = "N")]
    pub strands: Option<usize>,
    /// Hair from a file in place of the scene's: .hair, .tfx, .data, .bin, .ply or Mitsuba's text
    #[arg(long, value_name = "FILE")]
    pub import: Option<PathBuf>,
    /// Centimetres per unit of the file of hair [default: by its format]
    #[arg(long, value_name = "X", requires = "import")]
    pub scale: Option<f32>,
    /// Radius at the roots in centimetres in place of the file's
    #[arg(long, value_name = "CM", requires = "import")]
    pub radius: Option<f32>,
    /// The axis of the file of hair, and of the head, that points up
    #[arg(long, value_enum, requires = "import", default_value_t = Up::Y)]
    pub up: Up,
    /// How nodes of the file make a strand
    #[arg(long, value_enum, requires = "import", default_value_t)]
    pub curve: Curve,
    /// A mesh of skin under the hair of the file: PLY or OBJ
    #[arg(long, value_name = "FILE", requires = "import")]
    pub head: Option<PathBuf>,
    /// Centimetres per unit of the mesh [default: those of the file of hair]
    #[arg(long, value_name = "X", requires = "head")]
    pub head_scale: Option<f32>,
    /// An ellipsoid of skin, fitted to the roots of the hair of the file
    #[arg(long, value_enum, requires = "import", conflicts_with = "head")]
    pub scalp: Option<Scalp>,
    /// Strands to add beside each strand of the file: of hair for games, which holds guides
    #[arg(long, value_name = "N", requires = "import", default_value_t = 0)]
    pub follow: u32,
    /// Largest distance of added strands from theirs in centimetres
    #[arg(long, value_name = "CM", requires = "import", default_value_t = 0.5)]
    pub spread: f32,
    /// Environment map in place of the scene's light, latitude-longitude, .hdr or .exr
    #[arg(long, value_name = "FILE", group = "layered")]
    pub env: Option<PathBuf>,
    /// Layer of the .exr map [default: the only one with colour]
    #[arg(long, value_name = "NAME", requires = "layered")]
    pub layer: Option<String>,
    /// Radiance that the camera sees beside the hair, in place of the map
    #[arg(long, value_name = "X")]
    pub backdrop: Option<f32>,
    /// Degrees by which the camera goes around the hair, to the right
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    pub turn: f32,
    /// How directions towards rectangular lights are drawn
    #[arg(long, value_enum, default_value_t)]
    pub rectangles: RectangleSampling,
    /// Place of hair that rays meet and leave
    #[arg(long, value_enum, default_value_t)]
    pub meet: Meet,
}

/// Flags of the hair's material.
#[derive(Clone, Debug, clap::Args)]
pub struct Looks {
    /// Preset of the hair [default: that of the scene]
    #[arg(long, value_name = "PRESET")]
    pub hair: Option<String>,
    /// Scattering model [default: gaussian]
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// Hair of a file in place of a preset, in the JSON of `hairis eval`; a picture for each
    /// material
    #[arg(long, value_name = "FILE.json", conflicts_with_all = ["hair", "model"])]
    pub material: Vec<PathBuf>,
    /// Another value for a parameter of the hair
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// How directions are drawn: uniform, published, or a word of the model's
    #[arg(long, value_name = "WORD")]
    pub sampler: Option<String>,
}

/// Arguments of `hairis-render merge`.
#[derive(Clone, Debug, clap::Args)]
pub struct Merge {
    /// The EXR file; a preview lies beside it
    #[arg(value_name = "OUT.exr")]
    pub out: PathBuf,
    /// Parts that shards have left
    #[arg(value_name = "PART", required = true)]
    pub parts: Vec<PathBuf>,
}

/// Flags of `hairis-render figures`.
#[derive(Clone, Debug, clap::Args)]
pub struct Figures {
    /// Small pictures, in less than three minutes
    #[arg(long)]
    pub quick: bool,
    /// Environment maps, each a scene of its own [default: a clear sky]
    #[arg(long, value_name = "FILE")]
    pub env: Vec<PathBuf>,
    /// Layer of the .exr maps [default: the only one with colour]
    #[arg(long, value_name = "NAME", requires = "env")]
    pub layer: Option<String>,
    /// Seed of the samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Only these scenes
    #[arg(long, value_enum, value_name = "SCENE")]
    pub scene: Vec<Name>,
    /// Hair of files in place of the scenes' presets, in the JSON of `hairis eval`; each scene with
    /// each material
    #[arg(long, value_name = "FILE.json")]
    pub material: Vec<PathBuf>,
    /// Another value for a parameter of the hair
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// How light is estimated [default: by scene]
    #[arg(long, value_enum)]
    pub integrator: Option<Integrator>,
    /// Source of uniform numbers
    #[arg(long, value_enum, default_value_t = Sequence::Sobol)]
    pub xi: Sequence,
    /// How directions towards rectangular lights are drawn
    #[arg(long, value_enum, default_value_t)]
    pub rectangles: RectangleSampling,
    /// Compare the models, and dual scattering with paths, too, where --scene is given
    #[arg(long)]
    pub models: bool,
    /// Print the table of all scenes, and the verdicts on standard error
    #[arg(long)]
    pub tables: bool,
    /// Measure shard I of N only; a run without this flag, with what all shards have left in its folder, writes the page
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Folder for report.html and the pictures; made if missing
    #[arg(long, value_name = "DIR", default_value = "out/figures")]
    pub out: PathBuf,
}

/// Width and height of a picture in pixels, parsed from `WxH`: 1 to 16384 each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text
            .split('x')
            .map(|side| side.parse().ok().filter(|side| (1..=16384).contains(side)));
        match sides.collect::<Option<Vec<u32>>>().as_deref() {
            Some(&[width, height]) => Ok(Self([width, height])),
            _ => Err("must be WxH, each from 1 to 16384".to_owned()),
        }
    }
}

/// Part of a picture, parsed from `X,Y,W,H` in pixels, whose width and height are above zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CropArg(pub Crop);

impl FromStr for CropArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text
            .split(',')
            .map(|number| number.parse().ok())
            .collect::<Option<Vec<u32>>>()
            .as_deref()
        {
            Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Self(Crop {
                x,
                y,
                width,
                height,
            })),
            _ => Err("must be X,Y,W,H, with W and H above 0".to_owned()),
        }
    }
}

impl Render {
    /// Returns the part of the picture to render, which is the whole picture unless `--crop` is given.
    ///
    /// # Errors
    ///
    /// Returns a usage error if the part does not lie within the picture.
    pub fn part(&self) -> Result<Crop, Error> {
        let Size([width, height]) = self.size;
        let Some(CropArg(crop)) = self.crop else {
            return Ok(Crop::whole([width, height]));
        };
        let within =
            |from: u32, count: u32, all: u32| from.checked_add(count).is_some_and(|end| end <= all);
        if within(crop.x, crop.width, width) && within(crop.y, crop.height, height) {
            return Ok(crop);
        }
        Err(Error::Usage(format!(
            "--crop must lie within {width}x{height}"
        )))
    }

    /// Checks the ranges of the flags, and rejects flags that do not go together.
    ///
    /// # Errors
    ///
    /// Returns a usage error if a count or a number is out of its range, or if another flag rules out a flag that is given.
    pub fn check(&self) -> Result<(), Error> {
        if let Some(spp) = self.spp.filter(|spp| !(1..=1 << 20).contains(spp)) {
            return refuse("--spp", "from 1 to 1048576", &spp);
        }
        if let Some(time) = self.time.filter(|time| !(*time > 0.0 && time.is_finite())) {
            return refuse("--time", "a number of seconds above 0", &time);
        }
        if self.time.is_some() && self.shard.is_some() {
            let problem = "--time must not be given with --shard, whose parts need one count of samples: use --spp";
            return Err(Error::Usage(problem.to_owned()));
        }
        check_exposure(self.exposure)?;
        self.place.check()?;
        if !(1..=4096).contains(&self.aa) {
            return refuse("--aa", "from 1 to 4096", &self.aa);
        }
        if let Some(depth) = self.depth.filter(|depth| !(1..=10_000).contains(depth)) {
            return refuse("--depth", "from 1 to 10000", &depth);
        }
        self.check_integrator()
    }

    /// Rejects flags that the integrator of the picture does not use.
    fn check_integrator(&self) -> Result<(), Error> {
        let integrator = self
            .integrator
            .unwrap_or(self.place.scene.defaults().integrator);
        for (flag, is_given, user) in [
            ("--depth", self.depth.is_some(), Integrator::Path),
            ("--aa", self.aa > 1, Integrator::Gather),
        ] {
            if is_given && integrator != user {
                let [user, got] = [user, integrator].map(Integrator::word);
                let problem = format!(
                    "{flag} must be given with --integrator {user}, got {got}: leave it out"
                );
                return Err(Error::Usage(problem));
            }
        }
        Ok(())
    }
}

impl Fit {
    /// Checks that the counts and numbers of the flags lie within their ranges.
    ///
    /// # Errors
    ///
    /// Returns a usage error that names the first flag whose count or number is out of its range.
    pub fn check(&self) -> Result<(), Error> {
        if !(1..=2).contains(&self.depth) {
            return refuse("--depth", "1 or 2", &self.depth);
        }
        if !(2..=1000).contains(&self.iterations) {
            return refuse("--iterations", "from 2 to 1000", &self.iterations);
        }
        if !(2..=1024).contains(&self.spp) || !self.spp.is_multiple_of(2) {
            return refuse("--spp", "an even number from 2 to 1024", &self.spp);
        }
        let without_map = self
            .place
            .layer
            .as_ref()
            .filter(|_| self.place.env.is_none());
        if let Some(layer) = without_map.filter(|_| self.target_layer.is_some()) {
            return refuse("--layer", "given with --env beside --target-layer", layer);
        }
        check_exposure(self.exposure)?;
        self.place.check()
    }

    /// Returns the layer of the target.
    #[must_use]
    pub fn target_layer(&self) -> LayerFlag<'_> {
        let (flag, layer) = match (&self.target_layer, &self.place) {
            (
                None,
                Place {
                    env: None, layer, ..
                },
            ) => ("--layer", layer),
            (layer, _) => ("--target-layer", layer),
        };
        LayerFlag {
            flag,
            name: layer.as_deref(),
        }
    }
}

impl Place {
    /// Checks that the numbers of the flags lie within their ranges.
    ///
    /// # Errors
    ///
    /// Returns a usage error that names the first flag whose number is out of its range.
    pub fn check(&self) -> Result<(), Error> {
        if let Some(backdrop) = self
            .backdrop
            .filter(|backdrop| !(*backdrop >= 0.0 && backdrop.is_finite()))
        {
            return refuse("--backdrop", "a radiance, 0 or above", &backdrop);
        }
        if self.follow > 1000 {
            return refuse("--follow", "at most 1000", &self.follow);
        }
        if !self.turn.is_finite() {
            return refuse("--turn", "a number of degrees", &self.turn);
        }
        Ok(())
    }
}

/// Returns the usage error for a flag whose value is out of its range.
fn refuse(flag: &str, range: &str, got: &dyn core::fmt::Display) -> Result<(), Error> {
    Err(Error::Usage(format!("{flag} must be {range}, got {got}")))
}

fn check_exposure(exposure: Option<f64>) -> Result<(), Error> {
    match exposure.filter(|exposure| !(*exposure > 0.0 && exposure.is_finite())) {
        Some(exposure) => refuse("--exposure", "a number above 0", &exposure),
        None => Ok(()),
    }
}
