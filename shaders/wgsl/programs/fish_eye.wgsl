// A picture of the whole upper sky with the disc, equidistant around the zenith, in linear sRGB: `[row][column]`, +x at the top
// and +y on the right, as it is seen from below.

// Where tables begin, in elements of four: the sky and the disc; then rows and columns of the picture.
@group(1) @binding(0) var<uniform> place: vec4<u32>;
@group(1) @binding(1) var<uniform> sky: SkyHeader;
@group(1) @binding(2) var<uniform> disc: DiscHeader;
@group(1) @binding(3) var<storage, read_write> out: array<vec4<f32>>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= place.z || id.y >= place.z {
        return;
    }
    let spot = (vec2<f32>(id.xy) + 0.5) * (2.0 / f32(place.z)) - 1.0;
    let radius = length(spot);
    if radius >= 1.0 {
        out[id.y * place.z + id.x] = vec4<f32>();
        return;
    }
    let turn = half_turn(radius * 0.5 * WELKIN_PI);
    let level = vec2<f32>(-spot.y, spot.x) * (turn.y / max(radius, 1e-9));
    let d = vec3<f32>(level, turn.x);
    let xyz = sky_xyz(sky, place.x, d) + disc_xyz(disc, place.y, d);
    out[id.y * place.z + id.x] = vec4<f32>(linear_srgb(xyz), 1.0);
}
