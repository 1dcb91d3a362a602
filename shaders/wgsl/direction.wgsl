// Coordinates of directions that the tables share.

const WELKIN_PI: f32 = 3.14159265358979;

// Cosine and sine of 0 ≤ x ≤ π/2 to rounding; those of a graphics processor may be off by 5e-4.
fn quarter_turn(x: f32) -> vec2<f32> {
    let t = x - 0.25 * WELKIN_PI;
    let s = t * t;
    let sine = t * (1.0 - s * (1.0 / 6.0 - s * (1.0 / 120.0 - s * (1.0 / 5040.0 - s / 362880.0))));
    let cosine = 1.0 - s * (0.5 - s * (1.0 / 24.0 - s * (1.0 / 720.0 - s / 40320.0)));
    return vec2<f32>(cosine - sine, cosine + sine) * 0.70710678;
}

// Cosine and sine of 0 ≤ x ≤ π.
fn half_turn(x: f32) -> vec2<f32> {
    let half = quarter_turn(0.5 * x);
    return vec2<f32>((half.x - half.y) * (half.x + half.y), 2.0 * half.x * half.y);
}

// 0 above the geometric horizon, 1 below it.
fn side_of(z: f32, horizon: f32) -> u32 {
    return select(1u, 0u, z >= horizon);
}

// Root of the share of the way in z from the pole to the horizon.
fn pole_cosine(z: f32, side: u32, shrink: vec2<f32>) -> f32 {
    let sign = 1.0 - 2.0 * f32(side);
    return sqrt(clamp((1.0 - sign * z) * shrink[side], 0.0, 1.0));
}

// Place among the rows of a table, 0 at the horizon and 1 at the pole.
fn row_of(z: f32, horizon: f32, side: u32, shrink: vec2<f32>, crowding: vec2<f32>, pole: f32) -> f32 {
    let sine = sqrt(min(abs(z - horizon) * shrink[side], 1.0));
    let cosine = pole_cosine(z, side, shrink);
    let c = crowding[side];
    return (c * sine + sine) / (c * sine + (cosine * pole + 1.0));
}

// Cosine and sine of the azimuth from the sun: `d` along the sun's azimuth and to the left of it.
fn azimuth_of(d: vec2<f32>) -> vec2<f32> {
    let square = dot(d, d);
    if square < 1e-37 {
        return vec2<f32>(1.0, 0.0);
    }
    return d / sqrt(square);
}

fn half_sine(cosine: f32) -> f32 {
    return sqrt(clamp(0.5 - 0.5 * cosine, 0.0, 1.0));
}

// Half the chord between unit vectors: exact where the cosine of the angle is not.
fn half_chord(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let way = a - b;
    return min(0.5 * sqrt(dot(way, way)), 1.0);
}
