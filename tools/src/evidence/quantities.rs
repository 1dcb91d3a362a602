//! Medians and percentiles with weights.

/// The value below which a share of the weights lies.
pub fn quantile(values: &mut [(f64, f64)], share: f64) -> f64 {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = values.iter().map(|v| v.1).sum();
    let mut sum = 0.0;
    for &(value, weight) in values.iter() {
        sum += weight;
        if sum >= share * total {
            return value;
        }
    }
    f64::NAN
}

/// Two significant digits, whole from 10 on.
pub fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if !value.is_finite() => "–".into(),
        _ if size == 0.0 => "0".into(),
        _ if size >= 9.95 => format!("{:.0}", two_digits(value)),
        _ if size >= 0.995 => format!("{value:.1}"),
        _ => format!("{:.*}", (1.0 - size.log10().floor()) as usize, value),
    }
}

fn two_digits(value: f64) -> f64 {
    let scale = 10f64.powf(value.abs().log10().floor() - 1.0);
    (value / scale).round() * scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_go_by_weight() {
        let mut values = vec![(3.0, 1.0), (1.0, 1.0), (2.0, 6.0)];
        assert_eq!(quantile(&mut values, 0.5), 2.0);
        assert_eq!(quantile(&mut values, 0.95), 3.0);
        assert!(quantile(&mut [], 0.5).is_nan());
    }

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (123.4, "120"),
            (12.34, "12"),
            (1.26, "1.3"),
            (0.0234, "0.023"),
            (0.0, "0"),
        ] {
            assert_eq!(short(value), text);
        }
        assert_eq!(short(f64::NAN), "–");
    }
}
