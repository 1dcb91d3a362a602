//! Which files are written: a picture and the scene beside it that refers to it.

use std::path::{Path, PathBuf};

use welkin::output::{self, Target};

use crate::failure::{Failure, Result};
use crate::naming::{self, Named};

/// Both targets, and what the scene calls the picture.
pub struct Files {
    picture: Target,
    scene: Target,
    /// Name of the picture in its folder, which is that of the scene.
    pub name: String,
}

#[derive(Clone, Copy, PartialEq)]
enum Which {
    Picture,
    Scene,
}

impl Files {
    /// From a base name or the name of one of the files; `extension` is that of scenes.
    pub fn new(out: &Path, extension: &str) -> Result<Self> {
        let refused = |text: &str| Err(Failure::message(format!("{}: {text}", out.display())));
        if Target::new(out).is_stream() {
            return refused("a scene and its picture are two files: name them");
        }
        if is_folder(out) {
            return refused("the name of a file is missing");
        }
        let formats = [(Which::Picture, "exr"), (Which::Scene, extension)];
        let base: PathBuf = match naming::named(out, None, &formats)? {
            Some(Named { .. }) => out.with_extension(""),
            None => out.to_owned(),
        };
        let with = |extension: &str| {
            let mut name = base.clone().into_os_string();
            name.push(".");
            name.push(extension);
            PathBuf::from(name)
        };
        let (picture, scene) = (with("exr"), with(extension));
        let name = match picture.file_name().and_then(|name| name.to_str()) {
            Some(name) if name.chars().all(is_plain) => name.to_owned(),
            _ => {
                return refused(
                    "the scene cannot refer to this name: no quotes, backslashes, @, < or > and control characters",
                );
            }
        };
        let (picture, scene) = (Target::Path(picture), Target::Path(scene));
        [&picture, &scene].into_iter().try_for_each(Target::check)?;
        Ok(Self {
            picture,
            scene,
            name,
        })
    }

    pub fn all(&self) -> [&Target; 2] {
        [&self.picture, &self.scene]
    }

    /// Both or none; the picture gets its name first.
    pub fn write(&self, picture: &[u8], scene: &[u8]) -> Result<()> {
        Ok(output::write(&[
            (&self.picture, picture),
            (&self.scene, scene),
        ])?)
    }
}

/// Whether a path names a folder by how it is written.
fn is_folder(path: &Path) -> bool {
    let text = path.as_os_str().to_string_lossy();
    let last = text.rsplit(std::path::is_separator).next();
    matches!(last, Some("" | "." | ".."))
}

/// Whether a character means itself in the names of files in every scene format: `<` begins a token of Arnold and USD.
fn is_plain(character: char) -> bool {
    !character.is_control() && !"\"'\\@<>".contains(character)
}
