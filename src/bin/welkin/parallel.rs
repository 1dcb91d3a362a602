//! Pictures row by row on all cores. What comes out does not depend on their number.

use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use crate::failure::Result;

/// Rows that are in memory twice at a time.
const BATCH: usize = 64;

/// Whether somebody shows how far all has got, and nobody wants to see each part.
static IS_WATCHED: AtomicBool = AtomicBool::new(false);

/// A progress bar for work of which other bars would show the parts: they stay hidden from now on.
pub fn outer_bar(steps: usize, what: &'static str) -> ProgressBar {
    let bar = bar(steps, what);
    IS_WATCHED.store(true, Ordering::Relaxed);
    bar
}

/// A progress bar on standard error if that is a terminal.
pub fn bar(steps: usize, what: &'static str) -> ProgressBar {
    if IS_WATCHED.load(Ordering::Relaxed) {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{msg:<8} {wide_bar} {percent:>3} % {eta}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(steps as u64)
        .with_style(style)
        .with_message(what)
}

/// The pixels of a picture of `[width, height]`, row by row; `pixel` gets `[column, row]`.
pub fn pixels<T: Clone + Default + Send, E: Send>(
    [width, height]: [usize; 2],
    pixel: impl Fn([usize; 2]) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let mut pixels = vec![T::default(); width * height];
    let bar = bar(height, "render");
    let fill = |(row, out): (usize, &mut [T])| {
        for (column, out) in out.iter_mut().enumerate() {
            *out = pixel([column, row])?;
        }
        bar.inc(1);
        Ok(())
    };
    let rows = pixels.par_chunks_mut(width.max(1)).enumerate();
    let filled: Vec<Result<(), E>> = rows.map(fill).collect();
    bar.finish_and_clear();
    // The first, whichever came first.
    filled.into_iter().collect::<Result<(), E>>()?;
    Ok(pixels)
}

/// So many planes of a picture of `[width, height]`; `pixel` gets `[column, row]` and writes a value for each plane,
/// with something that `scratch` makes at hand.
pub fn planes<S>(
    [width, height]: [usize; 2],
    count: usize,
    scratch: impl Fn() -> S + Sync,
    pixel: impl Fn([usize; 2], &mut S, &mut [f32]) -> welkin::Result<()> + Sync,
) -> welkin::Result<Vec<Vec<f32>>> {
    let mut planes = vec![Vec::with_capacity(width * height); count];
    let mut batch = vec![0.0; BATCH.min(height) * width * count];
    let bar = bar(height, "render");
    for first in (0..height).step_by(BATCH) {
        let rows = BATCH.min(height - first);
        let values = &mut batch[..rows * width * count];
        let fill = |scratch: &mut S, (row, out): (usize, &mut [f32])| {
            for (column, out) in out.chunks_exact_mut(count).enumerate() {
                pixel([column, first + row], scratch, out)?;
            }
            bar.inc(1);
            Ok(())
        };
        let rows = values.par_chunks_mut((width * count).max(1)).enumerate();
        let filled: Vec<welkin::Result<()>> = rows.map_init(&scratch, fill).collect();
        filled.into_iter().collect::<welkin::Result<()>>()?;
        let share = planes.par_iter_mut().enumerate();
        share.for_each(|(i, plane)| plane.extend(values.iter().skip(i).step_by(count)));
    }
    bar.finish_and_clear();
    Ok(planes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_planes_are_in_order() {
        let size = [3, 150];
        let number = |[column, row]: [usize; 2]| (row * 3 + column) as f32;
        let all: Vec<f32> = (0..450).map(|i| i as f32).collect();
        assert_eq!(pixels(size, |at| Ok::<_, ()>(number(at))), Ok(all.clone()));
        let twice = planes(
            size,
            2,
            || (),
            |at, (), out| {
                out.copy_from_slice(&[number(at), -number(at)]);
                Ok(())
            },
        );
        let twice = twice.unwrap();
        assert_eq!(twice[0], all);
        assert!(twice[1].iter().zip(&all).all(|(a, b)| *a == -b));
        let refused = pixels(size, |at| if number(at) < 50.0 { Ok(0.0) } else { Err(at) });
        assert_eq!(refused, Err([2, 16]));
    }
}
