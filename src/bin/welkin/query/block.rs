//! A few ten thousand rows at a time: understood and answered by all threads, in an order that shares work, and written
//! in theirs.

use std::io;
use std::sync::Mutex;

use csv::ByteRecord;
use rayon::prelude::*;

use super::answer::Answerer;
use super::bounded::Bounded;
use super::columns::Columns;
use super::quantity::Question;
use super::shared::Shared;
use crate::failure::describe;

/// Most rows of a block, and most bytes of their cells.
const MOST_ROWS: usize = 1 << 16;
pub const MOST_BYTES: usize = 1 << 25;
/// Rows that a thread takes at once.
const PORTION: usize = 256;

/// The error of a row whose value is no number.
const OVERFLOW: &str = "the value overflows: the file is not a sensible sky";

/// What to write beside rows.
pub struct Answers {
    /// `[row][column]`; of rows with an error anything.
    pub values: Vec<f32>,
    pub errors: Vec<Result<(), String>>,
}

impl Answers {
    fn with_capacity(rows: usize, width: usize) -> Self {
        Self {
            values: vec![f32::NAN; rows * width],
            errors: Vec::with_capacity(rows),
        }
    }
}

/// Rows whose records are used again and again.
#[derive(Default)]
pub struct Block {
    records: Vec<ByteRecord>,
    len: usize,
}

impl Block {
    /// Reads rows until the block is full or the table ends; what precedes an error is kept.
    pub fn read(&mut self, reader: &mut csv::Reader<Bounded<impl io::Read>>) -> csv::Result<()> {
        self.len = 0;
        let mut bytes = 0;
        while self.len < MOST_ROWS && bytes < MOST_BYTES {
            if self.len == self.records.len() {
                self.records.push(ByteRecord::new());
            }
            let record = &mut self.records[self.len];
            reader.get_ref().allow(MOST_BYTES);
            if !reader.read_byte_record(record)? {
                break;
            }
            bytes += record.as_slice().len();
            self.len += 1;
        }
        Ok(())
    }

    pub fn rows(&self) -> &[ByteRecord] {
        &self.records[..self.len]
    }

    /// Answers all rows, in their order, with so many values each.
    pub fn answer<'a>(
        &self,
        columns: &Columns,
        width: usize,
        shared: &'a Shared<'a>,
        answerers: &Mutex<Vec<Answerer<'a>>>,
    ) -> Answers {
        let [_, highest] = shared.model.altitude_range();
        let questions: Vec<Result<_, String>> = (self.rows().par_iter().with_min_len(PORTION))
            .map(|row| Ok(columns.question(row)?.of_air(highest)))
            .collect();
        let mut order: Vec<_> = (questions.iter().enumerate())
            .filter_map(|(i, question)| Some((question.as_ref().ok()?.key(), i)))
            .collect();
        order.par_sort_unstable();
        let portions: Vec<Answers> = order
            .par_chunks(PORTION)
            .map(|portion| {
                let rows = portion.iter().map(|&(_, i)| &questions[i]);
                let rows = rows.filter_map(|question| question.as_ref().ok());
                answer_all(rows, width, shared, answerers)
            })
            .collect();
        let mut answers = Answers::with_capacity(questions.len(), width);
        let errors = questions.into_iter().map(|question| question.map(|_| ()));
        answers.errors.extend(errors);
        for (portion, order) in portions.into_iter().zip(order.chunks(PORTION)) {
            let rows = portion.errors.into_iter().zip(portion.values.chunks(width));
            for ((error, values), &(_, i)) in rows.zip(order) {
                answers.errors[i] = error;
                answers.values[i * width..][..width].copy_from_slice(values);
            }
        }
        answers
    }
}

fn answer_all<'a, 'q>(
    questions: impl Iterator<Item = &'q Question>,
    width: usize,
    shared: &'a Shared<'a>,
    answerers: &Mutex<Vec<Answerer<'a>>>,
) -> Answers {
    // A thread that panicked leaves nothing half done in the list.
    let lock = || {
        answerers
            .lock()
            .unwrap_or_else(|poison| poison.into_inner())
    };
    let idle = lock().pop();
    let mut answerer = idle.unwrap_or_else(|| Answerer::new(shared));
    let mut answers = Answers::with_capacity(PORTION, width);
    for (question, values) in questions.zip(answers.values.chunks_mut(width)) {
        let error = match answerer.answer(question, values) {
            Ok(()) if values.iter().all(|value| value.is_finite()) => Ok(()),
            Ok(()) => Err(OVERFLOW.to_owned()),
            Err(error) => Err(describe(&error)),
        };
        answers.errors.push(error);
    }
    lock().push(answerer);
    answers
}
