{
    use glam::Vec3;
    use hairis::Hit;
    use hairis_conformance::{Case, Replay, Row, bounds};
    let mut case = Case::new(|| Row {
        material: subject.materials().swap_remove(0).1,
        hit: Hit::new(Vec3::new(0.0, 1.0, 0.0), 0.0),
        wi: Vec3::new(0.0, 1.0, 0.0),
        xi: [0.0, 0.0, 0.0],
        tolerances: true,
    });
    case.rows[7] = Row {
        material: subject.materials().swap_remove(0).1,
        hit: Hit::new(Vec3::new(0.0, 1.0, 0.0), 0.0),
        wi: Vec3::new(-0.88704467, 0.4616836, 0.0),
        xi: [0.0, 0.0, 0.0],
        tolerances: true,
    };
    bounds::eval_is_reciprocal(&Replay::pasted(&subject, case))
}
