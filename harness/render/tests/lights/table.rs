//! Tests of `lights::table`.

use hairis_conformance::statistics::chi_square;
use hairis_instruments::light::{Environment, Light as _};
use hairis_instruments::sequence::{Independent, XiSource as _};
use hairis_instruments::stats::Moments;
use hairis_render::lights::{LightSample8, Sky, TABLES, Table, Tables};

fn map() -> Environment {
    let mut xi = Independent::new(4, 0);
    let pixels = (0..32)
        .map(|k| {
            xi.next_xi_f32::<3>()
                .map(|x| if k == 9 { 20.0 * x } else { x })
        })
        .collect();
    Environment::from_pixels("small", 8, 4, pixels).expect("valid")
}

#[test]
fn every_entry_has_the_density_of_the_sky() {
    // Over seeds, the texels of single entries, against the probabilities of texels.
    let map = map();
    let sky = Sky::from(map.clone());
    let texel = |dir: glam::Vec3| {
        let (polar, turn) = (dir.y.clamp(-1.0, 1.0).acos(), dir.x.atan2(-dir.z));
        let cell = |x: f32, n: usize| {
            (0..n)
                .rev()
                .find(|k| x * n as f32 >= *k as f32)
                .unwrap_or(0)
        };
        cell(polar / core::f32::consts::PI, 4) * 8 + cell(0.5 + turn / core::f32::consts::TAU, 8)
    };
    let mut counts = [[0_u64; 32]; 3];
    let seeds = 3000;
    for seed in 0..seeds {
        let table = Table::draw(&sky, seed, 1 << 10).expect("a sky");
        for (counts, place) in counts.iter_mut().zip([0, 77, table.blocks().len() - 1]) {
            counts[texel(table.block(place).direction.lane(place % 8))] += 1;
        }
    }
    let mut xi = Independent::new(5, 0);
    let mut expected = [0.0; 32];
    for _ in 0..2_000_000 {
        let sample = map.sample(xi.next_xi());
        expected[texel(sample.dir.as_vec3())] += seeds as f64 / 2e6;
    }
    for counts in &counts {
        let p = chi_square(counts, &expected, 5.0).p_value;
        assert!(p > 1e-3, "p {p}");
    }
}

#[test]
fn tables_differ_by_seed_and_their_error_is_small() {
    let map = map();
    let sky = Sky::from(map.clone());
    let mut moments = Moments::new();
    for seed in 0..64 {
        let table = Table::draw(&sky, seed, 1 << 14).expect("a sky");
        let one = |block: &LightSample8| {
            let up = block.direction.y * block.direction.y;
            (up * block.radiance[1] / block.pdf)
                .to_array()
                .iter()
                .map(|x| f64::from(*x))
                .sum::<f64>()
        };
        let count = 8.0 * table.blocks().len() as f64;
        moments.push(table.blocks().iter().map(one).sum::<f64>() / count);
        let seen = sky.see8(&table.block(5).direction);
        assert_eq!(
            (seen.pdf, seen.radiance),
            (table.block(5).pdf, table.block(5).radiance)
        );
    }
    let got = moments.mean_estimate();
    // Independent directions would leave some 5e-3 of it in each table.
    assert!(
        8.0 * got.standard_error < 5e-4 * got.value && got.standard_error > 0.0,
        "{got:?}"
    );
    let truth = map.integrate(
        &|dir| [dir.y * dir.y; 3],
        &hairis_instruments::quadrature::SphereIntegrator::new(),
    );
    assert!(
        (got.value / truth.value[1] - 1.0).abs() < 1e-4,
        "{got:?} for {:?}",
        truth.value
    );
    assert!(Table::draw(&Sky::BLACK, 1, 16).is_none());
    let bytes = |length| size_of_val(Table::draw(&sky, 1, length).expect("a sky").blocks());
    assert_eq!([bytes(1 << 14), bytes(usize::MAX)], [1 << 19, 1 << 23]);
    let tables = Tables::new(&sky, 1, 64);
    let first = |pass| {
        tables
            .of_pass(pass)
            .expect("a sky")
            .block(0)
            .direction
            .lane(0)
    };
    assert!(
        first(0) != first(1) && first(3) == first(3 + TABLES),
        "a table per pass"
    );
}
