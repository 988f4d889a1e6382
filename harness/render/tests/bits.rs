//! Bits of pictures: those of the seed, whatever the threads.

use crate::support::{film, hair, scene};
use hairis_render::film::{Crop, Film};
use hairis_render::scenes::Name;
use hairis_render::transport::{self, Integrator, Mis, Settings};

/// Sums of a film, which must not depend on the machine's load.
fn sums(film: &Film) -> Vec<(Crop, u32, Vec<[u64; 4]>)> {
    let bits = |sums: &hairis_render::film::Sums| {
        let [r, g, b] = sums.radiance.map(f64::to_bits);
        [r, g, b, sums.luminance_sq.to_bits()]
    };
    film.tiles.iter().map(|tile| (tile.place, tile.samples, tile.sums.iter().map(bits).collect())).collect()
}

#[test]
fn threads_passes_and_crops_do_not_show() {
    let cases = [
        (Name::Head, Integrator::Path, Mis::Both),
        (Name::Head, Integrator::Gather, Mis::Both),
        (Name::Head, Integrator::Gather, Mis::Resampled),
        (Name::Env, Integrator::Gather, Mis::Resampled),
        (Name::Env, Integrator::Path, Mis::Resampled),
    ];
    for (name, integrator, mis) in cases {
        let one = scene(name, hair("gaussian", "matched", "blond"), 800, 70);
        let settings = Settings { integrator, mis, ..Settings::default() };
        let whole = Crop::whole([70, 70]);
        let all: Vec<_> = [1, 2, 7]
            .map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                sums(&pool.install(|| film(&one, &settings, 6)))
            })
            .into();
        assert!(all[0] == all[1] && all[0] == all[2], "{integrator:?}, {mis:?}: threads show");
        let mut bit_by_bit = Film::new(whole);
        if integrator == Integrator::Path {
            for samples in [1, 3, 6] {
                transport::render(&one, &settings, &mut bit_by_bit, samples, &|_| ());
            }
            assert_eq!(sums(&bit_by_bit), all[0], "passes show");
        }
        let crop = Crop { x: 21, y: 30, width: 13, height: 11 };
        let part = transport::film(&one, &settings, crop, 6).picture();
        let picture = film(&one, &settings, 6).picture();
        for [x, y] in crop.pixels() {
            assert_eq!(
                part.at(x - crop.x, y - crop.y),
                picture.at(x, y),
                "{integrator:?}, {mis:?}: the crop shows at {x} {y}"
            );
        }
        assert!(picture.mean()[0] > 1e-3);
    }
}
