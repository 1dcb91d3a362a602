// Cubic B-splines with even intervals: the first of four neighbours and their weights.

struct Taps {
    first: u32,
    weight: vec4<f32>,
}

// `u` counts intervals from the start of the axis.
fn spline_taps(u: f32, intervals: u32) -> Taps {
    let cell = clamp(floor(u), 0.0, f32(intervals) - 1.0);
    let t = u - cell;
    let s = 1.0 - t;
    let inner = vec2<f32>(t * t * (t * 3.0 - 6.0), s * s * (s * 3.0 - 6.0)) + 4.0;
    let weight = vec4<f32>(s * s * s, inner.x, inner.y, t * t * t) * (1.0 / 6.0);
    return Taps(u32(cell), weight);
}

fn spline_line(first: u32, weight: vec4<f32>) -> vec4<f32> {
    return (welkin_table[first] * weight.x + welkin_table[first + 1u] * weight.y)
        + (welkin_table[first + 2u] * weight.z + welkin_table[first + 3u] * weight.w);
}

fn spline_surface(first: u32, stride: u32, rows: vec4<f32>, columns: vec4<f32>) -> vec4<f32> {
    return spline_line(first, columns) * rows.x
        + spline_line(first + stride, columns) * rows.y
        + spline_line(first + 2u * stride, columns) * rows.z
        + spline_line(first + 3u * stride, columns) * rows.w;
}
