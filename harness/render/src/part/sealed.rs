//! Bytes that end in a digest of the rest, and numbers read from them.

use hairis_instruments::sequence::mix;

/// Returns a number that differs where bytes differ, except by chance.
pub(crate) fn digest(bytes: &[u8]) -> u64 {
    bytes.chunks(8).fold(bytes.len() as u64, |hash, chunk| {
        mix(hash
            ^ chunk
                .iter()
                .fold(0, |word, byte| word << 8 | u64::from(*byte)))
    })
}

/// Appends a digest of all bytes to them.
pub(crate) fn seal(bytes: &mut Vec<u8>) {
    let check = digest(bytes);
    bytes.extend(check.to_le_bytes());
}

/// Returns the bytes before the digest, or `None` if the digest is wrong.
pub(crate) fn unseal(bytes: &[u8]) -> Option<&[u8]> {
    let (content, check) = bytes.split_last_chunk()?;
    (digest(content) == u64::from_le_bytes(*check)).then_some(content)
}

/// Reader of numbers from the front of bytes.
pub(crate) struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*first)
    }

    pub(crate) fn number(&mut self) -> Option<u32> {
        self.bytes().map(u32::from_le_bytes)
    }

    pub(crate) fn double(&mut self) -> Option<f64> {
        self.bytes().map(f64::from_le_bytes)
    }
}
