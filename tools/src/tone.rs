//! How linear light is shown.

/// sRGB of light where `white` is white: darker parts are lifted, as twilight spans decades.
pub fn display(pixel: [f32; 3], white: f32) -> [u8; 3] {
    pixel.map(|v| {
        let v = (v.max(0.0) / white).powf(0.7);
        let v = v / (1.0 + 0.4 * v);
        let encoded = match v <= 0.003_130_8 {
            true => 12.92 * v,
            false => 1.055 * v.powf(1.0 / 2.4) - 0.055,
        };
        (encoded.min(1.0) * 255.0 + 0.5) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_is_black_and_more_light_is_brighter() {
        assert_eq!(display([0.0, -1.0, 0.0], 1.0), [0; 3]);
        let levels = [0.01, 0.1, 1.0, 3.0].map(|v| display([v; 3], 1.0)[0]);
        assert!(levels.is_sorted() && levels[0] < levels[3]);
    }
}
