//! A prepared sky with its polarisation.

use super::frame::{Aspect, PolarisationFrame};
use super::prepare_stokes::prepare;
use super::stokes::{Stokes, between};
use super::stokes_tables::{Block, Mix, Polarisation, limit_even};
use crate::conditions::Conditions;
use crate::error::Result;
use crate::format::Kind;
use crate::geometry::Ray;
use crate::ground::{BetweenGrounds, OverGround};
use crate::kernel::math::{LANES, finite};
use crate::model::{Model, Nodes};
use crate::phase_function::SunAngle;
use crate::sky::prepare::NodeWeights;
use crate::sky::{MOST_WAVELENGTHS, Sky, check_length};

/// A clear sky whose light is polarised, at one set of conditions.
///
/// Singly scattered light is polarised as Rayleigh scattering says; what was scattered more often comes from tables of
/// its own (Wilkie et al. 2021, section 5.2, but with both components). Everything that [`Sky`] says about directions
/// holds here, too.
///
/// After [`Model::polarised_sky`] returns, nothing here allocates, blocks or calls the system. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model, PolarisationFrame, Stokes};
///
/// let sky = Model::default_model()?.polarised_sky(&Conditions::default())?;
/// let mut out = vec![Stokes::default(); sky.sky().wavelengths().len()]; // W m⁻² sr⁻¹ nm⁻¹
/// sky.stokes([0.0, 0.5, 0.9], PolarisationFrame::Vertical, &mut out)?;
/// assert!(out.iter().all(|light| light.i > 0.0 && light.degree() < 1.0));
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PolarisedSky {
    sky: Sky,
    polarisation: Polarisation,
    over: Option<Box<OverPolarised>>,
}

/// Where the albedo of the ground depends on wavelength: what belongs to the other skies of [`Sky::over_ground`].
#[derive(Clone, Debug)]
struct OverPolarised {
    second: Polarisation,
    colour: Polarisation,
}

impl Model {
    /// Whether the file holds the polarisation of skylight.
    pub fn is_polarised(&self) -> bool {
        let mut kinds = self.directory().iter().map(|entry| entry.kind);
        kinds.any(|kind| kind == Kind::PolarisationBasis)
    }
}

impl PolarisedSky {
    /// As [`Sky::prepare`].
    pub(crate) fn prepare(
        model: &Model,
        nodes: Nodes,
        conditions: &Conditions,
        albedos: &[f64],
    ) -> Result<Self> {
        let conditions = conditions.checked(model)?;
        let place = NodeWeights::new(nodes.head, &conditions);
        let basis = (Kind::PolarisationBasis, None, None);
        let chunks = place.keys_of(Kind::Polarisation).chain([basis]);
        model.prefetch(place.keys().chain(chunks).chain(nodes.spectrum()))?;
        let sky = Sky::prepare(model, nodes, &conditions, albedos)?;
        let layout = &sky.tables().layout;
        let polarisation = prepare(model, nodes, &place, albedos, layout)?;
        Ok(Self {
            sky,
            polarisation,
            over: None,
        })
    }

    /// The same sky, where its ground has the albedo of `grounds`, with that over the second of these and the one for
    /// colours.
    pub(crate) fn with_ground(self, grounds: BetweenGrounds, second: Self, colour: Self) -> Self {
        Self {
            sky: self.sky.with_ground(OverGround {
                grounds,
                second: second.sky,
                colour: colour.sky,
            }),
            over: Some(Box::new(OverPolarised {
                second: second.polarisation,
                colour: colour.polarisation,
            })),
            ..self
        }
    }

    /// The sky over the other ground, where the albedo depends on wavelength.
    pub(crate) fn second(&self) -> Option<Self> {
        let (over, own) = (self.sky.over_ground()?, self.over.as_ref()?);
        Some(Self {
            sky: over.second.clone(),
            polarisation: own.second.clone(),
            over: None,
        })
    }

    /// The sky without its polarisation.
    pub fn sky(&self) -> &Sky {
        &self.sky
    }

    /// As [`Sky::set_solar_azimuth`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) if the azimuth is not finite.
    pub fn set_solar_azimuth(&mut self, azimuth: f64) -> Result<()> {
        self.sky.set_solar_azimuth(azimuth)
    }

    /// Memory that the sky holds on the heap, bytes: that of [`PolarisedSky::sky`] and half as much.
    pub fn bytes(&self) -> usize {
        let over = (self.over.as_ref()).map_or(0, |o| o.second.bytes() + o.colour.bytes());
        self.sky.bytes() + self.polarisation.bytes() + over
    }

    /// Stokes vectors in W m⁻² sr⁻¹ nm⁻¹ at each of [`Sky::wavelengths`], in the frame of the caller. Q² + U² ≤ I².
    ///
    /// # Errors
    /// [`Error::Direction`](crate::Error::Direction) for a direction or an axis that is zero or not finite;
    /// [`Error::Length`](crate::Error::Length) unless `out` has one element per wavelength.
    pub fn stokes(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        out: &mut [Stokes],
    ) -> Result<()> {
        check_length(out.len(), self.sky.wavelengths().len())?;
        let irradiance = &self.sky.tables().irradiance;
        self.evaluate(direction, frame, |block, light| {
            let i =
                core::array::from_fn(|l| (light.radiance[l] * irradiance[block][l]).min(f32::MAX));
            store(out, block, i, &light);
        })
    }

    /// Stokes vectors per unit of solar spectral irradiance, sr⁻¹; otherwise as [`PolarisedSky::stokes`].
    ///
    /// # Errors
    /// As [`PolarisedSky::stokes`].
    pub fn relative_stokes(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        out: &mut [Stokes],
    ) -> Result<()> {
        check_length(out.len(), self.sky.wavelengths().len())?;
        self.light().relative_stokes(direction, frame, out)
    }

    /// Light at the wavelengths of the sky.
    pub(crate) fn light(&self) -> PolarisedLight<'_> {
        PolarisedLight {
            sky: &self.sky,
            polarisation: &self.polarisation,
        }
    }

    /// Light at the wavelengths that colours are made of.
    pub(crate) fn colour_light(&self) -> PolarisedLight<'_> {
        let own = self.over.as_ref();
        PolarisedLight {
            sky: self.sky.coloured(),
            polarisation: own.map_or(&self.polarisation, |own| &own.colour),
        }
    }

    /// Stokes vector in W m⁻² sr⁻¹ nm⁻¹ at any wavelength (nm) within the range of the model.
    ///
    /// # Errors
    /// [`Error::Direction`](crate::Error::Direction); [`Error::OutOfRange`](crate::Error::OutOfRange) for the
    /// wavelength.
    pub fn stokes_at(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        wavelength: f64,
    ) -> Result<Stokes> {
        let i = self.sky.radiance_at(direction, wavelength)?;
        let mut values = [Stokes::default(); MOST_WAVELENGTHS];
        let mut relative = [0.0; MOST_WAVELENGTHS];
        let nodes = self.sky.wavelengths().len();
        let (values, relative) = (&mut values[..nodes], &mut relative[..nodes]);
        self.evaluate(direction, frame, |block, light| {
            store(values, block, [1.0; LANES], &light);
            let out = relative[block * LANES..].iter_mut();
            out.zip(light.radiance).for_each(|(out, l)| *out = l);
        })?;
        self.blend(direction, frame, wavelength, (values, relative))?;
        let shares = self.sky.interpolation().shares(relative, wavelength);
        Ok(between(&shares, values, i))
    }

    /// Light at the nodes as it is over the ground of a wavelength: radiance, and what is polarised of its unit.
    fn blend(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        wavelength: f64,
        (values, relative): (&mut [Stokes], &mut [f32]),
    ) -> Result<()> {
        let (Some(over), Some(own)) = (self.sky.over_ground(), &self.over) else {
            return Ok(());
        };
        let mut second = [Stokes::default(); MOST_WAVELENGTHS];
        let light = PolarisedLight {
            sky: &over.second,
            polarisation: &own.second,
        };
        light.relative_stokes(direction, frame, &mut second[..values.len()])?;
        let shares = over.grounds.shares(wavelength);
        let lights = values.iter_mut().zip(relative).zip(&second);
        for (((part, whole), second), share) in lights.zip(shares) {
            let first = *whole;
            *whole = (first + share * (second.i - first)).max(0.0);
            let over = whole.max(f32::MIN_POSITIVE);
            let mix = |first: f32, second: f32| (first + share * (second - first)) / over;
            part.q = mix(first * part.q, second.q);
            part.u = mix(first * part.u, second.u);
        }
        Ok(())
    }

    /// CIE 1931 X, Y and Z of the radiance and of what is polarised of it; Y in cd m⁻².
    ///
    /// # Errors
    /// [`Error::Direction`](crate::Error::Direction) for a direction or an axis that is zero or not finite.
    pub fn xyz(&self, direction: [f32; 3], frame: PolarisationFrame) -> Result<[Stokes; 3]> {
        let mut sums = [Stokes::default(); 3];
        let own = self.colour_light();
        let weights = &own.sky.tables().xyz;
        own.evaluate(direction, frame, |block, light| {
            for (sum, weight) in sums.iter_mut().zip(&weights[block]) {
                for (lane, weight) in weight.iter().enumerate() {
                    let i = weight * light.radiance[lane];
                    sum.i += i;
                    sum.q += i * light.q[lane];
                    sum.u += i * light.u[lane];
                }
            }
        })?;
        Ok(sums.map(|sum| Stokes {
            i: finite(sum.i),
            q: finite(sum.q),
            u: finite(sum.u),
        }))
    }

    /// Relative radiance, Q/I and U/(I sin φ) in the vertical frame towards a ray, φ its azimuth from the sun (0..=π),
    /// handed to `emit` block by block of wavelengths. Even in φ, at most the whole light, and smooth where that is no limit.
    pub(crate) fn ratios(
        &self,
        ray: &Ray,
        phi: f64,
        angle: SunAngle,
        mut emit: impl FnMut(usize, [f32; LANES], [[f32; LANES]; 2]),
    ) {
        let tables = self.sky.tables();
        let line = self.sky.sightline_at(ray, phi);
        let lookup = tables.lookup((ray, &line), phi, self.sky.phi_intervals(), angle);
        let aspect = Aspect::along(
            self.sky.cylinder(ray),
            phi,
            self.sky.conditions().solar_elevation,
        );
        let mix = Mix {
            single: aspect.single_even().map(|v| v as f32),
            from_q: [1.0, 0.0],
            from_u: [0.0, 1.0],
        };
        let sine = phi.sin() as f32;
        self.polarisation
            .ratios(tables, &lookup, &mix, |block, radiance, [q, u]| {
                emit(block, radiance, limit_even(q, u, sine));
            });
    }

    #[inline(always)]
    fn evaluate(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        emit: impl FnMut(usize, Block),
    ) -> Result<()> {
        self.light().evaluate(direction, frame, emit)
    }
}

/// A sky at its wavelengths, whatever it is part of.
#[derive(Clone, Copy)]
pub(crate) struct PolarisedLight<'a> {
    sky: &'a Sky,
    polarisation: &'a Polarisation,
}

impl PolarisedLight<'_> {
    /// As [`PolarisedSky::relative_stokes`].
    pub fn relative_stokes(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        out: &mut [Stokes],
    ) -> Result<()> {
        self.evaluate(direction, frame, |block, light| {
            store(out, block, light.radiance, &light);
        })
    }

    #[inline(always)]
    fn evaluate(
        &self,
        direction: [f32; 3],
        frame: PolarisationFrame,
        emit: impl FnMut(usize, Block),
    ) -> Result<()> {
        let lookup = self.sky.lookup(direction)?;
        let aspect = self.sky.aspect(direction);
        let mix = Mix::new(&aspect, frame)?;
        let tables = self.sky.tables();
        self.polarisation.evaluate(tables, &lookup, &mix, emit);
        Ok(())
    }
}

/// Writes a block of wavelengths, of which the last may be cut short.
#[inline(always)]
fn store(out: &mut [Stokes], block: usize, i: [f32; LANES], light: &Block) {
    let rest = &mut out[block * LANES..];
    for (lane, stokes) in rest.iter_mut().take(LANES).enumerate() {
        *stokes = Stokes {
            i: i[lane],
            q: i[lane] * light.q[lane],
            u: i[lane] * light.u[lane],
        };
    }
}

impl Sky {
    fn aspect(&self, direction: [f32; 3]) -> Aspect {
        let (sun, azimuth) = self.sun();
        Aspect::new(direction, sun, azimuth)
    }
}
