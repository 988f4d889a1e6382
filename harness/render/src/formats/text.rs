//! Lines of text files.

use super::bytes::Bytes;
use std::borrow::Cow;

/// Byte order mark, which some editors write before text in UTF-8.
const MARK: &[u8] = b"\xef\xbb\xbf";
/// Number of characters of a file that a message quotes.
const LONGEST_EXCERPT: usize = 60;

/// Returns the bytes of a file behind its byte order mark.
pub(super) fn without_mark(bytes: Bytes<'_>) -> &[u8] {
    bytes.0.strip_prefix(MARK).unwrap_or(bytes.0)
}

/// Lines and their offsets, from an offset on, without their ends: a line feed, a carriage return, or both.
pub(super) struct Lines<'a> {
    pub(super) bytes: Bytes<'a>,
    pub(super) at: u64,
}

impl<'a> Lines<'a> {
    /// Begins at the start of a file, behind a byte order mark.
    pub(super) fn new(bytes: Bytes<'a>) -> Self {
        let at = bytes.len() - without_mark(bytes).len() as u64;
        Self { bytes, at }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (u64, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let start = self.at;
        let rest = self.bytes.0.get(usize::try_from(start).ok()?..)?;
        if rest.is_empty() {
            return None;
        }
        let ends = |byte: &u8| matches!(byte, b'\n' | b'\r');
        let length = rest.iter().position(ends).unwrap_or(rest.len());
        let end = if rest[length..].starts_with(b"\r\n") {
            2
        } else {
            1
        };
        self.at = (start + (length + end) as u64).min(self.bytes.len());
        Some((start, &rest[..length]))
    }
}

/// Returns the part of a line before a comment, which begins with `#`. Bytes that are not UTF-8 are replaced, because comments and names
/// may be in any encoding.
pub(super) fn data(line: &[u8]) -> Cow<'_, str> {
    let data = line.split(|byte| *byte == b'#').next().unwrap_or_default();
    String::from_utf8_lossy(data)
}

/// Returns the beginning of a text, quoted.
pub(super) fn excerpt(text: &str) -> String {
    let text = text.trim();
    match text.char_indices().nth(LONGEST_EXCERPT) {
        Some((end, _)) => format!("{:?}...", &text[..end]),
        None => format!("{text:?}"),
    }
}
