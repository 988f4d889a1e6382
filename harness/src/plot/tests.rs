//! Charts of odd data are charts.

use super::*;
use crate::markup::well_formed;

const ODD: [f64; 9] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0, 1e300, -1e300, 1e-300, 2.0];

fn check(svg: &str, what: &str) {
    well_formed(svg).unwrap_or_else(|e| panic!("{what}: {e}\n{svg}"));
    assert!(svg.starts_with("<svg xmlns=") && svg.contains("role=\"img\"") && svg.contains("<desc>"), "{what}");
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{what} has odd coordinates");
    assert!(!svg.contains(" id=") && !svg.contains("href"), "{what} has ids or links");
    for number in svg.split(['"', ' ', ',', 'M', 'h', 'v', 'z']).filter_map(|t| t.parse::<f64>().ok()) {
        assert!(number.abs() < 20_000.0, "{what} has the far coordinate {number}");
    }
}

#[test]
fn line_charts_take_any_data() {
    let pairs = || ODD.into_iter().flat_map(|x| ODD.map(|y| (x, Bar::new(y).with_error(y))));
    for x in [Axis::linear("x"), Axis::log("x"), Axis::linear("x").range(-1.0, 1.0)] {
        for y in [Axis::linear("y"), Axis::log("y"), Axis::log("y").range(1.0, 10.0)] {
            for n in [0, 1, 2, 9, 40, 81] {
                let series = Series::new("a", pairs().take(n));
                let chart = LineChart::new("t", x.clone(), y.clone()).series(series.clone()).series(series);
                check(&chart.clone().reference("p", -0.5, (0.0, f64::NAN)).svg(), &format!("{x:?} {y:?} {n}"));
                check(&chart.reference("l", 0.0, (1.0, ODD[n % 9])).svg(), &format!("{x:?} {y:?} {n} with a level"));
            }
        }
    }
    check(&LineChart::new("", Axis::linear(""), Axis::log("")).svg(), "an empty chart");
}

#[test]
fn other_charts_take_any_data() {
    for y in [Axis::linear("y"), Axis::log("y")] {
        let chart = BarChart::new("t", y, "abcdefghi".chars());
        let chart = chart.level(f64::NAN);
        check(&chart.clone().svg(), "no bars");
        let bars = ODD.map(|v| Bar::new(v).with_error(1.0 - v));
        check(&chart.series("a", bars).series("b", bars.into_iter().take(2)).svg(), "odd bars");
    }
    let mut odd = ODD.into_iter().cycle();
    let grid = SphereGrid::sample(Projection::EqualArea, (9, 13), |_, _| odd.next().unwrap_or(0.0));
    for value in [Axis::linear("v"), Axis::log("v")] {
        check(&HeatMap::new("t", value.clone(), grid.clone()).svg(), "an odd heat map");
        check(&HeatMap::signed("t", value.clone(), grid.clone()).svg(), "an odd map of differences");
        let flat = SphereGrid::sample(Projection::EqualAngle, (3, 5), |_, _| 0.0);
        check(&HeatMap::new("t", value.clone(), flat).svg(), "a flat heat map");
        let none = SphereGrid::sample(Projection::EqualAngle, (0, 0), |_, _| 0.0);
        check(&HeatMap::new("t", value, none).svg(), "an empty heat map");
    }
    let pairs: Vec<(f64, f64)> = ODD.into_iter().flat_map(|x| ODD.map(|y| (x, y))).collect();
    let panel = ScatterPanel { title: "p".into(), points: pairs.iter().map(|p| [p.0, p.1]).collect(), density: grid };
    for panels in [vec![], vec![panel]] {
        let mark = ("m".into(), [f64::NAN, 0.0]);
        check(&ScatterMap { title: "t".into(), panels, mark }.svg(), "odd directions");
    }
    let series = vec![("s".into(), pairs)];
    let panel = PolarPanel { title: "p".into(), angle: "a".into(), series, arrow: ("o".into(), f64::INFINITY) };
    for panels in [vec![], vec![panel.clone(), panel]] {
        check(&PolarChart { title: "t".into(), radius: "r".into(), panels }.svg(), "odd angles");
    }
}

#[test]
fn text_is_escaped() {
    let hostile = "</text><script>\"&'\u{0}\u{7}";
    let axis = || Axis::linear(hostile);
    let svg = LineChart::new(hostile, axis(), axis()).series(Series::curve(hostile, [(0.0, 1.0), (1.0, 2.0)])).svg();
    check(&svg, "a hostile chart");
    assert!(!svg.contains("<script") && !svg.contains(['\u{0}', '\u{7}']), "{svg}");
}

#[test]
fn a_line_lies_where_its_points_are() {
    // The diagonal of the plot, given by points far outside of it, ends in two corners of the frame.
    let axes = (Axis::linear("x").range(0.0, 10.0), Axis::linear("y").range(0.0, 1.0));
    let svg = LineChart::new("t", axes.0, axes.1).series(Series::curve("s", [(-10.0, -1.0), (20.0, 2.0)])).svg();
    let path = |line: &str| -> Vec<i32> {
        let data = line.rsplit(" d=\"M").next().unwrap_or_default();
        data.split(|c: char| !c.is_ascii_digit()).filter_map(|n| n.parse().ok()).collect()
    };
    let line = path(svg.lines().find(|l| l.contains("stroke=\"#0072B2\"")).expect("the first colour"));
    let corners = svg.lines().map(path).find(|p| p.len() >= 10 && p[..2] == p[8..10]).expect("a closed frame");
    assert_eq!(line[..2], [corners[6], corners[7]], "from the lower left corner");
    assert_eq!(line[2..4], [corners[2], corners[3]], "to the upper right corner");
}
