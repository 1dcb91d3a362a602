//! How what depends on the azimuth of the sun fades where the sun comes to the zenith and has none. Format
//! specification, section 7.1.

/// Inverse of the sine of the sun's zenith angle within which azimuths fade: 2.9°.
const PER_SINE: f64 = 20.0;

/// What the fading part counts where the sine of the sun's zenith angle is `sine`: from 0 at the zenith to 1.
#[inline]
pub(crate) fn azimuthal(sine: f64) -> f64 {
    let t = (PER_SINE * sine).clamp(0.0, 1.0);
    t * (0.5 * (3.0 - t * t))
}

/// [`azimuthal`] over the sine; finite at the zenith.
#[inline]
pub(crate) fn azimuthal_per_sine(sine: f32) -> f32 {
    const RATE: f32 = PER_SINE as f32;
    let t = RATE * sine;
    match t < 1.0 {
        true => 0.5 * RATE * (3.0 - t * t),
        false => 1.0 / sine,
    }
}

/// What the coefficient at `index` of an azimuth axis with this many intervals counts in the mean over all azimuths.
#[inline]
pub(crate) fn mean_weight(index: usize, intervals: usize) -> f64 {
    let inner = 1.0 / intervals as f64;
    match index == 0 || index == intervals {
        true => 0.5 * inner,
        false => inner,
    }
}

/// Fades rows of coefficients over the azimuth, `[azimuth][rank]`, towards their mean.
pub(crate) fn fade_rows(rows: &mut [f32], rank: usize, fade: f64) {
    if fade == 1.0 {
        return;
    }
    let intervals = rows.len() / rank - 1;
    for r in 0..rank {
        let column = rows.iter().skip(r).step_by(rank).enumerate();
        let mean: f64 = column
            .map(|(i, &v)| mean_weight(i, intervals) * f64::from(v))
            .sum();
        for value in rows.iter_mut().skip(r).step_by(rank) {
            *value = (mean + fade * (f64::from(*value) - mean)) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::axis::{Ends, spline};

    #[test]
    fn fades_smoothly_to_nothing_at_the_zenith() {
        assert_eq!(azimuthal(0.0), 0.0);
        assert_eq!(azimuthal(0.05), 1.0);
        assert_eq!(azimuthal(1.0), 1.0);
        let mut before = 0.0;
        for i in 1..=1000 {
            let sine = 6e-5 * f64::from(i);
            let now = azimuthal(sine);
            assert!(now >= before && now - before < 2e-3, "{sine}");
            let again = f64::from(azimuthal_per_sine(sine as f32)) * sine;
            assert!((again - now).abs() < 1e-6);
            before = now;
        }
    }

    #[test]
    fn the_mean_is_that_of_the_spline() {
        for n in [1, 2, 5] {
            let mut weights = vec![0.0; n + 1];
            const STEPS: usize = 9000;
            for k in 0..STEPS {
                let u = n as f64 * (k as f64 + 0.5) / STEPS as f64;
                let taps = spline(u, n, Ends::Mirrored);
                for (i, w) in taps.index.into_iter().zip(taps.weight) {
                    weights[i] += f64::from(w) / STEPS as f64;
                }
            }
            for (i, w) in weights.into_iter().enumerate() {
                assert!((w - mean_weight(i, n)).abs() < 1e-6, "{n} {i} {w}");
            }
        }
    }
}
