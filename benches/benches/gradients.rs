//! Time of derivatives over that of values, in slices of hits, of every model on every level.
//!
//! `cargo bench -p hairis-benches --bench gradients` prints a record: with and without the density.

use core::array::from_fn;
use core::hint::black_box;
use hairis::columns::{EvalColumns, HitColumns};
use hairis::simd::Level;
use hairis::{Gaussian, Matched, Material, Published};
use hairis_benches::inputs::{Column, DIRECTIONS, Inputs, arrays};
use hairis_benches::{cpu, turns};
use hairis_gradients::{Differentiable, GradColumns, Gradients, Weights};
use hairis_variants::{AllCauchy, Cauchy, Chiang, DEon, KajiyaKay, ModelId, Parameters};

fn main() {
    println!("# CPU: {}", cpu::name());
    println!("# compiled for {}", Level::portable());
    println!("model,call,level,ns,base_ns,ratio");
    let inputs = Inputs::draw();
    macro_rules! all {
        ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
            $(time::<$model>(ModelId::$variant, &inputs);)*
        };
    }
    hairis_variants::for_each_model! { all }
}

fn parts<const N: usize>(columns: &mut [Column; N]) -> [&mut [f32]; N] {
    columns
        .each_mut()
        .map(|column| column.part_mut(0, DIRECTIONS))
}

fn time<M: Differentiable>(id: ModelId, inputs: &Inputs) {
    let turns = turns::turns();
    let columns = |first: usize, rows: &[[f32; 3]]| -> [Column; 3] {
        from_fn(|k| Column::new(first + k, rows.iter().map(|row| row[k])))
    };
    let [wo, wi, xi] = [
        columns(0, &arrays(&inputs.wo)),
        columns(3, &arrays(&inputs.wi)),
        columns(6, &inputs.xi),
    ];
    let [wo, wi, xi] =
        [&wo, &wi, &xi].map(|columns| columns.each_ref().map(|c| c.part(0, DIRECTIONS)));
    // Offsets and weights are any numbers.
    let hits = HitColumns { wo, h: Some(xi[0]) };
    let mut ours: [Column; 11] = from_fn(|k| Column::new(9 + k, []));
    let mut base: [Column; 4] = from_fn(|k| Column::new(9 + k, []));
    let mut sums = vec![0.0; Gradients::<M>::NUMBERS];
    let params = &M::Params::PRESETS[0].1;
    for level in Level::available() {
        let gradients = Gradients::<M>::new(params).with_level(level);
        let material = Material::new(&M::MODEL, params).with_level(level);
        for has_pdf in [false, true] {
            let [ns, base_ns, ratio] = turns::pair(
                turns,
                DIRECTIONS,
                || {
                    let [r, g, b, pdf, u, v, w, h, x, y, z] = parts(&mut ours);
                    let weights = Weights {
                        value: Some(xi),
                        pdf: Some(xi[1]),
                    };
                    let out = GradColumns {
                        value: Some([r, g, b]),
                        pdf: Some(pdf),
                        d_wo: Some([u, v, w]),
                        d_h: Some(h),
                        d_wi: Some([x, y, z]),
                        d_material: Some(&mut sums),
                        d_material_of_hits: None,
                    };
                    let done = if has_pdf {
                        gradients.eval_pdf_grad(hits, wi, weights, out)
                    } else {
                        gradients.eval_grad(hits, wi, weights, out)
                    };
                    black_box(done.is_ok());
                },
                || {
                    let [r, g, b, pdf] = parts(&mut base);
                    let out = EvalColumns {
                        value: Some([r, g, b]),
                        pdf: has_pdf.then_some(pdf),
                    };
                    black_box(material.eval_hits(hits, wi, out).is_ok());
                },
            );
            let call = if has_pdf {
                "value and density"
            } else {
                "value"
            };
            println!("{id:?},{call},{level},{ns:.2},{base_ns:.2},{ratio:.3}");
        }
    }
}
