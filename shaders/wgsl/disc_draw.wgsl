// Directions on the disc, evenly in solid angle.

// The angle at which a chord cuts a segment of this area, 0 ≤ area ≤ π, off the unit disc.
fn segment_angle(area: f32) -> f32 {
    let bounded = clamp(area, 0.0, WELKIN_PI);
    let small = min(bounded, WELKIN_PI - bounded);
    // e − sin e = 2 · area: its series, refined by Newton's rule where that has no cancellation.
    let s = select(pow(12.0 * small, 1.0 / 3.0), 0.0, small < 1e-30);
    let q = s * s;
    let series = 1.0 / 1400.0 + q * (1.0 / 25200.0 + q * (43.0 / 17248000.0));
    var e = s * (1.0 + q * (1.0 / 60.0 + q * series));
    if e > 0.5 {
        for (var i = 0; i < 2; i++) {
            let turn = half_turn(min(e, WELKIN_PI));
            e -= (e - turn.y - 2.0 * small) / (1.0 - turn.x);
        }
    }
    return select(0.5 * e, WELKIN_PI - 0.5 * e, bounded > small);
}

// Maps the unit square to the visible part of the disc: upright, then across.
fn disc_draw(h: DiscHeader, numbers: vec2<f32>) -> vec3<f32> {
    let turn = half_turn(segment_angle((1.0 - numbers.x) * h.area));
    var place = vec2<f32>((2.0 * numbers.y - 1.0) * turn.y, turn.x);
    let radius = length(place);
    place *= select(1.0, (1.0 - h.margin) / radius, radius > 1.0 - h.margin);
    let square = h.chord * h.chord * dot(place, place);
    place *= h.chord * sqrt(max(1.0 - 0.25 * square, 0.0));
    return h.centre * (1.0 - 0.5 * square) + h.left * place.x + h.up * place.y;
}

// The density of that, sr⁻¹.
fn disc_density(h: DiscHeader, d: vec3<f32>) -> f32 {
    let reach = 1.0 + h.margin;
    let height = dot(d - h.centre, h.up);
    let covered = h.visible != 0u && disc_square(h, d) <= reach * reach
        && height >= (h.floor - 2.0 * h.margin) * h.chord;
    return select(0.0, 1.0 / (h.area * h.chord * h.chord), covered);
}
