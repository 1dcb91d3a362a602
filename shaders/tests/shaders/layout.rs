//! Headers lie in memory as the structs of the shaders do; `LAYOUT.md` says how.

use std::mem::{offset_of, size_of};
use std::path::Path;

use crate::common::readme::{compare, table};
use naga::TypeInner;
use welkin::{
    AerialBuffers, AerialHeader, AirBuffers, AirHeader, BufferHeader, DiscBuffers, DiscHeader,
};
use welkin::{SamplerBuffers, SamplerHeader, SkyBuffers};
use welkin_shaders::{PROGRAMS, module};

/// A field and its offset.
type Field = (&'static str, usize);

macro_rules! fields {
    ($type:ty: $($field:ident)*) => {
        (size_of::<$type>(), vec![$((stringify!($field), offset_of!($type, $field))),*])
    };
}

/// Struct of the shaders, program that has it, version, size and fields in the library.
type Header = (&'static str, &'static str, u32, (usize, Vec<Field>));

fn headers() -> [Header; 5] {
    [
        (
            "SkyHeader",
            "sky_directions",
            SkyBuffers::LAYOUT,
            fields!(BufferHeader: sun horizon azimuth shrink crowding pole opaque intervals sun_intervals groups
                channels polarised layout),
        ),
        (
            "DiscHeader",
            "disc_directions",
            DiscBuffers::LAYOUT,
            fields!(DiscHeader: centre chord up floor left area lowest nodes_per_radian mean nodes groups wavelengths
                visible cut margin unused layout),
        ),
        (
            "SamplerHeader",
            "sampler_draws",
            SamplerBuffers::LAYOUT,
            fields!(SamplerHeader: azimuth shrink horizon share rows columns unused layout),
        ),
        (
            "AirHeader",
            "air_segments",
            AirBuffers::LAYOUT,
            fields!(AirHeader: radius top layers quads groups wavelengths unused layout),
        ),
        (
            "AerialHeader",
            "fill_volume",
            AerialBuffers::LAYOUT,
            fields!(AerialHeader: sun horizon up height forward top left bend white pole shrink crowding intervals
                sun_intervals distances steepness haze nearness per_stretch unused layout),
        ),
    ]
}

/// Name, type and offset of the members of a struct, and its size.
fn members(program: &str, name: &str) -> (Vec<(String, String, u32)>, u32) {
    let program = PROGRAMS.iter().find(|p| p.name == program).unwrap();
    let (module, _) = module(&program.source()).unwrap();
    let found = module
        .types
        .iter()
        .find(|(_, t)| t.name.as_deref() == Some(name));
    let TypeInner::Struct { members, span } = &found.expect("the struct").1.inner else {
        panic!("{name} is no struct");
    };
    let scalar = |scalar: naga::Scalar| match scalar.kind {
        naga::ScalarKind::Float => "f32",
        _ => "u32",
    };
    let members = members.iter().map(|member| {
        let kind = match &module.types[member.ty].inner {
            TypeInner::Scalar(s) => scalar(*s).to_string(),
            TypeInner::Vector { size, scalar: s } => format!("vec{}<{}>", *size as u8, scalar(*s)),
            other => panic!("{other:?}"),
        };
        (member.name.clone().unwrap(), kind, member.offset)
    });
    (members.collect(), *span)
}

#[test]
fn headers_are_those_of_the_shaders() {
    let mut page = String::from(
        "# Headers of the buffers\n\nUniform buffers, with the offsets of std140 and std430. \
         `WELKIN_BLESS=1 cargo test layout` writes this page.\n",
    );
    for (name, program, version, (size, fields)) in headers() {
        let (members, span) = members(program, name);
        assert_eq!(span as usize, size, "{name}");
        for (field, offset) in fields {
            // Names that a shader cannot have, or has one by one.
            let wanted = match field {
                "opaque" => "opaque_length",
                "layout" => "layout_version",
                "unused" if members.iter().any(|m| m.0 == "unused_a") => "unused_a",
                field => field,
            };
            let member = members
                .iter()
                .find(|m| m.0 == wanted)
                .unwrap_or_else(|| panic!("{name}.{wanted}"));
            assert_eq!(member.2 as usize, offset, "{name}.{wanted}");
        }
        let rows: Vec<[String; 3]> = members
            .into_iter()
            .map(|(member, kind, offset)| {
                [
                    format!("`{member}`"),
                    format!("`{kind}`"),
                    offset.to_string(),
                ]
            })
            .collect();
        page += &format!("\n## {name}, version {version}, {size} bytes\n\n");
        page += &table(&["field", "type", "offset"], &rows);
    }
    compare(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("LAYOUT.md"),
        &page,
    );
}
