//! Tests of `transport::resampled::cells`.

use glam::Vec3;
use hairis_instruments::sequence::{Independent, XiSource as _};
use hairis_render::transport::resampled::cells::{CELLS, CURVE, SIDE, cells};

#[test]
fn the_curve_goes_from_cell_to_neighbour() {
    let mut at = [[0; 2]; CELLS];
    for (index, place) in CURVE.iter().enumerate() {
        at[usize::from(*place)] = [index / SIDE, index % SIDE];
    }
    for pair in at.windows(2) {
        let steps = pair[0][0].abs_diff(pair[1][0]) + pair[0][1].abs_diff(pair[1][1]);
        assert_eq!(steps, 1, "{pair:?}");
    }
}

#[test]
fn a_cell_is_a_small_part_of_the_sphere() {
    let mut xi = Independent::new(3, 0);
    let mut members = vec![Vec::new(); CELLS];
    for _ in 0..4000 {
        let dirs: [Vec3; 8] =
            core::array::from_fn(|_| hairis_render::lights::uniform_direction(xi.next_xi_f32()));
        for (dir, cell) in dirs.iter().zip(cells(&dirs.into())) {
            members[usize::from(cell)].push(*dir);
        }
    }
    for members in &members {
        let mean = members.iter().sum::<Vec3>().normalize();
        assert!(members.len() > 200, "{} directions", members.len());
        // The sphere has cells of 0.2 sr, longer where it is unfolded.
        assert!(
            members.iter().all(|dir| dir.dot(mean) > 0.7),
            "about {mean}"
        );
    }
    let none = cells(
        &[
            Vec3::ZERO,
            Vec3::NAN,
            Vec3::INFINITY,
            Vec3::Y,
            -Vec3::Y,
            Vec3::X,
            -Vec3::X,
            Vec3::Z,
        ]
        .into(),
    );
    assert!(
        none.iter().all(|cell| usize::from(*cell) < CELLS),
        "{none:?}"
    );
}
