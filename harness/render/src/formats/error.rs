//! Errors of files of hair and of heads, which state why a file was rejected.

use crate::geometry::GeometryError;
use core::fmt;
use std::io;
use std::path::PathBuf;

/// Error of a file of hair or of a head that was rejected. Its one line has the name, the byte that
/// shows the problem, and the numbers that disagree.
#[derive(Debug)]
pub struct ImportError {
    /// Path of the file.
    pub path: PathBuf,
    /// Offset of the byte that shows the problem, counted from 0, if there is one.
    pub offset: Option<u64>,
    /// Problem with the file.
    pub problem: Problem,
}

/// Problem with a file of hair or of a head, with the numbers that disagree.
#[derive(Debug)]
#[non_exhaustive]
pub enum Problem {
    /// Neither the content nor the name of the file is of a known format.
    Unknown,
    /// The file cannot be read.
    Read(io::Error),
    /// The file is longer than any that is read.
    TooLong {
        /// Largest number of bytes.
        most: u64,
    },
    /// An option is not finite, not above 0, or out of all reason.
    Option {
        /// Name of the option.
        name: &'static str,
        /// Value given.
        value: f32,
    },
    /// The file is shorter than its header.
    Header {
        /// Bytes of a header.
        needed: u64,
        /// Bytes of the file.
        got: u64,
    },
    /// The file does not begin as files of its format do.
    Signature {
        /// Beginning of files of the format.
        expected: &'static str,
        /// The first four bytes.
        got: [u8; 4],
    },
    /// The file has no points, or arrays that the format does not know.
    Flags {
        /// Requirement on the flags.
        expected: &'static str,
        /// Flags of the file.
        got: u32,
    },
    /// A number of things is out of its range.
    Count {
        /// Quantity and its range.
        expected: &'static str,
        /// Number in the file.
        got: u32,
    },
    /// The number of points that the strands need differs from the number in the file.
    Points {
        /// Segments of all strands, and one more per strand.
        needed: u64,
        /// Points according to the header.
        got: u64,
    },
    /// The arrays take more than the file may be long.
    TooLarge {
        /// Bytes of the arrays.
        bytes: u64,
        /// Largest number of bytes.
        most: u64,
    },
    /// The file is shorter than the needed part of what its header describes.
    Length {
        /// Length according to the header.
        expected: u64,
        /// Length of the file.
        got: u64,
    },
    /// A section begins inside the header.
    Section {
        /// Bytes of the header.
        header: u64,
        /// Offset at which the section begins.
        got: u64,
    },
    /// A coordinate is not finite, or too far away.
    Coordinate {
        /// Value in the file.
        value: f32,
    },
    /// A thickness is negative or not finite.
    Thickness {
        /// Value in the file.
        value: f32,
    },
    /// Thickness is 0 everywhere.
    NoRadius,
    /// The vertices of a strand do not fit in the file.
    Strand {
        /// Number of the strand, from 0.
        strand: u32,
        /// Offset at which its vertices would end.
        end: u64,
        /// Bytes of the file.
        got: u64,
    },
    /// Text, or a header of text, is not as its format has it.
    Text(String),
    /// A strand is too large once it is scaled.
    Geometry {
        /// Number of the strand in the file, from 0.
        strand: usize,
        /// Problem with the strand.
        error: GeometryError,
    },
    /// The scene is so wide that no thickness of its strands would show in it.
    Scattered {
        /// Diagonal of the scene, in centimetres.
        size: f32,
        /// Median length of the strands, in centimetres.
        length: f32,
        /// Number, in the file, of the strand that is farthest from the others, from 0.
        strand: usize,
    },
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => f.write_str(
                "must be hair: .hair (cyHair, MonoHair), .tfx (TressFX), .data (USC-HairSalon), .bin (CT2Hair), .ply or \
                 Mitsuba's text",
            ),
            Self::Read(source) => write!(f, "cannot be read: {source}"),
            Self::TooLong { most } => write!(f, "the file must have at most {most} bytes"),
            Self::Option { name, value } => {
                write!(f, "`{name}` must be in [1e-6, 1e6], got {value}")
            }
            Self::Header { needed, got } => write!(f, "the header has {needed} bytes, got {got}"),
            Self::Signature { expected, got } => {
                write!(
                    f,
                    "must begin with {expected}, got \"{}\"",
                    got.escape_ascii()
                )
            }
            Self::Flags { expected, got } => write!(f, "flags must {expected}, got {got}"),
            Self::Count { expected, got } => write!(f, "{expected}, got {got}"),
            Self::Points { needed, got } => write!(f, "strands need {needed} points, got {got}"),
            Self::TooLarge { bytes, most } => {
                write!(f, "arrays must have at most {most} bytes, got {bytes}")
            }
            Self::Length { expected, got } => {
                write!(f, "the file must have at least {expected} bytes, got {got}")
            }
            Self::Section { header, got } => {
                write!(f, "sections must begin after byte {header}, got {got}")
            }
            Self::Coordinate { value } => {
                write!(f, "coordinates must be finite and at most 1e6, got {value}")
            }
            Self::Thickness { value } => {
                write!(f, "thickness must be finite and at least 0, got {value}")
            }
            Self::NoRadius => {
                f.write_str("thickness must be above 0 somewhere, got 0 everywhere: give --radius")
            }
            Self::Strand { strand, end, got } => {
                write!(f, "strand {strand} must end by byte {got}, the file's end, got {end}")
            }
            Self::Text(problem) => f.write_str(problem),
            Self::Geometry { strand, error } => write!(f, "strand {strand}: {error}"),
            Self::Scattered {
                size,
                length,
                strand,
            } => write!(
                f,
                "the hair must be less than 10000 times as wide as its strands are long, got {size} cm and {length} cm: strand \
                 {strand} is farthest from the others"
            ),
        }
    }
}

impl fmt::Display for ImportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.offset {
            Some(offset) => write!(
                f,
                "{}: byte {offset}: {}",
                self.path.display(),
                self.problem
            ),
            None => write!(f, "{}: {}", self.path.display(), self.problem),
        }
    }
}

impl core::error::Error for ImportError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.problem {
            Problem::Read(source) => Some(source),
            Problem::Geometry { error, .. } => Some(error),
            _ => None,
        }
    }
}
