//! Tests of the published model's family, with any bell, the published sampler and the matched ones.
//!
//! They compare the kernels with the paper's formulas in double precision, with a row of bounds per model. Both the kernels and the
//! variants run them. Other models have no use for them.

pub mod albedo;
pub mod density;
pub mod edge;
pub mod faint;
pub mod fireflies;
mod handles;
pub mod lobes;
pub mod parity;
pub mod props;
pub mod quadrature;
mod rows;
pub mod sampling;
pub mod seam;
pub mod subject;
pub mod support;
pub mod tails;
pub mod values;
pub mod variance;
pub mod weights;

pub use rows::Rows;
pub use subject::Family;

use core::fmt;
use hairis::model::{MatchedBell, Model};
use hairis::{HairParams, Matched, Published};
use hairis_reference::{HairFormulas, Shape};
use handles::{AnyModel, Sampler};

/// Model of the family, with its bell, its sampler and its bounds.
pub trait FamilyModel: Sync {
    /// Model under test.
    type Model: Model<Params = HairParams> + 'static;
    /// Bell of the model.
    type Bell: MatchedBell + 'static;

    /// Returns the bell of the model.
    fn bell() -> Self::Bell;

    /// Returns every form of the model, with its factor on the widths. The first form is that of [`bell`](Self::bell).
    fn forms() -> Vec<(Self::Model, f32)>;

    /// Bell of the reference that this kernel's bell is compared with.
    const SHAPE: Shape;
    /// Number of bands of the matched sampler, or `None` for the published one.
    const BANDS: Option<usize> = None;
    /// True if the matched sampler chooses lobes by channel.
    const BY_CHANNEL: bool = false;
    /// Largest ratio of the bell to the Cauchy value.
    const OVER_CAUCHY: f64;
    /// Densities below this floor are compared absolutely.
    const PDF_FLOOR: f64;
    /// Bounds of the errors of the model.
    const ROWS: Rows;
    /// Source whose documentation has the table of the matched samplers, for tests of these samplers.
    const DOCS: &'static str = "";
}

/// Returns the formulas in double precision that a model is compared with.
#[must_use]
pub const fn formulas<S: FamilyModel>() -> HairFormulas {
    HairFormulas {
        shape: S::SHAPE,
        bands: S::BANDS,
        by_channel: S::BY_CHANNEL,
    }
}

/// [`FamilyModel`] without its types, in the form that the tests take.
pub struct Tested {
    forms: Vec<(Box<dyn AnyModel>, f32)>,
    /// Handles with the published sampler, and with the matched samplers of 5, 9 and 25 bands.
    samplers: [(Option<usize>, Box<dyn Sampler>); 4],
    formulas: HairFormulas,
    over_cauchy: f64,
    pdf_floor: f64,
    rows: Rows,
    docs: &'static str,
}

impl fmt::Debug for Tested {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.formulas.fmt(f)
    }
}

impl Tested {
    /// Makes the handles and the bounds of the model `S`.
    pub fn new<S: FamilyModel>() -> Self {
        let forms = S::forms()
            .into_iter()
            .map(|(model, factor)| (Box::new(model) as Box<dyn AnyModel>, factor));
        let samplers: [(_, Box<dyn Sampler>); 4] = [
            (None, Box::new(Published(S::bell()))),
            (Some(5), Box::new(Matched::<_, 5>(S::bell()))),
            (Some(9), Box::new(Matched::<_, 9>(S::bell()))),
            (Some(25), Box::new(Matched::<_, 25>(S::bell()))),
        ];
        Self {
            forms: forms.collect(),
            samplers,
            formulas: formulas::<S>(),
            over_cauchy: S::OVER_CAUCHY,
            pdf_floor: S::PDF_FLOOR,
            rows: S::ROWS.of_this_run(),
            docs: S::DOCS,
        }
    }

    /// Returns every form of the model, with its factor on the widths.
    fn forms(&self) -> impl Iterator<Item = (&dyn AnyModel, f32)> {
        self.forms.iter().map(|(model, factor)| (&**model, *factor))
    }

    /// Returns the first form of the model, with its factor on the widths.
    fn first(&self) -> (&dyn AnyModel, f32) {
        let (model, factor) = &self.forms[0];
        (&**model, *factor)
    }

    /// Returns the figures that the documentation states for a number of bands, each with the unit of its last digit: V, its mean gain
    /// and its least one, and the largest weight.
    fn documented(&self, bands: usize) -> [[f64; 2]; 4] {
        let name = format!("`Matched<_, {bands}>`");
        let row = self
            .docs
            .lines()
            .find(|line| line.contains(&name) && line.contains("| "));
        let row = row.unwrap_or_else(|| panic!("the docs have no row of {name}"));
        let cells: Vec<&str> = row.split('|').collect();
        let column = usize::from(self.formulas.shape == Shape::Cauchy);
        let words = cells[2 + column].split_whitespace();
        let words = words.chain(cells[4].split_whitespace().nth(column));
        let number = |word: &str| {
            let digits = word.trim_matches(|c: char| !c.is_ascii_digit() && c != '.');
            let decimals = digits.split_once('.').map_or(0, |(_, digits)| digits.len());
            let unit = (0..decimals).fold(1.0, |unit, _| unit / 10.0);
            [digits.parse().expect("a number"), unit]
        };
        let numbers: Vec<_> = words.map(number).collect();
        numbers.try_into().expect("four numbers")
    }

    /// Returns the model of the first form.
    fn model(&self) -> &dyn AnyModel {
        self.first().0
    }

    /// Returns the model with the matched sampler of this number of bands, or with the published sampler.
    fn sampler(&self, bands: Option<usize>) -> &dyn Sampler {
        let found = self.samplers.iter().find(|(with, _)| *with == bands);
        &*found.expect("one of the samplers").1
    }
}

/// Declares a module with a `#[test]` for each test of a [`FamilyModel`]: the `common` tests, or also those of the `published` or a
/// `matched` sampler.
#[macro_export]
#[doc(hidden)]
macro_rules! published {
    ($name:ident, $model:ty, common) => {
        $crate::published!(@$name, $model,);
    };
    ($name:ident, $model:ty, published) => {
        $crate::published!(
            @sampled $name, $model,
            weights { weights_are_below_their_bound the_bound_is_reached the_published_flaw_is_there }
        );
    };
    ($name:ident, $model:ty, matched) => {
        $crate::published!(
            @sampled $name, $model,
            density { each_lobe_integrates_to_one }
            fireflies { weights_are_below_their_bound_and_close_to_the_mean }
            seam { samples_next_to_the_seam_report_their_own_direction }
            tails {
                samples_in_the_tails_report_their_own_direction samples_of_lobes_off_the_sphere_report_their_own_direction
                ends_of_an_azimuth_are_sound_however_results_are_rounded
            }
            variance { variance_falls_by_what_is_promised }
        );
    };
    (@sampled $name:ident, $model:ty, $($more:tt)*) => {
        $crate::published!(
            @$name, $model,
            albedo {
                albedo_is_the_integral albedo_of_any_width_is_the_integral max_albedo_bounds_a_scan_ten_times_as_fine
                max_albedo_bounds_lobes_of_any_width
                scaled_hair_returns_at_most_what_it_receives conserving_hair_returns_at_most_what_it_receives
            }
            $($more)*
        );
    };
    (@$name:ident, $model:ty, $($more:tt)*) => {
        $crate::published!(
            @@$name, $model,
            edge {
                ends_of_xi_give_sound_samples_of_every_lobe nothing_is_negative_on_the_seam the_axis_scatters_nothing
                a_direction_just_off_the_axis_has_a_density vectors_that_are_no_direction_give_zero the_seam_is_no_edge
                a_zero_wo_counts_as_the_normal_plane lobes_without_energy_are_never_drawn
                black_hair_scatters_and_samples_nothing grazing_samples_are_discarded
                an_azimuth_next_to_nothing_is_still_an_azimuth a_direction_next_to_the_axis_is_still_a_direction
                absurd_glints_of_a_faint_colour_do_not_overflow
            }
            faint {
                a_faint_lobe_alone_is_sampled_as_a_bright_one a_lobe_off_the_sphere_has_the_density_it_is_drawn_with
            }
            lobes { lobes_add_up a_subset_scatters_its_lobes_alone a_lobe_is_colored_by_its_parameters }
            parity { one_lane_never_fuses levels_agree_with_one_lane }
            props { a_sample_agrees_with_eval_and_pdf }
            sampling { samples_on_the_grid samples_of_narrow_lobes samples_of_wide_lobes }
            values { values_on_the_grid values_of_narrow_lobes values_of_wide_lobes }
            $($more)*
        );
    };
    (@@$name:ident, $model:ty, $($module:ident { $($test:ident)* })*) => {
        #[cfg(test)]
        mod $name {
            /// Model under test.
            type Model = $model;
            $(
                mod $module {
                    $(
                        #[test]
                        fn $test() {
                            $crate::published::$module::$test(&$crate::published::Tested::new::<super::Model>());
                        }
                    )*
                }
            )*
        }
    };
}
