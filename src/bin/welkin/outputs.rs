//! Where the files of a picture go.

use std::io::Write;
use std::path::{Path, PathBuf};

use welkin::output::{self, Target};

use crate::about::About;
use crate::encoding::Encoding;
use crate::failure::{Failure, Result};
use crate::folder;
use crate::naming::{self, Named};
use crate::picture::{Picture, Wanted};
use crate::tone::Film;

#[derive(clap::Args)]
#[group(skip)]
pub struct Options {
    /// Base name for an EXR and a PNG, or the name of one of them with its extension; - for standard output. What
    /// begins with a digit is no extension.
    #[arg(long, default_value = "sky", value_name = "FILE")]
    out: PathBuf,
    /// Write only this, to the very file that --out names, where its name does not tell.
    #[arg(long, value_enum)]
    format: Option<Format>,
    #[command(flatten)]
    encoding: Encoding,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    Exr,
    Png,
}

/// As far as they are wanted.
pub struct Outputs {
    exr: Option<Target>,
    png: Option<Target>,
    encoding: Encoding,
}

impl Options {
    /// Of one picture, checked.
    pub fn one(&self) -> Result<Outputs> {
        let outputs = self.outputs(None)?;
        Target::new(&self.out).check()?;
        outputs.all().try_for_each(Target::check)?;
        Ok(outputs)
    }

    /// Of so many numbered pictures, checked: `sky-01.png` …
    pub fn numbered(&self, count: usize) -> Result<Vec<Outputs>> {
        if Target::new(&self.out).is_stream() {
            let text = format!("{}: frames need a name of files", self.out.display());
            return Err(Failure::message(text));
        }
        let digits = count.to_string().len().max(4);
        let number = |frame: usize| format!("-{frame:0digits$}");
        let all = (1..=count).map(|frame| self.outputs(Some(&number(frame))));
        let all = all.collect::<Result<Vec<_>>>()?;
        folder::make(self.out.parent().unwrap_or(Path::new("")))?;
        // The folder is the same for all.
        all[0].all().try_for_each(Target::check)?;
        Ok(all)
    }

    fn outputs(&self, number: Option<&str>) -> Result<Outputs> {
        let formats = [(Format::Exr, "exr"), (Format::Png, "png")];
        let number = number.unwrap_or_default();
        let with =
            |extension: &str| Some(Target::Path(appended(&self.out, &[number, ".", extension])));
        let [exr, png] = match naming::named(&self.out, self.format, &formats)? {
            Some(Named { format, target }) => {
                let target = match number {
                    "" => target,
                    _ => Target::Path(before_extension(&self.out, number)),
                };
                match format {
                    Format::Exr => [Some(target), None],
                    Format::Png => [None, Some(target)],
                }
            }
            None => [with("exr"), with("png")],
        };
        let encoding = self.encoding;
        Ok(Outputs { exr, png, encoding })
    }
}

fn appended(path: &Path, parts: &[&str]) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    parts.iter().for_each(|part| name.push(part));
    name.into()
}

fn before_extension(path: &Path, number: &str) -> PathBuf {
    match path.extension().and_then(|e| e.to_str()) {
        Some(extension) => appended(&path.with_extension(""), &[number, ".", extension]),
        None => appended(path, &[number]),
    }
}

impl Outputs {
    /// What is wanted of a picture on a film.
    pub fn wanted(&self, film: Film, mut about: About) -> Wanted {
        film.describe(&mut about);
        let [exr, png] = [&self.exr, &self.png].map(Option::is_some);
        Wanted {
            exr,
            png,
            film,
            about,
            encoding: self.encoding,
        }
    }

    pub fn all(&self) -> impl Iterator<Item = &Target> {
        self.exr.iter().chain(&self.png)
    }

    /// Both of a picture, or none: first the EXR gets its name, then the PNG.
    pub fn write(&self, picture: &Picture) -> Result<()> {
        let bytes = picture.exr.iter().chain(&picture.png);
        let files: Vec<_> = self.all().zip(bytes.map(Vec::as_slice)).collect();
        Ok(output::write(&files)?)
    }

    /// Where to say what was done.
    pub fn report(&self) -> Box<dyn Write> {
        match self.all().next() {
            Some(target) => target.report(),
            None => Box::new(std::io::stdout()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_before_extensions() {
        let number = |text: &str| before_extension(Path::new(text), "-0007");
        assert_eq!(number("a.b/sky.png"), Path::new("a.b/sky-0007.png"));
        assert_eq!(number("a.b/sky"), Path::new("a.b/sky-0007"));
        assert_eq!(
            appended(Path::new("v-59.4"), &["-0001", ".", "exr"]),
            Path::new("v-59.4-0001.exr")
        );
    }
}
