//! What stands around the body of every function.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::status::{WelkinError, WelkinStatus};

/// Why a call was refused.
#[derive(Debug)]
pub enum Failure {
    /// By the library.
    Library(library::Error),
    /// A pointer is null.
    Null(&'static str),
    /// A pointer is not aligned.
    Alignment(&'static str),
    /// An array is longer than memory can be.
    Length(&'static str, usize),
    /// Arrays overlap.
    Overlap,
    /// A struct has a size that cannot be.
    StructSize {
        what: &'static str,
        got: u64,
        least: usize,
    },
    /// A struct has a field that is set and not known.
    UnknownField(&'static str),
    /// A number that cannot be, or that does not go with another.
    Range(String),
    /// A constant or a text that means nothing.
    Argument(&'static str, i64),
    /// This build lacks something.
    Unsupported(&'static str),
    /// The header of the program is not served.
    Abi(String),
}

pub type Outcome<T> = Result<T, Failure>;

impl From<library::Error> for Failure {
    fn from(error: library::Error) -> Self {
        Failure::Library(error)
    }
}

impl Failure {
    fn status(&self) -> WelkinStatus {
        match self {
            Failure::Library(error) => WelkinStatus::of_class(error.class()),
            Failure::Null(_) => WelkinStatus::Null,
            Failure::Alignment(_) => WelkinStatus::Alignment,
            Failure::Length(..) => WelkinStatus::Length,
            Failure::Overlap => WelkinStatus::Overlap,
            Failure::StructSize { .. } | Failure::UnknownField(_) => WelkinStatus::Struct,
            Failure::Range(_) => WelkinStatus::Range,
            Failure::Argument(..) => WelkinStatus::Argument,
            Failure::Unsupported(_) => WelkinStatus::Unsupported,
            Failure::Abi(_) => WelkinStatus::Abi,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Failure::Library(error) => error.fmt(f),
            Failure::Null(what) => write!(f, "{what} must not be null"),
            Failure::Alignment(what) => write!(f, "{what} is not aligned"),
            Failure::Length(what, count) => {
                write!(f, "{what}: no memory is as long as {count} elements")
            }
            Failure::Overlap => write!(f, "an output overlaps an input or another output"),
            Failure::StructSize { what, got, least } => {
                write!(
                    f,
                    "struct_size of {what} must be its sizeof, at least {least}, got {got}: was it initialised?"
                )
            }
            Failure::UnknownField(what) => {
                write!(
                    f,
                    "{what} sets a field that this library does not know: use a newer one"
                )
            }
            Failure::Argument(what, got) => write!(f, "{got} is no {what}"),
            Failure::Unsupported(what) => write!(f, "this library was built without {what}"),
            Failure::Range(detail) | Failure::Abi(detail) => f.write_str(detail),
        }
    }
}

/// Runs the body of a function: no panic leaves it, and its failure becomes a code and text.
#[inline(always)]
pub fn guard(error: *mut WelkinError, body: impl FnOnce() -> Outcome<()>) -> WelkinStatus {
    let outcome = catch_unwind(AssertUnwindSafe(body));
    let error = match error.is_aligned() {
        // SAFETY: the caller of each function hands over null or a WelkinError.
        true => unsafe { error.as_mut() },
        // Left alone.
        false => None,
    };
    match outcome {
        Ok(Ok(())) => {
            if let Some(error) = error {
                error.status = WelkinStatus::Ok as i32;
                error.text[0] = 0;
            }
            WelkinStatus::Ok
        }
        Ok(Err(failure)) => report(error, failure.status(), &failure),
        Err(_) => report(
            error,
            WelkinStatus::Panic,
            &"a defect of the library: please report it",
        ),
    }
}

#[cold]
fn report(
    error: Option<&mut WelkinError>,
    status: WelkinStatus,
    text: &dyn fmt::Display,
) -> WelkinStatus {
    if let Some(error) = error {
        error.set(status, &text.to_string());
    }
    status
}

/// The body of a function that may fail.
macro_rules! call {
    ($error:expr, $body:block) => {
        $crate::guard::guard($error, || {
            // SAFETY: the caller promises that pointers are null or point to what the documentation says.
            unsafe { $body }
            Ok(())
        })
    };
}
pub(crate) use call;

/// A question that cannot fail: where the handle is null, or the library panics, the answer is the default one.
macro_rules! ask {
    ($handle:expr, |$name:ident| $body:expr) => {
        // SAFETY: the caller promises that the handle is null or alive.
        match unsafe { $handle.as_ref() } {
            Some($name) => {
                std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| $body)).unwrap_or_default()
            }
            None => Default::default(),
        }
    };
}
pub(crate) use ask;

/// Frees a handle; null is none.
macro_rules! free {
    ($handle:expr) => {
        if !$handle.is_null() {
            // SAFETY: the caller promises that the handle came from this library and is not used any more.
            let owned = unsafe { Box::from_raw($handle) };
            let _ = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| drop(owned)));
        }
    };
}
pub(crate) use free;

#[cfg(test)]
mod tests {
    use super::{guard, report};
    use crate::status::{WelkinError, WelkinStatus};

    #[test]
    fn panics_become_a_status() {
        let mut error = WelkinError {
            status: 0,
            text: [0; 256],
        };
        let status = guard(&raw mut error, || panic!("on purpose"));
        assert_eq!(
            (status, error.status),
            (WelkinStatus::Panic, WelkinStatus::Panic as i32)
        );
        assert_ne!(error.text[0], 0);
        assert_eq!(
            guard(std::ptr::null_mut(), || panic!("on purpose")),
            WelkinStatus::Panic
        );
    }

    #[test]
    fn texts_are_cut_between_characters() {
        let mut error = WelkinError {
            status: 0,
            text: [1; 256],
        };
        for n in 0..300 {
            let text = "ö".repeat(n) + "\0é";
            report(Some(&mut error), WelkinStatus::Value, &text);
            let bytes: Vec<u8> = error
                .text
                .iter()
                .map(|&c| c as u8)
                .take_while(|&c| c != 0)
                .collect();
            assert!(bytes.len() <= 255 && std::str::from_utf8(&bytes).is_ok());
        }
    }
}
