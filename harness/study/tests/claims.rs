//! Direction of each of the paper's claims: the side of the threshold that figures are on, and the verdict that follows.

mod bounded;
mod bounds;
mod claim;
mod energy;
mod glint;
mod grazing;
mod hair;
mod tails;
mod uniform;

use hairis_harness::journal::Journal;
use hairis_study::claims::{Claim, Claims, Figure, Origin, Role, Verdict, run, tables};
use hairis_study::study::Size;
use std::sync::OnceLock;

fn claims() -> &'static Claims {
    static CLAIMS: OnceLock<Claims> = OnceLock::new();
    CLAIMS.get_or_init(|| run(1, Size::Quick, &Journal::default(), &|_| ()).unwrap())
}

fn claim(id: &str) -> &'static Claim {
    claims()
        .claims
        .iter()
        .find(|claim| claim.id == id)
        .unwrap_or_else(|| panic!("no claim {id}"))
}

/// Returns the figures whose names contain `words`; there is at least one.
fn figures(of: &'static Claim, words: &str) -> Vec<&'static Figure> {
    let found: Vec<&Figure> = of
        .figures
        .iter()
        .filter(|figure| figure.name.contains(words))
        .collect();
    assert!(!found.is_empty(), "{}: no figure with {words:?}", of.id);
    found
}

fn value(of: &'static Claim, words: &str) -> f64 {
    figures(of, words)[0].value
}

fn role(of: &Claim, role: Role) -> &Figure {
    of.figures
        .iter()
        .find(|figure| figure.role == role)
        .unwrap()
}

#[test]
fn verdicts_follow_from_figures_and_thresholds() {
    let mut ids = Vec::new();
    for claim in &claims().claims {
        let keeps = |of| claim.threshold.is_kept_by(role(claim, of));
        let want = match (keeps(Role::Everywhere), keeps(Role::WithinLimits)) {
            (true, _) => Verdict::Holds,
            (false, true) => Verdict::HoldsWithinLimits,
            (false, false) => Verdict::False,
        };
        assert_eq!(claim.verdict, want, "{}", claim.id);
        for figure in &claim.figures {
            assert!(
                figure.value.is_finite() && figure.error >= 0.0,
                "{}: {figure:?}",
                claim.id
            );
            assert_eq!(
                figure.error == 0.0,
                figure.origin == Origin::Counted,
                "{}: {figure:?}",
                claim.id
            );
        }
        assert!(
            !claim.quotation.is_empty() && claim.sentence.ends_with('.'),
            "{}",
            claim.id
        );
        ids.push(claim.id);
    }
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), claims().claims.len(), "names are used once");
}

#[test]
fn energies_are_within_1_percent_from_the_front_on_narrow_hair_alone() {
    let claim = claim("energy-within-1-percent");
    assert_eq!(claim.verdict, Verdict::HoldsWithinLimits);
    let printed = value(claim, "ran over ±90°");
    assert!(
        (0.009..0.01).contains(&printed),
        "as printed it holds, just: {printed}"
    );
    let front = value(claim, "largest error, θ_o = 0°");
    assert!((front - 0.2175).abs() < 5e-4, "{front}");
    assert!(
        value(claim, "largest error, θ_o = 75°") > 0.99,
        "a narrow lobe off the sphere"
    );
    let wide = value(claim, "β = 30°, θ_o = 75°");
    assert!((wide - 0.662).abs() < 5e-3, "{wide}");
    assert!(value(claim, "widest β for which it holds, θ_o = 0°") >= 10.0);
    assert_eq!(value(claim, "widest β for which it holds, θ_o = 75°"), 0.0);
}

#[test]
fn wider_tails_bound_weights_and_add_variance() {
    let claim = claim("wider-tails");
    assert_eq!(claim.verdict, Verdict::False);
    let line = value(claim, "a factor on the line");
    assert!(
        (line - (0.75 * core::f64::consts::PI.sqrt() - 1.0)).abs() < 1e-6,
        "{line}"
    );
    let weight = value(claim, "largest Gaussian over Cauchy");
    assert!((weight - 2.0 * (-0.5_f64).exp()).abs() < 1e-6, "{weight}");
    assert!(
        role(claim, Role::WithinLimits).value > 1e-3,
        "no lobe of the grid is spared"
    );
}

#[test]
fn uniform_sampling_is_better_on_rough_hair_and_nowhere_else() {
    let claim = claim("better-than-uniform");
    assert_eq!(claim.verdict, Verdict::HoldsWithinLimits);
    let example = |of: &str, value: f64| {
        let found = figures(claim, of);
        let (measured, exact) = (found[0], found[1]);
        assert_eq!(
            [measured.origin, exact.origin],
            [Origin::Sampled, Origin::Quadrature]
        );
        assert!((exact.value - value).abs() < 1e-3, "{exact:?}");
        assert!(
            (measured.value - exact.value).abs() < 4.0 * measured.error,
            "{measured:?} {exact:?}"
        );
    };
    example("V of the published sampler, Gaussian, β_R = 20°", 0.302);
    example("V of uniform, Gaussian, β_R = 20°", 0.267);
    for model in ["Gaussian", "Cauchy"] {
        let worse = value(claim, &format!("cells worse than uniform, {model}"));
        assert!((1.0..5.0).contains(&worse), "{model}: {worse}");
    }
    assert!(
        value(claim, "geometric mean") < 0.2,
        "and by far the worse on the whole"
    );
}

#[test]
fn the_discard_costs_nothing_but_for_lobes_as_narrow_as_the_cap() {
    let claim = claim("grazing-discard");
    assert_eq!(claim.verdict, Verdict::HoldsWithinLimits);
    assert!(role(claim, Role::WithinLimits).value < 1e-12, "the grid");
    let [narrow, wide] = ["β = 1e-4 rad", "β = 60°"].map(|words| value(claim, words));
    assert!(
        narrow > 1e6 * wide,
        "narrow lobes lose, wide ones do not: {narrow} {wide}"
    );
    assert!((narrow - 3.3e-5).abs() < 1e-6, "{narrow}");
}

#[test]
fn the_cauchy_model_samples_better_but_for_the_sky() {
    for light in ["constant", "smooth", "sun", "area"] {
        let claim = claim(&format!("cauchy-samples-better-{light}"));
        assert_eq!(claim.verdict, Verdict::HoldsWithinLimits, "{light}");
        let mean = value(claim, "geometric mean");
        assert!((1.03..2.0).contains(&mean), "{light}: {mean}");
    }
    let sky = claim("cauchy-samples-better-sky");
    assert_eq!(sky.verdict, Verdict::False);
    assert!(value(sky, "geometric mean") < 0.5);
    let timed = claim("cauchy-samples-better-in-equal-time");
    assert!(
        timed
            .figures
            .iter()
            .all(|figure| figure.origin == Origin::Timed && figure.value > 0.0),
        "{timed:?}"
    );
    let others = claims().claims.iter().filter(|claim| claim.id != timed.id);
    assert!(
        others
            .flat_map(|claim| &claim.figures)
            .all(|figure| figure.origin != Origin::Timed),
        "in one claim alone"
    );
}

#[test]
fn unhalved_bounds_lose_samples_brighten_and_add_variance() {
    let claim = claim("misprint-bounds");
    assert_eq!(claim.verdict, Verdict::False);
    let [most, least] = [Role::Everywhere, Role::WithinLimits].map(|of| role(claim, of).value);
    assert!(
        (most - 0.450).abs() < 1e-3 && (least - 0.0089).abs() < 1e-4,
        "{most} {least}"
    );
    assert!(
        value(claim, "redrawn, least") > 0.01,
        "too bright everywhere"
    );
    assert!(
        value(claim, "samples count, least") > 1.0,
        "more variance everywhere"
    );
}

#[test]
fn an_uncut_glint_exceeds_one_and_darkens() {
    let claim = claim("misprint-glint-density");
    assert_eq!(claim.verdict, Verdict::False);
    let [most, least] = [Role::Everywhere, Role::WithinLimits].map(|of| role(claim, of).value);
    assert!(
        (most - 0.118).abs() < 1e-3 && (least - 0.014).abs() < 1e-3,
        "{most} {least}"
    );
    assert!(
        value(claim, "divides by it, least") > 1e-3,
        "too dark everywhere"
    );
}

#[test]
fn a_cut_glint_diverges_where_nothing_else_covers_its_tail() {
    let claim = claim("glint-interval");
    assert_eq!(claim.verdict, Verdict::HoldsWithinLimits);
    let growing: Vec<f64> = figures(claim, "V up to")
        .iter()
        .map(|figure| figure.value)
        .collect();
    let steps: Vec<f64> = growing.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(
        steps
            .iter()
            .all(|step| (step / steps[2] - 1.0).abs() < 0.05 && *step > 0.01),
        "a logarithm: {growing:?}"
    );
    assert!(
        value(claim, "the same, glints on [0, π]") < growing[0],
        "less than the least of them"
    );
    assert!(
        value(claim, "alone, glints on [0, π]") < 1e-6,
        "glints on [0, pi] converge"
    );
}

#[test]
fn every_claim_is_printed_with_its_verdict() {
    let text: String = tables(claims())
        .iter()
        .map(|table| table.to_text(Some(u16::MAX)))
        .collect();
    for claim in &claims().claims {
        let named = text.lines().filter(|line| line.contains(claim.id)).count();
        assert!(
            named >= 2 && text.contains(claim.quotation) && text.contains(&claim.sentence),
            "{}",
            claim.id
        );
        let verdict = format!("{}: {}", claim.verdict.name(), claim.sentence);
        assert!(text.contains(&verdict), "{verdict}");
        assert!(
            claim
                .figures
                .iter()
                .all(|figure| text.contains(&figure.name)),
            "{}",
            claim.id
        );
    }
}
