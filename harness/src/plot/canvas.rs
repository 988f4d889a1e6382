//! The sheet that charts draw on: plotters' SVG backend at ten times the size, so that its whole numbers are tenths of
//! a pixel, and what makes an SVG small and accessible.

use super::palette::{Dash, Marker};
use crate::markup;
use core::fmt::Write as _;
use plotters::prelude::{DrawingBackend, RGBColor, SVGBackend, ShapeStyle};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontDesc, FontFamily, FontStyle, FontTransform, TextStyle};

/// Units of the backend a pixel.
const FINE: f64 = 10.0;
/// What plotters divides font sizes by.
const PLOTTERS_EM: f64 = 1.24;

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
    pub(crate) color: RGBColor,
}

impl Type {
    pub(crate) const fn new(size: f64, hang: Hang) -> Self {
        Self { size, hang, bold: false, upright: false, color: super::palette::INK }
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pen {
    pub(crate) color: RGBColor,
    pub(crate) width: f64,
    pub(crate) alpha: f64,
}

impl Pen {
    pub(crate) const fn new(color: RGBColor, width: f64) -> Self {
        Self { color, width, alpha: 1.0 }
    }

    pub(crate) const fn faded(self, alpha: f64) -> Self {
        Self { alpha, ..self }
    }

    fn shape(self, filled: bool) -> ShapeStyle {
        ShapeStyle { color: self.color.mix(self.alpha), filled, stroke_width: fine(self.width).unsigned_abs() }
    }
}

/// A place on the sheet, pixels from its top left.
pub(crate) type Place = (f64, f64);

pub(crate) struct Canvas<'a> {
    backend: SVGBackend<'a>,
}

#[expect(clippy::cast_possible_truncation, reason = "sheets are far smaller than 2^31 and `as` saturates")]
fn fine(pixels: f64) -> i32 {
    (pixels * FINE).round() as i32
}

fn at((x, y): Place) -> (i32, i32) {
    (fine(x), fine(y))
}

/// An SVG of `width` by `height` pixels with an accessible name and description, drawn by `paint`.
///
/// It has no ids at all, so that any number of them can stand in one page.
pub(crate) fn sheet(
    (width, height): (f64, f64),
    title: &str,
    description: &str,
    paint: impl FnOnce(&mut Canvas<'_>),
) -> String {
    let mut raw = String::new();
    let size = (fine(width).unsigned_abs(), fine(height).unsigned_abs());
    let mut canvas = Canvas { backend: SVGBackend::with_string(&mut raw, size) };
    canvas.block((0.0, 0.0), (width, height), super::palette::PAPER, 1.0);
    paint(&mut canvas);
    drop(canvas); // ends the document
    let body = raw.split_once('>').map_or("", |(_, body)| body).trim_start();
    let (title, description) = (markup::escape(title), markup::escape(description));
    let mut svg = String::new();
    // Writing to a string does not fail.
    let _ = write!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{title}\" width=\"{width:.0}\" \
         height=\"{height:.0}\" viewBox=\"0 0 {} {}\" stroke-linejoin=\"round\">\n<title>{title}</title>\n\
         <desc>{description}</desc>\n",
        size.0, size.1
    );
    super::compact::append(&mut svg, body);
    svg
}

impl Canvas<'_> {
    // The backend writes to a string, which does not fail; its results are dropped below.

    pub(crate) fn line(&mut self, points: &[Place], pen: Pen, dash: Dash) {
        match dash.pattern() {
            [] => self.stroke(points, pen),
            pattern => dashes(points, pattern, |part| self.stroke(part, pen)),
        }
    }

    fn stroke(&mut self, points: &[Place], pen: Pen) {
        if points.len() > 1 {
            let _ = self.backend.draw_path(points.iter().copied().map(at), &pen.shape(false));
        }
    }

    pub(crate) fn polygon(&mut self, points: &[Place], color: RGBColor, alpha: f64) {
        if points.len() > 2 {
            let _ = self.backend.fill_polygon(points.iter().copied().map(at), &color.mix(alpha));
        }
    }

    pub(crate) fn block(&mut self, (x0, y0): Place, (x1, y1): Place, color: RGBColor, alpha: f64) {
        let (low, high) = (at((x0.min(x1), y0.min(y1))), at((x0.max(x1), y0.max(y1))));
        if low != high {
            let _ = self.backend.draw_rect(low, high, &color.mix(alpha), true);
        }
    }

    pub(crate) fn frame(&mut self, (x0, y0): Place, (x1, y1): Place, pen: Pen) {
        self.stroke(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], pen);
    }

    pub(crate) fn dot(&mut self, center: Place, radius: f64, color: RGBColor, alpha: f64) {
        let _ = self.backend.draw_circle(at(center), fine(radius).unsigned_abs(), &color.mix(alpha), true);
    }

    pub(crate) fn ring(&mut self, center: Place, radius: f64, pen: Pen) {
        let _ = self.backend.draw_circle(at(center), fine(radius).unsigned_abs(), &pen.shape(false), false);
    }

    pub(crate) fn marker(&mut self, (x, y): Place, marker: Marker, size: f64, color: RGBColor) {
        let corner = |dx: f64, dy: f64| (x + dx * size, y + dy * size);
        let filled = match marker {
            Marker::Circle => return self.dot((x, y), size, color, 1.0),
            Marker::Square => vec![corner(-0.9, -0.9), corner(0.9, -0.9), corner(0.9, 0.9), corner(-0.9, 0.9)],
            Marker::Triangle => vec![corner(0.0, -1.2), corner(1.1, 0.8), corner(-1.1, 0.8)],
            Marker::Diamond => vec![corner(0.0, -1.3), corner(1.3, 0.0), corner(0.0, 1.3), corner(-1.3, 0.0)],
            Marker::Inverted => vec![corner(0.0, 1.2), corner(1.1, -0.8), corner(-1.1, -0.8)],
            Marker::Cross => {
                let pen = Pen::new(color, size * 0.55);
                self.stroke(&[corner(-1.0, -1.0), corner(1.0, 1.0)], pen);
                return self.stroke(&[corner(-1.0, 1.0), corner(1.0, -1.0)], pen);
            }
        };
        self.polygon(&filled, color, 1.0);
    }

    /// A text whose middle height is at `place`.
    pub(crate) fn text(&mut self, text: &str, place: Place, set: Type) {
        let style = if set.bold { FontStyle::Bold } else { FontStyle::Normal };
        let font = FontDesc::new(FontFamily::SansSerif, set.size * FINE * PLOTTERS_EM, style);
        let turn = if set.upright { FontTransform::Rotate270 } else { FontTransform::None };
        let hang = match set.hang {
            Hang::Left => HPos::Left,
            Hang::Center => HPos::Center,
            Hang::Right => HPos::Right,
        };
        // The em of 0.35 to the base line is set here: `ex`, which plotters uses, is not known to every renderer.
        let drop = 0.11 * set.size;
        let place = if set.upright { (place.0 + drop, place.1) } else { (place.0, place.1 + drop) };
        let style = TextStyle::from(font).color(&set.color).transform(turn).pos(Pos::new(hang, VPos::Center));
        let _ = self.backend.draw_text(&markup::clean(text), &style, at(place));
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

/// Cuts a path into the parts that `pattern` (pixels on, off, on, off ...) draws.
fn dashes(points: &[Place], pattern: &[f64], mut draw: impl FnMut(&[Place])) {
    let mut phase = 0;
    let mut left = pattern[0];
    let mut part: Vec<Place> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
        let length = (x1 - x0).hypot(y1 - y0);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let here = (x0 + (x1 - x0) * done / length, y0 + (y1 - y0) * done / length);
            if phase % 2 == 0 {
                part.push(here);
                draw(&part);
            }
            part = vec![here];
            phase = (phase + 1) % pattern.len();
            left = pattern[phase];
        }
        left -= length - done;
        if phase % 2 == 0 {
            part.push((x1, y1));
        }
    }
    if phase % 2 == 0 {
        draw(&part);
    }
}
