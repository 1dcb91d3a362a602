//! Skies in colour under all suns of a range: between some that are baked, the tables are interpolated.

use super::baked_colour::BakedColourSky;
use super::grid_choice::{BakeError, Errors, TAIL, difference};
use super::spline_table::Grid;
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::kernel::axis::{Stencil, hermite};
use crate::kernel::lanes::Lanes;
use crate::model::Model;

/// Distance of the first elevations that are baked, rad; halved where that is too much.
const STEP: f64 = 0.07;
/// Below this distance the 95th percentile alone counts, rad: in the tail baked skies differ by as much themselves.
const PATIENT: f64 = 5e-3;
/// Least distance, rad.
const LEAST: f64 = 2e-4;
/// Share of the tolerance that interpolation may take.
const SHARE: f64 = 0.5;
/// Rows above and below the horizon, and azimuths, at which interpolated skies are compared with baked ones.
const PROBES: [usize; 3] = [16, 8, 12];

/// Baked skies in colour under every sun of a range, of one observer and one air: a sky for the next frame of a day
/// costs microseconds by day, as the tables of four skies that were baked beforehand are blended.
///
/// Elevations are chosen so that in the middle between any two the blend differs from a sky that is baked there by half
/// of the tolerance at most (95 % of directions and colours), and by [`BakedSky::TAIL`](crate::BakedSky::TAIL) times as
/// much at 99.9 % where they stand more than 0.3° apart. Blends are continuous in the elevation, and so are their slopes.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let model = Model::default_model()?;
/// let elevations = [10f64.to_radians(), 20f64.to_radians()];
/// let course = model.sun_course(&Conditions::default(), elevations, BakedSky::TOLERANCE)?;
/// let mut sky = course.at(elevations[0], 0.0)?;
/// for frame in 0..100 {
///     let elevation = elevations[0] + 1e-4 * f64::from(frame);
///     course.write(elevation, 0.3, &mut sky)?;
///     let [_, g, _] = sky.linear_srgb([0.0, 0.0, 1.0])?; // cd m⁻²
///     assert!(g > 100.0);
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SunCourse {
    /// Elevations that are baked, rad.
    nodes: Vec<f64>,
    skies: Vec<BakedColourSky>,
    /// The worst that was found between nodes.
    error: BakeError,
}

impl Model {
    /// Bakes skies for all solar `elevations` (lowest and highest, rad), as [`ColourSky::bake`](crate::ColourSky::bake)
    /// does; the sun of the conditions does not count. By day that takes as long as baking some tens of skies; twilight
    /// is dearer, as skies differ there from one tenth of a degree to the next: −12..60° on the ground takes seconds
    /// and 6 MB, three times as much at 9 km.
    ///
    /// # Errors
    /// As [`Model::sky`] and [`Sky::bake`](crate::Sky::bake); [`Error::OutOfRange`] unless the highest elevation is
    /// 2·10⁻⁴ above the lowest; [`Error::Tolerance`] if skies that close together still differ by more, as in twilight
    /// above some 60 km.
    pub fn sun_course(
        &self,
        conditions: &Conditions,
        elevations: [f64; 2],
        tolerance: f64,
    ) -> Result<SunCourse> {
        let [lowest, highest] = elevations;
        let top = self.solar_elevation_range()[1];
        check(highest, [lowest + LEAST, top])?;
        let bake = |elevation: f64| {
            let conditions = Conditions {
                solar_elevation: elevation,
                solar_azimuth: 0.0,
                ..*conditions
            };
            self.colour_sky(&conditions)?.bake(tolerance)
        };
        let steps = ((highest - lowest) / STEP).ceil().max(3.0);
        let nodes: Vec<f64> = (0..=steps as usize)
            .map(|i| lowest + (highest - lowest) * i as f64 / steps)
            .collect();
        let skies = nodes.iter().map(|&e| bake(e)).collect::<Result<_>>()?;
        let mut course = SunCourse {
            error: Errors::default().summary(),
            nodes,
            skies,
        };
        course.refine(bake, tolerance)?;
        Ok(course)
    }
}

impl SunCourse {
    /// Lowest and highest elevation, rad.
    pub fn elevations(&self) -> [f64; 2] {
        [self.nodes[0], self.nodes[self.nodes.len() - 1]]
    }

    /// How many skies are baked.
    pub fn skies(&self) -> usize {
        self.skies.len()
    }

    /// What interpolation adds to [`BakedColourSky::bake_error`], where it was worst.
    pub fn interpolation_error(&self) -> BakeError {
        self.error
    }

    /// Memory on the heap, bytes.
    pub fn bytes(&self) -> usize {
        let skies: usize = self.skies.iter().map(BakedColourSky::bytes).sum();
        skies + size_of_val(self.nodes.as_slice()) + size_of_val(self.skies.as_slice())
    }

    /// The sky under a sun at an elevation and an azimuth, rad.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for an elevation beyond [`SunCourse::elevations`], or an azimuth that is not finite.
    pub fn at(&self, elevation: f64, azimuth: f64) -> Result<BakedColourSky> {
        let mut sky = self.skies[0].clone();
        self.write(elevation, azimuth, &mut sky)?;
        Ok(sky)
    }

    /// The same, over a sky that came from here: microseconds by day. Where the sizes of tables change, as they do often
    /// in twilight, smaller ones are refined first, which allocates and takes up to a tenth of a millisecond.
    ///
    /// # Errors
    /// As [`SunCourse::at`]; then the sky stays what it was.
    pub fn write(&self, elevation: f64, azimuth: f64, sky: &mut BakedColourSky) -> Result<()> {
        check(elevation, self.elevations())?;
        let conditions = Conditions {
            solar_elevation: elevation,
            ..*self.skies[0].conditions()
        };
        let conditions = conditions.with_solar_azimuth(azimuth)?;
        let stencil = hermite(&self.nodes, elevation);
        self.blend(&stencil, sky);
        sky.baked.frame = self.skies[0].baked.frame.under(&conditions);
        sky.baked.conditions = conditions;
        Ok(())
    }

    fn blend(&self, stencil: &Stencil, sky: &mut BakedColourSky) {
        let tables = stencil
            .taps()
            .map(|(node, weight)| (&self.skies[node].baked.table, weight as f32));
        let grids = tables.clone().map(|(table, _)| table.grid);
        let Some(grid) = grids.reduce(Grid::or_larger) else {
            return;
        };
        let out = &mut sky.baked.table;
        out.grid = grid;
        out.cells.clear();
        out.cells.resize(grid.cells(), Lanes::splat(0.0));
        out.envelope.fill(Lanes::splat(0.0));
        for (table, weight) in tables {
            add(&mut out.envelope, &table.envelope, weight);
            if table.grid == grid {
                add(&mut out.cells, &table.cells, weight);
                continue;
            }
            let mut larger = table.clone();
            larger.refine(grid);
            add(&mut out.cells, &larger.cells, weight);
        }
        let errors = stencil.taps().map(|(node, _)| self.skies[node].baked.error);
        sky.baked.error = errors.fold(Errors::default().summary(), BakeError::or_larger);
    }

    /// Bakes more skies until the tolerance is kept between all.
    fn refine(
        &mut self,
        bake: impl Fn(f64) -> Result<BakedColourSky>,
        tolerance: f64,
    ) -> Result<()> {
        let mut i = 0;
        while i + 1 < self.nodes.len() {
            let middle = 0.5 * (self.nodes[i] + self.nodes[i + 1]);
            let truth = bake(middle)?;
            let error = self.differences(&truth)?;
            let limit = SHARE * tolerance;
            let width = self.nodes[i + 1] - self.nodes[i];
            if error.p95 <= limit && (error.p999 <= TAIL * limit || width < PATIENT) {
                self.error = self.error.or_larger(error);
                i += 1;
                continue;
            }
            if width < 2.0 * LEAST {
                return Err(Error::Tolerance {
                    expected: limit,
                    got: error.p95,
                });
            }
            self.nodes.insert(i + 1, middle);
            self.skies.insert(i + 1, truth);
            // The slopes of the interval before have changed.
            i = i.saturating_sub(1);
        }
        Ok(())
    }

    /// Between a baked sky and the blend there.
    fn differences(&self, truth: &BakedColourSky) -> Result<BakeError> {
        let blend = self.at(truth.conditions().solar_elevation, 0.0)?;
        let [up, down, azimuths] = PROBES;
        let frame = truth.baked.frame;
        let mut pairs = Vec::with_capacity((up + down) * azimuths);
        for row in 0..up + down {
            let [low, high] = frame.row(row, up, down);
            let z = 0.5 * (low + high);
            let level = (1.0 - z * z).max(0.0).sqrt();
            for k in 0..azimuths {
                let share = (k as f64 + 0.5) / azimuths as f64;
                let (y, x) = (core::f64::consts::PI * share * share).sin_cos();
                let direction = [level * x, level * y, z].map(|v| v as f32);
                let part = (high - low).abs() * share;
                pairs.push((blend.xyz(direction)?, truth.xyz(direction)?, part));
            }
        }
        let brightest = pairs
            .iter()
            .fold(0f32, |most, (_, xyz, _)| most.max(xyz[1]));
        let least = (super::fill::DARK * brightest).max(f32::MIN_POSITIVE);
        let mut errors = Errors::default();
        // Below an observer on the ground there is nothing to differ.
        let seen =
            |(got, expected, _): &([f32; 3], [f32; 3], f64)| *got != [0.0; 3] || got != expected;
        for (got, expected, part) in pairs.into_iter().filter(seen) {
            let pairs = got.into_iter().zip(expected);
            let differences = pairs.map(|(got, expected)| difference(got, expected, least));
            errors.add(differences, part as f32);
        }
        Ok(errors.sorted().summary())
    }
}

fn add<const N: usize>(sums: &mut [Lanes<N>], values: &[Lanes<N>], weight: f32) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum = *sum + *value * weight;
    }
}

fn check(elevation: f64, [min, max]: [f64; 2]) -> Result<()> {
    if elevation >= min && elevation <= max {
        return Ok(());
    }
    Err(Error::OutOfRange {
        parameter: "solar_elevation",
        value: elevation,
        min,
        max,
        unit: "rad",
    })
}

#[cfg(all(test, feature = "default-model"))]
mod tests {
    use super::*;
    use crate::BakedSky;

    /// Off the middles, at suns that were not compared.
    #[test]
    fn blends_are_the_skies_in_between() {
        let model = Model::default_model().unwrap();
        for (altitude, visibility) in [(0.0, 40e3), (9e3, 80e3)] {
            let conditions = Conditions {
                altitude,
                visibility,
                ..Conditions::default()
            };
            let elevations = [-0.11, 0.3];
            let course = model
                .sun_course(&conditions, elevations, BakedSky::TOLERANCE)
                .unwrap();
            println!("{} skies, {} bytes", course.skies(), course.bytes());
            let mut worst = 0f64;
            for k in 0..40 {
                let elevation = elevations[0] + 0.41 * (k as f64 + 0.37) / 40.0;
                let conditions = Conditions {
                    solar_elevation: elevation,
                    ..conditions
                };
                let sky = model.colour_sky(&conditions).unwrap();
                let truth = sky.bake(BakedSky::TOLERANCE).unwrap();
                let error = course.differences(&truth).unwrap();
                worst = worst.max(error.p95);
                assert!(error.p95 < BakedSky::TOLERANCE, "{elevation} {error:?}");
            }
            println!("worst p95 {worst:.5}");
        }
    }

    #[test]
    fn nodes_are_the_baked_skies_and_bad_suns_are_refused() {
        let model = Model::default_model().unwrap();
        let conditions = Conditions::default();
        let course = model
            .sun_course(&conditions, [0.5, 0.8], BakedSky::TOLERANCE)
            .unwrap();
        let error = course.differences(&course.skies[1]).unwrap();
        assert_eq!(error.max, 0.0);
        let mut sky = course.at(0.6, 1.0).unwrap();
        let before = sky.xyz([0.3, 0.1, 0.9]).unwrap();
        for (elevation, azimuth) in [(0.4, 0.0), (0.9, 0.0), (f64::NAN, 0.0), (0.6, f64::NAN)] {
            let error = course.write(elevation, azimuth, &mut sky).unwrap_err();
            assert!(matches!(error, Error::OutOfRange { .. }));
            assert_eq!(sky.xyz([0.3, 0.1, 0.9]).unwrap(), before);
        }
        for range in [
            [0.8, 0.5],
            [0.5, 0.5],
            [-0.5, 0.3],
            [0.5, 2.0],
            [f64::NAN, 0.5],
        ] {
            assert!(
                model
                    .sun_course(&conditions, range, BakedSky::TOLERANCE)
                    .is_err()
            );
        }
    }
}
