//! Escaping of text for HTML and SVG, and a check for tests that markup nests.

/// Escapes characters that have a meaning in markup, for element content and quoted attributes alike.
///
/// Control characters, which XML forbids even when escaped, are left out; tabs and line ends become spaces.
#[must_use]
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            _ => out.extend(printable(c)),
        }
    }
    out
}

/// Returns `text` without control characters, for writers that escape by themselves.
pub(crate) fn clean(text: &str) -> String {
    text.chars().filter_map(printable).collect()
}

fn printable(c: char) -> Option<char> {
    match c {
        '\t' | '\n' | '\r' => Some(' '),
        '\u{fffe}' | '\u{ffff}' => None,
        _ => (!c.is_control()).then_some(c),
    }
}

/// Checks that `markup` nests: that tags are closed in order, and that no angle bracket is stray. Void HTML elements may stay open. The
/// check is meant for tests of pages.
///
/// # Errors
///
/// Returns a description of the first fault.
pub fn well_formed(markup: &str) -> Result<(), String> {
    const VOID: [&str; 3] = ["meta", "br", "link"];
    let mut open: Vec<&str> = Vec::new();
    let mut rest = markup;
    while let Some(start) = rest.find('<') {
        let (text, tail) = rest.split_at(start);
        if text.contains('>') {
            return Err(format!("a stray '>' in {text:?}"));
        }
        let end = tail.find('>').ok_or("a tag without an end")?;
        let tag = &tail[1..end];
        rest = &tail[end + 1..];
        if tag.contains('<') || !tag.matches('"').count().is_multiple_of(2) {
            return Err(format!("a broken tag {tag:?}"));
        }
        let name = tag
            .trim_start_matches('/')
            .split([' ', '/', '\n'])
            .next()
            .unwrap_or_default();
        if tag.starts_with('!') || tag.ends_with('/') || VOID.contains(&name) {
            continue;
        }
        if !tag.starts_with('/') {
            open.push(name);
        } else if open.pop() != Some(name) {
            return Err(format!("</{name}> closes nothing"));
        }
    }
    if rest.contains('>') {
        return Err(format!("a stray '>' in {rest:?}"));
    }
    if open.is_empty() {
        Ok(())
    } else {
        Err(format!("left open: {open:?}"))
    }
}
