//! The line that tells runs apart.

use crate::args::{Place, Render, Size};
use crate::cmd::place::Ground;
use crate::film::Crop;
use crate::part::build;
use crate::transport::Settings;
use hairis_instruments::light::Environment;

/// Everything that the sums of a picture depend on, but for the count of samples and the shard: parts of equal lines may be
/// continued and joined. `hair` is what it depends on of the hair.
pub(super) fn describe(
    flags: &Render,
    hair: &str,
    settings: &Settings,
    crop: Crop,
    ground: &Ground,
) -> String {
    // Without `..`: whoever adds a flag decides whether it shapes the sums.
    let Render {
        place,
        size: Size([columns, rows]),
        // In the hair, the settings, the crop and the environment.
        looks: _,
        energy: _,
        integrator: _,
        xi: _,
        mis: _,
        depth: _,
        no_multiple: _,
        aa: _,
        seed: _,
        crop: _,
        // How much is rendered, what else is done, and where files lie.
        spp: _,
        time: _,
        shard: _,
        profile: _,
        exposure: _,
        export: _,
        out: _,
    } = flags;
    let Place {
        scene,
        strands,
        scale,
        radius,
        up,
        curve,
        head_scale,
        scalp,
        follow,
        spread,
        turn,
        backdrop,
        rectangles,
        meet,
        // In the digests of what was read.
        import: _,
        head: _,
        env: _,
        layer: _,
    } = place;
    let Settings {
        integrator,
        sequence,
        seed,
        mis,
        depth,
        roulette,
        multiple,
        rays,
        profile: _,
    } = settings;
    let Crop {
        x,
        y,
        width,
        height,
    } = crop;
    let [file, mesh] = ground.digests;
    let env = ground.env.as_ref().map_or(0, Environment::digest);
    let words = [
        format!("scene={scene:?} {hair}"),
        format!(
            "size={columns}x{rows} crop={x},{y},{width},{height} turn={turn} backdrop={backdrop:?} env={env:016x}"
        ),
        format!("strands={strands} import={file:016x} scale={scale:?} radius={radius:?} up={up:?}"),
        format!("curve={curve:?} head={mesh:016x} head_scale={head_scale:?} scalp={scalp:?}"),
        format!("follow={follow} spread={spread} rectangles={rectangles:?} meet={meet:?}"),
        format!("integrator={integrator:?} xi={sequence:?} seed={seed} mis={mis:?}"),
        format!("depth={depth:?} roulette={roulette} multiple={multiple} aa={rays}"),
        build(),
    ];
    words.join(" ")
}

/// Width and height of the whole picture, out of the line that [`describe`] makes.
pub(crate) fn picture_size(run: &str) -> Option<[u32; 2]> {
    let size = run
        .split_whitespace()
        .find_map(|word| word.strip_prefix("size="))?;
    size.parse().ok().map(|Size(size)| size)
}
