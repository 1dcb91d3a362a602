// Draws directions: `[draw][2]`, direction and density, then the density that is looked up for the direction given
// beside the numbers, and whether the draw was the disc's.

struct Request {
    numbers: vec2<f32>,
    unused: vec2<f32>,
    direction: vec4<f32>,
}

// Where tables begin, in elements of four: x.
@group(1) @binding(0) var<uniform> place: vec4<u32>;
@group(1) @binding(1) var<uniform> sampler_header: SamplerHeader;
@group(1) @binding(2) var<uniform> disc: DiscHeader;
@group(1) @binding(3) var<storage, read> requests: array<Request>;
@group(1) @binding(4) var<storage, read_write> out: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&requests) {
        return;
    }
    let draw = sampler_draw(sampler_header, place.x, disc, requests[id.x].numbers);
    let d = normalize(requests[id.x].direction.xyz);
    out[2u * id.x] = vec4<f32>(draw.direction, draw.pdf);
    out[2u * id.x + 1u] = vec4<f32>(sampler_pdf(sampler_header, place.x, disc, d), select(0.0, 1.0, draw.disc), 0.0, 0.0);
}
