//! Tables that read the same in the terminal and in the report.

pub mod number;

use crate::markup;
use comfy_table::{CellAlignment, ContentArrangement, LineStyle, TableStyle};
use core::iter;

/// A table: cells are text, formatted once (see [`number`]), so that its forms cannot differ.
///
/// ```
/// use hairis_harness::table::{Table, number};
/// let mut table = Table::new("Variance at θ_o = 0°").text("sampler").number("V (relative variance)");
/// table.push(["uniform".into(), number::with_error(0.706, 0.002)]);
/// table.push(["published".into(), number::with_error(0.209, 0.001)]);
/// let table = table.note("2²⁰ samples each.");
/// assert!(table.to_html().contains("<td class=\"number\">0.2090 ± 0.0010</td>"));
/// assert!(table.to_plain().contains("0.2090 ± 0.0010"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    title: String,
    /// The names of the columns, and whether they hold numbers, which stand to the right.
    headers: Vec<(String, bool)>,
    rows: Vec<Vec<String>>,
    notes: Vec<String>,
}

impl Table {
    /// A table without columns.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), ..Self::default() }
    }

    /// Adds a column of text.
    #[must_use]
    pub fn text(self, header: impl Into<String>) -> Self {
        self.texts([header])
    }

    /// Adds a column of numbers. Put the unit in the header.
    #[must_use]
    pub fn number(self, header: impl Into<String>) -> Self {
        self.numbers([header])
    }

    /// Adds columns of text.
    #[must_use]
    pub fn texts<S: Into<String>>(mut self, headers: impl IntoIterator<Item = S>) -> Self {
        self.headers.extend(headers.into_iter().map(|header| (header.into(), false)));
        self
    }

    /// Adds columns of numbers.
    #[must_use]
    pub fn numbers<S: Into<String>>(mut self, headers: impl IntoIterator<Item = S>) -> Self {
        self.headers.extend(headers.into_iter().map(|header| (header.into(), true)));
        self
    }

    /// Adds a row; cells that it lacks are empty, and those beyond the last column are left out.
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
        let is_tty = comfy_table::Table::new().is_tty();
        self.layout(is_tty, None)
    }

    /// With every row on one line, however long.
    #[must_use]
    pub fn to_plain(&self) -> String {
        self.layout(false, None)
    }

    /// Lines of text; if `wrap`, with cells broken so that none is longer than `width` characters, or the terminal is wide.
    fn layout(&self, wrap: bool, width: Option<u16>) -> String {
        let line = || LineStyle::none().fill('─').junction('─');
        let mut table = comfy_table::Table::new();
        table.load_style(TableStyle::new().header_separator(line()).bottom_border(line()));
        table.set_content_arrangement(if wrap { ContentArrangement::Dynamic } else { ContentArrangement::Disabled });
        if let Some(width) = width {
            table.set_width(width);
        }
        table.set_header(self.headers.iter().map(|(header, _)| markup::clean(header)));
        for row in &self.rows {
            table.add_row(row.iter().map(|cell| markup::clean(cell)));
        }
        for (column, (_, is_number)) in table.column_iter_mut().zip(&self.headers) {
            column.set_cell_alignment(if *is_number { CellAlignment::Right } else { CellAlignment::Left });
        }
        let body = table.to_string();
        let title = markup::clean(&self.title);
        let notes: Vec<String> = self.notes.iter().map(|note| markup::clean(note)).collect();
        let lines = [title.as_str()].into_iter().chain(body.lines()).chain(notes.iter().map(String::as_str));
        lines.map(|line| format!("{}\n", line.trim_end())).collect()
    }

    /// As HTML, in a box of its own that scrolls sideways.
    #[must_use]
    pub fn to_html(&self) -> String {
        let cell = |tag: &str, (text, (_, is_number)): (&String, &(String, bool))| {
            let class = if *is_number { " class=\"number\"" } else { "" };
            let name = &tag[..2];
            format!("<{tag}{class}>{}</{name}>", markup::escape(text))
        };
        let head: String = self.headers.iter().map(|header| cell("th scope=\"col\"", (&header.0, header))).collect();
        let row = |row: &Vec<String>| {
            let tags = ["th scope=\"row\""].into_iter().chain(iter::repeat("td"));
            let cells: String = tags.zip(row.iter().zip(&self.headers)).map(|(tag, of)| cell(tag, of)).collect();
            format!("<tr>{cells}</tr>\n")
        };
        let rows: String = self.rows.iter().map(row).collect();
        let note = |note: &String| format!("<p class=\"note\">{}</p>\n", markup::escape(note));
        let (title, notes) = (markup::escape(&self.title), self.notes.iter().map(note).collect::<String>());
        format!(
            "<div class=\"table-box\" role=\"region\" tabindex=\"0\" aria-label=\"{title}\"><table>\n\
             <thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n{notes}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Table {
        let mut table = Table::new("Speed <of> \"hair\"").text("kernel").number("time (ns)").number("ratio");
        table.push(["eval & sample", "8.31 ± 0.02", "13.4×"]);
        table.push(["short"]);
        table.push(["long", "1", "2", "dropped"]);
        table
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
        let text = wide.layout(true, Some(60));
        assert!(text.lines().all(|l| l.chars().count() <= 60), "{text}");
        assert!(wide.to_plain().lines().any(|l| l.chars().count() > 200), "nothing is broken off a terminal");
        assert!(!Table::new("a\u{1b}[31m").to_plain().contains('\u{1b}'), "no escape sequences get through");
    }
}
