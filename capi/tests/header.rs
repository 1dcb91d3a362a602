//! `include/welkin/capi.h` is what cbindgen makes of the sources; `WELKIN_BLESS=1` writes it anew.

use std::mem::offset_of;
use std::path::Path;

use cbindgen::{Builder, Config, EnumConfig, ExportConfig, Language, RenameRule, Style};
use welkin::{
    WelkinAbi, WelkinAxis, WelkinBakeError, WelkinBudget, WelkinCameraVolume, WelkinConditions,
    WelkinError, WelkinMoon, WelkinPlanSummary, WelkinPolarisationFrame, WelkinRanges,
    WelkinSample, WelkinStokes,
};

const INTRODUCTION: &str = include_str!("introduction.h");
const TRAILER: &str = include_str!("trailer.h");

/// Assertions about the layout of structs, with the numbers of this library.
macro_rules! layouts {
    ($($name:ident { $($field:ident),* })*) => {{
        let mut text = String::new();
        $(
            let size = size_of::<$name>();
            text += &format!("WELKIN_LAYOUT(sizeof({0}) == {size}, \"size of {0}\");\n", stringify!($name));
            $(
                let (name, field) = (stringify!($name), stringify!($field));
                let offset = offset_of!($name, $field);
                text += &format!("WELKIN_LAYOUT(offsetof({name}, {field}) == {offset}, \"{name}.{field}\");\n");
            )*
        )*
        text
    }};
}

fn trailer() -> String {
    let layouts = layouts! {
        WelkinError { text }
        WelkinConditions { solar_elevation, solar_azimuth, visibility, albedo, altitude }
        WelkinPolarisationFrame { axis }
        WelkinStokes { u }
        WelkinBakeError { max }
        WelkinSample { pdf, xyz, part }
        WelkinRanges { wavelength, top }
        WelkinAxis { nodes, name, unit }
        WelkinMoon { distance }
        WelkinBudget { altitude, channels }
        WelkinPlanSummary { bake_p95 }
        WelkinCameraVolume { columns, depths }
        WelkinAbi { camera_volume }
    };
    TRAILER.replace("LAYOUTS\n", &layouts)
}

fn header() -> String {
    let config = Config {
        language: Language::C,
        style: Style::Both,
        cpp_compat: true,
        header: Some(INTRODUCTION.trim_end().to_owned()),
        trailer: Some(trailer().trim_end().to_owned()),
        include_guard: Some("WELKIN_CAPI_H".to_owned()),
        no_includes: true,
        sys_includes: ["stdbool.h", "stddef.h", "stdint.h"]
            .map(str::to_owned)
            .to_vec(),
        usize_is_size_t: true,
        line_length: 120,
        tab_width: 4,
        enumeration: EnumConfig {
            rename_variants: RenameRule::QualifiedScreamingSnakeCase,
            ..Default::default()
        },
        export: ExportConfig {
            exclude: vec!["Span".to_owned()],
            ..Default::default()
        },
        ..Config::default()
    };
    let room = Path::new(env!("CARGO_MANIFEST_DIR"));
    let bindings = Builder::new()
        .with_config(config)
        .with_crate(room)
        .generate()
        .unwrap();
    let mut text = Vec::new();
    bindings.write(&mut text);
    String::from_utf8(text).unwrap()
}

#[test]
fn the_header_is_that_of_the_sources() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("include/welkin/capi.h");
    let header = header();
    if std::env::var_os("WELKIN_BLESS").is_some() {
        std::fs::write(&path, &header).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == header,
        "include/welkin/capi.h differs: WELKIN_BLESS=1 cargo test --test header"
    );
}
