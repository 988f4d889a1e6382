//! Tests of `report`.

// GLOB rayon::prelude::*
use hairis_instruments::markup::well_formed;
use hairis_instruments::plot::{Axis, Series, lines};
use hairis_instruments::report::{Drawing, Report, Section, literal};
use hairis_instruments::table::Table;
use std::fs;

const HOSTILE: &str = "`<img src=x onerror=alert(1)>`\"'</style></section>&amp;`\u{0}";

fn full(text: &str) -> Report {
    let svg = || {
        lines(
            text,
            Axis::linear(text),
            Axis::log(text),
            &[Series::curve(text, [(1.0, 2.0)])],
        )
    };
    let mut table = Table::new(text).texts([text]).numbers([text]).note(text);
    table.push([text, text]);
    let section = Section::new(text)
        .heading(text)
        .paragraph(text)
        .tables([table])
        .facts(&[[text, text]]);
    let section = section.figures([Drawing::new("", svg(), text), Drawing::new("", svg(), text)]);
    let text = text.to_owned();
    Report {
        title: text.clone(),
        subtitle: text.clone(),
        verdicts: vec![[text.clone(), text.clone()]],
        summary: Some(Drawing::new("summary", svg(), text.clone())),
        findings: vec![text.clone()],
        sections: vec![section, Section::new(text.clone()).paragraph(text)],
    }
}

#[test]
fn hostile_text_is_inert() {
    let html = full(HOSTILE).html();
    well_formed(&html).expect("the page nests");
    assert!(
        !html.contains("<img") && !html.contains('\u{0}'),
        "hostile text got through"
    );
    assert_eq!(html.matches("</style>").count(), 1, "the style ends once");
    assert!(
        html.contains("<code>&lt;img src=x onerror=alert(1)&gt;</code>"),
        "code is set as code"
    );
}

/// A name has all of its letters, in text and in code, and sets nothing else as code.
#[test]
fn names_are_literal() {
    for name in [
        "a`b",
        "`",
        "``",
        "\\",
        "a\\`b`\\",
        "\\\\",
        "plain",
        "<b>`x`</b>",
    ] {
        let escaped = hairis_instruments::markup::escape(name);
        let name = literal(name);
        let html = Section::new("").paragraph(format!("hair {name} of `{name}`: `code`"));
        let html = Report {
            sections: vec![html],
            ..Report::default()
        }
        .html();
        let expected =
            format!("<p>hair {escaped} of <code>{escaped}</code>: <code>code</code></p>");
        assert!(html.contains(&expected), "{name}: {html}");
    }
    let html = Section::new("").paragraph("a ` without a pair, C:\\hair");
    let html = Report {
        sections: vec![html],
        ..Report::default()
    }
    .html();
    assert!(
        html.contains("<p>a ` without a pair, C:\\hair</p>"),
        "{html}"
    );
}

#[test]
fn a_page_without_verdicts_has_no_empty_box() {
    let page = Report {
        findings: vec!["one".to_owned()],
        ..Report::default()
    };
    let html = page.html();
    well_formed(&html).expect("the page nests");
    assert!(!html.contains("id=\"verdicts\""), "{html}");
    assert!(full("text").html().contains("id=\"verdicts\""));
}

#[test]
fn a_page_stands_alone_and_ids_are_unique() {
    let html = full("text").html();
    for outside in ["http-equiv", "<script", "<link", "src=", "url(", "@import"] {
        assert!(!html.contains(outside), "{outside} reaches outside");
    }
    let links = html.replace("http://www.w3.org/2000/svg", "");
    assert!(!links.contains("http"), "no addresses");
    let mut ids: Vec<&str> = html
        .split(" id=\"")
        .skip(1)
        .filter_map(|t| t.split('"').next())
        .collect();
    let all = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all, "an id stands twice");
    let anchors = html
        .split("href=\"#")
        .skip(1)
        .filter_map(|t| t.split('"').next());
    assert!(
        anchors.clone().count() == 2 && anchors.into_iter().all(|a| ids.contains(&a)),
        "links have ends"
    );
}

#[test]
fn figures_are_written_by_number_and_name() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let mut report = full("text");
    let svg = lines("t", Axis::linear("x"), Axis::linear("y"), &[]);
    report
        .sections
        .push(Section::new("s").figures([Drawing::new("last", svg.clone(), "c")]));
    Report::writable(dir.path()).expect("a new folder");
    let count = |name: &str| {
        fs::read_dir(dir.path().join(name))
            .expect("a folder")
            .count()
    };
    assert_eq!([count(""), count("figures")], [1, 0], "no file is left");
    report.write(dir.path(), "example").expect("written");
    let read = |name: &str| fs::read(dir.path().join(name)).expect("there");
    assert_eq!(read("report.html"), report.html().as_bytes());
    assert_eq!(read("figures/example-04-last.svg"), svg.as_bytes());
    let has_png = cfg!(feature = "png");
    assert!(
        !has_png || read("figures/example-02.png").starts_with(b"\x89PNG"),
        "a PNG beside each SVG"
    );
    assert_eq!(count("figures"), if has_png { 8 } else { 4 });
}

#[test]
fn reports_that_cannot_be_written_are_refused() {
    let dir = tempfile::TempDir::new().expect("a folder");
    let at = |name: &str| dir.path().join(name);
    fs::create_dir_all(at("page/report.html")).expect("made");
    fs::create_dir(at("folder")).expect("made");
    fs::write(at("folder/figures"), "").expect("written");
    for (name, file) in [("page", "report.html"), ("folder", "figures")] {
        let error = Report::writable(&at(name)).expect_err(name).to_string();
        assert!(error.contains(file), "{error}");
    }
}

#[test]
fn an_empty_report_is_a_page() {
    well_formed(&Report::default().html()).expect("the page nests");
}

#[test]
fn the_head_keeps_to_the_width_of_a_terminal() {
    let verdict = |name: &str| {
        let sentence = "`matched` takes ".to_owned() + &"many words ".repeat(20);
        [name.to_owned(), sentence]
    };
    let report = Report {
        title: "Is the report as narrow as the terminal that it is read on?".to_owned(),
        subtitle: literal("map `a`.exr"),
        verdicts: vec![verdict("Speed"), verdict("Under a large area light")],
        ..Report::default()
    };
    for width in [24, 40, 80, 100] {
        let head = report.headline(width, "out/report.html");
        let longest = head.lines().map(|line| line.chars().count()).max();
        assert!(longest <= Some(width), "{width}: {head}");
        assert!(
            head.contains("map `a`.exr") && !head.contains("`matched`"),
            "{head}"
        );
        assert!(head.ends_with("out/report.html\n"), "{head}");
        assert_eq!(head.matches("many").count(), 40, "{head}");
    }
}
