{
    use glam::Vec3;
    use hairis::Hit;
    use hairis_conformance::{Case, Replay, Row, lobes};
    let mut case = Case::new(|| Row {
        material: subject.materials().swap_remove(0).1,
        hit: Hit::new(Vec3::new(0.0, 1.0, 0.0), 0.0),
        wi: Vec3::new(0.0, 1.0, 0.0),
        xi: [0.0, 0.0, 0.0],
        tolerances: true,
    });
    case.rows[0] = Row {
        material: Params { fault: 1065353223, kd: [0.0, 0.0, 0.0], ks: [0.0, 0.0, 0.0], width: 1.0 },
        hit: Hit::new(Vec3::new(0.0, 1.0, 0.0), 0.0),
        wi: Vec3::new(0.0, 1.0, 0.0),
        xi: [0.0, 0.0, 0.0],
        tolerances: false,
    };
    lobes::masks_select_lobes(&Replay::pasted(&subject, case))
}
