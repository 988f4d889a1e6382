//! Tests of `table`.

mod number;

use hairis_instruments::markup;
use hairis_instruments::table::Table;

const WIDE: Option<u16> = Some(u16::MAX);

fn example() -> Table {
    let mut table = Table::new("Speed <of> \"hair\"")
        .texts(["kernel"])
        .numbers(["time (ns)", "ratio"]);
    table.push(["eval & sample", "8.31 ± 0.02", "13.4×"]);
    table.push(["short"]);
    table.push(["long", "1", "2", "dropped"]);
    table
}

#[test]
fn the_terminal_and_the_report_show_the_same_cells() {
    let (plain, html) = (example().to_text(WIDE), example().to_html());
    for cell in ["8.31 ± 0.02", "13.4×", "time (ns)", "short"] {
        assert!(
            plain.contains(cell) && html.contains(cell),
            "{cell} in {plain} and {html}"
        );
    }
    assert!(
        !plain.contains("dropped") && !html.contains("dropped"),
        "a cell beyond the columns"
    );
    assert_eq!(
        html.matches("<t").count() - html.matches("<tr").count(),
        3 + 3 + 9,
        "every row is full: {html}"
    );
}

#[test]
fn html_is_escaped_and_nests() {
    let html = example().note("</table>").to_html();
    markup::well_formed(&html).expect("the table nests");
    assert!(
        html.contains("Speed &lt;of&gt; &quot;hair&quot;") && html.contains("eval &amp; sample"),
        "{html}"
    );
}

#[test]
fn columns_line_up_and_lines_keep_to_the_width() {
    let plain = example().to_text(WIDE);
    let ends: Vec<usize> = plain
        .lines()
        .filter(|l| l.contains("13.4×") || l.contains("ratio"))
        .map(|l| l.chars().count())
        .collect();
    assert_eq!(ends.len(), 2, "{plain}");
    assert_eq!(
        ends[0], ends[1],
        "numbers end where their header does: {plain}"
    );
    let mut wide = Table::new("t").texts(["a", "b"]);
    wide.push(["word ".repeat(30), "other ".repeat(30)]);
    let text = wide.to_text(Some(60));
    assert!(text.lines().all(|l| l.chars().count() <= 60), "{text}");
    assert!(
        wide.to_text(WIDE).lines().any(|l| l.chars().count() > 200),
        "nothing is broken off a terminal"
    );
    assert!(
        !Table::new("a\u{1b}[31m").to_text(None).contains('\u{1b}'),
        "no escape sequences get through"
    );
}

/// Every part of a table that is too wide names its rows, and no cell is lost or broken.
#[test]
fn a_table_that_is_too_wide_stands_in_parts() {
    let mut table = Table::new("Parts")
        .texts(["row"])
        .numbers((0..12).map(|k| format!("number {k}")));
    for row in ["first", "second"] {
        let cells = (0..12).map(|k| format!("{row}-{k}"));
        table.push([row.to_owned()].into_iter().chain(cells));
    }
    for width in [30, 60, 90] {
        let text = table.to_text(Some(width));
        let longest = text.lines().map(|line| line.chars().count()).max();
        assert!(longest <= Some(usize::from(width)), "{text}");
        let words = |word: &str| text.split_whitespace().filter(|one| *one == word).count();
        for k in 0..12 {
            assert_eq!(
                [words(&format!("first-{k}")), words(&format!("second-{k}"))],
                [1, 1],
                "{text}"
            );
        }
        assert_eq!(words("row"), words("first"), "{text}");
        assert!(words("row") > 1, "{text}");
    }
    assert_eq!(table.to_text(None), table.to_text(WIDE));
}
