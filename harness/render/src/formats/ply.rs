//! PLY, the Stanford triangle format: tables of numbers under a header of text, as text or binary
//! in either byte order.
//!
//! Own code, because `ply-rs-bw` reads no number such as `.5`, `1.` or `nan`, no header with a comment
//! that is not UTF-8 and no empty line, all of which occur in files in use, and names no byte that it
//! rejects.

use super::bytes::Bytes;
use super::text::{Lines, excerpt, without_mark};
use super::{Problem, Wrong};

/// Type of a number in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

const TYPES: &str =
    "the type of a property must be char, uchar, short, ushort, int, uint, float or double";

impl Number {
    fn of(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Converts bytes, the lowest first, to the number.
    fn value(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Self::I8 => f64::from(i8::from_le_bytes([a])),
            Self::U8 => f64::from(a),
            Self::I16 => f64::from(i16::from_le_bytes([a, b])),
            Self::U16 => f64::from(u16::from_le_bytes([a, b])),
            Self::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::F64 => f64::from_le_bytes(bytes),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Text,
    Little,
    Big,
}

const FORMATS: &str = "the format must be ascii, binary_little_endian or binary_big_endian";

impl Encoding {
    fn of(word: &str) -> Option<Self> {
        Some(match word {
            "ascii" => Self::Text,
            "binary_little_endian" => Self::Little,
            "binary_big_endian" => Self::Big,
            _ => return None,
        })
    }
}

/// Column of a table, of numbers or of lists.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    /// Type of the counts of a column of lists.
    count: Option<Number>,
    number: Number,
}

impl Property {
    /// Parses a column from the words behind `property`. An error states the rule that they break.
    fn of(words: &[&str]) -> Result<Self, &'static str> {
        let (count, number, name) = match words {
            ["list", count, number, name] => (Some(Number::of(count).ok_or(TYPES)?), number, name),
            [number, name] => (None, number, name),
            _ => {
                return Err(
                    "a property must have a type and a name, or `list`, two types and a name",
                );
            }
        };
        Ok(Self {
            name: (*name).to_owned(),
            count,
            number: Number::of(number).ok_or(TYPES)?,
        })
    }

    pub(super) fn is_list(&self) -> bool {
        self.count.is_some()
    }
}

/// Table of rows with the same columns.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Parses a table from the words behind `element`.
    fn of(words: &[&str]) -> Option<Self> {
        let [name, count] = words else { return None };
        Some(Self {
            name: (*name).to_owned(),
            count: count.parse().ok()?,
            properties: Vec::new(),
        })
    }

    /// Returns the index of the first column that has one of these names, and whose rows are lists or not.
    pub(super) fn column(&self, names: &[&str], lists: bool) -> Option<usize> {
        let places = names.iter().map(|name| {
            let mut properties = self.properties.iter();
            properties.position(|own| own.name.eq_ignore_ascii_case(name) && own.is_list() == lists)
        });
        places.flatten().next()
    }
}

/// PLY file whose header is read.
#[derive(Clone, Debug)]
pub(super) struct Ply<'a> {
    bytes: Bytes<'a>,
    encoding: Encoding,
    pub(super) elements: Vec<Element>,
    body: u64,
}

/// Row of a table: for each column its number, or the numbers of its list.
#[derive(Debug, Default)]
pub(super) struct Row {
    pub(super) offset: u64,
    pub(super) columns: Vec<Vec<f64>>,
}

impl Row {
    pub(super) fn number(&self, column: usize) -> f64 {
        self.columns[column].first().copied().unwrap_or(f64::NAN)
    }

    /// Converts the number of a vertex, of `limit` vertices, to an index.
    pub(super) fn index(&self, value: f64, limit: u64) -> Result<u32, Wrong> {
        let index = whole(value).filter(|index| u64::from(*index) < limit);
        index.ok_or_else(|| {
            let problem =
                format!("numbers of vertices must be whole and below {limit}, got {value}");
            (self.offset, Problem::Text(problem))
        })
    }

    /// Converts the number of parts of a strand to an integer.
    pub(super) fn count(&self, value: f64) -> Result<u32, Wrong> {
        whole(value).ok_or_else(|| {
            let problem =
                format!("the count of a strand must be whole and below 2^32, got {value}");
            (self.offset, Problem::Text(problem))
        })
    }
}

/// Converts a number to an integer, unless that changes its value.
fn whole(value: f64) -> Option<u32> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "compared with the number"
    )]
    let integer = value as u32;
    (f64::from(integer) == value).then_some(integer)
}

pub(super) fn fits(bytes: Bytes<'_>) -> bool {
    [&b"ply\n"[..], b"ply\r", b"ply ", b"ply\t"]
        .iter()
        .any(|start| without_mark(bytes).starts_with(start))
}

impl<'a> Ply<'a> {
    /// Reads the header of a file.
    pub(super) fn new(bytes: Bytes<'a>) -> Result<Self, Wrong> {
        let mut lines = Lines::new(bytes);
        let (mut encoding, mut elements) = (None, Vec::<Element>::new());
        if !fits(bytes) {
            let problem = "must begin with a line \"ply\"".to_owned();
            return Err((0, Problem::Text(problem)));
        }
        lines.next();
        loop {
            let Some((offset, line)) = lines.next() else {
                let problem = "the header must end with a line \"end_header\"".to_owned();
                return Err((bytes.len(), Problem::Text(problem)));
            };
            let line = String::from_utf8_lossy(line);
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            let wrong = |problem: &str| {
                let problem = format!("{problem}, got {}", excerpt(&line));
                (offset, Problem::Text(problem))
            };
            match words[..] {
                [] | ["comment" | "obj_info", ..] => {}
                ["end_header"] => break,
                ["format", word, ..] => {
                    encoding = Some(Encoding::of(word).ok_or_else(|| wrong(FORMATS))?)
                }
                ["element", ref rest @ ..] => {
                    let element = Element::of(rest);
                    elements.push(
                        element.ok_or_else(|| wrong("an element must have a name and a count"))?,
                    );
                }
                ["property", ref rest @ ..] => {
                    let property = Property::of(rest).map_err(wrong)?;
                    let element = elements.last_mut();
                    let element =
                        element.ok_or_else(|| wrong("a property must be below an element"))?;
                    element.properties.push(property);
                }
                _ => {
                    return Err(wrong(
                        "a line of the header must begin with a keyword of PLY",
                    ));
                }
            }
        }
        let problem = "the header must have a line \"format\"".to_owned();
        let ply = Self {
            bytes,
            encoding: encoding.ok_or((0, Problem::Text(problem)))?,
            elements,
            body: lines.at,
        };
        ply.check_counts()?;
        Ok(ply)
    }

    /// Rejects tables that take more bytes than there are, before memory is taken for their rows.
    fn check_counts(&self) -> Result<(), Wrong> {
        let left = self.bytes.len() - self.body;
        for Element {
            name,
            count,
            properties,
        } in &self.elements
        {
            let least = properties.iter().map(|property| match self.encoding {
                Encoding::Text => 2,
                _ => property.count.unwrap_or(property.number).size() as u64,
            });
            // The last line of text may have no end.
            if count.saturating_mul(least.sum()) > left + 1 {
                let problem = format!(
                    "the {count} rows of `{name}` must fit in what follows the header, got {left} bytes"
                );
                return Err((self.body, Problem::Text(problem)));
            }
        }
        Ok(())
    }

    /// Visits all rows of all tables, and returns where the last row ends.
    pub(super) fn rows(
        &self,
        mut visit: impl FnMut(&Element, &Row) -> Result<(), Wrong>,
    ) -> Result<u64, Wrong> {
        let mut source = Source {
            bytes: self.bytes,
            encoding: self.encoding,
            at: self.body,
            line: Vec::new().into_iter(),
        };
        let mut row = Row::default();
        // Rows without columns take no bytes.
        for element in self
            .elements
            .iter()
            .filter(|one| !one.properties.is_empty())
        {
            row.columns = vec![Vec::new(); element.properties.len()];
            for number in 0..element.count {
                source.row(element, &mut row).map_err(|(offset, what)| {
                    let Element { name, count, .. } = element;
                    let problem = format!("row {number} of the {count} of `{name}` {what}");
                    (offset, Problem::Text(problem))
                })?;
                visit(element, &row)?;
            }
        }
        let behind = usize::try_from(source.at).unwrap_or(usize::MAX);
        let rest = self.bytes.0.get(behind..).unwrap_or_default();
        let blank = self.encoding == Encoding::Text && rest.iter().all(u8::is_ascii_whitespace);
        Ok(if blank { self.bytes.len() } else { source.at })
    }
}

/// Numbers of the tables, read from an offset on.
struct Source<'a> {
    bytes: Bytes<'a>,
    encoding: Encoding,
    at: u64,
    /// Unread words of a line of text.
    line: std::vec::IntoIter<&'a [u8]>,
}

impl Source<'_> {
    /// Reads a row. An error states what is wrong with the row.
    fn row(&mut self, element: &Element, row: &mut Row) -> Result<(), (u64, String)> {
        if self.encoding == Encoding::Text {
            let bytes = self.bytes;
            let mut lines = Lines { bytes, at: self.at };
            let is_row = |line: &[u8]| line.iter().any(|byte| !byte.is_ascii_whitespace());
            let Some((offset, line)) = lines.find(|(_, line)| is_row(line)) else {
                return Err((bytes.len(), "is missing".to_owned()));
            };
            (self.at, row.offset) = (lines.at, offset);
            let words = line
                .split(u8::is_ascii_whitespace)
                .filter(|word| !word.is_empty());
            self.line = words.collect::<Vec<_>>().into_iter();
        } else {
            row.offset = self.at;
        }
        for (column, property) in row.columns.iter_mut().zip(&element.properties) {
            column.clear();
            let length = match property.count {
                None => 1.0,
                Some(number) => self.number(number, row.offset)?,
            };
            // The length must be whole, and no larger than the bytes that are left.
            let left = self.bytes.len() - row.offset;
            if !(0.0..=left as f64).contains(&length) || length.fract() != 0.0 {
                return Err((row.offset, format!("has a list of {length} numbers")));
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "whole, and below the file's length"
            )]
            for _ in 0..length as u64 {
                column.push(self.number(property.number, row.offset)?);
            }
        }
        match self.line.len() {
            0 => Ok(()),
            more => Err((row.offset, format!("has {more} numbers too many"))),
        }
    }

    fn number(&mut self, number: Number, row: u64) -> Result<f64, (u64, String)> {
        if self.encoding == Encoding::Text {
            let word = self
                .line
                .next()
                .ok_or_else(|| (row, "is too short".to_owned()))?;
            let word = String::from_utf8_lossy(word);
            return word
                .parse()
                .map_err(|_| (row, format!("must have numbers, got {}", excerpt(&word))));
        }
        let start = usize::try_from(self.at).unwrap_or(usize::MAX);
        let size = number.size();
        let Some(own) = self.bytes.0.get(start..).and_then(|rest| rest.get(..size)) else {
            return Err((self.bytes.len(), "is cut off".to_owned()));
        };
        let mut bytes = [0; 8];
        bytes[..size].copy_from_slice(own);
        if self.encoding == Encoding::Big {
            bytes[..size].reverse();
        }
        self.at += size as u64;
        Ok(number.value(bytes))
    }
}
