//! A ray against a segment.

use glam::Vec3;
use hairis_render::geometry::Strands;
use hairis_render::tree::{Ray, Tree};

#[test]
fn offset_has_the_sign_of_the_kernels() {
    let mut builder = Strands::builder();
    builder.push([(Vec3::NEG_X, 0.1), (Vec3::X, 0.1)]).expect("a cylinder");
    let tree = Tree::build(&builder.finish()).expect("a small scene");
    let frame = hairis::FiberFrame { u: Vec3::X, v: Vec3::Y, w: Vec3::Z };
    for z in [-0.09_f32, -0.02, 0.0, 0.05, 0.08] {
        let hit = tree.closest(&Ray::new(Vec3::new(0.5, 2.0, z), Vec3::NEG_Y)).expect("within the radius");
        let normal = Vec3::new(0.0, (0.01 - z * z).sqrt(), z);
        let expected = frame.offset(normal, Vec3::Y);
        assert!((hit.h - expected).abs() < 1e-5, "at z = {z}: {} and {expected}", hit.h);
        assert!((hit.t - 2.0).abs() < 1e-6 && (hit.s - 0.75).abs() < 1e-6, "{hit:?}");
    }
}
