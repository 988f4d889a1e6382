//! SVG sheet that charts draw on. Coordinates are written in tenths of a pixel, as whole numbers; consecutive marks of one
//! style become one path.

use super::palette::{Color, Dash, Marker};
use crate::markup::escape;

/// Units of the drawing per pixel.
const FINE: f64 = 10.0;

/// Where a text hangs from its point.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Hang {
    Left,
    Center,
    Right,
}

/// How a text is set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Type {
    pub(crate) size: f64,
    pub(crate) hang: Hang,
    pub(crate) bold: bool,
    /// Reads from the bottom to the top.
    pub(crate) upright: bool,
    pub(crate) color: Color,
}

impl Type {
    pub(crate) const fn new(size: f64, hang: Hang) -> Self {
        Self { size, hang, bold: false, upright: false, color: super::palette::INK }
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pen {
    pub(crate) color: Color,
    pub(crate) width: f64,
    pub(crate) alpha: f64,
}

impl Pen {
    pub(crate) const fn new(color: Color, width: f64) -> Self {
        Self { color, width, alpha: 1.0 }
    }

    pub(crate) const fn faded(self, alpha: f64) -> Self {
        Self { alpha, ..self }
    }

    fn style(self) -> String {
        let Self { color, width, alpha } = self;
        format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"{}\"{}", fine(width), opacity(alpha))
    }
}

/// A place on the sheet, pixels from its top left.
pub(crate) type Place = (f64, f64);

/// The drawing so far, and the path that is being gathered: its style and its data.
#[derive(Default)]
pub(crate) struct Canvas {
    svg: String,
    style: String,
    path: String,
}

#[expect(clippy::cast_possible_truncation, reason = "sheets are far smaller than 2^31 and `as` saturates")]
fn fine(pixels: f64) -> i32 {
    (pixels * FINE).round() as i32
}

fn opacity(alpha: f64) -> String {
    if alpha < 1.0 { format!(" opacity=\"{alpha}\"") } else { String::new() }
}

fn path_data(points: &[Place]) -> String {
    let points: Vec<String> = points.iter().map(|(x, y)| format!("{},{}", fine(*x), fine(*y))).collect();
    format!("M{}", points.join(" "))
}

/// An SVG of `width` by `height` pixels with an accessible name and description, drawn by `paint`.
///
/// It has no ids at all, so that any number of them can stand in one page.
pub(crate) fn sheet(
    (width, height): (f64, f64),
    title: &str,
    description: &str,
    paint: impl FnOnce(&mut Canvas),
) -> String {
    let (title, description, right, bottom) = (escape(title), escape(description), fine(width), fine(height));
    let head = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{title}\" width=\"{width:.0}\" \
         height=\"{height:.0}\" viewBox=\"0 0 {right} {bottom}\" font-family=\"sans-serif\" stroke-linejoin=\"round\">\n\
         <title>{title}</title>\n<desc>{description}</desc>\n",
    );
    let mut canvas = Canvas { svg: head, ..Canvas::default() };
    canvas.block((0.0, 0.0), (width, height), super::palette::PAPER, 1.0);
    paint(&mut canvas);
    canvas.flush();
    canvas.svg + "</svg>\n"
}

impl Canvas {
    /// Adds to the path of this style.
    fn add(&mut self, style: String, data: &str) {
        if style != self.style {
            self.flush();
            self.style = style;
        }
        self.path.push_str(data);
    }

    fn flush(&mut self) {
        if !self.path.is_empty() {
            self.svg.push_str(&format!("<path {} d=\"{}\"/>\n", self.style, self.path));
        }
        self.path.clear();
    }

    pub(crate) fn line(&mut self, points: &[Place], pen: Pen, dash: Dash) {
        if points.len() < 2 {
            return;
        }
        let pattern: Vec<String> = dash.pattern().iter().map(|length| fine(*length).to_string()).collect();
        let dashes =
            if pattern.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", pattern.join(" ")) };
        // Crossing lines that let paper through would not darken each other within one path.
        if pen.alpha < 1.0 {
            self.flush();
        }
        self.add(pen.style() + &dashes, &path_data(points));
    }

    pub(crate) fn polygon(&mut self, points: &[Place], color: Color, alpha: f64) {
        if points.len() > 2 {
            self.add(format!("fill=\"{color}\"{}", opacity(alpha)), &(path_data(points) + "z"));
        }
    }

    pub(crate) fn block(&mut self, (x0, y0): Place, (x1, y1): Place, color: Color, alpha: f64) {
        let (left, right) = (fine(x0.min(x1)), fine(x0.max(x1)));
        let (top, bottom) = (fine(y0.min(y1)), fine(y0.max(y1)));
        let (width, height) = (right - left, bottom - top);
        if width > 0 || height > 0 {
            let data = format!("M{left} {top}h{width}v{height}h-{width}z");
            self.add(format!("fill=\"{color}\"{}", opacity(alpha)), &data);
        }
    }

    pub(crate) fn frame(&mut self, (x0, y0): Place, (x1, y1): Place, pen: Pen) {
        self.line(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], pen, Dash::Solid);
    }

    pub(crate) fn dot(&mut self, (x, y): Place, radius: f64, color: Color, alpha: f64) {
        // A line of no length with round ends is a disc.
        let width = fine(2.0 * radius);
        let style = format!("stroke=\"{color}\" stroke-width=\"{width}\" stroke-linecap=\"round\"{}", opacity(alpha));
        self.add(style, &format!("M{} {}h0", fine(x), fine(y)));
    }

    pub(crate) fn ring(&mut self, (x, y): Place, radius: f64, pen: Pen) {
        let (x, y, r) = (fine(x), fine(y), fine(radius));
        self.add(pen.style(), &format!("M{} {y}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 -{} 0z", x - r, 2 * r, 2 * r));
    }

    pub(crate) fn marker(&mut self, (x, y): Place, marker: Marker, size: f64, color: Color) {
        let corners: &[Place] = match marker {
            Marker::Circle => return self.dot((x, y), size, color, 1.0),
            Marker::Square => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
            Marker::Triangle => &[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
            Marker::Diamond => &[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
            Marker::Inverted => &[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)],
            Marker::Cross => &[(-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (1.0, -1.0)],
        };
        let corners: Vec<Place> = corners.iter().map(|(dx, dy)| (x + dx * size, y + dy * size)).collect();
        if marker == Marker::Cross {
            for stroke in corners.chunks(2) {
                self.line(stroke, Pen::new(color, size * 0.55), Dash::Solid);
            }
        } else {
            self.polygon(&corners, color, 1.0);
        }
    }

    /// A text whose middle height is at `place`.
    pub(crate) fn text(&mut self, text: &str, (x, y): Place, set: Type) {
        self.flush();
        let anchor = match set.hang {
            Hang::Left => "",
            Hang::Center => " text-anchor=\"middle\"",
            Hang::Right => " text-anchor=\"end\"",
        };
        // From the middle of the letters to their base line.
        let drop = 0.35 * set.size;
        let (x, y) = if set.upright { (fine(x + drop), fine(y)) } else { (fine(x), fine(y + drop)) };
        let turn = if set.upright { format!(" transform=\"rotate(270, {x}, {y})\"") } else { String::new() };
        let weight = if set.bold { " font-weight=\"bold\"" } else { "" };
        self.svg.push_str(&format!(
            "<text x=\"{x}\" y=\"{y}\"{anchor} font-size=\"{}\"{weight} fill=\"{}\"{turn}>{}</text>\n",
            fine(set.size),
            set.color,
            escape(text)
        ));
    }
}

/// Width of a text in pixels, as an estimate a little on the safe side.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    let wide = |c: char| match c {
        'i' | 'j' | 'l' | 'I' | '|' | '.' | ',' | ':' | ';' | '\'' | ' ' | '(' | ')' => 0.36,
        'm' | 'w' | 'M' | 'W' => 0.9,
        _ if c.is_uppercase() => 0.7,
        _ => 0.6,
    };
    text.chars().map(wide).sum::<f64>() * size
}

/// `text` in lines no wider than `width` pixels, as far as words allow.
pub(crate) fn wrap(text: &str, width: f64, size: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if text_width(line, size) + text_width(word, size) + 0.36 * size <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
