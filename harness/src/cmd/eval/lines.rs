//! Lines of a stream, with a bound on their length.

use hairis_materials::json::refusal;
use std::io::{self, BufRead, BufReader, Read};

/// Longest line that is accepted, in bytes: a thousand times what a request needs.
const LONGEST: usize = 1 << 20;

/// Byte-order mark in UTF-8.
const MARK: &[u8] = "\u{feff}".as_bytes();

/// Reader of a stream, line by line, in one buffer.
pub(super) struct Lines<R> {
    input: BufReader<R>,
    line: Vec<u8>,
}

impl<R: Read> Lines<R> {
    pub(super) fn new(input: BufReader<R>) -> Self {
        Self {
            input,
            line: Vec::new(),
        }
    }

    /// Returns true if a whole line can be read without waiting for the input.
    pub(super) fn ready(&self) -> bool {
        self.input.buffer().contains(&b'\n')
    }

    /// Reads the next line without its line break, or the reason for rejecting it; `None` at the end of the input. The last line needs no
    /// line break.
    pub(super) fn next(&mut self) -> io::Result<Option<Result<&str, String>>> {
        self.line.clear();
        // One byte more than the longest line, for its line break.
        let read = self
            .input
            .by_ref()
            .take(LONGEST as u64 + 1)
            .read_until(b'\n', &mut self.line)?;
        if read == 0 {
            return Ok(None);
        }
        if self.line.last() == Some(&b'\n') {
            self.line.pop();
        } else if self.line.len() > LONGEST {
            self.input.skip_until(b'\n')?;
            return Ok(Some(Err(refusal(
                "line",
                format!("longer than {LONGEST} bytes"),
            ))));
        }
        // Files written by editors and shells of Windows begin with a mark. A line in the middle may have one too, where several files have
        // been joined.
        let line = self.line.strip_prefix(MARK).unwrap_or(&self.line);
        let text = core::str::from_utf8(line).map_err(|error| {
            refusal(
                "line",
                format!("not UTF-8 after byte {}", error.valid_up_to()),
            )
        });
        Ok(Some(text))
    }
}
