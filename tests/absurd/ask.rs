//! Asks a model everything that gives numbers.

use welkin::{
    AerialPerspective, AerialPerspectiveQuery, BakedColourSky, BakedPolarisedSky, BakedSky, Budget,
    Channels, Conditions, Directions, Error, Interpolation, Model, PointQuery, PolarisationFrame,
    PolarisedPointQuery, PolarisedSky, Result, Sky, SkyDifference, SolarDisc, Stokes,
    StokesSpectra,
};

const DIRECTIONS: [[f32; 3]; 6] = [
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 0.0],
    [0.3, -0.2, 0.01],
    [0.3, -0.2, -0.001],
    [-0.5, 0.4, -0.3],
    [0.0, 0.0, -1.0],
];
const SEGMENTS: [[[f64; 3]; 2]; 6] = [
    [[0.0, 0.0, 2.0], [9e4, 0.0, 2.0]],
    [[0.0, 0.0, 9e3], [1e5, 2e5, 3e5]],
    [[0.0, 0.0, 500.0], [3e4, 1e4, -4e3]],
    [[0.0, 0.0, 2000.0], [0.0, 0.0, 0.0]],
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
];
const FRAMES: [PolarisationFrame; 3] = [
    PolarisationFrame::Vertical,
    PolarisationFrame::SunAligned,
    PolarisationFrame::Axis([0.1, 0.2, 1.0]),
];

/// What the last call was about, and how many answers were numbers.
pub struct Asker {
    pub answers: usize,
    pub refusals: usize,
}

impl Asker {
    fn finite(&mut self, what: &str, values: impl IntoIterator<Item = f32>) {
        for value in values {
            assert!(value.is_finite(), "{what}: {value}");
            self.answers += 1;
        }
    }

    fn light(&mut self, what: &str, values: &[f32]) {
        self.finite(what, values.iter().copied());
        assert!(values.iter().all(|l| *l >= 0.0), "{what}: {values:?}");
    }

    fn share(&mut self, what: &str, values: &[f32]) {
        self.light(what, values);
        assert!(values.iter().all(|t| *t <= 1.0), "{what}: {values:?}");
    }

    fn stokes(&mut self, what: &str, light: &[Stokes]) {
        for stokes in light {
            self.finite(what, [stokes.i, stokes.q, stokes.u]);
            self.finite(what, [stokes.degree(), stokes.signed_degree()]);
            self.finite(
                what,
                [
                    stokes.angle(),
                    stokes.through_polariser(0.3),
                    stokes.turned(1.0).q,
                ],
            );
        }
    }

    /// Counts what was refused, which only absurd values may be.
    fn allowed<T>(&mut self, what: &str, answer: Result<T>) -> Option<T> {
        match answer {
            Ok(answer) => Some(answer),
            // On a small planet a point is soon far away.
            Err(Error::Reach { .. }) => None,
            Err(error) => {
                let class = error.class();
                assert!(matches!(class, "value" | "tolerance"), "{what}: {error}");
                let text = error.to_string();
                assert!(!text.contains("NaN") && text.len() < 200, "{what}: {text}");
                self.refusals += 1;
                None
            }
        }
    }

    pub fn everything(&mut self, bytes: &'static [u8]) {
        let model = Model::from_static(bytes).expect("a file that was verified");
        let query = PointQuery::new(bytes).expect("a small model");
        for t in [0.0, 0.4, 1.0] {
            let within = |[low, high]: [f64; 2]| (low + t * (high - low)).clamp(low, high);
            let conditions = Conditions {
                altitude: within(model.altitude_range()),
                visibility: within(model.visibility_range()),
                solar_elevation: within(model.solar_elevation_range()),
                solar_azimuth: t,
                albedo: t,
            };
            let wavelength = within(model.wavelength_range().expect("a sound spectrum"));
            self.point_query(&query, &conditions);
            let sky = self.allowed("sky", model.sky(&conditions));
            if let Some(sky) = &sky {
                let disc = self.allowed("sun", model.solar_disc(&conditions));
                if let Some(disc) = &disc {
                    self.disc(disc);
                }
                self.sky(sky, disc.as_ref(), wavelength);
            }
            let polarised = self.allowed("polarised sky", model.polarised_sky(&conditions));
            if let Some(sky) = &polarised {
                self.polarised(sky, wavelength);
            }
            if let Some(air) = self.allowed("air", model.transmittance(conditions.visibility)) {
                self.air(&air);
            }
            if let Some(aerial) =
                self.allowed("aerial perspective", model.aerial_perspective(&conditions))
            {
                self.aerial_perspective(&aerial, wavelength);
                if let (Some(sky), Some(polarised)) = (&sky, &polarised) {
                    self.foreground(&aerial, sky, polarised);
                }
            }
            if let Some(skies) = self.allowed("sky difference", model.sky_difference(&conditions)) {
                self.difference(&skies, model.head().wavelengths.len());
            }
            self.plan(&model, &conditions, wavelength);
            if let Some(mut aerial) =
                self.allowed("aerial perspective query", model.aerial_perspective_query())
            {
                self.aerial_perspective_query(&mut aerial, &conditions, wavelength);
            }
        }
    }

    fn point_query(&mut self, query: &PointQuery, conditions: &Conditions) {
        let mut out = vec![0.0; query.wavelengths().len()];
        for direction in DIRECTIONS {
            let answer = query.radiance(conditions, direction, &mut out);
            if self.allowed("point query", answer).is_some() {
                self.light("point query", &out);
            }
            let answer = query.relative_radiance(conditions, direction, &mut out);
            if self.allowed("point query", answer).is_some() {
                self.light("point query, relative", &out);
            }
        }
        let _ = Interpolation::Full;
    }

    fn sky(&mut self, sky: &Sky, disc: Option<&SolarDisc>, wavelength: f64) {
        let mut out = vec![0.0; sky.wavelengths().len()];
        for direction in DIRECTIONS {
            sky.radiance(direction, &mut out).unwrap();
            self.light("radiance", &out);
            sky.relative_radiance(direction, &mut out).unwrap();
            self.light("relative radiance", &out);
            let between = welkin::between_wavelengths(sky.wavelengths(), &out, wavelength);
            if let Some(value) = self.allowed("between wavelengths", between) {
                self.light("between wavelengths", &[value]);
            }
            let at = sky.radiance_at(direction, wavelength).unwrap();
            self.light("radiance at a wavelength", &[at]);
            let at = sky.relative_radiance_at(direction, wavelength).unwrap();
            self.light("relative radiance at a wavelength", &[at]);
            self.finite("XYZ", sky.xyz(direction).unwrap());
            self.finite("RGB", sky.linear_srgb(direction).unwrap());
        }
        if let Some(baked) = self.allowed("bake", sky.bake(0.1)) {
            self.baked(&baked, wavelength as f32);
        }
        if let Some(baked) = self.allowed("bake colour", sky.bake_colour(0.1)) {
            self.colour(&baked, disc);
        }
    }

    fn disc(&mut self, disc: &SolarDisc) {
        let mut out = vec![0.0; disc.wavelengths().len()];
        let sun = disc.direction();
        let beside = [sun[0], sun[1], sun[2] + 0.004];
        for direction in [sun, beside].into_iter().chain(DIRECTIONS) {
            disc.radiance(direction, &mut out).unwrap();
            self.light("disc", &out);
            self.finite("disc, XYZ", disc.xyz(direction).unwrap());
            disc.irradiance(direction, &mut out).unwrap();
            self.light("disc, irradiance", &out);
        }
        self.finite("disc, solid angle", [disc.solid_angle() as f32]);
    }

    fn baked(&mut self, baked: &BakedSky, wavelength: f32) {
        let mut out = vec![0.0; baked.wavelengths().len()];
        for direction in DIRECTIONS {
            baked.radiance(direction, &mut out).unwrap();
            self.light("baked", &out);
            let hero = baked.hero(direction, [wavelength; 4]).unwrap();
            self.light("baked, hero", &hero);
        }
        baked.irradiance([0.1, 0.2, 0.9], &mut out).unwrap();
        self.light("baked, irradiance", &out);
        let mut batch = vec![0.0; DIRECTIONS.len() * out.len()];
        let [x, y, z] = [0, 1, 2].map(|c| DIRECTIONS.map(|d| d[c]));
        let directions = Directions {
            x: &x,
            y: &y,
            z: &z,
        };
        baked.radiance_batch(&directions, &mut batch).unwrap();
        self.light("baked, batch", &batch);
        let error = baked.bake_error();
        self.answers += 1;
        let errors = [error.median, error.p95, error.p99, error.max];
        assert!(errors.iter().all(|e| e.is_finite()), "{error:?}");
    }

    fn colour(&mut self, baked: &BakedColourSky, disc: Option<&SolarDisc>) {
        for direction in DIRECTIONS {
            self.finite("baked XYZ", baked.xyz(direction).unwrap());
            self.finite("baked RGB", baked.linear_srgb(direction).unwrap());
        }
        let sampler = baked.sampler();
        let with_sun = disc.map(|disc| sampler.clone().with_sun(disc));
        for sampler in with_sun.into_iter().chain([sampler]) {
            for i in 0..16 {
                let place = [i as f32 / 15.0, (i * 7 % 16) as f32 / 16.0];
                let sample = sampler.sample(place);
                self.finite("sample", sample.direction);
                self.finite("XYZ of a sample", sample.xyz);
                self.light("pdf of a sample", &[sample.pdf]);
            }
            for direction in DIRECTIONS {
                self.light("pdf", &[sampler.pdf(direction).unwrap()]);
            }
        }
    }

    fn polarised(&mut self, sky: &PolarisedSky, wavelength: f64) {
        let mut light = vec![Stokes::default(); sky.sky().wavelengths().len()];
        for direction in DIRECTIONS {
            for frame in FRAMES {
                sky.stokes(direction, frame, &mut light).unwrap();
                self.stokes("Stokes", &light);
                sky.relative_stokes(direction, frame, &mut light).unwrap();
                self.stokes("relative Stokes", &light);
                let at = sky.stokes_at(direction, frame, wavelength).unwrap();
                self.stokes("Stokes at a wavelength", &[at]);
                self.stokes("Stokes, XYZ", &sky.xyz(direction, frame).unwrap());
            }
        }
        if let Some(baked) = self.allowed("bake Stokes", sky.bake(0.1)) {
            self.baked_polarised(&baked, wavelength as f32);
        }
    }

    fn baked_polarised(&mut self, baked: &BakedPolarisedSky, wavelength: f32) {
        let n = baked.sky().wavelengths().len();
        let [mut i, mut q, mut u] = [(); 3].map(|()| vec![0.0; n]);
        for direction in DIRECTIONS {
            let out = StokesSpectra {
                i: &mut i,
                q: &mut q,
                u: &mut u,
            };
            baked
                .stokes(direction, PolarisationFrame::Vertical, out)
                .unwrap();
            self.light("baked Stokes", &i);
            self.finite("baked Stokes", q.iter().chain(&u).copied());
            let hero = baked.hero(direction, PolarisationFrame::Vertical, [wavelength; 4]);
            self.stokes("baked Stokes, hero", &hero.unwrap());
        }
        let error = baked.polarisation_error();
        self.finite("error of polarisation", [error.p95 as f32]);
    }

    fn air(&mut self, air: &welkin::Transmittance) {
        let mut out = vec![0.0; air.wavelengths().len()];
        for [from, to] in SEGMENTS {
            air.transmittance(from, to, &mut out).unwrap();
            self.share("transmittance", &out);
            air.optical_depth(from, to, &mut out).unwrap();
            self.light("optical depth", &out);
            let up = [0.1, 0.2, 0.5];
            air.transmittance_to_space(from, up, &mut out).unwrap();
            self.share("transmittance to space", &out);
        }
    }

    fn aerial_perspective(&mut self, aerial: &AerialPerspective, wavelength: f64) {
        let n = aerial.wavelengths().len();
        let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
        let [mut q, mut u] = [(); 2].map(|()| vec![0.0; n]);
        for [from, to] in SEGMENTS {
            if !within_reach(aerial.in_scattering(from, to, &mut light, &mut through)) {
                continue;
            }
            self.light("in-scatter", &light);
            self.share("transmittance", &through);
            if within_reach(aerial.to_end(from, [0.1, 0.2, 0.05], &mut light, &mut through)) {
                self.light("in-scatter to the end", &light);
            }
            let (colour, factors) = aerial.xyz(from, to).unwrap();
            self.finite("in-scatter, XYZ", colour);
            self.share("factors of XYZ", &factors);
            let (colour, factors) = aerial.linear_srgb(from, to).unwrap();
            self.finite("in-scatter, RGB", colour);
            self.share("factors of RGB", &factors);
            for frame in FRAMES {
                let out = StokesSpectra {
                    i: &mut light,
                    q: &mut q,
                    u: &mut u,
                };
                aerial
                    .in_scattering_stokes(from, to, frame, out, &mut through)
                    .unwrap();
                self.finite("in-scatter, Stokes", light.iter().copied());
                self.finite("in-scatter, Stokes", q.iter().chain(&u).copied());
                let at = aerial.relative_stokes_at(from, to, frame, wavelength);
                self.stokes("in-scatter, Stokes at a wavelength", &[at.unwrap()]);
                let (colour, factors) = aerial.xyz_stokes(from, to, frame).unwrap();
                self.stokes("in-scatter, Stokes, XYZ", &colour);
                self.share("factors of XYZ", &factors);
                let (colour, factors) = aerial.linear_srgb_stokes(from, to, frame).unwrap();
                self.stokes("in-scatter, Stokes, RGB", &colour);
                self.share("factors of RGB", &factors);
            }
        }
    }

    fn difference(&mut self, skies: &SkyDifference, n: usize) {
        let mut light = vec![0.0; n];
        for [from, to] in SEGMENTS {
            for answer in [
                skies.in_scattering(from, to, &mut light),
                skies.blurred(from, to, &mut light),
            ] {
                // Segments leave the altitudes of the model.
                if matches!(answer, Err(Error::OutOfRange { .. })) {
                    continue;
                }
                if self.allowed("sky difference", answer).is_some() {
                    self.finite("sky difference", light.iter().copied());
                }
            }
        }
    }

    fn aerial_perspective_query(
        &mut self,
        aerial: &mut AerialPerspectiveQuery,
        conditions: &Conditions,
        wavelength: f64,
    ) {
        let n = aerial.wavelengths().len();
        let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
        for [from, to] in SEGMENTS {
            let answer = aerial.in_scattering(conditions, from, to, &mut light, &mut through);
            if self
                .allowed("aerial perspective query, in-scattering", answer)
                .is_some()
            {
                self.light("aerial perspective query, in-scattering", &light);
                self.share("aerial perspective query, transmittance", &through);
            }
            let along = [0.1, 0.2, 0.05];
            let answer = aerial.to_end(conditions, from, along, &mut light, &mut through);
            if self
                .allowed("aerial perspective query, in-scattering", answer)
                .is_some()
            {
                self.light("aerial perspective query, in-scattering to the end", &light);
            }
            let at = aerial.relative_stokes_at(
                conditions,
                from,
                to,
                PolarisationFrame::Vertical,
                wavelength,
            );
            if let Some(stokes) = self.allowed("aerial perspective query, Stokes", at) {
                self.stokes(
                    "aerial perspective query, Stokes at a wavelength",
                    &[stokes],
                );
            }
        }
    }

    fn foreground(&mut self, aerial: &AerialPerspective, sky: &Sky, polarised: &PolarisedSky) {
        let n = aerial.wavelengths().len();
        let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
        let before = aerial.joined_to(sky).unwrap();
        for [_, to] in SEGMENTS {
            if !within_reach(before.in_scattering(to, &mut light, &mut through)) {
                continue;
            }
            self.light("foreground", &light);
            self.share("foreground, transmittance", &through);
            let (colour, factors) = before.xyz(to).unwrap();
            self.finite("foreground, XYZ", colour);
            self.share("foreground, factors", &factors);
            let (colour, _) = before.linear_srgb(to).unwrap();
            self.finite("foreground, RGB", colour);
            let before = aerial.joined_to_polarised(polarised).unwrap();
            let (colour, factors) = before
                .linear_srgb_stokes(to, PolarisationFrame::Vertical)
                .unwrap();
            self.stokes("foreground, Stokes", &colour);
            self.share("foreground, factors", &factors);
        }
    }

    fn plan(&mut self, model: &Model, conditions: &Conditions, wavelength: f64) {
        for channels in [Channels::Spectral, Channels::Colour, Channels::Stokes] {
            let plan = model.plan(&Budget {
                altitude: [conditions.altitude; 2],
                visibility: [conditions.visibility; 2],
                solar_elevation: [conditions.solar_elevation; 2],
                tolerance: 0.1,
                channels,
            });
            let plan = plan.expect("conditions of the model");
            self.finite("plan", [plan.error_median, plan.error_p99]);
            if channels == Channels::Stokes {
                let query =
                    self.allowed("polarised point query", model.polarised_point_query(&plan));
                if let Some(query) = query {
                    self.polarised_point_query(&query, conditions, wavelength);
                }
            }
        }
    }

    fn polarised_point_query(
        &mut self,
        query: &PolarisedPointQuery,
        conditions: &Conditions,
        wavelength: f64,
    ) {
        let mut out = vec![Stokes::default(); query.wavelengths().len()];
        for direction in DIRECTIONS {
            for frame in FRAMES {
                let answer = query.stokes(conditions, direction, frame, &mut out);
                if self.allowed("polarised point query", answer).is_some() {
                    self.stokes("polarised point query", &out);
                }
                let at = query.stokes_at(conditions, direction, frame, wavelength);
                if let Some(at) = self.allowed("polarised point query", at) {
                    self.stokes("polarised point query, at a wavelength", &[at]);
                }
            }
        }
    }
}

/// On a small planet a point is soon far away.
fn within_reach(answer: Result<()>) -> bool {
    match answer {
        Err(Error::Reach { .. }) => false,
        answer => {
            answer.unwrap();
            true
        }
    }
}
