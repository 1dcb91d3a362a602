#version 450 core
#extension GL_ARB_compute_shader : require
#extension GL_ARB_shader_storage_buffer_object : require
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;

struct Taps {
    uint first;
    vec4 weight;
};
struct SkyHeader {
    vec3 sun;
    float horizon;
    vec2 azimuth;
    vec2 shrink;
    vec2 crowding;
    float pole;
    float opaque_length;
    uvec3 intervals;
    uint sun_intervals;
    uint groups;
    uint channels;
    uint polarised;
    uint layout_version;
};
struct SkyPoint {
    uint cell;
    uint columns;
    uint cells;
    Taps angle;
    vec4 row;
    vec4 column;
    float opacity;
    float sine;
};
struct DiscHeader {
    vec3 centre;
    float chord;
    vec3 up;
    float floor_;
    vec3 left;
    float area;
    vec2 lowest;
    float nodes_per_radian;
    float mean;
    uint nodes;
    uint groups;
    uint wavelengths;
    uint visible;
    uint cut;
    float margin;
    uint unused;
    uint layout_version;
};
struct DiscPoint {
    bool seen;
    uint node;
    vec4 weight;
    float mu;
};
const float WELKIN_PI = 3.1415927;

layout(std430, binding = 0) readonly buffer type_2_block_0Compute { vec4 _group_0_binding_0_cs[]; };

layout(std140, binding = 1) uniform type_9_block_1Compute { uvec4 _group_1_binding_0_cs; };

layout(std140, binding = 2) uniform SkyHeader_block_2Compute { SkyHeader _group_1_binding_1_cs; };

layout(std140, binding = 3) uniform DiscHeader_block_3Compute { DiscHeader _group_1_binding_2_cs; };

layout(std430, binding = 4) buffer type_2_block_4Compute { vec4 _group_1_binding_3_cs[]; };


Taps spline_taps(float u, uint intervals) {
    float cell = clamp(floor(u), 0.0, (float(intervals) - 1.0));
    float t = (u - cell);
    float s = (1.0 - t);
    vec2 inner = (vec2(((t * t) * ((t * 3.0) - 6.0)), ((s * s) * ((s * 3.0) - 6.0))) + vec2(4.0));
    vec4 weight_1 = (vec4(((s * s) * s), inner.x, inner.y, ((t * t) * t)) * 0.16666667);
    return Taps(uint(cell), weight_1);
}

vec4 spline_line(uint first, vec4 weight) {
    vec4 _e4 = _group_0_binding_0_cs[first];
    vec4 _e11 = _group_0_binding_0_cs[(first + 1u)];
    vec4 _e19 = _group_0_binding_0_cs[(first + 2u)];
    vec4 _e26 = _group_0_binding_0_cs[(first + 3u)];
    return (((_e4 * weight.x) + (_e11 * weight.y)) + ((_e19 * weight.z) + (_e26 * weight.w)));
}

vec4 spline_surface(uint first_1, uint stride, vec4 rows, vec4 columns) {
    vec4 _e4 = spline_line(first_1, columns);
    vec4 _e8 = spline_line((first_1 + stride), columns);
    vec4 _e15 = spline_line((first_1 + (2u * stride)), columns);
    vec4 _e22 = spline_line((first_1 + (3u * stride)), columns);
    return ((((_e4 * rows.x) + (_e8 * rows.y)) + (_e15 * rows.z)) + (_e22 * rows.w));
}

vec2 quarter_turn(float x) {
    float t_1 = (x - 0.7853982);
    float s_1 = (t_1 * t_1);
    float sine = (t_1 * (1.0 - (s_1 * (0.16666667 - (s_1 * (0.008333334 - (s_1 * (0.0001984127 - (s_1 / 362880.0)))))))));
    float cosine_1 = (1.0 - (s_1 * (0.5 - (s_1 * (0.041666668 - (s_1 * (0.0013888889 - (s_1 / 40320.0))))))));
    return (vec2((cosine_1 - sine), (cosine_1 + sine)) * 0.70710677);
}

vec2 half_turn(float x_1) {
    vec2 _e3 = quarter_turn((0.5 * x_1));
    return vec2(((_e3.x - _e3.y) * (_e3.x + _e3.y)), ((2.0 * _e3.x) * _e3.y));
}

uint side_of(float z, float horizon) {
    return ((z >= horizon) ? 0u : 1u);
}

float pole_cosine(float z_1, uint side, vec2 shrink) {
    float sign_ = (1.0 - (2.0 * float(side)));
    return sqrt(clamp(((1.0 - (sign_ * z_1)) * shrink[side]), 0.0, 1.0));
}

float row_of(float z_2, float horizon_1, uint side_1, vec2 shrink_1, vec2 crowding, float pole) {
    float sine_1 = sqrt(min((abs((z_2 - horizon_1)) * shrink_1[side_1]), 1.0));
    float _e13 = pole_cosine(z_2, side_1, shrink_1);
    float c = crowding[side_1];
    return (((c * sine_1) + sine_1) / ((c * sine_1) + ((_e13 * pole) + 1.0)));
}

vec2 azimuth_of(vec2 d) {
    float square = dot(d, d);
    if ((square < 1e-37)) {
        return vec2(1.0, 0.0);
    }
    return (d / vec2(sqrt(square)));
}

float half_sine(float cosine) {
    return sqrt(clamp((0.5 - (0.5 * cosine)), 0.0, 1.0));
}

float half_chord(vec3 a, vec3 b) {
    vec3 way = (a - b);
    return min((0.5 * sqrt(dot(way, way))), 1.0);
}

vec3 linear_srgb(vec3 xyz) {
    return vec3(dot(xyz, vec3(3.24097, -1.5373832, -0.49861076)), dot(xyz, vec3(-0.96924365, 1.8759675, 0.04155506)), dot(xyz, vec3(0.05563008, -0.20397696, 1.0569715)));
}

float sky_opacity(SkyHeader h, float z_3, uint side_2) {
    float root = (sqrt(max(((z_3 + h.horizon) * (z_3 - h.horizon)), 0.0)) + abs(z_3));
    return ((side_2 == 0u) ? 1.0 : (h.opaque_length / (h.opaque_length + max(root, 1e-20))));
}

SkyPoint sky_point(SkyHeader h_1, vec3 d_1) {
    SkyPoint point = SkyPoint(0u, 0u, 0u, Taps(0u, vec4(0.0)), vec4(0.0), vec4(0.0), 0.0, 0.0);
    uint _e4 = side_of(d_1.z, h_1.horizon);
    vec2 turned = vec2(dot(d_1.xy, h_1.azimuth), ((d_1.y * h_1.azimuth.x) - (d_1.x * h_1.azimuth.y)));
    vec2 _e18 = azimuth_of(turned);
    float _e24 = row_of(d_1.z, h_1.horizon, _e4, h_1.shrink, h_1.crowding, h_1.pole);
    Taps _e31 = spline_taps((_e24 * float(h_1.intervals[_e4])), h_1.intervals[_e4]);
    float _e33 = half_sine(_e18.x);
    Taps _e40 = spline_taps((_e33 * float(h_1.intervals.z)), h_1.intervals.z);
    uint columns_1 = (h_1.intervals.z + 3u);
    point.cell = (((_e31.first + (_e4 * (h_1.intervals.x + 3u))) * columns_1) + _e40.first);
    point.columns = columns_1;
    point.cells = (((h_1.intervals.x + h_1.intervals.y) + 6u) * columns_1);
    float _e69 = half_chord(d_1, h_1.sun);
    Taps _e74 = spline_taps((_e69 * float(h_1.sun_intervals)), h_1.sun_intervals);
    point.angle = _e74;
    point.row = _e31.weight;
    point.column = _e40.weight;
    float _e81 = sky_opacity(h_1, d_1.z, _e4);
    point.opacity = _e81;
    point.sine = _e18.y;
    SkyPoint _e84 = point;
    return _e84;
}

uint sky_scale(SkyHeader h_2, uint first_2, SkyPoint point_1) {
    return (first_2 + (h_2.groups * ((h_2.sun_intervals + 3u) + (point_1.cells * (1u + (2u * h_2.polarised))))));
}

vec4 sky_group(SkyHeader h_3, uint first_3, SkyPoint point_2, uint group) {
    uint envelope = (h_3.sun_intervals + 3u);
    uint cells = ((first_3 + (h_3.groups * envelope)) + (group * point_2.cells));
    vec4 _e20 = spline_line(((first_3 + (group * envelope)) + point_2.angle.first), point_2.angle.weight);
    vec4 _e26 = spline_surface((cells + point_2.cell), point_2.columns, point_2.row, point_2.column);
    vec4 logarithm = (_e20 + _e26);
    uint _e32 = sky_scale(h_3, first_3, point_2);
    vec4 _e35 = _group_0_binding_0_cs[(_e32 + group)];
    return ((exp2(logarithm) * point_2.opacity) * _e35);
}

vec4[2] sky_polarisation(SkyHeader h_4, uint first_4, SkyPoint point_3, uint group_1) {
    uint q = (((first_4 + (h_4.groups * ((h_4.sun_intervals + 3u) + point_3.cells))) + ((2u * group_1) * point_3.cells)) + point_3.cell);
    vec4 _e22 = spline_surface(q, point_3.columns, point_3.row, point_3.column);
    vec4 _e28 = spline_surface((q + point_3.cells), point_3.columns, point_3.row, point_3.column);
    vec4 other = (_e28 * point_3.sine);
    vec4 shrink_2 = inversesqrt(max(((_e22 * _e22) + (other * other)), vec4(1.0)));
    return vec4[2]((_e22 * shrink_2), (other * shrink_2));
}

vec3 sky_xyz(SkyHeader h_5, uint first_5, vec3 d_2) {
    SkyPoint _e3 = sky_point(h_5, d_2);
    vec4 _e5 = sky_group(h_5, first_5, _e3, 0u);
    return _e5.xyz;
}

float disc_square(DiscHeader h_6, vec3 d_3) {
    vec3 way_1 = ((d_3 - h_6.centre) / vec3(h_6.chord));
    return dot(way_1, way_1);
}

vec4 disc_weights(float u_1) {
    float b_1 = (u_1 - 1.0);
    float c_1 = (u_1 - 2.0);
    float d_6 = (u_1 - 3.0);
    return vec4((((b_1 * c_1) * d_6) * -0.16666667), (((u_1 * c_1) * d_6) * 0.5), (((u_1 * b_1) * d_6) * -0.5), (((u_1 * b_1) * c_1) * 0.16666667));
}

DiscPoint disc_point(DiscHeader h_7, vec3 d_4) {
    DiscPoint point_4 = DiscPoint(false, 0u, vec4(0.0), 0.0);
    bool local_1 = false;
    bool local_2 = false;
    float _e3 = disc_square(h_7, d_4);
    if (!((h_7.visible == 0u))) {
        local_1 = (_e3 > 1.0);
    } else {
        local_1 = true;
    }
    bool _e13 = local_1;
    if (_e13) {
        DiscPoint _e14 = point_4;
        return _e14;
    }
    float sine_2 = ((d_4.z * h_7.lowest.x) - (length(d_4.xy) * h_7.lowest.y));
    float elevation = (sine_2 + (((sine_2 * sine_2) * sine_2) * 0.16666667));
    float u_2 = clamp((elevation * h_7.nodes_per_radian), 0.0, float((h_7.nodes - 1u)));
    if (!((h_7.cut == 0u))) {
        local_2 = (sine_2 >= 0.0);
    } else {
        local_2 = true;
    }
    bool _e48 = local_2;
    point_4.seen = _e48;
    point_4.node = (uint(clamp(u_2, 1.0, float((h_7.nodes - 3u)))) - 1u);
    uint _e61 = point_4.node;
    vec4 _e64 = disc_weights((u_2 - float(_e61)));
    point_4.weight = _e64;
    point_4.mu = sqrt((1.0 - _e3));
    DiscPoint _e69 = point_4;
    return _e69;
}

vec4 disc_relative(DiscHeader h_8, uint first_6, DiscPoint point_5, uint group_2) {
    vec4 depth = vec4(0.0);
    uint k = 0u;
    vec4 limb = vec4(0.0);
    uint i = 5u;
    if (!(point_5.seen)) {
        return vec4(0.0);
    }
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e31 = k;
            k = (_e31 + 1u);
        }
        loop_init = false;
        uint _e11 = k;
        if ((_e11 < 4u)) {
        } else {
            break;
        }
        {
            vec4 _e14 = depth;
            uint _e16 = k;
            uint _e20 = k;
            vec4 _e27 = _group_0_binding_0_cs[((first_6 + ((point_5.node + _e20) * h_8.groups)) + group_2)];
            depth = (_e14 + (point_5.weight[_e16] * _e27));
        }
    }
    uint profile = ((first_6 + (h_8.nodes * h_8.groups)) + (6u * group_2));
    vec4 _e44 = _group_0_binding_0_cs[(profile + 5u)];
    limb = _e44;
    bool loop_init_1 = true;
    while(true) {
        if (!loop_init_1) {
            uint _e63 = i;
            i = (_e63 - 1u);
        }
        loop_init_1 = false;
        uint _e48 = i;
        if ((_e48 > 0u)) {
        } else {
            break;
        }
        {
            vec4 _e51 = limb;
            uint _e55 = i;
            vec4 _e60 = _group_0_binding_0_cs[((profile + _e55) - 1u)];
            limb = ((_e51 * point_5.mu) + _e60);
        }
    }
    vec4 _e65 = depth;
    vec4 _e72 = limb;
    return ((exp(-(max(_e65, vec4(0.0)))) * h_8.mean) * _e72);
}

uint disc_weight(DiscHeader h_9, uint first_7, uint group_3) {
    return ((first_7 + ((h_9.nodes + 6u) * h_9.groups)) + (4u * group_3));
}

vec4 disc_group(DiscHeader h_10, uint first_8, DiscPoint point_6, uint group_4) {
    vec4 _e4 = disc_relative(h_10, first_8, point_6, group_4);
    uint _e6 = disc_weight(h_10, first_8, group_4);
    vec4 _e10 = _group_0_binding_0_cs[(_e6 + 3u)];
    return (_e4 * _e10);
}

vec3 disc_xyz(DiscHeader h_11, uint first_9, vec3 d_5) {
    vec3 xyz_1 = vec3(0.0);
    uint group_5 = 0u;
    DiscPoint _e3 = disc_point(h_11, d_5);
    if (!(_e3.seen)) {
        vec3 _e8 = xyz_1;
        return _e8;
    }
    bool loop_init_2 = true;
    while(true) {
        if (!loop_init_2) {
            uint _e38 = group_5;
            group_5 = (_e38 + 1u);
        }
        loop_init_2 = false;
        uint _e11 = group_5;
        if ((_e11 < h_11.groups)) {
        } else {
            break;
        }
        {
            uint _e14 = group_5;
            vec4 _e15 = disc_relative(h_11, first_9, _e3, _e14);
            uint _e16 = group_5;
            uint _e17 = disc_weight(h_11, first_9, _e16);
            vec3 _e18 = xyz_1;
            vec4 _e21 = _group_0_binding_0_cs[_e17];
            vec4 _e27 = _group_0_binding_0_cs[(_e17 + 1u)];
            vec4 _e33 = _group_0_binding_0_cs[(_e17 + 2u)];
            xyz_1 = (_e18 + vec3(dot(_e15, _e21), dot(_e15, _e27), dot(_e15, _e33)));
        }
    }
    vec3 _e40 = xyz_1;
    return _e40;
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    bool local = false;
    uint _e4 = _group_1_binding_0_cs.z;
    if (!((id.x >= _e4))) {
        uint _e12 = _group_1_binding_0_cs.z;
        local = (id.y >= _e12);
    } else {
        local = true;
    }
    bool _e15 = local;
    if (_e15) {
        return;
    }
    uint _e23 = _group_1_binding_0_cs.z;
    vec2 spot = (((vec2(id.xy) + vec2(0.5)) * (2.0 / float(_e23))) - vec2(1.0));
    float radius = length(spot);
    if ((radius >= 1.0)) {
        uint _e38 = _group_1_binding_0_cs.z;
        _group_1_binding_3_cs[((id.y * _e38) + id.x)] = vec4(0.0);
        return;
    }
    vec2 _e48 = half_turn(((radius * 0.5) * WELKIN_PI));
    vec2 level = (vec2(-(spot.y), spot.x) * (_e48.y / max(radius, 1e-9)));
    vec3 d_7 = vec3(level, _e48.x);
    SkyHeader _e61 = _group_1_binding_1_cs;
    uint _e64 = _group_1_binding_0_cs.x;
    vec3 _e65 = sky_xyz(_e61, _e64, d_7);
    DiscHeader _e67 = _group_1_binding_2_cs;
    uint _e70 = _group_1_binding_0_cs.y;
    vec3 _e71 = disc_xyz(_e67, _e70, d_7);
    vec3 xyz_2 = (_e65 + _e71);
    uint _e77 = _group_1_binding_0_cs.z;
    vec3 _e82 = linear_srgb(xyz_2);
    _group_1_binding_3_cs[((id.y * _e77) + id.x)] = vec4(_e82, 1.0);
    return;
}

