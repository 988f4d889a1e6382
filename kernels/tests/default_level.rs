//! Packets whose calls name no level: they run on the one that is found.

use crate::support::{Draws, direction, lanes_of, packet};
use hairis::params::HairDesc;
use hairis::simd::Level;
use hairis::{Gaussian, HairParams, Material, Material8, Published};

#[test]
fn packets_without_a_level_run_on_the_one_found() {
    let mut draws = Draws(71);
    let narrow = HairParams::new(&HairDesc {
        beta: [0.05; 3],
        ..*HairParams::bright().desc()
    })
    .unwrap();
    let [a, b] =
        [HairParams::bright(), narrow].map(|params| Material::new(&Published(Gaussian), &params));
    let packed = Material8::pack([&a, &b, &b, &a, &a, &b, &a, &b]);
    let level = Level::detect();
    for _ in 0..100 {
        let mut eight = || {
            let v: [_; 8] = core::array::from_fn(|_| {
                direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1))
            });
            packet(&v)
        };
        let [wo, wi] = [eight(), eight()];
        let xi = lanes_of(&core::array::from_fn(|_| draws.xi3()));
        let same = |default: String, found: String, what: &str| {
            assert_eq!(default, found, "{what} of {wo:?} {wi:?}")
        };
        let text = |of: &dyn core::fmt::Debug| format!("{of:?}");
        let (shared, mixed) = (a.prepare8(&wo), packed.prepare8(&wo));
        same(
            text(&shared),
            text(&a.with_level(level).prepare8(&wo)),
            "one material",
        );
        same(
            text(&mixed),
            text(&packed.with_level(level).prepare8(&wo)),
            "eight materials",
        );
        same(
            text(&mixed.eval_pdf8(&wi)),
            text(&mixed.with_level(level).eval_pdf8(&wi)),
            "values of eight hits",
        );
        same(
            text(&mixed.sample8(&xi)),
            text(&mixed.with_level(level).sample8(&xi)),
            "samples of eight hits",
        );
        same(
            text(&mixed.lobes8(&wi)),
            text(&mixed.with_level(level).lobes8(&wi)),
            "lobes of eight hits",
        );
        same(
            text(&mixed.albedo8()),
            text(&mixed.with_level(level).albedo8()),
            "albedos of eight hits",
        );
        same(
            text(&mixed.conserving()),
            text(&mixed.with_level(level).conserving()),
            "eight hits that conserve energy",
        );
        let one = mixed.lane(3);
        same(
            text(&one.eval_pdf8(&wi)),
            text(&one.with_level(level).eval_pdf8(&wi)),
            "values of one hit",
        );
        same(
            text(&one.sample8(&xi)),
            text(&one.with_level(level).sample8(&xi)),
            "samples of one hit",
        );
        same(
            text(&one.lobes8(&wi)),
            text(&one.with_level(level).lobes8(&wi)),
            "lobes of one hit",
        );
    }
}
