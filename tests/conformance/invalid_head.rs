//! Heads that break a rule of sections 3 and 4 at one end of a range: files without chunks.

use welkin::format::{Head, encode, parse};

use crate::files::small;
use crate::invalid::{Case, HeadOffsets, forged};

pub fn all() -> Vec<Case> {
    [scalars(), tables(), counts(), close_nodes(), absorbers()].concat()
}

fn case(name: &'static str, shows: &'static str, bytes: Vec<u8>) -> Case {
    Case {
        name,
        shows,
        class: "value",
        needs: Vec::new(),
        bytes,
    }
}

fn bare(head: &Head) -> Vec<u8> {
    encode(head, &[]).expect("a valid model")
}

/// Of two constituents.
fn absorbers() -> Vec<Case> {
    let good = bare(&small(&[0.0], &[50e3]));
    let bits = |bits: u32| forged(&good, 12, &(bits << 16).to_le_bytes());
    vec![
        case("absorbers-all", "no constituent scatters", bits(0b11)),
        Case {
            class: "feature",
            ..case(
                "absorbers-third",
                "a third of two constituents absorbs",
                bits(0b100),
            )
        },
    ]
}

/// Numbers of the header.
fn scalars() -> Vec<Case> {
    let good = bare(&small(&[0.0], &[50e3]));
    let header =
        |name, shows, at, value: f64| case(name, shows, forged(&good, at, &value.to_le_bytes()));
    vec![
        header("radius-large", "a planet of 2e9 m", 64, 2e9),
        header("radius-nan", "a radius that is not a number", 64, f64::NAN),
        header("top-large", "an atmosphere of 2e9 m", 72, 2e9),
        header("top-last", "the top is at the last altitude", 72, 0.0),
        header("exponent-small", "an up exponent below 1", 80, 0.99),
        header("exponent-down", "a down exponent of 9", 88, 9.0),
        header("exponent-down-small", "a down exponent below 1", 88, 0.5),
        header("elevation-min", "elevation_min below -pi/2", 96, -1.58),
        header("elevation-max", "elevation_max above pi/2", 104, 1.58),
        header(
            "elevation-equal",
            "elevation_max is elevation_min",
            104,
            (-4.2f64).to_radians(),
        ),
        header("elevation-centre", "elevation_centre above pi/2", 112, 2.0),
        header("elevation-width-large", "an axis width of 1e7", 120, 1e7),
    ]
}

/// Numbers of the head arrays, at the other end than those of `invalid`.
fn tables() -> Vec<Case> {
    let good = bare(&small(&[0.0], &[50e3]));
    let head = parse(&good).expect("a valid file").head;
    let nw = head.wavelengths.len();
    let HeadOffsets {
        visibility,
        extinction,
        spherical,
        parameter,
        xyz,
        solar,
        irradiance,
        field,
        ..
    } = HeadOffsets::of(&head);
    let number =
        |name, shows, at, value: f64| case(name, shows, forged(&good, at, &value.to_le_bytes()));
    let single =
        |name, shows, at, value: f32| case(name, shows, forged(&good, at, &value.to_le_bytes()));
    let last = 128 + 8 * (nw - 1);
    vec![
        number("wavelength-large", "a wavelength above 1e6 nm", last, 2e6),
        number(
            "visibility-large",
            "a visibility above 1e9 m",
            visibility,
            2e9,
        ),
        number(
            "extinction-large",
            "an extinction above 1e6",
            extinction,
            2e6,
        ),
        number(
            "extinction-nan",
            "an extinction that is not a number",
            extinction,
            f64::NAN,
        ),
        number(
            "spherical-negative",
            "a negative spherical albedo",
            spherical,
            -0.1,
        ),
        number(
            "parameter-infinite",
            "an infinite parameter without phase function",
            parameter,
            f64::INFINITY,
        ),
        number(
            "depolarisation-negative",
            "a depolarisation below 0",
            parameter + 8 * nw,
            -0.1,
        ),
        number(
            "asymmetry-negative",
            "an asymmetry of -1",
            parameter + 16 * nw,
            -1.0,
        ),
        number(
            "xyz-nan",
            "a colour weight that is not a number",
            xyz,
            f64::NAN,
        ),
        number(
            "solar-start-negative",
            "a negative start of the solar spectrum",
            solar,
            -1.0,
        ),
        number("solar-step-zero", "a solar step below 1e-3", solar + 8, 0.0),
        number("solar-step-large", "a solar step above 1e6", solar + 8, 2e6),
        single(
            "solar-infinite",
            "an infinite irradiance",
            irradiance,
            f32::INFINITY,
        ),
        case(
            "field-ground",
            "an unknown phase function of the ground",
            forged(&good, field, &0x0001_0003u32.to_le_bytes()),
        ),
    ]
}

/// The counts that give the length of head arrays.
#[derive(Clone, Copy)]
struct Counts {
    wavelengths: usize,
    altitudes: usize,
    visibilities: usize,
    fields: usize,
    constituents: usize,
    solar: usize,
    /// Up, down, azimuth, elevation.
    intervals: [usize; 4],
}

const FEW: Counts = Counts {
    wavelengths: 2,
    altitudes: 1,
    visibilities: 1,
    fields: 1,
    constituents: 1,
    solar: 2,
    intervals: [1; 4],
};

fn counts() -> Vec<Case> {
    let with = |name, shows, change: &dyn Fn(&mut Counts)| {
        let mut counts = FEW;
        change(&mut counts);
        case(name, shows, counted(counts))
    };
    let intervals = |name, shows, axis: usize, n| {
        with(name, shows, &move |c: &mut Counts| c.intervals[axis] = n)
    };
    vec![
        with("count-wavelengths", "one wavelength", &|c| {
            c.wavelengths = 1
        }),
        with("count-wavelengths-large", "257 wavelengths", &|c| {
            c.wavelengths = 257
        }),
        with("count-altitudes", "no altitude", &|c| c.altitudes = 0),
        with("count-altitudes-large", "1025 altitudes", &|c| {
            c.altitudes = 1025
        }),
        with("count-visibilities", "no visibility", &|c| {
            c.visibilities = 0
        }),
        with("count-visibilities-large", "1025 visibilities", &|c| {
            c.visibilities = 1025
        }),
        with("count-fields", "no field", &|c| c.fields = 0),
        with("count-fields-large", "17 fields", &|c| c.fields = 17),
        with("count-constituents", "no constituent", &|c| {
            c.constituents = 0
        }),
        with("count-constituents-large", "17 constituents", &|c| {
            c.constituents = 17
        }),
        with("count-solar", "one solar sample", &|c| c.solar = 1),
        with("count-solar-large", "16385 solar samples", &|c| {
            c.solar = 16385
        }),
        intervals("count-up", "an up axis without intervals", 0, 0),
        intervals("count-up-large", "an up axis of 1025 intervals", 0, 1025),
        intervals("count-down", "a down axis without intervals", 1, 0),
        intervals("count-down-large", "a down axis of 1025 intervals", 1, 1025),
        intervals("count-phi", "an azimuth axis without intervals", 2, 0),
        intervals(
            "count-phi-large",
            "an azimuth axis of 1025 intervals",
            2,
            1025,
        ),
        intervals(
            "count-elevation",
            "an elevation axis without intervals",
            3,
            0,
        ),
        intervals(
            "count-elevation-large",
            "an elevation axis of 1025 intervals",
            3,
            1025,
        ),
        with(
            "coefficients",
            "more than 2^24 coefficients of a sky",
            &|c| {
                c.intervals = [1024, 1021, 1023, 1];
                c.fields = 4;
            },
        ),
    ]
}

/// A head of these counts, with nothing else to complain about.
fn counted(counts: Counts) -> Vec<u8> {
    let Counts {
        wavelengths: nw,
        altitudes: na,
        visibilities: nv,
        fields: nf,
        constituents: nk,
        solar: ns,
        intervals,
    } = counts;
    let mut bytes = bare(&small(&[0.0], &[50e3]))[..128].to_vec();
    let steps = |n: usize, first: f64, step: f64| (0..n).map(move |i| first + step * i as f64);
    let even = |n: usize, value: f64| std::iter::repeat_n(value, n);
    let doubles = steps(nw, 400.0, 1.0)
        .chain(steps(na, 0.0, 10.0))
        .chain(steps(nv, 20e3, 100.0))
        .chain(even(nv * nk * nw, 1e-5))
        .chain(even(nv * nw + nf * nw + 3 * nw, 0.5))
        .chain([300.0, 1000.0]);
    bytes.extend(doubles.flat_map(f64::to_le_bytes));
    bytes.extend(even(ns, 1.0).flat_map(|v| (v as f32).to_le_bytes()));
    bytes.extend(std::iter::repeat_n(0u32, nf).flat_map(u32::to_le_bytes));
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    let [up, down, phi, elevation] = intervals;
    for (i, count) in [nw, na, nv, nf, nk, up, down, phi, elevation, ns]
        .into_iter()
        .enumerate()
    {
        bytes[40 + 2 * i..][..2].copy_from_slice(&(count as u16).to_le_bytes());
    }
    let length = (bytes.len() as u64).to_le_bytes();
    bytes[16..24].copy_from_slice(&length);
    bytes[24..32].copy_from_slice(&length);
    bytes[60..64].fill(0);
    bytes[32..36].fill(0);
    let crc = crc32fast::hash(&bytes);
    bytes[32..36].copy_from_slice(&crc.to_le_bytes());
    bytes
}

/// Nodes that increase, but too little to divide by.
fn close_nodes() -> Vec<Case> {
    let good = bare(&small(&[500.0, 900.0], &[25e3, 75e3]));
    let nw = parse(&good).expect("a valid file").head.wavelengths.len();
    let (altitude, visibility) = (128 + 8 * nw, 128 + 8 * nw + 16);
    let pair = |name, shows, at, [a, b]: [f64; 2]| {
        case(
            name,
            shows,
            forged(&good, at, &[a.to_le_bytes(), b.to_le_bytes()].concat()),
        )
    };
    let next = |v: f64| [v, v.next_up()];
    // The reciprocal of a number just below a power of two changes by a quarter of its last digit.
    let far = 131_072f64.next_down().next_down();
    assert!(1.0 / far == 1.0 / far.next_up() && 500f64.cbrt() == 500f64.next_up().cbrt());
    vec![
        pair("altitude-order", "altitudes fall", altitude, [900.0, 500.0]),
        pair(
            "altitude-close",
            "two altitudes with the same cube root",
            altitude,
            next(500.0),
        ),
        pair(
            "visibility-order",
            "visibilities fall",
            visibility,
            [75e3, 25e3],
        ),
        pair(
            "visibility-close",
            "two visibilities with the same inverse",
            visibility,
            next(far),
        ),
    ]
}

#[test]
fn heads_of_these_counts_are_valid_where_the_counts_are() {
    let problems = welkin::format::verify(&counted(FEW));
    assert!(problems.is_empty(), "{problems:?}");
}
