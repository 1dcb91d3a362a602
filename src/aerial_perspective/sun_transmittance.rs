//! Sunlight at points: how high the disc stands above the planet's edge, and the air that it crosses.

use super::path_points::{BATCH, PathPoints};
use crate::geometry::Planet;
use crate::kernel::lanes::Lanes;
use crate::kernel::math::{LANES, bound, sqrt};
use crate::sun::SOLAR_ANGULAR_RADIUS;
use crate::transmittance::{Layers, QUADS};
use crate::visible_disc::visible_rise;

type Heights = Lanes<BATCH>;
/// Columns at two places: four constituents at the one, then at the other.
pub(crate) type Two = [Lanes<8>; QUADS];

/// Columns towards the sun, wherever it stands above the horizon.
#[derive(Clone, Debug)]
pub(crate) struct Beam {
    /// Highest angle above the geometric horizon in the table, rad.
    highest: f64,
    top: f64,
    /// Vectors per node.
    quads: usize,
    /// Logarithms, `[altitude][angle][vector]`.
    columns: Vec<[f32; LANES]>,
}

/// Angles above the horizon, ever closer towards it.
const ANGLES: usize = 256;
/// Altitudes, ever closer towards the ground.
const ALTITUDES: usize = 121;
/// Added to columns before the logarithm, m: less is nothing.
const NOTHING: f32 = 1e-3;

impl Beam {
    pub fn new(layers: &Layers) -> Self {
        let planet = layers.planet();
        let highest = core::f64::consts::FRAC_PI_2 + planet.dip(planet.top);
        let columns = |node: usize| {
            let h = planet.top * share(node / ANGLES, ALTITUDES).powi(2);
            let angle = highest * share(node % ANGLES, ANGLES).powi(2);
            // What is beyond the zenith of low observers is never looked up but for interpolation.
            let columns = layers.to_space(h, (angle - planet.dip(h)).sin());
            let logarithms = |column: [f32; LANES]| column.map(|c| (c + NOTHING).ln());
            columns.0.into_iter().take(layers.quads).map(logarithms)
        };
        Self {
            highest,
            top: planet.top,
            quads: layers.quads,
            columns: (0..ALTITUDES * ANGLES).flat_map(columns).collect(),
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.columns.as_slice())
    }

    /// How many radii the sun's centre stands above the geometric horizon of each place; for the first `pairs` pairs of
    /// places, the columns towards the centroid of the visible share of the disc, m; towards the horizon where none is
    /// visible.
    #[inline(always)]
    pub fn at(
        &self,
        layers: &Layers,
        places: &PathPoints,
        pairs: usize,
        out: &mut [Two],
    ) -> Heights {
        let [dip, rise, angle] = heights(&layers.planet(), places);
        let spots = self.spots(places.altitude, angle);
        for (p, out) in out.iter_mut().enumerate().take(pairs) {
            let two = [2 * p, 2 * p + 1];
            if two.into_iter().all(|i| spots.tabulated[i]) {
                self.look_up(&spots, two, out);
                continue;
            }
            for (half, i) in two.into_iter().enumerate() {
                let sine = f64::from(angle.0[i] - dip.0[i]).sin();
                let altitude = f64::from(places.altitude.0[i].max(0.0));
                let columns = layers.to_space(altitude, sine);
                for (out, quad) in out.iter_mut().zip(&columns.0) {
                    out.0[4 * half..][..4].copy_from_slice(quad);
                }
            }
        }
        rise
    }

    /// Where in the table these altitudes (m) and angles above the horizon are.
    #[inline(always)]
    fn spots(&self, altitude: Heights, angle: Heights) -> Spots {
        let (highest, top) = (self.highest as f32, self.top as f32);
        let cell = |share: Heights, count: usize| {
            let u = share.map(|share| sqrt(bound(share, 0.0, 1.0))) * (count - 1) as f32;
            let (cell, index) = u.round_down(Heights::splat((count - 2) as f32));
            (u - cell, index)
        };
        let (t, i) = cell(altitude * (1.0 / top), ALTITUDES);
        let (s, j) = cell(angle * (1.0 / highest), ANGLES);
        let one = Heights::splat(1.0);
        Spots {
            node: core::array::from_fn(|k| (i[k] as usize * ANGLES + j[k] as usize) * self.quads),
            weight: [(one - t) * (one - s), (one - t) * s, t * (one - s), t * s],
            tabulated: core::array::from_fn(|k| {
                altitude.0[k] <= top && (0.0..=highest).contains(&angle.0[k])
            }),
        }
    }

    /// Interpolates the logarithms of two places between four nodes each.
    #[inline(always)]
    fn look_up(&self, spots: &Spots, [a, b]: [usize; 2], out: &mut Two) {
        let steps = [0, 1, ANGLES, ANGLES + 1].map(|step| step * self.quads);
        let rows = &self.columns;
        for (q, out) in out.iter_mut().enumerate().take(self.quads) {
            let mut sum = Lanes::splat(0.0);
            for (step, weight) in steps.iter().zip(&spots.weight) {
                let node = [a, b].map(|i| rows[spots.node[i] + step + q]);
                sum = sum + Lanes::join(node[0], node[1]) * Lanes::pair(weight.0[a], weight.0[b]);
            }
            *out = sum.exp();
        }
    }
}

/// Dip of the horizon (rad), height of the sun's centre above it (radii), and that of the visible share of the disc
/// (rad).
#[inline(always)]
fn heights(planet: &Planet, places: &PathPoints) -> [Heights; 3] {
    let dip = dips(planet, places.altitude.max(Heights::splat(0.0)));
    let rise = (places.sun.asin() + dip) * (1.0 / SOLAR_ANGULAR_RADIUS) as f32;
    [dip, rise, visible_rise(rise) * SOLAR_ANGULAR_RADIUS as f32]
}

/// Cells of the table and places in them.
struct Spots {
    node: [usize; BATCH],
    weight: [Heights; 4],
    tabulated: [bool; BATCH],
}

/// Angles of the geometric horizon below the horizontal at these altitudes (m), rad.
#[inline(always)]
fn dips(planet: &Planet, altitude: Heights) -> Heights {
    /// Up to which the series holds to 1e-8: some 200 km above the Earth.
    const LIMIT: f32 = 0.06;
    let per_radius = (1.0 / planet.radius) as f32;
    let square = altitude.map(|h| h * per_radius * (h * per_radius + 2.0));
    // The series of the arc tangent.
    let mut dips = square.map(|q| {
        let series = 1.0 - q * (1.0 / 3.0 - q * (0.2 - q * (1.0 / 7.0 - q * (1.0 / 9.0))));
        sqrt(q) * series
    });
    for i in 0..BATCH {
        if square.0[i] > LIMIT {
            dips.0[i] = planet.dip(f64::from(altitude.0[i])) as f32;
        }
    }
    dips
}

fn share(i: usize, count: usize) -> f64 {
    i as f64 / (count - 1) as f64
}

#[cfg(all(test, feature = "default-model"))]
mod tests {
    use super::*;
    use crate::visible_disc::mean_shares;
    use crate::{Conditions, Model};

    /// D of section 7.7, which is the transmittance towards one point, and the irradiance of the disc. Up to 760 nm they
    /// agree where more than a twentieth of the light comes through; run with --nocapture for the rest.
    #[test]
    fn sunlight_is_the_light_of_the_disc() {
        let model = Model::default_model().unwrap();
        let mut report = String::new();
        for altitude in [0.0, 2000.0, 12_000.0] {
            for above in [0.3, 1.0, 2.0, 4.0, 6.0, 10.0, 30.0, 80.0f64] {
                let elevation = above.to_radians() - model.head().planet.dip(altitude);
                let conditions = Conditions {
                    altitude,
                    solar_elevation: elevation,
                    ..Conditions::default()
                };
                let air = model.transmittance(conditions.visibility).unwrap();
                let beam = Beam::new(&air.layers);
                let places = PathPoints {
                    altitude: Lanes::splat(altitude as f32),
                    sun: Lanes::splat(elevation.sin() as f32),
                    ..PathPoints::default()
                };
                let mut columns = [[Lanes::splat(0.0); QUADS]; BATCH / 2];
                let rise = beam.at(&air.layers, &places, 1, &mut columns);
                let share = mean_shares(rise, rise, Lanes::splat(0.0)).0[0];
                let depth = |w: usize| -> f32 {
                    let column = |k: usize| columns[0][k / LANES].0[k % LANES];
                    let row = |k: usize| air.extinction.row(k, w / LANES)[w % LANES];
                    let constituents = model.head().constituents;
                    (0..constituents).map(|k| row(k) * column(k)).sum()
                };
                let sun = model.solar_disc(&conditions).unwrap();
                let n = sun.wavelengths().len();
                let [mut disc, mut centre] = [(); 2].map(|()| vec![0.0; n]);
                sun.irradiance(sun.direction(), &mut disc).unwrap();
                air.transmittance_to_space(
                    [0.0, 0.0, altitude],
                    sun.direction().map(f64::from),
                    &mut centre,
                )
                .unwrap();
                for w in [0, n / 2, 2 * n / 3, n - 1] {
                    let outside = model.head().solar_irradiance_at(sun.wavelengths()[w]) as f32;
                    let got = share * (-depth(w)).exp();
                    let [disc, centre] = [disc[w] / outside, centre[w]];
                    let nm = sun.wavelengths()[w];
                    if got > 0.05 && nm <= 760.0 {
                        // Up to 0.0036 of it is that of one point instead of the disc.
                        assert!((got / disc - 1.0).abs() < 0.0055, "{conditions:?} {nm} nm");
                        assert!((got / centre - 1.0).abs() < 0.002, "{conditions:?} {nm} nm");
                    }
                    report += &format!(
                        "{altitude:6} m, {above:4}° above the horizon, {nm} nm: D {got:.3e}, {:+.3} % of the disc, {:+.3} % of T towards its centre\n",
                        100.0 * (got / disc - 1.0),
                        100.0 * (got / centre - 1.0),
                    );
                }
            }
        }
        println!("{report}");
    }
}
