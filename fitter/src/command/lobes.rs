//! `welkin-fit lobes`: phase functions as sums of a few Henyey-Greenstein functions.

use super::atmosphere::draw::{Panel, Series, svg};
use super::make::find;
use anyhow::Result;
use std::path::PathBuf;
use welkin::output::{Target, write};
use welkin_fitter::atmosphere::matrix::{Matrix, NODES, angle};
use welkin_fitter::atmosphere::{Monochromatic, Phase};
use welkin_fitter::dataset::VISIBLE;
use welkin_fitter::particles::lobe_fit::{Lobes, MOST, Signs, fit, value};

/// Fits the phase functions of the particles of a recipe, as spheres, by more and more Henyey-Greenstein functions.
#[derive(clap::Args)]
pub struct Args {
    /// The recipe: a TOML file or a name.
    recipe: PathBuf,
    /// Draw the phase functions at 550 nm and these fits, as SVG.
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    /// Write the errors as CSV, too.
    #[arg(long, value_name = "CSV")]
    csv: Option<PathBuf>,
    /// Print the functions of so many, too.
    #[arg(long, value_name = "COUNT")]
    functions: Option<usize>,
}

/// Ranges of scattering angles, degrees.
const RANGES: [[f64; 2]; 4] = [[0.0, 5.0], [5.0, 20.0], [20.0, 160.0], [160.0, 180.0]];
/// Wavelengths that are reported, by node: 300, 343, 550, 740, 1030 nm.
const REPORTED: [usize; 5] = [0, 7, 12, 16, 23];
/// That of the plot.
const GREEN: usize = 12;

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let species = species(args)?;
    let mut rows = vec![];
    for (name, matrix) in &species {
        let fits: Vec<Vec<Lobes>> = (1..=MOST)
            .map(|count| fit(matrix, count, Signs::Any))
            .collect();
        for w in REPORTED {
            for (count, lobes) in fits.iter().enumerate() {
                rows.push(Row {
                    name: name.clone(),
                    wavelength: VISIBLE.nodes[w].wavelength,
                    lobes: count + 1,
                    errors: RANGES.map(|range| error(matrix, w, &lobes[w], range)),
                });
            }
        }
        if let Some(lobes) = args.functions.and_then(|n| fits.get(n.wrapping_sub(1))) {
            functions(name, lobes);
        }
    }
    print(&rows);
    if let Some(path) = &args.csv {
        write(&[(&Target::new(path), &csv(&rows)?)])?;
    }
    if let Some(path) = &args.plot {
        let panels: Vec<Panel> = species.iter().take(3).map(panel).collect();
        let text = svg("phase functions at 550 nm by sums of lobes", &panels)?;
        write(&[(&Target::new(path), text.as_bytes())])?;
    }
    Ok(())
}

/// How far so many lobes are from a phase function.
struct Row {
    name: String,
    wavelength: f64,
    lobes: usize,
    /// Root mean squares of fit / phase function − 1 by range of angles.
    errors: [f64; RANGES.len()],
}

fn ranges() -> [String; RANGES.len()] {
    RANGES.map(|[from, to]| format!("{from}..{to}°"))
}

fn print(rows: &[Row]) {
    println!("root mean square of fit/phase function − 1, by scattering angle");
    print!("{:<8}{:>8}{:>6}", "", "nm", "lobes");
    ranges().iter().for_each(|range| print!("{range:>12}"));
    println!();
    for row in rows {
        print!("{:<8}{:>8}{:>6}", row.name, row.wavelength, row.lobes);
        row.errors
            .iter()
            .for_each(|e| print!("{:>11.1}%", 100.0 * e));
        println!();
    }
}

fn csv(rows: &[Row]) -> Result<Vec<u8>> {
    let mut out = csv::Writer::from_writer(vec![]);
    let head = ["particles", "nm", "lobes"].map(str::to_owned);
    out.write_record(head.iter().chain(&ranges()))?;
    for row in rows {
        let place = [
            row.name.clone(),
            row.wavelength.to_string(),
            row.lobes.to_string(),
        ];
        let errors = row.errors.map(|e| format!("{:.1} %", 100.0 * e));
        out.write_record(place.iter().chain(&errors))?;
    }
    Ok(out.into_inner().map_err(|e| e.into_error())?)
}

/// Different phase functions with the names of the particles.
fn species(args: &Args) -> Result<Vec<(String, std::sync::Arc<Matrix>)>> {
    let recipe = find(&args.recipe)?.with_mie()?;
    let lights = VISIBLE
        .nodes
        .map(|n| Monochromatic::beside_lines(n.wavelength));
    let mut out: Vec<(String, std::sync::Arc<Matrix>)> = vec![];
    for constituent in recipe.air(&lights)?.constituents {
        for scatterer in constituent.scatterers {
            if let Phase::Tabulated(matrix) = scatterer.phase
                && out.iter().all(|(_, known)| *known != matrix)
            {
                out.push((scatterer.name, matrix));
            }
        }
    }
    Ok(out)
}

fn error(matrix: &Matrix, w: usize, lobes: &[[f64; 2]], [from, to]: [f64; 2]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for i in (0..NODES).filter(|&i| (from..=to).contains(&angle(i).to_degrees())) {
        let relative = value(lobes, angle(i).cos()) / matrix.at(w, i)[0] - 1.0;
        sum += relative * relative;
        count += 1.0;
    }
    (sum / f64::max(count, 1.0)).sqrt()
}

fn functions(name: &str, lobes: &[Lobes]) {
    for (w, lobes) in lobes.iter().enumerate() {
        print!("{name} {} nm:", VISIBLE.nodes[w].wavelength);
        lobes
            .iter()
            .for_each(|[weight, g]| print!("  {weight:.4} · HG({g:.4})"));
        println!();
    }
}

fn panel((name, matrix): &(String, std::sync::Arc<Matrix>)) -> Panel {
    // From a quarter of a degree on, which a logarithmic axis can show.
    let nodes: Vec<usize> = (3..NODES).collect();
    let points = |of: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
        nodes
            .iter()
            .map(|&i| (angle(i).to_degrees(), of(i)))
            .collect()
    };
    let mut series = vec![Series::new(
        &format!("{name}, Mie"),
        points(&|i| matrix.at(GREEN, i)[0]),
    )];
    for count in [1, 3, 4, 5] {
        let lobes = fit(matrix, count, Signs::Any).swap_remove(GREEN);
        series.push(Series::new(
            &format!("{count} lobes"),
            points(&|i| value(&lobes, angle(i).cos())),
        ));
    }
    Panel {
        title: "P11, mean 1",
        below: "scattering angle, degrees",
        beside: "",
        x: (0.3, 180.0),
        y: (0.01, 1000.0),
        log: (true, true),
        series,
    }
}
