{
    use glam::Vec3;
    use hairis::Hit;
    use hairis_conformance::{Case, Replay, Row, totality};
    let mut case = Case::new(|| Row {
        material: subject.materials().swap_remove(0).1,
        hit: Hit::new(Vec3::new(0.0, 1.0, 0.0), 0.0),
        wi: Vec3::new(0.0, 1.0, 0.0),
        xi: [0.0, 0.0, 0.0],
        tolerances: true,
    });
    case.rows[5] = Row {
        material: subject.materials().swap_remove(0).1,
        hit: Hit::new(Vec3::new(0.0, 1.0, 0.0), 0.0),
        wi: Vec3::new(0.0, 0.0, 1e30),
        xi: [0.0, 0.0, 0.0],
        tolerances: true,
    };
    totality::results_are_finite(&Replay::pasted(&subject, case))
}
