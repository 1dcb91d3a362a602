//! The spectrum chunk (kind 9) in files: written, read, recoded, cropped, refused. Format specification, section 6.9.

mod common;

use common::spectrum::{chunk, spectrum, with_spectrum};
use welkin::format::{
    Chunk, ENCODING_ZSTD, FEATURE_SPECTRUM, Head, Kind, Payload, Selection, Spectrum, crop, encode,
    extend, parse, recode, unpack, verify,
};
use welkin::{Conditions, Model, PointQuery};

fn head() -> Head {
    common::head(&[0.0, 120.0], &[20e3, 59.4e3, 131.8e3])
}

fn file() -> Vec<u8> {
    let head = head();
    encode(&head, &with_spectrum(&head, common::chunks(&head))).unwrap()
}

/// `version_minor` and `required_features`.
fn declared(file: &[u8]) -> (u16, u32) {
    let minor = u16::from_le_bytes([file[10], file[11]]);
    (minor, u32::from_le_bytes(file[12..16].try_into().unwrap()))
}

fn spectrum_of(file: &[u8]) -> Option<Spectrum> {
    let (_, chunks) = unpack(file).unwrap();
    chunks.into_iter().find_map(|chunk| match chunk.payload {
        Payload::Spectrum(spectrum) => Some(spectrum),
        _ => None,
    })
}

/// The error of a file with this spectrum.
fn refusal(change: impl Fn(&mut Spectrum)) -> welkin::Error {
    let head = head();
    let mut spectrum = spectrum(&head);
    change(&mut spectrum);
    let chunk = Chunk::new(None, None, Payload::Spectrum(spectrum));
    encode(&head, &[chunk]).unwrap_err()
}

#[test]
fn comes_back_as_it_was_written() {
    let file = file();
    assert_eq!(spectrum_of(&file), Some(spectrum(&head())));
    assert!(verify(&file).is_empty());
    Model::from_bytes(file).unwrap().verify().unwrap();
}

#[test]
fn files_declare_it_and_only_then_are_of_version_1_1() {
    let plain = common::model_bytes();
    assert_eq!(declared(&plain), (0, 0));
    assert_eq!(declared(&file()), (1, FEATURE_SPECTRUM));
    let head = parse(&plain).unwrap().head;
    let extended = extend(&plain, &[chunk(&head)]).unwrap();
    assert_eq!(declared(&extended), (1, FEATURE_SPECTRUM));
    let packed = recode(&extended, ENCODING_ZSTD).unwrap();
    assert_eq!(declared(&packed), (1, FEATURE_SPECTRUM));
    assert_eq!(spectrum_of(&packed), spectrum_of(&extended));
    assert_eq!(declared(&recode(&plain, ENCODING_ZSTD).unwrap()), (0, 0));
}

#[test]
fn bit_and_chunk_come_together() {
    let (plain, file) = (common::model_bytes(), file());
    for (good, bits, class) in [
        (&plain, FEATURE_SPECTRUM, "value"),
        (&file, 0, "value"),
        (&file, 5, "feature"),
        (&file, 3, "value"),
        (&plain, 2, "value"),
        (&plain, 1 << 31, "feature"),
    ] {
        let mut bytes = good.clone();
        bytes[12..16].copy_from_slice(&bits.to_le_bytes());
        common::seal(&mut bytes, good);
        assert_eq!(parse(&bytes).unwrap_err().class(), class, "{bits:#x}");
        let Err(error) = PointQuery::new(&bytes) else {
            panic!("a point query takes the bits {bits:#x}");
        };
        assert_eq!(error.class(), class, "{bits:#x}");
    }
    PointQuery::new(&file).unwrap();
}

#[test]
fn the_range_of_wavelengths_is_that_of_the_cells() {
    let (plain, model) = (
        Model::from_bytes(common::model_bytes()).unwrap(),
        Model::from_bytes(file()).unwrap(),
    );
    assert_eq!(plain.wavelength_range().unwrap(), [320.0, 760.0]);
    let cells = spectrum(model.head()).wavelength;
    let [first, last] = model.wavelength_range().unwrap();
    assert_eq!([first, last], [cells[0], cells[cells.len() - 1]]);
    assert_ne!([first, last], [320.0, 760.0]);
}

#[test]
fn damage_shows_where_it_is_asked_for() {
    let mut file = file();
    let contents = parse(&file).unwrap();
    let entry = contents.directory[contents.index[&(Kind::Spectrum, None, None)]];
    file[entry.offset + 40] ^= 1;
    assert_eq!(verify(&file).len(), 1);
    let model = Model::from_bytes(file).unwrap();
    assert_eq!(model.wavelength_range().unwrap_err().class(), "checksum");
    let conditions = Conditions::default();
    assert_eq!(model.sky(&conditions).unwrap_err().class(), "checksum");
    // Colour does not depend on it.
    let sky = model.colour_sky(&conditions).unwrap();
    assert!(sky.xyz([0.0, 0.0, 1.0]).unwrap()[1] > 0.0);
}

#[test]
fn is_not_read_for_colour() {
    let model = Model::stream(file()).unwrap();
    let length = model.directory().iter().find(|e| e.kind == Kind::Spectrum);
    let length = length.unwrap().length;
    let conditions = Conditions::default();
    model.colour_sky(&conditions).unwrap();
    let touched = model.touched_bytes();
    model.sky(&conditions).unwrap();
    assert_eq!(model.touched_bytes(), touched + length);
}

#[test]
fn stays_where_all_nodes_with_a_weight_do() {
    let (mut head, mut chunks) = unpack(&file()).unwrap();
    let before = spectrum(&head);
    // All but the last node: nobody uses that.
    let used: Vec<usize> = (0..5).collect();
    for chunk in &mut chunks {
        if let Payload::Spectrum(spectrum) = &mut chunk.payload {
            for (node, weight) in spectrum.tap_node.iter_mut().zip(&mut spectrum.tap_weight) {
                if *node == 5 {
                    *weight = 0.0;
                }
            }
        }
    }
    let selection = Selection {
        visibilities: vec![0, 2],
        wavelengths: used.clone(),
        ..Selection::all(&head)
    };
    crop(&mut head, &mut chunks, &selection).unwrap();
    let cropped = encode(&head, &chunks).unwrap();
    assert_eq!(declared(&cropped), (1, FEATURE_SPECTRUM));
    let after = spectrum_of(&cropped).unwrap();
    let row = head.constituents * before.wavelength.len();
    assert_eq!(after.extinction[..row], before.extinction[..row]);
    assert_eq!(after.extinction[row..], before.extinction[2 * row..]);
    assert_eq!(after.example[5..10], before.example[6..11]);
    // Where a node goes that counts, the spectrum goes with it.
    let selection = Selection {
        wavelengths: vec![0, 1, 3, 4],
        ..Selection::all(&head)
    };
    crop(&mut head, &mut chunks, &selection).unwrap();
    let cropped = encode(&head, &chunks).unwrap();
    assert_eq!(declared(&cropped), (0, 0));
    assert_eq!(spectrum_of(&cropped), None);
}

#[test]
fn writers_refuse_what_readers_do() {
    type Change<'a> = &'a dyn Fn(&mut Spectrum);
    let broken: [(&str, Change); 15] = [
        ("a node that is none", &|s| s.tap_node[4] = 6),
        ("a weight beyond 1e3", &|s| s.tap_weight[0] = 1.001e3),
        ("a weight that is no number", &|s| {
            s.tap_weight[7] = f32::NAN
        }),
        ("cells that do not increase", &|s| {
            s.wavelength[3] = s.wavelength[2]
        }),
        ("a cell before the sun", &|s| s.wavelength[0] = 299.0),
        ("a cell after the sun", &|s| s.wavelength[8] = 801.0),
        ("a negative extinction", &|s| s.extinction[1] = -1e-9),
        ("an infinite extinction", &|s| {
            s.extinction[1] = f32::INFINITY
        }),
        ("a share above 1", &|s| {
            s.term_weight[1..3].copy_from_slice(&[1.1, -0.1])
        }),
        ("shares of sum 1.0001", &|s| s.term_weight[0] += 1e-4),
        ("lines that shine", &|s| s.term_extinction[0] = -1e-9),
        ("an example of 101", &|s| s.example[0] = 101.0),
        ("no taps", &|s| {
            (s.taps, s.tap_node, s.tap_weight) = (0, vec![], vec![])
        }),
        ("half an example", &|s| s.example.truncate(3)),
        ("a table that is too short", &|s| s.extinction.truncate(1)),
    ];
    for (what, change) in broken {
        let class = refusal(change).class();
        assert!(["value", "length"].contains(&class), "{what}: {class}");
    }
}

/// −0 is 0, and shares may be off by rounding.
#[test]
fn edges_of_rules_are_within_them() {
    let head = head();
    let mut edge = spectrum(&head);
    edge.tap_weight[..3].copy_from_slice(&[1e3, -1e3, -0.0]);
    edge.extinction[0] = -0.0;
    edge.term_weight[1] += 5e-6;
    edge.term_extinction[3] = 1e6;
    edge.wavelength[0] = head.solar_start;
    edge.wavelength[8] = 800.0;
    let chunk = Chunk::new(None, None, Payload::Spectrum(edge.clone()));
    assert_eq!(spectrum_of(&encode(&head, &[chunk]).unwrap()), Some(edge));
}
