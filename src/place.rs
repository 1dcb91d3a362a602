//! Places on a planet: from a world frame to the local frame of an observer, and back.

use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::geometry::Planet;
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;
#[cfg(feature = "std")]
use crate::polarisation::PolarisationFrame;

/// A place on or above the planet, with its local frame: the one that [`Conditions`], directions of skies and of
/// [`PointQuery`](crate::PointQuery), points of [`Transmittance`](crate::Transmittance) and
/// [`AerialPerspective`](crate::AerialPerspective), and [`PolarisationFrame::Axis`] are meant in.
///
/// The world frame is the caller's: any axes, any origin, metres, the planet's centre where the caller says. The local
/// frame has +z away from the centre and its origin on the ground below the place; +x and +y are those of the world
/// carried along the great circle from where +z of the world is up, so that they turn smoothly everywhere but opposite
/// to that. The local frame of a place with the up of the world is the world's, but for the origin.
///
/// ```
/// use welkin::{Conditions, Place};
/// use welkin::geometry::Planet;
///
/// let planet = Planet { radius: 6_378_000.0, top: 100_000.0 };
/// // 2 km above the equator, in a frame with the planet's centre in the origin.
/// let place = Place::new(&planet, [0.0; 3], [0.0, 6_380_000.0, 0.0])?;
/// let sun = [0.0, 0.6, 0.8];
/// let conditions = place.conditions(sun, &Conditions::default())?;
/// assert!((conditions.altitude - 2000.0).abs() < 1e-6);
/// assert!((conditions.solar_elevation - 0.6f64.asin()).abs() < 1e-12);
/// // A view direction of the world, to be asked of a sky with these conditions.
/// let up = place.direction([0.0, 2.0, 0.0]);
/// assert_eq!(up, [0.0, 0.0, 2.0]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    radius: f64,
    centre: [f64; 3],
    altitude: f64,
    axes: [[f64; 3]; 3],
}

impl Place {
    /// The place at `position` on a planet with its centre in `centre`, both in world coordinates, m. The frame of
    /// [`AerialPerspective`](crate::AerialPerspective) has its centre in (0, 0, −R). In the centre itself, up is +z of
    /// the world.
    ///
    /// # Errors
    /// [`Error::Point`] for coordinates that are not finite or beyond 10⁹ m.
    pub fn new(planet: &Planet, centre: [f64; 3], position: [f64; 3]) -> Result<Self> {
        for point in [centre, position] {
            if !point.iter().all(|v| v.abs() <= FARTHEST) {
                return Err(Error::Point { got: point });
            }
        }
        let from_centre: [f64; 3] = core::array::from_fn(|i| position[i] - centre[i]);
        let distance = dot(from_centre, from_centre).sqrt();
        let up = match distance > 0.0 {
            true => from_centre.map(|v| v / distance),
            false => [0.0, 0.0, 1.0],
        };
        Ok(Self {
            radius: planet.radius,
            centre,
            altitude: distance - planet.radius,
            axes: carried(up),
        })
    }

    /// Height above the sphere, m; negative below it.
    pub fn altitude(&self) -> f64 {
        self.altitude
    }

    /// Unit vectors along +x, +y and +z (up) of the local frame, in the world.
    pub fn axes(&self) -> [[f64; 3]; 3] {
        self.axes
    }

    /// A vector of the world in the local frame: directions, axes of polarisation. Keeps its length.
    pub fn to_local(&self, world: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, world))
    }

    /// A vector of the local frame in the world.
    pub fn to_world(&self, local: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.axes;
        core::array::from_fn(|i| x[i] * local[0] + y[i] * local[1] + z[i] * local[2])
    }

    /// [`Place::to_local`] as skies take directions.
    pub fn direction(&self, world: [f64; 3]) -> [f32; 3] {
        self.to_local(world).map(|v| v as f32)
    }

    /// A point of the world (m) in the local frame, as [`Transmittance`](crate::Transmittance) and a
    /// [`AerialPerspective`](crate::AerialPerspective) that is prepared here take points: relative to the ground below
    /// the place.
    pub fn point_to_local(&self, world: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.to_local(core::array::from_fn(|i| world[i] - self.centre[i]));
        [x, y, z - self.radius]
    }

    /// A point of the local frame (m) in the world.
    pub fn point_to_world(&self, local: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = local;
        let from_centre = self.to_world([x, y, z + self.radius]);
        core::array::from_fn(|i| self.centre[i] + from_centre[i])
    }

    /// The conditions here: those of `elsewhere` with the altitude of the place and the local elevation and azimuth of
    /// a sun in this direction of the world (need not be normalised). The azimuth of a vertical sun is 0. Whether a
    /// model reaches that far is said by whoever is asked.
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite.
    pub fn conditions(&self, sun: [f64; 3], elsewhere: &Conditions) -> Result<Conditions> {
        let [x, y, z] = self.to_local(scaled(sun)?);
        let level = (x * x + y * y).sqrt();
        Ok(Conditions {
            altitude: self.altitude,
            solar_elevation: z.atan2(level),
            solar_azimuth: if level > 0.0 { y.atan2(x) } else { 0.0 },
            ..*elsewhere
        })
    }

    /// The place where a ray from here in a direction of the world (need not be normalised) first comes down to an
    /// altitude (m): where a camera beyond the air asks for the sky, with [`Place::conditions`] and
    /// [`Place::direction`] of that place. This place itself where it is not above the altitude; none where the ray
    /// does not come so low.
    ///
    /// # Errors
    /// [`Error::Direction`] for a vector that is zero or not finite.
    ///
    /// ```
    /// use welkin::{Conditions, Model, Place, PointQuery};
    ///
    /// let model = Model::default_model()?;
    /// let planet = model.head().planet;
    /// let [_, ceiling] = model.altitude_range();
    /// let camera = Place::new(&planet, [0.0; 3], [0.0, 0.0, planet.radius + 400e3])?;
    /// // Through the air above the horizon, which is 20° below the horizontal.
    /// let (ray, sun) = ([0.943, 0.0, -0.334], [0.0, 0.6, 0.8]);
    /// let entry = camera.entry(ray, ceiling)?.expect("a ray that meets the air");
    /// let conditions = entry.conditions(sun, &Conditions::default())?;
    /// let query = PointQuery::new(welkin::DEFAULT_MODEL)?;
    /// let mut radiance = vec![0.0; model.wavelengths().len()];
    /// query.radiance(&conditions, entry.direction(ray), &mut radiance)?;
    /// assert!(camera.entry([1.0, 0.0, 0.0], ceiling)?.is_none());
    /// # Ok::<(), welkin::Error>(())
    /// ```
    pub fn entry(&self, direction: [f64; 3], altitude: f64) -> Result<Option<Self>> {
        let unit = unit(direction)?;
        if self.altitude <= altitude {
            return Ok(Some(*self));
        }
        let [_, _, up] = self.axes;
        let (here, there) = (self.radius + self.altitude, self.radius + altitude);
        let sine = dot(up, unit);
        // The squared distance of the line from the centre, without the cancellation of 1 − sin².
        let across: [f64; 3] = core::array::from_fn(|i| unit[i] - sine * up[i]);
        let nearest = here * dot(across, across).sqrt();
        if sine >= 0.0 || nearest > there || there <= 0.0 {
            return Ok(None);
        }
        let half = ((there - nearest) * (there + nearest)).sqrt();
        let distance = (here - there) * (here + there) / (half - here * sine);
        let from_centre: [f64; 3] = core::array::from_fn(|i| here * up[i] + distance * unit[i]);
        let length = dot(from_centre, from_centre).sqrt();
        Ok(Some(Self {
            altitude,
            axes: carried(from_centre.map(|v| v / length)),
            ..*self
        }))
    }

    /// The polarisation frame with this axis of the world: the up vector of a camera, say.
    #[cfg(feature = "std")]
    pub fn frame(&self, axis: [f64; 3]) -> PolarisationFrame {
        PolarisationFrame::Axis(self.direction(axis))
    }
}

/// A vector of which the largest component is 1 in size.
fn scaled(vector: [f64; 3]) -> Result<[f64; 3]> {
    let largest = vector.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    if !(largest > 0.0 && vector.iter().all(|v| v.is_finite())) {
        let got = vector.map(|v| v as f32);
        return Err(Error::Direction { got });
    }
    Ok(vector.map(|v| v / largest))
}

/// A unit vector.
fn unit(vector: [f64; 3]) -> Result<[f64; 3]> {
    let scaled = scaled(vector)?;
    let length = dot(scaled, scaled).sqrt();
    Ok(scaled.map(|v| v / length))
}

/// Farther out there is nothing.
const FARTHEST: f64 = 1e9;

/// The axes of the world, turned by the shortest way so that +z becomes `up`.
fn carried(up: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y, z] = up;
    let level = x * x + y * y;
    // 1 / (1 + z), without the cancellation on the far side; there any turn is the shortest.
    let share = match z > 0.0 {
        true => 1.0 / (1.0 + z),
        false if level > 0.0 => (1.0 - z) / level,
        false => return [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], up],
    };
    let mixed = -x * y * share;
    [
        [1.0 - x * x * share, mixed, -x],
        [mixed, 1.0 - y * y * share, -y],
        up,
    ]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    const EARTH: Planet = Planet {
        radius: 6_378_000.0,
        top: 100_000.0,
    };

    #[test]
    fn axes_are_orthonormal_everywhere() {
        let mut ups = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1e-170, 0.0, -1.0]];
        for i in 0..500 {
            let z = 1.0 - f64::from(i) * 0.004;
            let level = (1.0 - z * z).max(0.0).sqrt();
            let (y, x) = (2.4 * f64::from(i)).sin_cos();
            ups.push([level * x, level * y, z]);
            ups.push([1e-9 * x, 1e-9 * y, -1.0]);
        }
        for up in ups {
            let place = Place::new(&EARTH, [0.0; 3], up.map(|v| v * EARTH.radius)).unwrap();
            let [x, y, z] = place.axes();
            for (a, b, expected) in [(x, x, 1.0), (y, y, 1.0), (z, z, 1.0), (x, y, 0.0)] {
                assert!((dot(a, b) - expected).abs() < 1e-12, "{up:?}");
            }
            assert!(dot(x, z).abs() < 1e-12 && dot(y, z).abs() < 1e-12);
            // Right-handed.
            let cross = x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
                + x[2] * (y[0] * z[1] - y[1] * z[0]);
            assert!((cross - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn points_and_vectors_come_back() {
        let centre = [10.0, -2e5, -EARTH.radius];
        let place = Place::new(&EARTH, centre, [3e6, 1e6, 8e5]).unwrap();
        let point = [3.1e6, 0.9e6, 7.5e5];
        let local = place.point_to_local(point);
        let back = place.point_to_world(local);
        assert!((0..3).all(|i| (back[i] - point[i]).abs() < 1e-7));
        let own = place.point_to_local([3e6, 1e6, 8e5]);
        assert!(own[0].abs() < 1e-7 && own[1].abs() < 1e-7);
        assert!((own[2] - place.altitude()).abs() < 1e-7);
        let vector = [0.3, -0.2, 7.0];
        let back = place.to_world(place.to_local(vector));
        assert!((0..3).all(|i| (back[i] - vector[i]).abs() < 1e-12));
    }

    #[test]
    fn the_frame_of_an_aerial_perspective_is_its_own() {
        let place = Place::new(&EARTH, [0.0, 0.0, -EARTH.radius], [0.0, 0.0, 300.0]).unwrap();
        assert_eq!(
            place.axes(),
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        );
        assert_eq!(place.altitude(), 300.0);
        assert_eq!(place.point_to_local([5.0, 6.0, 300.0]), [5.0, 6.0, 300.0]);
    }

    #[test]
    fn rays_enter_where_they_first_come_down() {
        let height = 4e5;
        let centre = [5e5, 0.0, -3e6];
        let up = [0.6, 0.0, 0.8];
        let position = core::array::from_fn(|i| centre[i] + up[i] * (EARTH.radius + height));
        let camera = Place::new(&EARTH, centre, position).unwrap();
        let ceiling = 99e3;
        let mut met = 0;
        for i in 0..2000 {
            let z = 1.0 - f64::from(i) * 0.001;
            let level = (1.0 - z * z).max(0.0).sqrt();
            let (y, x) = (2.4 * f64::from(i)).sin_cos();
            let ray = camera.to_world([2.0 * level * x, 2.0 * level * y, 2.0 * z]);
            let Some(entry) = camera.entry(ray, ceiling).unwrap() else {
                // Above the horizon of that sphere.
                let lowest = (EARTH.radius + height) * level;
                assert!(z >= 0.0 || lowest > EARTH.radius + ceiling);
                continue;
            };
            met += 1;
            assert_eq!(entry.altitude(), ceiling);
            let point = entry.point_to_world([0.0, 0.0, ceiling]);
            // On the ray, and coming down.
            let path: [f64; 3] = core::array::from_fn(|i| point[i] - position[i]);
            let along = dot(path, ray) / 2.0;
            let off: f64 = (0..3)
                .map(|i| (path[i] - along * ray[i] / 2.0).powi(2))
                .sum();
            assert!(along > 0.0 && off.sqrt() < 1e-3, "{off}");
            assert!(entry.to_local(ray)[2] <= 1e-9);
        }
        assert!(met > 500);
        let inside = camera.entry([0.0, 0.0, 1.0], 5e5).unwrap().unwrap();
        assert_eq!(inside, camera);
        assert!(camera.entry([0.0; 3], ceiling).is_err());
        assert!(camera.entry([f64::NAN, 0.0, 1.0], ceiling).is_err());
    }

    #[test]
    fn what_is_no_place_and_no_direction_is_refused() {
        for bad in [f64::NAN, f64::INFINITY, 1.1e9] {
            assert!(Place::new(&EARTH, [0.0; 3], [0.0, bad, 1.0]).is_err());
            assert!(Place::new(&EARTH, [bad, 0.0, 0.0], [1.0; 3]).is_err());
        }
        let centre = Place::new(&EARTH, [0.0; 3], [0.0; 3]).unwrap();
        assert_eq!(centre.altitude(), -EARTH.radius);
        for sun in [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 1.0]] {
            let refused = centre.conditions(sun, &Conditions::default());
            assert!(matches!(refused, Err(Error::Direction { .. })));
        }
        let tiny = centre.conditions([0.0, 1e-300, 0.0], &Conditions::default());
        assert_eq!(tiny.unwrap().solar_elevation, 0.0);
    }
}
