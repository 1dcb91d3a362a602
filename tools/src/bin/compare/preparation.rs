//! What comes before the first query.

use std::hint::black_box;

use welkin::{BakedSky, Model, Result, Sky};
use welkin_tools::WAVELENGTHS;
use welkin_tools::texture::Texture;

use crate::clock;
use crate::report::Row;
use crate::scene::{Scene, unwrapped};

/// Skies next to a picture, and opening the model next to reading it.
pub fn rows(scene: &Scene) -> Result<Vec<Row>> {
    let whole = |_| {
        let model = Model::from_bytes(welkin::DEFAULT_MODEL)?;
        model.verify()
    };
    let open = clock::duel(
        [1; 2],
        unwrapped(|_| Model::default_model().map(drop)),
        unwrapped(whole),
    );
    let fresh = |_| -> Result<()> {
        let model = Model::default_model()?;
        let sky = model.sky(&scene.conditions)?.bake(BakedSky::TOLERANCE)?;
        black_box(sky.radiance([0.0, 0.0, 1.0], &mut [0.0; WAVELENGTHS]))
    };
    let colour = |_| -> Result<()> {
        let model = Model::default_model()?;
        let sky = model
            .colour_sky(&scene.conditions)?
            .bake(BakedSky::TOLERANCE)?;
        black_box(sky.xyz([0.0, 0.0, 1.0])).map(drop)
    };
    let picture = |_| {
        let pixel = |sky: &Sky, d| sky.xyz(d).expect("a direction");
        drop(black_box(Texture::<3>::with_height(&scene.sky, 64, pixel)));
    };
    let row = |name, peer, ns, bytes| Row {
        name,
        peer,
        ns,
        p95_error: [None, None],
        bytes,
    };
    let picture_bytes = 128 * 64 * 12;
    Ok(vec![
        row(
            "prepare",
            "rendering a texture 128 x 64",
            clock::duel([1; 2], unwrapped(fresh), picture),
            [scene.spectral.bytes(), picture_bytes],
        ),
        row(
            "prepare_rgb",
            "rendering a texture 128 x 64",
            clock::duel([1; 2], unwrapped(colour), picture),
            [scene.colour.bytes(), picture_bytes],
        ),
        row(
            "open",
            "reading and checking the whole file",
            open,
            [scene.model.head_bytes(), welkin::DEFAULT_MODEL.len()],
        ),
    ])
}
