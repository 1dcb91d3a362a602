//! The library as a reader of the conformance suite: `conformance FILE < queries > answers`.
//!
//! The contract is `format-spec/conformance/README.md`.

#[path = "../../../tests/common/answer.rs"]
mod answer;

use std::io::{self, BufRead, Write};

use welkin::Model;

fn main() -> io::Result<()> {
    let path = std::env::args_os().nth(1);
    let path = path.ok_or_else(|| io::Error::other("usage: conformance FILE < queries"))?;
    let model = Model::open(path);
    let mut out = io::stdout().lock();
    for line in io::stdin().lock().lines() {
        let line = line?;
        let answer = match &model {
            Ok(model) => answer::answer(model, &line),
            Err(error) => Err(error.class()),
        };
        match answer {
            Ok(values) => {
                let text: Vec<String> = values.iter().map(f32::to_string).collect();
                writeln!(out, "{}", text.join("\t"))?;
            }
            Err(class) => writeln!(out, "error {class}")?,
        }
    }
    Ok(())
}
