//! Checks that the parameters of several models share.

use hairis::ParamError;

/// Whether `value` is finite and at least 0.
#[inline]
pub(crate) fn is_intensity(value: f32) -> bool {
    (0.0..=f32::MAX).contains(&value)
}

#[inline]
pub(crate) fn check(passed: bool, error: ParamError) -> Result<(), ParamError> {
    if passed { Ok(()) } else { Err(error) }
}

/// Refuses a `value` outside `[least, most]`, and NaN.
#[inline]
pub(crate) fn check_range(
    field: &'static str,
    value: f32,
    [least, most]: [f32; 2],
) -> Result<(), ParamError> {
    check(
        (least..=most).contains(&value),
        ParamError::Range(field, value, [least, most]),
    )
}

/// Refuses a colour with a channel that is negative or not finite.
#[inline]
pub(crate) fn check_rgb(field: &'static str, rgb: [f32; 3]) -> Result<(), ParamError> {
    for (channel, value) in rgb.into_iter().enumerate() {
        check(
            is_intensity(value),
            ParamError::Intensity(field, channel, value),
        )?;
    }
    Ok(())
}
