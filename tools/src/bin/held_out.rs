//! Errors of the embedded model at the samples that its fit did not see, as its file states them, as CSV:
//! `cargo run --release -p welkin-tools --bin held_out`.

use serde_json::Value;
use welkin::Model;
use welkin_tools::figures::{self, formatted};

fn main() -> figures::Result<()> {
    let model = Model::default_model()?;
    let metadata: Value = serde_json::from_str(&model.head().metadata)?;
    println!("held out at the nodes,median,p95,p99,max");
    for (key, name, unit) in [
        ("all", "radiance: all", "%"),
        ("day (sun > 0°)", "… sun above 0°", "%"),
        ("day, 300..760 nm", "… … 300..760 nm", "%"),
        ("sun 0..12°", "… sun at 0..12°", "%"),
        ("twilight", "… twilight", "%"),
        ("twilight, 300..760 nm", "… … 300..760 nm", "%"),
        ("within 15° of the sun", "… within 15° of the sun", "%"),
        (
            "within 2° of the horizon",
            "… within 2° of the horizon",
            "%",
        ),
    ] {
        print(name, &metadata["relative_error_held_out"][key], unit)?;
    }
    let degree = &metadata["degree_of_polarisation_error_held_out"];
    print("degree of linear polarisation", degree, "2")?;
    let angle = &metadata["angle_of_polarisation_error_deg_held_out"];
    print("angle of light more than 5 % polarised", angle, "°")
}

fn print(name: &str, quantiles: &Value, unit: &str) -> figures::Result<()> {
    let mut line = name.to_owned();
    for column in ["median", "p95", "p99", "max"] {
        let error = quantiles[column].as_f64();
        let error =
            error.ok_or_else(|| format!("the model does not state the {column} of {name}"))?;
        line += &match unit {
            "°" => format!(",{}°", formatted(error, "2")),
            _ => format!(",{}", formatted(error, unit)),
        };
    }
    println!("{line}");
    Ok(())
}
