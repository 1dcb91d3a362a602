//! `welkin animate`: a picture at every step of the sun's course.

use std::fs::File;
use std::io::{BufReader, Write};
use std::path::Path;

use welkin::Conditions;
use welkin::output::Target;

use crate::failure::{Failure, Result};
use crate::outputs::Outputs;
use crate::{parallel, render};

/// What a frame says about the call that made it.
const MARK: &str = "animation";

#[derive(clap::Args)]
// What differs from a single picture.
#[command(
    mut_arg("out", |out| out.help("Name of the frames: sky gives sky-0001.exr and sky-0001.png …, sky.png gives sky-0001.png …; their folder is made if it is not there")),
    mut_arg("sun_elevation", |sun| sun.required_unless_present("date"))
)]
pub struct Options {
    #[command(flatten)]
    render: render::Options,
    /// How many frames the course of the sun has, both ends included.
    #[arg(long, default_value_t = 120, value_parser = clap::value_parser!(u32).range(1..=100_000), value_name = "COUNT")]
    frames: u32,
    /// Render all frames anew, over whatever is there. Without, frames of the same call that exist whole are left as
    /// they are, and others are refused before the first is rendered.
    #[arg(long)]
    overwrite: bool,
}

pub fn run(options: &Options) -> Result<()> {
    let (render, count) = (&options.render, options.frames as usize);
    let model = render.scene.over_ground(render.source.open()?);
    let course = render.course(&model, count)?;
    let outputs = render.outputs.numbered(count)?;
    let call = options.call()?;
    let mark = |frame: usize| format!("{call:08x} {} of {count}", frame + 1);
    let mut missing = Vec::new();
    for (frame, outputs) in outputs.iter().enumerate() {
        if options.overwrite || !exists(outputs, &mark(frame))? {
            missing.push(frame);
        }
    }
    let bar = parallel::outer_bar(missing.len(), "frames");
    for &frame in &missing {
        let conditions: &Conditions = &course[frame];
        let marks = [(MARK, &*mark(frame))];
        let shot = render.shot(&model, conditions, &outputs[frame], &marks);
        let written = shot.and_then(|shot| outputs[frame].write(&shot.picture));
        written.map_err(|failure| failure.about(&format!("frame {}", frame + 1)))?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    let mut out = outputs[0].report();
    let ends = |of: &Outputs| {
        of.all()
            .map(Target::to_string)
            .collect::<Vec<_>>()
            .join(" and ")
    };
    writeln!(
        out,
        "frames          {} to {}",
        ends(&outputs[0]),
        ends(&outputs[count - 1])
    )?;
    writeln!(
        out,
        "rendered        {}, and {} were there already",
        missing.len(),
        count - missing.len()
    )?;
    Ok(())
}

impl Options {
    /// A checksum of all that makes a frame what it is.
    fn call(&self) -> Result<u32> {
        let mut hasher = crc32fast::Hasher::new();
        hasher.update(env!("CARGO_PKG_VERSION").as_bytes());
        for argument in std::env::args_os().skip(1) {
            if argument != "--overwrite" {
                hasher.update(argument.as_encoded_bytes());
                hasher.update(&[0]);
            }
        }
        hasher.update(&self.render.source.bytes()?);
        let files = [self.render.landscape.file(), self.render.sensor.file()];
        for path in files.into_iter().flatten() {
            let unreadable = |e| Failure::message(format!("{}: {e}", path.display()));
            hasher.update(&std::fs::read(path).map_err(unreadable)?);
        }
        if let Some(ground) = self.render.scene.ground() {
            // What its table holds, which may change under the same name.
            hasher.update(format!("{ground:?}").as_bytes());
        }
        Ok(hasher.finalize())
    }
}

/// Whether a frame is there, whole and of the same call; an error if something else is.
fn exists(outputs: &Outputs, mark: &str) -> Result<bool> {
    let mut there = Vec::new();
    for target in outputs.all() {
        let Target::Path(path) = target else {
            continue;
        };
        if !path.exists() {
            there.push(false);
        } else if mark_of(path).as_deref() == Some(mark) {
            there.push(true);
        } else {
            let text =
                format!("{target} is there, and not of this call: --overwrite, or another --out");
            return Err(Failure::message(text));
        }
    }
    Ok(there.into_iter().all(|is_there| is_there))
}

/// What a file says about its call, if it is whole.
fn mark_of(path: &Path) -> Option<String> {
    match path.extension()?.to_str()? {
        "exr" => mark_of_exr(path),
        _ => mark_of_png(path),
    }
}

fn mark_of_exr(path: &Path) -> Option<String> {
    use exr::prelude::{AttributeValue, Text, read_all_flat_layers_from_file};
    let image = read_all_flat_layers_from_file(path).ok()?;
    match image
        .layer_data
        .first()?
        .attributes
        .other
        .get(&Text::from(MARK))?
    {
        AttributeValue::Text(text) => Some(text.to_string()),
        _ => None,
    }
}

fn mark_of_png(path: &Path) -> Option<String> {
    let file = BufReader::new(File::open(path).ok()?);
    let mut reader = png::Decoder::new(file).read_info().ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    reader.next_frame(&mut pixels).ok()?;
    reader.finish().ok()?;
    let mut texts = reader.info().utf8_text.iter();
    texts.find(|text| text.keyword == MARK)?.get_text().ok()
}
