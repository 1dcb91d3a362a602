//! Bands of sensors against sums over single wavelengths.

use std::time::Instant;
use welkin::{Conditions, Model, Response};

#[test]
fn explore() {
    let model = Model::default_model().unwrap();
    let gauss = |c: f64, w: f64| {
        let l: Vec<f64> = (-30..=30).map(|i| c + w * f64::from(i) / 10.0).collect();
        let v: Vec<f64> = l.iter().map(|l| (-0.5 * ((l - c) / w).powi(2)).exp()).collect();
        Response::table(&l, &v).unwrap().normalised()
    };
    println!("{:?}", model.wavelengths());
    let sets: Vec<(&str, Vec<Response>)> = vec![
        ("rgb", vec![gauss(450.0, 20.0), gauss(540.0, 30.0), gauss(600.0, 25.0)]),
        ("broad", vec![Response::table(&[350.0, 700.0], &[1.0, 1.0]).unwrap()]),
        ("box10", (0..12).map(|i| { let c = 400.0 + 25.0 * i as f64; Response::table(&[c - 5.0, c + 5.0], &[1.0, 1.0]).unwrap() }).collect()),
        ("hero12", (0..12).map(|i| Response::wavelength(400.0 + 25.3 * i as f64)).collect()),
        ("hero4", (0..4).map(|i| Response::wavelength(420.0 + 80.3 * i as f64)).collect()),
        ("nodes", model.wavelengths().iter().map(|&l| Response::wavelength(l)).collect()),
    ];
    for (name, set) in sets {
        let t = Instant::now();
        let bands = model.bands(&set).unwrap();
        let took = t.elapsed();
        println!("{name}: {took:?} nodes {:?}", bands.nodes());
        for r in bands.residuals() { print!(" {:.5}/{:.5}", r.median, r.p99); }
        println!();
        bands.describe();
        let c = Conditions::default();
        for _ in 0..3 { let t = Instant::now(); let _ = model.band_sky(&c, &bands).unwrap(); print!(" band {:?}", t.elapsed());
        let t = Instant::now(); let _ = model.sky(&c).unwrap(); println!(" all {:?}", t.elapsed()); }
    }
}
