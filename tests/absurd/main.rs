//! Files that conform and hold absurd numbers: every answer is a number in its range or a typed error.

#[path = "../common/mod.rs"]
mod common;

mod ask;
mod forge;

use ask::Asker;
use forge::{Edit, TABLES, edits, forge};
use proptest::prelude::*;
use welkin::format::verify;

/// Asks forged files everything; how many answers there were, and how many refusals.
fn ask(edits: &[Edit]) -> Option<Asker> {
    let mut asker = Asker {
        answers: 0,
        refusals: 0,
    };
    let files = [false, true].map(|estimated| forge(edits, estimated));
    let files: Vec<Vec<u8>> = files.into_iter().flatten().collect();
    let any = !files.is_empty();
    files
        .into_iter()
        .for_each(|bytes| ask_file(bytes, &mut asker));
    any.then_some(asker)
}

fn ask_file(bytes: Vec<u8>, asker: &mut Asker) {
    assert!(verify(&bytes).is_empty(), "what the writer takes conforms");
    // A few hundred kilobytes for the life of the test.
    asker.everything(Box::leak(bytes.into_boxed_slice()));
}

#[test]
fn each_table_alone_can_be_absurd() {
    let mut forged = [0; TABLES];
    let mut refusals = 0;
    for (table, forged) in forged.iter_mut().enumerate() {
        for value in [
            0.0, 88.0, -88.0, 1e30, -1e30, 3.4e38, 65504.0, -65504.0, 1e6, -1.0, 1e-45,
        ] {
            let edit = Edit {
                table,
                place: None,
                value,
            };
            let Some(asker) = ask(&[edit]) else { continue };
            assert!(asker.answers + asker.refusals > 0);
            *forged += 1;
            refusals += asker.refusals;
        }
    }
    assert!(
        forged.iter().filter(|n| **n > 0).count() > TABLES - 6,
        "{forged:?}"
    );
    assert!(refusals > 0, "some are refused");
}

proptest! {
    #![proptest_config(common::cases(150))]

    #[test]
    fn absurd_files_give_numbers_or_typed_errors(edits in edits()) {
        ask(&edits);
    }
}
