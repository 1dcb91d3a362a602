//! Which format a file gets.

use std::path::Path;

use welkin::output::Target;

use crate::failure::{Failure, Result};

/// The extension of a path in lower case. What follows the last dot and begins with a digit is none: `visibility-59.4`.
fn extension(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
    let (_, extension) = name.rsplit_once('.')?;
    let is_number = extension.starts_with(|c: char| c.is_ascii_digit());
    (!extension.is_empty() && !is_number).then(|| extension.to_owned())
}

/// Whether nothing but dots is before the extension: `folder/.exr`, `..exr`.
fn is_bare(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.rsplit_once('.').map(|(stem, _)| stem);
    stem.is_some_and(|stem| stem.chars().all(|c| c == '.'))
}

/// A file of a certain format.
pub struct Named<F> {
    pub format: F,
    pub target: Target,
}

/// Which of the `formats`, listed with their extensions, `--out` means: by its extension, or as `--format` wishes where
/// there is none. `None` if there is neither.
pub fn named<F: Copy + PartialEq>(
    path: &Path,
    wish: Option<F>,
    formats: &[(F, &str)],
) -> Result<Option<Named<F>>> {
    let target = Target::new(path);
    let supported: Vec<String> = formats.iter().map(|(_, e)| format!(".{e}")).collect();
    let supported = supported.join(" or ");
    let fail = |text: String| Err(Failure::message(format!("{}: {text}", path.display())));
    let extension = extension(path);
    let known = formats
        .iter()
        .find(|(_, e)| Some(*e) == extension.as_deref());
    let known = known.map(|(format, _)| *format);
    let format = if target.is_stream() {
        match wish.or(known) {
            None => return fail("say what to write there with --format".to_owned()),
            format => format,
        }
    } else if is_bare(path) {
        return fail(format!("a name is missing before {supported}"));
    } else {
        match (extension, known, wish) {
            (Some(extension), None, _) => {
                return fail(format!("cannot write .{extension}, only {supported}"));
            }
            (_, Some(known), Some(wish)) if known != wish => {
                return fail("--format says another format".to_owned());
            }
            (_, known, wish) => known.or(wish),
        }
    };
    Ok(format.map(|format| Named { format, target }))
}
