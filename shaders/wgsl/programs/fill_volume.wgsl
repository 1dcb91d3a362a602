// Fills a camera-aligned volume ("froxels"), a ray for each invocation: `[row][column][slice]`, in linear sRGB.

// As `CameraVolume` of the library.
struct Volume {
    axis: vec3<f32>,
    columns: u32,
    right: vec3<f32>,
    rows: u32,
    up: vec3<f32>,
    slices: u32,
}

// Where tables begin, in elements of four: x.
@group(1) @binding(0) var<uniform> place: vec4<u32>;
@group(1) @binding(1) var<uniform> aerial: AerialHeader;
@group(1) @binding(2) var<uniform> volume: Volume;
// Where slices end, growing, in lengths of the axis.
@group(1) @binding(3) var<storage, read> depths: array<f32>;
@group(1) @binding(4) var<storage, read_write> light: array<vec4<f32>>;
@group(1) @binding(5) var<storage, read_write> factors: array<vec4<f32>>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= volume.columns || id.y >= volume.rows {
        return;
    }
    let x = f32(2u * id.x + 1u) / f32(volume.columns) - 1.0;
    let y = 1.0 - f32(2u * id.y + 1u) / f32(volume.rows);
    let way = volume.axis + x * volume.right + y * volume.up;
    let stretch = length(way);
    let ray = aerial_ray(aerial, place.x, way / stretch);
    var nodes: array<AerialNode, 4>;
    // The node after the last one that was looked up.
    var next = 0u;
    for (var slice = 0u; slice < volume.slices; slice++) {
        let distance = depths[slice] * stretch;
        let taps = aerial_taps(aerial, ray, distance);
        next = max(next, taps.first);
        while next < taps.first + 4u {
            nodes[0] = nodes[1];
            nodes[1] = nodes[2];
            nodes[2] = nodes[3];
            nodes[3] = aerial_node(aerial, ray, next);
            next++;
        }
        let seen = aerial_blend(aerial, ray, nodes, taps.weight, distance);
        let at = (id.y * volume.columns + id.x) * volume.slices + slice;
        light[at] = vec4<f32>(linear_srgb(seen.light), 0.0);
        factors[at] = vec4<f32>(aerial_srgb_factors(aerial, seen.factors), 0.0);
    }
}
