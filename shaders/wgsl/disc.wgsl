// The disc of the sun, or of the moon: `DiscBuffers` of the library has the formulae.

struct DiscHeader {
    centre: vec3<f32>,
    chord: f32,
    up: vec3<f32>,
    floor: f32,
    left: vec3<f32>,
    area: f32,
    lowest: vec2<f32>,
    nodes_per_radian: f32,
    mean: f32,
    nodes: u32,
    groups: u32,
    wavelengths: u32,
    visible: u32,
    cut: u32,
    margin: f32,
    unused: u32,
    layout_version: u32,
}

// A direction, looked up.
struct DiscPoint {
    seen: bool,
    node: u32,
    weight: vec4<f32>,
    // Cosine of the angle from the vertical of the surface that is seen.
    mu: f32,
}

fn disc_square(h: DiscHeader, d: vec3<f32>) -> f32 {
    let way = (d - h.centre) / h.chord;
    return dot(way, way);
}

// `d` is a unit vector.
fn disc_point(h: DiscHeader, d: vec3<f32>) -> DiscPoint {
    var point: DiscPoint;
    let square = disc_square(h, d);
    if h.visible == 0u || square > 1.0 {
        return point;
    }
    let sine = d.z * h.lowest.x - length(d.xy) * h.lowest.y;
    let elevation = sine + sine * sine * sine * (1.0 / 6.0);
    let u = clamp(elevation * h.nodes_per_radian, 0.0, f32(h.nodes - 1u));
    point.seen = h.cut == 0u || sine >= 0.0;
    point.node = u32(clamp(u, 1.0, f32(h.nodes - 3u))) - 1u;
    point.weight = disc_weights(u - f32(point.node));
    point.mu = sqrt(1.0 - square);
    return point;
}

// Lagrange's, of the nodes 0 to 3.
fn disc_weights(u: f32) -> vec4<f32> {
    let a = u;
    let b = u - 1.0;
    let c = u - 2.0;
    let d = u - 3.0;
    return vec4<f32>(b * c * d * (-1.0 / 6.0), a * c * d * 0.5, a * b * d * -0.5, a * b * c * (1.0 / 6.0));
}

// Radiance over the irradiance outside the air, sr⁻¹, of four wavelengths; 0 where the disc is not seen.
fn disc_relative(h: DiscHeader, first: u32, point: DiscPoint, group: u32) -> vec4<f32> {
    if !point.seen {
        return vec4<f32>();
    }
    var depth = vec4<f32>();
    for (var k = 0u; k < 4u; k++) {
        depth += point.weight[k] * welkin_table[first + (point.node + k) * h.groups + group];
    }
    let profile = first + h.nodes * h.groups + 6u * group;
    var limb = welkin_table[profile + 5u];
    for (var i = 5u; i > 0u; i--) {
        limb = limb * point.mu + welkin_table[profile + i - 1u];
    }
    return exp(-max(depth, vec4<f32>())) * h.mean * limb;
}

fn disc_weight(h: DiscHeader, first: u32, group: u32) -> u32 {
    return first + (h.nodes + 6u) * h.groups + 4u * group;
}

// Spectral radiance of four wavelengths, W m⁻² sr⁻¹ nm⁻¹.
fn disc_group(h: DiscHeader, first: u32, point: DiscPoint, group: u32) -> vec4<f32> {
    return disc_relative(h, first, point, group) * welkin_table[disc_weight(h, first, group) + 3u];
}

// CIE XYZ, Y in cd m⁻².
fn disc_xyz(h: DiscHeader, first: u32, d: vec3<f32>) -> vec3<f32> {
    let point = disc_point(h, d);
    var xyz = vec3<f32>();
    if !point.seen {
        return xyz;
    }
    for (var group = 0u; group < h.groups; group++) {
        let relative = disc_relative(h, first, point, group);
        let weight = disc_weight(h, first, group);
        xyz += vec3<f32>(
            dot(relative, welkin_table[weight]),
            dot(relative, welkin_table[weight + 1u]),
            dot(relative, welkin_table[weight + 2u]),
        );
    }
    return xyz;
}
