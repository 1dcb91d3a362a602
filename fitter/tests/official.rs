//! Files of the official model: synthetic ones with every section, damaged ones, and the published ones where they are.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::FRAC_PI_2;
use welkin_fitter::official::error::OfficialError;
use welkin_fitter::official::layout::{
    Axes, Channels, Header, Node, PolarisationBreaks, RadianceBreaks,
};
use welkin_fitter::official::tables::{PolarisationTables, RadianceTables};
use welkin_fitter::official::transmittance::{Shape, Transmittance};
use welkin_fitter::official::{Note, Observer, OfficialData, Section, Writer};

/// Breaks that half precision has exactly, and so has the angle itself as a table.
fn breaks(from: i32, to: i32) -> Vec<f64> {
    (from..=to).map(|k| f64::from(k) / 16.0).collect()
}

fn header() -> Header {
    Header {
        axes: Axes {
            visibilities: vec![20.0, 40.0, 80.0],
            albedos: vec![0.0, 1.0],
            altitudes: vec![0.0, 1000.0],
            elevations: vec![-4.0, 0.0, 24.0, 88.0],
        },
        channels: Channels {
            count: 3,
            start: 400.0,
            width: 100.0,
        },
        breaks: RadianceBreaks {
            rank: 2,
            sun: breaks(-1, 51),
            zenith: breaks(-1, 51),
            emphasis: breaks(0, 51),
        },
    }
}

/// Linear in every condition, so that what lies between the nodes is known; at the nodes a few bits, so that half
/// precision has it exactly.
fn level(visibility: f64, albedo: f64, altitude: f64, elevation: f64, channel: usize) -> f64 {
    visibility / 20.0
        * (1.0 + albedo)
        * (1.0 + altitude / 1000.0)
        * (8.0 + elevation)
        * f64::from(1 << channel)
}

fn level_at(axes: &Axes, node: Node, channel: usize) -> f64 {
    level(
        axes.visibilities[node.visibility],
        axes.albedos[node.albedo],
        axes.altitudes[node.altitude],
        axes.elevations[node.elevation],
        channel,
    )
}

/// level · (2 + γ α).
fn radiance_tables(header: &Header, node: Node, channel: usize) -> RadianceTables {
    let level = level_at(&header.axes, node, channel) as f32;
    let breaks = &header.breaks;
    let single = |values: &[f64]| values.iter().map(|v| *v as f32).collect::<Vec<f32>>();
    let scaled = |values: Vec<f32>| values.into_iter().map(|v| level * v).collect::<Vec<f32>>();
    RadianceTables {
        sun: [vec![2.0; breaks.sun.len()], single(&breaks.sun)].concat(),
        zenith: scaled([vec![1.0; breaks.zenith.len()], single(&breaks.zenith)].concat()),
        emphasis: vec![1.0; breaks.emphasis.len()],
    }
}

fn polarisation_breaks() -> PolarisationBreaks {
    PolarisationBreaks {
        rank: 1,
        sun: breaks(0, 51),
        zenith: breaks(0, 51),
    }
}

/// −γ/8 · α/8 in every sky.
fn polarisation_tables(breaks: &PolarisationBreaks) -> PolarisationTables {
    let eighth =
        |values: &[f64], sign: f64| values.iter().map(|v| (sign * v / 8.0) as f32).collect();
    PolarisationTables {
        sun: eighth(&breaks.sun, 1.0),
        zenith: eighth(&breaks.zenith, -1.0),
    }
}

/// Root of the transmittance: 1 − (share of the longest arc)/2, in a channel times 1/(1 + channel).
fn transmittance(channels: Channels) -> Transmittance {
    let shape = Shape {
        arcs: 40,
        heights: 30,
        visibilities: 2,
        altitudes: 2,
        rank: 2,
    };
    let mut paths = vec![];
    for _ in 0..shape.altitudes {
        for arc in 0..shape.arcs {
            // Linear in the arc, which is the fourth power of the coordinate.
            let share = (arc as f32 / shape.arcs as f32).powi(4);
            (0..shape.heights).for_each(|_| paths.extend([1.0, share]));
        }
    }
    let mut airs = vec![];
    for _ in 0..shape.visibilities * shape.altitudes {
        for channel in 0..channels.count {
            let level = 1.0 / (1.0 + channel as f32);
            airs.extend([level, -0.5 * level]);
        }
    }
    let axes = [vec![0.0, 1000.0], vec![20.0, 100.0]];
    Transmittance::new(shape, channels, axes, [paths, airs]).unwrap()
}

/// A file with every section, and where they end.
fn file() -> (Vec<u8>, [usize; 4]) {
    let header = header();
    let mut writer = Writer::new(vec![], header.clone()).unwrap();
    for node in header.nodes() {
        for channel in 0..header.channels.count {
            writer
                .radiance(&radiance_tables(&header, node, channel))
                .unwrap();
        }
    }
    writer
        .transmittance(&transmittance(header.channels))
        .unwrap();
    let breaks = polarisation_breaks();
    writer.polarisation(&breaks).unwrap();
    for _ in 0..header.configurations() {
        writer
            .polarisation_tables(&polarisation_tables(&breaks))
            .unwrap();
    }
    let (bytes, length) = writer.finish().unwrap();
    assert_eq!(bytes.len() as u64, length);
    let radiance = header.configurations() * header.breaks.bytes();
    let polarisation = header.configurations() * breaks.bytes()
        + 12
        + 8 * (breaks.sun.len() + breaks.zenith.len()) as u64;
    let (whole, start) = (bytes.len(), bytes.len() - polarisation as usize);
    let through = 20 + 4 * (2 + 2 + 2 * 40 * 30 * 2 + 2 * 2 * 3 * 2);
    let ends = [
        start - through - radiance as usize,
        start - through,
        start,
        whole,
    ];
    (bytes, ends)
}

/// An observer right above the origin who is not raised.
fn observer(altitude: f64, solar_elevation: f64) -> Observer {
    Observer {
        viewpoint: [0.0, 0.0, altitude],
        raised: 0.0,
        solar_elevation: solar_elevation.to_radians(),
        solar_azimuth: 0.0,
    }
}

#[test]
fn what_is_written_is_read() {
    let (bytes, _) = file();
    let data = OfficialData::from_bytes(bytes).unwrap();
    let header = header();
    assert_eq!(data.header(), &header);
    assert_eq!(data.notes(), &[]);
    for (i, node) in header.nodes().enumerate().step_by(5) {
        let channel = i % 3;
        let tables = data.radiance_tables(node, channel).unwrap();
        assert_eq!(tables, radiance_tables(&header, node, channel));
        let breaks = polarisation_breaks();
        let polarised = data.polarisation_tables(node, channel).unwrap();
        assert_eq!(polarised, polarisation_tables(&breaks));
    }
    assert_eq!(
        data.transmittance().unwrap(),
        transmittance(header.channels)
    );
}

#[test]
fn radiance_between_nodes_is_multilinear() {
    let data = OfficialData::from_bytes(file().0).unwrap();
    for (visibility, albedo, elevation) in [(20e3, 0.0, 10.0), (37e3, 0.4, 55.0), (80e3, 1.0, 1.0)]
    {
        let sky = data
            .sky(&observer(0.0, elevation), visibility, albedo)
            .unwrap();
        for (turn, above) in [(0.3, 0.9), (2.0, 0.2), (3.0, 1.3f64)] {
            let direction = [
                above.cos() * f64::cos(turn),
                above.cos() * f64::sin(turn),
                above.sin(),
            ];
            let sun = elevation.to_radians();
            let gamma = (direction[0] * sun.cos() + direction[2] * sun.sin()).acos();
            let alpha = FRAC_PI_2 - above;
            for (channel, got) in sky.radiance(direction).unwrap().into_iter().enumerate() {
                let level = level(visibility / 1e3, albedo, 0.0, elevation, channel);
                let want = level * (2.0 + gamma * alpha);
                assert!((got / want - 1.0).abs() < 1e-6, "{got} {want}");
            }
        }
    }
}

/// Below the horizon the tables of the zenith angle are looked up by the angle to the axis of the Earth's shadow.
#[test]
fn after_sunset_the_shadow_counts() {
    let data = OfficialData::from_bytes(file().0).unwrap();
    let elevation = -2f64;
    let sky = data.sky(&observer(0.0, elevation), 20e3, 0.0).unwrap();
    let direction = [0.6, 0.0, 0.8];
    let sun = elevation.to_radians();
    let gamma = (0.6 * sun.cos() + 0.8 * sun.sin()).acos();
    let alpha = (0.8 * sun.cos() - 0.6 * sun.sin()).acos();
    let want = level(20.0, 0.0, 0.0, elevation, 0) * (2.0 + gamma * alpha);
    let got = sky.radiance(direction).unwrap()[0];
    assert!((got / want - 1.0).abs() < 1e-6, "{got} {want}");
}

/// The official code raises observers by 50 m; what it then takes for the zenith angle puts the geometric horizon at 90°.
#[test]
fn raised_observers_are_higher_and_see_the_horizon_at_a_right_angle() {
    let data = OfficialData::from_bytes(file().0).unwrap();
    let raised = Observer {
        raised: 50.0,
        ..observer(0.0, 30.0)
    };
    let dip = (6_378_000.0f64 / 6_378_050.0).acos();
    let direction = [0.0, dip.cos(), -dip.sin()];
    let gamma = (-dip.sin() * 0.5).acos();
    let want = level(20.0, 0.0, 50.0, 30.0, 1) * (2.0 + gamma * FRAC_PI_2);
    let sky = data.sky(&raised, 20e3, 0.0).unwrap();
    let got = sky.radiance(direction).unwrap()[1];
    assert!((got / want - 1.0).abs() < 1e-6, "{got} {want}");
}

#[test]
fn polarisation_has_the_opposite_sign_of_the_tables() {
    let data = OfficialData::from_bytes(file().0).unwrap();
    let sky = data.polarised(&observer(0.0, 30.0), 30e3, 0.5).unwrap();
    let direction = [0.0, 0.6, 0.8];
    let gamma = (0.8f64 * 0.5).acos();
    let want = gamma / 8.0 * 0.8f64.acos() / 8.0;
    for got in sky.degree(direction).unwrap() {
        assert!((got - want).abs() < 1e-7, "{got} {want}");
    }
}

#[test]
fn transmittance_follows_the_arc_on_the_ground() {
    let table = transmittance(header().channels);
    let radius = 6_378_000.0f64;
    let longest = (15e3 * (2.0 * radius + 15e3)).sqrt() + (1e5 * (2.0 * radius + 1e5)).sqrt();
    assert!((longest - 1_571_524.413_613).abs() < 1e-3);
    for (altitude, theta, distance) in [(500.0, 1.2f64, 20e3), (0.0, 1.5, 1e3), (900.0, 1.5, 60e3)]
    {
        let got = table.at(altitude, theta, distance, 50e3).unwrap();
        let (sine, cosine) = theta.sin_cos();
        let arc = radius * (sine * distance).atan2(radius + altitude + cosine * distance);
        let root = 1.0 - 0.5 * arc / longest;
        for (channel, got) in got.into_iter().enumerate() {
            let want = (root / (1.0 + channel as f64)).powi(2);
            assert!((got - want).abs() < 1e-6, "{got} {want}");
        }
    }
}

#[test]
fn a_line_to_the_ground_ends_there() {
    let table = transmittance(header().channels);
    let at = |distance| table.at(1000.0, 2.5, distance, 50e3).unwrap();
    assert_eq!(at(1e5), at(f64::INFINITY));
    assert_ne!(at(1e3), at(f64::INFINITY));
}

#[test]
fn truncated_files_are_refused_or_noted() {
    let (bytes, [header, radiance, transmittance, whole]) = file();
    let open = |length: usize| OfficialData::from_bytes(bytes[..length].to_vec());
    let all = (0..header).chain((header..whole).step_by(997));
    let edges = [header, radiance, transmittance, whole];
    let edges = edges
        .into_iter()
        .flat_map(|end| end.saturating_sub(9)..=(end + 9).min(whole));
    for length in all.chain(edges) {
        match open(length) {
            Err(OfficialError::Truncated {
                section, needed, ..
            }) => {
                assert!(length < radiance && needed > length as u64);
                let expected = if length < header {
                    Section::Header
                } else {
                    Section::Radiance
                };
                assert_eq!(section, expected);
            }
            Err(other) => panic!("{length}: {other}"),
            Ok(data) => {
                assert!(length >= radiance);
                let noted = |section| {
                    data.notes().iter().any(|note| {
                    matches!(note, Note::Absent(s) | Note::Truncated { section: s, .. } if *s == section)
                })
                };
                assert_eq!(noted(Section::Transmittance), length < transmittance);
                assert_eq!(data.transmittance().is_ok(), length >= transmittance);
                let polarised = length == whole;
                assert_eq!(data.polarisation().is_some(), polarised);
                assert_eq!(
                    noted(Section::Polarisation),
                    !polarised && length >= transmittance
                );
            }
        }
    }
}

#[test]
fn what_follows_the_last_section_is_noted() {
    let mut bytes = file().0;
    bytes.extend([0; 5]);
    let data = OfficialData::from_bytes(bytes).unwrap();
    assert_eq!(data.notes(), &[Note::Trailing(5)]);
}

/// Offsets of all counts before the factors.
fn counts(ends: [usize; 4]) -> Vec<usize> {
    let h = header();
    let mut at = 0;
    let mut out = vec![];
    let lists = [
        h.axes.visibilities.len(),
        h.axes.albedos.len(),
        h.axes.altitudes.len(),
        h.axes.elevations.len(),
    ];
    for length in lists {
        out.push(at);
        at += 4 + 8 * length;
    }
    out.push(at);
    at += 20;
    out.push(at);
    at += 4;
    for length in [
        h.breaks.sun.len(),
        h.breaks.zenith.len(),
        h.breaks.emphasis.len(),
    ] {
        out.push(at);
        at += 4 + 8 * length;
    }
    assert_eq!(at, ends[0]);
    out.extend((0..5).map(|i| ends[1] + 4 * i));
    out.push(ends[2]);
    out
}

#[test]
fn counts_that_nobody_has_are_refused() {
    let (bytes, ends) = file();
    for at in counts(ends) {
        for count in [0, -1, i32::MIN, i32::MAX, 1 << 30, 1 << 20] {
            let mut bad = bytes.clone();
            bad[at..at + 4].copy_from_slice(&i32::to_le_bytes(count));
            match OfficialData::from_bytes(bad) {
                Err(OfficialError::Value { .. } | OfficialError::Truncated { .. }) => {}
                Err(other) => panic!("{other}"),
                Ok(_) => panic!("a count of {count} at byte {at} passes"),
            }
        }
    }
}

#[test]
fn counts_within_reason_meet_the_length_of_the_file() {
    let (bytes, ends) = file();
    for at in counts(ends).into_iter().take(9) {
        let mut bad = bytes.clone();
        bad[at..at + 4].copy_from_slice(&1000i32.to_le_bytes());
        // Not a number is what follows read as, or more is needed than there is.
        assert!(OfficialData::from_bytes(bad).is_err());
    }
}

#[test]
fn axes_that_do_not_increase_are_refused() {
    let bytes = file().0;
    for bad in [f64::NAN, f64::INFINITY, -1e300, 1e300, 40.0] {
        let mut file = bytes.clone();
        // The first visibility; the second is 40.
        file[4..12].copy_from_slice(&bad.to_le_bytes());
        let error = OfficialData::from_bytes(file).err().unwrap();
        assert!(
            matches!(
                error,
                OfficialError::Value {
                    what: "visibilities",
                    ..
                }
            ),
            "{error}"
        );
    }
}

#[test]
fn factors_that_are_no_numbers_are_refused_when_they_are_read() {
    let (bytes, ends) = file();
    let node = header().nodes().next().unwrap();
    let sun = 2 * header().breaks.sun.len();
    let patches: [(usize, &[u8]); 3] = [
        (ends[0], &[0, 0x7c]),
        (ends[0] + sun, &0f64.to_le_bytes()),
        (ends[0] + sun, &f64::NAN.to_le_bytes()),
    ];
    for (at, patch) in patches {
        let mut bad = bytes.clone();
        bad[at..at + patch.len()].copy_from_slice(patch);
        let data = OfficialData::from_bytes(bad).unwrap();
        assert!(matches!(
            data.radiance_tables(node, 0),
            Err(OfficialError::Value { .. })
        ));
        // Others are sound.
        assert!(data.radiance_tables(node, 1).is_ok());
    }
}

/// Whatever bits flip, a file is refused or gives finite numbers.
#[test]
fn flipped_bits_are_survived() {
    let (bytes, ends) = file();
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    let (mut refused, mut answered) = (0, 0);
    for case in 0..1500 {
        let mut bad = bytes.clone();
        let within = ends[case % 4].min(if case % 3 == 0 { ends[0] } else { usize::MAX });
        for _ in 0..1 + case % 3 {
            let bit = rng.next_u64() as usize % (8 * within);
            bad[bit / 8] ^= 1 << (bit % 8);
        }
        let Ok(data) = OfficialData::from_bytes(bad) else {
            refused += 1;
            continue;
        };
        let seen = observer(100.0, 20.0);
        let light = data
            .sky(&seen, 45e3, 0.3)
            .and_then(|sky| sky.radiance([0.1, 0.2, 0.9]));
        let degree = data
            .polarised(&seen, 45e3, 0.3)
            .and_then(|sky| sky.degree([0.1, 0.2, 0.9]));
        let through = data
            .transmittance()
            .and_then(|t| t.at(100.0, 1.0, 5e3, 45e3));
        for answer in [light, degree, through].into_iter().flatten() {
            assert!(answer.iter().all(|v| v.is_finite()), "{case}: {answer:?}");
            answered += 1;
        }
    }
    assert!(refused > 50 && answered > 500, "{refused} {answered}");
}

#[test]
fn questions_without_sense_are_refused() {
    let data = OfficialData::from_bytes(file().0).unwrap();
    let sky = |o: &Observer, v, a| data.sky(o, v, a).err();
    let good = observer(0.0, 30.0);
    assert!(matches!(
        sky(&good, f64::NAN, 0.0),
        Some(OfficialError::Condition(_))
    ));
    assert!(matches!(
        sky(&good, 5e4, f64::NAN),
        Some(OfficialError::Condition(_))
    ));
    let nowhere = observer(f64::NAN, 30.0);
    assert!(matches!(
        sky(&nowhere, 5e4, 0.0),
        Some(OfficialError::Condition(_))
    ));
    let centre = observer(-6_378_000.0, 30.0);
    assert!(matches!(
        sky(&centre, 5e4, 0.0),
        Some(OfficialError::Condition(_))
    ));
    let sky = data.sky(&good, 5e4, 0.0).unwrap();
    for direction in [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0]] {
        assert!(matches!(
            sky.radiance(direction),
            Err(OfficialError::Direction)
        ));
    }
    let table = data.transmittance().unwrap();
    for (h, theta, t) in [
        (f64::NAN, 1.0, 1.0),
        (0.0, f64::NAN, 1.0),
        (0.0, 1.0, f64::NAN),
    ] {
        assert!(matches!(
            table.at(h, theta, t, 5e4),
            Err(OfficialError::Condition(_))
        ));
    }
}

#[test]
fn a_writer_wants_sections_whole_and_in_order() {
    let header = header();
    let node = header.nodes().next().unwrap();
    let start = || Writer::new(vec![], header.clone()).unwrap();
    assert!(matches!(start().finish(), Err(OfficialError::Order(_))));
    let early = start().transmittance(&transmittance(header.channels));
    assert!(matches!(
        early,
        Err(OfficialError::Order(Section::Radiance))
    ));
    let mut short = radiance_tables(&header, node, 0);
    short.sun.pop();
    assert!(matches!(
        start().radiance(&short),
        Err(OfficialError::Value { .. })
    ));
    let mut large = radiance_tables(&header, node, 0);
    large.sun[0] = 1e6;
    assert!(matches!(
        start().radiance(&large),
        Err(OfficialError::Value { .. })
    ));
    let mut empty = header.clone();
    empty.axes.albedos.clear();
    assert!(matches!(
        Writer::new(vec![], empty),
        Err(OfficialError::Value { .. })
    ));
}

/// The published data, where `WELKIN_OFFICIAL_DATA` names a file of them: as their authors' paper has them.
#[test]
fn published_data_are_read() {
    let Some(path) = std::env::var_os("WELKIN_OFFICIAL_DATA") else {
        println!("skipped: WELKIN_OFFICIAL_DATA names no file");
        return;
    };
    let data = OfficialData::open(path).unwrap();
    let header = data.header();
    assert_eq!(
        header.axes.visibilities,
        [20.0, 27.6, 40.0, 59.4, 90.0, 131.8]
    );
    assert_eq!(header.breaks.rank, 9);
    assert_eq!(header.breaks.bytes(), 8948);
    // A clear zenith under a sun at 30°: about 0.05 W m⁻² sr⁻¹ nm⁻¹ in the blue.
    let sky = data.sky(&observer(0.0, 30.0), 131.8e3, 1.0 / 3.0).unwrap();
    let zenith = sky.radiance([0.0, 0.0, 1.0]).unwrap();
    let blue = zenith[header.channels.of(460.0).unwrap()];
    assert!((0.03..0.08).contains(&blue), "{blue}");
    // Every table is sound.
    for node in header.nodes() {
        for channel in 0..header.channels.count {
            data.radiance_tables(node, channel).unwrap();
        }
    }
}
