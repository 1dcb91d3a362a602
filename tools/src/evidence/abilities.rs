//! What each model can answer: asked where it can be asked, stated where the paper has it and this comparison not.

use std::path::Path;

use welkin::Model;
use welkin_fitter::official::SAFETY_ALTITUDE;

use super::cases::FIRST;
use super::entry::NOT_RUN;
use super::models::conditions;
use super::official::{NAMES, Official};
use super::table::Table;
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
use crate::peers::sky::{Coloured, LaneModel, Observer, Sky, SkyModel};

const COMMAND: &str = "cargo run --release -p welkin-tools --bin evidence -- skies";
/// Lowest sun that is tried, degrees.
const LOWEST: i32 = -20;
/// Luminance below which it is night, cd m⁻²: a hundredth of that under the full moon.
const NIGHT: f32 = 1e-5;

/// A model by the albedo of its ground.
type Make<'a> = &'a dyn Fn(f32) -> Option<Box<dyn SkyModel + 'a>>;

/// What the papers say about colours, polarisation, transmittance and light on the way.
type Stated = [&'static str; 4];

/// Writes both tables.
///
/// # Errors
/// Where the default model does not open or a table cannot be written.
pub fn write(official: Option<&Path>) -> Result<()> {
    let model = Model::default_model()?;
    let turbidity = model.turbidity(VISIBILITY)?;
    let sky = GeneralSky::new(GeneralSky::CLEAR).ok_or("type 12")?;
    let mut asked = Table::new(
        COMMAND,
        &[
            "model",
            "lowest sun",
            "below the horizon",
            "observer's altitude",
            "ground albedo",
        ],
    );
    let mut papers = Table::new(
        COMMAND,
        &[
            "model",
            "spectrum",
            "polarisation",
            "transmittance",
            "light before things",
        ],
    );
    let mut add = |name: &str, make: Make, stated: Stated| {
        let row = |cells: [String; 4]| [name.to_owned()].into_iter().chain(cells).collect();
        asked.push(row(probed(make)));
        papers.push(row(stated.map(str::to_owned)));
    };
    add(
        "welkin",
        &|albedo| {
            Some(Box::new(Welkin {
                model: &model,
                albedo,
            }))
        },
        ["300 to 1100 nm", "yes", "between any two points", "yes"],
    );
    add(
        "Preetham et al. 1999",
        &|_| Some(Box::new(Preetham { turbidity })),
        [
            "daylight of its colour",
            "–",
            "to the sun, from the ground",
            "near the ground",
        ],
    );
    add(
        "Hosek–Wilkie 2012",
        &|albedo| Some(Box::new(Hosek { turbidity, albedo })),
        [
            "320 to 720 nm",
            "–",
            "to the sun, from the ground (2013)",
            "–",
        ],
    );
    add(
        "CIE clear sky (type 12)",
        &|_| {
            let zenith_luminance = |_: f64| Some(3000.0);
            Some(Box::new(ScaledSky {
                sky,
                zenith_luminance,
                white: [1.0; 3],
            }))
        },
        ["–", "–", "–", "–"],
    );
    let wavelength = |mut medium: crate::peers::medium::Medium<1>, albedo| {
        medium.albedo = albedo;
        medium
    };
    add(
        "Nishita et al. 1993",
        &|albedo| {
            grey(Nishita::new(&wavelength(
                published::blender([550.0]),
                albedo,
            )))
        },
        ["any", "–", "between any two points", "yes"],
    );
    add(
        "Bruneton 2017",
        &|albedo| {
            grey(Bruneton::new(
                &wavelength(published::bruneton([550.0]), albedo),
                2,
            ))
        },
        [
            "any, or red, green and blue",
            "–",
            "between any two points",
            "yes",
        ],
    );
    add(
        "Hillaire 2020",
        &|albedo| {
            grey(Hillaire::new(&wavelength(
                published::bruneton([550.0]),
                albedo,
            )))
        },
        ["red, green and blue", "–", "between any two points", "yes"],
    );
    let stated = [
        "280 to 2480 nm",
        "yes",
        "from the observer to any point",
        "by a difference of two skies",
    ];
    match official {
        Some(file) => add(NAMES[0], &|albedo| seen(file, albedo).ok(), stated),
        None => {
            add(NAMES[0], &|_| None, stated);
            asked.replace_last(NOT_RUN);
        }
    }
    asked.write("abilities.csv")?;
    papers.write("papers.csv")
}

/// The official model as its code has it.
fn seen(file: &Path, albedo: f32) -> Result<Box<dyn SkyModel>> {
    let model = Official::open(file, SAFETY_ALTITUDE, VISIBILITY, albedo)?;
    let colour = ToXyz::spectral(WAVELENGTHS);
    Ok(Box::new(Coloured { model, colour }))
}

/// A model at one wavelength.
fn grey<'a>(model: impl LaneModel<1> + 'a) -> Option<Box<dyn SkyModel + 'a>> {
    Some(Box::new(Grey(model)))
}

struct Grey<M>(M);

struct GreySky<'a>(Box<dyn crate::peers::sky::LaneSky<1> + 'a>);

impl<M: LaneModel<1>> SkyModel for Grey<M> {
    fn sky(&self, observer: Observer) -> Option<Box<dyn Sky + '_>> {
        Some(Box::new(GreySky(self.0.sky(observer)?)))
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

impl Sky for GreySky<'_> {
    fn xyz(&self, direction: [f32; 3]) -> Option<[f32; 3]> {
        let Lanes([ratio]) = self.0.relative_radiance(direction)?;
        // All light as if it were that of 550 nm.
        Some(ToXyz::spectral([400.0, 700.0]).xyz(Lanes::splat(ratio)))
    }
}

struct Welkin<'a> {
    model: &'a Model,
    albedo: f32,
}

struct WelkinSky(welkin::Sky);

impl SkyModel for Welkin<'_> {
    fn sky(&self, observer: Observer) -> Option<Box<dyn Sky + '_>> {
        let mut conditions = conditions(&FIRST, observer);
        conditions.albedo = f64::from(self.albedo);
        Some(Box::new(WelkinSky(self.model.sky(&conditions).ok()?)))
    }

    fn bytes(&self) -> usize {
        0
    }
}

impl Sky for WelkinSky {
    fn xyz(&self, direction: [f32; 3]) -> Option<[f32; 3]> {
        self.0.xyz(direction).ok()
    }
}

/// Luminance of a sky in a direction.
fn luminance(model: &dyn SkyModel, sun: f64, altitude: f64, direction: [f32; 3]) -> Option<f32> {
    let sky = model.sky(Observer {
        solar_elevation: sun.to_radians(),
        altitude,
    })?;
    sky.xyz(direction).map(|xyz| xyz[1])
}

/// Answers of a model: lowest sun, below the horizon, altitude, albedo.
fn probed(make: Make) -> [String; 4] {
    const UP: [f32; 3] = [0.0, 0.0, 1.0];
    let yes = |answer: bool| if answer { "yes" } else { "–" }.to_owned();
    let (Some(model), Some(white)) = (make(ALBEDO), make(1.0)) else {
        return [0; 4].map(|_| yes(false));
    };
    let light = |sun: i32| luminance(model.as_ref(), f64::from(sun), 0.0, UP);
    let lowest = (LOWEST..=0).find(|&sun| light(sun).is_some_and(|light| light > NIGHT));
    let lowest = lowest.map_or("–".into(), |sun| {
        format!("{}°", sun.to_string().replace('-', "−"))
    });
    let differs = |a: Option<f32>, b: Option<f32>| match (a, b) {
        (Some(a), Some(b)) => (a / b - 1.0).abs() > 2e-3,
        _ => false,
    };
    let below = luminance(model.as_ref(), 20.0, 0.0, [0.0, 0.98, -0.199]);
    let high = luminance(model.as_ref(), 20.0, 5e3, UP);
    let white = luminance(white.as_ref(), 20.0, 0.0, UP);
    [
        lowest,
        yes(below.is_some()),
        yes(differs(light(20), high)),
        yes(differs(light(20), white)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_ignores_a_parameter_is_found_out() {
        let preetham: Make = &|_| Some(Box::new(Preetham { turbidity: 2.0 }));
        assert_eq!(probed(preetham), ["0°", "–", "–", "–"].map(str::to_owned));
        let model = Model::default_model().unwrap();
        let welkin: Make = &|albedo| {
            Some(Box::new(Welkin {
                model: &model,
                albedo,
            }))
        };
        assert_eq!(
            probed(welkin),
            ["−12°", "yes", "yes", "yes"].map(str::to_owned)
        );
    }
}
