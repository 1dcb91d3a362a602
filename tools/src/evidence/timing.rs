//! Memory and processor time of each, in one run. Times of the clock would be those of a busy machine.

use std::hint::black_box;
use std::path::Path;

use cpu_time::ProcessTime;
use welkin::{BakedColourSky, BakedSky, Model};
use welkin_fitter::official::SAFETY_ALTITUDE;

use super::cases::FIRST;
use super::entry::NOT_RUN;
use super::models::conditions;
use super::official::{NAMES, Official};
use super::quantities::short;
use super::table::Table;
use super::{ALBEDO, Result, VISIBILITY};
use crate::peers::WAVELENGTHS;
use crate::peers::bruneton::Bruneton;
use crate::peers::cie::{GeneralSky, ScaledSky};
use crate::peers::colour::ToXyz;
use crate::peers::hillaire::Hillaire;
use crate::peers::hosek::Hosek;
use crate::peers::nishita::Nishita;
use crate::peers::preetham::Preetham;
use crate::peers::published::{self, RGB};
use crate::peers::sky::{Coloured, LaneModel, Observer, Sky, SkyModel};
use crate::random::{Sequence, sphere};

const COMMAND: &str = "cargo run --release -p welkin-tools --bin evidence -- times";
/// Directions of a round.
const DIRECTIONS: usize = 2048;
/// Rounds, of which the fastest counts.
const ROUNDS: usize = 15;
/// Of skies under a new sun.
const SUN_ROUNDS: usize = 5;

/// This library as a renderer uses it: baked, in colour.
struct Welkin(Model);

impl SkyModel for Welkin {
    fn sky(&self, observer: Observer) -> Option<Box<dyn Sky + '_>> {
        let sky = self.0.colour_sky(&conditions(&FIRST, observer)).ok()?;
        Some(Box::new(Baked(sky.bake(BakedSky::TOLERANCE).ok()?)))
    }

    fn bytes(&self) -> usize {
        self.0.file_bytes()
    }
}

struct Baked(BakedColourSky);

impl Sky for Baked {
    fn xyz(&self, direction: [f32; 3]) -> Option<[f32; 3]> {
        self.0.xyz(direction).ok()
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

/// What was measured of one model, seconds of all threads together.
struct Times {
    name: &'static str,
    air: f64,
    sun: f64,
    direction: f64,
    bytes: [usize; 2],
}

/// Measures all and writes the table.
///
/// # Errors
/// Where a model cannot be made or the table not be written.
pub fn write(official: Option<&Path>) -> Result<()> {
    let models = models(official)?;
    let times = measured(&models)?;
    let first = &times[0];
    let mut table = Table::new(
        COMMAND,
        &[
            "model",
            "a direction",
            "× welkin",
            "a new sun",
            "× welkin",
            "new air",
            "tables",
            "per sun",
        ],
    );
    for t in &times {
        let ratio = |a: f64, b: f64| short(a / b);
        table.push(vec![
            t.name.into(),
            time(t.direction),
            ratio(t.direction, first.direction),
            time(t.sun),
            ratio(t.sun, first.sun),
            time(t.air),
            bytes(t.bytes[0]),
            bytes(t.bytes[1]),
        ]);
    }
    if official.is_none() {
        let absent = [NOT_RUN; 7].map(str::to_owned);
        let name = NAMES[0].to_owned();
        table.push([name].into_iter().chain(absent).collect());
    }
    table.write("times.csv")
}

type Timed = (&'static str, f64, Box<dyn SkyModel>);

fn models(official: Option<&Path>) -> Result<Vec<Timed>> {
    let turbidity = Model::default_model()?.turbidity(VISIBILITY)?;
    let sky = GeneralSky::new(GeneralSky::CLEAR).ok_or("type 12")?;
    let rgb = |model| Coloured {
        model,
        colour: ToXyz::rgb(),
    };
    let mut models = Vec::new();
    let mut add = |name, make: &mut dyn FnMut() -> Result<Box<dyn SkyModel>>| -> Result<()> {
        let start = ProcessTime::now();
        let model = make()?;
        models.push((name, start.elapsed().as_secs_f64(), model));
        Ok(())
    };
    add("welkin, baked in colour", &mut || {
        Ok(Box::new(Welkin(Model::default_model()?)))
    })?;
    add("Preetham et al. 1999", &mut || {
        Ok(Box::new(Preetham { turbidity }))
    })?;
    add("Hosek–Wilkie 2012", &mut || {
        Ok(Box::new(Hosek {
            turbidity,
            albedo: ALBEDO,
        }))
    })?;
    add("CIE clear sky (type 12)", &mut || {
        let zenith_luminance = |_: f64| Some(3000.0);
        Ok(Box::new(ScaledSky {
            sky,
            zenith_luminance,
            white: [1.0; 3],
        }))
    })?;
    let lanes =
        |model: Box<dyn LaneModel<3>>| -> Result<Box<dyn SkyModel>> { Ok(Box::new(rgb(model))) };
    let medium = published::bruneton(RGB);
    add("Nishita et al. 1993", &mut || {
        lanes(Box::new(Nishita::new(&published::blender(RGB))))
    })?;
    add("Bruneton 2017, four orders", &mut || {
        lanes(Box::new(Bruneton::new(&medium, 4)))
    })?;
    add("Hillaire 2020", &mut || {
        lanes(Box::new(Hillaire::new(&published::hillaire())))
    })?;
    if let Some(file) = official {
        add(NAMES[0], &mut || {
            let model = Official::open(file, SAFETY_ALTITUDE, VISIBILITY, ALBEDO)?;
            let colour = ToXyz::spectral(WAVELENGTHS);
            Ok(Box::new(Coloured { model, colour }))
        })?;
    }
    Ok(models)
}

impl<const K: usize> LaneModel<K> for Box<dyn LaneModel<K>> {
    fn sky(&self, observer: Observer) -> Option<Box<dyn crate::peers::sky::LaneSky<K> + '_>> {
        self.as_ref().sky(observer)
    }

    fn bytes(&self) -> usize {
        self.as_ref().bytes()
    }
}

/// Rounds alternate between the models, so that what else the machine does meets all.
fn measured(models: &[Timed]) -> Result<Vec<Times>> {
    let observer = Observer::on_the_ground(20f64.to_radians());
    let mut draws = Sequence::<2>::default();
    let up = |[x, y, z]: [f32; 3]| [x, y, z.abs()];
    let directions: Vec<_> = (0..DIRECTIONS).map(|_| up(sphere(draws.draw()))).collect();
    let skies: Vec<_> = models
        .iter()
        .map(|(.., model)| model.sky(observer))
        .collect::<Option<_>>()
        .ok_or("no sky")?;
    let mut least = vec![[f64::INFINITY; 2]; models.len()];
    for round in 0..ROUNDS {
        for (i, (.., model)) in models.iter().enumerate() {
            fastest(&mut least[i][0], || {
                for d in &directions {
                    black_box(skies[i].xyz(black_box(*d)));
                }
            });
            if round < SUN_ROUNDS {
                let sun = Observer::on_the_ground((20.0 + 0.3 * round as f64).to_radians());
                fastest(&mut least[i][1], || {
                    drop(black_box(model.sky(black_box(sun))))
                });
            }
        }
    }
    let rows = models.iter().zip(&skies).zip(least);
    Ok(rows
        .map(|(((name, air, model), sky), [all, sun])| Times {
            name,
            air: *air,
            sun,
            direction: all / DIRECTIONS as f64,
            bytes: [model.bytes(), sky.bytes()],
        })
        .collect())
}

fn fastest(least: &mut f64, work: impl FnOnce()) {
    let start = ProcessTime::now();
    work();
    *least = least.min(start.elapsed().as_secs_f64());
}

fn time(seconds: f64) -> String {
    scaled(seconds * 1e9, ["ns", "µs", "ms", "s"])
}

fn bytes(bytes: usize) -> String {
    match bytes {
        0 => "–".into(),
        bytes => scaled(bytes as f64, ["B", "kB", "MB", "GB"]),
    }
}

fn scaled(value: f64, units: [&str; 4]) -> String {
    let step = (0..3)
        .take_while(|&i| value >= 995.0 * 1e3f64.powi(i))
        .count();
    format!(
        "{} {}",
        short(value / 1e3f64.powi(step as i32)),
        units[step]
    )
}
