// Transmittance of segments, and from their starts through all of the air: `[segment][2][groups]`, the second 0 where
// the ground is in the way.

struct Segment {
    start: vec4<f32>,
    end: vec4<f32>,
}

// Where tables begin, in elements of four: x.
@group(1) @binding(0) var<uniform> place: vec4<u32>;
@group(1) @binding(1) var<uniform> air: AirHeader;
@group(1) @binding(2) var<storage, read> segments: array<Segment>;
@group(1) @binding(3) var<storage, read_write> out: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&segments) {
        return;
    }
    let start = segments[id.x].start.xyz;
    let way = segments[id.x].end.xyz - start;
    let distance = length(way);
    let direction = select(vec3<f32>(0.0, 0.0, 1.0), way / distance, distance > 0.0);
    let end = air_end(air, start, direction);
    let near = air_columns(air, place.x, start, direction, distance);
    let whole = air_columns(air, place.x, start, direction, end.x);
    for (var group = 0u; group < air.groups; group++) {
        let at = 2u * id.x * air.groups + group;
        out[at] = exp(-air_depth(air, place.x, near, group));
        out[at + air.groups] = exp(-air_depth(air, place.x, whole, group)) * (1.0 - end.y);
    }
}
