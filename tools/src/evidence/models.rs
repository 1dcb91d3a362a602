//! All that are compared, each with the terms on which it is.

use welkin::{Conditions, Model};

use super::air::{Air, LOW_TOP};
use super::{ALBEDO, Result, VISIBILITY};
use crate::peers::WAVELENGTHS;
use crate::peers::bruneton::Bruneton;
use crate::peers::cie::{GeneralSky, ScaledSky};
use crate::peers::colour::ToXyz;
use crate::peers::hillaire::Hillaire;
use crate::peers::hosek::Hosek;
use crate::peers::lanes::Lanes;
use crate::peers::nishita::Nishita;
use crate::peers::preetham::Preetham;
use crate::peers::published;
use crate::peers::sky::{Coloured, LaneModel, LaneSky, Observer, SkyModel};

/// A model on its terms.
pub struct Entry {
    /// Name of its files.
    pub key: &'static str,
    /// For people.
    pub name: &'static str,
    /// Which parameters it has.
    pub terms: String,
    /// Whether it has a luminance and a colour of its own.
    pub own_light: bool,
    /// The model.
    pub model: Box<dyn SkyModel>,
}

/// This library at the wavelengths of the others.
pub struct Welkin(Model);

impl LaneModel<8> for Welkin {
    fn sky(&self, observer: Observer) -> Option<Box<dyn LaneSky<8> + '_>> {
        let sky = self.0.sky(&conditions(observer)).ok()?;
        Some(Box::new(WelkinSky(sky)))
    }

    fn bytes(&self) -> usize {
        self.0.file_bytes()
    }
}

struct WelkinSky(welkin::Sky);

impl LaneSky<8> for WelkinSky {
    fn relative_radiance(&self, direction: [f32; 3]) -> Option<Lanes<8>> {
        let mut lanes = [0.0; 8];
        for (lane, nm) in lanes.iter_mut().zip(WAVELENGTHS) {
            *lane = self.0.relative_radiance_at(direction, nm).ok()?;
        }
        Some(Lanes(lanes))
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

/// The sky that all are compared with.
pub fn conditions(observer: Observer) -> Conditions {
    Conditions {
        solar_elevation: observer.solar_elevation,
        solar_azimuth: 0.0,
        visibility: VISIBILITY,
        albedo: f64::from(ALBEDO),
        altitude: observer.altitude,
    }
}

/// All models, this one first.
///
/// # Errors
/// Where the default model does not open, or the air was not summed up for these wavelengths.
pub fn all(air: &Air) -> Result<Vec<Entry>> {
    let mut models = vec![this()?];
    models.extend(formulas()?);
    models.extend(of_coefficients(air)?);
    Ok(models)
}

fn seen<M: LaneModel<8> + 'static>(model: M) -> Box<dyn SkyModel> {
    let colour = ToXyz::spectral(WAVELENGTHS);
    Box::new(Coloured { model, colour })
}

fn this() -> Result<Entry> {
    Ok(Entry {
        key: "welkin",
        name: "welkin",
        terms: "visibility 59.4 km, albedo 0.2".into(),
        own_light: true,
        model: seen(Welkin(Model::default_model()?)),
    })
}

fn formulas() -> Result<Vec<Entry>> {
    let turbidity = Model::default_model()?.turbidity(VISIBILITY)?;
    let zenith = Model::default_model()?;
    let zenith_luminance = move |solar_elevation: f64| {
        let sky = zenith
            .sky(&conditions(Observer::on_the_ground(solar_elevation)))
            .ok()?;
        Some(sky.xyz([0.0, 0.0, 1.0]).ok()?[1])
    };
    let (sky, sun) = (
        GeneralSky::new(GeneralSky::CLEAR).ok_or("type 12")?,
        daylight(),
    );
    Ok(vec![
        Entry {
            key: "preetham",
            name: "Preetham et al. 1999",
            terms: format!("turbidity {turbidity:.2}"),
            own_light: true,
            model: Box::new(Preetham { turbidity }),
        },
        Entry {
            key: "hosek",
            name: "Hosek–Wilkie 2012",
            terms: format!("turbidity {turbidity:.2}, albedo 0.2"),
            own_light: true,
            model: Box::new(Hosek {
                turbidity,
                albedo: ALBEDO,
            }),
        },
        Entry {
            key: "cie",
            name: "CIE clear sky (type 12)",
            terms: "zenith luminance of welkin, no colour".into(),
            own_light: false,
            model: Box::new(ScaledSky {
                sky,
                zenith_luminance,
                white: sun,
            }),
        },
    ])
}

/// D65 with Y = 1.
fn daylight() -> [f32; 3] {
    crate::peers::colour::srgb_to_xyz([1.0; 3])
}

fn of_coefficients(air: &Air) -> Result<Vec<Entry>> {
    let medium = air.medium()?;
    let low = air.medium()?.below(LOW_TOP);
    let matched = "optical depths, scale heights and mean cosine of welkin's air, albedo 0.2";
    let entry = |key, name, terms: &str, model| Entry {
        key,
        name,
        terms: terms.into(),
        own_light: true,
        model,
    };
    let hillaire = Coloured {
        model: Hillaire::new(&published::hillaire()),
        colour: ToXyz::rgb(),
    };
    Ok(vec![
        entry(
            "nishita-published",
            "Nishita et al. 1993, as in Blender",
            "Blender's coefficients, all densities 1, no ground",
            seen(Nishita::new(&published::blender(WAVELENGTHS))),
        ),
        entry(
            "nishita-matched",
            "Nishita, matched",
            matched,
            seen(Nishita::new(&low)),
        ),
        entry(
            "bruneton-published",
            "Bruneton 2017",
            "its coefficients, albedo 0.1, four orders",
            seen(Bruneton::new(
                &published::bruneton(WAVELENGTHS),
                Bruneton::<8>::ORDERS,
            )),
        ),
        entry(
            "bruneton-matched",
            "Bruneton, matched",
            &format!("{matched}, four orders"),
            seen(Bruneton::new(&low, Bruneton::<8>::ORDERS)),
        ),
        entry(
            "hillaire-published",
            "Hillaire 2020",
            "its coefficients in red, green and blue, albedo 0.3",
            Box::new(hillaire),
        ),
        entry(
            "hillaire-matched",
            "Hillaire, matched",
            matched,
            seen(Hillaire::new(&medium)),
        ),
    ])
}

/// Writes on which terms they are compared.
///
/// # Errors
/// Where the table cannot be written.
pub fn write(models: &[Entry]) -> Result<()> {
    let command = "cargo run --release -p welkin-tools --bin evidence -- skies";
    let mut table = super::table::Table::new(command, &["model", "here"]);
    for entry in models {
        table.push(vec![entry.name.into(), entry.terms.clone()]);
    }
    table.write("models.csv")
}
