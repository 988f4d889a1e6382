//! Reports, each of which is one self-contained HTML page without scripts.

use crate::error::Error;
use crate::files::{whole, writable};
use crate::markup::{self, escape};
#[cfg(feature = "png")]
use crate::plot::png;
use crate::table::Table;
use crate::wrap::wrapped;
use rayon::prelude::*;
use std::fs;
use std::io::Write;
use std::path::Path;
use unicode_width::UnicodeWidthStr as _;

const STYLE: &str = include_str!("report/style.css");
/// Name of the page's file.
const PAGE: &str = "report.html";
/// Name of the folder of the figures.
const FIGURES: &str = "figures";

/// Page of a report: verdicts and one plot, then findings, then sections of plots with their tables folded away.
///
/// Texts are plain: everything in them is escaped, and text between `` ` `` marks is set as code. Names that others choose go through
/// [`literal`].
///
/// ```
/// use hairis_instruments::report::{Report, Section};
/// let html = Report {
///     title: "Comparison".to_owned(),
///     verdicts: vec![["Speed".to_owned(), "Eight lanes are `7.1×` as fast as one.".to_owned()]],
///     sections: vec![Section::new("Machine").facts(&[["CPU", "Example <9000>"]])],
///     ..Report::default()
/// }
/// .html();
/// assert!(html.contains("<code>7.1×</code>") && html.contains("Example &lt;9000&gt;"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Title of the page.
    pub title: String,
    /// Line under the title, such as when and where the report was made.
    pub subtitle: String,
    /// Use cases with a sentence each, which come first on the page.
    pub verdicts: Vec<[String; 2]>,
    /// Plot beside the verdicts.
    pub summary: Option<Drawing>,
    /// Sentences that follow the verdicts. If a sentence begins with a question, the question stands out.
    pub findings: Vec<String>,
    /// Sections in the order of the page, the last about the method.
    pub sections: Vec<Section>,
}

/// Part of a report, with a heading of its own and an entry in the table of contents.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct Section {
    title: String,
    blocks: Vec<Block>,
}

#[derive(Clone, Debug, PartialEq)]
enum Block {
    Html(String),
    Figure(Drawing),
}

/// Drawing with its caption, and the name under which its files are written.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Name of the files without the ending: letters, digits and hyphens, or empty for no name.
    pub name: String,
    /// Complete `<svg>` element, such as those of [`crate::plot`], which goes into the page as it is.
    pub svg: String,
    /// Caption below the drawing.
    pub caption: String,
}

impl Drawing {
    /// Makes a drawing with its name and its caption.
    #[must_use]
    pub fn new(name: impl Into<String>, svg: String, caption: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            svg,
            caption: caption.into(),
        }
    }
}

impl Section {
    /// Makes a section that has a title and no content yet.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            blocks: Vec::new(),
        }
    }

    /// Adds a heading within the section, one level below that of the section.
    pub fn heading(self, text: &str) -> Self {
        self.html(format!("<h3>{}</h3>\n", inline(text)))
    }

    /// Adds a paragraph of plain text, in which text between `` ` `` marks is set as code.
    pub fn paragraph(self, text: impl AsRef<str>) -> Self {
        self.html(format!("<p>{}</p>\n", inline(text.as_ref())))
    }

    /// Adds tables, each folded away behind its title.
    pub fn tables(self, tables: impl IntoIterator<Item = Table>) -> Self {
        tables.into_iter().fold(self, |section, table| {
            let title = escape(table.title());
            section.html(format!(
                "<details><summary>{title}</summary>\n{}</details>\n",
                table.to_html()
            ))
        })
    }

    /// Adds a list of names with their values, such as the CPU, the seed and the commit.
    pub fn facts<S: AsRef<str>>(self, facts: &[[S; 2]]) -> Self {
        self.html(definitions(facts))
    }

    /// Adds figures, which are numbered throughout the report.
    pub fn figures(mut self, figures: impl IntoIterator<Item = Drawing>) -> Self {
        self.blocks.extend(figures.into_iter().map(Block::Figure));
        self
    }

    fn html(mut self, html: String) -> Self {
        self.blocks.push(Block::Html(html));
        self
    }
}

impl Report {
    /// Returns the head of the page as lines of text for terminals: title, verdicts, and where the files are, in at most `width` columns.
    #[must_use]
    pub fn headline(&self, width: usize, files: &str) -> String {
        let plain = |text: &str| markup::clean(&pieces(text).concat());
        let subtitle = wrapped(&plain(&self.subtitle), width, "");
        let files = ["Report".to_owned(), files.to_owned()];
        let verdicts = self
            .verdicts
            .iter()
            .map(|verdict| verdict.each_ref().map(|text| plain(text)));
        let all: Vec<[String; 2]> = verdicts.chain([files]).collect();
        // The names stand in a column of their own where that leaves room for sentences.
        let names = all.iter().map(|[name, _]| name.width()).max().unwrap_or(0) + 2;
        let (names, gap) = if 3 * names + 10 <= width {
            (names, "")
        } else {
            (2, ": ")
        };
        let indent = " ".repeat(names);
        let mut text = format!(
            "{}\n{subtitle}\n\n",
            wrapped(&plain(&self.title), width, "")
        );
        for [name, sentence] in all {
            let pad = " ".repeat(names.saturating_sub(name.width()));
            let pad = if gap.is_empty() { &pad } else { gap };
            text += &wrapped(&format!("{name}{pad}{sentence}"), width, &indent);
            text.push('\n');
        }
        text
    }

    /// Returns the page as HTML, with its style and its figures included.
    #[must_use]
    pub fn html(&self) -> String {
        let mut last = 0;
        let mut figure = |Drawing { svg, caption, .. }: &Drawing| {
            last += 1;
            let caption = inline(caption);
            format!(
                "<figure id=\"figure-{last}\">\n<div class=\"plot\">\n{svg}</div>\n\
                 <figcaption><strong>Figure {last}.</strong> {caption}</figcaption>\n</figure>\n"
            )
        };
        let summary = self.summary.as_ref().map(&mut figure).unwrap_or_default();
        let mut verdicts = String::new();
        if !self.verdicts.is_empty() || self.summary.is_some() {
            verdicts = format!(
                "<section id=\"verdicts\" class=\"verdicts\">\n{}{summary}</section>\n",
                definitions(&self.verdicts)
            );
        }
        let mut findings: String = self
            .findings
            .iter()
            .map(|text| format!("<li>{}</li>\n", answer(text)))
            .collect();
        if !findings.is_empty() {
            findings = format!(
                "<section id=\"findings\">\n<h2>In figures</h2>\n<ul>\n{findings}</ul>\n</section>\n"
            );
        }
        let (mut contents, mut sections) = (String::new(), String::new());
        for (i, section) in (1..).zip(&self.sections) {
            let title = inline(&section.title);
            contents += &format!("<li><a href=\"#section-{i}\">{title}</a></li>\n");
            sections += &format!("<section id=\"section-{i}\">\n<h2>{title}</h2>\n");
            for block in &section.blocks {
                sections += &match block {
                    Block::Html(html) => html.clone(),
                    Block::Figure(drawing) => figure(drawing),
                };
            }
            sections += "</section>\n";
        }
        let (title, subtitle) = (escape(&self.title), inline(&self.subtitle));
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n\
             </head>\n<body>\n<header>\n<h1>{title}</h1>\n<p class=\"subtitle\">{subtitle}</p>\n</header>\n<main>\n\
             {verdicts}<nav aria-label=\"Contents\">\n<ol>\n{contents}</ol>\n</nav>\n{findings}{sections}</main>\n</body>\n</html>\n"
        )
    }

    /// Returns the figures in the order of their numbers.
    fn figures(&self) -> impl Iterator<Item = &Drawing> {
        let blocks = self.sections.iter().flat_map(|section| &section.blocks);
        let figures = blocks.filter_map(|block| {
            if let Block::Figure(figure) = block {
                Some(figure)
            } else {
                None
            }
        });
        self.summary.iter().chain(figures)
    }

    /// Checks that [`write`](Self::write) can write into `dir`, before the work for the report begins. Makes the folder `figures`.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Output`] if the page, the folder or a figure cannot be written.
    pub fn writable(dir: &Path) -> Result<(), Error> {
        let folder = dir.join(FIGURES);
        fs::create_dir_all(&folder).map_err(Error::output(&folder))?;
        writable(&dir.join(PAGE))?;
        writable(&folder.join("figure.svg"))
    }

    /// Writes the page to `report.html` in `dir`, and every figure to `figures/NAME-NUMBER-....svg`, with feature `png` also to `.png`.
    /// Each file is written as a whole or not at all.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Output`] if a file cannot be written.
    pub fn write(&self, dir: &Path, name: &str) -> Result<(), Error> {
        whole(&dir.join(PAGE), |out| out.write_all(self.html().as_bytes()))?;
        let folder = dir.join(FIGURES);
        fs::create_dir_all(&folder).map_err(Error::output(&folder))?;
        let figures: Vec<(usize, &Drawing)> = (1..).zip(self.figures()).collect();
        figures.par_iter().try_for_each(|(number, figure)| {
            let stem = format!("{name}-{number:02}-{}", figure.name);
            let stem = stem.trim_end_matches('-');
            whole(&folder.join(format!("{stem}.svg")), |out| {
                out.write_all(figure.svg.as_bytes())
            })?;
            #[cfg(feature = "png")]
            whole(&folder.join(format!("{stem}.png")), |out| {
                out.write_all(&png(&figure.svg)?)
            })?;
            Ok(())
        })
    }
}

fn definitions<S: AsRef<str>>(pairs: &[[S; 2]]) -> String {
    let item = |[name, text]: &[S; 2]| {
        format!(
            "<dt>{}</dt><dd>{}</dd>\n",
            inline(name.as_ref()),
            inline(text.as_ref())
        )
    };
    format!(
        "<dl>\n{}</dl>\n",
        pairs.iter().map(item).collect::<String>()
    )
}

/// Returns a finding as HTML, in which a question at the beginning stands out.
fn answer(text: &str) -> String {
    match text.split_once("? ") {
        Some((question, answer)) if !question.contains(['.', '`']) => {
            format!("<strong>{}?</strong> {}", inline(question), inline(answer))
        }
        _ => inline(text),
    }
}

/// Returns a text, such as the name of a file, as every text of a report takes it: marks in it are not those of code.
#[must_use]
pub fn literal(text: &str) -> String {
    text.replace('\\', "\\\\").replace('`', "\\`")
}

/// Returns text and code in turns, which `` ` `` marks divide. A mark behind a backslash is itself: see [`literal`].
fn pieces(text: &str) -> Vec<String> {
    let mut pieces = vec![String::new()];
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let piece = pieces.last_mut().expect("at least one");
        match c {
            '`' => pieces.push(String::new()),
            '\\' => piece.push(rest.next_if(|c| ['`', '\\'].contains(c)).unwrap_or(c)),
            _ => piece.push(c),
        }
    }
    // A mark without its pair is text.
    if pieces.len().is_multiple_of(2)
        && let Some(last) = pieces.pop()
        && let Some(piece) = pieces.last_mut()
    {
        *piece += &format!("`{last}");
    }
    pieces
}

/// Escapes a text and sets parts between pairs of `` ` `` as code; numbers stay on one line with their unit.
fn inline(text: &str) -> String {
    let set = |(place, piece): (usize, &String)| {
        let piece = escape(piece);
        if place.is_multiple_of(2) {
            piece
        } else {
            format!("<code>{piece}</code>")
        }
    };
    let html: String = pieces(text).iter().enumerate().map(set).collect();
    html.replace(" %", "\u{a0}%").replace(" ns", "\u{a0}ns")
}
