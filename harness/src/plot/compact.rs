//! Makes the SVG of plotters a fifth as large: runs of equal marks become one path, and defaults are left out.

use core::fmt::Write as _;

/// The marks being gathered into one path: what they share, and the path so far.
#[derive(Default)]
struct Run {
    style: String,
    path: String,
}

/// Appends the lines of `body` to `out`. A line it does not know is copied, so a change in plotters' output costs size
/// and nothing else.
pub(super) fn append(out: &mut String, body: &str) {
    let mut run = Run::default();
    for line in body.lines() {
        let line = line.replace(" opacity=\"1\"", "");
        match shape(&line) {
            Some(next) if next.style == run.style => run.path.push_str(&next.path),
            Some(next) => {
                flush(out, &run);
                run = next;
            }
            None => {
                flush(out, &run);
                run = Run::default();
                out.push_str(&line);
                out.push('\n');
            }
        }
    }
    flush(out, &run);
}

fn flush(out: &mut String, run: &Run) {
    if !run.path.is_empty() {
        // Writing to a string does not fail.
        let _ = writeln!(out, "<path {} d=\"{}\"/>", run.style, run.path);
    }
}

/// The value of an attribute and the tag without it.
fn take<'a>(tag: &'a str, name: &str) -> Option<(&'a str, String)> {
    let start = tag.find(&format!(" {name}=\""))?;
    let value = start + name.len() + 3;
    let end = value + tag[value..].find('"')?;
    Some((&tag[value..end], format!("{}{}", &tag[..start], &tag[end + 1..])))
}

fn shape(line: &str) -> Option<Run> {
    let tag = line.strip_suffix("/>")?;
    let (name, _) = tag.strip_prefix('<')?.split_once(' ')?;
    let rest = tag.strip_prefix('<')?.strip_prefix(name)?;
    match name {
        "circle" => {
            let (x, rest) = take(rest, "cx")?;
            let (y, rest) = take(&rest, "cy")?;
            let (r, rest) = take(&rest, "r")?;
            let (fill, rest) = take(&rest, "fill")?;
            if fill == "none" {
                return None;
            }
            let (_, rest) = take(&rest, "stroke")?;
            let (_, rest) = take(&rest, "stroke-width")?;
            // A line of no length with round ends is a disc.
            let width = 2 * r.parse::<u32>().ok()?;
            let style = format!("stroke=\"{fill}\" stroke-width=\"{width}\" stroke-linecap=\"round\"{rest}");
            Some(Run { style, path: format!("M{x} {y}h0") })
        }
        "rect" => {
            let (x, rest) = take(rest, "x")?;
            let (y, rest) = take(&rest, "y")?;
            let (w, rest) = take(&rest, "width")?;
            let (h, rest) = take(&rest, "height")?;
            let rest = rest.replace(" stroke=\"none\"", "");
            Some(Run { style: rest.trim_start().to_owned(), path: format!("M{x} {y}h{w}v{h}h-{w}z") })
        }
        "polyline" => {
            let (points, rest) = take(rest, "points")?;
            // Parts that overlap would darken each other if they were apart and not if they were one path.
            if rest.contains("opacity") {
                return None;
            }
            let path = format!("M{}", points.trim_end());
            Some(Run { style: rest.trim().to_owned(), path })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn runs_become_one_path_and_strangers_stay() {
        let dot = |x: u32| {
            format!(
                "<circle cx=\"{x}\" cy=\"2\" r=\"3\" opacity=\"1\" fill=\"#000\" stroke=\"none\" stroke-width=\"1\"/>\n"
            )
        };
        let mut out = String::new();
        super::append(&mut out, &format!("{}{}<other a=\"1\"/>\n{}", dot(1), dot(5), dot(7)));
        let path = |d| format!("<path stroke=\"#000\" stroke-width=\"6\" stroke-linecap=\"round\" d=\"{d}\"/>\n");
        assert_eq!(out, format!("{}<other a=\"1\"/>\n{}", path("M1 2h0M5 2h0"), path("M7 2h0")), "two runs, one apart");
    }
}
