use std::io::Write;
use welkin_fitter::dataset::Store;
use welkin_fitter::spectrum::{
    cells::cells,
    training::{Training, lights},
};
fn main() -> anyhow::Result<()> {
    let args: Vec<String> = std::env::args().collect();
    let t = Training::default();
    let c = cells()?;
    let l = lights(&c);
    eprintln!(
        "{} cells, {} lights, {} sets",
        c.len(),
        l.len(),
        l.len().div_ceil(24)
    );
    let mut f = std::fs::File::create(format!("{}/cells.csv", args[1]))?;
    for (i, c) in c.iter().enumerate() {
        for t in &c.terms {
            writeln!(
                f,
                "{i},{},{},{},{}",
                c.wavelength, t.weight, t.light.water, t.light.mixed
            )?;
        }
    }
    if args.len() < 3 {
        return Ok(());
    }
    let store = Store::open(format!("{}/units", args[1]), format!("{t:?} {l:?}"))?;
    for &v in &t.visibilities {
        for set in 0..l.len().div_ceil(24) {
            let start = std::time::Instant::now();
            t.unit(&store, v, &l, set)?;
            eprintln!("{v} {set} {:.1} s", start.elapsed().as_secs_f64());
        }
    }
    Ok(())
}
