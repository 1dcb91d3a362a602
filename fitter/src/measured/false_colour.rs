//! The colours of the comparisons of Kider et al. 2014 and Wilkie et al. 2021, Fig. 7: from blue over green to red.

/// Blue for 0, green in the middle, red for 1; dark blue and dark red at the very ends.
pub fn rainbow(value: f64) -> [u8; 3] {
    let v = value.clamp(0.0, 1.0);
    let peak = |middle: f64| (1.5 - (4.0 * v - middle).abs()).clamp(0.0, 1.0);
    [3.0, 2.0, 1.0].map(|middle| (255.0 * peak(middle)).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_dark_and_the_middle_is_green() {
        assert_eq!(rainbow(0.0), [0, 0, 128]);
        assert_eq!(rainbow(0.5), [128, 255, 128]);
        assert_eq!(rainbow(1.0), [128, 0, 0]);
        assert_eq!(rainbow(9.0), rainbow(1.0));
    }
}
