//! Every public type can be moved to and shared between threads, holds nothing but what it says it borrows, and has an
//! example.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use welkin::axis::*;
use welkin::estimate::*;
use welkin::format::*;
use welkin::geometry::*;
use welkin::output::Target;
use welkin::*;

const fn shared<T: Send + Sync + 'static + ?Sized>() {}

/// Asserts it for all types of a list at compile time, and gives their names.
macro_rules! all_shared {
    ($($type:ty,)*) => {
        const _: () = { $(shared::<$type>();)* };
        const LISTED: &[&str] = &[$(stringify!($type)),*];
    };
}

all_shared! {
    Transmittance,
    AlphaAxis,
    AxisTable,
    ModelAxis,
    BakeError,
    Moon,
    SkySum,
    BakedBandSky,
    BakedPolarisedBandSky,
    BandAerialPerspective,
    ColourAerialPerspective,
    BufferHeader,
    CameraVolume<'static>,
    ColourSpace,
    SkyBuffers,
    SunCourse,
    BandSky,
    BandSolarDisc,
    BandTransmittance,
    Bands,
    ColourSky,
    JoinedBandAerialPerspective<'static>,
    PolarisedBandSky,
    Residual,
    Response,
    BakedColourSky,
    BakedPolarisedSky,
    BakedSky,
    BasisView<'static>,
    Budget,
    Channels,
    Chunk,
    ColumnTable,
    ColumnView<'static>,
    Albedo,
    Conditions,
    Contents,
    DensityTable,
    DensityView<'static>,
    Spectrum,
    SpectrumView<'static>,
    SpectralInterpolation,
    Directions<'static>,
    ElevationAxis,
    Ends,
    Entry,
    Estimate,
    EstimateView<'static>,
    Estimates,
    Error,
    FactorsView<'static>,
    Field,
    JoinedAerialPerspective<'static>,
    PolarisationFrame,
    PointQuery<'static>,
    AerialPerspectiveQuery<'static>,
    AerialPerspective,
    Head,
    Interpolation,
    Kind,
    Model,
    Part,
    Payload,
    Payload16,
    PhaseFunction,
    Place,
    Plan,
    Planet,
    PolarisationBasis,
    PolarisationFactors,
    JoinedPolarisedAerialPerspective<'static>,
    PolarisedPointQuery<'static>,
    PolarisedSky,
    Problem,
    RadianceBasis,
    RadianceFactors,
    Ray,
    Ranks,
    dyn ReadAt,
    welkin::Result<()>,
    Sample,
    Selection,
    Shape,
    Side,
    Sightline,
    Sky,
    SkySampler,
    SourceBasis,
    SourceBasisView<'static>,
    SourceCore,
    SourceView<'static>,
    Stokes,
    Stencil,
    StokesSpectra<'static>,
    SkyDifference<'static>,
    SolarDisc,
    Target,
    Taps,
    Traffic,
}

/// `welkin::Result<()>` is `Result`.
fn name(listed: &str) -> String {
    let path = listed.split('<').next().unwrap();
    let last = path.rsplit([':', ' ']).find(|part| !part.is_empty());
    last.unwrap().to_owned()
}

/// The file of `mod name;` that stands in the file of its parent.
fn file(parent: &Path, name: &str) -> PathBuf {
    let folder = match parent.file_stem().unwrap().to_str().unwrap() {
        "lib" | "mod" => parent.parent().unwrap().to_owned(),
        _ => parent.with_extension(""),
    };
    let flat = folder.join(format!("{name}.rs"));
    match flat.exists() {
        true => flat,
        false => folder.join(name).join("mod.rs"),
    }
}

fn is_type(name: &str) -> bool {
    let mut letters = name.chars();
    letters.next().is_some_and(char::is_uppercase) && letters.any(char::is_lowercase)
}

/// What a module shows: types that it declares or names again, and those of its public modules.
fn shown(path: &Path, names: &mut BTreeSet<String>) {
    let text = std::fs::read_to_string(path).unwrap();
    // What stands in the one block that needs the standard library is indented.
    let lines = text.lines().map(str::trim_start);
    let code: Vec<_> = lines.filter(|line| !line.starts_with("//")).collect();
    let code = format!("\n{}", code.join("\n"));
    let identifiers = |text: &str| -> Vec<String> {
        let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
        words.filter(|w| !w.is_empty()).map(str::to_owned).collect()
    };
    for statement in code.split("\npub ").skip(1) {
        let (keyword, rest) = statement.split_once(' ').unwrap();
        match keyword {
            "use" => {
                let list = rest.split(';').next().unwrap();
                assert!(!list.contains('*'), "{}: pub use {list}", path.display());
                let parts: Vec<_> = list.split("::").collect();
                if parts[0] != "crate" && list.chars().all(|c| c.is_lowercase() || c == ':') {
                    let module = parts.iter().fold(path.to_owned(), |p, part| file(&p, part));
                    if module.exists() {
                        shown(&module, names);
                    }
                }
                names.extend(identifiers(list).into_iter().filter(|n| is_type(n)));
            }
            "mod" => shown(&file(path, rest.split(';').next().unwrap()), names),
            "struct" | "enum" | "union" | "trait" | "type" => {
                names.extend(identifiers(rest).into_iter().take(1));
            }
            _ => {}
        }
    }
}

#[test]
fn every_public_type_is_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs");
    let mut names = BTreeSet::new();
    shown(&root, &mut names);
    assert!(names.len() > 50, "{names:?}");
    let listed: BTreeSet<String> = LISTED.iter().map(|l| name(l)).collect();
    let missing: Vec<_> = names.difference(&listed).collect();
    let gone: Vec<_> = listed.difference(&names).collect();
    assert!(
        missing.is_empty() && gone.is_empty(),
        "missing: {missing:?}, gone: {gone:?}"
    );
}

/// Comments of the types that the files of a folder declare, commands left out.
fn comments(folder: &Path, found: &mut BTreeMap<String, String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.ends_with("src/bin") {
            continue;
        }
        if path.is_dir() {
            comments(&path, found);
            continue;
        }
        let mut comment = String::new();
        for line in std::fs::read_to_string(&path).unwrap().lines() {
            if let Some(text) = line.strip_prefix("///") {
                comment += &format!("{}\n", text.trim());
            } else if line.is_empty() {
                comment.clear();
            } else if let Some(declared) = line.strip_prefix("pub ") {
                let mut words = declared.split(|c: char| !c.is_alphanumeric());
                let keyword = words.next().unwrap();
                if ["struct", "enum", "union", "trait", "type"].contains(&keyword) {
                    let name = words.next().unwrap().to_owned();
                    *found.entry(name).or_default() += &std::mem::take(&mut comment);
                }
            }
        }
    }
}

/// A block that is neither of another language nor only compiled.
fn has_example(comment: &str) -> bool {
    comment.lines().filter(|line| *line == "```").count() >= 2
}

#[test]
fn every_public_type_has_an_example_that_runs() {
    let mut found = BTreeMap::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    comments(&root, &mut found);
    let without: Vec<String> = LISTED
        .iter()
        .map(|listed| name(listed))
        .filter(|name| !found.get(name).is_some_and(|text| has_example(text)))
        .collect();
    assert!(without.is_empty(), "no example: {without:?}");
}
