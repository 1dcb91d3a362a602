//! Models of coefficients next to the path tracer, in the exponential air that they are made for.

use super::bruneton::Bruneton;
use super::hillaire::Hillaire;
use super::lanes::Lanes;
use super::medium::Medium;
use super::nishita::Nishita;
use super::sky::{LaneModel, Observer};
use crate::evidence::air::{Air, LOW_TOP};

/// Zenith angle and solar elevation (degrees), across the sun; radiance of one order, of all over black ground, and of
/// all over ground of an albedo of 0.2, at 560 nm: `welkin-fit trace --atmosphere exponential.json`, the file being
/// that of `docs/evidence/trace`.
const TRACED: [([f64; 2], [f32; 3]); 6] = [
    ([5.0, 60.0], [2.7727e-2, 3.0807e-2, 3.3274e-2]),
    ([55.0, 60.0], [1.6284e-2, 2.0899e-2, 2.5621e-2]),
    ([86.0, 60.0], [2.6998e-2, 4.2848e-2, 6.3702e-2]),
    ([5.0, 20.0], [6.5908e-3, 8.8528e-3, 9.6538e-3]),
    ([55.0, 20.0], [9.0948e-3, 1.3567e-2, 1.5019e-2]),
    ([86.0, 20.0], [1.9813e-2, 3.5593e-2, 4.2658e-2]),
];

/// The exponential air at 560 nm.
fn medium(albedo: f32) -> Medium<1> {
    let air = Air::read(&crate::book::root().join("docs/evidence/air.csv")).unwrap();
    let all = air.medium(albedo).unwrap();
    let one = |lanes: Lanes<8>| Lanes([lanes.0[4]]);
    Medium {
        shell: all.shell,
        rayleigh: one(all.rayleigh),
        rayleigh_height: all.rayleigh_height,
        mie_scattering: one(all.mie_scattering),
        mie_extinction: one(all.mie_extinction),
        mie_height: all.mie_height,
        g: all.g,
        phase: all.phase,
        ozone: one(all.ozone),
        ozone_layer: all.ozone_layer,
        albedo: all.albedo,
        sun_radius: all.sun_radius,
    }
}

/// The largest relative difference to one of the columns.
fn worst(model: &dyn LaneModel<1>, column: usize) -> f32 {
    let off = |([zenith, elevation], traced): &([f64; 2], [f32; 3])| {
        let sky = model
            .sky(Observer::on_the_ground(elevation.to_radians()))
            .unwrap();
        let (y, z) = zenith.to_radians().sin_cos();
        let got = sky.relative_radiance([0.0, y as f32, z as f32]).unwrap().0[0];
        (got / traced[column] - 1.0).abs()
    };
    TRACED.iter().map(off).fold(0.0, f32::max)
}

#[test]
fn single_scattering_is_the_tracers() {
    assert!(worst(&Nishita::in_steps(&medium(0.2), 2000), 0) < 0.01);
}

/// In finer steps than published, which cost some per cent.
#[test]
#[cfg_attr(debug_assertions, ignore = "needs --release")]
fn single_scattering_from_tables_is_the_tracers() {
    let medium = medium(0.0).below(LOW_TOP);
    assert!(worst(&Bruneton::in_steps(&medium, 1, 300), 0) < 0.005);
    assert!(worst(&Bruneton::new(&medium, 1), 0) < 0.06);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "needs --release")]
fn all_orders_are_the_tracers() {
    let medium = medium(0.2).below(LOW_TOP);
    assert!(worst(&Bruneton::in_steps(&medium, 5, 150), 2) < 0.03);
}

/// Isotropic multiple scattering is an approximation, and off by that.
#[test]
fn hillaires_orders_are_nearly_the_tracers() {
    for (albedo, column) in [(0.0, 1), (0.2, 2)] {
        assert!(
            worst(&Hillaire::new(&medium(albedo)), column) < 0.15,
            "{albedo}"
        );
    }
}
