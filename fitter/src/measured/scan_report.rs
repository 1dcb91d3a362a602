//! How far a fitted sky is from a scan: over all, by wavelength, by angle from the sun, by elevation.

use super::fit::{Choice, Fitted, Residual};
use super::scan::Scan;
use welkin::Conditions;

/// Of ln (measured / fitted).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// How many.
    pub count: usize,
    /// Mean: the bias.
    pub mean: f64,
    /// Median of what is off, either way.
    pub median: f64,
    /// Root of the mean square.
    pub rms: f64,
}

impl Spread {
    /// Of errors; none of none.
    pub fn of(errors: impl Iterator<Item = f64>) -> Option<Self> {
        let errors: Vec<f64> = errors.collect();
        let count = errors.len();
        let mut off: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
        off.sort_by(f64::total_cmp);
        let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / count as f64;
        (count > 0).then(|| Self {
            count,
            mean: mean(&mut errors.iter().copied()),
            median: off[count / 2],
            rms: mean(&mut errors.iter().map(|e| e * e)).sqrt(),
        })
    }
}

/// Head of the CSV.
pub const HEAD: &str = "scan,by,at,count,mean_ln,median_abs_ln,rms_ln\n";

/// Width of the bins of angles from the sun, degrees.
const BIN: f64 = 15.0;

/// A line for all, for every wavelength (nm), for angles from the sun in bins of 15° and for every elevation; and for
/// every sample of which something was left out, how many bands of it.
pub fn csv(scan: &Scan, choice: &Choice, fitted: &Fitted) -> String {
    let date = &scan.start;
    let name = format!(
        "{}-{:02}-{:02}T{}",
        date.year,
        date.month,
        date.day,
        date.clock()
    );
    let mut out = String::new();
    let mut line = |by: &str, at: String, keep: &dyn Fn(&Residual) -> bool| {
        let kept = fitted.residuals.iter().filter(|r| keep(r)).map(|r| r.error);
        if let Some(Spread {
            count,
            mean,
            median,
            rms,
        }) = Spread::of(kept)
        {
            out += &format!("{name},{by},{at},{count},{mean:.4},{median:.4},{rms:.4}\n");
        }
    };
    line("all", String::new(), &|_| true);
    for (w, nm) in choice.wavelengths.iter().enumerate() {
        line("wavelength_nm", nm.to_string(), &|r| r.wavelength == w);
    }
    for bin in 0..(180.0 / BIN) as usize {
        let from = BIN * bin as f64;
        line("from_sun_deg", from.to_string(), &|r| {
            (r.angle.to_degrees() / BIN) as usize == bin
        });
    }
    for ring in super::pattern::rings() {
        line("elevation_deg", ring.to_string(), &|r| {
            let elevation = scan.samples[r.sample].elevation.to_degrees();
            (elevation - ring).abs() < 1.0
        });
    }
    for (sample, count) in &fitted.left_out.samples {
        out += &format!("{name},left_out_of_sample,{sample},{count},,,\n");
    }
    out
}

/// What was fitted, in words.
pub fn summary(scan: &Scan, fitted: &Fitted) -> String {
    let Conditions {
        visibility,
        albedo,
        solar_elevation,
        ..
    } = fitted.conditions;
    let spread = Spread::of(fitted.residuals.iter().map(|r| r.error));
    let (median, rms) = spread.map_or((f64::NAN, f64::NAN), |s| (s.median, s.rms));
    let but = match fitted.left_out.count() {
        0 => String::new(),
        _ => format!("; left out: {}", fitted.left_out),
    };
    format!(
        "{}-{:02}-{:02} {}: sun {:.2}°, visibility {:.1} km, albedo {albedo:.2}, measured / model {:.3}, north \
         {:+.1}°; median |ln| {median:.3}, rms {rms:.3}{but}",
        scan.start.year,
        scan.start.month,
        scan.start.day,
        scan.start.clock(),
        solar_elevation.to_degrees(),
        1e-3 * visibility,
        fitted.scale,
        fitted.north.to_degrees(),
    )
}
