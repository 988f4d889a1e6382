//! RTXCR's far field: its faults, and its distance from ours.

use super::support::{DEG, direction, rule, sum};
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::random;
use hairis_reference::{DEonReference, Reference, RtxcrFaults, RtxcrReference};
use hairis_variants::{DEonDesc, DEonParams};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

const SHIPPED: RtxcrFaults = RtxcrFaults::SHIPPED;
const MENDED: RtxcrFaults = RtxcrFaults::MENDED;

fn clear(roughness: f64) -> DEonDesc<f64> {
    DEonDesc {
        roughness,
        tilt: 0.0,
        sigma_a: [0.0; 3],
        ..DEonParams::default().desc().map(f64::from)
    }
}

fn theirs(p: &DEonDesc<f64>, faults: RtxcrFaults, degrees: f64) -> RtxcrReference<f64> {
    RtxcrReference::prepare(p, faults, direction(degrees * DEG, 0.0))
}

/// The integral of `f(wi) cos theta_i` over all directions, of a function that is even in the azimuth.
fn over_sphere(degrees: f64, roughness: f64, f: impl Fn([f64; 3]) -> f64) -> f64 {
    let at = -degrees * DEG;
    let peaks = [
        (at, 0.02 * roughness),
        (at, roughness),
        (FRAC_PI_2, 1e-3),
        (-FRAC_PI_2, 1e-3),
    ];
    let edge = (degrees * DEG).cos() / (1.55_f64.powi(2) - at.sin().powi(2)).sqrt();
    let phi = rule(
        0.0,
        PI,
        &[(2.0 * edge.asin(), 1e-2)],
        &[0.2, 0.5, 1.0, 2.9, 3.1],
    );
    let theta = rule(-FRAC_PI_2, FRAC_PI_2, &peaks, &[]);
    2.0 * sum(&theta, |t| {
        t.cos() * t.cos() * sum(&phi, |phi| f(direction(t, phi)))
    })
}

fn albedo(fiber: &RtxcrReference<f64>, degrees: f64, roughness: f64, channel: usize) -> f64 {
    over_sphere(degrees, roughness, |wi| fiber.eval(wi)[channel])
}

#[test]
fn its_diffuse_lobe_has_a_cosine_too_many() {
    let matte = DEonDesc {
        diffuse: 1.0,
        ..clear(0.3)
    };
    for degrees in [0.0, 60.0] {
        let of = |faults| albedo(&theirs(&matte, faults, degrees), degrees, 0.3, 0);
        let (shipped, mended) = (of(SHIPPED), of(MENDED));
        println!("diffuse lobe at {degrees}: {shipped:.4}, mended {mended:.4}");
        assert!((mended - 1.0).abs() < 1e-6, "mended: {mended}");
        assert!(
            (shipped - 8.0 / (3.0 * PI)).abs() < 1e-6,
            "shipped: {shipped}"
        );
    }
}

#[test]
fn its_third_lobe_has_a_negative_weight_next_to_30_degrees() {
    // theta_d of 0.53, where the weight of the centre is -2.9e-5; off the cone of TT, and beyond the outer Gaussians.
    let p = DEonDesc {
        sigma_a: [0.0; 3],
        ..clear(0.2)
    };
    let (wo, wi) = (direction(0.83, 0.0), direction(-0.23, 1.7));
    let of = |faults| RtxcrReference::prepare(&p, faults, wo);
    let (shipped, mended) = (of(SHIPPED), of(MENDED));
    let (value, density) = shipped.eval_pdf(wi);
    println!(
        "S {:e}, stated density {density:e}, mended {:e}",
        value[0],
        mended.eval(wi)[0]
    );
    assert!(mended.eval(wi)[0] > value[0], "the centre takes light away");
    // The value is cut at 0, which hides the sign; the density is not.
    let further = direction(-0.23, 2.2);
    let [near, far] = [wi, further].map(|wi| shipped.pdf(wi));
    assert!(near.min(far) < mended.pdf(wi), "{near}, {far}");
}

#[test]
fn its_gaussians_are_cut_and_lose_light() {
    // TRT alone differs, and most where its widths are above half a turn.
    for (degrees, roughness, lost) in [(0.0, 0.1, 0.0), (60.0, 0.3, 0.0033), (75.0, 0.3, 0.0105)] {
        let p = clear(roughness);
        let of = |faults| albedo(&theirs(&p, faults, degrees), degrees, roughness, 0);
        let found = of(MENDED) - of(SHIPPED);
        println!(
            "light lost beyond half a turn at {degrees} degrees, roughness {roughness}: {found:.4}"
        );
        assert!((found - lost).abs() < 2e-4, "{degrees}: {found}");
    }
}

#[test]
fn its_third_lobe_ignores_the_index() {
    // Less reflectance, and the same light in TRT: clear hair gains.
    let p = DEonDesc {
        eta: 1.3,
        ..clear(0.05)
    };
    let found = albedo(&theirs(&p, MENDED, 0.0), 0.0, 0.05, 0);
    println!("light of clear hair with an index of 1.3: {found:.4}");
    assert!((found - 1.018).abs() < 2e-3, "{found}");
}

#[test]
fn its_density_is_not_that_of_its_samples() {
    let p = DEonParams::brown().desc().map(f64::from);
    let fiber = theirs(&p, SHIPPED, 0.0);
    let mass = over_sphere(0.0, p.roughness, |wi| fiber.pdf(wi));
    // Share of directions in the half of the sphere behind the fibre, as stated and as drawn.
    let stated = over_sphere(0.0, p.roughness, |wi| {
        if wi[1] < 0.0 { fiber.pdf(wi) } else { 0.0 }
    });
    let mut rng = ChaCha8Rng::seed_from_u64(0x5eed);
    let count = 100_000;
    let behind = (0..count)
        .filter(|_| draw(&fiber, &mut rng)[1] < 0.0)
        .count();
    let drawn = behind as f64 / f64::from(count);
    println!(
        "mass {mass:.4}, behind the fibre {:.4} stated, {drawn:.4} drawn",
        stated / mass
    );
    assert!(
        (mass - 0.977).abs() < 1e-3,
        "mass of the stated density: {mass}"
    );
    assert!((stated / mass - drawn).abs() > 0.1, "{stated} and {drawn}");
}

fn draw(fiber: &RtxcrReference<f64>, rng: &mut ChaCha8Rng) -> [f64; 3] {
    let [[a, b, c], [d, e, f]] = [(); 2].map(|()| random::xi(rng).map(f64::from));
    fiber.draw([a, b, c, d, e, f])
}

/// Mean, variance over its square, and largest of weights.
fn moments(weights: impl Iterator<Item = f64>) -> [f64; 3] {
    let (mut count, mut sum, mut squares, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
    for weight in weights {
        count += 1.0;
        sum += weight;
        squares += weight * weight;
        largest = largest.max(weight);
    }
    let mean = sum / count;
    [mean, squares / count / (mean * mean) - 1.0, largest]
}

const RECORD: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../benches/records/rtxcr.csv"
);
const HEAD: &str = "\
# Far field of RTXCR and d'Eon's of this library, by the test `the_record_states_the_distance_from_rtxcr` of hairis-reference
# CPU: any
theta_o,narrow_theirs,wide_theirs,clear,brown_theirs,estimate_theirs,brown,variance_theirs,variance,weight_theirs,weight,bound
";

/// The record has the figures that this test finds, and writes with `HAIRIS_RECORD=write`; the guide has its table.
#[test]
fn the_record_states_the_distance_from_rtxcr() {
    const COUNT: usize = 200_000;
    let brown = DEonParams::brown().desc().map(f64::from);
    let mean = |[r, g, b]: [f64; 3]| (r + g + b) / 3.0;
    let mut rows = HEAD.to_owned();
    for degrees in [0.0, 60.0, 75.0] {
        let of = |roughness| {
            let p = clear(roughness);
            albedo(&theirs(&p, SHIPPED, degrees), degrees, roughness, 0)
        };
        let (narrow, wide) = (of(0.1), of(0.3));
        let ours_clear: f64 = {
            let fiber = DEonReference::prepare(&clear(0.3), direction(degrees * DEG, 0.0));
            fiber.albedo().0.iter().map(|lobe| lobe[0]).sum()
        };
        let rtxcr = theirs(&brown, SHIPPED, degrees);
        let ours = DEonReference::prepare(&brown, direction(degrees * DEG, 0.0));
        let returned = over_sphere(degrees, brown.roughness, |wi| mean(rtxcr.eval(wi)));
        let ours_returned: f64 = ours.albedo().0.iter().map(|lobe| mean(*lobe)).sum();
        let mut rng = ChaCha8Rng::seed_from_u64(0x5eed);
        let estimate = moments((0..COUNT).map(|_| {
            let wi = draw(&rtxcr, &mut rng);
            let (value, pdf) = rtxcr.eval_pdf(wi);
            if pdf > 0.0 {
                mean(value) * wi[1].hypot(wi[2]) / pdf
            } else {
                0.0
            }
        }));
        let ours_estimate = moments(
            (0..COUNT).map(|_| mean(ours.sample(random::xi(&mut rng).map(f64::from)).weight)),
        );
        let bound = ours.weight_bound(hairis::LobeMask::ALL).unwrap();
        let off = ours_estimate[0] / ours_returned - 1.0;
        assert!(
            off.abs() < 4.5 * (ours_estimate[1] / COUNT as f64).sqrt(),
            "ours is unbiased: {off}"
        );
        let row = format!(
            "{degrees},{narrow:.4},{wide:.4},{ours_clear:.4},{returned:.4},{:.4},{ours_returned:.4},{:.4},{:.4},{:.4},{:.4},{bound:.4}\n",
            estimate[0], estimate[1], ours_estimate[1], estimate[2], ours_estimate[2],
        );
        rows.push_str(&row);
    }
    if std::env::var("HAIRIS_RECORD").is_ok_and(|word| word == "write") {
        std::fs::write(RECORD, &rows).unwrap();
    }
    let record = std::fs::read_to_string(RECORD).unwrap_or_default();
    assert_eq!(
        record, rows,
        "write the record: HAIRIS_RECORD=write cargo test -p hairis-reference the_record_states"
    );
}
