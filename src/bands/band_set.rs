//! The bands of a sensor on the nodes of a model.

use super::band_fit::Fit;
use super::band_ground::{BandGround, piece_albedos, twice};
use super::band_projection::{Made, Projection};
use super::residual::Residual;
use super::response::Response;
use super::spectral_axis::SpectralAxis;
use super::transmittance_fit::TransmittanceFit;
use crate::conditions::Conditions;
use crate::error::{Error, Result};
use crate::ground::Albedo;
use crate::model::{Model, NodeSubset, Nodes};
use crate::polarisation::Stokes;
use crate::sky::{MOST_WAVELENGTHS, check_length};

/// The bands of a sensor, projected onto few wavelengths of a model: what is prepared with them, and asked, costs as
/// much as those wavelengths and bands need, however many the model has.
///
/// The value of a band is that of its [`Response`]: ∫ R E L dλ in W m⁻² sr⁻¹, or spectral radiance in W m⁻² sr⁻¹ nm⁻¹
/// for a normalised curve and for a single wavelength. It is a sum of the radiance at a few wavelengths of the model,
/// with weights that are not negative and reproduce the integrals of typical skies; where no such sum does to 0.3 %, a
/// sum over a few wavelengths between them, at which the sky is interpolated as by
/// [`Sky::radiance_at`](crate::Sky::radiance_at). [`Bands::residuals`] says how well; [`Bands::TOLERANCE`] is aimed at.
/// `Send + Sync`.
///
/// ```
/// use welkin::{Bands, Conditions, Model, Response};
///
/// let model = Model::default_model()?;
/// let red = Response::table(&[590.0, 620.0, 680.0], &[0.0, 1.0, 0.0])?;
/// let blue = Response::table(&[420.0, 460.0, 500.0], &[0.0, 1.0, 0.0])?;
/// let bands = model.bands(&[red.normalised(), blue.normalised(), Response::wavelength(550.0)])?;
/// assert!(bands.residuals().iter().all(|residual| residual.p99 < 0.01));
///
/// let sky = model.band_sky(&Conditions::default(), &bands)?;
/// let mut radiance = [0.0; 3]; // W m⁻² sr⁻¹ nm⁻¹
/// sky.radiance([0.0, 0.0, 1.0], &mut radiance)?;
/// assert!(radiance[1] > radiance[0]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Bands {
    /// What tells the file that they are made for.
    file: Vec<u8>,
    nodes: NodeSubset,
    /// Over a ground whose albedo depends on wavelength, with the nodes that are prepared and their albedos.
    over: Option<(BandGround, (NodeSubset, Vec<f64>))>,
    projection: Projection,
    residuals: Vec<Residual>,
    air: TransmittanceFit,
}

impl Model {
    /// Projects responses onto the wavelengths of the model. Takes some milliseconds, once for all conditions.
    ///
    /// A file without example spectra gives them by some of its own skies, for which their chunks are read.
    ///
    /// # Errors
    /// [`Error::Invalid`] for no response, [`Error::Limit`] for more than 256; [`Error::OutOfRange`] for one that reaches beyond the model
    /// ([`Model::wavelength_range`]) and is not zero there; [`Error::MissingChunk`] if the file has no radiance; those
    /// of damaged chunks.
    pub fn bands(&self, responses: &[Response]) -> Result<Bands> {
        if responses.is_empty() {
            return Err(Error::invalid("responses", "there must be one at least"));
        }
        if responses.len() > MOST_WAVELENGTHS {
            return Err(Error::Limit {
                what: "bands",
                most: MOST_WAVELENGTHS,
                got: responses.len(),
            });
        }
        let axis = SpectralAxis::new(self)?;
        let Fit {
            mut made,
            residuals,
        } = Fit::new(self, &axis, responses)?;
        let ground = self.spectral_ground();
        let pieces = ground.map(|g| piece_albedos(self, &axis, g, (responses, &made)));
        let pieces = pieces.transpose()?;
        let (kept, floor) = (renumber(&mut made), axis.has_cells());
        let projection = Projection::new(kept.len(), &made, floor);
        let over = match ground.zip(pieces) {
            Some((ground, pieces)) => {
                let made = (made, kept.len(), floor);
                Some((
                    BandGround::new(self, ground, made, pieces)?,
                    twice(self, &kept),
                ))
            }
            None => None,
        };
        Ok(Bands {
            file: identity(self),
            projection,
            nodes: NodeSubset::new(self, kept),
            over,
            residuals,
            air: TransmittanceFit::new(self, &axis, responses)?,
        })
    }
}

impl Bands {
    /// What the 99th percentile of the residual of a curve is to keep, relative.
    pub const TOLERANCE: f64 = super::band_fit::TOLERANCE;

    /// How many bands there are.
    pub fn count(&self) -> usize {
        self.projection.bands()
    }

    /// How far each band is from the integral over its response.
    pub fn residuals(&self) -> &[Residual] {
        &self.residuals
    }

    /// The wavelengths of the model that the bands are made of, nm.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes.nodes().head.wavelengths
    }

    /// The nodes, if the bands are those of this model.
    pub(crate) fn at(&self, model: &Model) -> Result<Nodes<'_>> {
        self.check(model)?;
        let nodes = self.over.as_ref().map(|(_, (twice, _))| twice);
        Ok(nodes.unwrap_or(&self.nodes).nodes())
    }

    /// Albedos at the nodes under checked conditions.
    pub(crate) fn albedos(&self, conditions: &Conditions) -> Vec<f64> {
        match &self.over {
            Some((_, (_, albedos))) => albedos.clone(),
            None => vec![conditions.albedo; self.nodes.kept().len()],
        }
    }

    /// The ground, if its albedo depends on wavelength.
    fn ground(&self) -> Option<&Albedo> {
        self.over.as_ref().map(|(ground, _)| ground.albedo())
    }

    /// Refuses models that the bands are not made for.
    fn check(&self, model: &Model) -> Result<()> {
        let same = self.file == identity(model);
        match same && self.ground() == model.spectral_ground() {
            true => Ok(()),
            false if same => Err(Error::invalid("bands", "were made over another ground")),
            false => Err(Error::invalid("bands", "were made for another model")),
        }
    }

    /// What makes bands of light at the nodes under checked conditions.
    pub(crate) fn projection(&self, conditions: &Conditions) -> Projection {
        match &self.over {
            Some((ground, (twice, _))) => {
                ground.projection(twice.nodes().head, conditions.visibility)
            }
            None => self.projection.clone(),
        }
    }

    /// The exponentials of the air, if the bands are those of this model.
    pub(super) fn air(&self, model: &Model) -> Result<&TransmittanceFit> {
        self.check(model)?;
        Ok(&self.air)
    }

    /// The bands of relative radiance (sr⁻¹) at all wavelengths of the model, whoever gives that: a
    /// [`PointQuery`](crate::PointQuery), an [`AerialPerspectiveQuery`](crate::AerialPerspectiveQuery).
    ///
    /// ```
    /// use welkin::{Conditions, Model, PointQuery, Response};
    ///
    /// let model = Model::default_model()?;
    /// let bands = model.bands(&[Response::wavelength(450.0), Response::wavelength(650.0)])?;
    /// let query = PointQuery::new(welkin::DEFAULT_MODEL)?;
    /// let (mut relative, mut radiance) = (vec![0.0; model.wavelengths().len()], [0.0; 2]);
    /// query.relative_radiance(&Conditions::default(), [0.0, 0.0, 1.0], &mut relative)?;
    /// bands.project(&relative, &mut radiance)?; // W m⁻² sr⁻¹ nm⁻¹
    /// assert!(radiance[0] > radiance[1]);
    /// # Ok::<(), welkin::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Length`] unless there is one number per wavelength of the model and `out` has one per band;
    /// [`Error::Invalid`] for bands over a ground whose albedo depends on wavelength ([`Model::over`]): they see it with
    /// other albedos than a node does.
    pub fn project(&self, relative: &[f32], out: &mut [f32]) -> Result<()> {
        let mut kept = [0.0; MOST_WAVELENGTHS];
        let kept = self.pick(relative, out.len(), &mut kept)?;
        self.projection.apply(kept, out);
        Ok(())
    }

    /// [`Bands::project`] for Stokes vectors.
    ///
    /// # Errors
    /// As [`Bands::project`].
    pub fn project_stokes(&self, relative: &[Stokes], out: &mut [Stokes]) -> Result<()> {
        let mut kept = [Stokes::default(); MOST_WAVELENGTHS];
        let kept = self.pick(relative, out.len(), &mut kept)?;
        self.projection.apply_stokes(kept, out);
        Ok(())
    }

    /// What belongs to the nodes.
    fn pick<'k, T: Copy>(&self, all: &[T], bands: usize, kept: &'k mut [T]) -> Result<&'k [T]> {
        check_length(bands, self.count())?;
        if self.over.is_some() {
            let detail = "over a ground whose albedo depends on wavelength are not made of light at the nodes";
            return Err(Error::invalid("bands", detail));
        }
        if all.len() != self.nodes.stored() {
            return Err(Error::Length {
                what: "wavelengths of the model",
                expected: self.nodes.stored() as u64,
                got: all.len() as u64,
            });
        }
        let nodes = self.nodes.kept();
        let pairs = kept.iter_mut().zip(nodes);
        pairs.for_each(|(kept, &node)| *kept = all[node]);
        Ok(&kept[..nodes.len()])
    }
}

/// The front of the head has the checksum of all of it, which those of the chunks are part of.
fn identity(model: &Model) -> Vec<u8> {
    const HEADER: usize = 128;
    model.front()[..HEADER.min(model.front().len())].to_vec()
}

/// Numbers the nodes that count anew, and says which they were.
fn renumber(made: &mut [Made]) -> Vec<usize> {
    let mut kept: Vec<usize> = made.iter().flat_map(Made::nodes).collect();
    if kept.is_empty() {
        kept.push(0);
    }
    kept.sort_unstable();
    kept.dedup();
    let number = |node: usize| kept.binary_search(&node).unwrap_or(0);
    made.iter_mut().for_each(|made| made.renumber(number));
    kept
}
