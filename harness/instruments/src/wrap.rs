//! Text broken into lines.

/// Breaks a text into lines of at most `width` columns between words. Lines after the first begin with `indent`.
#[must_use]
pub fn wrapped(text: &str, width: usize, indent: &str) -> String {
    let options = textwrap::Options::new(width).subsequent_indent(indent);
    textwrap::fill(text, options)
}
