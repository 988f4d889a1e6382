//! Interface of a model under test, with its claims.

use core::fmt;
use hairis::model::Model;
use hairis::{Conserving, Hit, LobeMask, Material};
use hairis_reference::Reference;
use proptest::prelude::*;

/// Parameters of the subject's model.
pub type ParamsOf<S> = <<S as Subject>::Model as Model>::Params;

/// Materials, each with a name that failures print.
pub type Materials<S> = Vec<(&'static str, ParamsOf<S>)>;

/// Model under test. Implement this trait on a unit struct, and pass the struct to [`conformance!`](crate::conformance).
///
/// Two functions are required. Even if all others are left out, the model still has to be total, to sample the density it reports, and to
/// give the same results on one lane, on eight and in slices.
pub trait Subject: Sync {
    /// Model under test: a marker without borrowed data.
    type Model: Model + 'static;

    /// Returns the marker of the model.
    fn model(&self) -> Self::Model;

    /// Makes the material of these parameters.
    fn material(&self, params: &ParamsOf<Self>) -> Material<Self::Model> {
        Material::new(&self.model(), params)
    }

    /// Returns everyday materials, on which every property is tested.
    ///
    /// Give two to six materials, from narrow to wide lobes and of different colours. A material without any energy is legal.
    fn materials(&self) -> Materials<Self>;

    /// Returns materials at the ends of the parameters' ranges, on which totality, masks, lanes and slices are tested as well.
    fn extremes(&self) -> Materials<Self> {
        Vec::new()
    }

    /// Returns materials without absorption, on which the furnace test runs if [`Claims::furnace`] is set.
    fn white(&self) -> Materials<Self> {
        Vec::new()
    }

    /// Returns a strategy for any legal material, with the ends of ranges more often than chance: see [`strategies`](crate::strategies).
    ///
    /// Properties without a tolerance draw half of their materials from this strategy. Properties with a tolerance, which is stated for
    /// everyday materials, do not.
    fn any_material(&self) -> Option<BoxedStrategy<AnyMaterial<ParamsOf<Self>>>> {
        None
    }

    /// Returns the claims of the model, with their tolerances.
    fn claims(&self) -> Claims {
        Claims::default()
    }

    /// Returns the inclinations and azimuths of `wi` in rad at which densities jump or have a kink.
    ///
    /// Quadrature refines where necessary, and starts from where samples fall. Stated edges make it faster and more accurate. Values
    /// outside the domain are ignored.
    fn edges(&self, params: &ParamsOf<Self>, hit: &Hit) -> [Vec<f64>; 2] {
        let _ = (params, hit);
        [Vec::new(), Vec::new()]
    }

    /// Returns the largest weight of any channel of any sample with these lobes, if the model has a bound in closed form.
    fn weight_bound(&self, params: &ParamsOf<Self>, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        let _ = (params, hit, lobes);
        None
    }

    /// Returns the model in double precision at this hit, if there is one.
    fn reference(&self, params: &ParamsOf<Self>, hit: &Hit) -> Option<Expected> {
        let _ = (params, hit);
        None
    }

    /// Returns further materials to compare with the [`reference`](Self::reference), for instance random ones.
    fn random_materials(&self) -> Vec<ParamsOf<Self>> {
        Vec::new()
    }
}

/// Subject whose materials have the types of [`Conserving`] without its limit, like the handles of models chosen at run time.
///
/// A package that lists models has compiled these types already. A test of the list compares them with the models' own types.
#[derive(Clone, Copy, Debug)]
pub struct AsConserving<S>(pub S);

impl<S: Subject> Subject for AsConserving<S> {
    type Model = Conserving<S::Model>;

    fn model(&self) -> Self::Model {
        Conserving(self.0.model())
    }
    fn material(&self, params: &ParamsOf<Self>) -> Material<Self::Model> {
        self.0.material(params).into()
    }
    fn materials(&self) -> Materials<Self> {
        self.0.materials()
    }
    fn extremes(&self) -> Materials<Self> {
        self.0.extremes()
    }
    fn white(&self) -> Materials<Self> {
        self.0.white()
    }
    fn any_material(&self) -> Option<BoxedStrategy<AnyMaterial<ParamsOf<Self>>>> {
        self.0.any_material()
    }
    fn claims(&self) -> Claims {
        self.0.claims()
    }
    fn edges(&self, params: &ParamsOf<Self>, hit: &Hit) -> [Vec<f64>; 2] {
        self.0.edges(params, hit)
    }
    fn weight_bound(&self, params: &ParamsOf<Self>, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        self.0.weight_bound(params, hit, lobes)
    }
    fn reference(&self, params: &ParamsOf<Self>, hit: &Hit) -> Option<Expected> {
        self.0.reference(params, hit)
    }
    fn random_materials(&self) -> Vec<ParamsOf<Self>> {
        self.0.random_materials()
    }
}

/// Parameters of a material that a strategy has drawn, with the code that makes them.
#[derive(Clone)]
pub struct AnyMaterial<P> {
    pub(crate) params: P,
    pub(crate) code: String,
}

impl<P> AnyMaterial<P> {
    /// Combines parameters with the code that makes them.
    #[must_use]
    pub const fn new(params: P, code: String) -> Self {
        Self { params, code }
    }
}

impl<P: fmt::Debug> From<P> for AnyMaterial<P> {
    /// Converts parameters whose `Debug` form is code, as it is for a structure with public fields.
    fn from(params: P) -> Self {
        let code = format!("{params:?}");
        Self { params, code }
    }
}

impl<P> fmt::Debug for AnyMaterial<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.code)
    }
}

/// Claims of a model beyond the promises of [`Model`], and their tolerances.
///
/// Tolerances are relative unless stated otherwise. Start from the defaults, run the suite, and set each to no more than
/// twice the worst case that `cargo test -- --nocapture` prints.
#[derive(Clone, Debug)]
pub struct Claims {
    /// Error to which S is the same with `wo` and `wi` exchanged, beyond what rounding the directions changes.
    pub reciprocal: Option<f64>,
    /// Absolute error to which white materials return all light: the sum of the lobes' albedos is 1.
    pub furnace: Option<f64>,
    /// True if the model reads [`Hit::h`]. If not, results must not depend on `h`.
    pub near_field: bool,
    /// True if levels that fuse as one lane does ([`Level::fuses`](hairis::simd::Level::fuses)) give its bits.
    pub same_bits: bool,
    /// Error to which levels that fuse otherwise give one lane's results, beyond what rounding the directions changes.
    pub lanes: f64,
    /// Distance to which levels that fuse otherwise sample the direction of one lane, beyond what rounding the numbers changes.
    pub direction: f64,
    /// Error to which a sample's value and density are those of its direction, beyond what rounding the directions changes.
    pub sample_eval: f64,
    /// Error to which a sample's weight is `value cos theta_i / pdf`.
    pub weight: f64,
    /// Error to which the lobes sum to the value.
    pub lobe_sum: f64,
    /// Sum of lobes up to which S is compared with it: beyond, a part may be cut off at the largest float before it is weighed. Infinite for a
    /// model without parts.
    pub most: f64,
    /// Largest share of samples that may be discarded.
    pub discarded: f64,
    /// Absolute error to which the density integrates to the share of samples that are not discarded.
    pub integral: f64,
    /// Absolute error to which the distribution of samples of Sobol points is the integral of the density.
    pub inversion: f64,
    /// Error to which `albedo` is the integral of `S cos theta_i`.
    pub albedo: f64,
    /// Number of random samples per chi-square test.
    pub samples: u32,
    /// Number of Sobol points that samples are drawn from, a power of two.
    pub points: u32,
}

impl Default for Claims {
    /// Returns no claim beyond the promises of [`Model`], and tolerances for lobes of 0.01 rad and wider.
    fn default() -> Self {
        Self {
            reciprocal: None,
            furnace: None,
            near_field: false,
            same_bits: true,
            lanes: 1e-5,
            direction: 2e-6,
            sample_eval: 1e-5,
            weight: 1e-5,
            lobe_sum: 1e-5,
            most: f64::INFINITY,
            discarded: 1e-3,
            integral: 1e-4,
            inversion: 1e-4,
            albedo: 1e-3,
            samples: 200_000,
            points: 1 << 17,
        }
    }
}

/// Model in double precision at one hit, with the agreement to expect: made by [`Subject::reference`].
#[derive(Debug)]
pub struct Expected {
    /// Formulas of the model.
    pub reference: Box<dyn Reference<f64>>,
    /// Agreement to expect of the model with the formulas.
    pub tolerance: Tolerance,
}

/// Tolerances against the [`Reference`] at directions further than 1e-3 rad from the axis. Where it bounds errors by argument
/// ([`Reference::error_bound`]), S, density and lobes have these bounds in place of tolerances.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Relative error of S.
    pub value: f64,
    /// Relative error of the density.
    pub pdf: f64,
    /// Relative error of each lobe's value and density; `None` if the reference has no lobes.
    pub lobes: Option<f64>,
    /// Least value that every lobe has where lobes are compared.
    pub lobe_floor: f64,
    /// Values and densities below this floor are compared absolutely.
    pub floor: f64,
    /// Backward error in rad: results may also differ by the change that moving the direction by this angle causes.
    pub rounding: f64,
    /// Largest distance between the sampled directions; `None` if the reference has no sampler.
    pub direction: Option<f64>,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self {
            value: 1e-5,
            pdf: 1e-5,
            lobes: Some(1e-5),
            lobe_floor: 0.0,
            floor: 1e-20,
            rounding: 2.5e-7,
            direction: Some(1e-4),
        }
    }
}
