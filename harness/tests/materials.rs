//! Names and keys of materials, agreement with quadrature, and checks.

use hairis_harness::efficiency::intensity;
use hairis_harness::lights::Lights;
use hairis_harness::materials::*;
use hairis_harness::rays::RaySubject;
use hairis_harness::variance::SampleBudget;
use hairis_instruments::light::Constant;
use hairis_instruments::light::{Light, Sky};
use hairis_instruments::quadrature::SphereIntegrator;
use hairis_instruments::stats::Estimate;
use hairis_reference::reference;
use hairis_variants::ModelId;

const BUDGET: SampleBudget = SampleBudget {
    samples: 1 << 17,
    light_samples: 1 << 12,
    pools: 64,
};

fn named(models: &[&str]) -> Vec<NamedMaterial> {
    let models: Vec<String> = models.iter().map(|name| (*name).to_owned()).collect();
    of_flags(&models, &[]).expect("models of the list")
}

#[test]
fn a_model_stands_for_its_presets_and_keys_come_back() {
    for id in ModelId::defaults_of_names() {
        let materials = named(&[id.name()]);
        assert_eq!(materials.len(), id.presets().count());
        for material in &materials {
            let key = material.key();
            let text = serde_json::to_string(&key).expect("no maps");
            let read: MaterialKey = serde_json::from_str(&text).expect("a key");
            let again = NamedMaterial::of_key(&read).expect("of this version");
            assert_eq!((again.key(), again.digest()), (key, material.digest()));
        }
    }
    let twice = named(&["chiang", "chiang"]);
    let names: Vec<&str> = twice.iter().map(|of| &*of.name).collect();
    assert_eq!(names[names.len() / 2], format!("{}-2", names[0]));
    let error = of_flags(&["phong".to_owned()], &[]).expect_err("no such model");
    let words = error.to_string();
    assert!(
        words.contains("--model must be one of gaussian, cauchy"),
        "{words}"
    );
    let mut other = twice[0].key();
    other.samplers.pop();
    assert!(NamedMaterial::of_key(&other).is_err(), "other samplers");
}

#[test]
fn zeros_of_both_signs_have_one_digest() {
    let [zero, negative] = [0.0, -0.0].map(|zero| {
        let material = named(&["kajiya-kay"]).remove(0);
        let values = material.values.with("kd", &[zero, 1.0, zero]);
        NamedMaterial { values, ..material }
    });
    assert_eq!(zero.values, negative.values);
    assert_eq!(zero.digest(), negative.digest());
}

#[test]
fn variances_agree_with_quadrature_for_every_model() {
    let theta_o_deg = 45.0;
    let wo = viewer(theta_o_deg).as_dvec3().to_array();
    let sphere = SphereIntegrator::new();
    for id in ModelId::defaults_of_names() {
        let material = &named(&[id.name()])[0];
        let found = material
            .measure(2, BUDGET, Lights::default(), theta_o_deg)
            .expect("accepted");
        let lights = Lights::default().all();
        for (of, rows) in RaySubject::of_model(id).zip(found.chunks(lights.len())) {
            let entry = of.own().unwrap_or(id);
            let formulas =
                reference(entry, &material.values, wo, f64::from(OFFSET)).expect("accepted");
            let pdf = |dir: [f64; 3]| match of.own() {
                Some(_) => formulas.pdf(dir),
                None => 0.25 / core::f64::consts::PI,
            };
            let moments = |dir: glam::DVec3| {
                let cosine = dir.y.hypot(dir.z);
                let y = intensity(formulas.eval(dir.to_array())) * cosine;
                let pdf = pdf(dir.to_array());
                let square = if pdf > 0.0 { y * y / pdf } else { 0.0 };
                [y, square, 0.0]
            };
            let [mean, square, _] = Constant.integrate(&moments, &sphere).value;
            let place = format!("{} {}", id.name(), of.sampler());
            // Kajiya-Kay's sampler is perfect here: the error that remains is rounding of single precision.
            let rounded = |of: Estimate, size: f64| Estimate {
                standard_error: of.standard_error.hypot(1e-5 * size),
                ..of
            };
            let constant = rows[0].figures;
            let z = rounded(constant.mean, mean).z_score(mean);
            assert!(z.abs() < 4.5, "{place}: mean {mean} is {z} errors off");
            let v = square / (mean * mean) - 1.0;
            let z = rounded(constant.v, 1.0).z_score(v);
            assert!(
                z.abs() < 4.5,
                "{place}: V {v} is {z} errors off {constant:?}"
            );
        }
    }
}

#[test]
fn a_run_passes_its_checks_and_a_wrong_weight_does_not() {
    let sky = Sky::default().environment();
    let materials = named(&["kajiya-kay", "chiang"]);
    let run = |seed| {
        let some = &materials[..2];
        run(some, seed, BUDGET, (&sky).into(), &[0.0, 75.0], &|_, _| ()).expect("accepted")
    };
    let mut poses = run(3);
    assert_eq!(poses.len(), 4);
    fn lines(poses: &[MaterialPose]) -> Vec<String> {
        let rows: Vec<MaterialRow<'_>> = poses.iter().flat_map(MaterialPose::rows).collect();
        failures(&rows)
    }
    assert_eq!(lines(&poses), [""; 0]);
    let rows: Vec<MaterialRow<'_>> = poses.iter().flat_map(MaterialPose::rows).collect();
    let text = table(&rows).to_text(Some(u16::MAX));
    assert!(
        text.contains(&materials[0].name) && text.contains("perfect"),
        "{text}"
    );
    poses[0].rows[0].measured.weight_bound = Some(1e-6);
    let said = lines(&poses);
    assert!(
        said.len() == 1 && said[0].contains("above its bound"),
        "{said:?}"
    );
}
