//! Tables that read the same in the terminal and in the report.

pub mod number;

use crate::markup;
use comfy_table::{CellAlignment, ContentArrangement, LineStyle, TableStyle};
use core::fmt;

/// Where a column's cells stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Text.
    #[default]
    Left,
    /// Numbers.
    Right,
}

/// A table: cells are text, formatted once (see [`number`]), so that its forms cannot differ.
///
/// ```
/// use hairis_harness::table::{Table, number};
/// let table = Table::new("Variance at θ_o = 0°")
///     .text("sampler")
///     .number("V (relative variance)")
///     .row(["uniform".into(), number::with_error(0.706, 0.002)])
///     .row(["published".into(), number::with_error(0.209, 0.001)])
///     .note("2²⁰ samples each.");
/// assert!(table.to_html().contains("<td class=\"number\">0.2090 ± 0.0010</td>"));
/// assert!(table.to_plain().contains("0.2090 ± 0.0010"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    title: String,
    headers: Vec<(String, Align)>,
    rows: Vec<Vec<String>>,
    notes: Vec<String>,
}

impl Table {
    /// A table without columns.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), ..Self::default() }
    }

    /// Adds a column.
    #[must_use]
    pub fn column(mut self, header: impl Into<String>, align: Align) -> Self {
        self.headers.push((header.into(), align));
        self
    }

    /// Adds a column of text.
    #[must_use]
    pub fn text(self, header: impl Into<String>) -> Self {
        self.column(header, Align::Left)
    }

    /// Adds a column of numbers. Put the unit in the header.
    #[must_use]
    pub fn number(self, header: impl Into<String>) -> Self {
        self.column(header, Align::Right)
    }

    /// Adds columns of text.
    #[must_use]
    pub fn texts<S: Into<String>>(self, headers: impl IntoIterator<Item = S>) -> Self {
        headers.into_iter().fold(self, Self::text)
    }

    /// Adds columns of numbers.
    #[must_use]
    pub fn numbers<S: Into<String>>(self, headers: impl IntoIterator<Item = S>) -> Self {
        headers.into_iter().fold(self, Self::number)
    }

    /// Adds a row; cells that it lacks are empty, and those beyond the last column are left out.
    #[must_use]
    pub fn row<S: Into<String>>(mut self, cells: impl IntoIterator<Item = S>) -> Self {
        self.push(cells);
        self
    }

    /// As [`row`](Self::row), in a loop.
    pub fn push<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        let mut row: Vec<String> = cells.into_iter().map(Into::into).collect();
        row.resize(self.headers.len(), String::new());
        self.rows.push(row);
    }

    /// Adds a line below the table.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// The title.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Whether it has no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// For standard output: as wide as the terminal allows if it is one, else as [`to_plain`](Self::to_plain).
    #[must_use]
    pub fn to_terminal(&self) -> String {
        let tty = self.comfy().is_tty();
        if tty { self.layout(None, true) } else { self.to_plain() }
    }

    /// With every row on one line, however long.
    #[must_use]
    pub fn to_plain(&self) -> String {
        self.layout(None, false)
    }

    /// With cells broken so that no line is longer than `width` characters.
    #[must_use]
    pub fn to_width(&self, width: u16) -> String {
        self.layout(Some(width), true)
    }

    fn comfy(&self) -> comfy_table::Table {
        let mut table = comfy_table::Table::new();
        let line = || LineStyle::none().fill('─').junction('─');
        table.load_style(TableStyle::new().header_separator(line()).bottom_border(line()));
        table
    }

    fn layout(&self, width: Option<u16>, wrap: bool) -> String {
        let mut table = self.comfy();
        table.set_content_arrangement(if wrap { ContentArrangement::Dynamic } else { ContentArrangement::Disabled });
        if let Some(width) = width {
            table.set_width(width);
        }
        let cells = |row: &[String]| row.iter().map(|cell| markup::clean(cell)).collect::<Vec<_>>();
        table.set_header(self.headers.iter().map(|(header, _)| markup::clean(header)));
        for row in &self.rows {
            table.add_row(cells(row));
        }
        for (column, (_, align)) in table.column_iter_mut().zip(&self.headers) {
            column.set_cell_alignment(match align {
                Align::Left => CellAlignment::Left,
                Align::Right => CellAlignment::Right,
            });
        }
        let mut text = format!("{}\n", markup::clean(&self.title));
        for line in table.to_string().lines() {
            text.push_str(line.trim_end());
            text.push('\n');
        }
        for note in &self.notes {
            text.push_str(&markup::clean(note));
            text.push('\n');
        }
        text
    }

    /// As HTML, in a box of its own that scrolls sideways.
    #[must_use]
    pub fn to_html(&self) -> String {
        let class = |align: Align| if align == Align::Right { " class=\"number\"" } else { "" };
        let mut html = String::from("<div class=\"table-box\" role=\"region\" tabindex=\"0\" aria-label=\"");
        html.push_str(&markup::escape(&self.title));
        html.push_str("\"><table>\n");
        html.push_str("<thead><tr>");
        for (header, align) in &self.headers {
            html.push_str(&format!("<th scope=\"col\"{}>{}</th>", class(*align), markup::escape(header)));
        }
        html.push_str("</tr></thead>\n<tbody>\n");
        for row in &self.rows {
            html.push_str("<tr>");
            for (i, (cell, (_, align))) in row.iter().zip(&self.headers).enumerate() {
                let (open, close) = if i == 0 { ("th scope=\"row\"", "th") } else { ("td", "td") };
                html.push_str(&format!("<{open}{}>{}</{close}>", class(*align), markup::escape(cell)));
            }
            html.push_str("</tr>\n");
        }
        html.push_str("</tbody></table></div>\n");
        for note in &self.notes {
            html.push_str(&format!("<p class=\"note\">{}</p>\n", markup::escape(note)));
        }
        html
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.to_plain())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Table {
        let table = Table::new("Speed <of> \"hair\"").text("kernel").number("time (ns)").number("ratio");
        table.row(["eval & sample", "8.31 ± 0.02", "13.4×"]).row(["short"]).row(["long", "1", "2", "dropped"])
    }

    #[test]
    fn the_terminal_and_the_report_show_the_same_cells() {
        let (plain, html) = (example().to_plain(), example().to_html());
        for cell in ["8.31 ± 0.02", "13.4×", "time (ns)", "short"] {
            assert!(plain.contains(cell) && html.contains(cell), "{cell} in {plain} and {html}");
        }
        assert!(!plain.contains("dropped") && !html.contains("dropped"), "a cell beyond the columns");
        assert_eq!(html.matches("<t").count() - html.matches("<tr").count(), 3 + 3 + 9, "every row is full: {html}");
    }

    #[test]
    fn html_is_escaped_and_nests() {
        let html = example().note("</table>").to_html();
        markup::well_formed(&html).expect("the table nests");
        assert!(html.contains("Speed &lt;of&gt; &quot;hair&quot;") && html.contains("eval &amp; sample"), "{html}");
    }

    #[test]
    fn columns_line_up_and_lines_keep_to_the_width() {
        let plain = example().to_plain();
        let ends: Vec<usize> =
            plain.lines().filter(|l| l.contains("13.4×") || l.contains("ratio")).map(|l| l.chars().count()).collect();
        assert_eq!(ends.len(), 2, "{plain}");
        assert_eq!(ends[0], ends[1], "numbers end where their header does: {plain}");
        let mut wide = Table::new("t").text("a").text("b");
        wide.push(["word ".repeat(30), "other ".repeat(30)]);
        let text = wide.to_width(60);
        assert!(text.lines().all(|l| l.chars().count() <= 60), "{text}");
        assert!(wide.to_plain().lines().any(|l| l.chars().count() > 200), "nothing is broken off a terminal");
        assert!(!Table::new("a\u{1b}[31m").to_plain().contains('\u{1b}'), "no escape sequences get through");
    }
}
