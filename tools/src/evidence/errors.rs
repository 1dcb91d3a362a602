//! Luminance and chromaticity next to the traced sky.

use super::directions::{Site, sites};
use super::models::Entry;
use super::quantities::{quantile, short};
use super::table::Table;
use super::truth::Traced;
use super::{Result, SUNS};
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
type Light = Vec<Option<Vec<[f32; 3]>>>;

/// Writes tables of all models, and of methods on the air that they were made for.
///
/// # Errors
/// Where a table cannot be written.
pub fn write(models: &[Entry], real: &Traced, exponential: &Traced) -> Result<()> {
    let lights: Vec<(&Entry, Light)> = models.iter().map(|entry| (entry, light(entry))).collect();
    let traced: Light = exponential.xyz.iter().cloned().map(Some).collect();
    let mut all: Vec<(&str, bool, &Light)> = lights
        .iter()
        .map(|(e, l)| (e.name, e.own_light, l))
        .collect();
    all.push(("exponential air, traced", true, &traced));
    for region in REGIONS {
        table(
            &all,
            &|_, light, sun, sites| luminance(light, &real.xyz[sun], sites),
            Some(region),
        )
        .write(&format!("{}.csv", region.0))?;
    }
    table(
        &all,
        &|_, light, sun, sites| level(light, &real.xyz[sun], sites),
        None,
    )
    .write("level.csv")?;
    let colour = |own: bool, light: &[[f32; 3]], sun: usize, sites: &[(Site, usize)]| match own {
        true => colour(light, &real.xyz[sun], sites),
        false => "no colour".into(),
    };
    table(&all, &colour, None).write("chromaticity.csv")?;
    let solved: Vec<_> = lights
        .iter()
        .filter(|(entry, _)| entry.key.ends_with("-matched"))
        .map(|(entry, light)| (entry.name, true, light))
        .collect();
    table(
        &solved,
        &|_, light, sun, sites| luminance(light, &exponential.xyz[sun], sites),
        None,
    )
    .write("own-air.csv")?;
    noise(real, exponential).write("noise.csv")
}

/// Standard errors of what all are compared with.
fn noise(real: &Traced, exponential: &Traced) -> Table {
    let mut table = Table::new(
        COMMAND,
        &["traced", "standard error at a wavelength, median"],
    );
    for (name, traced) in [
        ("the air of welkin", real),
        ("exponential air", exponential),
    ] {
        table.push(vec![
            name.into(),
            format!("{} %", short(100.0 * traced.noise)),
        ]);
    }
    table
}

fn light(entry: &Entry) -> Light {
    let sky = |sun: f64| {
        let sky = entry.model.sky(Observer::on_the_ground(sun.to_radians()))?;
        sites()
            .iter()
            .map(|site| sky.xyz(site.direction()))
            .collect()
    };
    SUNS.iter().map(|&sun| sky(sun)).collect()
}

type Cell<'a> = dyn Fn(bool, &[[f32; 3]], usize, &[(Site, usize)]) -> String + 'a;

/// A row per model, a column per sun.
fn table(rows: &[(&str, bool, &Light)], cell: &Cell, region: Option<Region>) -> Table {
    let mut header = vec!["model".to_owned()];
    header.extend(SUNS.map(|sun| format!("sun {}°", sun.to_string().replace('-', "−"))));
    let mut table = Table::new(
        COMMAND,
        &header.iter().map(String::as_str).collect::<Vec<_>>(),
    );
    for (name, own, light) in rows {
        let mut row = vec![(*name).to_owned()];
        for (i, sun) in SUNS.into_iter().enumerate() {
            let belongs = |site: &Site| region.is_none_or(|(_, belongs)| belongs(site, sun));
            let part = sites()
                .into_iter()
                .zip(0..)
                .filter(|(site, _)| belongs(site));
            let part: Vec<_> = part.collect();
            row.push(match &light[i] {
                Some(light) => cell(*own, light, i, &part),
                None => "no sky".into(),
            });
        }
        table.push(row);
    }
    table
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
