//! The floor: radiance in a latitude-longitude picture, read at the nearest pixel.

use welkin::Sky;

const WIDTH: usize = 512;
const HEIGHT: usize = 256;

/// `N` channels per pixel.
pub struct Texture<const N: usize>(Vec<[f32; N]>);

impl<const N: usize> Texture<N> {
    pub fn new(sky: &Sky, pixel: impl Fn(&Sky, [f32; 3]) -> [f32; N]) -> Self {
        let direction = |i: usize| {
            let z = 1.0 - 2.0 * ((i / WIDTH) as f32 + 0.5) / HEIGHT as f32;
            let azimuth = std::f32::consts::TAU * ((i % WIDTH) as f32 + 0.5) / WIDTH as f32;
            let (r, (y, x)) = ((1.0 - z * z).sqrt(), azimuth.sin_cos());
            [r * x, r * y, z]
        };
        Self(
            (0..WIDTH * HEIGHT)
                .map(|i| pixel(sky, direction(i)))
                .collect(),
        )
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.0.as_slice())
    }

    pub fn at(&self, [x, y, z]: [f32; 3]) -> [f32; N] {
        let azimuth = y.atan2(x) * std::f32::consts::FRAC_1_PI * 0.5;
        let column = (azimuth - azimuth.floor()) * WIDTH as f32;
        let row = (0.5 - 0.5 * z) * HEIGHT as f32;
        self.0[(row as usize).min(HEIGHT - 1) * WIDTH + (column as usize).min(WIDTH - 1)]
    }
}
