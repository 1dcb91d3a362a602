//! Real spherical harmonics of a function that is even in azimuth. Format specification, section 7.7.

/// Index of the first harmonic of order `m` when harmonics are sorted by order, then by degree.
fn order_start(degree: usize, m: usize) -> usize {
    (0..m).map(|k| degree + 1 - k).sum()
}

/// Orthonormal harmonics without their factor cos mφ, at the cosine of the zenith angle: the sum over the degrees of
/// each order m of `coefficient(index)` times harmonic.
pub(crate) fn orders(
    degree: usize,
    orders: usize,
    cosine: f64,
    coefficient: impl Fn(usize) -> f64,
) -> Vec<f64> {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let mut diagonal = (0.25 / core::f64::consts::PI).sqrt();
    let mut out = Vec::with_capacity(orders + 1);
    for m in 0..=orders {
        if m > 0 {
            diagonal *= sine * ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
        }
        let even = if m > 0 {
            core::f64::consts::SQRT_2
        } else {
            1.0
        };
        let ratio = |l: usize| (((4 * l * l) as f64 - 1.0) / ((l * l - m * m) as f64)).sqrt();
        let (mut previous, mut current) = (0.0, diagonal);
        let mut sum = 0.0;
        for l in m..=degree {
            sum += even * current * coefficient(order_start(degree, m) + l - m);
            let before = if l > m { previous / ratio(l) } else { 0.0 };
            (previous, current) = (current, ratio(l + 1) * (cosine * current - before));
        }
        out.push(sum);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn low_degrees_are_the_textbook_ones() {
        let (x, pi) = (0.3f64, core::f64::consts::PI);
        let one = |wanted: usize| orders(2, 2, x, |i| f64::from(u8::from(i == wanted)));
        let s = (1.0 - x * x).sqrt();
        // (0,0), (1,0), (2,0), (1,1), (2,1), (2,2)
        assert!((one(0)[0] - (0.25 / pi).sqrt()).abs() < 1e-12);
        assert!((one(2)[0] - (5.0 / (16.0 * pi)).sqrt() * (3.0 * x * x - 1.0)).abs() < 1e-12);
        assert!((one(3)[1].abs() - (3.0 / (4.0 * pi)).sqrt() * s).abs() < 1e-12);
        assert!((one(4)[1].abs() - (15.0 / (4.0 * pi)).sqrt() * s * x).abs() < 1e-12);
        assert!((one(5)[2] - (15.0 / (16.0 * pi)).sqrt() * s * s).abs() < 1e-12);
    }
}
