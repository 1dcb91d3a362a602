use std::time::Instant;
use welkin::geometry::Side;
use welkin_fitter::orders::source::Sun;
use welkin_fitter::{atmosphere::*, orders::*};
fn main() {
    for path in std::env::args().skip(1) {
        let d: serde_json::Value =
            serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let v = |x: &serde_json::Value| -> Vec<f64> {
            x.as_array()
                .unwrap()
                .iter()
                .map(|y| y.as_f64().unwrap())
                .collect()
        };
        let constituents = d["species"]
            .as_array()
            .unwrap()
            .iter()
            .map(|s| {
                let ext = 1.0;
                let ssa = s["single_scattering_albedo"]
                    .as_f64()
                    .or(s["ssa"].as_f64())
                    .unwrap_or(1.0);
                let kind = s["kind"].as_str().unwrap();
                let scat = match kind {
                    "rayleigh" => vec![Scatterer {
                        name: "r".into(),
                        phase: Phase::Rayleigh {
                            depolarisation: vec![s["depolarisation"].as_f64().unwrap(); 12],
                        },
                        scattering: vec![ssa; 12],
                    }],
                    "henyey_greenstein" => vec![Scatterer {
                        name: "a".into(),
                        phase: Phase::HenyeyGreenstein {
                            g: vec![s["g"].as_f64().unwrap(); 12],
                        },
                        scattering: vec![ssa; 12],
                    }],
                    _ => vec![],
                };
                Constituent {
                    name: kind.into(),
                    profile: v(&s["extinction_per_m"]),
                    extinction: vec![ext; 12],
                    scatterers: scat,
                }
            })
            .collect();
        let air = Atmosphere {
            planet_radius: d["planet_radius_m"].as_f64().unwrap(),
            altitudes: v(&d["altitude_m"]),
            wavelengths: (0..12).map(|i| 400.0 + i as f64).collect(),
            constituents,
        };
        let albedo = d["ground_albedo"].as_f64().unwrap() as f32;
        let e = d["sun_elevation_deg"].as_f64().unwrap().to_radians();
        let t = Instant::now();
        let medium = Medium::new(air, 0.0).unwrap();
        let mut st = Settings::default();
        for a in std::env::var("ST")
            .unwrap_or_default()
            .split(",")
            .filter(|a| !a.is_empty())
        {
            let (k, v) = a.split_once("=").unwrap();
            match k {
                "up" => st.up = v.parse().unwrap(),
                "down" => st.down = v.parse().unwrap(),
                "az" => st.azimuths = v.parse().unwrap(),
                "orders" => st.orders = v.parse().unwrap(),
                _ => st.fineness = v.parse().unwrap(),
            }
        }
        println!("{st:?}");
        let light = solve(&medium, st, &|_| ());
        println!(
            "{path} e {:.1} A {albedo} solved {:.1?} s {:.5}",
            e.to_degrees(),
            t.elapsed(),
            light.spherical_albedo[0]
        );
        let t = Instant::now();
        let g = Gatherer::new(&medium, &light, 1.0);
        let cols: Vec<&str> = d["columns"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| c.as_str().unwrap())
            .collect();
        let ix = |n: &str| {
            cols.iter()
                .position(|c| *c == n)
                .unwrap_or_else(|| panic!("{n} {cols:?}"))
        };
        let mut errs = vec![];
        for row in d["rows"].as_array().unwrap() {
            let r = |n: &str| row[ix(n)].as_f64().unwrap();
            let h = r("obs_alt_m");
            let th = r("view_zenith_deg").to_radians();
            let az = r("view_azimuth_deg").to_radians();
            let side = if r("los_hits_ground") == 1.0 {
                Side::Down
            } else {
                Side::Up
            };
            let p = g.path(h, std::f64::consts::FRAC_PI_2 - th, side);
            let sun = Sun {
                elevation: (e.cos(), e.sin()),
                azimuth: (az.cos(), az.sin()),
            };
            // generic assembly
            let (ss, ms, gr) = g.parts_for_test(&p, th.cos(), sun);
            let f = albedo / (1.0 - albedo * light.spherical_albedo[0]);
            let i = ss[0][0] + ms[0][0] + f * gr[0][0];
            let q = ss[1][0] + ms[1][0] + f * gr[1][0];
            let u = ss[2][0] + ms[2][0] + f * gr[2][0];
            let (ri, rq, ru) = (r("I_path"), r("Q_path"), r("U_path"));
            let si = r("sigma_I_path");
            let rs = row[ix("I_ss")].as_f64().unwrap_or(f64::NAN);
            errs.push((
                i as f64 / ri - 1.0,
                rs,
                ss[0][0] as f64 / rs - 1.0,
                si / ri,
                (q as f64 - rq) / ri,
                (u as f64 - ru) / ri,
                h,
                th.to_degrees(),
                az.to_degrees(),
                ri,
                rq / ri,
                ru / ri,
                q as f64 / ri,
                u as f64 / ri,
            ));
        }
        println!("gather {:.1?}", t.elapsed());
        let n = errs.len() as f64;
        println!(
            "  I bias {:+.4}% rms {:.4}% (ref se {:.4}%)  ss rms {:.5}%  Q/I bias {:+.5} rms {:.5}  U/I rms {:.5}",
            100.0 * errs.iter().map(|e| e.0).sum::<f64>() / n,
            100.0 * (errs.iter().map(|e| e.0 * e.0).sum::<f64>() / n).sqrt(),
            100.0 * (errs.iter().map(|e| e.3 * e.3).sum::<f64>() / n).sqrt(),
            100.0
                * (errs
                    .iter()
                    .map(|e| e.2 * e.2)
                    .filter(|x| x.is_finite())
                    .sum::<f64>()
                    / n)
                    .sqrt(),
            errs.iter().map(|e| e.4).sum::<f64>() / n,
            (errs.iter().map(|e| e.4 * e.4).sum::<f64>() / n).sqrt(),
            (errs.iter().map(|e| e.5 * e.5).sum::<f64>() / n).sqrt()
        );
        errs.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
        for e in errs.iter().take(6) {
            println!(
                "    I {:+.3}% se {:.3}% ss {:+.4}% h {} zen {:.2} az {:.1} I {:.4e} Q {:+.4} vs {:+.4} U {:+.4} vs {:+.4}",
                100.0 * e.0,
                100.0 * e.3,
                100.0 * e.2,
                e.6,
                e.7,
                e.8,
                e.9,
                e.12,
                e.10,
                e.13,
                e.11
            );
        }
    }
}
