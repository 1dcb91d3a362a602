// Transmittance along straight lines, in closed form layer by layer: `AirBuffers` of the library has the formulae.
// Points are in metres, the origin on the ground, +z up there.

struct AirHeader {
    radius: f32,
    top: f32,
    layers: u32,
    quads: u32,
    groups: u32,
    wavelengths: u32,
    unused: u32,
    layout_version: u32,
}

// Most constituents are four times this.
const AIR_QUADS: u32 = 4u;

// A line by where it starts: w = altitude + altitude² / 2R, and distance from the planet's centre times the cosine of
// the angle from the vertical.
struct AirLine {
    w: f32,
    b: f32,
}

fn air_line(h: AirHeader, start: vec3<f32>, direction: vec3<f32>) -> AirLine {
    let w = start.z + dot(start, start) / (2.0 * h.radius);
    return AirLine(w, dot(start, direction) + h.radius * direction.z);
}

// Where the line is at an edge on its way down, or far away if it never is.
fn air_down(h: AirHeader, line: AirLine, edge: f32) -> f32 {
    let c = max(2.0 * h.radius * (line.w - edge), 0.0);
    let square = line.b * line.b - c;
    return select(1e30, c / (sqrt(max(square, 0.0)) - line.b), line.b < 0.0 && square > 0.0);
}

// Where the line is at an edge on its way up.
fn air_up(h: AirHeader, line: AirLine, edge: f32) -> f32 {
    let c = 2.0 * h.radius * (edge - line.w);
    let root = sqrt(max(line.b * line.b + c, 0.0));
    if line.b > 0.0 {
        return c / (line.b + root);
    }
    return root - line.b;
}

// Length of a ray up to the ground or to the end of the air, and 1 if that is the ground.
fn air_end(h: AirHeader, start: vec3<f32>, direction: vec3<f32>) -> vec2<f32> {
    let line = air_line(h, start, direction);
    let c = 2.0 * h.radius * line.w;
    if line.b < 0.0 && line.b * line.b > c {
        let height = max(c, 0.0);
        return vec2<f32>(height / (sqrt(line.b * line.b - c) - line.b), 1.0);
    }
    let top = h.top + h.top * h.top / (2.0 * h.radius);
    return vec2<f32>(max(air_up(h, line, top), 0.0), 0.0);
}

// Adds what a layer has between two distances.
fn air_piece(h: AirHeader, first: u32, line: AirLine, layer: u32, ends: vec2<f32>, sums: ptr<function, array<vec4<f32>, 4>>) {
    let edges = welkin_table[first + layer];
    let d = ends.y - ends.x;
    let m = 0.5 * (ends.x + ends.y);
    let w = line.w + (m * (m + 2.0 * line.b) + d * d * (1.0 / 12.0)) / (2.0 * h.radius);
    let mean = (w - edges.x) * edges.y;
    let slope = (m + line.b) * edges.z * d;
    let bent = d * d * edges.z;
    let square = mean * mean + slope * slope * (1.0 / 3.0) + bent * bent * (1.0 / 180.0);
    let row = first + h.layers + 3u * layer * h.quads;
    for (var q = 0u; q < h.quads; q++) {
        let density = welkin_table[row + q] + welkin_table[row + h.quads + q] * mean
            + welkin_table[row + 2u * h.quads + q] * square;
        (*sums)[q] += max(density, vec4<f32>()) * d;
    }
}

// Columns of the constituents along a line of some length, m.
fn air_columns(h: AirHeader, first: u32, start: vec3<f32>, direction: vec3<f32>, length: f32) -> array<vec4<f32>, 4> {
    let none = vec4<f32>();
    var sums = array<vec4<f32>, 4>(none, none, none, none);
    let line = air_line(h, start, direction);
    var s = 0.0;
    // From beyond the air: in, if at all.
    let top = welkin_table[first + h.layers - 1u].w;
    if line.w > top {
        s = air_down(h, line, top);
    }
    if s >= length {
        return sums;
    }
    var layer = air_layer(h, first, min(line.w, top));
    while s < length && line.b < 0.0 {
        let edge = air_down(h, line, welkin_table[first + layer].x);
        if edge >= length || layer == 0u {
            break;
        }
        air_piece(h, first, line, layer, vec2<f32>(s, max(edge, s)), &sums);
        s = max(edge, s);
        layer -= 1u;
    }
    while s < length && layer < h.layers {
        let end = max(air_up(h, line, welkin_table[first + layer].w), s);
        air_piece(h, first, line, layer, vec2<f32>(s, min(end, length)), &sums);
        s = end;
        layer += 1u;
    }
    return sums;
}

// The layer that holds w, by bisection.
fn air_layer(h: AirHeader, first: u32, w: f32) -> u32 {
    var low = 0u;
    var high = h.layers;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if welkin_table[first + middle].x <= w {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// Optical depths of four wavelengths.
fn air_depth(h: AirHeader, first: u32, columns: array<vec4<f32>, 4>, group: u32) -> vec4<f32> {
    let extinction = first + h.layers * (1u + 3u * h.quads) + group;
    var sums = columns;
    var depth = vec4<f32>();
    for (var k = 0u; k < 4u * h.quads; k++) {
        depth += welkin_table[extinction + k * h.groups] * sums[k / 4u][k % 4u];
    }
    return depth;
}
