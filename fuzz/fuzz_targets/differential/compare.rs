//! Which answers of two readers are the same.

use crate::mutation::Changes;
use crate::question::{Answer, PER_SCENE, Question, Ranges};
use crate::readers::{ABSTAINS, Report};

/// Two readers within the tolerance of the specification of the same value.
const RELATIVE: f64 = 2e-4;
/// The same in units of the zenith's radiance.
const OF_ZENITH: f64 = 2e-7;
/// Of Q and U in units of L.
const OF_LIGHT: f64 = 4e-4;
/// Of the sun's light, which readers may interpolate.
const SUNLIGHT: f64 = 5e-3;
/// Beyond these, f32 has too few digits or none.
const SANE: std::ops::Range<f64> = 1e-25..1e25;

pub struct Case<'a> {
    pub base: &'a str,
    pub questions: &'a [Question],
    pub ranges: Ranges,
    pub changes: &'a Changes,
    /// The class of what is wrong with the spectrum or the estimates, if anything: those may be looked at early.
    pub early: Option<&'static str>,
}

/// What is wrong with the report of another reader, if anything.
pub fn disagreement(case: &Case, library: &Report, other: &Report) -> Option<String> {
    match (library, other) {
        (_, Err(class)) if class == ABSTAINS => None,
        (Err(a), Err(b)) => class_at_open(case, a, b),
        // A damaged spectrum and damaged estimates may be refused early.
        (Ok(_), Err(class)) => case
            .early
            .is_none()
            .then(|| format!("refused at open: {class}")),
        // Readers that are asked line by line say so at each question.
        (Err(a), Ok(answers)) => answers.iter().find_map(|answer| match answer {
            Ok(_) => Some(format!("not refused: {a}")),
            Err(b) if b == ABSTAINS => Some(format!("not refused: {a}")),
            Err(b) => class_at_open(case, a, b),
        }),
        (Ok(a), Ok(b)) => (0..case.questions.len()).find_map(|i| {
            let wrong = answer(case, i, a, b)?;
            let question = &case.questions[i];
            Some(format!(
                "{wrong}\n  {}\n  {:?}\n  {:?}",
                question.line(),
                a[i],
                b[i]
            ))
        }),
    }
}

/// Where one rule is broken, the classes are the same.
fn class_at_open(case: &Case, a: &str, b: &str) -> Option<String> {
    let known = |class: &str| {
        ["magic", "version", "feature", "length", "checksum", "value"].contains(&class)
    };
    if !known(a) || !known(b) {
        return Some(format!("no class of an error at open: {a}, {b}"));
    }
    // A wrong length can be that of a file without a whole magic, or make the last chunk end in a wrong place.
    let follows = [a, b].contains(&"length")
        && [a, b]
            .iter()
            .any(|c| ["magic", "value", "checksum"].contains(c));
    let one = case.changes.count == 1 && !follows;
    (a != b && one).then(|| format!("at open {a} and {b}"))
}

fn answer(case: &Case, i: usize, a: &[Answer], b: &[Answer]) -> Option<String> {
    let question = &case.questions[i];
    match (&a[i], &b[i]) {
        (_, Err(class)) | (Err(class), _) if class == ABSTAINS => None,
        // A disc asks for all conditions, its light for the visibility.
        _ if question.name() == "sunlight_at" && question.is_outside(&case.ranges) => None,
        (Ok(a_values), Ok(b_values)) => {
            let zenith = &a[i - i % PER_SCENE];
            if is_beside_dark(case, i, [a, b]) {
                return None;
            }
            values(case, question, zenith, a_values, b_values)
        }
        (Err(a), Err(b)) => class(case, question, a, b),
        // So may they be where nothing depends on them, but need not.
        (Ok(_), Err(class)) | (Err(class), Ok(_))
            if !question.needs_spectrum() && case.early == Some(class) =>
        {
            None
        }
        // Numbers that overflow are refused or bounded.
        (Ok(values), Err(class)) | (Err(class), Ok(values)) => {
            let overflow = class == "value" && (case.changes.wild || !are_sane(values));
            // Air beyond its reach is what a reader may refuse.
            let reach = class == "point" && question.name().starts_with("in_scattering");
            (!overflow && !reach).then(|| format!("values, and an error: {class}"))
        }
    }
}

fn class(case: &Case, question: &Question, a: &str, b: &str) -> Option<String> {
    if question.is_outside(&case.ranges) && case.early.is_none() && (a, b) != ("range", "range") {
        return Some(format!("outside the range, but {a} and {b}"));
    }
    let both = |one, other| [(one, other), (other, one)].contains(&(a, b));
    // Where a chunk is missing, others may be broken, and a wavelength is no condition.
    let free = ["checksum", "encoding", "value", "direction"]
        .iter()
        .any(|c| both("missing", c));
    let damaged = case.early.is_some_and(|class| [a, b].contains(&class));
    let free = free || damaged || question.has_wavelength() && (a, b) != ("range", "range");
    let several = case.changes.count > 1;
    (a != b && !several && !free).then(|| format!("{a} and {b}"))
}

fn are_sane(values: &[f64]) -> bool {
    values.iter().all(|v| *v == 0.0 || SANE.contains(&v.abs()))
}

fn values(
    case: &Case,
    question: &Question,
    zenith: &Answer,
    a: &[f64],
    b: &[f64],
) -> Option<String> {
    if a.len() != b.len() {
        return Some("as many values".to_owned());
    }
    if !a.iter().chain(b).all(|v| v.is_finite()) {
        return Some("values that are not finite".to_owned());
    }
    if case.changes.wild || !are_sane(a) || !are_sane(b) || is_rough(case, question) {
        return None;
    }
    let zenith = zenith.as_ref().map(Vec::as_slice).unwrap_or_default();
    let mut floors: Vec<f64> = zenith.iter().map(|l| l * OF_ZENITH).collect();
    if is_through_zero(case) {
        // Where a sum passes through zero, f32 has few digits: the terms are some tenths, their rounding 1e-8 each.
        floors.fill(3e-7);
    }
    let tolerances = tolerances(question, a, &floors)?;
    let mut all = a.iter().zip(b).zip(tolerances);
    let wrong = all.find(|((a, b), tolerance)| !((*a - *b).abs() <= *tolerance));
    wrong.map(|((a, b), tolerance)| format!("{a} and {b}, more than {tolerance} apart"))
}

/// Whether radiances of the file pass through zero.
fn is_through_zero(case: &Case) -> bool {
    ["negative", "spectrum-dark"].contains(&case.base)
}

/// Whether a radiance that is almost nothing decides: by its logarithm between the nodes, by its digits in a colour.
fn is_beside_dark(case: &Case, i: usize, readers: [&[Answer]; 2]) -> bool {
    let question = &case.questions[i];
    let between = question.has_wavelength() && question.name() != "sunlight_at";
    let colour = question.name() == "xyz" && is_through_zero(case);
    if question.is_segment() || !(between || colour) {
        return false;
    }
    let scene = i - i % PER_SCENE;
    let is_dark = |answers: &[Answer]| {
        let [zenith, radiance] = [0, 1].map(|k| answers[scene + k].as_deref().unwrap_or_default());
        let floor = |l: f64| {
            if is_through_zero(case) {
                3e-7
            } else {
                OF_ZENITH * l
            }
        };
        let mut pairs = zenith.iter().zip(radiance);
        pairs.any(|(z, l)| *l != 0.0 && *l < 1e4 * floor(*z))
    };
    readers.into_iter().any(is_dark)
}

/// Whether the specification promises nothing about the light of a segment: the source is not smooth, or the view so
/// steep that it may count as vertical; or only wishes, for segments that leave the air, and for long ones in twilight,
/// of which quadratures differ most.
fn is_rough(case: &Case, question: &Question) -> bool {
    let [.., distance] = question.cells;
    let twilight = question.cells[3] < 0.0 && distance > 100.0;
    let jagged = case.base == "aerial-perspective-negative" || distance > 1e5 || twilight;
    let [x, y, z] = [5, 6, 7].map(|i| question.cells[i]);
    let vertical =
        question.name().starts_with("in_scattering_stokes") && x.hypot(y) <= 1e-6 * z.abs();
    question.name().starts_with("in_scattering") && (jagged || vertical)
}

/// Tolerances of the values of the first reader; none where the logarithm of almost nothing decides.
fn tolerances(question: &Question, a: &[f64], floors: &[f64]) -> Option<Vec<f64>> {
    let relative = |v: &f64| RELATIVE * v.abs();
    let lowest = floors.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = floors.iter().copied().fold(0.0, f64::max);
    let third = a.len() / 3;
    Some(match question.name() {
        "relative_radiance" => a
            .iter()
            .zip(floors)
            .map(|(v, floor)| relative(v).max(*floor))
            .collect(),
        "wavelength_range" => vec![0.0; a.len()],
        "sunlight_at" => vec![SUNLIGHT * a[0].abs()],
        "transmittance" | "transmittance_at" => a.iter().map(|v| relative(v).max(2e-9)).collect(),
        "stokes" => {
            let wide = |i: usize| (OF_LIGHT * a[i % third]).max(floors[i % third]);
            (0..a.len())
                .map(|i| {
                    if i < third {
                        relative(&a[i]).max(floors[i])
                    } else {
                        wide(i)
                    }
                })
                .collect()
        }
        name if name.starts_with("in_scattering") => {
            // The specification asks for 2 %, and wishes for 5 %.
            let share = if question.cells[9] <= 100.0 {
                0.04
            } else {
                0.1
            };
            let n = if name.starts_with("in_scattering_stokes") {
                third
            } else {
                a.len()
            };
            (0..a.len()).map(|i| share * a[i % n]).collect()
        }
        // Sums and logarithms of radiances.
        "xyz" => {
            let size = a.iter().map(|v| v.abs()).fold(0.0, f64::max);
            vec![RELATIVE * size; a.len()]
        }
        _ if a[0] < 1e4 * largest => return None,
        "stokes_at" => vec![
            relative(&a[0]).max(lowest),
            OF_LIGHT * a[0],
            OF_LIGHT * a[0],
        ],
        _ => vec![relative(&a[0]).max(lowest)],
    })
}
