//! Tables over the wavelength, from the data of the fitter.

use std::sync::OnceLock;

/// Columns of a CSV file over wavelengths of 1 nm.
struct Table {
    first: f64,
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// `columns` by their names.
    fn new(text: &str, columns: &[&str]) -> Self {
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
        let find = |name: &&str| names.iter().position(|n| n == name).expect("a column");
        let at: Vec<usize> = columns.iter().map(find).collect();
        let number = |cell: &str| cell.parse::<f64>().expect("a number");
        let mut first = None;
        let mut row = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            first.get_or_insert(number(cells[0]));
            at.iter().map(|&i| number(cells[i])).collect()
        };
        let rows = lines.map(&mut row).collect();
        Self {
            first: first.expect("rows"),
            rows,
        }
    }

    /// Between the rows; nothing beyond them.
    fn at(&self, nm: f64, column: usize) -> f64 {
        let at = nm - self.first;
        if at < 0.0 || at > (self.rows.len() - 1) as f64 {
            return 0.0;
        }
        let i = (at as usize).min(self.rows.len() - 2);
        let [a, b] = [self.rows[i][column], self.rows[i + 1][column]];
        a + (at - i as f64) * (b - a)
    }
}

/// Absorption cross section of ozone at 223 K, m².
pub fn ozone(nm: f64) -> f64 {
    static TABLE: OnceLock<Table> = OnceLock::new();
    const TEXT: &str = include_str!("../../../fitter/data/o3_xsec_1nm.csv");
    1e-4 * TABLE
        .get_or_init(|| Table::new(TEXT, &["sigma_223K"]))
        .at(nm, 0)
}

/// Of the sun outside the air, W m⁻² nm⁻¹: the one of the default model.
pub fn sun(nm: f64) -> f64 {
    static TABLE: OnceLock<Table> = OnceLock::new();
    const TEXT: &str = include_str!("../../../fitter/data/solar_irradiance_1nm.csv");
    TABLE.get_or_init(|| Table::new(TEXT, &["g173"])).at(nm, 0)
}

/// Colour matching functions of the CIE 1931 2° observer.
pub fn matching(nm: f64) -> [f64; 3] {
    static TABLE: OnceLock<Table> = OnceLock::new();
    const TEXT: &str = include_str!("../../../fitter/data/cie1931_2deg_1nm.csv");
    let table = TABLE.get_or_init(|| Table::new(TEXT, &["xbar", "ybar", "zbar"]));
    std::array::from_fn(|k| table.at(nm, k))
}
