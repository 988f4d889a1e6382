//! Properties of the diffuse part alone. The suite that every model passes is in `samplers.rs`.

use crate::diffuse::{formulas, with};
use crate::support::{Draws, direction};
use hairis::model::Model;
use hairis::{Conserving, Gaussian, HairParams, Hit, Lobe, LobeMask, Matched, Material, Published};
use hairis_reference::{Formulas, Reference, integrate};
use hairis_variants::{
    Chiang, ChiangParams, DiffusePresets, Parameters, Registered, WithDiffuse, WithDiffuseDesc,
    WithDiffuseParams,
};

const COLOR: [f32; 3] = [0.6, 0.4, 0.3];

/// Calls a function for everyday materials of the models.
macro_rules! each_model {
    ($call:ident $($argument:expr),*) => {
        $call(&Published(Gaussian), HairParams::brown() $(, $argument)*);
        $call(&Matched::new(Gaussian), HairParams::brown() $(, $argument)*);
        $call(&Chiang::MEAN, ChiangParams::brown() $(, $argument)*);
    };
}

fn hit(draws: &mut Draws) -> Hit {
    let wo = direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1));
    Hit::new(wo, crate::support::narrow(draws.between(-1.0, 1.0)))
}

#[test]
fn without_a_diffuse_part_the_model_stays_as_it_is() {
    fn check<M: Formulas<Params: DiffusePresets>>(model: &M, fiber: M::Params) {
        let none = with(fiber, (0.0, COLOR));
        let (own, wrapped) = (
            Material::new(model, &fiber),
            Material::new(&WithDiffuse(*model), &none),
        );
        let mut draws = Draws(0xd0);
        for _ in 0..500 {
            let hit = hit(&mut draws);
            let (own, wrapped) = (own.prepare(hit), wrapped.prepare(hit));
            let wi = direction(draws.between(-1.5, 1.5), draws.between(-3.1, 3.1));
            assert_eq!(own.eval_pdf(wi), wrapped.eval_pdf(wi), "{hit:?} {wi}");
            let xi = draws.xi3();
            let [own, wrapped] = [own.sample(xi), wrapped.sample(xi)]
                .map(|sample| sample.map(|sample| (sample.wi, sample.lobe)));
            assert_eq!(own, wrapped, "{hit:?} {xi:?}");
        }
    }
    each_model! { check }
    assert_eq!(
        WithDiffuseParams::<HairParams>::default().desc().diffuse,
        0.0,
        "the default"
    );
}

#[test]
fn the_cylinder_is_the_mean_of_lamberts_law_over_its_width() {
    let white = with(HairParams::brown(), (1.0, [1.0; 3]));
    let material = Material::new(&WithDiffuse(Published(Gaussian)), &white);
    let mut draws = Draws(0xd1);
    let pi = core::f64::consts::PI;
    for _ in 0..200 {
        let phi = draws.between(-3.1, 3.1);
        let (theta_o, theta_i, phi_o) = (
            draws.between(-1.4, 1.4),
            draws.between(-1.4, 1.4),
            draws.between(-3.1, 3.1),
        );
        let bsdf = material.prepare(direction(theta_o, phi_o));
        let got = bsdf.eval_pdf(direction(theta_i, phi_o + phi));
        // Seen from azimuth 0 and lit from phi; a normal at azimuth x covers cos x dx / 2 of the width, and is lit by cos (x - phi).
        let (from, to) = (
            (phi - 0.5 * pi).max(-0.5 * pi),
            (phi + 0.5 * pi).min(0.5 * pi),
        );
        let lit = |x: f64| 0.5 * x.cos() * (x - phi).cos() / pi;
        let want = integrate([from, to], 0.5 * (from + to), 0.5 * (to - from), lit);
        for value in got.value {
            let error = (f64::from(value) / want - 1.0).abs();
            assert!(
                error < 1e-5 + 1e-6 / want,
                "{phi}: {value}, integral {want}"
            );
        }
        let pdf = f64::from(got.value[0]) * theta_i.cos();
        assert!((f64::from(got.pdf) / pdf - 1.0).abs() < 1e-5, "{got:?}");
    }
}

#[test]
fn albedo_and_energy_are_shared() {
    fn check<M: Formulas<Params: DiffusePresets>>(model: &M, fiber: M::Params) {
        let (own, part) = (Material::new(model, &fiber), with(fiber, (0.3, COLOR)));
        let wrapped = Material::new(&WithDiffuse(*model), &part);
        let mut draws = Draws(0xd2);
        for _ in 0..20 {
            let hit = hit(&mut draws);
            let (of_fiber, all) = (own.prepare(hit).albedo(), wrapped.prepare(hit).albedo());
            for lobe in Lobe::FOUR {
                for c in 0..3 {
                    let want = 0.7 * of_fiber[lobe][c];
                    assert!(
                        (all[lobe][c] - want).abs() <= 1e-6 * want,
                        "{lobe:?} {hit:?}"
                    );
                }
            }
            let diffuse = all[Lobe::slot(4)];
            for (got, color) in diffuse.into_iter().zip(COLOR) {
                assert!((got - 0.3 * color).abs() < 1e-7, "{diffuse:?}");
            }
        }
    }
    each_model! { check }
}

/// Returns how often the diffuse lobe is drawn with a mask, and the probability that it should have.
fn share_of_diffuse<M: Formulas<Params: DiffusePresets>>(
    model: &M,
    params: &WithDiffuseParams<M::Params>,
    hit: Hit,
    draws: &mut Draws,
) -> [f64; 2] {
    let bsdf = Material::new(&WithDiffuse(*model), params).prepare(hit);
    let count = 4000;
    let drawn = (0..count).filter(|k| {
        let [_, second, third] = draws.xi3();
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let first = (*k as f32 + 0.5) / count as f32;
        let sample = bsdf.sample([first, second, third]);
        sample.is_some_and(|sample| sample.lobe == Lobe::slot(4))
    });
    let share = drawn.count() as f64 / f64::from(count);
    let want = formulas::<M>(params, &hit).probabilities()[Lobe::slot(4)];
    [share, want]
}

#[test]
fn the_diffuse_part_is_chosen_by_its_energy() {
    fn check<M: Formulas<Params: DiffusePresets>>(model: &M, fiber: M::Params) {
        let mut draws = Draws(0xd3);
        for part in [0.05, 0.3, 0.9] {
            let params = with(fiber, (part, COLOR));
            for _ in 0..4 {
                let hit = hit(&mut draws);
                let [share, want] = share_of_diffuse(model, &params, hit, &mut draws);
                assert!(
                    (share - want).abs() < 1e-3,
                    "{share} of the samples, not {want}: {hit:?}"
                );
                let albedo = Material::new(&WithDiffuse(*model), &params)
                    .prepare(hit)
                    .albedo();
                let mean = |rgb: [f32; 3]| f64::from(rgb.iter().sum::<f32>()) / 3.0;
                let total: f64 = albedo.0.into_iter().map(mean).sum();
                let ratio = want / (mean(albedo[Lobe::slot(4)]) / total);
                assert!(
                    (0.4..2.5).contains(&ratio),
                    "{ratio} of the share of the albedo: {hit:?}"
                );
            }
        }
    }
    each_model! { check }
}

/// The samples of one model in the whole: those of the model alone, by a number stretched to the whole interval.
#[test]
fn the_first_number_is_stretched() {
    fn check<M: Formulas<Params: DiffusePresets>>(model: &M, fiber: M::Params) {
        let mut draws = Draws(0xd4);
        for _ in 0..200 {
            let hit = hit(&mut draws);
            let params = with(fiber, (0.4, COLOR));
            let own = Material::new(model, &fiber).prepare(hit);
            let bsdf = Material::new(&WithDiffuse(*model), &params).prepare(hit);
            let of_model = 1.0 - formulas::<M>(&params, &hit).probabilities()[Lobe::slot(4)];
            let [first, second, third] = draws.xi3();
            #[expect(clippy::cast_possible_truncation, reason = "rounded to a float")]
            let shrunk = (f64::from(first) * of_model) as f32;
            let want = own.sample([first, second, third]);
            let got = bsdf.sample([shrunk, second, third]);
            let (Some(want), Some(got)) = (want, got) else {
                continue;
            };
            // Rounding moves the number, in a tail by far, and next to a bound of two lobes to the other.
            let next = [first - 1e-5, first + 1e-5].map(|x| own.sample([x, second, third]));
            let next = next.iter().flatten().filter(|next| next.lobe == got.lobe);
            if want.lobe == got.lobe {
                let moved = next.map(|next| want.wi.distance(next.wi));
                let most = moved.fold(1e-5, f32::max);
                assert!(want.wi.distance(got.wi) < most, "{want:?} {got:?}");
            } else {
                assert!(next.count() > 0, "{want:?} {got:?}");
            }
        }
    }
    each_model! { check }
}

#[test]
fn conserving_limits_the_whole() {
    let bright = with(HairParams::bright(), (0.3, [1.0; 3]));
    fn check<M: Model<Params = HairParams>>(model: M, bright: &WithDiffuseParams<HairParams>) {
        let hair = Material::new(&Conserving(WithDiffuse(model)), bright);
        assert!(!hair.integrates(), "the fit is that of the model");
        for k in 0..30_u8 {
            let theta = f64::from(k) / 20.0;
            let hit = direction(theta, 0.3);
            let all = |albedo: hairis::PerLobe<[f32; 3]>| {
                albedo.0.iter().map(|lobe| lobe[0]).sum::<f32>()
            };
            let raw = hair.raw().prepare(hit);
            for albedo in [hair.prepare(hit).albedo(), raw.conserving().albedo()] {
                assert!(all(albedo) < 1.001, "{theta}: {albedo:?}");
                let lost = all(raw.albedo()).min(1.0) - all(albedo);
                assert!(lost < 0.31, "{theta}: {lost} is lost");
            }
        }
    }
    check(Published(Gaussian), &bright);
    check(Matched::<_, 9>(Gaussian), &bright);
}

#[test]
fn masks_choose_between_both() {
    let params = with(HairParams::brown(), (0.3, COLOR));
    let bsdf =
        Material::new(&WithDiffuse(Published(Gaussian)), &params).prepare(direction(0.4, 1.0));
    let diffuse = bsdf.with_lobes(LobeMask::of(&[Lobe::slot(4)]));
    let hair = bsdf.with_lobes(LobeMask::of(&Lobe::FOUR));
    let mut draws = Draws(0xd5);
    for _ in 0..200 {
        let xi = draws.xi3();
        let (diffuse, hair) = (diffuse.sample(xi).unwrap(), hair.sample(xi).unwrap());
        assert!(
            diffuse.lobe == Lobe::slot(4) && hair.lobe != Lobe::slot(4),
            "{xi:?}"
        );
        for (weight, color) in diffuse.weight.into_iter().zip(COLOR) {
            assert!((weight / (0.3 * color) - 1.0).abs() < 1e-5, "{diffuse:?}");
        }
    }
}

#[test]
fn parameters_are_those_of_the_model_and_two_more() {
    let fields = WithDiffuseParams::<HairParams>::FIELDS;
    assert_eq!(&fields[..9], HairParams::FIELDS, "the fields of the model");
    assert_eq!(
        [fields[9].name, fields[10].name],
        ["diffuse", "diffuse_color"],
        "the others"
    );
    assert_eq!(fields.len(), 11, "the fields");
    let names = [
        <WithDiffuse<Published<Gaussian>> as Registered>::NAME,
        <WithDiffuse<Chiang> as Registered>::NAME,
    ];
    assert_eq!(names, ["gaussian-diffuse", "chiang-diffuse"], "the names");
    for (name, preset) in WithDiffuseParams::<ChiangParams>::PRESETS {
        let back = WithDiffuseParams::from_values(&preset.values());
        assert_eq!(back, Ok(*preset), "{name}");
    }
    let desc = WithDiffuseDesc {
        fiber: HairParams::red(),
        diffuse: 0.5,
        diffuse_color: COLOR,
    };
    for (refused, message) in [
        (
            WithDiffuseDesc {
                diffuse: -0.1,
                ..desc
            },
            "diffuse must be in [0, 1], got -0.1",
        ),
        (
            WithDiffuseDesc {
                diffuse_color: [0.5, 1.5, 0.5],
                ..desc
            },
            "diffuse_color[1] must be in [0, 1], got 1.5",
        ),
        (
            WithDiffuseDesc {
                diffuse: f32::NAN,
                ..desc
            },
            "diffuse must be in [0, 1], got NaN",
        ),
    ] {
        assert_eq!(
            WithDiffuseParams::new(&refused).unwrap_err().to_string(),
            message
        );
    }
    let values = with(HairParams::red(), (0.5, COLOR)).values();
    let error =
        WithDiffuseParams::<HairParams>::from_values(&values.with("beta", &[0.1, 0.0, 0.2]));
    assert_eq!(error.unwrap_err().field(), "beta", "a field of the model");
    let half = with(HairParams::red(), (0.5, COLOR)).scaled(0.5).unwrap();
    assert_eq!(
        half.desc().diffuse_color,
        COLOR.map(|c| c * 0.5),
        "half of the light"
    );
    assert_eq!(
        half.desc().fiber,
        HairParams::red().scaled(0.5).unwrap(),
        "half of the light"
    );
}

#[test]
fn derivatives_by_other_fields_pass_through() {
    type Params = WithDiffuseParams<ChiangParams>;
    let values = Params::default().values().with("melanin", &[1.0, 0.2]);
    let by_kept = hairis_variants::Values::none(Params::FIELDS)
        .with("beta_n", &[0.5])
        .with("sigma_a", &[1.0, 0.0, 0.0])
        .with("diffuse", &[2.0])
        .with("diffuse_color", &[3.0, 4.0, 5.0]);
    let by = Params::chain(&values, &by_kept);
    assert!(
        (by.numbers("melanin")[0] - 0.419).abs() < 1e-6,
        "by melanin"
    );
    assert_eq!(
        (by.numbers("diffuse"), by.numbers("diffuse_color")),
        (&[2.0][..], &[3.0, 4.0, 5.0][..])
    );
}

#[test]
fn every_preset_of_a_model_has_one_with_a_diffuse_part() {
    fn check<P: DiffusePresets>() {
        let each = P::WITH_DIFFUSE.iter().zip(P::PRESETS);
        for ((name, with), (own, fiber)) in each {
            assert_eq!((name, with.desc().fiber), (own, *fiber));
        }
        assert_eq!(P::WITH_DIFFUSE.len(), P::PRESETS.len());
    }
    check::<HairParams>();
    check::<ChiangParams>();
}
