//! Reader of Radiance HDR files: the header, and the order of the pixels.

use super::primaries::{Primaries, xyz_to_rec_709};
use super::{Pixels, checked, damaged, excerpt, line, rgbe};
use crate::light::rounded;
use std::collections::BTreeMap;
use std::io::{BufRead, ErrorKind, Read as _};

/// Length of the longest header that is read, in bytes.
const LONGEST_HEADER: u64 = 1 << 20;

/// Reads the map of a file.
pub(super) fn read(mut file: impl BufRead, most: usize) -> Result<Pixels, String> {
    let header = Header::read(&mut file.by_ref().take(LONGEST_HEADER))?;
    let [lines, length] = header.scan.map(|axis| axis.length);
    let size = checked("picture", header.size(), most)?;
    let mut map = Pixels {
        size,
        corner: [0; 2],
        extent: size,
        values: Vec::new(),
        remarks: Vec::new(),
        texts: BTreeMap::new(),
    };
    let scanned = rgbe::read(&mut file, lines, length).map_err(|e| match e.kind() {
        ErrorKind::UnexpectedEof | ErrorKind::InvalidData => damaged(e),
        _ => format!("cannot read: {}", line(&e)),
    })?;
    map.values = vec![[0.0; 3]; lines * length];
    for (k, pixel) in scanned.into_iter().enumerate() {
        map.values[header.place(k)] = pixel;
    }
    if header.divisor != [1.0; 3] {
        for pixel in &mut map.values {
            *pixel = core::array::from_fn(|c| rounded(f64::from(pixel[c]) / header.divisor[c]));
        }
        let [r, g, b] = header.divisor;
        map.remarks.push(format!(
            "divided by EXPOSURE and COLORCORR of the file, {r} {g} {b}"
        ));
    }
    if header.is_xyz {
        map.convert(&xyz_to_rec_709());
        map.remarks
            .push("converted from XYZ to Rec. 709".to_owned());
    } else if let Some(matrix) = header.primaries.to_rec_709()? {
        map.convert(&matrix);
        map.remarks.push(format!(
            "converted to Rec. 709 from the primaries of the file, {}",
            header.primaries
        ));
    }
    Ok(map)
}

/// Axis of the order in which pixels are stored.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    is_x: bool,
    /// Whether the axis runs to the left or to the top.
    is_backward: bool,
    length: usize,
}

/// Statements of a header that concern the pixels.
#[derive(Debug, PartialEq)]
struct Header {
    is_xyz: bool,
    primaries: Primaries,
    /// Divisors that turn the pixels into radiances.
    divisor: [f64; 3],
    /// Axes from one scan line to the next, and along a scan line.
    scan: [Axis; 2],
}

impl Header {
    fn read(file: &mut impl BufRead) -> Result<Self, String> {
        let mut header = Self {
            is_xyz: false,
            primaries: Primaries::REC_709,
            divisor: [1.0; 3],
            scan: [Axis {
                is_x: false,
                is_backward: false,
                length: 0,
            }; 2],
        };
        let mut is_first = true;
        loop {
            let text = next_line(file)?;
            // Indented lines belong to pictures from which this one was made.
            match text.split_once('=') {
                _ if is_first || text.starts_with('#') => {}
                _ if text.is_empty() => break,
                Some((key, value)) => {
                    let data = value.split('#').next().unwrap_or_default();
                    header.take(key, data.trim())?;
                }
                None => {}
            }
            is_first = false;
        }
        let resolution = next_line(file)?;
        header.scan = scan(&resolution)?;
        Ok(header)
    }

    /// Applies a line of the header, and ignores unknown keys.
    fn take(&mut self, key: &str, value: &str) -> Result<(), String> {
        match key {
            "FORMAT" => match value {
                "32-bit_rle_rgbe" => self.is_xyz = false,
                "32-bit_rle_xyze" => self.is_xyz = true,
                _ => return Err(format!("unsupported: FORMAT={}", excerpt(value))),
            },
            "EXPOSURE" => {
                let [exposure] = numbers(key, value, 0.0)?;
                self.divisor = self.divisor.map(|divisor| divisor * exposure);
            }
            "COLORCORR" => {
                let factors: [f64; 3] = numbers(key, value, 0.0)?;
                self.divisor = core::array::from_fn(|c| self.divisor[c] * factors[c]);
            }
            "PRIMARIES" => {
                let [rx, ry, gx, gy, bx, by, wx, wy] = numbers(key, value, f64::NEG_INFINITY)?;
                self.primaries = Primaries([[rx, ry], [gx, gy], [bx, by], [wx, wy]]);
            }
            "GAMMA" => {
                let [gamma] = numbers(key, value, 0.0)?;
                if gamma != 1.0 {
                    return Err(format!(
                        "unsupported: GAMMA={gamma}; write the file with linear values"
                    ));
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Returns the width and the height of the picture.
    fn size(&self) -> [usize; 2] {
        let [lines, along] = self.scan;
        if along.is_x {
            [along.length, lines.length]
        } else {
            [lines.length, along.length]
        }
    }

    /// Returns the index of the `k`th stored pixel, counted row by row from the upper left corner.
    fn place(&self, k: usize) -> usize {
        let [lines, along] = self.scan;
        let step = |axis: Axis, k: usize| {
            if axis.is_backward {
                axis.length - 1 - k
            } else {
                k
            }
        };
        let (line, offset) = (step(lines, k / along.length), step(along, k % along.length));
        if along.is_x {
            line * along.length + offset
        } else {
            offset * lines.length + line
        }
    }
}

/// Reads the next line and strips its end.
fn next_line(file: &mut impl BufRead) -> Result<String, String> {
    let mut bytes = Vec::new();
    file.read_until(b'\n', &mut bytes)
        .map_err(|e| format!("cannot read: {}", line(&e)))?;
    if bytes.pop() != Some(b'\n') {
        return Err(damaged("the header has no end"));
    }
    let text = String::from_utf8_lossy(&bytes);
    Ok(text.strip_suffix('\r').unwrap_or(&text).to_owned())
}

/// Parses the order of pixels and the size, such as `-Y 512 +X 1024`: both axes with their directions, where y points upwards.
fn scan(text: &str) -> Result<[Axis; 2], String> {
    let axis = |name: &str, length: &str| {
        let is_x = name.ends_with('X');
        let is_backward = match name {
            "+X" | "-Y" => false,
            "-X" | "+Y" => true,
            _ => return None,
        };
        Some(Axis {
            is_x,
            is_backward,
            length: length.parse().ok()?,
        })
    };
    let words: Vec<&str> = text.split_whitespace().collect();
    if let [first, lines, second, length] = words[..]
        && let (Some(lines), Some(along)) = (axis(first, lines), axis(second, length))
        && lines.is_x != along.is_x
    {
        return Ok([lines, along]);
    }
    Err(damaged(format_args!(
        "the resolution must be like -Y 512 +X 1024, got {}",
        excerpt(text)
    )))
}

/// Parses `N` finite numbers above `least` from a line of the header.
fn numbers<const N: usize>(key: &str, value: &str, least: f64) -> Result<[f64; N], String> {
    let number = |word: &str| {
        word.parse()
            .ok()
            .filter(|x: &f64| x.is_finite() && *x > least)
    };
    let numbers: Option<Vec<f64>> = value.split_whitespace().map(number).collect();
    numbers
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| {
            let count = if N == 1 {
                "a number".to_owned()
            } else {
                format!("{N} numbers")
            };
            let range = if least == 0.0 { " above 0" } else { "" };
            format!("{key} must be {count}{range}, got {}", excerpt(value))
        })
}
