// The air between a camera and a point: `AerialBuffers` of the library has the formulae.

struct AerialHeader {
    sun: vec3<f32>,
    horizon: f32,
    up: vec3<f32>,
    nearest: f32,
    forward: vec3<f32>,
    farthest: f32,
    left: vec3<f32>,
    nodes_per_octave: f32,
    white: vec3<f32>,
    pole: f32,
    shrink: vec2<f32>,
    crowding: vec2<f32>,
    intervals: vec3<u32>,
    sun_intervals: u32,
    distances: u32,
    unused_a: u32,
    unused_b: u32,
    unused_c: u32,
    unused_d: u32,
    unused_e: u32,
    unused_f: u32,
    layout_version: u32,
}

// A direction, looked up: what all distances share.
struct AerialRay {
    cell: u32,
    columns: u32,
    cells: u32,
    row: vec4<f32>,
    column: vec4<f32>,
    envelope: vec4<f32>,
}

// What a node of the distance says of a ray.
struct AerialNode {
    light: vec4<f32>,
    depth: vec4<f32>,
}

// Light that is added, CIE XYZ with Y in cd m⁻², and factors of X, Y and Z of what is behind.
struct Aerial {
    light: vec3<f32>,
    factors: vec3<f32>,
}

// `d` is a unit vector.
fn aerial_ray(h: AerialHeader, first: u32, d: vec3<f32>) -> AerialRay {
    let z = clamp(dot(d, h.up), -1.0, 1.0);
    let side = side_of(z, h.horizon);
    let azimuth = azimuth_of(vec2<f32>(dot(d, h.forward), dot(d, h.left)));
    let row = spline_taps(
        row_of(z, h.horizon, side, h.shrink, h.crowding, h.pole) * f32(h.intervals[side]),
        h.intervals[side],
    );
    let column = spline_taps(half_sine(azimuth.x) * f32(h.intervals.z), h.intervals.z);
    let angle = spline_taps(half_chord(d, h.sun) * f32(h.sun_intervals), h.sun_intervals);
    var ray: AerialRay;
    ray.columns = h.intervals.z + 3u;
    ray.cells = (h.intervals.x + h.intervals.y + 6u) * ray.columns;
    ray.cell = first + h.sun_intervals + 3u
        + (row.first + side * (h.intervals.x + 3u)) * ray.columns + column.first;
    ray.row = row.weight;
    ray.column = column.weight;
    ray.envelope = spline_line(first + angle.first, angle.weight);
    return ray;
}

fn aerial_node(h: AerialHeader, ray: AerialRay, node: u32) -> AerialNode {
    let cell = ray.cell + node * ray.cells;
    let depths = (h.distances + 3u) * ray.cells;
    return AerialNode(
        spline_surface(cell, ray.columns, ray.row, ray.column),
        spline_surface(cell + depths, ray.columns, ray.row, ray.column),
    );
}

fn aerial_taps(h: AerialHeader, distance: f32) -> Taps {
    let nodes = log2(max(distance, h.nearest) / h.nearest) * h.nodes_per_octave;
    return spline_taps(min(nodes, f32(h.distances)), h.distances);
}

fn aerial_blend(h: AerialHeader, ray: AerialRay, nodes: array<AerialNode, 4>, weight: vec4<f32>, distance: f32) -> Aerial {
    let way = min(distance, h.farthest);
    let light = nodes[0].light * weight.x + nodes[1].light * weight.y
        + nodes[2].light * weight.z + nodes[3].light * weight.w;
    let depth = nodes[0].depth * weight.x + nodes[1].depth * weight.y
        + nodes[2].depth * weight.z + nodes[3].depth * weight.w;
    return Aerial(exp2((light + ray.envelope).xyz) * way, exp2(-way * max(depth.xyz, vec3<f32>())));
}

// A single point.
fn aerial_at(h: AerialHeader, first: u32, d: vec3<f32>, distance: f32) -> Aerial {
    let ray = aerial_ray(h, first, d);
    let taps = aerial_taps(h, distance);
    let nodes = array<AerialNode, 4>(
        aerial_node(h, ray, taps.first),
        aerial_node(h, ray, taps.first + 1u),
        aerial_node(h, ray, taps.first + 2u),
        aerial_node(h, ray, taps.first + 3u),
    );
    return aerial_blend(h, ray, nodes, taps.weight, distance);
}

// Factors of red, green and blue of linear sRGB from those of X, Y and Z.
fn aerial_srgb_factors(h: AerialHeader, factors: vec3<f32>) -> vec3<f32> {
    return clamp(linear_srgb(factors * h.white) / linear_srgb(h.white), vec3<f32>(), vec3<f32>(1.0));
}
