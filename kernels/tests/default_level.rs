//! Packets whose calls name no level: they run on the one that is found.

use crate::support::{Draws, direction, lanes_of, packet};
use hairis::params::HairDesc;
use hairis::simd::Level;
use hairis::{Gaussian, HairParams, Hit8, Material, Material8, Published};

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
        let hits = &Hit8::from(&wo);
        let xi = lanes_of(&core::array::from_fn(|_| draws.xi3()));
        macro_rules! same {
            ($of:ident.$call:ident($($argument:expr)?)) => {
                assert_eq!(
                    format!("{:?}", $of.$call($($argument)?)),
                    format!("{:?}", $of.with_level(level).$call($($argument)?)),
                    "{}.{} of {wo:?} {wi:?}",
                    stringify!($of),
                    stringify!($call),
                );
            };
        }
        assert_eq!(
            format!("{:?}", a.prepare8(&wo)),
            format!("{:?}", a.with_level(level).prepare8(hits)),
            "a.prepare8 of {wo:?}"
        );
        same!(packed.prepare8(hits));
        let mixed = packed.prepare8(hits);
        same!(mixed.eval_pdf8(&wi));
        same!(mixed.sample8(&xi));
        same!(mixed.lobes8(&wi));
        same!(mixed.albedo8());
        same!(mixed.conserving());
        let one = mixed.lane(3);
        same!(one.eval_pdf8(&wi));
        same!(one.sample8(&xi));
        same!(one.lobes8(&wi));
    }
}
