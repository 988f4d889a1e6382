//! Kernels of resampling have the bits of samples and evaluations, from which objects of a model chosen at run time propose and weigh.

use crate::conserving::{columns, slices};
use glam::Vec3;
use hairis::model::{DynBsdf, Model};
use hairis::resample::{CandidateColumns, Counts, Partition, Resample, WeightColumns};
use hairis::simd::{Level, f32x8};
use hairis::{Bsdf, Gaussian, HairParams, Hit8, Matched, Material, Published, Vec3x8};

const COUNTS: Counts = Counts { bsdf: 3, light: 5 };

type Rows<const N: usize> = [Vec<f32>; N];

/// Candidates of a BSDF, and contributions and weights of these and of other directions.
fn resampled(
    bsdf: &(impl Resample + ?Sized),
    xi: [&[f32]; 3],
    wi: [&[f32]; 3],
    partition: Partition,
) -> (Rows<3>, [Rows<4>; 2]) {
    let len = xi[0].len();
    let mut proposed = [(); 3].map(|()| vec![f32::NAN; len]);
    bsdf.propose_columns(xi, proposed.each_mut().map(Vec::as_mut_slice))
        .unwrap();
    let pdf_light: Vec<f32> = xi[0].iter().map(|xi| xi - 0.1).collect();
    let weighed = [wi, slices(&proposed)].map(|wi| {
        let mut out = [(); 4].map(|()| vec![f32::NAN; len]);
        let [r, g, b, weight] = out.each_mut().map(Vec::as_mut_slice);
        let out_columns = WeightColumns {
            contribution: [r, g, b],
            weight,
        };
        let candidates = CandidateColumns {
            wi,
            radiance: xi,
            pdf_light: &pdf_light,
        };
        bsdf.weigh_columns(candidates, COUNTS, partition, out_columns)
            .unwrap();
        out
    });
    (proposed, weighed)
}

fn packet(column: &[f32]) -> f32x8 {
    f32x8::new(column.try_into().expect("eight numbers"))
}

fn kernels_have_the_bits_of_samples<M: Model + 'static>(material: &Material<M>)
where
    Bsdf<M>: DynBsdf,
{
    let [wo, wi, mut xi] = columns(200);
    // A discarded sample, whose candidate is 0.
    xi[1][3] = f32::NAN;
    let wo = Vec3::new(wo[0][0], wo[1][0], wo[2][0]);
    for level in Level::available() {
        let hits = Hit8::new(Vec3x8::from([wo; 8]), f32x8::ZERO);
        let bsdf8 = material.with_level(level).prepare8(hits);
        let bsdf = bsdf8.lane(0);
        for (len, partition) in [
            (0, Partition::All),
            (1, Partition::Balance),
            (7, Partition::Power),
            (64, Partition::All),
            (65, Partition::Balance),
            (200, Partition::Power),
        ] {
            let [xi, wi] = [&xi, &wi].map(|rows| rows.each_ref().map(|row| &row[..len]));
            let by_kernels = resampled(&bsdf, xi, wi, partition);
            let by_samples = resampled(&bsdf as &dyn DynBsdf, xi, wi, partition);
            assert_eq!(by_kernels, by_samples, "{len} on {level}");
            assert!(
                len < 4 || by_kernels.0.iter().all(|column| column[3] == 0.0),
                "discarded"
            );
        }
        let (rows, [weighed, _]) = resampled(&bsdf, slices(&xi), slices(&wi), Partition::All);
        for at in (0..200).step_by(8) {
            let eight = |rows: &Rows<3>| rows.each_ref().map(|row| packet(&row[at..at + 8]));
            let ([x, y, z], xi8) = (eight(&wi), eight(&xi));
            let proposed = bsdf8.propose8(&xi8);
            assert_eq!([proposed.x, proposed.y, proposed.z], eight(&rows), "{at}");
            let light = xi8[0] - f32x8::splat(0.1);
            let out = bsdf8.weigh8(&Vec3x8::new(x, y, z), &xi8, &light, COUNTS, Partition::All);
            let [r, g, b] = out.contribution;
            let wanted = weighed.each_ref().map(|row| packet(&row[at..at + 8]));
            assert_eq!([r, g, b, out.weight], wanted, "{at}");
        }
    }
}

#[test]
fn candidates_have_the_bits_of_samples_and_evaluations() {
    let hair = HairParams::blond();
    kernels_have_the_bits_of_samples(&Material::new(&Published(Gaussian), &hair));
    kernels_have_the_bits_of_samples(&Material::new(&Matched::new(Gaussian), &hair));
}
