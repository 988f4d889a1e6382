//! Vectors in the frame of the fibre.

/// Vector along (u, v, w), with u the axis.
pub(super) type Vector = [f64; 3];

pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns `p + x a`.
pub(super) fn along(p: &Vector, a: &Vector, x: f64) -> Vector {
    core::array::from_fn(|k| p[k] + x * a[k])
}

/// Returns two vectors that are orthonormal with the unit vector `n`.
///
/// - Source: Duff et al. 2017.
pub(super) fn frame([x, y, z]: &Vector) -> [Vector; 2] {
    let sign = 1.0_f64.copysign(*z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    [
        [1.0 + sign * x * x * a, sign * b, -sign * x],
        [b, sign + y * y * a, -y],
    ]
}

/// Returns the vector with these components about the unit vector `n`, which is the third axis.
pub(super) fn around(n: &Vector, [x, y, z]: Vector) -> Vector {
    let [s, t] = frame(n);
    core::array::from_fn(|k| x * s[k] + y * t[k] + z * n[k])
}
