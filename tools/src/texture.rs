//! The floor: radiance in a latitude-longitude picture, read at the nearest pixel.

use welkin::Sky;

/// `N` channels per pixel, twice as wide as high.
pub struct Texture<const N: usize> {
    height: usize,
    pixels: Vec<[f32; N]>,
}

impl<const N: usize> Texture<N> {
    /// 512 x 256 pixels.
    pub fn new(sky: &Sky, pixel: impl Fn(&Sky, [f32; 3]) -> [f32; N]) -> Self {
        Self::with_height(sky, 256, pixel)
    }

    /// What `pixel` says for the direction of each.
    pub fn with_height(
        sky: &Sky,
        height: usize,
        pixel: impl Fn(&Sky, [f32; 3]) -> [f32; N],
    ) -> Self {
        let width = 2 * height;
        let direction = |i: usize| {
            let z = 1.0 - 2.0 * ((i / width) as f32 + 0.5) / height as f32;
            let azimuth = std::f32::consts::TAU * ((i % width) as f32 + 0.5) / width as f32;
            let (r, (y, x)) = ((1.0 - z * z).sqrt(), azimuth.sin_cos());
            [r * x, r * y, z]
        };
        Self {
            height,
            pixels: (0..width * height)
                .map(|i| pixel(sky, direction(i)))
                .collect(),
        }
    }

    /// Memory of the pixels.
    pub fn bytes(&self) -> usize {
        size_of_val(self.pixels.as_slice())
    }

    /// The pixel nearest to a direction.
    pub fn at(&self, [x, y, z]: [f32; 3]) -> [f32; N] {
        let (width, height) = (2 * self.height, self.height);
        let azimuth = y.atan2(x) * std::f32::consts::FRAC_1_PI * 0.5;
        let column = (azimuth - azimuth.floor()) * width as f32;
        let row = (0.5 - 0.5 * z) * height as f32;
        self.pixels[(row as usize).min(height - 1) * width + (column as usize).min(width - 1)]
    }
}
