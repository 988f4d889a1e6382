//! Tests of the suite on a sound model, and of each property on a model that breaks it.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod broken;
mod pasted;
mod reference;

use broken::*;
use hairis::simd::Level;
use hairis_conformance::{
    Claims, Materials, Outcome, Subject, bounds, chi_square, environment, hits, integral,
    inversion, is_full, lanes, lobes, not_numbers, resampling, sampling, slices, speed, totality,
};
use std::io::Write;

hairis_conformance::conformance!(sound, crate::Broken(crate::SOUND));

/// Model with a fault, under the property that must find it.
struct Fault {
    /// Call of the property.
    call: &'static str,
    outcome: fn() -> Outcome,
    /// Part of the message that names the fault.
    why: &'static str,
}

impl Fault {
    /// Returns the reason why the fault is not found, if it is not.
    fn missed(&self) -> Option<String> {
        let Err(failure) = (self.outcome)() else {
            return Some(format!("{} holds", self.call));
        };
        println!("{failure}");
        let (call, why) = (self.call, self.why);
        (!failure.message.contains(why))
            .then(|| format!("{call} fails for another reason than {why:?}: {failure}"))
    }
}

macro_rules! faults {
    ($($module:ident::$property:ident($($arguments:tt)*) names $why:literal;)*) => {
        vec![$(Fault {
            call: stringify!($module::$property($($arguments)*)),
            outcome: || $module::$property($($arguments)*),
            why: $why,
        }),*]
    };
}

/// Returns the faults that any number of cases finds.
fn plain_faults() -> Vec<Fault> {
    let mut all = faults! {
        totality::results_are_finite(&Broken(NAN_AT_THE_POLE)) names "density";
        totality::results_are_finite(&Broken(NEGATIVE)) names "value";
        totality::results_are_finite(&Broken(LONG_DIRECTION)) names "unit vector";
        not_numbers::inputs_that_are_no_numbers_are_black(&Broken(NAN_IS_A_NUMBER)) names "one lane";
        integral::density_integrates_to_one(&Broken(DENSITY_TOO_HIGH)) names "integral";
        integral::density_integrates_to_one(&Broken(DISCARDS)) names "kept";
        inversion::even_points_invert_density(&Broken(WRONG_PROBABILITY)) names "cdf";
        inversion::even_points_invert_density(&Broken(SKEWED_LOBE)) names "lobes [cone]";
        inversion::even_points_invert_density(&Broken(AZIMUTH_UNEVEN)) names "cdf";
        sampling::samples_agree_with_eval(&Broken(WEIGHT_WITHOUT_COSINE)) names "weight";
        sampling::samples_agree_with_eval(&Broken(PACKET_DIFFERS)) names "density of a sample";
        lanes::lanes_equal_scalar(&Broken(WRONG_LANE)) names "lane 3";
        // Equal lanes hide which of them `lane` returns. Another property detects the packed material.
        lanes::lanes_equal_scalar(&Broken(WRONG_LANE)) names "`lane`";
        lanes::lanes_equal_scalar(&Broken(WRONG_PACK)) names "lane 6";
        lanes::lanes_permute(&Broken(WRONG_PACK)) names "moved";
        lanes::lanes_equal_scalar(&Broken(PACKET_DIFFERS)) names "one lane";
        lanes::lobes_and_albedo_equal_scalar(&Broken(READS_H)) names "h changes";
        lobes::lobes_sum_to_value(&Broken(LOBE_MISSING)) names "`Claims::lobe_sum`";
        lobes::masks_select_lobes(&Broken(MASK_LEAKS)) names "masked lobes scatter";
        bounds::albedo_is_the_integral(&Broken(ALBEDO_TOO_LOW)) names "albedo";
        bounds::white_furnace(&Grey) names "sum of albedos";
        bounds::weights_are_bounded(&Broken(HEAVY_WEIGHT)) names "is above";
        bounds::eval_is_reciprocal(&Broken(NOT_RECIPROCAL)) names "exchanged";
    };
    if cfg!(target_arch = "x86_64") {
        all.extend(faults! {
            environment::any_rounding_is_finite(&Broken(NEGATIVE_ROUNDED_DOWN)) names "mode 0x2000";
            environment::everyday_input_raises_no_exception(&Broken(DIVIDES_BY_ZERO)) names "division by zero";
        });
    }
    // Only levels that process more than one packet at a time have separate lanes for slices.
    if Level::available().any(|level| level != Level::portable()) {
        all.extend(faults! {
            slices::slices_equal_packets(&Broken(WIDE_SLICES_DIFFER)) names "entry";
            hits::hits_equal_packets(&Broken(WIDE_SLICES_DIFFER)) names "entry";
            speed::lanes_are_inlined(&Slow) names "eval_pdf8";
        });
    }
    all
}

/// Returns the faults that random samples find only if there are enough of them.
fn random_faults() -> Vec<Fault> {
    faults! {
        chi_square::samples_follow_density(&Broken(DENSITY_TOO_HIGH)) names "chi-square";
        chi_square::samples_follow_density(&Broken(WRONG_PROBABILITY)) names "chi-square";
        resampling::check(&Broken(SOUND), 0.98) names "standard errors";
        resampling::check(&Broken(SOUND), 1.02) names "standard errors";
    }
}

/// In CI's size every fault is found. In a smaller one the share is printed, and those that random samples find may be missed.
#[test]
fn faults_are_found() {
    let [plain, random] = [plain_faults(), random_faults()];
    let count = plain.len() + random.len();
    let [plain, random] =
        [plain, random].map(|faults| faults.iter().filter_map(Fault::missed).collect::<Vec<_>>());
    let found = count - plain.len() - random.len();
    // Past the test harness, which holds back what a passing test prints.
    let line =
        format!("{found} of {count} faults of broken models are found; missed: {random:?}\n");
    std::io::stderr().write_all(line.as_bytes()).unwrap();
    assert!(plain.is_empty(), "{}", plain.join("\n"));
    assert!(random.is_empty() || !is_full(), "{}", random.join("\n"));
}

/// Fibre whose white material absorbs.
struct Grey;

impl Subject for Grey {
    type Model = Fiber;
    fn model(&self) -> Self::Model {
        Fiber
    }
    fn materials(&self) -> Materials<Self> {
        Broken(SOUND).materials()
    }
    fn white(&self) -> Materials<Self> {
        vec![(
            "grey",
            Params {
                fault: SOUND,
                kd: [0.999; 3],
                ks: [0.0; 3],
                width: 0.1,
            },
        )]
    }
    fn claims(&self) -> Claims {
        Claims {
            furnace: Some(1e-4),
            ..Claims::default()
        }
    }
}
