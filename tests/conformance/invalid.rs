//! Files that readers must refuse, each for one reason.

use welkin::format::{ENCODING_ZSTD, Head, encode, parse, recode};

use crate::axis;
use crate::common;
use crate::files::{minimal, small};
use crate::{invalid_chunks, invalid_estimate, invalid_head, invalid_segments, invalid_spectrum};

#[derive(Clone)]
pub struct Case {
    pub name: &'static str,
    pub shows: &'static str,
    pub class: &'static str,
    pub needs: Vec<&'static str>,
    pub bytes: Vec<u8>,
}

impl Case {
    /// What a reader is asked to find out.
    pub fn quantity(&self) -> &'static str {
        match self.needs.first() {
            Some(&"transmittance") => "transmittance",
            Some(&"aerial-perspective") => "in_scattering",
            Some(&"polarisation") => "stokes",
            Some(&"axis") => axis::QUANTITY,
            _ if self.name.starts_with("spectrum") => "relative_radiance_at",
            _ => "relative_radiance",
        }
    }
}

const TWO_F64: [f64; 2] = [f64::NAN, f64::INFINITY];

/// A change of bytes at a place in a file of which all checksums are made right afterwards.
struct Forgery {
    name: &'static str,
    shows: &'static str,
    class: &'static str,
    at: usize,
    bytes: Vec<u8>,
}

pub fn all() -> Vec<Case> {
    let good = good();
    let mut cases = damaged(&good);
    cases.extend(forgeries(&good).into_iter().map(|forgery| Case {
        name: forgery.name,
        shows: forgery.shows,
        class: forgery.class,
        needs: Vec::new(),
        bytes: forged(&good, forgery.at, &forgery.bytes),
    }));
    cases.push(twice(&good));
    cases.push(trailing(&good));
    cases.extend(compressed());
    cases.extend(invalid_head::all());
    cases.extend(invalid_chunks::all());
    cases.extend(invalid_segments::all());
    cases.extend(invalid_spectrum::all());
    cases.extend(invalid_estimate::all());
    cases.extend(axis::invalid());
    cases
}

/// One altitude, one visibility, at which every invalid file is asked.
fn good() -> Vec<u8> {
    let head = small(&[0.0], &[50e3]);
    encode(&head, &common::chunks(&head)).expect("a valid model")
}

fn damaged(good: &[u8]) -> Vec<Case> {
    let case = |name, shows, class, bytes| Case {
        name,
        shows,
        class,
        needs: Vec::new(),
        bytes,
    };
    let flipped = |at: usize| {
        let mut bytes = good.to_vec();
        bytes[at] ^= 0x10;
        bytes
    };
    let contents = parse(good).expect("a valid file");
    vec![
        case("empty", "no bytes", "magic", Vec::new()),
        case(
            "png",
            "another format",
            "magic",
            b"\x89PNG\r\n\x1a\n".repeat(40),
        ),
        case(
            "text-mode",
            "line ends were converted",
            "magic",
            good_in_text_mode(good),
        ),
        case(
            "short-header",
            "ends within the header",
            "length",
            good[..100].to_vec(),
        ),
        case(
            "short-head",
            "ends within the head",
            "length",
            good[..contents.head_length - 1].to_vec(),
        ),
        case(
            "short",
            "the last byte is missing",
            "length",
            good[..good.len() - 1].to_vec(),
        ),
        case("long", "a byte too many", "length", [good, &[0]].concat()),
        case(
            "head-damaged",
            "a flipped bit in the axes",
            "checksum",
            flipped(130),
        ),
        case(
            "chunk-damaged",
            "a flipped bit in a chunk",
            "checksum",
            flipped(contents.directory[2].offset + 3),
        ),
    ]
}

fn good_in_text_mode(good: &[u8]) -> Vec<u8> {
    let mut bytes = good.to_vec();
    bytes.remove(4);
    bytes
}

/// Where the arrays of a head with one altitude and one visibility start.
pub struct HeadOffsets {
    pub wavelength: usize,
    pub altitude: usize,
    pub visibility: usize,
    pub extinction: usize,
    pub spherical: usize,
    pub parameter: usize,
    pub xyz: usize,
    pub solar: usize,
    pub irradiance: usize,
    pub field: usize,
    pub metadata: usize,
    pub padding: usize,
}

impl HeadOffsets {
    pub fn of(head: &Head) -> Self {
        let (nw, nf, nk) = (head.wavelengths.len(), head.fields.len(), head.constituents);
        let wavelength = 128;
        let altitude = wavelength + 8 * nw;
        let visibility = altitude + 8;
        let extinction = visibility + 8;
        let spherical = extinction + 8 * nk * nw;
        let parameter = spherical + 8 * nw;
        let xyz = parameter + 8 * nf * nw;
        let solar = xyz + 24 * nw;
        let irradiance = solar + 16;
        let field = irradiance + 4 * head.solar_irradiance.len();
        let metadata = field + 4 * nf;
        Self {
            wavelength,
            altitude,
            visibility,
            extinction,
            spherical,
            parameter,
            xyz,
            solar,
            irradiance,
            field,
            metadata,
            padding: metadata + head.metadata.len(),
        }
    }
}

fn forgeries(good: &[u8]) -> Vec<Forgery> {
    let contents = parse(good).expect("a valid file");
    let head = &contents.head;
    let HeadOffsets {
        wavelength,
        altitude,
        visibility,
        extinction,
        spherical,
        parameter,
        xyz,
        solar,
        irradiance,
        field,
        metadata,
        padding,
    } = HeadOffsets::of(head);
    let nw = head.wavelengths.len();
    let entry = |i: usize| contents.head_length - 64 * (contents.directory.len() - i);
    let column = &contents.directory[1];
    let forge = |name, shows, class, at, bytes: &[u8]| Forgery {
        name,
        shows,
        class,
        at,
        bytes: bytes.to_vec(),
    };
    let value = |name, shows, at, v: f64| forge(name, shows, "value", at, &v.to_le_bytes());
    let single = |name, shows, at, v: f32| forge(name, shows, "value", at, &v.to_le_bytes());
    let mut all = vec![
        forge("version", "another major version", "version", 8, &[99, 0]),
        forge(
            "feature",
            "a required feature that nobody knows",
            "feature",
            12,
            &(1u32 << 31).to_le_bytes(),
        ),
        forge(
            "head-length",
            "head_length is not what the counts give",
            "length",
            24,
            &(contents.head_length as u64 + 8).to_le_bytes(),
        ),
        value(
            "wavelength-order",
            "wavelengths do not increase",
            wavelength + 8,
            320.0,
        ),
        value(
            "wavelength-range",
            "a wavelength below 1 nm",
            wavelength,
            0.5,
        ),
        value(
            "altitude-negative",
            "an altitude below the ground",
            altitude,
            -1.0,
        ),
        value(
            "visibility-range",
            "a visibility below 1 m",
            visibility,
            0.5,
        ),
        value(
            "extinction-negative",
            "a negative extinction",
            extinction,
            -1e-6,
        ),
        value(
            "spherical-albedo",
            "a spherical albedo of 1",
            spherical,
            1.0,
        ),
        value(
            "depolarisation",
            "a depolarisation above 1",
            parameter + 8 * nw,
            1.5,
        ),
        value("asymmetry", "an asymmetry of 1", parameter + 16 * nw, 1.0),
        value("xyz-range", "a colour weight of 1e31", xyz, 1e31),
        value(
            "solar-start",
            "the solar spectrum starts after the first wavelength",
            solar,
            321.0,
        ),
        value(
            "solar-step",
            "the solar spectrum ends before the last wavelength",
            solar + 8,
            10.0,
        ),
        single("solar-negative", "a negative irradiance", irradiance, -1.0),
        forge(
            "field-phase",
            "an unknown phase function",
            "value",
            field,
            &7u32.to_le_bytes(),
        ),
        forge(
            "field-bits",
            "an unknown bit of a field",
            "value",
            field,
            &(1u32 << 20).to_le_bytes(),
        ),
        forge(
            "metadata-utf8",
            "metadata is not UTF-8",
            "value",
            metadata + 5,
            &[0xff],
        ),
        value("radius", "a planet of 10 m", 64, 10.0),
        value("top", "the atmosphere ends below the observer", 72, -5.0),
        value("exponent", "an axis exponent of 9", 80, 9.0),
        value(
            "elevation-order",
            "elevation_max below elevation_min",
            104,
            -1.0,
        ),
        value("elevation-width", "an axis width of zero", 120, 0.0),
        forge(
            "entry-offset",
            "a hole between chunks",
            "value",
            entry(2) + 8,
            &(contents.directory[2].offset as u64 + 64).to_le_bytes(),
        ),
        forge(
            "entry-length",
            "a chunk that reaches beyond the file",
            "value",
            entry(2) + 16,
            &u64::MAX.to_le_bytes(),
        ),
        forge(
            "entry-raw-length",
            "raw_length is not what the shape gives",
            "value",
            entry(1) + 24,
            &(column.raw_length as u64 + 4).to_le_bytes(),
        ),
        forge(
            "entry-altitude",
            "an index beyond the altitude axis",
            "value",
            entry(1) + 4,
            &1u16.to_le_bytes(),
        ),
        forge(
            "entry-visibility",
            "a column with a visibility",
            "value",
            entry(1) + 6,
            &0u16.to_le_bytes(),
        ),
        forge(
            "entry-rank",
            "a radiance chunk of rank 0",
            "value",
            entry(2) + 40,
            &0u32.to_le_bytes(),
        ),
        forge(
            "basis-rank",
            "a basis of a smaller rank than its chunks",
            "value",
            entry(0) + 40,
            &4u32.to_le_bytes(),
        ),
        forge(
            "entry-tier",
            "a tier other than 0",
            "value",
            entry(1) + 44,
            &1u32.to_le_bytes(),
        ),
        single("entry-error", "a negative error", entry(1) + 48, -0.5),
        forge(
            "entry-encoding",
            "an unknown encoding",
            "encoding",
            entry(1) + 32,
            &77u32.to_le_bytes(),
        ),
        single(
            "column-nan",
            "NaN in a column chunk",
            column.offset + 4,
            f32::NAN,
        ),
        single(
            "factor-infinite",
            "infinity in a radiance chunk",
            contents.directory[2].offset,
            f32::INFINITY,
        ),
    ];
    if !padding.is_multiple_of(8) {
        all.push(forge(
            "padding",
            "bytes after the metadata are not zero",
            "value",
            padding,
            &[1],
        ));
    }
    for (name, v) in ["wavelength-nan", "wavelength-infinite"]
        .into_iter()
        .zip(TWO_F64)
    {
        all.push(value(
            name,
            "a wavelength that is not finite",
            wavelength,
            v,
        ));
    }
    all
}

pub fn forged(good: &[u8], at: usize, change: &[u8]) -> Vec<u8> {
    let mut bytes = good.to_vec();
    bytes[at..at + change.len()].copy_from_slice(change);
    common::seal(&mut bytes, good);
    bytes
}

/// The header knows of the bytes, the directory does not.
fn trailing(good: &[u8]) -> Case {
    let mut bytes = [good, &[0; 64]].concat();
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    common::seal(&mut bytes, good);
    Case {
        name: "trailing",
        shows: "bytes after the last chunk",
        class: "value",
        needs: Vec::new(),
        bytes,
    }
}

fn twice(good: &[u8]) -> Case {
    Case {
        name: "entry-twice",
        shows: "two chunks for the same conditions",
        class: "value",
        needs: Vec::new(),
        bytes: common::with_entry(good, |_| {}),
    }
}

/// Compressed chunks that lie.
fn compressed() -> Vec<Case> {
    let packed = recode(&minimal(), ENCODING_ZSTD).expect("a valid model");
    let contents = parse(&packed).expect("a valid file");
    let index = contents
        .directory
        .iter()
        .position(|e| e.encoding == ENCODING_ZSTD);
    let index = index.expect("something that shrinks");
    let entry = &contents.directory[index];
    let frame = packed[entry.offset..entry.offset + entry.length].to_vec();
    let shorter = zstd::bulk::compress(&vec![0; entry.raw_length - 4], 3).expect("a frame");
    let case = |name, shows, needs, stored: &[u8]| Case {
        name,
        shows,
        class: "value",
        needs,
        bytes: common::with_chunk(&packed, index, stored),
    };
    let zstd = || vec!["zstd"];
    vec![
        case(
            "zstd-short",
            "a frame that ends early",
            zstd(),
            &frame[..frame.len() - 2],
        ),
        case(
            "zstd-length",
            "a frame with less content than raw_length",
            zstd(),
            &shorter,
        ),
        case(
            "zstd-trailing",
            "bytes after the frame",
            zstd(),
            &[&frame[..], &[0; 4]].concat(),
        ),
        case(
            "zstd-two-frames",
            "two frames",
            zstd(),
            &[&frame[..], &frame[..]].concat(),
        ),
        case(
            "zstd-bomb",
            "raw_length is more than 256 times stored_length",
            vec![],
            &frame[..1],
        ),
    ]
}
