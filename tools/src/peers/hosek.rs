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

    #[test]
    fn it_answers_by_day_above_the_horizon() {
        let model = Hosek { turbidity: 2.1, albedo: 0.2 };
        assert!(model.sky(Observer::on_the_ground(-0.01)).is_none());
        let sky = model.sky(Observer::on_the_ground(0.5)).unwrap();
        assert!(sky.xyz([0.0, 0.6, -0.8]).is_none());
        let zenith = sky.xyz([0.0, 0.0, 1.0]).unwrap();
        // cd m⁻²: the zenith of a clear sky by day has some thousands.
        assert!((1e3..1e4).contains(&zenith[1]), "{zenith:?}");
    }
}
