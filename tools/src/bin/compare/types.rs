//! The types that no other row times, each next to the one that it is taken for or prepared with.

use std::hint::black_box;

use welkin::{
    BakedSky, Budget, CameraVolume, Channels, Conditions, PointQuery, PolarisationFrame,
    PolarisedPointQuery, Result, Stokes,
};
use welkin_tools::random::{self, Sequence};

use crate::clock;
use crate::finite::segments;
use crate::report::Row;
use crate::scene::{QUERIES, ROUND, SLOW, Scene, span, unwrapped};

/// Queries, then preparations.
pub fn rows(scene: &Scene) -> Result<Vec<Row>> {
    let mut rows = vec![sky(scene)?, sample(scene)?, disc(scene)?, joined(scene)?];
    rows.push(colour_segment(scene)?);
    rows.push(slices(scene)?);
    rows.push(volume(scene)?);
    rows.push(query(scene)?);
    rows.push(polarised_query(scene)?);
    rows.extend(preparation(scene)?);
    Ok(rows)
}

fn row(name: &'static str, peer: &'static str, ns: [f64; 2], bytes: [usize; 2]) -> Row {
    Row {
        name,
        peer,
        ns,
        p95_error: [None, None],
        bytes,
    }
}

fn sky(scene: &Scene) -> Result<Row> {
    let [mut out, mut peer] = [(); 2].map(|()| vec![0.0; scene.sky.wavelengths().len()]);
    let ours = |round| {
        let mut directions = scene.directions[span(round, ROUND)].iter();
        directions.try_for_each(|&d| scene.sky.radiance(black_box(d), &mut out))
    };
    let theirs = |round| {
        let mut directions = scene.directions[span(round, ROUND)].iter();
        directions.try_for_each(|&d| scene.spectral.radiance(black_box(d), &mut peer))
    };
    let ns = clock::duel([ROUND; 2], unwrapped(ours), unwrapped(theirs));
    let bytes = [scene.sky.bytes(), scene.spectral.bytes()];
    Ok(row("sky_single", "the same, baked", ns, bytes))
}

fn sample(scene: &Scene) -> Result<Row> {
    let disc = scene.model.solar_disc(&scene.conditions)?;
    let sampler = scene.colour.sampler().with_sun(&disc);
    let mut sequence = Sequence::<2>::default();
    let numbers: Vec<_> = (0..QUERIES)
        .map(|_| sequence.draw().map(|v| v as f32))
        .collect();
    let ours = |round| {
        for &pair in &numbers[span(round, ROUND)] {
            black_box(sampler.sample(black_box(pair)));
        }
    };
    let theirs = |round| {
        let mut directions = scene.directions[span(round, ROUND)].iter();
        directions.try_for_each(|&d| scene.colour.xyz(black_box(d)).map(|c| _ = black_box(c)))
    };
    let ns = clock::duel([ROUND; 2], ours, unwrapped(theirs));
    let bytes = [sampler.bytes(), scene.colour.bytes()];
    Ok(row("sample", "colour of one direction", ns, bytes))
}

fn disc(scene: &Scene) -> Result<Row> {
    let disc = scene.model.solar_disc(&scene.conditions)?;
    let [mut out, mut peer] = [(); 2].map(|()| vec![0.0; disc.wavelengths().len()]);
    let direction = disc.direction();
    let ours = |_| (0..ROUND).try_for_each(|_| disc.radiance(black_box(direction), &mut out));
    let theirs =
        |_| (0..ROUND).try_for_each(|_| scene.spectral.radiance(black_box(direction), &mut peer));
    let ns = clock::duel([ROUND; 2], unwrapped(ours), unwrapped(theirs));
    // The disc does not say what it holds on the heap.
    let bytes = [size_of_val(&disc), scene.spectral.bytes()];
    Ok(row("solar_disc", "baked sky in front of it", ns, bytes))
}

fn joined(scene: &Scene) -> Result<Row> {
    let aerial = scene.model.aerial_perspective(&scene.conditions)?;
    let joined = aerial.joined_to(&scene.sky)?;
    let (camera, segments) = (joined.camera(), segments());
    let n = aerial.wavelengths().len();
    let [mut light, mut through] = [(); 2].map(|()| vec![0.0; n]);
    let [mut peer, mut peer_through] = [(); 2].map(|()| vec![0.0; n]);
    let ours = |round| {
        let mut ends = segments[span(round, SLOW)].iter();
        ends.try_for_each(|&[_, to]| joined.in_scattering(black_box(to), &mut light, &mut through))
    };
    let theirs = |round| {
        let mut ends = segments[span(round, SLOW)].iter();
        ends.try_for_each(|&[_, to]| {
            aerial.in_scattering(camera, black_box(to), &mut peer, &mut peer_through)
        })
    };
    let ns = clock::duel([SLOW; 2], unwrapped(ours), unwrapped(theirs));
    Ok(row(
        "segment_joined",
        "the same alone",
        ns,
        [aerial.bytes(); 2],
    ))
}

/// Segments in colour alone.
fn colour_segment(scene: &Scene) -> Result<Row> {
    let aerial = scene.model.aerial_perspective(&scene.conditions)?;
    let colour = scene.model.colour_aerial_perspective(&scene.conditions)?;
    let segments = segments();
    let ours = |round| {
        let mut ends = segments[span(round, SLOW)].iter();
        ends.try_for_each(|&[from, to]| {
            (colour.linear_srgb(from, black_box(to))).map(|c| _ = black_box(c))
        })
    };
    let theirs = |round| {
        let mut ends = segments[span(round, SLOW)].iter();
        ends.try_for_each(|&[from, to]| {
            (aerial.linear_srgb(from, black_box(to))).map(|c| _ = black_box(c))
        })
    };
    let ns = clock::duel([SLOW; 2], unwrapped(ours), unwrapped(theirs));
    let bytes = [colour.bytes(), aerial.bytes()];
    Ok(row("segment_rgb", "the same of all wavelengths", ns, bytes))
}

/// Slices of a volume along rays, 50 m to 100 km.
fn slices(scene: &Scene) -> Result<Row> {
    const SLICES: usize = 64;
    let colour = scene.model.colour_aerial_perspective(&scene.conditions)?;
    let growth = |i: usize| (i as f64 / (SLICES - 1) as f64) * 2000f64.ln();
    let distances: [f64; SLICES] = core::array::from_fn(|i| 50.0 * growth(i).exp());
    let segments = segments();
    let rays = |round| span(round, SLOW / SLICES).map(|i| segments[i]);
    let [mut light, mut factors] = [[[0.0; 3]; SLICES]; 2];
    let unit = |from: [f64; 3], to: [f64; 3]| -> [f64; 3] {
        let way: [f64; 3] = core::array::from_fn(|i| to[i] - from[i]);
        let length = way.iter().map(|v| v * v).sum::<f64>().sqrt().max(1e-9);
        way.map(|v| v / length)
    };
    let ours = |round| {
        rays(round).try_for_each(|[from, to]| {
            let direction = black_box(unit(from, to));
            colour.linear_srgb_along(from, direction, &distances, &mut light, &mut factors)
        })
    };
    let theirs = |round| {
        rays(round).try_for_each(|[from, to]| {
            let direction = black_box(unit(from, to));
            distances.iter().try_for_each(|d| {
                let end = core::array::from_fn(|i| from[i] + d * direction[i]);
                colour.linear_srgb(from, end).map(|c| _ = black_box(c))
            })
        })
    };
    let ns = clock::duel([SLOW; 2], unwrapped(ours), unwrapped(theirs));
    Ok(row("slice_rgb", "segments in RGB", ns, [colour.bytes(); 2]))
}

/// A volume of 160 × 90 × 64 that looks 30° past the sun, on one core, next to its rays one after another.
fn volume(scene: &Scene) -> Result<Row> {
    const SIZE: [usize; 3] = [160, 90, 64];
    let colour = scene.model.colour_aerial_perspective(&scene.conditions)?;
    let depths: [f64; SIZE[2]] =
        core::array::from_fn(|k| 50.0 * 2000f64.powf(k as f64 / (SIZE[2] - 1) as f64));
    let (sin, cos) = (scene.conditions.solar_azimuth + 30f64.to_radians()).sin_cos();
    let tan = 30f64.to_radians().tan();
    let volume = CameraVolume {
        from: [0.0, 0.0, scene.conditions.altitude + 2.0],
        axis: [cos, sin, 0.0],
        right: [sin, -cos, 0.0].map(|v| v * tan * 16.0 / 9.0),
        up: [0.0, 0.0, tan],
        size: [SIZE[0], SIZE[1]],
        depths: &depths,
    };
    let [mut light, mut factors] = [(); 2].map(|()| vec![[0.0; 3]; SIZE.iter().product()]);
    let ours = |_| colour.linear_srgb_volume(black_box(&volume), &mut light, &mut factors);
    let [mut ray_light, mut ray_factors] = [[[0.0; 3]; SIZE[2]]; 2];
    let theirs = |_| {
        (0..SIZE[0] * SIZE[1]).try_for_each(|i| {
            let direction = volume.direction([i % SIZE[0], i / SIZE[0]].map(|n| n as f64));
            let length = direction.iter().map(|v| v * v).sum::<f64>().sqrt();
            let distances = depths.map(|depth| depth * length);
            let (light, factors) = (&mut ray_light, &mut ray_factors);
            colour.linear_srgb_along(volume.from, direction, &distances, light, factors)
        })
    };
    let ns = clock::duel([1; 2], unwrapped(ours), unwrapped(theirs));
    Ok(row("volume_rgb", "its rays", ns, [colour.bytes(); 2]))
}

/// Segments each under conditions of their own.
fn query(scene: &Scene) -> Result<Row> {
    let aerial = scene.model.aerial_perspective(&scene.conditions)?;
    let mut query = scene.model.aerial_perspective_query()?;
    let (mut sequence, segments) = (Sequence::<4>::default(), segments());
    let anywhere: Vec<_> = (0..QUERIES)
        .map(|_| random::conditions(&scene.model, sequence.draw()))
        .collect();
    let n = aerial.wavelengths().len();
    let [mut light, mut through] = [(); 2].map(|()| vec![0.0; n]);
    let [mut peer, mut peer_through] = [(); 2].map(|()| vec![0.0; n]);
    let ours = |round| {
        span(round, SLOW).try_for_each(|i| {
            let [from, to] = black_box(segments[i]);
            query.in_scattering(&anywhere[i], from, to, &mut light, &mut through)
        })
    };
    let theirs = |round| {
        span(round, SLOW).try_for_each(|i| {
            let [from, to] = black_box(segments[i]);
            aerial.in_scattering(from, to, &mut peer, &mut peer_through)
        })
    };
    let ns = clock::duel([SLOW; 2], unwrapped(ours), unwrapped(theirs));
    let bytes = [welkin::DEFAULT_MODEL.len(), aerial.bytes()];
    Ok(row(
        "segment_query",
        "prepared, fixed conditions",
        ns,
        bytes,
    ))
}

/// Stokes vectors each under conditions of their own.
fn polarised_query(scene: &Scene) -> Result<Row> {
    let model = &scene.model;
    let plan = model.plan(&Budget {
        altitude: model.altitude_range(),
        visibility: model.visibility_range(),
        solar_elevation: model.solar_elevation_range(),
        tolerance: BakedSky::TOLERANCE,
        channels: Channels::Stokes,
    })?;
    let query = model.polarised_point_query(&plan)?;
    let mut sequence = Sequence::<4>::default();
    let anywhere: Vec<_> = (0..QUERIES)
        .map(|_| random::conditions(model, sequence.draw()))
        .collect();
    let n = query.wavelengths().len();
    let (mut out, mut peer) = (vec![Stokes::default(); n], vec![0.0; n]);
    let ours = |round| {
        span(round, ROUND).try_for_each(|i| {
            let frame = PolarisationFrame::Vertical;
            query.stokes(&anywhere[i], scene.directions[i], frame, &mut out)
        })
    };
    let theirs = |round| {
        span(round, ROUND).try_for_each(|i| {
            let query = query.point_query();
            query.radiance(&anywhere[i], scene.directions[i], &mut peer)
        })
    };
    let ns = clock::duel([ROUND; 2], unwrapped(ours), unwrapped(theirs));
    let bytes = [size_of::<PolarisedPointQuery>(), size_of::<PointQuery>()];
    Ok(row("polarised_point_query", "radiance alone", ns, bytes))
}

/// What each takes before the first query, next to the sky alone.
fn preparation(scene: &Scene) -> Result<Vec<Row>> {
    let (model, conditions) = (&scene.model, &scene.conditions);
    let time = |name, bytes, work: &dyn Fn(&Conditions) -> Result<()>| {
        let ours = |_| work(black_box(conditions));
        let theirs = |_| model.sky(black_box(conditions)).map(drop);
        let ns = clock::duel([1; 2], unwrapped(ours), unwrapped(theirs));
        row(name, "Sky", ns, [bytes, scene.sky.bytes()])
    };
    let polarised = model.polarised_sky(conditions)?;
    let aerial = model.aerial_perspective(conditions)?;
    let disc = model.solar_disc(conditions)?;
    let colour = model.colour_sky(conditions)?;
    let reach = 0.1;
    let course = model.sun_course(
        conditions,
        [
            conditions.solar_elevation - reach,
            conditions.solar_elevation + reach,
        ],
        BakedSky::TOLERANCE,
    )?;
    let colour_aerial = model.colour_aerial_perspective(conditions)?;
    Ok(vec![
        time("prepare_sky", scene.sky.bytes(), &|c| {
            model.sky(c).map(drop)
        }),
        time("bake", scene.spectral.bytes(), &|_| {
            scene.sky.bake(BakedSky::TOLERANCE).map(drop)
        }),
        time("bake_colour", scene.colour.bytes(), &|_| {
            colour.bake(BakedSky::TOLERANCE).map(drop)
        }),
        time("bake_colour_like", scene.colour.bytes(), &|_| {
            black_box(colour.bake_like(&scene.colour));
            Ok(())
        }),
        time("sun_course_at", course.bytes(), &|c| {
            course.at(c.solar_elevation, c.solar_azimuth).map(drop)
        }),
        time("prepare_colour_aerial", colour_aerial.bytes(), &|c| {
            model.colour_aerial_perspective(c).map(drop)
        }),
        time("prepare_colour", colour.bytes(), &|c| {
            model.colour_sky(c).map(drop)
        }),
        time("prepare_polarised", polarised.bytes(), &|c| {
            model.polarised_sky(c).map(drop)
        }),
        time(
            "bake_polarised",
            polarised.bake(BakedSky::TOLERANCE)?.bytes(),
            &|_| polarised.bake(BakedSky::TOLERANCE).map(drop),
        ),
        time("prepare_aerial_perspective", aerial.bytes(), &|c| {
            model.aerial_perspective(c).map(drop)
        }),
        time(
            "prepare_transmittance",
            aerial.transmittance().bytes(),
            &|c| model.transmittance(c.visibility).map(drop),
        ),
        time("prepare_solar_disc", size_of_val(&disc), &|c| {
            model.solar_disc(c).map(drop)
        }),
        time(
            "sampler",
            scene.colour.sampler().with_sun(&disc).bytes(),
            &|_| {
                black_box(scene.colour.sampler());
                Ok(())
            },
        ),
    ])
}
