//! Hosek and Wilkie 2012, *An Analytic Model for Full Spectral Sky-Dome Radiance*, by the crate `hw-skymodel`, which
//! holds the authors' data for red, green and blue.

use hw_skymodel::rgb::{Channel, SkyParams, SkyState};

use super::colour::srgb_to_xyz;
use super::sky::{Observer, Sky, SkyModel};

/// lm W⁻¹: the data are radiances.
const EFFICACY: f32 = 683.0;

/// The model at one turbidity and albedo.
#[derive(Clone, Copy, Debug)]
pub struct Hosek {
    /// Optical thickness of molecules and particles over that of molecules.
    pub turbidity: f64,
    /// Of the ground.
    pub albedo: f32,
}

impl SkyModel for Hosek {
    fn sky(&self, observer: Observer) -> Option<Box<dyn Sky + '_>> {
        let state = SkyState::new(&SkyParams {
            elevation: observer.solar_elevation as f32,
            turbidity: self.turbidity as f32,
            albedo: [self.albedo; 3],
        });
        let sky = HosekSky {
            state: state.ok()?,
            sun: observer.sun(),
        };
        Some(Box::new(sky))
    }

    fn bytes(&self) -> usize {
        // Six control points of nine coefficients and a radiance for ten turbidities, two albedos and three colours.
        6 * (9 + 1) * 10 * 2 * 3 * size_of::<f32>()
    }
}

struct HosekSky {
    state: SkyState,
    sun: [f32; 3],
}

impl Sky for HosekSky {
    fn xyz(&self, direction: [f32; 3]) -> Option<[f32; 3]> {
        if direction[2] < 0.0 {
            return None;
        }
        let cosine = (0..3).map(|i| direction[i] * self.sun[i]).sum::<f32>();
        let (theta, gamma) = (direction[2].min(1.0).acos(), cosine.clamp(-1.0, 1.0).acos());
        let channels = [Channel::R, Channel::G, Channel::B];
        let rgb = channels.map(|c| EFFICACY * self.state.radiance(theta, gamma, c));
        Some(srgb_to_xyz(rgb))
    }

    fn bytes(&self) -> usize {
        size_of::<Self>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Red, green and blue of another reader of the authors' data: `sunsky` of Mitsuba 3.9 (`scalar_rgb`, turbidity 3,
    /// albedo 0.2, no sun), at solar elevation, zenith angle and azimuth in degrees. It divides by the integral of the
    /// luminous efficiency function, 106.857 nm.
    #[test]
    fn it_is_that_of_another_reader() {
        let model = Hosek {
            turbidity: 3.0,
            albedo: 0.2,
        };
        for ([elevation, zenith, azimuth], expected) in [
            ([60.0f64, 5.0f64, 90.0f64], [0.0346231, 0.0532377, 0.10054]),
            ([60.0, 80.0, 180.0], [0.0834626, 0.134677, 0.216412]),
            ([20.0, 55.0, 90.0], [0.025732, 0.0459703, 0.0756899]),
            ([5.0, 5.0, 90.0], [0.00671738, 0.0121455, 0.0182968]),
            ([5.0, 80.0, 180.0], [0.0680586, 0.0755943, 0.0612984]),
        ] {
            let sky = model
                .sky(Observer::on_the_ground(elevation.to_radians()))
                .unwrap();
            let (r, z) = zenith.to_radians().sin_cos();
            let (y, x) = azimuth.to_radians().sin_cos();
            let xyz = sky.xyz([r * x, r * y, z].map(|v| v as f32)).unwrap();
            let rgb = welkin::xyz_to_linear_srgb(xyz.map(|v| v / (EFFICACY * 106.857)));
            for (got, expected) in rgb.iter().zip(expected) {
                assert!(
                    (got / expected - 1.0).abs() < 0.01,
                    "{elevation} {zenith}: {rgb:?}"
                );
            }
        }
    }

    #[test]
    fn it_answers_by_day_above_the_horizon() {
        let model = Hosek {
            turbidity: 2.1,
            albedo: 0.2,
        };
        assert!(model.sky(Observer::on_the_ground(-0.01)).is_none());
        let sky = model.sky(Observer::on_the_ground(0.5)).unwrap();
        assert!(sky.xyz([0.0, 0.6, -0.8]).is_none());
        let zenith = sky.xyz([0.0, 0.0, 1.0]).unwrap();
        // cd m⁻²: the zenith of a clear sky by day has some thousands.
        assert!((1e3..1e4).contains(&zenith[1]), "{zenith:?}");
    }
}
