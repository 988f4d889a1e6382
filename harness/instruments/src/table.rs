//! Tables with the same content in the terminal and in the report.

pub mod number;

use crate::markup;
use crate::wrap::wrapped;
use comfy_table::{CellAlignment, ContentArrangement, LineStyle, TableStyle};
use unicode_width::UnicodeWidthStr as _;

/// Table whose cells are text, formatted once (see [`number`]), so that its forms cannot differ.
///
/// ```
/// use hairis_instruments::table::{Table, number};
/// let rows = [("uniform", 0.706, 0.002), ("published", 0.209, 0.001)];
/// let table = Table::new("Variance at θ_o = 0°")
///     .texts(["sampler"])
///     .numbers(["V (relative variance)"])
///     .rows(rows.map(|(sampler, v, error)| [sampler.to_owned(), number::with_error(v, error)]))
///     .note("2²⁰ samples each.");
/// assert!(table.to_html().contains("<td class=\"number\">0.2090 ± 0.0010</td>"));
/// assert!(table.to_text(None).contains("0.2090 ± 0.0010"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct Table {
    title: String,
    /// Names of the columns, and whether the columns hold numbers, which are aligned to the right.
    headers: Vec<(String, bool)>,
    rows: Vec<Vec<String>>,
    notes: Vec<String>,
}

impl Table {
    /// Makes a table that has a title, and no columns or rows yet.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..Self::default()
        }
    }

    /// Adds columns of text with these headers, aligned to the left.
    pub fn texts<S: Into<String>>(mut self, headers: impl IntoIterator<Item = S>) -> Self {
        self.headers
            .extend(headers.into_iter().map(|header| (header.into(), false)));
        self
    }

    /// Adds columns of numbers, aligned to the right, whose headers should contain the unit.
    pub fn numbers<S: Into<String>>(mut self, headers: impl IntoIterator<Item = S>) -> Self {
        self.headers
            .extend(headers.into_iter().map(|header| (header.into(), true)));
        self
    }

    /// Adds a row. Missing cells are empty, and cells beyond the last column are left out.
    pub fn push<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        let mut row: Vec<String> = cells.into_iter().map(Into::into).collect();
        row.resize(self.headers.len(), String::new());
        self.rows.push(row);
    }

    /// Adds rows of cells, each as [`push`](Self::push) does.
    pub fn rows<R: IntoIterator<Item = String>>(
        mut self,
        rows: impl IntoIterator<Item = R>,
    ) -> Self {
        rows.into_iter().for_each(|row| self.push(row));
        self
    }

    /// Adds a note as a line below the table.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// Returns the title of the table.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Returns true if the table has no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Formats the table as lines of text that are no longer than `width` columns, or as long as necessary without a width.
    ///
    /// A table that is too wide is broken into parts, each of which begins with the columns of text that name the rows. Cells are broken
    /// only if a single column does not fit beside those.
    #[must_use]
    pub fn to_text(&self, width: Option<u16>) -> String {
        let most = width.map_or(usize::MAX, usize::from);
        let line = |text: &String| {
            let text = markup::clean(text.trim_end());
            let text = if width.is_some() {
                wrapped(&text, most, "")
            } else {
                text
            };
            text + "\n"
        };
        let mut text = line(&self.title);
        for part in self.parts(most) {
            text += &self.part(&part, width);
        }
        text + &self.notes.iter().map(line).collect::<String>()
    }

    /// Returns the columns of each part of the table that is at most `most` columns of the terminal wide.
    fn parts(&self, most: usize) -> Vec<Vec<usize>> {
        // A cell has a space on either side, and one in front of the next column.
        let widths: Vec<usize> = (0..self.headers.len())
            .map(|column| {
                let cells = self.rows.iter().map(|row| &row[column]);
                let all = cells.chain([&self.headers[column].0]);
                all.map(|text| text.width()).max().unwrap_or(0) + 3
            })
            .collect();
        let taken = |part: &[usize]| part.iter().map(|column| widths[*column]).sum::<usize>();
        let keys: Vec<usize> = (0..self.headers.len())
            .take_while(|column| !self.headers[*column].1)
            .collect();
        let mut parts = vec![keys.clone()];
        for (column, width) in widths.iter().enumerate().skip(keys.len()) {
            let last = parts.len() - 1;
            let is_full = taken(&parts[last]) + width > most.saturating_add(1);
            if is_full && parts[last].len() > keys.len() {
                parts.push([&keys[..], &[column]].concat());
            } else {
                parts[last].push(column);
            }
        }
        parts
    }

    /// Formats some of the columns.
    fn part(&self, columns: &[usize], width: Option<u16>) -> String {
        let line = || LineStyle::none().fill('─').junction('─');
        let mut table = comfy_table::Table::new();
        table.load_style(
            TableStyle::new()
                .header_separator(line())
                .bottom_border(line()),
        );
        table.set_content_arrangement(ContentArrangement::Dynamic);
        if let Some(width) = width {
            table.set_width(width);
        }
        table.set_header(
            columns
                .iter()
                .map(|column| markup::clean(&self.headers[*column].0)),
        );
        table.add_rows(
            self.rows
                .iter()
                .map(|row| columns.iter().map(|column| markup::clean(&row[*column]))),
        );
        for (shown, column) in table.column_iter_mut().zip(columns) {
            shown.set_cell_alignment(if self.headers[*column].1 {
                CellAlignment::Right
            } else {
                CellAlignment::Left
            });
        }
        let text = table.to_string();
        text.lines()
            .map(|line| format!("{}\n", line.trim_end()))
            .collect()
    }

    /// Formats the table as HTML, in a box of its own that scrolls sideways.
    #[must_use]
    pub fn to_html(&self) -> String {
        let class = |is_number: bool| if is_number { " class=\"number\"" } else { "" };
        let (mut head, mut rows) = (String::new(), String::new());
        for (header, is_number) in &self.headers {
            head += &format!(
                "<th scope=\"col\"{}>{}</th>",
                class(*is_number),
                markup::escape(header)
            );
        }
        for row in &self.rows {
            rows += "<tr>";
            for (place, (cell, (_, is_number))) in row.iter().zip(&self.headers).enumerate() {
                let (tag, scope) = if place == 0 {
                    ("th", " scope=\"row\"")
                } else {
                    ("td", "")
                };
                rows += &format!(
                    "<{tag}{scope}{}>{}</{tag}>",
                    class(*is_number),
                    markup::escape(cell)
                );
            }
            rows += "</tr>\n";
        }
        let note = |note: &String| format!("<p class=\"note\">{}</p>\n", markup::escape(note));
        let (title, notes) = (
            markup::escape(&self.title),
            self.notes.iter().map(note).collect::<String>(),
        );
        format!(
            "<div class=\"table-box\" role=\"region\" tabindex=\"0\" aria-label=\"{title}\"><table>\n\
             <thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n{notes}"
        )
    }
}
