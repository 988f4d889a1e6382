//! Strings of C, and the errors that calls of set-up write.

use crate::layout::Error;
use core::ffi::{CStr, c_char};
use core::fmt::{self, Write};

/// Reads a string of the host; returns `None` for null. Bytes that are not UTF-8 become a text that names nothing.
pub(crate) unsafe fn string<'a>(text: *const c_char) -> Option<&'a str> {
    if text.is_null() {
        return None;
    }
    // SAFETY: the caller's promise: the string ends in 0.
    let text = unsafe { CStr::from_ptr(text) };
    Some(text.to_str().unwrap_or("\u{fffd}"))
}

/// Text in an array that ends in 0. Characters that do not fit are left out as a whole.
struct Text<'a> {
    to: &'a mut [c_char],
    len: usize,
    is_full: bool,
}

impl Write for Text<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for character in text.chars() {
            let mut bytes = [0; 4];
            let bytes = character.encode_utf8(&mut bytes).as_bytes();
            self.is_full |= self.len + bytes.len() >= self.to.len();
            if self.is_full {
                break;
            }
            for byte in bytes {
                self.to[self.len] = c_char::from_ne_bytes([*byte]);
                self.len += 1;
            }
        }
        Ok(())
    }
}

/// Writes the displayed text to `to`, with a 0 behind it.
fn write(to: &mut [c_char], text: &dyn fmt::Display) {
    let mut text_to = Text {
        to,
        len: 0,
        is_full: false,
    };
    let _ = write!(text_to, "{text}");
    let len = text_to.len;
    if let Some(end) = to.get_mut(len) {
        *end = 0;
    }
}

/// Returns an array with the text and a 0 behind it.
pub(crate) fn array<const N: usize>(text: &str) -> [c_char; N] {
    let mut to = [0; N];
    write(&mut to, &text);
    to
}

/// Copies a name to `size` characters of the host, as `snprintf` does, and returns the length of the name.
pub(crate) unsafe fn copy(name: &str, to: *mut c_char, size: usize) -> usize {
    if size > 0 && !to.is_null() {
        // SAFETY: the caller's promise. No name is longer than this.
        write(
            unsafe { core::slice::from_raw_parts_mut(to, size.min(256)) },
            &name,
        );
    }
    name.len()
}

/// List of names that displays as names separated by commas.
pub(crate) struct List<I>(pub(crate) I);

impl<'a, I: Iterator<Item = &'a str> + Clone> fmt::Display for List<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, name) in self.0.clone().enumerate() {
            f.write_str(if place > 0 { ", " } else { "" })?;
            f.write_str(name)?;
        }
        Ok(())
    }
}

/// Place of an error: the field, the number at fault and its value.
pub(crate) struct Fault<'a> {
    pub(crate) field: &'a str,
    pub(crate) number: Option<usize>,
    pub(crate) value: f32,
}

impl<'a> Fault<'a> {
    /// Makes the place of a whole field, or of an argument.
    pub(crate) const fn of(field: &'a str) -> Self {
        Self {
            field,
            number: None,
            value: 0.0,
        }
    }
}

/// Writes the error unless the host passes null, and returns its code.
pub(crate) unsafe fn refuse(
    error: *mut Error,
    code: i32,
    fault: &Fault<'_>,
    message: &dyn fmt::Display,
) -> i32 {
    // SAFETY: the caller's promise: null, or memory for an error.
    if !error.is_null() {
        let mut text = [0; 212];
        write(&mut text, message);
        let number = fault.number.and_then(|number| i32::try_from(number).ok());
        let refusal = Error {
            code,
            number: number.unwrap_or(-1),
            value: fault.value,
            field: array(fault.field),
            message: text,
        };
        // SAFETY: as above.
        unsafe { error.write(refusal) };
    }
    code
}
