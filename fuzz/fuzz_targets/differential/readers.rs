//! The readers: each answers all questions about a file.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use welkin::{Interpolation, Model, PointQuery};

use crate::answer;
use crate::question::{Answer, Question};
use crate::sunlight;

/// An error at open, or an answer for each question.
pub type Report = Result<Vec<Answer>, String>;

/// The reader could not be asked: the file is too large for it, or it lacks what it needs.
pub const ABSTAINS: &str = "abstains";

pub fn library(model: &Result<Model, welkin::Error>, questions: &[Question]) -> Report {
    let model = model.as_ref().map_err(|e| e.class().to_owned())?;
    // What is asked for per unit of sunlight is not known where there is none.
    let dark = model.head().solar_irradiance.contains(&0.0);
    let has_spectrum = model.has_spectrum();
    let answer = |q: &Question| match q.name() {
        "wavelength_range" => {
            let range = model.wavelength_range().map(Vec::from);
            range.map_err(|e| e.class().to_owned())
        }
        // Others know it at the nodes only.
        "transmittance_at" | "sunlight_at" if !has_spectrum => Err(ABSTAINS.to_owned()),
        "sunlight_at" => sunlight::of_disc(model, q),
        _ => of_line(model, q, dark),
    };
    Ok(questions.iter().map(answer).collect())
}

fn of_line(model: &Model, q: &Question, dark: bool) -> Answer {
    match answer::answer(model, &q.line()) {
        Ok(values) if dark && values.iter().any(|v| v.is_nan()) => Err(ABSTAINS.to_owned()),
        Ok(values) => Ok(values.into_iter().map(f64::from).collect()),
        Err(class) => Err(class.to_owned()),
    }
}

/// Answers for radiances only. Numbers of chunks are not checked by this reader.
pub fn general(file: &[u8], questions: &[Question]) -> Report {
    let general = PointQuery::new(file).map_err(|error| match error.class() {
        "limit" | "encoding" => ABSTAINS.to_owned(),
        class => class.to_owned(),
    })?;
    let general = general.with_interpolation(Interpolation::Full);
    let mut row = vec![0.0; general.wavelengths().len()];
    let mut answer = |q: &Question| {
        let [.., x, y, z, wavelength, _] = q.cells;
        let direction = [x, y, z].map(|v| v as f32);
        let class = |error: welkin::Error| error.class().to_owned();
        match q.name() {
            "wavelength_range" => Ok(general.wavelength_range().to_vec()),
            "relative_radiance_at" => {
                let light = general.relative_radiance_at(&q.conditions(), direction, wavelength);
                Ok(vec![f64::from(light.map_err(class)?)])
            }
            "relative_radiance" => {
                let done = general.relative_radiance(&q.conditions(), direction, &mut row);
                done.map_err(class)?;
                Ok(row.iter().copied().map(f64::from).collect())
            }
            _ => Err(ABSTAINS.to_owned()),
        }
    };
    Ok(questions.iter().map(&mut answer).collect())
}

const MOST_VALUES: usize = 3 * 256;

#[repr(C)]
#[derive(Clone)]
struct CAnswer {
    error: i32,
    count: u32,
    values: [f64; MOST_VALUES],
}

unsafe extern "C" {
    fn welkin_c_reader(
        bytes: *const u8,
        length: usize,
        questions: *const Question,
        count: usize,
        answers: *mut CAnswer,
    ) -> i32;
}

/// In the order of the C reader's enumeration.
const C_CLASSES: [&str; 13] = [
    "none",
    "magic",
    "version",
    "feature",
    "length",
    "checksum",
    "value",
    "encoding",
    "range",
    "missing",
    "direction",
    "point",
    ABSTAINS,
];

pub fn c(file: &[u8], questions: &[Question]) -> Report {
    let empty = CAnswer {
        error: 0,
        count: 0,
        values: [0.0; MOST_VALUES],
    };
    let mut answers = vec![empty; questions.len()];
    // SAFETY: the function reads so many bytes and questions, and writes so many answers, whose layouts are those of
    // reader.c.
    let error = unsafe {
        welkin_c_reader(
            file.as_ptr(),
            file.len(),
            questions.as_ptr(),
            questions.len(),
            answers.as_mut_ptr(),
        )
    };
    let class = |error: i32| C_CLASSES[error as usize].to_owned();
    if error != 0 {
        return Err(class(error));
    }
    let answer = |a: &CAnswer| match a.error {
        0 => Ok(a.values[..a.count as usize].to_vec()),
        error => Err(class(error)),
    };
    Ok(answers.iter().map(answer).collect())
}

/// The Python reader in a process of its own.
pub struct Python {
    _child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    lacks_zstd: bool,
}

impl Python {
    pub fn start() -> Self {
        let script = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/fuzz_targets/differential/reader.py"
        );
        let mut child = Command::new("python3")
            .arg(script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("python3 with numpy");
        let input = child.stdin.take().expect("a pipe");
        let mut output = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut lacks = String::new();
        output.read_line(&mut lacks).expect("a line");
        assert!(
            lacks.starts_with("lacks"),
            "the Python reader does not start: is numpy installed?"
        );
        Self {
            _child: child,
            input,
            output,
            lacks_zstd: lacks.contains("zstd"),
        }
    }

    pub fn ask(&mut self, file: &[u8], questions: &[Question]) -> Report {
        let lines: Vec<String> = questions.iter().map(Question::line).collect();
        for block in [file, lines.join("\n").as_bytes()] {
            let length = (block.len() as u32).to_le_bytes();
            self.input
                .write_all(&length)
                .expect("the Python reader lives");
            self.input
                .write_all(block)
                .expect("the Python reader lives");
        }
        self.input.flush().expect("the Python reader lives");
        let answers = questions.iter().map(|_| self.answer());
        Ok(answers.collect())
    }

    fn answer(&mut self) -> Answer {
        let mut line = String::new();
        let by_ref = self.output.by_ref();
        by_ref
            .read_line(&mut line)
            .expect("the Python reader lives");
        assert!(!line.is_empty(), "the Python reader ended");
        if let Some(class) = line.strip_prefix("error ") {
            return Err(match class.trim() {
                "encoding" if self.lacks_zstd => ABSTAINS.to_owned(),
                class => class.to_owned(),
            });
        }
        Ok(line
            .split_whitespace()
            .map(|v| v.parse().expect("a number"))
            .collect())
    }
}
