//! Times and errors next to those of others, on the same directions in the same run.
//!
//! `cargo run --release -p welkin-tools --bin compare` prints a table, `-- --json` the same as JSON. Times are medians per query
//! on one core; errors are 95th percentiles of relative differences from [`welkin::Sky`] (peers: from what they stand
//! for). Only ratios mean something on another machine.

mod clock;
mod finite;
mod polarised;
mod report;

use std::hint::black_box;
use std::ops::Range;

use hw_skymodel::rgb::{Channel, SkyParams, SkyState};
use report::Row;
use welkin::{
    BakedColourSky, BakedSky, Conditions, Directions, Interpolation, Model, PointQuery, Result, Sky,
};
use welkin_tools::paper::{Cell, Paper};
use welkin_tools::random::{self, Sequence, p95, sphere};
use welkin_tools::texture::Texture;

const QUERIES: usize = 8192;
/// Queries of one round: of prepared skies, of the paper's scheme, of the whole model.
const ROUND: usize = 2048;
const SLOW: usize = 64;
const GENERAL: usize = 2048;

/// The queries of a round of `n`.
fn span(round: usize, n: usize) -> Range<usize> {
    let first = round * n % QUERIES;
    first..first + n
}

fn main() -> Result<()> {
    let json = std::env::args().any(|argument| argument == "--json");
    let scene = Scene::new()?;
    let mut rows = scene.prepared()?;
    rows.extend(polarised::rows(&scene)?);
    rows.extend(finite::rows(&scene)?);
    rows.extend(scene.general()?);
    rows.extend(scene.preparation()?);
    match json {
        true => println!("{}", report::json(&rows)),
        false => report::table(&rows),
    }
    Ok(())
}

/// A sky between all nodes, and directions to look in.
struct Scene {
    model: Model,
    cell: fn() -> Cell,
    conditions: Conditions,
    sky: Sky,
    spectral: BakedSky,
    colour: BakedColourSky,
    directions: Vec<[f32; 3]>,
    components: [Vec<f32>; 3],
}

/// The cell of the paper's grid (Table 2) with the conditions of the scene.
fn cell() -> Cell {
    Cell {
        visibility: [27.6e3, 40e3],
        albedo: [0.0, 0.33],
        altitude: [405.0, 643.1],
        elevation: [18.04f64.to_radians(), 23.35f64.to_radians()],
    }
}

impl Scene {
    fn new() -> Result<Self> {
        let model = Model::default_model()?;
        let conditions = cell().inside([0.5; 4]);
        let sky = model.sky(&conditions)?;
        let mut sequence = Sequence::<2>::default();
        let directions: Vec<_> = (0..QUERIES).map(|_| sphere(sequence.draw())).collect();
        Ok(Self {
            components: [0, 1, 2].map(|i| directions.iter().map(|d| d[i]).collect()),
            spectral: sky.bake(BakedSky::TOLERANCE)?,
            colour: sky.bake_colour(BakedSky::TOLERANCE)?,
            cell,
            model,
            conditions,
            sky,
            directions,
        })
    }

    fn prepared(&self) -> Result<Vec<Row>> {
        let [x, y, z] = &self.components;
        let directions = Directions { x, y, z };
        let n = self.sky.wavelengths().len();
        let paper = Paper::fit(&self.model, (self.cell)())?;
        let truth = self.spectra(|d, out| self.sky.radiance(d, out))?;
        let mut spectra = vec![0.0; n * QUERIES];
        self.spectral.radiance_batch(&directions, &mut spectra)?;
        let spectral_error = p95(spectra.iter().copied().zip(truth.iter().copied()));
        let paper_spectra = self.spectra(|d, out| {
            paper.radiance(0, &self.conditions, d, out);
            Ok(())
        })?;
        let paper_error = p95(paper_spectra.into_iter().zip(truth.iter().copied()));
        let mut out = vec![0.0; n];
        let mut peer_out = vec![0.0; n];
        let mut paper_all = |round| {
            for &d in &self.directions[span(round, SLOW)] {
                paper.radiance(0, &self.conditions, black_box(d), &mut peer_out);
                black_box(&peer_out);
            }
        };
        let bytes = self.spectral.bytes();
        let paper_row = |name, ns| Row {
            name,
            peer: "paper's scheme, fixed conditions",
            ns,
            p95_error: [Some(spectral_error), Some(paper_error)],
            bytes: [bytes, paper.bytes()],
        };
        let batch = |round| {
            self.spectral
                .radiance_batch(&self.part(round), &mut spectra[..n * ROUND])
        };
        let batch = clock::duel([ROUND, SLOW], unwrapped(batch), &mut paper_all);
        let single = |round| {
            let mut ask = |d| self.spectral.radiance(black_box(d), &mut out);
            self.directions[span(round, ROUND)]
                .iter()
                .try_for_each(|&d| ask(d))
        };
        let single = clock::duel([ROUND, SLOW], unwrapped(single), &mut paper_all);
        let heroes = self.heroes();
        let mut four = vec![[0.0; 4]; QUERIES];
        self.spectral.hero_batch(&directions, &heroes, &mut four)?;
        let hero_error = self.hero_error(&heroes, &four)?;
        let hero = |round| {
            let (part, span) = (self.part(round), span(round, ROUND));
            self.spectral
                .hero_batch(&part, &heroes[span], &mut four[..ROUND])
        };
        let hero = clock::duel([ROUND, SLOW], unwrapped(hero), &mut paper_all);
        let mut rows = vec![
            paper_row("prepared_spectral_batch", batch),
            paper_row("prepared_spectral_single", single),
            Row {
                p95_error: [Some(hero_error), Some(paper_error)],
                ..paper_row("prepared_hero_batch", hero)
            },
        ];
        rows.extend(self.colours(&directions)?);
        rows.push(self.floor(spectral_error)?);
        Ok(rows)
    }

    fn colours(&self, directions: &Directions) -> Result<Vec<Row>> {
        let mut rgb = vec![[0.0; 3]; QUERIES];
        let hosek = SkyState::new(&SkyParams {
            elevation: self.conditions.solar_elevation as f32,
            turbidity: 3.0,
            albedo: [self.conditions.albedo as f32; 3],
        })
        .expect("within the range of Hosek-Wilkie");
        let sun = self.sky.sun_direction();
        let mut peer = |round| {
            for &d in &self.directions[span(round, ROUND)] {
                let [x, y, z] = black_box(d);
                let theta = z.max(0.0).acos();
                let gamma = (x * sun[0] + y * sun[1] + z * sun[2])
                    .clamp(-1.0, 1.0)
                    .acos();
                let channels = [Channel::R, Channel::G, Channel::B];
                black_box(channels.map(|c| hosek.radiance(theta, gamma, c)));
            }
        };
        let mut xyz = rgb.clone();
        self.colour.xyz_batch(directions, &mut xyz)?;
        let mut pairs = Vec::new();
        for (&d, &got) in self.directions.iter().zip(&xyz) {
            pairs.extend(got.into_iter().zip(self.sky.xyz(d)?));
        }
        let error = p95(pairs.into_iter());
        let batch = |round| {
            let part = self.part(round);
            self.colour.linear_srgb_batch(&part, &mut rgb[..ROUND])
        };
        let batch = clock::duel([ROUND; 2], unwrapped(batch), &mut peer);
        let single = |round| {
            let ask = |d| {
                self.colour
                    .linear_srgb(black_box(d))
                    .map(|c| _ = black_box(c))
            };
            self.directions[span(round, ROUND)]
                .iter()
                .try_for_each(|&d| ask(d))
        };
        let single = clock::duel([ROUND; 2], unwrapped(single), &mut peer);
        let row = |name, ns| Row {
            name,
            peer: "hw-skymodel, RGB",
            ns,
            p95_error: [Some(error), None],
            bytes: [self.colour.bytes(), size_of::<SkyState>()],
        };
        Ok(vec![
            row("prepared_rgb_batch", batch),
            row("prepared_rgb_single", single),
        ])
    }

    /// Against the least that a renderer could do.
    fn floor(&self, error: f64) -> Result<Row> {
        let texture = Texture::<12>::new(&self.sky, |sky, d| {
            let mut spectrum = [0.0; 12];
            sky.radiance(d, &mut spectrum)
                .expect("a direction and the model's wavelengths");
            spectrum
        });
        let truth = self.spectra(|d, out| self.sky.radiance(d, out))?;
        let nearest = self.directions.iter().flat_map(|&d| texture.at(d));
        let texture_error = p95(nearest.zip(truth));
        let mut spectra = vec![0.0; self.sky.wavelengths().len() * QUERIES];
        let n = self.sky.wavelengths().len();
        let ours = |round| {
            let part = self.part(round);
            self.spectral
                .radiance_batch(&part, &mut spectra[..n * ROUND])
        };
        let peer = |round| {
            for &d in &self.directions[span(round, ROUND)] {
                black_box(texture.at(black_box(d)));
            }
        };
        Ok(Row {
            name: "prepared_spectral_batch_floor",
            peer: "texture 512 x 256, nearest pixel",
            ns: clock::duel([ROUND; 2], unwrapped(ours), peer),
            p95_error: [Some(error), Some(texture_error)],
            bytes: [self.spectral.bytes(), texture.bytes()],
        })
    }

    /// Everything random: ours anywhere in the model, the paper's scheme in copies of one cell of its grid.
    fn general(&self) -> Result<Vec<Row>> {
        let paper = Paper::fit(&self.model, cell())?;
        let mut sequence = Sequence::<4>::default();
        let places: Vec<_> = (0..QUERIES).map(|_| sequence.draw()).collect();
        let anywhere: Vec<_> = places
            .iter()
            .map(|&p| random::conditions(&self.model, p))
            .collect();
        let inside: Vec<_> = places.iter().map(|&p| cell().inside(p)).collect();
        let peer_error = self.error_in(&inside, |i, d, out| {
            paper.radiance(i, &inside[i], d, out);
            Ok(())
        })?;
        let mut rows = Vec::new();
        for (name, interpolation) in [
            ("general_spectral", Interpolation::Lean),
            ("general_spectral_linear", Interpolation::Linear),
            ("general_spectral_full", Interpolation::Full),
        ] {
            let general = PointQuery::new(welkin::DEFAULT_MODEL)?.with_interpolation(interpolation);
            let error = self.error_in(&anywhere, |i, d, out| {
                general.radiance(&anywhere[i], d, out)
            })?;
            let [mut out, mut peer_out] = [[0.0; 12]; 2];
            let ours = |round| {
                let mut ask = |i: usize| {
                    general.radiance(black_box(&anywhere[i]), self.directions[i], &mut out)
                };
                span(round, GENERAL).try_for_each(&mut ask)
            };
            let peer = |round| {
                for i in span(round, SLOW) {
                    // A step that visits all copies in no order that a cache knows.
                    paper.radiance(
                        i * 89,
                        black_box(&inside[i]),
                        self.directions[i],
                        &mut peer_out,
                    );
                    black_box(&peer_out);
                }
            };
            rows.push(Row {
                name,
                peer: "paper's scheme, all random",
                ns: clock::duel([GENERAL, SLOW], unwrapped(ours), peer),
                p95_error: [Some(error), Some(peer_error)],
                bytes: [welkin::DEFAULT_MODEL.len(), paper.bytes()],
            });
        }
        Ok(rows)
    }

    /// From skies that are prepared for each query.
    fn error_in(
        &self,
        conditions: &[Conditions],
        mut ask: impl FnMut(usize, [f32; 3], &mut [f32]) -> Result<()>,
    ) -> Result<f64> {
        let mut pairs = Vec::new();
        let [mut got, mut truth] = [[0.0; 12]; 2];
        for i in (0..QUERIES).step_by(41) {
            let direction = self.directions[i];
            ask(i, direction, &mut got)?;
            let sky = self.model.sky(&conditions[i])?;
            sky.radiance(direction, &mut truth)?;
            pairs.extend(got.into_iter().zip(truth));
        }
        Ok(p95(pairs.into_iter()))
    }

    fn preparation(&self) -> Result<Vec<Row>> {
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
            let sky = model.sky(&self.conditions)?.bake(BakedSky::TOLERANCE)?;
            black_box(sky.radiance([0.0, 0.0, 1.0], &mut [0.0; 12]))
        };
        let colour = |_| -> Result<()> {
            let model = Model::default_model()?;
            let sky = model
                .sky(&self.conditions)?
                .bake_colour(BakedSky::TOLERANCE)?;
            black_box(sky.xyz([0.0, 0.0, 1.0])).map(drop)
        };
        let picture = |_| {
            let pixel = |sky: &Sky, d| sky.xyz(d).expect("a direction");
            drop(black_box(Texture::<3>::with_height(&self.sky, 64, pixel)));
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
                [self.spectral.bytes(), picture_bytes],
            ),
            row(
                "prepare_rgb",
                "rendering a texture 128 x 64",
                clock::duel([1; 2], unwrapped(colour), picture),
                [self.colour.bytes(), picture_bytes],
            ),
            row(
                "open",
                "reading and checking the whole file",
                open,
                [self.model.head_bytes(), welkin::DEFAULT_MODEL.len()],
            ),
        ])
    }

    /// The directions of a round.
    fn part(&self, round: usize) -> Directions<'_> {
        let [x, y, z] = &self.components;
        let span = span(round, ROUND);
        black_box(Directions {
            x: &x[span.clone()],
            y: &y[span.clone()],
            z: &z[span],
        })
    }

    fn spectra(&self, mut ask: impl FnMut([f32; 3], &mut [f32]) -> Result<()>) -> Result<Vec<f32>> {
        let n = self.sky.wavelengths().len();
        let mut spectra = vec![0.0; n * QUERIES];
        for (&d, out) in self.directions.iter().zip(spectra.chunks_exact_mut(n)) {
            ask(d, out)?;
        }
        Ok(spectra)
    }

    /// Four wavelengths per direction: one at random and three that divide the range with it.
    pub fn heroes(&self) -> Vec<[f32; 4]> {
        let [low, high] = self.model.wavelength_range();
        let mut sequence = Sequence::<1>::default();
        let place = |t: f64, k: usize| low + (high - low) * (t + 0.25 * k as f64).fract();
        let four = |t: f64| std::array::from_fn(|k| place(t, k) as f32);
        (0..QUERIES).map(|_| four(sequence.draw()[0])).collect()
    }

    fn hero_error(&self, wavelengths: &[[f32; 4]], got: &[[f32; 4]]) -> Result<f64> {
        let mut pairs = Vec::new();
        for ((&d, wavelengths), got) in self.directions.iter().zip(wavelengths).zip(got) {
            for (&wavelength, &got) in wavelengths.iter().zip(got) {
                pairs.push((got, self.sky.radiance_at(d, f64::from(wavelength))?));
            }
        }
        Ok(p95(pairs.into_iter()))
    }
}

fn unwrapped(mut work: impl FnMut(usize) -> Result<()>) -> impl FnMut(usize) {
    move |round| work(round).expect("valid queries")
}
