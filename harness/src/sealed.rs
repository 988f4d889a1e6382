//! Lines of files that grow, each a JSON object that ends in a checksum of the rest of the line.

use serde::Serialize;
use std::io;

/// Text before and after the checksum of a line.
const CHECKSUM: [&str; 2] = [",\"checksum\":\"", "\"}"];

/// Returns a hash of bytes (FNV-1a). A line's hash is over the bytes before its checksum.
#[must_use]
pub fn checksum(line: &[u8]) -> String {
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:016x}", line.iter().fold(0xcbf2_9ce4_8422_2325, step))
}

/// Returns the line of an object, with its checksum and line break.
///
/// # Errors
///
/// Returns an error if the object cannot be written as JSON.
pub fn line(content: &impl Serialize) -> io::Result<Vec<u8>> {
    let mut line = serde_json::to_vec(content)?;
    // The closing brace goes behind the checksum.
    line.pop();
    let sum = checksum(&line);
    let [before, after] = CHECKSUM;
    for text in [before, &sum, after, "\n"] {
        line.extend_from_slice(text.as_bytes());
    }
    Ok(line)
}

/// Returns the object in a line, and whether its checksum is right; `None` if it has none.
pub fn unseal(line: &[u8]) -> Option<(Vec<u8>, bool)> {
    let [before, after] = CHECKSUM.map(str::as_bytes);
    let (rest, sum) = line.strip_suffix(after)?.split_last_chunk::<16>()?;
    let content = rest.strip_suffix(before)?;
    let is_right = checksum(content).as_bytes() == sum;
    Some(([content, b"}"].concat(), is_right))
}
