//! Agreement of kernels and formulas. One lane and eight lanes of every instruction set are compared with the reference in `f64`, on random
//! hair, in the three regions where digits are lost.
//!
//! - Bounds: those of the registry, [`accuracy`], for directions further than 1e-3 rad from the axis. Relative, 3e-5 for the published
//!   density, 3e-5 for a Cauchy and 2e-4 for a Gaussian value. The largest error of all must keep the bound.
//! - Samples: density, value and weight are compared with those of the returned direction. The lobe's cdf at that direction must return the
//!   numbers that the direction was sampled with.
//! - Left out: `|phi|` within 1e-6 rad of pi/2, because the glints' density jumps there (ERRATA E3) and a rounded azimuth may fall on
//!   either side; and within 1e-9 rad of pi, because the reference itself has no digits left.
//! - Next to `|phi|` = pi the R and TRT-g lobes vanish as `cos(phi / 2)`, which a rounded azimuth does not determine. Errors beyond a bound
//!   are therefore counted apart if rotating `wi` by 2^-22 rad does not explain them.
//! - Absolute errors of Gaussian values up to `2^-114` per lobe are allowed: see [`slack`](hairis_reference::slack).

mod measure;
mod packet;

use hairis::ParamError;
use hairis_instruments::stats::percentile;
use hairis_materials::material::values_json;
use hairis_reference::{Accuracy, accuracy};
use hairis_variants::ModelId;
use measure::{CodePath, LanePlace, LocatedError, measure};
use packet::Packet;
pub use packet::{Formulas, formulas};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Region of directions in which kernels and formulas are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Region {
    /// Directions uniform on the sphere, and samples wherever they fall.
    General,
    /// Directions `wi` at 1e-3 to 1e-2 rad from the fibre's axis; half of the time `wo` is near the axis as well.
    Axis,
    /// Directions with `|phi|` within 1e-2 rad of pi.
    Back,
}

impl Region {
    /// Every region, in the order of the tables.
    pub const ALL: [Self; 3] = [Self::General, Self::Axis, Self::Back];

    /// Returns the name of the region in tables.
    pub(crate) const fn label(self) -> &'static str {
        match self {
            Self::General => "general",
            Self::Axis => "near the axis",
            Self::Back => "near phi = pi",
        }
    }
}

/// Quantity of the kernels that is compared with the formulas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// Density of a given direction.
    Pdf,
    /// Value S of a given direction, as the worst of three channels.
    Value,
    /// Density that a sample reports.
    SamplePdf,
    /// S that a sample reports.
    SampleValue,
    /// Weight that a sample reports.
    SampleWeight,
    /// Distance between the cdf of the sample's direction and the numbers it was sampled with.
    SampleCdf,
}

impl Quantity {
    /// Every quantity, in the order of the tables.
    pub const ALL: [Self; 6] = [
        Self::Pdf,
        Self::Value,
        Self::SamplePdf,
        Self::SampleValue,
        Self::SampleWeight,
        Self::SampleCdf,
    ];

    /// Returns the name of the quantity in tables.
    pub(crate) const fn label(self) -> &'static str {
        match self {
            Self::Pdf => "pdf",
            Self::Value => "S",
            Self::SamplePdf => "sample pdf",
            Self::SampleValue => "sample S",
            Self::SampleWeight => "sample weight",
            Self::SampleCdf => "sample cdf",
        }
    }

    /// Returns the largest error that is allowed.
    pub(crate) const fn bound(self, accuracy: &Accuracy) -> f64 {
        match self {
            Self::Pdf => accuracy.pdf,
            Self::Value => accuracy.value,
            Self::SamplePdf => accuracy.sample_pdf,
            Self::SampleValue => accuracy.sample_value,
            Self::SampleWeight => accuracy.sample_weight,
            Self::SampleCdf => accuracy.cdf,
        }
    }
}

/// Errors of one quantity on one code path in one region, which are a row of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AgreementResult {
    /// Name of the model.
    pub model: &'static str,
    /// Name of the sampler, for a model with several. S does not depend on the sampler.
    pub sampler: Option<&'static str>,
    /// Code path: `one lane`, `eight lanes, one point` or `eight lanes, eight points`.
    pub path: &'static str,
    /// Instruction set of the lanes, or `scalar` for one lane.
    pub level: &'static str,
    /// Region of the directions.
    pub region: Region,
    /// Quantity that is compared.
    pub quantity: Quantity,
    /// Number of directions.
    pub count: usize,
    /// 99.9th percentile of the error, which is relative, or absolute for a cdf.
    pub p999: f64,
    /// Largest error.
    pub worst: f64,
    /// Largest error allowed.
    pub bound: f64,
    /// Number of directions beyond the bound.
    pub beyond: usize,
    /// Number of directions beyond the bound whose error a rotation of the azimuth by 2^-22 rad does not explain, so that a formula loses
    /// digits.
    pub unexplained: usize,
    /// Whether there is at least one direction and the largest error is within the bound.
    pub passed: bool,
    /// Case of the largest error. If there are unexplained errors, the largest of those.
    pub worst_case: Option<WorstCase>,
}

/// Shading point and direction, written as `hairis eval` reads them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorstCase {
    /// Name of the model.
    pub model: &'static str,
    /// Word that selects among models of one name, such as the sampler.
    #[serde(flatten)]
    pub choice: BTreeMap<&'static str, &'static str>,
    /// Parameters of the hair.
    pub params: serde_json::Value,
    /// Offset across the fibre, for a model of the near field.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub h: Option<f32>,
    /// Direction of the shading point's viewer.
    pub wo: [f32; 3],
    /// Direction that was given or drawn.
    pub wi: [f32; 3],
    /// Uniform numbers that the direction was drawn with.
    pub xi: Option<[f32; 3]>,
}

impl WorstCase {
    fn new(model: ModelId, at: &LanePlace) -> Self {
        let (wo, wi, h) = (
            at.wo.to_array(),
            at.wi.to_array(),
            model.is_near_field().then_some(at.h),
        );
        let choice = model.choice().into_iter().collect();
        Self {
            model: model.name(),
            choice,
            params: values_json(&at.values),
            h,
            wo,
            wi,
            xi: at.xi,
        }
    }
}

/// Compares every model of the registry with its formulas, in every region. `seed` selects the hair, the directions and the numbers;
/// `packets` counts the packets of eight directions per region and model. A thousand packets take about a second on one core.
///
/// # Errors
///
/// Returns an error only if drawn parameters are rejected, which does not happen because all are drawn within the accepted ranges.
pub fn run(seed: u64, packets: u32) -> Result<Vec<AgreementResult>, ParamError> {
    let mut rows = Vec::new();
    for region in Region::ALL {
        for model in ModelId::ALL {
            rows.extend(of_model(*model, &formulas(*model), region, seed, packets)?);
        }
    }
    Ok(rows)
}

/// Returns the rows of one model in one region. All code paths share the packets.
///
/// # Errors
///
/// Returns an error if drawn parameters are rejected.
pub fn of_model(
    model: ModelId,
    formulas: &Formulas<'_>,
    region: Region,
    seed: u64,
    packets: u32,
) -> Result<Vec<AgreementResult>, ParamError> {
    let paths = CodePath::all();
    let empty = || vec![Column::default(); paths.len() * Quantity::ALL.len()];
    let part = |chunk: &[u32]| -> Result<Vec<Column>, ParamError> {
        let mut columns = empty();
        for index in chunk {
            let mut packet = Packet::draw(model, formulas, region, seed, u64::from(*index))?;
            for (path, columns) in paths
                .iter()
                .zip(columns.chunks_exact_mut(Quantity::ALL.len()))
            {
                measure(
                    model,
                    region,
                    &mut packet,
                    *path,
                    &mut |quantity, measured| {
                        columns[quantity as usize].add(measured);
                    },
                )?;
            }
        }
        Ok(columns)
    };
    let join = |mut all: Vec<Column>, part: Vec<Column>| {
        all.iter_mut()
            .zip(part)
            .for_each(|(column, more)| column.join(more));
        Ok(all)
    };
    let indices: Vec<u32> = (0..packets).collect();
    let all = indices.par_chunks(500).map(part).try_reduce(empty, join)?;
    let labels = paths
        .iter()
        .flat_map(|path| Quantity::ALL.map(|quantity| (*path, quantity)));
    // Models without a cdf get no row for it.
    let compared = labels.zip(all).filter(|((_, quantity), column)| {
        *quantity != Quantity::SampleCdf || !column.errors.is_empty()
    });
    Ok(compared
        .map(|((path, quantity), column)| column.row(model, region, path, quantity))
        .collect())
}

/// Errors behind a row of the table.
#[derive(Clone, Debug, Default)]
struct Column {
    errors: Vec<f64>,
    unexplained: usize,
    worst: Option<LocatedError>,
}

impl Column {
    fn add(&mut self, measured: LocatedError) {
        self.errors.push(measured.error);
        self.unexplained += usize::from(measured.unexplained);
        self.keep_worst(Some(measured));
    }

    fn join(&mut self, other: Self) {
        self.errors.extend(other.errors);
        self.unexplained += other.unexplained;
        self.keep_worst(other.worst);
    }

    fn keep_worst(&mut self, other: Option<LocatedError>) {
        // An unexplained error takes precedence over a larger error that rounding explains.
        let rank = |m: &Option<LocatedError>| m.map_or((false, -1.0), |m| (m.unexplained, m.error));
        if rank(&other) > rank(&self.worst) {
            self.worst = other;
        }
    }

    fn row(
        mut self,
        model: ModelId,
        region: Region,
        path: CodePath,
        quantity: Quantity,
    ) -> AgreementResult {
        self.errors.sort_by(f64::total_cmp);
        let worst = self.errors.last().copied().unwrap_or(f64::NAN);
        let bound = quantity.bound(&accuracy(model));
        AgreementResult {
            model: model.name(),
            sampler: model.choice().map(|(_, word)| word),
            path: path.name(),
            level: path.level(),
            region,
            quantity,
            count: self.errors.len(),
            p999: percentile(&self.errors, 0.999),
            worst,
            bound,
            beyond: self.errors.iter().filter(|error| **error > bound).count(),
            unexplained: self.unexplained,
            passed: worst <= bound,
            worst_case: self
                .worst
                .map(|measured| WorstCase::new(model, &measured.at)),
        }
    }
}
