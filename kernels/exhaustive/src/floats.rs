//! Floats by their place among all floats.

/// Returns the place of a float among all floats, in their order; both zeros have the place 0.
pub(crate) fn place(x: f32) -> i64 {
    let magnitude = i64::from(x.to_bits() & !(1 << 31));
    if x.is_sign_negative() {
        -magnitude
    } else {
        magnitude
    }
}

/// Returns the float at a place.
///
/// # Panics
///
/// Panics if no float has the place.
#[inline]
pub(crate) fn at_place(place: i64) -> f32 {
    let magnitude = u32::try_from(place.unsigned_abs()).expect("the place of a float");
    f32::from_bits(magnitude | u32::from(place < 0) << 31)
}

#[test]
fn places_are_in_the_order_of_floats() {
    for x in [
        -f32::MAX,
        -1.0,
        -f32::from_bits(1),
        0.0,
        1e-40,
        1.0,
        f32::MAX,
    ] {
        assert_eq!(at_place(place(x)).to_bits(), x.to_bits());
        assert_eq!(place(x.next_up()), place(x) + 1);
    }
}
