//! Parameter grid of the study: axes, cells, and the hair of a cell.

use hairis::params::HairDesc;
use hairis::{HairParams, ParamError};
use hairis_harness::efficiency::with_beta;
use hairis_harness::times::Rounds;
use hairis_harness::variance::SampleBudget;
use hairis_instruments::columns::Columns;

/// Values of each axis. Every combination of values is a cell, and the last axis runs fastest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Width of R, in degrees; `beta_tt` is half of this width, and `beta_trt` is twice.
    pub beta_r_deg: &'static [f32],
    /// Azimuthal width of TT, in degrees.
    pub gamma_tt_deg: &'static [f32],
    /// Azimuthal width of a glint, in degrees.
    pub gamma_g_deg: &'static [f32],
    /// Half angle between the glints, in degrees.
    pub phi_g_deg: &'static [f32],
    /// Strength of the glints.
    pub intensity_g: &'static [f32],
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: &'static [f32],
}

/// Cell of the grid: hair, and the inclination that it is seen from. Shifts and colours are those of the default hair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Index in the grid, from 0.
    pub index: usize,
    /// Width of R, in degrees; see [`Grid::beta_r_deg`].
    pub beta_r_deg: f32,
    /// Azimuthal width of TT, in degrees.
    pub gamma_tt_deg: f32,
    /// Azimuthal width of a glint, in degrees.
    pub gamma_g_deg: f32,
    /// Half angle between the glints, in degrees.
    pub phi_g_deg: f32,
    /// Strength of the glints.
    pub intensity_g: f32,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f32,
}

/// Values of an axis, and the function that returns the value of a cell.
pub(crate) type GridAxis = (&'static [f32], fn(&Cell) -> f32);

/// Size of a run, which its flags choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Run of tests that ask for no figure.
    Tiny,
    /// Short run.
    Quick,
    /// Whole run.
    Full,
}

impl Size {
    /// Every size.
    pub const ALL: [Self; 3] = [Self::Tiny, Self::Quick, Self::Full];

    /// Returns the size that the flags `--quick` and `--tiny` choose.
    #[must_use]
    pub const fn of_flags(quick: bool, tiny: bool) -> Self {
        match (tiny, quick) {
            (true, _) => Self::Tiny,
            (false, true) => Self::Quick,
            (false, false) => Self::Full,
        }
    }

    /// Returns true if this is not the whole run.
    #[must_use]
    pub const fn is_quick(self) -> bool {
        !matches!(self, Self::Full)
    }

    /// Returns the grid of the run.
    #[must_use]
    pub const fn grid(self) -> Grid {
        match self {
            Self::Tiny => Grid::TINY,
            Self::Quick => Grid::QUICK,
            Self::Full => Grid::FULL,
        }
    }

    /// Returns the numbers of samples per cell.
    #[must_use]
    pub const fn budget(self) -> SampleBudget {
        match self {
            Self::Tiny => SampleBudget {
                samples: 1 << 14,
                light_samples: 1 << 11,
                pools: 64,
            },
            Self::Quick => SampleBudget::of(true),
            Self::Full => SampleBudget::of(false),
        }
    }

    /// Returns the numbers of rounds in which times are measured.
    #[must_use]
    pub const fn rounds(self) -> Rounds {
        match self {
            Self::Tiny => Rounds {
                of_samples: 3,
                of_rays: 3,
            },
            Self::Quick => Rounds::QUICK,
            Self::Full => Rounds::FULL,
        }
    }

    /// Returns the flag that chooses the size, after a space.
    #[must_use]
    pub const fn flag(self) -> &'static str {
        match self {
            Self::Tiny => " --tiny",
            Self::Quick => " --quick",
            Self::Full => "",
        }
    }
}

impl Grid {
    /// Grid of the whole study, with 3024 cells.
    pub const FULL: Self = Self {
        beta_r_deg: &[2.5, 5.0, 7.5, 10.0, 15.0, 20.0],
        gamma_tt_deg: &[5.0, 10.0, 25.0, 45.0],
        gamma_g_deg: &[5.0, 10.0, 20.0],
        phi_g_deg: &[20.0, 35.0, 45.0],
        intensity_g: &[0.5, 5.0],
        theta_o_deg: &[0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0],
    };

    /// Grid of the short run: 48 of the cells, from narrow hair to wide, the default hair among them.
    pub const QUICK: Self = Self {
        beta_r_deg: &[2.5, 7.5, 20.0],
        gamma_tt_deg: &[10.0, 45.0],
        gamma_g_deg: &[10.0],
        phi_g_deg: &[35.0],
        intensity_g: &[0.5, 5.0],
        theta_o_deg: &[0.0, 45.0, 75.0, 85.0],
    };

    /// Grid of tests that ask for no figure: 12 of the cells of the short run, of three kinds of hair.
    pub const TINY: Self = Self {
        gamma_tt_deg: &[10.0],
        intensity_g: &[0.5],
        ..Self::QUICK
    };

    /// Returns the cells of the grid, in order.
    pub fn cells(self) -> impl Iterator<Item = Cell> {
        (0..self.len()).map(move |index| self.cell(index))
    }

    /// Returns the axis of the width of R.
    pub(crate) fn widths(&self) -> GridAxis {
        (self.beta_r_deg, |cell| cell.beta_r_deg)
    }

    /// Returns the axis of the inclination of the viewer.
    pub(crate) fn inclinations(&self) -> GridAxis {
        (self.theta_o_deg, |cell| cell.theta_o_deg)
    }

    fn axes(&self) -> [&'static [f32]; 6] {
        [
            self.beta_r_deg,
            self.gamma_tt_deg,
            self.gamma_g_deg,
            self.phi_g_deg,
            self.intensity_g,
            self.theta_o_deg,
        ]
    }

    /// Returns the number of cells in the grid.
    #[must_use]
    pub fn len(&self) -> usize {
        self.axes().iter().map(|axis| axis.len()).product()
    }

    /// Returns true if an axis has no values, so that there are no cells.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the cell at `index`, which is taken modulo the number of cells.
    ///
    /// # Panics
    ///
    /// Panics if an axis has no values.
    #[must_use]
    pub fn cell(&self, index: usize) -> Cell {
        let mut rest = index;
        let mut values = [0.0; 6];
        for (value, axis) in values.iter_mut().zip(self.axes()).rev() {
            *value = axis[rest % axis.len()];
            rest /= axis.len();
        }
        let [
            beta_r_deg,
            gamma_tt_deg,
            gamma_g_deg,
            phi_g_deg,
            intensity_g,
            theta_o_deg,
        ] = values;
        Cell {
            index,
            beta_r_deg,
            gamma_tt_deg,
            gamma_g_deg,
            phi_g_deg,
            intensity_g,
            theta_o_deg,
        }
    }
}

impl Cell {
    /// Returns the values of the axes, in the order of [`Grid`]'s fields.
    #[must_use]
    pub const fn values(&self) -> [f32; 6] {
        [
            self.beta_r_deg,
            self.gamma_tt_deg,
            self.gamma_g_deg,
            self.phi_g_deg,
            self.intensity_g,
            self.theta_o_deg,
        ]
    }

    /// Returns the parameters of the cell's hair.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of its range, which no cell of [`Grid::FULL`] or [`Grid::QUICK`] is.
    pub fn params(&self) -> Result<HairParams, ParamError> {
        let base = with_beta(&HairParams::bright(), self.beta_r_deg)?;
        HairParams::new(&HairDesc {
            gamma_tt: self.gamma_tt_deg.to_radians(),
            gamma_g: self.gamma_g_deg.to_radians(),
            phi_g: self.phi_g_deg.to_radians(),
            i_g: self.intensity_g,
            ..*base.desc()
        })
    }
}

/// Names of the columns of the axes.
const AXES: [&str; 6] = [
    "beta_r_deg",
    "gamma_tt_deg",
    "gamma_g_deg",
    "phi_g_deg",
    "intensity_g",
    "theta_o_deg",
];

/// Returns the columns that state the cell of each row.
pub(crate) fn columns_of<'a>(cells: impl Iterator<Item = &'a Cell> + Clone) -> Columns {
    let columns = Columns::default().whole("cell", cells.clone().map(|cell| cell.index));
    (0..)
        .zip(AXES)
        .fold(columns, |columns, (axis, name): (usize, _)| {
            columns.number(
                name,
                cells.clone().map(|cell| f64::from(cell.values()[axis])),
            )
        })
}
