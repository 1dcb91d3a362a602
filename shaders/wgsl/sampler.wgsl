// Directions drawn in proportion to the luminance of the sky and the disc: `SamplerBuffers` of the library.

struct SamplerHeader {
    azimuth: vec2<f32>,
    shrink: vec2<f32>,
    horizon: f32,
    share: f32,
    rows: vec2<u32>,
    columns: u32,
    unused_a: u32,
    unused_b: u32,
    layout_version: u32,
}

struct SkyDraw {
    direction: vec3<f32>,
    // Density per solid angle, sr⁻¹, of sky and disc together.
    pdf: f32,
    // Whether it was drawn for the disc.
    disc: bool,
}

// Edges that hold a number, and what is left of that.
struct Drawn {
    index: u32,
    rest: f32,
}

// Single numbers from `first`, an element of four, on.
fn sampler_number(first: u32, i: u32) -> f32 {
    return welkin_table[first + i / 4u][i % 4u];
}

fn into_unit(x: f32) -> f32 {
    return clamp(x, 0.0, 0.99999994);
}

// The interval of `count` that holds `x`, by bisection of its `count + 1` edges.
fn sampler_find(first: u32, edges: u32, count: u32, x: f32) -> Drawn {
    var low = 0u;
    var high = count;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if sampler_number(first, edges + middle) <= x {
            low = middle;
        } else {
            high = middle;
        }
    }
    let start = sampler_number(first, edges + low);
    let width = sampler_number(first, edges + low + 1u) - start;
    return Drawn(low, select(0.5, (x - start) / width, width > 0.0));
}

fn sampler_mix(first: u32, edge: u32, t: f32) -> f32 {
    let start = sampler_number(first, edge);
    return start + t * (sampler_number(first, edge + 1u) - start);
}

// A direction of the sky alone for two numbers in 0..1.
fn sampler_sky(h: SamplerHeader, first: u32, numbers: vec2<f32>) -> vec3<f32> {
    let rows = h.rows.x + h.rows.y;
    let azimuths = 2u * rows;
    let row = sampler_find(first, azimuths + h.columns + 1u, rows, numbers.x);
    // Left and right of the sun are alike.
    let right = numbers.y >= 0.5;
    let y = into_unit(select(2.0 * numbers.y, 2.0 * numbers.y - 1.0, right));
    let columns = azimuths + h.columns + 1u + rows + 1u;
    let column = sampler_find(first, columns + row.index * (h.columns + 1u), h.columns, y);
    let z = sampler_mix(first, 2u * row.index, row.rest);
    let turn = half_turn(sampler_mix(first, azimuths + column.index, column.rest));
    let level = sqrt(max(1.0 - z * z, 0.0)) * vec2<f32>(turn.x, select(turn.y, -turn.y, right));
    return vec3<f32>(
        level.x * h.azimuth.x - level.y * h.azimuth.y,
        level.x * h.azimuth.y + level.y * h.azimuth.x,
        z,
    );
}

// The density of draws at a unit vector, sr⁻¹.
fn sampler_pdf(h: SamplerHeader, first: u32, disc: DiscHeader, d: vec3<f32>) -> f32 {
    let side = side_of(d.z, h.horizon);
    let height = sqrt(1.0 - pole_cosine(d.z, side, h.shrink));
    let row = min(u32(height * f32(h.rows[side])), h.rows[side] - 1u) + side * h.rows.x;
    let turned = vec2<f32>(dot(d.xy, h.azimuth), d.y * h.azimuth.x - d.x * h.azimuth.y);
    let half = half_sine(azimuth_of(turned).x);
    let column = min(u32(half * f32(h.columns)), h.columns - 1u);
    let rows = h.rows.x + h.rows.y;
    let density = 2u * rows + h.columns + 1u + rows + 1u + rows * (h.columns + 1u);
    let sky = sampler_number(first, density + row * h.columns + column);
    if h.share <= 0.0 {
        return sky;
    }
    return (1.0 - h.share) * sky + h.share * disc_density(disc, d);
}

// Draws sky and disc as often as their shares of the luminous flux are.
fn sampler_draw(h: SamplerHeader, first: u32, disc: DiscHeader, numbers: vec2<f32>) -> SkyDraw {
    var draw: SkyDraw;
    var x = into_unit(numbers.x);
    let y = into_unit(numbers.y);
    draw.disc = x < h.share;
    if draw.disc {
        draw.direction = disc_draw(disc, vec2<f32>(x / h.share, y));
    } else {
        x = into_unit((x - h.share) / (1.0 - h.share));
        draw.direction = sampler_sky(h, first, vec2<f32>(x, y));
    }
    draw.pdf = sampler_pdf(h, first, disc, draw.direction);
    return draw;
}
