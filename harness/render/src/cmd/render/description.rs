//! Description of a run, by which runs with different settings are told apart.

use crate::args::{Place, Render, Size};
use crate::cmd::place::{Ground, strands};
use crate::film::Crop;
use crate::part::build;
use crate::transport::Settings;
use hairis_instruments::light::Environment;

/// Returns a line of everything that the sums of a picture depend on, except the count of samples and the shard. Parts with equal
/// lines may be continued and joined. `hair` describes what the sums depend on of the hair.
pub(super) fn describe(
    flags: &Render,
    hair: &str,
    settings: &Settings,
    crop: Crop,
    ground: &Ground,
) -> String {
    // Without `..`, so that each new flag needs a decision whether the sums depend on it.
    let Render {
        place,
        size: Size([columns, rows]),
        // Described by the hair, the settings, the crop and the environment.
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
        // Without influence on the sums: how much is rendered, what else is done, and where files lie.
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
        strands: _,
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
        // Described by the digests of the files that were read.
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
        format!(
            "strands={} import={file:016x} scale={scale:?} radius={radius:?} up={up:?}",
            strands(place)
        ),
        format!("curve={curve:?} head={mesh:016x} head_scale={head_scale:?} scalp={scalp:?}"),
        format!("follow={follow} spread={spread} rectangles={rectangles:?} meet={meet:?}"),
        format!("integrator={integrator:?} xi={sequence:?} seed={seed} mis={mis:?}"),
        format!("depth={depth:?} roulette={roulette} multiple={multiple} aa={rays}"),
        build(),
    ];
    words.join(" ")
}
