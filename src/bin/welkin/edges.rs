//! Smooth outlines: what a pixel of a landscape shows, seen at one place or, where a ridge ends, at several.

use crate::failure::Result;
use crate::parallel;

/// How many times as far is beyond an outline.
const JUMP: f32 = 1.1;
/// Places in a pixel that an outline may run through.
const PLACES: [[f64; 2]; 8] = [
    [0.0625, 0.4375],
    [0.1875, 0.8125],
    [0.3125, 0.1875],
    [0.4375, 0.6875],
    [0.5625, 0.0625],
    [0.6875, 0.5625],
    [0.8125, 0.3125],
    [0.9375, 0.9375],
];

/// What is seen at a place.
#[derive(Clone, Copy, Default)]
pub struct Seen {
    pub light: [f32; 3],
    /// m; infinite in the sky.
    pub distance: f32,
}

/// The light of every pixel; `see` gets a place in pixels from the upper left corner.
pub fn smooth(
    size: [usize; 2],
    see: impl Fn([f64; 2]) -> Result<Seen> + Sync,
) -> Result<Vec<[f32; 3]>> {
    let place = |pixel: [usize; 2], [x, y]: [f64; 2]| [pixel[0] as f64 + x, pixel[1] as f64 + y];
    let once = parallel::pixels(size, |pixel| see(place(pixel, [0.5; 2])))?;
    parallel::pixels(size, |pixel| {
        if !is_outline(&once, size, pixel) {
            return Ok(once[pixel[1] * size[0] + pixel[0]].light);
        }
        let mut sum = [0.0; 3];
        for at in PLACES {
            let seen = see(place(pixel, at))?;
            sum = std::array::from_fn(|c| sum[c] + seen.light[c] / PLACES.len() as f32);
        }
        Ok(sum)
    })
}

/// Whether a neighbour shows something much nearer or farther.
fn is_outline(seen: &[Seen], [width, height]: [usize; 2], [column, row]: [usize; 2]) -> bool {
    let distance = |column: usize, row: usize| seen[row * width + column].distance;
    let here = distance(column, row);
    let columns = column.saturating_sub(1)..=(column + 1).min(width - 1);
    let mut neighbours = columns
        .flat_map(|x| [row.saturating_sub(1), row, (row + 1).min(height - 1)].map(|y| (x, y)));
    neighbours.any(|(x, y)| {
        let (near, far) = (here.min(distance(x, y)), here.max(distance(x, y)));
        near.is_finite() && far > JUMP * near
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_are_as_bright_as_their_parts() {
        // A bright edge that rises by a quarter of a pixel per pixel before a black sky.
        let see = |[x, y]: [f64; 2]| {
            let is_land = y > 4.0 - 0.25 * x;
            Ok(Seen {
                light: [if is_land { 1.0 } else { 0.0 }; 3],
                distance: if is_land { 1000.0 } else { f32::INFINITY },
            })
        };
        let pixels = smooth([8, 8], see).unwrap();
        let sum: f32 = pixels.iter().map(|p| p[0]).sum();
        assert!((sum - 40.0).abs() < 0.6, "{sum}");
        assert!(pixels.iter().any(|p| p[0] > 0.1 && p[0] < 0.9));
        assert_eq!((pixels[0][0], pixels[63][0]), (0.0, 1.0));
    }
}
