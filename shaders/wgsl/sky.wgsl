// A baked sky: colours, wavelengths or bands, and their polarisation. `SkyBuffers` of the library has the formulae.

struct SkyHeader {
    sun: vec3<f32>,
    horizon: f32,
    azimuth: vec2<f32>,
    shrink: vec2<f32>,
    crowding: vec2<f32>,
    pole: f32,
    opaque_length: f32,
    intervals: vec3<u32>,
    sun_intervals: u32,
    groups: u32,
    channels: u32,
    polarised: u32,
    layout_version: u32,
}

// A direction, looked up: what all channels share.
struct SkyPoint {
    cell: u32,
    columns: u32,
    cells: u32,
    angle: Taps,
    row: vec4<f32>,
    column: vec4<f32>,
    opacity: f32,
    // Sine of the azimuth from the sun.
    sine: f32,
}

// `d` is a unit vector, +z up.
fn sky_point(h: SkyHeader, d: vec3<f32>) -> SkyPoint {
    let side = side_of(d.z, h.horizon);
    let turned = vec2<f32>(dot(d.xy, h.azimuth), d.y * h.azimuth.x - d.x * h.azimuth.y);
    let azimuth = azimuth_of(turned);
    let row = spline_taps(
        row_of(d.z, h.horizon, side, h.shrink, h.crowding, h.pole) * f32(h.intervals[side]),
        h.intervals[side],
    );
    let column = spline_taps(half_sine(azimuth.x) * f32(h.intervals.z), h.intervals.z);
    let columns = h.intervals.z + 3u;
    var point: SkyPoint;
    point.cell = (row.first + side * (h.intervals.x + 3u)) * columns + column.first;
    point.columns = columns;
    point.cells = (h.intervals.x + h.intervals.y + 6u) * columns;
    point.angle = spline_taps(half_chord(d, h.sun) * f32(h.sun_intervals), h.sun_intervals);
    point.row = row.weight;
    point.column = column.weight;
    point.opacity = sky_opacity(h, d.z, side);
    point.sine = azimuth.y;
    return point;
}

// Of the air before the ground; 1 above the horizon.
fn sky_opacity(h: SkyHeader, z: f32, side: u32) -> f32 {
    let root = sqrt(max((z + h.horizon) * (z - h.horizon), 0.0)) + abs(z);
    return select(h.opaque_length / (h.opaque_length + max(root, 1e-20)), 1.0, side == 0u);
}

// Four channels of a group: X, Y, Z of a colour sky (cd m⁻²), spectral radiance (W m⁻² sr⁻¹ nm⁻¹) or bands.
fn sky_group(h: SkyHeader, first: u32, point: SkyPoint, group: u32) -> vec4<f32> {
    let envelope = h.sun_intervals + 3u;
    let cells = first + h.groups * envelope + group * point.cells;
    let logarithm = spline_line(first + group * envelope + point.angle.first, point.angle.weight)
        + spline_surface(cells + point.cell, point.columns, point.row, point.column);
    return exp2(logarithm) * point.opacity * welkin_table[sky_scale(h, first, point) + group];
}

fn sky_scale(h: SkyHeader, first: u32, point: SkyPoint) -> u32 {
    return first + h.groups * (h.sun_intervals + 3u + point.cells * (1u + 2u * h.polarised));
}

// Q/I and U/I of a group in the vertical frame; only where the header says `polarised`.
fn sky_polarisation(h: SkyHeader, first: u32, point: SkyPoint, group: u32) -> array<vec4<f32>, 2> {
    let q = first + h.groups * (h.sun_intervals + 3u + point.cells) + 2u * group * point.cells + point.cell;
    let ratio = spline_surface(q, point.columns, point.row, point.column);
    let other = spline_surface(q + point.cells, point.columns, point.row, point.column) * point.sine;
    // Nothing is more than fully polarised.
    let shrink = inverseSqrt(max(ratio * ratio + other * other, vec4<f32>(1.0)));
    return array<vec4<f32>, 2>(ratio * shrink, other * shrink);
}

// CIE XYZ of a colour sky, Y in cd m⁻².
fn sky_xyz(h: SkyHeader, first: u32, d: vec3<f32>) -> vec3<f32> {
    return sky_group(h, first, sky_point(h, d), 0u).xyz;
}
