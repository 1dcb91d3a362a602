//! Sampling a linear density.

/// Where the linear density from `a` to `b` over [0, 1] has the part `u` of its mass before it.
pub(super) fn linear(a: f64, b: f64, u: f64) -> f64 {
    // The root's form that stays exact for a = b and for a = 0.
    let root = (a * a + u * (b * b - a * a)).sqrt();
    (u * (a + b) / (a + root)).min(1.0)
}
