//! The coefficients that the models were published with.

use super::lanes::Lanes;
use super::medium::{Medium, ParticlePhase};
use super::shell::Shell;

/// Molecules per m² in a Dobson unit.
const DOBSON_UNIT: f64 = 2.687e20;
/// Half the thickness of the layers of ozone here, m.
const HALF_LAYER: f64 = 15e3;

/// The wavelengths that stand for red, green and blue, nm.
pub const RGB: [f64; 3] = [680.0, 550.0, 440.0];

/// Of Bruneton 2017, at any wavelengths (nm): Rayleigh scattering as λ⁻⁴, particles alike at all wavelengths with an
/// optical depth of 0.0053, 300 DU of ozone, albedo 0.1.
pub fn bruneton<const K: usize>(wavelengths: [f64; K]) -> Medium<K> {
    const MIE_HEIGHT: f64 = 1.2e3;
    let mie = 5.328e-3 / MIE_HEIGHT;
    Medium {
        shell: Shell {
            bottom: 6.36e6,
            top: 6.42e6,
        },
        rayleigh: Lanes(wavelengths.map(|nm| (1.24062e-6 * (1e-3 * nm).powi(-4)) as f32)),
        rayleigh_height: 8e3,
        mie_scattering: Lanes::splat((0.9 * mie) as f32),
        mie_extinction: Lanes::splat(mie as f32),
        mie_height: MIE_HEIGHT,
        g: 0.8,
        phase: ParticlePhase::CornetteShanks,
        ozone: ozone(wavelengths, 300.0),
        ozone_layer: [25e3, HALF_LAYER],
        albedo: 0.1,
        sun_radius: 0.004_675,
    }
}

/// Of Hillaire 2020, Table 1: red, green and blue. Albedo 0.3.
pub fn hillaire() -> Medium<3> {
    Medium {
        shell: Shell {
            bottom: 6.36e6,
            top: 6.46e6,
        },
        rayleigh: Lanes([5.802e-6, 13.558e-6, 33.1e-6]),
        rayleigh_height: 8e3,
        mie_scattering: Lanes::splat(3.996e-6),
        mie_extinction: Lanes::splat(3.996e-6 + 4.4e-6),
        mie_height: 1.2e3,
        g: 0.8,
        phase: ParticlePhase::CornetteShanks,
        ozone: Lanes([0.65e-6, 1.881e-6, 0.085e-6]),
        ozone_layer: [25e3, HALF_LAYER],
        albedo: 0.3,
        sun_radius: 0.0,
    }
}

/// Of the single-scattering sky in Blender 2.90 to 4.5 with all densities at 1: molecules of a refractive index of
/// 1.0002926, particles alike at all wavelengths, 300 DU of ozone. Nothing comes from the ground.
pub fn blender<const K: usize>(wavelengths: [f64; K]) -> Medium<K> {
    Medium {
        shell: Shell {
            bottom: 6.36e6,
            top: 6.42e6,
        },
        rayleigh: Lanes(wavelengths.map(|nm| refraction_scattering(nm) as f32)),
        rayleigh_height: 8e3,
        mie_scattering: Lanes::splat(2e-5),
        // Its extinction counts a tenth more than what is scattered.
        mie_extinction: Lanes::splat(1.11 * 2e-5),
        mie_height: 1.2e3,
        g: 0.76,
        phase: ParticlePhase::CornetteShanks,
        ozone: ozone(wavelengths, 300.0),
        ozone_layer: [25e3, HALF_LAYER],
        albedo: 0.0,
        sun_radius: 0.0,
    }
}

/// `8π³(n² − 1)²/(3Nλ⁴)`, m⁻¹.
fn refraction_scattering(nm: f64) -> f64 {
    const REFRACTIVE_INDEX: f64 = 1.000_292_6;
    const MOLECULES: f64 = 2.504e25;
    let contrast = (REFRACTIVE_INDEX * REFRACTIVE_INDEX - 1.0).powi(2);
    8.0 * std::f64::consts::PI.powi(3) * contrast / (3.0 * MOLECULES * (1e-9 * nm).powi(4))
}

/// Absorption of so many Dobson units in a tent-shaped layer, where it is densest, m⁻¹. Cross sections at 223 K of
/// Serdyuchenko et al. 2014.
fn ozone<const K: usize>(wavelengths: [f64; K], units: f64) -> Lanes<K> {
    let density = units * DOBSON_UNIT / HALF_LAYER;
    Lanes(wavelengths.map(|nm| (density * super::spectra::ozone(nm)) as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blenders_molecules_are_those_of_its_source() {
        // First and last of the table in its source, 380 and 780 nm.
        assert!((refraction_scattering(380.0) / 5.424_820e-5 - 1.0).abs() < 2e-4);
    }

    #[test]
    fn formulas_and_tables_of_red_green_and_blue_agree() {
        // Hillaire's numbers are those of Bruneton's formulas at 680, 550 and 440 nm.
        let (a, b) = (bruneton(RGB), hillaire());
        for k in 0..3 {
            assert!((a.rayleigh.0[k] / b.rayleigh.0[k] - 1.0).abs() < 3e-3);
            // Cross sections of others, averaged over other bands: 1.758 and 1.881e-6 in the green.
            assert!((a.ozone.0[k] - b.ozone.0[k]).abs() < 0.13e-6, "{k}");
        }
    }
}
