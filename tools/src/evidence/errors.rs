//! Luminance and chromaticity next to the traced sky.

use super::Result;
use super::cases::{Case, FIRST, OTHERS};
use super::directions::{Site, sites};
use super::entry::Entry;
use super::quantities::{quantile, short};
use super::table::Table;
use super::truth::Traced;
use crate::peers::colour::uniform_chromaticity;
use crate::peers::sky::Observer;

/// What the tables are made by.
const COMMAND: &str = "cargo run --release -p welkin-tools --bin evidence -- skies";

/// Parts of the sky: name of the file, and which sites belong to it.
type Region = (&'static str, fn(&Site, f64) -> bool);
const REGIONS: [Region; 3] = [
    ("luminance", |_, _| true),
    ("luminance-near-sun", |site, sun| site.from_sun(sun) < 30.0),
    ("luminance-horizon", |site, _| site.zenith > 80.0),
];

/// Light of a model at all sites, per sun; nothing where it has no sky.
struct Light {
    name: &'static str,
    own_light: bool,
    absent: &'static str,
    xyz: Vec<Option<Vec<[f32; 3]>>>,
}

impl Light {
    fn of(entry: &Entry, case: &Case) -> Self {
        let sky = |sun: f64| {
            let sky = entry.model.sky(Observer::on_the_ground(sun.to_radians()))?;
            sites()
                .iter()
                .map(|site| sky.xyz(site.direction()))
                .collect()
        };
        Self {
            name: entry.name,
            own_light: entry.own_light,
            absent: entry.absent,
            xyz: case.suns.iter().map(|&sun| sky(sun)).collect(),
        }
    }

    fn traced(name: &'static str, traced: &Traced) -> Self {
        Self {
            name,
            own_light: true,
            absent: super::entry::NO_SKY,
            xyz: traced.xyz.iter().cloned().map(Some).collect(),
        }
    }
}

/// Writes tables of all models, and of methods on the air that they were made for.
///
/// # Errors
/// Where a table cannot be written.
pub fn write(models: &[Entry], real: &Traced, exponential: &Traced) -> Result<()> {
    let light = |entry: &Entry| Light::of(entry, &FIRST);
    let mut all: Vec<Light> = models.iter().map(light).collect();
    all.push(Light::traced("exponential air, traced", exponential));
    for region in REGIONS {
        let cell = |light: &[[f32; 3]], sun: usize, sites: &[(Site, usize)]| {
            luminance(light, &real.xyz[sun], sites)
        };
        by_sun(&all, &cell, Some(region)).write(&format!("{}.csv", region.0))?;
    }
    let cell = |light: &[[f32; 3]], sun: usize, sites: &[(Site, usize)]| {
        level(light, &real.xyz[sun], sites)
    };
    by_sun(&all, &cell, None).write("level.csv")?;
    colours(&all, real).write("chromaticity.csv")?;
    let solved = models
        .iter()
        .filter(|entry| entry.key.ends_with("-matched"));
    let solved: Vec<Light> = solved.map(light).collect();
    let cell = |light: &[[f32; 3]], sun: usize, sites: &[(Site, usize)]| {
        luminance(light, &exponential.xyz[sun], sites)
    };
    by_sun(&solved, &cell, None).write("own-air.csv")
}

/// Writes the table of a case beside the first: luminance and colour.
///
/// # Errors
/// Where it cannot be written.
pub fn write_case(case: &Case, models: &[Entry], traced: &Traced) -> Result<()> {
    let suns = case.suns.iter();
    let header = ["model".to_owned()]
        .into_iter()
        .chain(suns.clone().map(|sun| format!("sun {sun}°")))
        .chain(suns.map(|sun| format!("colour, {sun}°")));
    let mut table = Table::new(COMMAND, &header.collect::<Vec<_>>());
    let sites: Vec<_> = sites().into_iter().zip(0..).collect();
    for entry in models {
        let light = Light::of(entry, case);
        let luminances = cells(&light, |xyz, sun| luminance(xyz, &traced.xyz[sun], &sites));
        let colours = cells(&light, |xyz, sun| match light.own_light {
            true => colour(xyz, &traced.xyz[sun], &sites),
            false => NO_COLOUR.into(),
        });
        let name = light.name.to_owned();
        table.push(
            [name]
                .into_iter()
                .chain(luminances)
                .chain(colours)
                .collect(),
        );
    }
    table.write(&format!("case-{}.csv", case.key))
}

/// A cell per sun.
fn cells(light: &Light, cell: impl Fn(&[[f32; 3]], usize) -> String) -> Vec<String> {
    let cell = |(sun, xyz): (usize, &Option<Vec<[f32; 3]>>)| match xyz {
        Some(xyz) => cell(xyz, sun),
        None => light.absent.into(),
    };
    light.xyz.iter().enumerate().map(cell).collect()
}

/// Said of models without a colour of their own.
const NO_COLOUR: &str = "no colour";

/// Writes standard errors of what all are compared with: those of the page's sky, then of the cases.
///
/// # Errors
/// Where the table cannot be written.
pub fn write_noise(first: [&Traced; 2], others: &[Traced]) -> Result<()> {
    let header = ["traced", "standard error at a wavelength, median"];
    let mut table = Table::new(COMMAND, &header);
    let names = ["the air of welkin", "exponential air"];
    let first = names.into_iter().zip(first);
    let others = OTHERS.iter().map(|case| case.name).zip(others);
    for (name, traced) in first.chain(others) {
        let noise = format!("{} %", short(100.0 * traced.noise));
        table.push(vec![name.into(), noise]);
    }
    table.write("noise.csv")
}

type Cell<'a> = dyn Fn(&[[f32; 3]], usize, &[(Site, usize)]) -> String + 'a;

/// A row per model, a column per sun.
fn by_sun(rows: &[Light], cell: &Cell, region: Option<Region>) -> Table {
    let mut table = Table::new(COMMAND, &header());
    for light in rows {
        let row = cells(light, |xyz, sun| {
            cell(xyz, sun, &part(region, FIRST.suns[sun]))
        });
        let name = light.name.to_owned();
        table.push([name].into_iter().chain(row).collect());
    }
    table
}

fn colours(rows: &[Light], real: &Traced) -> Table {
    let mut table = Table::new(COMMAND, &header());
    for light in rows {
        let row = cells(light, |xyz, sun| match light.own_light {
            true => colour(xyz, &real.xyz[sun], &part(None, FIRST.suns[sun])),
            false => NO_COLOUR.into(),
        });
        let name = light.name.to_owned();
        table.push([name].into_iter().chain(row).collect());
    }
    table
}

fn header() -> Vec<String> {
    let sun = |sun: &f64| format!("sun {}°", sun.to_string().replace('-', "−"));
    let suns = FIRST.suns.iter().map(sun);
    ["model".to_owned()].into_iter().chain(suns).collect()
}

/// The sites of a region, each with its index.
fn part(region: Option<Region>, sun: f64) -> Vec<(Site, usize)> {
    let belongs = |site: &Site| region.is_none_or(|(_, belongs)| belongs(site, sun));
    let all = sites().into_iter().zip(0..);
    all.filter(|(site, _)| belongs(site)).collect()
}

/// Weighted values of the sites of a part.
fn values(
    light: &[[f32; 3]],
    truth: &[[f32; 3]],
    sites: &[(Site, usize)],
    value: impl Fn([f32; 3], [f32; 3]) -> f64,
) -> Vec<(f64, f64)> {
    let value = |(site, i): &(Site, usize)| (value(light[*i], truth[*i]), site.weight);
    sites.iter().map(value).collect()
}

fn ratio(got: [f32; 3], truth: [f32; 3]) -> f64 {
    f64::from(got[1]) / f64::from(truth[1])
}

/// Median and 95th percentile of what is off, in percent.
fn luminance(light: &[[f32; 3]], truth: &[[f32; 3]], sites: &[(Site, usize)]) -> String {
    let mut off = values(light, truth, sites, |a, b| {
        100.0 * (ratio(a, b) - 1.0).abs()
    });
    format!(
        "{} / {} %",
        short(quantile(&mut off, 0.5)),
        short(quantile(&mut off, 0.95))
    )
}

/// How bright it is: median of the ratio.
fn level(light: &[[f32; 3]], truth: &[[f32; 3]], sites: &[(Site, usize)]) -> String {
    let mut ratios = values(light, truth, sites, ratio);
    format!("{:.3}", quantile(&mut ratios, 0.5))
}

/// Distances in u′, v′, in thousandths.
fn colour(light: &[[f32; 3]], truth: &[[f32; 3]], sites: &[(Site, usize)]) -> String {
    let mut off = values(light, truth, sites, |a, b| {
        let ([u, v], [s, t]) = (uniform_chromaticity(a), uniform_chromaticity(b));
        1e3 * f64::from((u - s).hypot(v - t))
    });
    format!(
        "{} / {}",
        short(quantile(&mut off, 0.5)),
        short(quantile(&mut off, 0.95))
    )
}
