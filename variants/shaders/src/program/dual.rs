//! Dual scattering as a program: functions of the averages of a material, whatever its model.

use super::{Program, lanes, three, vector};
use crate::function::{Argument, Function};
use crate::graph::{Lane, input, record};
use crate::record::{Field, Record, Shape, numbers};
use hairis::dual_scattering::{Crossed, DualScattering};
use hairis::simd::trace::Target;

/// Name of the program, which is no model's.
const NAME: &str = "dual_scattering";
/// Fields of [`Crossed`] in their order.
const CROSSED: [(&str, Shape); 4] = [
    ("direct", Shape::Number),
    ("scattered", Shape::Vector),
    ("shift", Shape::Vector),
    ("variance", Shape::Vector),
];

/// Functions of the program, each with its purpose.
pub(crate) const PURPOSES: [(&str, &str); 3] = [
    (
        "strands",
        "Light that crossed so many fibres, each inclined to it by theta_i (radians).",
    ),
    (
        "depth",
        "Light that came through an optical depth: the mean number of fibres, inclined to it by theta_i (radians).",
    ),
    (
        "shade",
        "Light from wi to the viewer, in place of S (single): by one scattering and by those of other fibres.",
    ),
];

impl Program {
    /// Traces [dual scattering](hairis::dual_scattering). Its materials are averages, which a host measures and
    /// [adds](Self::add_material).
    #[must_use]
    pub fn dual_scattering(target: Target) -> Self {
        let material = Record::of(
            "material",
            &DualScattering::<f32> {
                coefficients: Default::default(),
            },
        )
        .0;
        let crossed = Record::new("crossed", &CROSSED);
        let functions = PURPOSES.map(|(name, _)| function(target, name, &material, &crossed));
        Self {
            name: NAME.to_owned(),
            target,
            material,
            prepared: crossed,
            functions: functions.into(),
            presets: Vec::new(),
            materials: Vec::new(),
        }
    }

    /// Adds the averages of a material under a name, like [`add_material`](Self::add_material).
    ///
    /// # Panics
    ///
    /// Panics if the name is not accepted, or if this is not the program of dual scattering.
    pub fn add_dual_material(&mut self, name: &str, dual: &DualScattering<f32>) {
        assert_eq!(self.name, NAME, "averages belong to dual scattering");
        self.add_material(name, &numbers(dual));
    }
}

fn function(target: Target, name: &str, material: &Record, crossed: &Record) -> Function {
    let field = |name: &str, shape| Argument::Field(Field::new(name, shape));
    let of_material = Argument::Record("material".to_owned(), material.clone());
    let (arguments, output) = if name == "shade" {
        let arguments = vec![
            of_material,
            field("wo", Shape::Vector),
            field("wi", Shape::Vector),
            field("single", Shape::Vector),
            Argument::Record("crossed".to_owned(), crossed.clone()),
            field("gain_before", Shape::Number),
            field("gain_behind", Shape::Number),
        ];
        (
            arguments,
            Record::new("shaded", &[("value", Shape::Vector)]),
        )
    } else {
        let count = field(name, Shape::Number);
        (
            vec![of_material, field("theta_i", Shape::Number), count],
            crossed.clone(),
        )
    };
    let (graph, results) = record(target, || {
        let next = &mut 0;
        let dual: DualScattering<Lane> = lanes(next);
        let results = if name == "shade" {
            let (wo, wi, single) = (vector(next), vector(next), three(next));
            let crossed = Crossed {
                direct: input(next),
                scattered: three(next),
                shift: three(next),
                variance: three(next),
            };
            let gain = [input(next), input(next)];
            dual.shade(wo, wi, single, &crossed, gain).to_vec()
        } else {
            let fibre = dual.averages(input(next));
            let count = input(next);
            let Crossed {
                direct,
                scattered,
                shift,
                variance,
            } = if name == "depth" {
                Crossed::depth(&fibre, count)
            } else {
                Crossed::strands(&fibre, count)
            };
            [&[direct][..], &scattered, &shift, &variance].concat()
        };
        results.into_iter().map(Lane::name).collect::<Vec<_>>()
    });
    Function::new(name.to_owned(), arguments, output, &graph, &results)
}
