//! The CSV tables of `fitter/data`, compiled into the program.

use anyhow::{Context, Result, ensure};

/// Numeric columns of a CSV text with `#` comments and one header line.
pub struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// Parses `text`; `source` names it in errors.
    pub fn parse(source: &str, text: &str) -> Result<Self> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let names = reader.headers()?.iter().map(str::to_owned).collect();
        let rows = reader
            .records()
            .map(|record| {
                record?
                    .iter()
                    .map(|cell| Ok(cell.trim().parse()?))
                    .collect()
            })
            .collect::<Result<Vec<Vec<f64>>>>()
            .with_context(|| format!("table {source}"))?;
        ensure!(rows.len() > 1, "table {source} has fewer than two rows");
        Ok(Self { names, rows })
    }

    /// A column by its name.
    pub fn column(&self, name: &str) -> Result<Vec<f64>> {
        let i = self
            .names
            .iter()
            .position(|n| n == name)
            .with_context(|| format!("no column {name}"))?;
        Ok(self.rows.iter().map(|row| row[i]).collect())
    }

    /// Column `name` as a function of column `of`, linear between rows.
    pub fn curve(&self, of: &str, name: &str) -> Result<Curve> {
        Ok(Curve {
            x: self.column(of)?,
            y: self.column(name)?,
        })
    }
}

/// A piecewise linear function, constant beyond its ends.
#[derive(Clone, Debug)]
pub struct Curve {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Curve {
    /// Through the points of `x`, at least two of them that increase, and `y`, as many.
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Result<Self> {
        ensure!(
            x.len() > 1 && x.len() == y.len(),
            "a function needs two points or more, not {} and {} numbers",
            x.len(),
            y.len()
        );
        ensure!(
            x.windows(2).all(|w| w[0] < w[1]),
            "the points must increase"
        );
        Ok(Self { x, y })
    }

    /// Where it bends.
    pub fn nodes(&self) -> &[f64] {
        &self.x
    }

    /// Its value at `x`.
    pub fn at(&self, x: f64) -> f64 {
        let (i, t) = self.locate(x);
        self.y[i] + t * (self.y[i + 1] - self.y[i])
    }

    /// Its value at `x` when the logarithm is linear between nodes.
    pub fn log_at(&self, x: f64) -> f64 {
        let (i, t) = self.locate(x);
        (self.y[i].ln() + t * (self.y[i + 1].ln() - self.y[i].ln())).exp()
    }

    fn locate(&self, x: f64) -> (usize, f64) {
        let i = self
            .x
            .partition_point(|&node| node <= x)
            .clamp(1, self.x.len() - 1)
            - 1;
        (
            i,
            ((x - self.x[i]) / (self.x[i + 1] - self.x[i])).clamp(0.0, 1.0),
        )
    }
}
