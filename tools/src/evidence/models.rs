//! All that are compared, each with the terms on which it is.

use std::path::Path;

use welkin::{Conditions, Model};

use super::Result;
use super::air::{Air, LOW_TOP};
use super::cases::{Case, FIRST};
use super::entry::{Entry, NO_SKY};
use super::official;
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

/// This library at the wavelengths of the others.
pub struct Welkin(Model, Case);

impl LaneModel<8> for Welkin {
    fn sky(&self, observer: Observer) -> Option<Box<dyn LaneSky<8> + '_>> {
        let sky = self.0.sky(&conditions(&self.1, observer)).ok()?;
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
pub fn conditions(case: &Case, observer: Observer) -> Conditions {
    Conditions {
        solar_elevation: observer.solar_elevation,
        solar_azimuth: 0.0,
        visibility: case.visibility,
        albedo: f64::from(case.albedo),
        altitude: observer.altitude,
    }
}

/// All models in a case, this one first; those of published coefficients, which are the same in all, only in the first.
///
/// # Errors
/// Where the default model or the official file does not open, or the air was not summed up for these wavelengths.
pub fn all(case: &Case, air: &Air, file: Option<&Path>) -> Result<Vec<Entry>> {
    let mut models = vec![this(case)?];
    models.extend(official::entries(case, file)?);
    models.extend(formulas(case)?);
    if *case == FIRST {
        models.extend(published());
    }
    models.extend(matched(case, air)?);
    Ok(models)
}

fn seen<M: LaneModel<8> + 'static>(model: M) -> Box<dyn SkyModel> {
    let colour = ToXyz::spectral(WAVELENGTHS);
    Box::new(Coloured { model, colour })
}

fn this(case: &Case) -> Result<Entry> {
    Ok(Entry {
        key: "welkin",
        name: "welkin",
        terms: case.name.into(),
        own_light: true,
        absent: NO_SKY,
        model: seen(Welkin(Model::default_model()?, *case)),
    })
}

fn formulas(case: &Case) -> Result<Vec<Entry>> {
    let turbidity = Model::default_model()?.turbidity(case.visibility)?;
    let (case, albedo) = (*case, case.albedo);
    let zenith = Model::default_model()?;
    let zenith_luminance = move |solar_elevation: f64| {
        let sky = zenith
            .sky(&conditions(&case, Observer::on_the_ground(solar_elevation)))
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
            absent: NO_SKY,
            model: Box::new(Preetham { turbidity }),
        },
        Entry {
            key: "hosek",
            name: "Hosek–Wilkie 2012",
            terms: format!("turbidity {turbidity:.2}, albedo {albedo}"),
            own_light: true,
            absent: NO_SKY,
            model: Box::new(Hosek { turbidity, albedo }),
        },
        Entry {
            key: "cie",
            name: "CIE clear sky (type 12)",
            terms: "zenith luminance of welkin, no colour".into(),
            own_light: false,
            absent: NO_SKY,
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

fn entry(key: &'static str, name: &'static str, terms: &str, model: Box<dyn SkyModel>) -> Entry {
    Entry {
        key,
        name,
        terms: terms.into(),
        own_light: true,
        absent: NO_SKY,
        model,
    }
}

fn published() -> Vec<Entry> {
    let hillaire = Coloured {
        model: Hillaire::new(&published::hillaire()),
        colour: ToXyz::rgb(),
    };
    vec![
        entry(
            "nishita-published",
            "Nishita et al. 1993, as in Blender",
            "Blender's coefficients, all densities 1, no ground",
            seen(Nishita::new(&published::blender(WAVELENGTHS))),
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
            "hillaire-published",
            "Hillaire 2020",
            "its coefficients in red, green and blue, albedo 0.3",
            Box::new(hillaire),
        ),
    ]
}

fn matched(case: &Case, air: &Air) -> Result<Vec<Entry>> {
    let medium = air.medium(case.albedo)?;
    let low = air.medium(case.albedo)?.below(LOW_TOP);
    let matched = format!(
        "optical depths, scale heights and mean cosine of welkin's air, albedo {}",
        case.albedo
    );
    Ok(vec![
        entry(
            "nishita-matched",
            "Nishita, matched",
            &matched,
            seen(Nishita::new(&low)),
        ),
        entry(
            "bruneton-matched",
            "Bruneton, matched",
            &format!("{matched}, four orders"),
            seen(Bruneton::new(&low, Bruneton::<8>::ORDERS)),
        ),
        entry(
            "hillaire-matched",
            "Hillaire, matched",
            &matched,
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
