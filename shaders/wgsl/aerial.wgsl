// The air between a camera and a point: `AerialBuffers` of the library has the formulae.

struct AerialHeader {
    sun: vec3<f32>,
    horizon: f32,
    up: vec3<f32>,
    height: f32,
    forward: vec3<f32>,
    top: f32,
    left: vec3<f32>,
    bend: f32,
    white: vec3<f32>,
    pole: f32,
    shrink: vec2<f32>,
    crowding: vec2<f32>,
    intervals: vec3<u32>,
    sun_intervals: u32,
    distances: u32,
    steepness: f32,
    haze: f32,
    nearness: f32,
    per_stretch: f32,
    unused_a: u32,
    unused_b: u32,
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
    way: AerialWay,
}

// How the distances of a ray are measured.
struct AerialWay {
    // Growth of w at the camera.
    rise: f32,
    end: f32,
    // Nearness over the measure of the end.
    rate: f32,
    // The ray goes down to the ground.
    grounded: bool,
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
    ray.way = aerial_way(h, z, side);
    return ray;
}

// How far rays go on beyond ground and air, m, so that none ends where it begins.
const AERIAL_BEYOND: f32 = 20.0;

fn aerial_way(h: AerialHeader, z: f32, side: u32) -> AerialWay {
    var way: AerialWay;
    way.rise = z * h.steepness;
    way.grounded = side == 1u;
    if way.grounded {
        let root = sqrt(max((z - h.horizon) * (z + h.horizon), 0.0)) * h.steepness;
        way.end = 2.0 * h.height / (root - way.rise);
    } else {
        let root = sqrt(max(way.rise * way.rise + 4.0 * h.bend * (h.top - h.height), 0.0));
        if way.rise > 0.0 {
            way.end = 2.0 * (h.top - h.height) / (root + way.rise);
        } else {
            way.end = (root - way.rise) / (2.0 * h.bend);
        }
    }
    way.end = max(way.end, 0.0) + AERIAL_BEYOND;
    way.rate = h.nearness / aerial_measure(h, way.rise, way.end);
    return way;
}

// What the density (w + haze)^(-3/2) sums up to over a distance.
fn aerial_measure(h: AerialHeader, rise: f32, distance: f32) -> f32 {
    let w = distance * (rise + distance * h.bend);
    let p = sqrt(h.height + h.haze);
    let q = sqrt(max(h.height + h.haze + w, 0.5 * h.haze));
    let turn = distance / (p + q);
    return turn / (p * q * (1.0 - h.bend * turn * turn));
}

fn aerial_node(h: AerialHeader, ray: AerialRay, node: u32) -> AerialNode {
    let cell = ray.cell + node * ray.cells;
    let depths = (h.distances + 3u) * ray.cells;
    return AerialNode(
        spline_surface(cell, ray.columns, ray.row, ray.column),
        spline_surface(cell + depths, ray.columns, ray.row, ray.column),
    );
}

fn aerial_taps(h: AerialHeader, ray: AerialRay, distance: f32) -> Taps {
    let measure = aerial_measure(h, ray.way.rise, clamp(distance, 0.0, ray.way.end));
    let share = min(log2(1.0 + measure * ray.way.rate) * h.per_stretch, 1.0);
    return spline_taps(share * f32(h.distances), h.distances);
}

fn aerial_blend(h: AerialHeader, ray: AerialRay, nodes: array<AerialNode, 4>, weight: vec4<f32>, distance: f32) -> Aerial {
    let way = min(distance, ray.way.end);
    let light = nodes[0].light * weight.x + nodes[1].light * weight.y
        + nodes[2].light * weight.z + nodes[3].light * weight.w;
    let depth = nodes[0].depth * weight.x + nodes[1].depth * weight.y
        + nodes[2].depth * weight.z + nodes[3].depth * weight.w;
    let whole = way * max(depth.xyz, vec3<f32>());
    let seen = Aerial(exp2((light + ray.envelope).xyz) * way, exp2(-whole));
    if ray.way.grounded && distance > way {
        return aerial_below(seen, whole, distance / way);
    }
    return seen;
}

// Below the ground, as of a valley beside it: more of the same air, so many times as far.
fn aerial_below(seen: Aerial, depth: vec3<f32>, times: f32) -> Aerial {
    let factors = exp2(-depth * times);
    let more = (1.0 - factors) / max(1.0 - seen.factors, vec3<f32>(1e-6));
    return Aerial(seen.light * select(more, vec3<f32>(times), depth < vec3<f32>(1e-3)), factors);
}

// A single point.
fn aerial_at(h: AerialHeader, first: u32, d: vec3<f32>, distance: f32) -> Aerial {
    let ray = aerial_ray(h, first, d);
    let taps = aerial_taps(h, ray, distance);
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
