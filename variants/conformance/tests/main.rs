//! Tests of the suite on a sound model, and of each property on a model that breaks it.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]

mod broken;
mod pasted;
mod reference;

use broken::*;
use hairis_conformance::{
    Claims, Materials, Outcome, Subject, bounds, chi_square, environment, hits, integral,
    inversion, lanes, lobes, not_numbers, resampling, sampling, slices, speed, totality,
};

hairis_conformance::conformance!(sound, crate::Broken(crate::SOUND));

/// Asserts that the property fails, and that its message names the fault.
#[track_caller]
fn assert_fails(outcome: Outcome, why: &str) {
    let Err(failure) = outcome else {
        panic!("the property holds on a model that breaks it")
    };
    assert!(
        failure.message.contains(why),
        "it fails for another reason than {why:?}: {failure}"
    );
    println!("{failure}");
}

#[test]
fn totality_finds_results_that_are_no_numbers_or_negative() {
    assert_fails(
        totality::results_are_finite(&Broken(NAN_AT_THE_POLE)),
        "density",
    );
    assert_fails(totality::results_are_finite(&Broken(NEGATIVE)), "value");
    assert_fails(
        totality::results_are_finite(&Broken(LONG_DIRECTION)),
        "unit vector",
    );
}

#[test]
#[cfg(target_arch = "x86_64")]
fn environments_are_found_to_matter() {
    assert_fails(
        environment::any_rounding_is_finite(&Broken(NEGATIVE_ROUNDED_DOWN)),
        "mode 0x2000",
    );
    assert_fails(
        environment::everyday_input_raises_no_exception(&Broken(DIVIDES_BY_ZERO)),
        "division by zero",
    );
}

#[test]
fn totality_finds_a_direction_that_is_none() {
    assert_fails(
        not_numbers::inputs_that_are_no_numbers_are_black(&Broken(NAN_IS_A_NUMBER)),
        "one lane",
    );
}

#[test]
fn integral_finds_a_density_that_is_too_high() {
    assert_fails(
        integral::density_integrates_to_one(&Broken(DENSITY_TOO_HIGH)),
        "integral",
    );
}

#[test]
fn integral_finds_discarded_samples() {
    assert_fails(
        integral::density_integrates_to_one(&Broken(DISCARDS)),
        "kept",
    );
}

#[test]
fn chi_square_finds_a_density_that_is_too_high() {
    assert_fails(
        chi_square::samples_follow_density(&Broken(DENSITY_TOO_HIGH)),
        "chi-square",
    );
}

#[test]
fn chi_square_finds_a_wrong_probability() {
    assert_fails(
        chi_square::samples_follow_density(&Broken(WRONG_PROBABILITY)),
        "chi-square",
    );
}

#[test]
fn even_points_find_a_wrong_probability() {
    assert_fails(
        inversion::even_points_invert_density(&Broken(WRONG_PROBABILITY)),
        "cdf",
    );
}

#[test]
fn even_points_find_a_skewed_lobe() {
    assert_fails(
        inversion::even_points_invert_density(&Broken(SKEWED_LOBE)),
        "lobes [cone]",
    );
    assert_fails(
        inversion::even_points_invert_density(&Broken(AZIMUTH_UNEVEN)),
        "cdf",
    );
}

#[test]
fn sampling_finds_a_weight_without_its_cosine() {
    assert_fails(
        sampling::samples_agree_with_eval(&Broken(WEIGHT_WITHOUT_COSINE)),
        "weight",
    );
}

#[test]
fn sampling_finds_a_sample_of_another_direction() {
    assert_fails(
        sampling::samples_agree_with_eval(&Broken(PACKET_DIFFERS)),
        "density of a sample",
    );
}

#[test]
fn lanes_find_a_lane_of_another_shading_point() {
    assert_fails(lanes::lanes_equal_scalar(&Broken(WRONG_LANE)), "lane 3");
}

#[test]
fn lanes_find_a_material_in_a_wrong_lane() {
    assert_fails(lanes::lanes_equal_scalar(&Broken(WRONG_PACK)), "lane 6");
    assert_fails(lanes::lanes_permute(&Broken(WRONG_PACK)), "moved");
}

#[test]
fn lanes_find_packets_that_differ_from_scalar() {
    assert_fails(
        lanes::lanes_equal_scalar(&Broken(PACKET_DIFFERS)),
        "one lane",
    );
}

#[test]
fn levels_find_a_lane_of_another_shading_point() {
    // Equal lanes hide which of them `lane` returns. Another property detects the packed material.
    assert_fails(lanes::lanes_equal_scalar(&Broken(WRONG_LANE)), "`lane`");
}

#[test]
fn h_is_found_where_it_is_not_claimed() {
    assert_fails(
        lanes::lobes_and_albedo_equal_scalar(&Broken(READS_H)),
        "h changes",
    );
}

#[test]
fn slices_find_entries_that_differ_from_packets() {
    // Only levels that process more than one packet at a time have separate lanes for slices.
    if hairis::simd::Level::available().any(|level| level != hairis::simd::Level::portable()) {
        assert_fails(
            slices::slices_equal_packets(&Broken(WIDE_SLICES_DIFFER)),
            "entry",
        );
        assert_fails(
            hits::hits_equal_packets(&Broken(WIDE_SLICES_DIFFER)),
            "entry",
        );
    }
}

#[test]
fn resampling_finds_estimates_that_are_two_percent_off() {
    for factor in [0.98, 1.02] {
        assert_fails(resampling::check(&Broken(SOUND), factor), "standard errors");
    }
}

#[test]
fn lobes_find_one_that_is_missing() {
    assert_fails(
        lobes::lobes_sum_to_value(&Broken(LOBE_MISSING)),
        "sum of the lobes",
    );
}

#[test]
fn masks_find_a_leak() {
    assert_fails(
        lobes::masks_select_lobes(&Broken(MASK_LEAKS)),
        "masked lobes scatter",
    );
}

#[test]
fn albedo_is_held_against_its_integral() {
    assert_fails(
        bounds::albedo_is_the_integral(&Broken(ALBEDO_TOO_LOW)),
        "albedo",
    );
}

#[test]
fn the_furnace_finds_lost_light() {
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
    assert_fails(bounds::white_furnace(&Grey), "sum of albedos");
}

#[test]
fn a_weight_above_its_bound_is_found() {
    assert_fails(
        bounds::weights_are_bounded(&Broken(HEAVY_WEIGHT)),
        "is above",
    );
}

#[test]
fn a_value_that_is_not_reciprocal_is_found() {
    assert_fails(
        bounds::eval_is_reciprocal(&Broken(NOT_RECIPROCAL)),
        "exchanged",
    );
}

#[test]
fn a_function_that_is_not_inlined_is_found() {
    if hairis::simd::Level::available().count() > 1 {
        assert_fails(speed::lanes_are_inlined(&Slow), "eval_pdf8");
    }
    speed::lanes_are_inlined(&Broken(SOUND)).unwrap();
}
