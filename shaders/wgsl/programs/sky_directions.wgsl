// Looks many directions of a baked sky up: `[direction][group]`, and where it is polarised then Q/I and U/I of each
// group.

// Where tables begin, in elements of four: x.
@group(1) @binding(0) var<uniform> place: vec4<u32>;
@group(1) @binding(1) var<uniform> sky: SkyHeader;
@group(1) @binding(2) var<storage, read> directions: array<vec4<f32>>;
@group(1) @binding(3) var<storage, read_write> out: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&directions) {
        return;
    }
    let point = sky_point(sky, normalize(directions[id.x].xyz));
    let stride = sky.groups * (1u + 2u * sky.polarised);
    for (var group = 0u; group < sky.groups; group++) {
        let at = id.x * stride + group * (1u + 2u * sky.polarised);
        out[at] = sky_group(sky, place.x, point, group);
        if sky.polarised != 0u {
            let ratios = sky_polarisation(sky, place.x, point, group);
            out[at + 1u] = ratios[0];
            out[at + 2u] = ratios[1];
        }
    }
}
