//! Tests that charts of odd data are valid charts.

mod axis;
#[cfg(feature = "png")]
mod png;

use hairis_instruments::markup::well_formed;
use hairis_instruments::plot::{
    Axis, Bar, PolarPanel, ScatterPanel, Series, SphereGrid, bars, heat_map, lines, polar,
    scatter_maps,
};

const ODD: [f64; 9] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -1.0,
    1e300,
    -1e300,
    1e-300,
    2.0,
];

fn check(svg: &str, what: &str) {
    well_formed(svg).unwrap_or_else(|e| panic!("{what}: {e}\n{svg}"));
    assert!(
        svg.starts_with("<svg xmlns=") && svg.contains("role=\"img\"") && svg.contains("<desc>"),
        "{what}"
    );
    assert!(
        !svg.contains("NaN") && !svg.contains("inf"),
        "{what} has odd coordinates"
    );
    assert!(
        !svg.contains(" id=") && !svg.contains("href"),
        "{what} has ids or links"
    );
    for number in svg
        .split(['"', ' ', ',', 'M', 'h', 'v', 'z'])
        .filter_map(|t| t.parse::<f64>().ok())
    {
        assert!(
            number.abs() < 20_000.0,
            "{what} has the far coordinate {number}"
        );
    }
}

#[test]
fn line_charts_take_any_data() {
    let bar = |y: f64| Bar {
        value: y,
        low: 0.0,
        high: 2.0 * y,
    };
    let pairs = || ODD.into_iter().flat_map(|x| ODD.map(|y| (x, bar(y))));
    for x in [
        Axis::linear("x"),
        Axis::log("x"),
        Axis::linear("x").range(-1.0, 1.0),
    ] {
        for y in [
            Axis::linear("y"),
            Axis::log("y"),
            Axis::log("y").range(1.0, 10.0),
        ] {
            for n in [0, 1, 2, 9, 40, 81] {
                let series = Series::new("a", pairs().take(n));
                for guide in [
                    [(0.0, f64::NAN), (1.0, ODD[n % 9])],
                    [(1.0, ODD[n % 9]), (f64::INFINITY, 2.0)],
                ] {
                    let all = [series.clone(), series.clone(), Series::guide("p", guide)];
                    check(
                        &lines("t", x.clone(), y.clone(), &all),
                        &format!("{x:?} {y:?} {n}"),
                    );
                }
            }
        }
    }
    check(
        &lines("", Axis::linear(""), Axis::log(""), &[]),
        "an empty chart",
    );
}

#[test]
fn other_charts_take_any_data() {
    let groups: Vec<String> = "abcdefghi".chars().map(String::from).collect();
    for y in [Axis::linear("y"), Axis::log("y")] {
        check(&bars("t", y.clone(), &groups, &[], f64::NAN), "no bars");
        let odd = ODD.map(|v| Bar {
            value: v,
            low: 2.0 * v - 1.0,
            high: 1.0,
        });
        let series = [
            ("a".to_owned(), odd.to_vec()),
            ("b".to_owned(), odd[..2].to_vec()),
        ];
        check(
            &bars("t", y.clone(), &groups, &series, f64::NAN),
            "odd bars",
        );
        check(
            &bars(
                "t",
                y,
                &groups[..1],
                &[("a".to_owned(), vec![0.0.into()])],
                0.0,
            ),
            "nothing but 0",
        );
    }
    let mut odd = ODD.into_iter().cycle();
    let grid = SphereGrid::sample((9, 13), &mut |_, _| odd.next().unwrap_or(0.0));
    let positive = SphereGrid::sample((9, 13), &mut |_, _| odd.next().unwrap_or(0.0).abs());
    let flat = SphereGrid::sample((3, 5), &mut |_, _| 0.0);
    let none = SphereGrid::sample((0, 0), &mut |_, _| 0.0);
    for value in [Axis::linear("v"), Axis::log("v")] {
        for (name, grid) in [
            ("differences", &grid),
            ("values", &positive),
            ("zeros", &flat),
            ("nothing", &none),
        ] {
            check(
                &heat_map("t", value.clone(), grid),
                &format!("a map of {name}"),
            );
        }
    }
    let pairs: Vec<(f64, f64)> = ODD.into_iter().flat_map(|x| ODD.map(|y| (x, y))).collect();
    let panel = ScatterPanel {
        title: "p".into(),
        points: pairs.iter().map(|p| [p.0, p.1]).collect(),
        density: grid,
    };
    for panels in [vec![], vec![panel]] {
        check(
            &scatter_maps("t", &panels, "m", [f64::NAN, 0.0]),
            "odd directions",
        );
    }
    let arrow = ("o".into(), f64::INFINITY);
    let panel = PolarPanel {
        title: "p".into(),
        angle: "a".into(),
        lines: vec![pairs],
        arrow,
    };
    for panels in [vec![], vec![panel.clone(), panel]] {
        check(&polar("t", "r", &["s"], &panels), "odd angles");
    }
}

#[test]
fn text_is_escaped() {
    let hostile = "</text><script>\"&'\u{0}\u{7}";
    let axis = || Axis::linear(hostile);
    let svg = lines(
        hostile,
        axis(),
        axis(),
        &[Series::curve(hostile, [(0.0, 1.0), (1.0, 2.0)])],
    );
    check(&svg, "a hostile chart");
    assert!(
        !svg.contains("<script") && !svg.contains(['\u{0}', '\u{7}']),
        "{svg}"
    );
}

#[test]
fn a_line_lies_where_its_points_are() {
    // The diagonal of the plot ends in two corners of the frame; points outside the plot are left out.
    let axes = (
        Axis::linear("x").range(0.0, 10.0),
        Axis::linear("y").range(0.0, 1.0),
    );
    let points = [(-10.0, -1.0), (0.0, 0.0), (10.0, 1.0), (20.0, 2.0)];
    let svg = lines("t", axes.0, axes.1, &[Series::curve("s", points)]);
    let path = |line: &str| -> Vec<i32> {
        let data = line.rsplit(" d=\"M").next().unwrap_or_default();
        data.split(|c: char| !c.is_ascii_digit())
            .filter_map(|n| n.parse().ok())
            .collect()
    };
    let line = path(
        svg.lines()
            .find(|l| l.contains("stroke=\"#0072B2\""))
            .expect("the first colour"),
    );
    let corners = svg
        .lines()
        .map(path)
        .find(|p| p.len() >= 10 && p[..2] == p[8..10])
        .expect("a closed frame");
    assert_eq!(
        line[..2],
        [corners[6], corners[7]],
        "from the lower left corner"
    );
    assert_eq!(
        line[2..4],
        [corners[2], corners[3]],
        "to the upper right corner"
    );
}
