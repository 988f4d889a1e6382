//! Requests of `hairis eval`: parses and checks one line of the input.

use glam::Vec3;
use hairis_materials::json::{Json, direction, numbers, offset, refusal};
use hairis_materials::material::{MaterialSpec, single};

/// Query about a shading point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Query {
    /// Unit direction at which value and densities are wanted.
    Wi(Vec3),
    /// Three uniform numbers in `[0, 1)` to sample with: for the lobe, the inclination and the azimuth.
    Xi([f32; 3]),
}

/// Line of the input, rounded to single precision for the kernels, and as it is for the formulas.
#[derive(Clone, Copy, Debug)]
pub(super) struct Request {
    pub(super) spec: MaterialSpec,
    /// Unit direction of the viewer.
    pub(super) wo: Vec3,
    /// Offset across the fibre, 0 for a far-field model.
    pub(super) h: f32,
    pub(super) query: Query,
    pub(super) exact: Exact,
}

/// Numbers of a line in double precision, except for those of the material. The query is the `wi` or `xi` of [`Query`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Exact {
    pub(super) wo: [f64; 3],
    pub(super) h: f64,
    pub(super) query: [f64; 3],
}

impl Request {
    /// Parses a line.
    pub(super) fn parse(line: &str) -> Result<Self, String> {
        let line = Json::parse(line)?;
        let first = MaterialSpec::first_of_name(&line);
        let known: Vec<_> = MaterialSpec::fields_of_request(first).collect();
        let line = line.fields("", &known)?;
        let given = |name: &str| line.get(name).ok_or_else(|| refusal(name, "missing"));
        let spec = MaterialSpec::read(first, &line)?;
        let h = line.get("h").map_or(Ok(0.0), offset)?;
        let wo = direction("wo", given("wo")?)?;
        let (query, numbers) = match [line.get("wi"), line.get("xi")] {
            [Some(wi), None] => {
                let wi = direction("wi", wi)?;
                (Query::Wi(single3(wi)), wi)
            }
            [None, Some(xi)] => {
                let xi = uniform("xi", xi)?;
                (Query::Xi(single_xi(xi)), xi)
            }
            [None, None] => return Err(refusal("wi", "missing; give wi or xi")),
            [Some(_), Some(_)] => {
                return Err(refusal("wi", "given together with xi; give one of them"));
            }
        };
        let exact = Exact {
            wo,
            h,
            query: numbers,
        };
        Ok(Self {
            spec,
            wo: single3(wo),
            h: single(h),
            query,
            exact,
        })
    }
}

/// Parses the three numbers in `[0, 1)` at `path`.
fn uniform(path: &str, json: &Json) -> Result<[f64; 3], String> {
    let xi = numbers(path, json, 3)?;
    match xi.iter().position(|x| !(0.0..1.0).contains(x)) {
        Some(i) => Err(refusal(
            &format!("{path}[{i}]"),
            format!("must be in [0, 1), got {}", xi[i]),
        )),
        None => Ok([xi[0], xi[1], xi[2]]),
    }
}

/// Rounds a direction to single precision.
fn single3([u, v, w]: [f64; 3]) -> Vec3 {
    Vec3::new(single(u), single(v), single(w))
}

/// Rounds uniform numbers to single precision, keeping them below 1.
fn single_xi(xi: [f64; 3]) -> [f32; 3] {
    const LARGEST: f32 = 1.0 - f32::EPSILON / 2.0;
    xi.map(|x| single(x).min(LARGEST))
}
