//! Air as the models of games and films have it: molecules and particles that thin out exponentially, ozone in a layer
//! shaped like a tent.

use super::lanes::Lanes;
use super::shell::Shell;

/// Coefficients (m⁻¹) at `K` wavelengths and profiles of them.
#[derive(Clone, Copy, Debug)]
pub struct Medium<const K: usize> {
    /// Ground and end of the air.
    pub shell: Shell,
    /// Scattering by molecules at the ground.
    pub rayleigh: Lanes<K>,
    /// Over which molecules thin out by e, m.
    pub rayleigh_height: f64,
    /// Scattering by particles at the ground.
    pub mie_scattering: Lanes<K>,
    /// Extinction by particles at the ground.
    pub mie_extinction: Lanes<K>,
    /// Over which particles thin out by e, m.
    pub mie_height: f64,
    /// Asymmetry of the particles' phase function.
    pub g: f32,
    /// Which one that is.
    pub phase: ParticlePhase,
    /// Absorption by ozone where it is densest.
    pub ozone: Lanes<K>,
    /// Altitude of that, and half the width of the layer, m.
    pub ozone_layer: [f64; 2],
    /// Of the ground.
    pub albedo: f32,
    /// Angular radius of the sun, 0 for a point, radians.
    pub sun_radius: f64,
}

/// The form of the particles' phase function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParticlePhase {
    /// Cornette and Shanks 1992, as published with these models. Its mean cosine is larger than `g`.
    CornetteShanks,
    /// Henyey and Greenstein 1941, whose mean cosine is `g`, as the air of the default model has it.
    HenyeyGreenstein,
}

impl<const K: usize> Medium<K> {
    /// Phase function of the particles, sr⁻¹.
    pub fn mie_phase(&self, cosine: f32) -> f32 {
        match self.phase {
            ParticlePhase::CornetteShanks => cornette_shanks(self.g, cosine),
            ParticlePhase::HenyeyGreenstein => henyey_greenstein(self.g, cosine),
        }
    }

    /// Of molecules, particles and ozone, relative to where they are densest.
    pub fn densities(&self, altitude: f64) -> [f32; 3] {
        let [centre, half_width] = self.ozone_layer;
        [
            (-altitude / self.rayleigh_height).exp() as f32,
            (-altitude / self.mie_height).exp() as f32,
            (1.0 - (altitude - centre).abs() / half_width).max(0.0) as f32,
        ]
    }

    /// The same without the air above an altitude, m.
    pub fn below(mut self, altitude: f64) -> Self {
        self.shell.top = self.shell.top.min(self.shell.bottom + altitude);
        self
    }

    /// All that is lost per metre.
    pub fn extinction(&self, [molecules, particles, ozone]: [f32; 3]) -> Lanes<K> {
        self.rayleigh * molecules + self.mie_extinction * particles + self.ozone * ozone
    }

    /// Altitude of a point.
    pub fn altitude(&self, r: f64) -> f64 {
        r - self.shell.bottom
    }

    /// Optical depth of a straight line, by the trapezoidal rule.
    pub fn optical_depth(&self, r: f64, mu: f64, distance: f64, steps: usize) -> Lanes<K> {
        let step = distance / steps as f64;
        let mut columns = [0.0f64; 3];
        for i in 0..=steps {
            let weight = if i == 0 || i == steps { 0.5 } else { 1.0 };
            let (there, _) = self.shell.advanced(r, mu, step * i as f64);
            let densities = self.densities(self.altitude(there));
            for (column, density) in columns.iter_mut().zip(densities) {
                *column += weight * step * f64::from(density);
            }
        }
        self.extinction(columns.map(|c| c as f32))
    }

    /// Vertical optical depths of molecules, particles and ozone from the ground up.
    pub fn vertical(&self) -> [Lanes<K>; 3] {
        let thickness = self.shell.top - self.shell.bottom;
        let column = |height: f64| (height * (1.0 - (-thickness / height).exp())) as f32;
        let [centre, half_width] = self.ozone_layer;
        assert!(centre >= half_width && centre + half_width <= thickness);
        [
            self.rayleigh * column(self.rayleigh_height),
            self.mie_extinction * column(self.mie_height),
            self.ozone * half_width as f32,
        ]
    }
}

/// Of molecules, sr⁻¹.
pub fn rayleigh_phase(cosine: f32) -> f32 {
    3.0 / (16.0 * std::f32::consts::PI) * (1.0 + cosine * cosine)
}

fn cornette_shanks(g: f32, cosine: f32) -> f32 {
    let scale = 1.5 * (1.0 + cosine * cosine) / (2.0 + g * g);
    scale * henyey_greenstein(g, cosine)
}

fn henyey_greenstein(g: f32, cosine: f32) -> f32 {
    let base = 1.0 + g * g - 2.0 * g * cosine;
    (1.0 - g * g) / (4.0 * std::f32::consts::PI * base * base.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean over the sphere of a phase function, times 4π.
    fn total(phase: impl Fn(f32) -> f32) -> f64 {
        let n = 200_000;
        let cosine = |i: usize| -1.0 + 2.0 * (i as f64 + 0.5) / n as f64;
        let sum: f64 = (0..n).map(|i| f64::from(phase(cosine(i) as f32))).sum();
        4.0 * std::f64::consts::PI * sum / n as f64
    }

    #[test]
    fn phase_functions_lose_no_light() {
        assert!((total(rayleigh_phase) - 1.0).abs() < 1e-5);
        for g in [0.0, 0.65, 0.76, 0.8] {
            assert!((total(|c| cornette_shanks(g, c)) - 1.0).abs() < 1e-4, "{g}");
            assert!(
                (total(|c| henyey_greenstein(g, c)) - 1.0).abs() < 1e-4,
                "{g}"
            );
            assert!((total(|c| c * henyey_greenstein(g, c)) - f64::from(g)).abs() < 1e-4);
        }
    }

    #[test]
    fn vertical_columns_are_what_the_profiles_integrate_to() {
        let medium = crate::peers::published::bruneton::<3>([680.0, 550.0, 440.0]);
        let height = medium.shell.top - medium.shell.bottom;
        let traced = medium.optical_depth(medium.shell.bottom, 1.0, height, 200_000);
        let [molecules, particles, ozone] = medium.vertical();
        let sum = molecules + particles + ozone;
        for (a, b) in traced.0.iter().zip(sum.0) {
            assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
        }
    }
}
