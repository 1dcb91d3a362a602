//! EXR files in other colour spaces, numbers and compressions.
#![cfg(all(unix, feature = "cli"))]

mod common;

use std::path::Path;
use std::process::Output;

use common::command::welkin;
use exr::prelude::{Compression, FlatImage, FlatSamples, Vec2, read_all_flat_layers_from_file};
use welkin::ColourSpace;

const RENDER: &str = "render --projection lat-long --size 16 --sun-elevation 12";

fn run(folder: &Path, line: &str) -> Output {
    let output = welkin(folder, &line.split(' ').collect::<Vec<_>>())
        .output()
        .unwrap();
    assert!(output.status.success(), "{line}: {output:?}");
    output
}

fn read(folder: &Path, file: &str) -> FlatImage {
    read_all_flat_layers_from_file(folder.join(file)).unwrap()
}

fn channel(image: &FlatImage, name: &str) -> Vec<f32> {
    let channels = &image.layer_data[0].channel_data.list;
    let channel = channels.iter().find(|c| c.name.eq(name));
    channel.unwrap().sample_data.values_as_f32().collect()
}

fn colours(image: &FlatImage, layer: &str) -> Vec<[f32; 3]> {
    let [r, g, b] = ["R", "G", "B"].map(|c| channel(image, &format!("{layer}{c}")));
    (0..r.len()).map(|i| [r[i], g[i], b[i]]).collect()
}

#[test]
fn colours_are_those_of_the_space_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    run(folder, &format!("{RENDER} --stokes --out srgb.exr"));
    let srgb = read(folder, "srgb.exr");
    for space in ColourSpace::ALL {
        let line = format!("{RENDER} --stokes --colour-space {space} --out s.exr");
        run(folder, &line);
        let image = read(folder, "s.exr");
        let primaries = image.attributes.chromaticities.unwrap();
        let [red, .., white] = space.chromaticities().map(|[x, y]| Vec2(x, y));
        assert_eq!((primaries.red, primaries.white), (red, white));
        for layer in ["", "S0.", "S1."] {
            let pixels = colours(&srgb, layer)
                .into_iter()
                .zip(colours(&image, layer));
            for (from, to) in pixels {
                assert_eq!(space.from_linear_srgb(from), to, "{space} {layer}");
            }
        }
    }
}

#[test]
fn volumes_are_in_the_space_too() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    run(folder, "froxels --size 3x3x2 --out a.exr");
    run(
        folder,
        "froxels --size 3x3x2 --colour-space acescg --out b.exr",
    );
    let [srgb, acescg] = ["a.exr", "b.exr"].map(|file| read(folder, file));
    for slice in ["slice000.", "slice001."] {
        for (a, b) in colours(&srgb, slice)
            .into_iter()
            .zip(colours(&acescg, slice))
        {
            let expected = ColourSpace::AcesCg.from_linear_srgb(a);
            assert!((0..3).all(|c| (b[c] - expected[c]).abs() < 1e-4 * expected[1]));
        }
    }
    let red = |image| channel(image, "slice001.TR");
    // Wider primaries are hazed a little differently.
    assert!(red(&srgb) != red(&acescg));
    assert!(
        red(&srgb)
            .iter()
            .zip(red(&acescg))
            .all(|(a, b)| (a - b).abs() < 0.05)
    );
}

#[test]
fn half_precision_says_what_it_loses() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let quiet = run(folder, &format!("{RENDER} --out a.exr --exr-type half"));
    assert!(quiet.stderr.is_empty(), "{quiet:?}");
    run(folder, &format!("{RENDER} --out b.exr"));
    let [half, float] = ["a.exr", "b.exr"].map(|file| read(folder, file));
    let samples = &half.layer_data[0].channel_data.list[0].sample_data;
    assert!(matches!(samples, FlatSamples::F16(_)));
    for (a, b) in channel(&half, "G").iter().zip(channel(&float, "G")) {
        assert!((a - b).abs() <= 5e-4 * b);
    }
    let loud = run(
        folder,
        &format!("{RENDER} --sun --out c.exr --exr-type half"),
    );
    assert!(String::from_utf8_lossy(&loud.stderr).contains("beyond 65504"));
    let brightest = channel(&read(folder, "c.exr"), "G")
        .into_iter()
        .fold(0.0, f32::max);
    assert_eq!(brightest, 65504.0);
    let dark = format!("{RENDER} --spectral --out d.exr --exr-type half");
    assert!(String::from_utf8_lossy(&run(folder, &dark).stderr).contains("coarse"));
}

#[test]
fn every_compression_holds_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    run(folder, &format!("{RENDER} --out a.exr"));
    let plain = read(folder, "a.exr");
    for (name, expected) in [
        ("none", Compression::Uncompressed),
        ("rle", Compression::RLE),
        ("zips", Compression::ZIP1),
        ("zip", Compression::ZIP16),
        ("piz", Compression::PIZ),
    ] {
        run(
            folder,
            &format!("{RENDER} --exr-compression {name} --out b.exr"),
        );
        let image = read(folder, "b.exr");
        assert_eq!(image.layer_data[0].encoding.compression, expected);
        assert_eq!(colours(&image, ""), colours(&plain, ""));
    }
}
