//! Recipes: what comes with the program against published figures, and what is refused.

use welkin_fitter::atmosphere::{Monochromatic, real};
use welkin_fitter::recipe::{OPAC, OPAC_HUMIDITY, Published, Recipe, RecipeError};

fn parse(text: &str) -> anyhow::Result<Recipe> {
    Recipe::parse(text, None)
}

fn depth(recipe: &Recipe, nm: f64) -> f64 {
    let layers = recipe.layers(&[nm]).unwrap();
    layers.iter().map(|layer| layer.optical_depth[0]).sum()
}

/// Extinction of the particles at the ground, 1/km.
fn extinction(recipe: &Recipe) -> f64 {
    let (_, layers) = recipe.particles(&[550.0]).unwrap();
    let parts = layers
        .iter()
        .map(|layer| layer.profile[0] * layer.extinction[0]);
    1000.0 * parts.sum::<f64>()
}

#[test]
fn recipes_have_the_optical_depths_of_opac() {
    for Published {
        name,
        extinction: ground,
        optical_depth: column,
    } in OPAC
    {
        let recipe = Recipe::named(name)
            .unwrap()
            .with("humidity", OPAC_HUMIDITY)
            .unwrap();
        let (ours, depth) = (extinction(&recipe), depth(&recipe, 550.0));
        println!("{name}: {ours:.4} {ground}, {depth:.4} {column}");
        // Half a unit of the last digit that is published, and what smooth edges change.
        assert!(
            (ours - ground).abs() < 0.0005 + 0.002 * ground,
            "{name}: {ours}, {ground}"
        );
        assert!(
            (depth - column).abs() < 0.0005 + 0.015 * column,
            "{name}: {depth}, {column}"
        );
    }
    // With four digits in the output of OPAC itself.
    let recipe = Recipe::named("continental-polluted").unwrap();
    assert!((extinction(&recipe) / 0.1746 - 1.0).abs() < 1e-3);
    assert!((depth(&recipe, 550.0) / 0.3270 - 1.0).abs() < 0.01);
}

#[test]
fn every_recipe_makes_air_for_the_solver() {
    let lights: Vec<_> = (0..12)
        .map(|i| Monochromatic::beside_lines(340.0 + 40.0 * f64::from(i)))
        .collect();
    for name in Recipe::names() {
        let recipe = Recipe::named(name).unwrap();
        let air = recipe.air(&lights).unwrap();
        assert!(air.constituents.len() <= 8, "{name}");
        assert!(
            air.altitudes.len() <= 260,
            "{name}: {} nodes",
            air.altitudes.len()
        );
        assert!(air.altitudes.windows(2).all(|z| z[0] < z[1]));
        assert_eq!((air.altitudes[0], air.top()), (0.0, 100_000.0));
        for constituent in &air.constituents {
            let parts = constituent.scatterers.iter();
            let values = parts.flat_map(|s| s.extinction.iter().chain(&s.scattering));
            let all = values
                .chain(&constituent.profile)
                .chain(&constituent.extinction);
            assert!(all.clone().all(|v| v.is_finite() && *v >= 0.0), "{name}");
            for scatterer in &constituent.scatterers {
                let pairs = scatterer.scattering.iter().zip(&scatterer.extinction);
                assert!(
                    pairs.clone().all(|(s, e)| *s <= e * (1.0 + 1e-12)),
                    "{name}"
                );
            }
        }
        assert!(recipe.solar_irradiance().unwrap().at(550.0) > 0.1);
        assert!(!recipe.description().is_empty() && !recipe.name().is_empty());
    }
}

#[test]
fn visibility_is_koschmieders() {
    for km in [2.0, 4.0, 10.0] {
        let fog = Recipe::named("fog")
            .unwrap()
            .with("visibility", km)
            .unwrap();
        assert!((fog.visibility().unwrap() / (1000.0 * km) - 1.0).abs() < 1e-9);
        let air = fog.air(&[Monochromatic::beside_lines(550.0)]).unwrap();
        let absorbed: f64 = (0..air.constituents.len())
            .filter(|&k| air.constituents[k].scatterers.is_empty())
            .map(|k| air.profile(k, 0.0) * air.constituents[k].extinction[0])
            .sum();
        let seen = 3.912 / (air.extinction(0.0, 0) - absorbed);
        assert!((seen / (1000.0 * km) - 1.0).abs() < 1e-9, "{km}: {seen}");
    }
    let haze = Recipe::named("urban")
        .unwrap()
        .with("visibility", 25.0)
        .unwrap();
    assert!((haze.visibility().unwrap() / 25_000.0 - 1.0).abs() < 1e-9);
    // The layers above the ground keep what they have.
    let [before, after] = ["urban", "urban"].map(|name| Recipe::named(name).unwrap());
    let after = after.with("visibility", 25.0).unwrap();
    let layer = |recipe: &Recipe| recipe.layers(&[550.0]).unwrap()[0].clone();
    assert_eq!(layer(&before), layer(&after));
    assert_eq!(layer(&before).name, "free_troposphere");
}

/// The model's own air of 59.4 km, written as a recipe.
const OWN: &str = include_str!("reference/own_air.toml");

#[test]
fn the_models_own_air_is_a_recipe() {
    let wavelengths = [340.0, 440.0, 550.0, 700.0, 1000.0, 2000.0];
    let recipe = parse(OWN).unwrap();
    assert!((recipe.visibility().unwrap() / 59_400.0 - 1.0).abs() < 1e-3);
    let own = real(59_400.0, &wavelengths).unwrap();
    let lights = wavelengths.map(Monochromatic::beside_lines);
    let ours = recipe.air(&lights).unwrap();
    assert_eq!(ours.constituents.len(), own.constituents.len());
    for (w, nm) in wavelengths.into_iter().enumerate() {
        for k in 0..5 {
            let [a, b] = [&ours, &own].map(|air| air.vertical_optical_depth(k, w));
            assert!(
                (a - b).abs() <= 1e-4 * b,
                "{} at {nm} nm: {a}, {b}",
                own.constituents[k].name
            );
        }
        let [a, b] = [&ours, &own]
            .map(|air| air.vertical_optical_depth(5, w) + air.vertical_optical_depth(6, w));
        assert!((a / b - 1.0).abs() < 1e-3, "particles at {nm} nm: {a}, {b}");
    }
}

#[test]
fn parameters_change_what_they_say() {
    let clean = Recipe::named("continental-clean").unwrap();
    let with = |parameter, value| clean.with(parameter, value).unwrap();
    assert!((with("ozone", 100.0).ozone().unwrap() - 100.0).abs() < 1e-9);
    assert!((clean.ozone().unwrap() - 345.0).abs() < 10.0);
    assert!((with("water", 3.0).water().unwrap() - 3.0).abs() < 1e-9);
    assert!((clean.water().unwrap() - 1.42).abs() < 0.02);
    assert!((depth(&with("optical_depth", 0.4), 550.0) - 0.4).abs() < 1e-9);
    let strato = with("layers.stratosphere.optical_depth", 0.1);
    let layers = strato.layers(&[550.0]).unwrap();
    let layer = layers
        .iter()
        .find(|layer| layer.name == "stratosphere")
        .unwrap();
    assert!((layer.optical_depth[0] - 0.1).abs() < 1e-9);
    assert!(extinction(&with("humidity", 95.0)) > 1.5 * extinction(&clean));
    let air = |recipe: &Recipe| {
        let air = recipe.air(&[Monochromatic::beside_lines(400.0)]).unwrap();
        air.vertical_optical_depth(0, 0)
    };
    // The US standard atmosphere weighs 1013 hPa, here with the same gravity at all altitudes.
    assert!((air(&with("pressure", 1013.25)) / air(&clean) - 1.0).abs() < 0.01);
    assert!((air(&with("pressure", 506.6)) / air(&with("pressure", 1013.2)) - 0.5).abs() < 1e-9);
    for (parameter, value) in [
        ("albedo", 0.1),
        ("layers.moon.top", 1.0),
        ("layers.mixing.colour", 1.0),
    ] {
        assert!(clean.with(parameter, value).is_err());
    }
    for (parameter, value) in [
        ("ozone", -1.0),
        ("visibility", f64::NAN),
        ("visibility", 390.0),
    ] {
        assert!(clean.with(parameter, value).is_err(), "{parameter} {value}");
    }
}

#[test]
fn keys_name_the_air_and_nothing_else() {
    let recipe = parse(OWN).unwrap();
    let same = parse(&format!(
        "name = \"other\"\n{OWN}\n[ground]\nalbedo = 0.5\n"
    ))
    .unwrap();
    assert_eq!(recipe.key(), same.key());
    assert_eq!(recipe.key().len(), 32);
    assert_ne!(recipe.key(), recipe.with("ozone", 300.0).unwrap().key());
    let folder = tempfile::tempdir().unwrap();
    let key = |extinction: f64| {
        let table = format!(
            "# dust\nwavelength_nm, extinction, single_scattering_albedo, asymmetry\n\
             300, {extinction}, 0.9, 0.7\n2500, 0.5, 0.95, 0.6\n"
        );
        std::fs::write(folder.path().join("dust.csv"), table).unwrap();
        let path = folder.path().join("dust.toml");
        std::fs::write(
            &path,
            "[layers.dust]\noptics = \"dust.csv\"\noptical_depth_550 = 0.3\n",
        )
        .unwrap();
        Recipe::read(&path).unwrap().key()
    };
    assert_ne!(key(1.0), key(1.1));
    assert_eq!(key(1.0), key(1.0));
}

#[test]
fn layers_of_one_kind_or_shape_become_one_constituent() {
    let layer = |name: &str, from: f64, to: f64, particles: &str| {
        format!(
            "[layers.{name}]\nbottom_km = {from}\ntop_km = {to}\nparticles_per_cm3 = {{ {particles} }}\n\
             optical_depth_550 = 0.05\n"
        )
    };
    let count = |text: &str| {
        let recipe = parse(text).unwrap();
        let air = recipe
            .air(&[400.0, 550.0].map(Monochromatic::beside_lines))
            .unwrap();
        let all: f64 = (0..air.constituents.len())
            .filter(|&k| !air.constituents[k].name.starts_with("ozone"))
            .skip(2)
            .map(|k| air.vertical_optical_depth(k, 1))
            .sum();
        assert!((all / depth(&recipe, 550.0) - 1.0).abs() < 1e-9);
        let ozone = air
            .constituents
            .iter()
            .filter(|c| c.name.starts_with("ozone"));
        (air.constituents.len(), ozone.count())
    };
    let kin: String = (0..6)
        .map(|i| {
            layer(
                &format!("l{i}"),
                f64::from(i),
                1.0 + f64::from(i),
                "waso = 1",
            )
        })
        .collect();
    assert_eq!(count(&kin), (6, 3));
    let shape: String = ["waso", "inso", "soot", "micm", "suso"]
        .map(|p| layer(p, 1.0, 3.0, &format!("{p} = 1")))
        .concat();
    assert_eq!(count(&shape), (6, 3));
    let many = |n: usize| {
        let kinds = ["waso", "inso", "soot", "micm", "suso", "ssam", "minm"];
        let layers = kinds[..n].iter().enumerate();
        layers
            .map(|(i, p)| layer(p, i as f64, i as f64 + 1.0, &format!("{p} = 1")))
            .collect::<String>()
    };
    assert_eq!(count(&many(3)), (8, 3));
    assert_eq!(count(&many(4)), (8, 2));
    assert_eq!(count(&many(5)), (8, 1));
    let error = parse(&many(6)).unwrap_err();
    let error = error.downcast_ref::<RecipeError>().unwrap();
    assert!(
        matches!(
            error,
            RecipeError::TooManyProfiles {
                particles: 6,
                most: 5
            }
        ),
        "{error}"
    );
}

/// Fewer temperatures of ozone, which more layers ask for, change its optical depth by little.
#[test]
fn fewer_temperatures_of_ozone_are_nearly_as_good() {
    let kinds = ["waso", "inso", "soot", "micm", "suso"];
    let depth = |n: usize, nm: f64| {
        let layers = kinds[..n].iter().enumerate();
        let text = layers.map(|(i, p)| {
            format!("[layers.{p}]\nbottom_km = {i}\nparticles_per_cm3 = {{ {p} = 1 }}\noptical_depth_550 = 0.01\n")
        });
        let recipe = parse(&text.collect::<String>()).unwrap();
        let air = recipe.air(&[Monochromatic::beside_lines(nm)]).unwrap();
        let ozone = (0..8).filter(|&k| air.constituents[k].name.starts_with("ozone"));
        ozone.map(|k| air.vertical_optical_depth(k, 0)).sum::<f64>()
    };
    for (nm, two, one) in [
        (305.0, 0.01, 0.01),
        (330.0, 0.02, 0.03),
        (600.0, 0.005, 0.005),
    ] {
        let [three, two_, one_] = [3, 4, 5].map(|n| depth(n, nm));
        println!(
            "{nm} nm: {:.4} {:.4}",
            two_ / three - 1.0,
            one_ / three - 1.0
        );
        assert!((two_ / three - 1.0).abs() < two, "{nm}");
        assert!((one_ / three - 1.0).abs() < one, "{nm}");
    }
}

/// Text and what the error must say.
const REFUSED: [(&str, &str); 40] = [
    ("[layers.a]\nmixture = \"urban\"\ncolour = 3", "colour"),
    ("[gases]\nozone = 300", "ozone"),
    (
        "[gases]\nozone_du = -3",
        "gases.ozone_du: -3.0 is outside 0..2000",
    ),
    ("[gases]\nozone_du = nan", "gases.ozone_du"),
    ("[gases]\nstandard = \"venus\"", "gases.standard"),
    (
        "[gases]\nstandard = \"tropical\"\nisothermal = { temperature_k = 200 }",
        "exclude",
    ),
    (
        "[gases]\nisothermal = { temperature_k = 200 }",
        "surface_pressure_hpa",
    ),
    ("[gases]\ntable = \"nowhere.csv\"", "nowhere.csv"),
    ("[gases]\ntable = { altitude_km = [0, 1] }", "30 or higher"),
    ("[planet]\nradius_km = 3", "planet.radius_km"),
    ("[planet]\ngravity_m_s2 = -9.8", "planet.gravity_m_s2"),
    (
        "[aerosol]\nhumidity_percent = 100",
        "aerosol.humidity_percent",
    ),
    ("[aerosol]\nvisibility_km = 20", "aerosol.visibility_km"),
    ("[layers.a]\ntop_km = 3", "layers.a"),
    ("[layers.a]\nmixture = \"urbane\"", "layers.a.mixture"),
    ("[layers.a]\nparticles_per_cm3 = { sugar = 1 }", "sugar"),
    (
        "[layers.a]\nparticles_per_cm3 = { waso = -1 }",
        "layers.a.particles_per_cm3.waso",
    ),
    (
        "[layers.a]\nmixture = \"urban\"\nbottom_km = 5\ntop_km = 4",
        "layers.a.top_km",
    ),
    (
        "[layers.a]\nmixture = \"urban\"\ntop_km = 120",
        "layers.a.top_km: 120.0 is outside 0..100",
    ),
    (
        "[layers.a]\nmixture = \"urban\"\nscale_height_km = 0",
        "layers.a.scale_height_km",
    ),
    (
        "[layers.a]\nmixture = \"urban\"\nvisibility_km = 5\noptical_depth_550 = 1",
        "exclude",
    ),
    (
        "[layers.a]\nmixture = \"urban\"\nvisibility_km = 5\n[aerosol]\nvisibility_km = 5",
        "another field",
    ),
    (
        "[layers.a]\nmixture = \"urban\"\nbottom_km = 9\noptics = \"a.csv\"",
        "a.csv",
    ),
    (
        "[layers.a]\noptical_depth_550 = 1\noptics = { wavelength_nm = [300, 2500], extinction = [1, 1], \
         single_scattering_albedo = [1, 1.1], asymmetry = [0, 0] }",
        "single_scattering_albedo = 1.1",
    ),
    ("[ground]\nsurface = \"cheese\"", "ground.surface"),
    ("[ground]\nalbedo = 1.5", "ground.albedo"),
    ("[sun]\ndistance_au = 0", "sun.distance_au"),
    (
        "[layers.d]\nbottom_km = 3\ntop_km = 5\nmixture = \"desert\"\nvisibility_km = 20",
        "layers.d.visibility_km: there are no particles at the ground",
    ),
    (
        "[layers.d]\nmixture = \"desert\"\nvisibility_km = 20\nprofile = { altitude_km = [1, 2], relative = [1, 1] }",
        "layers.d.visibility_km: there are no particles at the ground",
    ),
    (
        "name = \"a\"\n[layers.d]\ntop_m = 2000",
        "line 3, column 1: unknown field `top_m`, expected one of `bottom_km`, `top_km`",
    ),
    ("[layers.d]\ntop_km = ", "line 2, column 10: "),
    (
        "[layers.d]\nmixture = \"desert\"\nprofile = 3",
        "line 3, column 11: expected the name of a CSV file",
    ),
    (
        "[gases.table]\naltitude_km = [0, 10000, 50000]\ntemperature_k = [288, 223, 270]\n\
         air_per_cm3 = [2.5e19, 1e18, 2.1e16]",
        "gases.table: altitude_km = 50000.0 is outside 0..200",
    ),
    (
        "[layers.d]\nmixture = \"desert\"\nprofile = { altitude_km = [1000, 2000], relative = [1, 1] }",
        "layers.d.profile: altitude_km = 1000.0 is outside 0..200",
    ),
    (
        "[layers.d]\nmixture = \"desert\"\nprofile = { altitude_km = [1, 2], relative = [0, 0] }",
        "layers.d.profile: relative is 0 everywhere",
    ),
    (
        "[sun]\nspectrum = { wavelength_nm = [400, 700], irradiance_w_m2_nm = [1, 1] }",
        "sun.spectrum: wavelength_nm runs from 400 to 700, not from 300 to 1100",
    ),
    (
        "[sun]\nspectrum = { wavelength_nm = [300, 1100], irradiance_w_m2_nm = [1, 0] }",
        "sun.spectrum: irradiance_w_m2_nm = 0.0 is not above 0",
    ),
    ("[ground]\n", "ground: one of surface, albedo and table"),
    (
        "[layers.d]\nparticles_per_cm3 = {}",
        "layers.d.particles_per_cm3",
    ),
    (
        "[layers.d]\noptical_depth_550 = 1\noptics = { wavelength_nm = [300, 2500], extinction = [1, 1], \
         single_scattering_albedo = [1, 1] }\nphase = { angle_deg = [0, 90, 180], p11_550 = [5, 0, 1] }",
        "layers.d.phase: p11_550 = 0.0 is not above 0",
    ),
];

#[test]
fn what_cannot_be_is_refused_with_its_place() {
    for (text, says) in REFUSED {
        let error = parse(text).expect_err(text);
        let message = format!("{error:#}");
        assert!(message.contains(says), "{text}\n{message}");
        assert!(!message.contains('\n') && message.len() < 400, "{message}");
        assert!(
            error.downcast_ref::<RecipeError>().is_some(),
            "{text}\n{message}"
        );
    }
}

#[test]
fn an_own_phase_function_is_kept() {
    let text = "[layers.a]\noptical_depth_550 = 0.2\n\
        optics = { wavelength_nm = [300, 2500], extinction = [2, 1], single_scattering_albedo = [1, 0.9] }\n\
        [layers.a.phase]\nangle_deg = [0, 60, 90, 120, 180]\np11_550 = [8, 1, 0.5, 0.4, 0.6]\n";
    let recipe = parse(text).unwrap();
    let (_, layers) = recipe.particles(&[550.0]).unwrap();
    let welkin_fitter::atmosphere::Phase::Tabulated(matrix) = &layers[0].scatterers[0].phase else {
        panic!("not tabulated");
    };
    let nodes = welkin_fitter::atmosphere::matrix::NODES;
    let ratio = matrix.at(0, 0)[0] / matrix.at(0, nodes - 1)[0];
    assert!((ratio / (8.0 / 0.6) - 1.0).abs() < 1e-9);
    for bad in [
        "p11_550 = [8, 1, 0, 0.4, 0.6]",
        "p12_550 = [1, 1, 1, 1, 1]",
        "r12_550 = [0, 0, 0, 0, 0]",
    ] {
        let text = text.replace("p11_550 = [8, 1, 0.5, 0.4, 0.6]", bad);
        assert!(parse(&text).is_err(), "{bad}");
    }
}

/// Whatever stands in the file, there is air or an error.
#[test]
fn no_text_panics() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = move |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let seeds: Vec<&str> = Recipe::names()
        .map(|name| Recipe::text(name).unwrap())
        .collect();
    let words = [
        "nan",
        "inf",
        "-1",
        "0",
        "1e300",
        "1e-300",
        "99",
        "\"\"",
        "[]",
        "{}",
        "true",
        "[layers.x]",
        "mixture",
        "\"urban\"",
        "optics",
        "{ wavelength_nm = [300, 2500] }",
        "=",
        "\n",
        "profile",
        "top_km",
        "0.01",
        "suso",
    ];
    let (mut good, mut bad) = (0, 0);
    for _ in 0..3000 {
        let mut lines: Vec<String> = seeds[random(seeds.len())]
            .lines()
            .map(str::to_owned)
            .collect();
        for _ in 0..=random(3) {
            let at = random(lines.len());
            match random(4) {
                0 => drop(lines.remove(at)),
                1 => lines.insert(at, words[random(words.len())].into()),
                2 => {
                    let other = seeds[random(seeds.len())]
                        .lines()
                        .nth(random(20))
                        .unwrap_or("")
                        .to_owned();
                    lines.insert(at, other);
                }
                _ => {
                    let key = lines[at].split('=').next().unwrap_or("").to_owned();
                    lines[at] = format!("{key}= {}", words[random(words.len())]);
                }
            }
        }
        match parse(&lines.join("\n")) {
            Ok(recipe) => {
                good += 1;
                assert!(recipe.visibility().unwrap() > 0.0);
            }
            Err(error) => {
                bad += 1;
                assert!(!format!("{error:#}").is_empty());
            }
        }
    }
    assert!(good > 200 && bad > 200, "{good} good, {bad} bad");
}

#[test]
fn sharp_edges_high_up_are_said_to_be_a_risk() {
    let dust = |edge: &str| {
        let text = format!(
            "[layers.dust]\nbottom_km = 2\ntop_km = 5\n{edge}\nparticles_per_cm3 = {{ mitr = 1 }}\n\
             optical_depth_550 = 0.3\n"
        );
        parse(&text).unwrap().cautions().unwrap()
    };
    assert!(dust("").len() == 1 && dust("")[0].contains("layers.dust: its edge at 5 km"));
    assert_eq!(dust("top_edge_km = 0.7"), [""; 0]);
    for name in Recipe::names() {
        assert_eq!(
            Recipe::named(name).unwrap().cautions().unwrap(),
            [""; 0],
            "{name}"
        );
    }
}

#[test]
fn what_the_page_shows_are_recipes() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/recipes.md");
    let page = std::fs::read_to_string(page).unwrap();
    let blocks = page.split("```toml\n").skip(1);
    let texts: Vec<&str> = blocks
        .map(|block| block.split("```").next().unwrap())
        .collect();
    assert_eq!(texts.len(), 2);
    for text in texts {
        assert_eq!(parse(text).unwrap().cautions().unwrap(), [""; 0]);
    }
    assert_eq!(parse("").unwrap().layers(&[550.0]).unwrap(), []);
}

/// Ash of a short scale height is where the recipe says, and not at the ground.
#[test]
fn a_layer_aloft_stays_aloft() {
    let text = "[layers.ash]\nbottom_km = 12\ntop_km = 20\nscale_height_km = 0.4\n\
        particles_per_cm3 = { suso = 1 }\noptical_depth_550 = 0.1\n";
    let recipe = parse(text).unwrap();
    assert!((depth(&recipe, 550.0) / 0.1 - 1.0).abs() < 1e-9);
    assert!(extinction(&recipe) < 1e-6, "{}", extinction(&recipe));
    let clear = parse("").unwrap().visibility().unwrap();
    assert!((recipe.visibility().unwrap() / clear - 1.0).abs() < 1e-6);
    let (altitudes, layers) = recipe.particles(&[550.0]).unwrap();
    let nodes: Vec<(f64, f64)> = altitudes
        .into_iter()
        .zip(layers[0].profile.clone())
        .collect();
    let lower = nodes.windows(2).filter(|w| w[1].0 <= 9000.0);
    let column: f64 = lower
        .map(|w| 0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0))
        .sum();
    let below = column * layers[0].extinction[0];
    assert!(below < 1e-3, "{below}");
}

#[test]
fn a_profile_is_nothing_outside_its_rows() {
    let text = "[layers.a]\nmixture = \"desert\"\noptical_depth_550 = 0.2\n\
        profile = { altitude_km = [1, 2, 3], relative = [1, 1, 1] }\n";
    let recipe = parse(text).unwrap();
    let (altitudes, layers) = recipe.particles(&[550.0]).unwrap();
    let at = |z: f64| layers[0].profile[altitudes.iter().position(|a| *a == z).unwrap()];
    assert_eq!([at(0.0), at(990.0), at(3010.0)], [0.0; 3]);
    assert_eq!([at(1000.0), at(2000.0), at(3000.0)], [1.0; 3]);
    // So the layer has all of its optical depth within.
    let per_km = 1000.0 * layers[0].extinction[0];
    assert!((per_km / 0.1 - 1.0).abs() < 0.01, "{per_km}");
}

/// Nothing is 0, not −0.
#[test]
fn a_layer_of_nothing_has_no_optical_depth() {
    let recipe = parse("[layers.a]\nparticles_per_cm3 = { soot = 0 }\n").unwrap();
    let layers = recipe.layers(&[550.0]).unwrap();
    assert_eq!(format!("{:.1}", layers[0].optical_depth[0]), "0.0");
}

#[test]
fn own_profiles_are_kept() {
    let gases = "[gases.table]\naltitude_km = [0, 10, 20, 40]\ntemperature_k = [288, 223, 217, 250]\n\
        air_per_cm3 = [2.5e19, 8.6e18, 1.8e18, 8.3e16]\nozone_per_cm3 = [0, 1e12, 4e12, 6e11]\n";
    let layer = "[layers.smoke]\noptical_depth_550 = 0.3\nparticles_per_cm3 = { soot = 1 }\n\
        profile = { altitude_km = [0, 1, 2], relative = [4, 4, 0] }\n";
    let recipe = parse(&format!("{gases}{layer}")).unwrap();
    let air = recipe.air(&[Monochromatic::beside_lines(550.0)]).unwrap();
    assert_eq!((recipe.water().unwrap(), air.constituents.len()), (0.0, 5));
    assert!((air.profile(0, 10_000.0) / air.profile(0, 0.0) - 8.6 / 25.0).abs() < 1e-9);
    let smoke = |z: f64| air.profile(4, z) * air.constituents[4].extinction[0];
    for (z, per_km) in [
        (0.0, 0.2),
        (700.0, 0.2),
        (1500.0, 0.1),
        (2000.0, 0.0),
        (9000.0, 0.0),
    ] {
        assert!(
            (1000.0 * smoke(z) - per_km).abs() < 1e-6,
            "{z} m: {}",
            smoke(z)
        );
    }
    // Ozone of 1 cm⁻³ through 1 m is 1e6 molecules per m²; the profile is exponential between its rows.
    assert!(
        (100.0..250.0).contains(&recipe.ozone().unwrap()),
        "{}",
        recipe.ozone().unwrap()
    );
    let half = recipe.with("ozone", 0.5 * recipe.ozone().unwrap()).unwrap();
    let depth = |recipe: &Recipe| {
        let air = recipe.air(&[Monochromatic::beside_lines(600.0)]).unwrap();
        (1..4)
            .map(|k| air.vertical_optical_depth(k, 0))
            .sum::<f64>()
    };
    assert!((depth(&half) / depth(&recipe) - 0.5).abs() < 1e-6);
}
