//! Where along a ray light is looked at: where it crosses the levels, where it is nearest to the ground, and where it
//! enters and leaves the shadow of the Earth. Stops come and go at the ends of a ray or out of others, so that nothing
//! jumps.

use super::sightline::Sightline;
use crate::format::EstimateView;
use crate::geometry::{Planet, Side};
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// Most stops: all levels down and up, both nearest points, both ends, and two for each ring.
pub(super) const MOST_STOPS: usize = 64;

/// The stops of a ray, outwards from the observer.
pub(super) struct Stops {
    pub count: usize,
    /// Distances from the observer, m.
    pub distance: [f64; MOST_STOPS],
    /// Of the observer from the point of the line that is nearest to the planet's centre, m.
    pub start: f64,
    /// Squared altitude of that point, m.
    pub lowest: f64,
    /// Component of the observer's place along the direction to the sun, m, and of the ray.
    pub sunwards: [f64; 2],
}

impl Stops {
    #[inline(always)]
    pub fn new(planet: &Planet, tables: &EstimateView, line: &Sightline) -> Self {
        let radius = planet.radius + line.altitude;
        let [sine, cosine] = line.ray;
        let start = radius * sine;
        let across = radius * cosine;
        let lowest = (across - planet.radius) * (across + planet.radius) / (2.0 * planet.radius);
        let towards = cosine * line.sun[1] * line.azimuth + sine * line.sun[0];
        let mut out = Self {
            count: 0,
            distance: [0.0; MOST_STOPS],
            start,
            lowest,
            sunwards: [radius * line.sun[0], towards],
        };
        out.push(0.0);
        out.levels(planet, tables, line);
        out.rings(planet, tables, radius);
        out
    }

    #[inline(always)]
    fn push(&mut self, distance: f64) {
        if let Some(slot) = self.distance.get_mut(self.count) {
            *slot = distance;
            self.count += 1;
        }
    }

    /// Stops at the levels that the ray crosses, and at its end.
    #[inline(always)]
    fn levels(&mut self, planet: &Planet, tables: &EstimateView, line: &Sightline) {
        let diameter = 2.0 * planet.radius;
        let (start, lowest) = (self.start, self.lowest);
        let reach = |z: f64| {
            ((planet.squared_altitude(z) - lowest) * diameter)
                .max(0.0)
                .sqrt()
        };
        let level = |l: usize| f64::from(tables.level[l].get());
        let last = tables.level.len() - 1;
        if start < 0.0 {
            let squared = |z: f64| planet.squared_altitude(z);
            for z in (1..=last).rev().map(level) {
                if z < line.altitude && squared(z) > lowest {
                    self.push((-start - reach(z)).max(0.0));
                }
            }
        }
        if line.side == Side::Down {
            // Of an observer on the ground rounding would leave a nanometre.
            let length = (-start - reach(0.0)).max(0.0);
            return self.push(if line.altitude > 0.0 { length } else { 0.0 });
        }
        if start < 0.0 {
            self.push(-start);
        }
        for z in (1..=last).map(level) {
            let above = match start < 0.0 {
                true => planet.squared_altitude(z) > lowest,
                false => z > line.altitude,
            };
            if above {
                self.push((reach(z) - start).max(0.0));
            }
        }
    }

    /// Stops on cylinders around the axis of the Earth's shadow, and where the ray is nearest to that axis, so that
    /// those of a cylinder that it touches come out of a stop: in order with the others.
    #[inline(always)]
    fn rings(&mut self, planet: &Planet, tables: &EstimateView, radius: f64) {
        let [place, along] = self.sunwards;
        let end = self.distance[self.count - 1];
        let steep = (1.0 - along) * (1.0 + along);
        if steep < 1e-9 || tables.ring.is_empty() {
            return;
        }
        let nearest = (place * along - self.start) / steep;
        self.insert(self.moved(nearest, end), end);
        let middle = (radius - place) * (radius + place);
        for ring in tables.ring {
            let ring = planet.radius + f64::from(ring.get());
            let square = nearest * nearest - (middle - ring * ring) / steep;
            if square > 0.0 {
                let half = square.sqrt();
                self.insert(self.moved(nearest - half, end), end);
                self.insert(self.moved(nearest + half, end), end);
            }
        }
    }

    /// On the day side of the Earth cylinders mean nothing: over 300 km their stops go home to the observer.
    #[inline(always)]
    fn moved(&self, distance: f64, end: f64) -> f64 {
        const PER_REACH: f64 = 1.0 / 300e3;
        let [place, along] = self.sunwards;
        let distance = distance.min(end);
        let t = ((place + distance * along) * PER_REACH).clamp(0.0, 1.0);
        distance * (1.0 - t * t * (3.0 - 2.0 * t))
    }

    /// A stop before the end.
    #[inline(always)]
    fn insert(&mut self, distance: f64, end: f64) {
        if !(distance > 0.0 && distance < end) || self.count == MOST_STOPS {
            return;
        }
        let mut i = self.count;
        while self.distance[i - 1] > distance {
            self.distance[i] = self.distance[i - 1];
            i -= 1;
        }
        self.distance[i] = distance;
        self.count += 1;
    }
}
