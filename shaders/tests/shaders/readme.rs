//! What the README shows compiles, and its figures are true.

use crate::common::readme::{block, fill, table};
use welkin::{BakedSky, Conditions, Model};
use welkin_shaders::module;

#[test]
fn the_example_compiles() {
    let example = block("wgsl");
    assert!(example.lines().count() <= 60);
    let part = |name: &str| {
        let path = format!("{}/wgsl/{name}.wgsl", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).unwrap()
    };
    let parts = [
        "table",
        "spline",
        "direction",
        "colour",
        "sky",
        "disc",
        "aerial",
    ]
    .map(part);
    let source = parts.concat() + &example;
    if let Err(message) = module(&source) {
        panic!("{message}");
    }
}

/// The same statements as in the README, which a test compares.
fn prepared() -> welkin::Result<Vec<[f32; 4]>> {
    // README
    let model = Model::default_model()?;
    let conditions = Conditions::default();
    let sky = model
        .colour_sky(&conditions)?
        .bake(BakedSky::TOLERANCE)?
        .buffers();
    let disc = model.solar_disc(&conditions)?.buffers();
    let aerial = model
        .colour_aerial_perspective(&conditions)?
        .buffers([0.0, 0.0, 2.0])?;

    // One storage buffer, and where each table begins in it, counted in vectors of four.
    let mut table = sky.table();
    let first_of_disc = table.len() as u32;
    table.extend(&disc.table);
    let first_of_aerial = table.len() as u32;
    table.extend(&aerial.table);
    // README
    assert!(first_of_aerial > first_of_disc && first_of_disc > 0);
    Ok(table)
}

/// Without spaces, as lines are broken differently.
fn words(text: &str) -> String {
    text.split_whitespace().collect()
}

#[test]
fn the_preparation_runs() {
    assert!(!prepared().unwrap().is_empty());
    let own = include_str!("readme.rs")
        .split("// README\n")
        .nth(1)
        .unwrap();
    let shown = block("rust");
    assert!(words(&shown).contains(&words(own)), "{shown}");
}

#[test]
fn sizes() {
    let model = Model::default_model().unwrap();
    let conditions = Conditions::default();
    let colour = model
        .colour_sky(&conditions)
        .unwrap()
        .bake(BakedSky::TOLERANCE)
        .unwrap();
    let spectral = model
        .sky(&conditions)
        .unwrap()
        .bake(BakedSky::TOLERANCE)
        .unwrap()
        .buffers();
    let polarised = model
        .polarised_sky(&conditions)
        .unwrap()
        .bake(BakedSky::TOLERANCE)
        .unwrap()
        .buffers();
    let disc = model.solar_disc(&conditions).unwrap().buffers();
    let sampler = colour.sampler().buffers();
    let air = model
        .transmittance(conditions.visibility)
        .unwrap()
        .buffers();
    let aerial = model
        .colour_aerial_perspective(&conditions)
        .unwrap()
        .buffers([0.0, 0.0, 2.0])
        .unwrap();
    let colour = colour.buffers();
    let rows = [
        (
            "sky in colour",
            "`BakedColourSky`, `SkyBuffers`",
            colour.header_bytes().len(),
            16 * colour.table().len(),
        ),
        (
            "sky at all wavelengths",
            "`BakedSky`, `SkyBuffers`",
            spectral.header_bytes().len(),
            16 * spectral.table().len(),
        ),
        (
            "the same, polarised",
            "`BakedPolarisedSky`, `SkyBuffers`",
            polarised.header_bytes().len(),
            16 * polarised.table().len(),
        ),
        (
            "disc of sun or moon",
            "`SolarDisc`, `DiscBuffers`",
            disc.header_bytes().len(),
            disc.table_bytes().len(),
        ),
        (
            "draws",
            "`SkySampler`, `SamplerBuffers`",
            sampler.header_bytes().len(),
            sampler.table_bytes().len(),
        ),
        (
            "transmittance",
            "`Transmittance`, `AirBuffers`",
            air.header_bytes().len(),
            air.table_bytes().len(),
        ),
        (
            "aerial perspective",
            "`ColourAerialPerspective`, `AerialBuffers`",
            aerial.header_bytes().len(),
            aerial.table_bytes().len(),
        ),
    ];
    let rows = rows.map(|(what, of, header, table)| {
        [
            what.into(),
            of.into(),
            header.to_string(),
            table.to_string(),
        ]
    });
    fill(
        "sizes",
        &table(&["what", "of, as", "header", "table"], &rows),
    );
}
