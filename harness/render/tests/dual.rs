//! Dual scattering against paths of any length.

use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::record;
use hairis_render::figures::dual::{COLOURS, Pair};
use hairis_render::figures::measure::Plan;
use hairis_render::figures::store::Store;
use hairis_render::scenes::Name;
use std::fs;
use std::path::Path;

fn compare(name: Name, hair: [&'static str; 2], plan: &Plan) -> Pair {
    let folder = tempfile::TempDir::new().expect("a folder");
    let store = Store::new(folder.path(), Interrupt::default()).expect("a folder");
    let pair = Pair::render(name, hair, plan, 1, &store).expect("rendered");
    store.remove();
    pair
}

/// Blond and brown hair under the area light: means within 5%, and four standard errors of so few samples. The record has less noise.
#[test]
fn means_are_near_those_of_paths() {
    let plan = Plan {
        side: 40,
        strands: 20_000,
        reference: [0, 160],
        ..Plan::QUICK
    };
    for preset in ["blond", "brown"] {
        let pair = compare(Name::AreaHead, ["gaussian", preset], &plan);
        println!(
            "{preset}: {:.3?} ± {:.3}, of it scattered once {:.3?}",
            pair.means, pair.noise, pair.once
        );
        for mean in pair.means {
            let most = 0.05 + 4.0 * pair.noise;
            assert!((mean - 1.0).abs() < most, "{preset}: {:?}", pair.means);
        }
        assert!(pair.noise < 0.02, "{preset}: {}", pair.noise);
        // Without light that was scattered more than once the means are off.
        assert!(pair.once[0] < 0.75, "{preset}: {:?}", pair.once);
        assert!(
            (0.02..0.4).contains(&pair.by_block),
            "{preset}: {}",
            pair.by_block
        );
    }
}

/// All scenes, models and colours have the means of the record, within five standard errors of a difference. With `HAIRIS_RECORD=write`,
/// writes it.
#[test]
#[ignore = "slow: ten minutes on two cores"]
fn record_of_dual_scattering() {
    let plan = Plan {
        side: 96,
        ..Plan::FULL
    };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/records/dual.csv");
    let recorded = fs::read_to_string(&path).unwrap_or_default();
    let mut rows = Vec::new();
    for name in [Name::AreaHead, Name::Env, Name::Head] {
        for model in ["gaussian", "chiang"] {
            for preset in COLOURS {
                let pair = compare(name, [model, preset], &plan);
                let ([r, g, b], [dual, paths]) = (pair.means, pair.times.map(|time| 1e3 * time));
                let key = format!("{},{model},{preset},", name.word());
                let row = format!(
                    "{key}{r:.4},{g:.4},{b:.4},{:.4},{:.4},{:.4},{dual:.2},{paths:.2}",
                    pair.noise, pair.once[0], pair.by_block
                );
                println!("{row}");
                rows.push(row);
                if !record::is_asked() {
                    let [before @ .., noise] = record::numbers::<4>(&recorded, &key);
                    for (mean, was) in pair.means.iter().zip(&before) {
                        let off = (mean - was).abs();
                        assert!(off <= 7.0 * noise, "{key} has {before:?} in the record");
                    }
                }
            }
        }
    }
    if record::is_asked() {
        let about =
            "dual scattering over paths, of 512 samples each, on pixels of 96 x 96 that show hair";
        let columns = "scene,model,colour,red,green,blue,noise,once,by block,dual ms,paths ms";
        record::write(
            &path,
            &hairis_instruments::machine!(),
            about,
            columns,
            &rows,
        )
        .expect("the record can be written");
    }
}
