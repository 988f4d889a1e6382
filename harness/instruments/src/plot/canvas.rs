//! SVG sheet that charts draw on. Coordinates are written in tenths of a pixel, as whole numbers; consecutive marks of one style become
//! one path.

use super::palette::{Color, DASHES, FAINT_INK, INK, MARKERS, PAPER};
use crate::markup::escape;

/// Width of every sheet, in pixels: half of a wide page, and little more than a phone, so that letters stay readable on a phone.
pub(super) const WIDTH: f64 = 520.0;

/// Units of the drawing per pixel.
const FINE: f64 = 10.0;

/// Style in which a text is set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Type {
    pub(super) size: f64,
    /// Part of the text that lies at its place: `start`, `middle` or `end`.
    pub(super) anchor: &'static str,
    pub(super) bold: bool,
    /// Whether the text runs from the bottom to the top.
    pub(super) upright: bool,
    pub(super) color: Color,
}

/// Type of the names of axes and of the entries of legends.
pub(super) const LABEL: Type = Type {
    size: 15.5,
    anchor: "middle",
    bold: false,
    upright: false,
    color: INK,
};
/// Type of the labels of ticks, and of notes.
pub(super) const TICK: Type = Type {
    size: 14.0,
    color: FAINT_INK,
    ..LABEL
};
/// Type of the titles of panels.
pub(super) const HEADING: Type = Type {
    bold: true,
    ..LABEL
};
const TITLE: Type = Type {
    size: 17.0,
    ..HEADING
};

/// Style in which a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pen {
    pub(super) color: Color,
    pub(super) width: f64,
    /// Index of the pattern among the dashes.
    pub(super) dash: usize,
    pub(super) alpha: f64,
}

impl Pen {
    pub(super) const fn new(color: Color, width: f64) -> Self {
        Self {
            color,
            width,
            dash: 0,
            alpha: 1.0,
        }
    }
}

/// Pen of frames and ticks.
pub(super) const THIN: Pen = Pen::new(INK, 1.0);
/// Pen of grid lines, which let colours through.
pub(super) const GRID: Pen = Pen {
    alpha: 0.14,
    ..THIN
};

/// Place on the sheet, in pixels from its top left.
pub(super) type Place = (f64, f64);

/// Sheet with the drawing so far, and the path that is being gathered, with its style.
#[derive(Default)]
pub(super) struct Canvas {
    title: String,
    svg: String,
    style: String,
    path: String,
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "sheets are far smaller than 2^31 and `as` saturates"
)]
fn fine(pixels: f64) -> i32 {
    (pixels * FINE).round() as i32
}

fn path_data(points: &[Place]) -> String {
    let points: Vec<String> = points
        .iter()
        .map(|(x, y)| format!("{},{}", fine(*x), fine(*y)))
        .collect();
    format!("M{}", points.join(" "))
}

impl Canvas {
    /// Makes a sheet with its title, and returns it with the height below which the sheet is empty.
    pub(super) fn new(title: &str) -> (Self, f64) {
        let mut canvas = Self {
            title: escape(title),
            ..Self::default()
        };
        let bottom = canvas.lines(title, (0.5 * WIDTH, 20.0), WIDTH - 24.0, TITLE);
        (canvas, bottom)
    }

    /// Returns the SVG, cut off at `height`, with a description for readers who do not see the chart.
    ///
    /// The SVG has no ids at all, so that any number of charts can stand in one page.
    pub(super) fn finish(mut self, description: &str, height: f64) -> String {
        self.flush();
        let Self { title, svg, .. } = self;
        let (description, right, bottom) = (escape(description), fine(WIDTH), fine(height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" role=\"img\" aria-label=\"{title}\" width=\"{WIDTH}\" \
             height=\"{height:.0}\" viewBox=\"0 0 {right} {bottom}\" font-family=\"sans-serif\" \
             stroke-linejoin=\"round\">\n<title>{title}</title>\n<desc>{description}</desc>\n\
             <path fill=\"{PAPER}\" d=\"M0 0h{right}v{bottom}h-{right}z\"/>\n{svg}</svg>\n"
        )
    }

    /// Adds data to the path of this style, and ends the path of another style.
    fn add(&mut self, style: String, data: &str) {
        if style != self.style {
            self.flush();
            self.style = style;
        }
        self.path.push_str(data);
    }

    fn flush(&mut self) {
        if !self.path.is_empty() {
            self.svg
                .push_str(&format!("<path {} d=\"{}\"/>\n", self.style, self.path));
        }
        self.path.clear();
    }

    pub(super) fn line(
        &mut self,
        points: &[Place],
        Pen {
            color,
            width,
            dash,
            alpha,
        }: Pen,
    ) {
        if points.len() < 2 {
            return;
        }
        let (width, dashes) = (fine(width), DASHES[dash % DASHES.len()]);
        let style = format!(
            "fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" stroke-dasharray=\"{dashes}\" opacity=\"{alpha}\""
        );
        self.add(style, &path_data(points));
    }

    pub(super) fn block(&mut self, (x0, y0): Place, (x1, y1): Place, color: Color, alpha: f64) {
        let (left, top) = (fine(x0.min(x1)), fine(y0.min(y1)));
        let (width, height) = (fine(x0.max(x1)) - left, fine(y0.max(y1)) - top);
        self.add(
            format!("fill=\"{color}\" opacity=\"{alpha}\""),
            &format!("M{left} {top}h{width}v{height}h-{width}z"),
        );
    }

    pub(super) fn frame(&mut self, (x0, y0): Place, (x1, y1): Place, pen: Pen) {
        self.line(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], pen);
    }

    pub(super) fn dot(&mut self, (x, y): Place, radius: f64, color: Color, alpha: f64) {
        // A line of no length with round ends appears as a disc.
        let width = fine(2.0 * radius);
        let style = format!(
            "stroke=\"{color}\" stroke-width=\"{width}\" stroke-linecap=\"round\" opacity=\"{alpha}\""
        );
        self.add(style, &format!("M{} {}h0", fine(x), fine(y)));
    }

    /// Draws the marker of the series with number `index`.
    pub(super) fn marker(&mut self, (x, y): Place, index: usize, color: Color) {
        const SIZE: f64 = 4.2;
        let shape = MARKERS[index % MARKERS.len()];
        if shape.is_empty() {
            return self.dot((x, y), SIZE, color, 1.0);
        }
        let corners: Vec<Place> = shape
            .chunks_exact(2)
            .map(|at| (x + SIZE * at[0], y + SIZE * at[1]))
            .collect();
        self.add(format!("fill=\"{color}\""), &(path_data(&corners) + "z"));
    }

    /// Draws a text whose middle height is at a place.
    pub(super) fn text(&mut self, text: &str, (x, y): Place, set: Type) {
        self.flush();
        let Type {
            size,
            anchor,
            bold,
            upright,
            color,
        } = set;
        // From the middle of the letters to their base line.
        let drop = 0.35 * size;
        let (x, y) = if upright {
            (fine(x + drop), fine(y))
        } else {
            (fine(x), fine(y + drop))
        };
        let turn = if upright {
            format!(" transform=\"rotate(270, {x}, {y})\"")
        } else {
            String::new()
        };
        let weight = if bold { " font-weight=\"bold\"" } else { "" };
        let (size, text) = (fine(size), escape(text));
        self.svg.push_str(&format!(
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{size}\"{weight} fill=\"{color}\"{turn}>\
             {text}</text>\n"
        ));
    }

    /// Draws a text in lines no wider than `width` pixels, as far as words and hyphens allow. Returns the middle height of the line
    /// below.
    pub(super) fn lines(&mut self, text: &str, (x, mut y): Place, width: f64, set: Type) -> f64 {
        let mut line = String::new();
        for word in text.split_whitespace() {
            let mut space = if line.is_empty() { "" } else { " " };
            for part in word.split_inclusive('-') {
                let longer = format!("{line}{space}{part}");
                if !line.is_empty() && set.width(&longer) > width {
                    self.text(&line, (x, y), set);
                    y += 1.3 * set.size;
                    line = part.to_owned();
                } else {
                    line = longer;
                }
                space = "";
            }
        }
        self.text(&line, (x, y), set);
        y + 1.3 * set.size
    }
}

impl Type {
    /// Returns the width of a text in pixels, as an estimate a little on the safe side.
    pub(super) fn width(self, text: &str) -> f64 {
        let wide = |c: char| match c {
            'i' | 'j' | 'l' | 'I' | '|' | '.' | ',' | ':' | ';' | '\'' | ' ' | '(' | ')' => 0.36,
            'm' | 'w' | 'M' | 'W' => 0.9,
            _ if c.is_uppercase() => 0.7,
            _ => 0.6,
        };
        text.chars().map(wide).sum::<f64>() * self.size * if self.bold { 1.05 } else { 1.0 }
    }
}
