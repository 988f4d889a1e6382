{
    use glam::Vec3;
    use hairis::Hit;
    use hairis_conformance::{Case, Replay, Row, lanes};
    let mut case = Case::new(|| Row {
        material: subject.materials().swap_remove(0).1,
        hit: Hit::new(Vec3::new(0.0, 1.0, 0.0), 0.0),
        wi: Vec3::new(0.0, 1.0, 0.0),
        xi: [0.0, 0.0, 0.0],
        tolerances: true,
    });
    case.rows[6] = Row {
        material: subject.materials().swap_remove(1).1,
        hit: Hit::new(Vec3::new(0.0, 1.0, 0.0), 0.0),
        wi: Vec3::new(0.0, 1.0, 0.0),
        xi: [0.0, 0.0, 0.0],
        tolerances: true,
    };
    case.order = [2, 1, 3, 0, 6, 7, 4, 5];
    lanes::lanes_permute(&Replay::pasted(&subject, case))
}
