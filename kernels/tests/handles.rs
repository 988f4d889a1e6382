//! Calls that follow from others, and texts of errors and levels.

use crate::support::{Draws, direction};
use hairis::columns::LengthError;
use hairis::model::{Bell, DynBsdf};
use hairis::simd::{Lanes, Level};
use hairis::{Gaussian, HairParams, Material, Published};

#[test]
fn a_density_alone_is_that_beside_the_value() {
    let hair = Material::new(&Published(Gaussian), &HairParams::brown());
    let mut draws = Draws(0x4a1);
    for _ in 0..50 {
        let [wo, wi] =
            [(); 2].map(|()| direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1)));
        let bsdf = hair.prepare(wo);
        let (both, object): (_, &dyn DynBsdf) = (bsdf.eval_pdf(wi), &bsdf);
        assert!(both.pdf > 0.0);
        assert_eq!([bsdf.pdf(wi), object.pdf(wi)], [both.pdf; 2]);
        assert_eq!([bsdf.eval(wi), object.eval(wi)], [both.value; 2]);
    }
}

/// A Gaussian by the one function that a bell must have.
#[derive(Clone, Copy, Debug)]
struct Plain;

impl Bell for Plain {
    #[inline(always)]
    fn one<L: Lanes>(s: L, cauchy: L) -> L {
        Gaussian::one(s, cauchy)
    }
}

#[test]
fn a_bell_needs_no_more_than_one_function() {
    let hair = Material::new(&Published(Gaussian), &HairParams::brown());
    let plain = Material::new(&Published(Plain), &HairParams::brown());
    let mut draws = Draws(0x4a2);
    for _ in 0..200 {
        let [wo, wi] =
            [(); 2].map(|()| direction(draws.between(-1.0, 1.0), draws.between(-3.1, 3.1)));
        let [want, got] = [hair.prepare(wo).eval(wi), plain.prepare(wo).eval(wi)];
        for (got, want) in got.into_iter().zip(want) {
            assert!((got - want).abs() <= 1e-5 * want + 1e-9, "{got} for {want}");
        }
    }
}

#[test]
fn errors_and_levels_have_texts() {
    let error = LengthError {
        field: "wi",
        len: 3,
        expected: 4,
    };
    assert_eq!(
        error.to_string(),
        "wi has 3 entries where the first slice has 4"
    );
    for level in [Level::portable(), Level::detect()] {
        assert_eq!(level.to_string(), level.name());
    }
}
