//! Tests of `plot::png`.

use hairis_instruments::plot::png;
use resvg::tiny_skia::Pixmap;

/// Returns the number of dark pixels of a line of text.
fn ink(text: &str, weight: &str) -> usize {
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"30\"><rect width=\"60\" height=\"30\" \
         fill=\"#fff\"/><text x=\"5\" y=\"20\" font-family=\"sans-serif\" font-weight=\"{weight}\">{text}</text></svg>"
    );
    let picture = png(&svg).expect("a drawing");
    Pixmap::decode_png(&picture)
        .expect("a PNG")
        .pixels()
        .iter()
        .filter(|pixel| pixel.red() < 128)
        .count()
}

#[test]
fn every_character_of_the_charts_is_in_the_font() {
    let (nothing, unknown) = (ink("", "normal"), ink("\u{4e00}", "normal"));
    assert_eq!(nothing, 0);
    for c in "aZ09αβγθφσκₒᵢ_⁰¹²³⁴⁵⁶⁷⁸⁹⁻×±−°·≈∞√µ–—’→".chars()
    {
        for weight in ["normal", "bold"] {
            let ink = ink(&c.to_string(), weight);
            assert!(ink > 0 && ink != unknown, "{c} is not drawn");
        }
    }
    assert!(ink("m", "bold") > ink("m", "normal"), "bold is bold");
}

#[test]
fn what_is_no_drawing_is_refused() {
    assert!(png("").is_err() && png("<svg").is_err());
}
