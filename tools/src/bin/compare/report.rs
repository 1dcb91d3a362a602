//! What was found, for people and for programs.

/// One comparison.
pub struct Row {
    pub name: &'static str,
    pub peer: &'static str,
    /// Median time of a query, ours and the peer's.
    pub ns: [f64; 2],
    /// 95th percentile of the relative error, ours and the peer's.
    pub p95_error: [Option<f64>; 2],
    /// Memory that answers the queries, ours and the peer's.
    pub bytes: [usize; 2],
}

/// Prints for people.
pub fn table(rows: &[Row]) {
    println!(
        "{:<30} {:>10} {:>9} {:>8}   {:<34} {:>10} {:>9} {:>6}",
        "", "ns", "p95 error", "kB", "peer", "ns", "p95 error", "ratio"
    );
    let percent = |e: Option<f64>| e.map_or("-".to_owned(), |e| format!("{:.2} %", 100.0 * e));
    for row in rows {
        println!(
            "{:<30} {:>10.1} {:>9} {:>8.1}   {:<34} {:>10.1} {:>9} {:>6.1}",
            row.name,
            row.ns[0],
            percent(row.p95_error[0]),
            row.bytes[0] as f64 / 1e3,
            row.peer,
            row.ns[1],
            percent(row.p95_error[1]),
            row.ns[1] / row.ns[0],
        );
    }
}

/// A list of objects.
pub fn json(rows: &[Row]) -> String {
    let number = |e: Option<f64>| e.map_or("null".to_owned(), |e| format!("{e:.6}"));
    let object = |row: &Row| {
        format!(
            r#"  {{"name": "{}", "ns": {:.2}, "peer": "{}", "peer_ns": {:.2}, "ratio": {:.3}, "p95_error": {}, "peer_p95_error": {}, "bytes": {}, "peer_bytes": {}}}"#,
            row.name,
            row.ns[0],
            row.peer,
            row.ns[1],
            row.ns[1] / row.ns[0],
            number(row.p95_error[0]),
            number(row.p95_error[1]),
            row.bytes[0],
            row.bytes[1],
        )
    };
    let objects: Vec<_> = rows.iter().map(object).collect();
    format!("[\n{}\n]", objects.join(",\n"))
}
