// Looks many directions on a disc up: X, Y, Z, then the spectral radiance by groups, `[direction][1 + groups]`.

// Where tables begin, in elements of four: x.
@group(1) @binding(0) var<uniform> place: vec4<u32>;
@group(1) @binding(1) var<uniform> disc: DiscHeader;
@group(1) @binding(2) var<storage, read> directions: array<vec4<f32>>;
@group(1) @binding(3) var<storage, read_write> out: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&directions) {
        return;
    }
    let d = normalize(directions[id.x].xyz);
    let at = id.x * (1u + disc.groups);
    out[at] = vec4<f32>(disc_xyz(disc, place.x, d), 0.0);
    let point = disc_point(disc, d);
    for (var group = 0u; group < disc.groups; group++) {
        out[at + 1u + group] = disc_group(disc, place.x, point, group);
    }
}
