//! Cells of the grid.

use hairis::HairParams;
use hairis_study::study::grid::*;

#[test]
fn every_cell_is_there_once_and_accepted() {
    assert_eq!(Grid::FULL.len(), 3024);
    for grid in [Grid::FULL, Grid::QUICK] {
        let mut seen: Vec<[u32; 6]> = (0..grid.len())
            .map(|i| grid.cell(i).values().map(f32::to_bits))
            .collect();
        for i in 0..grid.len() {
            grid.cell(i).params().expect("within the ranges accepted");
        }
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), grid.len());
    }
    assert_eq!(
        Grid::FULL.cell(1).theta_o_deg,
        15.0,
        "the last axis runs fastest"
    );
}

#[test]
fn the_short_grid_is_part_of_the_whole_and_holds_the_default_hair() {
    let full: Vec<[f32; 6]> = (0..Grid::FULL.len())
        .map(|i| Grid::FULL.cell(i).values())
        .collect();
    let quick: Vec<Cell> = (0..Grid::QUICK.len())
        .map(|i| Grid::QUICK.cell(i))
        .collect();
    assert!(
        quick.iter().all(|cell| full.contains(&cell.values())),
        "cells of its own"
    );
    let default = HairParams::bright();
    let near = |a: f32, b: f32| (a - b).abs() <= 1e-6;
    let is_default = |cell: &&Cell| {
        let params = cell.params().expect("accepted");
        let (a, b) = (params.desc(), default.desc());
        near(a.beta[0], b.beta[0])
            && near(a.beta[1], b.beta[1])
            && near(a.beta[2], b.beta[2])
            && near(a.gamma_tt, b.gamma_tt)
            && near(a.gamma_g, b.gamma_g)
            && near(a.phi_g, b.phi_g)
            && a.i_g == b.i_g
    };
    assert_eq!(
        quick.iter().filter(is_default).count(),
        4,
        "the default hair from four inclinations"
    );
}

#[test]
fn shifts_and_colours_are_those_of_the_grid() {
    let params = Grid::FULL.cell(0).params().expect("accepted");
    let desc = params.desc();
    let deg = |rad: f32| f64::from(rad.to_degrees());
    for (got, want) in [
        (desc.alpha[0], -7.5),
        (desc.alpha[1], 3.75),
        (desc.alpha[2], 11.25),
    ] {
        assert!((deg(got) - want).abs() < 1e-5, "{got} for {want}");
    }
    assert_eq!(
        [desc.i_r, desc.i_tt, desc.i_trt],
        [[0.3; 3], [0.8, 0.6, 0.4], [0.7, 0.5, 0.3]]
    );
}
