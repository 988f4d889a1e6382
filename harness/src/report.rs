//! The report: one self-contained HTML page, without scripts.

use crate::error::Error;
use crate::files::whole;
use crate::markup::escape;
#[cfg(feature = "png")]
use crate::plot::png;
use crate::table::Table;
use rayon::prelude::*;
use std::fs;
use std::io::Write;
use std::path::Path;

const STYLE: &str = include_str!("report/style.css");

/// A page under construction: verdicts and one plot, then findings, then sections of plots with their tables folded away,
/// then the method.
///
/// Texts are plain: everything in them is escaped, and what stands between `` ` `` marks is set as code.
///
/// ```
/// use hairis_harness::report::{Report, Section};
/// let html = Report::new("Comparison")
///     .verdict("Speed", "Eight lanes are `7.1×` as fast as one.")
///     .section(Section::new("Speed").paragraph("Measured on an idle machine."))
///     .fact("CPU", "Example <9000>")
///     .html();
/// assert!(html.contains("<code>7.1×</code>") && html.contains("Example &lt;9000&gt;"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    title: String,
    subtitle: String,
    verdicts: Vec<[String; 2]>,
    summary: Option<Drawing>,
    findings: Vec<String>,
    sections: Vec<Section>,
    method: Section,
    facts: Vec<[String; 2]>,
}

/// A part of a report, under a heading of its own and in the table of contents.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    title: String,
    blocks: Vec<Block>,
}

#[derive(Clone, Debug, PartialEq)]
enum Block {
    Heading(String),
    Paragraph(String),
    Table(Table),
    Drawing(Drawing),
    Facts(Vec<[String; 2]>),
}

/// A drawing with its caption.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Name of its files, without the end; empty for none.
    pub name: String,
    /// A complete `<svg>` element, as those of [`crate::plot`]: it goes into the page as it is.
    pub svg: String,
    /// Caption.
    pub caption: String,
}

impl Drawing {
    /// A drawing with its caption.
    #[must_use]
    pub fn new(svg: impl Into<String>, caption: impl Into<String>) -> Self {
        Self { name: String::new(), svg: svg.into(), caption: caption.into() }
    }

    /// Names its files: letters, digits and hyphens.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// The figure, with the number after `last`.
    fn html(&self, last: &mut usize) -> String {
        *last += 1;
        format!(
            "<figure id=\"figure-{last}\">\n<div class=\"plot\">\n{}</div>\n\
             <figcaption><strong>Figure {last}.</strong> {}</figcaption>\n</figure>\n",
            self.svg,
            inline(&self.caption)
        )
    }
}

impl Section {
    /// A section without content.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), blocks: Vec::new() }
    }

    /// Adds a heading within the section.
    #[must_use]
    pub fn heading(self, text: impl Into<String>) -> Self {
        self.with([Block::Heading(text.into())])
    }

    /// Adds a paragraph.
    #[must_use]
    pub fn paragraph(self, text: impl Into<String>) -> Self {
        self.with([Block::Paragraph(text.into())])
    }

    /// Adds a table.
    #[must_use]
    pub fn table(self, table: Table) -> Self {
        self.tables([table])
    }

    /// Adds tables.
    #[must_use]
    pub fn tables(self, tables: impl IntoIterator<Item = Table>) -> Self {
        self.with(tables.into_iter().map(Block::Table))
    }

    /// Adds a figure; figures are numbered through the report.
    #[must_use]
    pub fn figure(self, figure: Drawing) -> Self {
        self.figures([figure])
    }

    /// Adds figures.
    #[must_use]
    pub fn figures(self, figures: impl IntoIterator<Item = Drawing>) -> Self {
        self.with(figures.into_iter().map(Block::Drawing))
    }

    fn with(mut self, blocks: impl IntoIterator<Item = Block>) -> Self {
        self.blocks.extend(blocks);
        self
    }
}

impl Report {
    /// A page without content.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), method: Section::new("Method and machine"), ..Self::default() }
    }

    /// The line under the title, such as when and where it was made.
    #[must_use]
    pub fn subtitle(self, text: impl Into<String>) -> Self {
        Self { subtitle: text.into(), ..self }
    }

    /// Adds the verdict on a use case; they come first.
    #[must_use]
    pub fn verdict(mut self, case: impl Into<String>, sentence: impl Into<String>) -> Self {
        self.verdicts.push([case.into(), sentence.into()]);
        self
    }

    /// Sets the plot beside the verdicts.
    #[must_use]
    pub fn summary(self, figure: Drawing) -> Self {
        Self { summary: Some(figure), ..self }
    }

    /// Adds a finding; they follow the verdicts.
    #[must_use]
    pub fn finding(mut self, text: impl Into<String>) -> Self {
        self.findings.push(text.into());
        self
    }

    /// Adds a section.
    #[must_use]
    pub fn section(mut self, section: Section) -> Self {
        self.sections.push(section);
        self
    }

    /// Adds a paragraph to "Method and machine", the last section.
    #[must_use]
    pub fn method(self, text: impl Into<String>) -> Self {
        Self { method: self.method.paragraph(text), ..self }
    }

    /// Adds a fact to "Method and machine": the CPU, the seed, the commit.
    #[must_use]
    pub fn fact(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.facts.push([name.into(), value.into()]);
        self
    }

    /// The page.
    #[must_use]
    pub fn html(&self) -> String {
        let mut figure = 0;
        let mut verdicts = String::new();
        if !self.verdicts.is_empty() {
            let summary: String = self.summary.iter().map(|drawing| drawing.html(&mut figure)).collect();
            let sentences = definitions(&self.verdicts);
            verdicts = format!("<section id=\"verdicts\" class=\"verdicts\">\n{sentences}{summary}</section>\n");
        }
        let mut findings: String = self.findings.iter().map(|text| format!("<li>{}</li>\n", answer(text))).collect();
        if !findings.is_empty() {
            findings = format!("<section id=\"findings\">\n<h2>In figures</h2>\n<ul>\n{findings}</ul>\n</section>\n");
        }
        let (mut contents, mut sections) = (String::new(), String::new());
        let method = self.method.clone().with([Block::Facts(self.facts.clone())]);
        for (i, section) in (1..).zip(self.sections.iter().chain([&method])) {
            let title = inline(&section.title);
            let blocks: String = section.blocks.iter().map(|block| block.html(&mut figure)).collect();
            contents += &format!("<li><a href=\"#section-{i}\">{title}</a></li>\n");
            sections += &format!("<section id=\"section-{i}\">\n<h2>{title}</h2>\n{blocks}</section>\n");
        }
        let (title, subtitle) = (escape(&self.title), inline(&self.subtitle));
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n\
             </head>\n<body>\n<header>\n<h1>{title}</h1>\n<p class=\"subtitle\">{subtitle}</p>\n</header>\n<main>\n\
             {verdicts}<nav aria-label=\"Contents\">\n<ol>\n{contents}</ol>\n</nav>\n{findings}{sections}</main>\n\
             </body>\n</html>\n"
        )
    }

    /// The figures in their order.
    fn figures(&self) -> impl Iterator<Item = &Drawing> {
        let blocks = self.sections.iter().flat_map(|section| &section.blocks);
        let figures = blocks.filter_map(|block| if let Block::Drawing(figure) = block { Some(figure) } else { None });
        self.summary.iter().chain(figures)
    }

    /// Writes the page to `report.html` in `dir`, and every figure to `figures/NAME-NUMBER-....svg`, with feature `png` to
    /// `.png` too, each as a whole or not at all.
    ///
    /// # Errors
    ///
    /// [`Error::Output`] for one that cannot be written.
    pub fn write(&self, dir: &Path, name: &str) -> Result<(), Error> {
        whole(&dir.join("report.html"), |out| out.write_all(self.html().as_bytes()))?;
        let folder = dir.join("figures");
        fs::create_dir_all(&folder).map_err(|source| Error::Output { path: folder.clone(), source })?;
        let figures: Vec<(usize, &Drawing)> = (1..).zip(self.figures()).collect();
        figures.par_iter().try_for_each(|(number, figure)| {
            let hyphen = if figure.name.is_empty() { "" } else { "-" };
            let stem = format!("{name}-{number:02}{hyphen}{}", figure.name);
            whole(&folder.join(format!("{stem}.svg")), |out| out.write_all(figure.svg.as_bytes()))?;
            #[cfg(feature = "png")]
            whole(&folder.join(format!("{stem}.png")), |out| out.write_all(&png(&figure.svg)?))?;
            Ok(())
        })
    }
}

impl Block {
    fn html(&self, figure: &mut usize) -> String {
        match self {
            Self::Heading(text) => format!("<h3>{}</h3>\n", inline(text)),
            Self::Paragraph(text) => format!("<p>{}</p>\n", inline(text)),
            Self::Table(table) => {
                let title = escape(table.title());
                format!("<details><summary>{title}</summary>\n{}</details>\n", table.to_html())
            }
            Self::Drawing(drawing) => drawing.html(figure),
            Self::Facts(facts) => definitions(facts),
        }
    }
}

fn definitions(pairs: &[[String; 2]]) -> String {
    let item = |[name, text]: &[String; 2]| format!("<dt>{}</dt><dd>{}</dd>\n", inline(name), inline(text));
    format!("<dl>\n{}</dl>\n", pairs.iter().map(item).collect::<String>())
}

/// A finding: the question that it begins with, if any, stands out.
fn answer(text: &str) -> String {
    match text.split_once("? ") {
        Some((question, answer)) if !question.contains(['.', '`']) => {
            format!("<strong>{}?</strong> {}", inline(question), inline(answer))
        }
        _ => inline(text),
    }
}

/// Escaped text with what stands between pairs of `` ` `` as code; numbers stay with their unit.
fn inline(text: &str) -> String {
    let mut html = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('`') {
        let Some((code, after)) = after.split_once('`') else { break };
        html.push_str(&format!("{}<code>{}</code>", escape(before), escape(code)));
        rest = after;
    }
    (html + &escape(rest)).replace(" %", "\u{a0}%").replace(" ns", "\u{a0}ns")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::markup::well_formed;
    use crate::plot::{Axis, LineChart, Series};

    const HOSTILE: &str = "`<img src=x onerror=alert(1)>`\"'</style></section>&amp;`\u{0}";

    fn full(text: &str) -> Report {
        let chart = LineChart::new(text, Axis::linear(text), Axis::log(text)).series(Series::curve(text, [(1.0, 2.0)]));
        let mut table = Table::new(text).text(text).number(text).note(text);
        table.push([text, text]);
        let section = Section::new(text).heading(text).paragraph(text).table(table);
        let section = section.figure(Drawing::new(chart.svg(), text)).figure(Drawing::new(chart.svg(), text));
        let summary = Drawing::new(chart.svg(), text).named("summary");
        let report = Report::new(text).subtitle(text).verdict(text, text).summary(summary).finding(text);
        report.section(section).method(text).fact(text, text)
    }

    #[test]
    fn hostile_text_is_inert() {
        let html = full(HOSTILE).html();
        well_formed(&html).expect("the page nests");
        assert!(!html.contains("<img") && !html.contains('\u{0}'), "hostile text got through");
        assert_eq!(html.matches("</style>").count(), 1, "the style ends once");
        assert!(html.contains("<code>&lt;img src=x onerror=alert(1)&gt;</code>"), "code is set as code");
    }

    #[test]
    fn a_page_stands_alone_and_ids_are_unique() {
        let html = full("text").html();
        for outside in ["http-equiv", "<script", "<link", "src=", "url(", "@import"] {
            assert!(!html.contains(outside), "{outside} reaches outside");
        }
        let links = html.replace("http://www.w3.org/2000/svg", "");
        assert!(!links.contains("http"), "no addresses");
        let mut ids: Vec<&str> = html.split(" id=\"").skip(1).filter_map(|t| t.split('"').next()).collect();
        let all = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), all, "an id stands twice");
        let anchors = html.split("href=\"#").skip(1).filter_map(|t| t.split('"').next());
        assert!(anchors.clone().count() == 2 && anchors.into_iter().all(|a| ids.contains(&a)), "links have ends");
    }

    #[test]
    fn figures_are_written_by_number_and_name() {
        let dir = tempfile::TempDir::new().expect("a folder");
        let mut report = full("text");
        let chart = LineChart::new("t", Axis::linear("x"), Axis::linear("y"));
        report = report.section(Section::new("s").figure(Drawing::new(chart.svg(), "c").named("last")));
        report.write(dir.path(), "example").expect("written");
        let read = |name: &str| fs::read(dir.path().join(name)).expect("there");
        assert_eq!(read("report.html"), report.html().as_bytes());
        assert_eq!(read("figures/example-04-last.svg"), chart.svg().as_bytes());
        let has_png = cfg!(feature = "png");
        assert!(!has_png || read("figures/example-02.png").starts_with(b"\x89PNG"), "a PNG beside each SVG");
        let files = fs::read_dir(dir.path().join("figures")).expect("a folder").count();
        assert_eq!(files, if has_png { 8 } else { 4 });
    }

    #[test]
    fn an_empty_report_is_a_page() {
        well_formed(&Report::new("").html()).expect("the page nests");
    }
}
