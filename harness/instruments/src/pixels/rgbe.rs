//! Decoder of the pixels of Radiance HDR: three mantissas and the exponent that they share, in runs of two kinds.

use std::io::{self, Read};

/// Mantissas of red, green and blue, and their exponent.
type Rgbe = [u8; 4];

/// Reads the pixels of `lines` scan lines of `length` pixels each, which may not be 0.
///
/// A line stores its components one after another, each in runs, or stores whole pixels. Runs of whole pixels are those of Ward's first
/// format: markers of mantissas 1 repeat the pixel before as often as their exponent says, and a marker behind a marker counts 256 times
/// as much.
///
/// # Errors
/// Returns an error of kind `InvalidData` if a run goes beyond its line or begins one, and otherwise the errors of `file`.
pub(super) fn read(file: &mut impl Read, lines: usize, length: usize) -> io::Result<Vec<[f32; 3]>> {
    let mut line = vec![Rgbe::default(); length];
    let mut pixels = Vec::with_capacity(lines * length);
    for _ in 0..lines {
        match bytes(file)? {
            [2, 2, 0..128, _] => (0..4).try_for_each(|c| read_component(file, &mut line, c))?,
            first => read_pixels(file, first, &mut line)?,
        }
        pixels.extend(line.iter().copied().map(radiance));
    }
    Ok(pixels)
}

fn bytes<const N: usize>(file: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// Reads a component of a line: runs of one byte, of more than 128, or that many bytes as they are.
fn read_component(file: &mut impl Read, line: &mut [Rgbe], component: usize) -> io::Result<()> {
    let mut place = 0;
    while place < line.len() {
        let [count] = bytes(file)?;
        let mut run = [0; 128];
        let run = if count > 128 {
            let run = &mut run[..usize::from(count) - 128];
            run.fill(bytes::<1>(file)?[0]);
            run
        } else {
            let run = &mut run[..usize::from(count)];
            file.read_exact(run)?;
            run
        };
        let pixels = part(line, place, run.len())?;
        pixels
            .iter_mut()
            .zip(&*run)
            .for_each(|(pixel, byte)| pixel[component] = *byte);
        place += run.len();
    }
    Ok(())
}

/// Reads whole pixels of a line, of which the first is known.
fn read_pixels(file: &mut impl Read, first: Rgbe, line: &mut [Rgbe]) -> io::Result<()> {
    if let [1, 1, 1, _] = first {
        return Err(invalid("a line begins with a run".to_owned()));
    }
    line[0] = first;
    let (mut place, mut weight) = (1, 1_usize);
    while place < line.len() {
        let pixel = bytes(file)?;
        let (value, count) = if let [1, 1, 1, count] = pixel {
            let count = usize::from(count).saturating_mul(weight);
            weight = weight.saturating_mul(256);
            (line[place - 1], count)
        } else {
            weight = 1;
            (pixel, 1)
        };
        part(line, place, count)?.fill(value);
        place += count;
    }
    Ok(())
}

/// Returns the pixels of a line that a run covers.
fn part(line: &mut [Rgbe], place: usize, count: usize) -> io::Result<&mut [Rgbe]> {
    let length = line.len();
    line.get_mut(place..place.saturating_add(count))
        .ok_or_else(|| invalid(format!("a run goes beyond its line of {length} pixels")))
}

fn invalid(problem: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, problem)
}

/// Returns the radiance of a pixel: mantissas times 2^(exponent - 136). An exponent of 0 is black.
fn radiance([r, g, b, exponent]: Rgbe) -> [f32; 3] {
    // 2^(exponent - 128), of which 1 gives a denormal number, by the bits of its exponent.
    let power = match exponent {
        0 | 1 => u32::from(exponent) << 22,
        _ => u32::from(exponent - 1) << 23,
    };
    let unit = f32::from_bits(power) / 256.0;
    [r, g, b].map(|mantissa| f32::from(mantissa) * unit)
}
