//! Compiles the C reader for the differential target.

fn main() {
    let [wrapper, reader] = [
        "fuzz_targets/differential/reader.c",
        "../format-spec/readers/c/welkin.h",
    ];
    println!("cargo:rerun-if-changed={wrapper}");
    println!("cargo:rerun-if-changed={reader}");
    cc::Build::new()
        .file(wrapper)
        .std("c99")
        .opt_level(2)
        .warnings(false)
        .include("../format-spec/readers/c")
        .compile("welkin_c_reader");
}
