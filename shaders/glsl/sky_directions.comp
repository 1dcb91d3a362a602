#version 450 core
#extension GL_ARB_compute_shader : require
#extension GL_ARB_shader_storage_buffer_object : require
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;

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
const float WELKIN_PI = 3.1415927;

layout(std430, binding = 0) readonly buffer type_2_block_0Compute { vec4 _group_0_binding_0_cs[]; };

layout(std140, binding = 1) uniform type_8_block_1Compute { uvec4 _group_1_binding_0_cs; };

layout(std140, binding = 2) uniform SkyHeader_block_2Compute { SkyHeader _group_1_binding_1_cs; };

layout(std430, binding = 3) readonly buffer type_2_block_3Compute { vec4 _group_1_binding_2_cs[]; };

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

vec4 sky_group(SkyHeader h_3, uint first_3, SkyPoint point_2, uint group_1) {
    uint envelope = (h_3.sun_intervals + 3u);
    uint cells = ((first_3 + (h_3.groups * envelope)) + (group_1 * point_2.cells));
    vec4 _e20 = spline_line(((first_3 + (group_1 * envelope)) + point_2.angle.first), point_2.angle.weight);
    vec4 _e26 = spline_surface((cells + point_2.cell), point_2.columns, point_2.row, point_2.column);
    vec4 logarithm = (_e20 + _e26);
    uint _e32 = sky_scale(h_3, first_3, point_2);
    vec4 _e35 = _group_0_binding_0_cs[(_e32 + group_1)];
    return ((exp2(logarithm) * point_2.opacity) * _e35);
}

vec4[2] sky_polarisation(SkyHeader h_4, uint first_4, SkyPoint point_3, uint group_2) {
    uint q = (((first_4 + (h_4.groups * ((h_4.sun_intervals + 3u) + point_3.cells))) + ((2u * group_2) * point_3.cells)) + point_3.cell);
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

void main() {
    uvec3 id = gl_GlobalInvocationID;
    uint group = 0u;
    if ((id.x >= uint(_group_1_binding_2_cs.length()))) {
        return;
    }
    SkyHeader _e6 = _group_1_binding_1_cs;
    vec4 _e10 = _group_1_binding_2_cs[id.x];
    SkyPoint _e13 = sky_point(_e6, normalize(_e10.xyz));
    uint _e16 = _group_1_binding_1_cs.groups;
    uint _e21 = _group_1_binding_1_cs.polarised;
    uint stride_1 = (_e16 * (1u + (2u * _e21)));
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e76 = group;
            group = (_e76 + 1u);
        }
        loop_init = false;
        uint _e27 = group;
        uint _e30 = _group_1_binding_1_cs.groups;
        if ((_e27 < _e30)) {
        } else {
            break;
        }
        {
            uint _e34 = group;
            uint _e39 = _group_1_binding_1_cs.polarised;
            uint at = ((id.x * stride_1) + (_e34 * (1u + (2u * _e39))));
            SkyHeader _e47 = _group_1_binding_1_cs;
            uint _e50 = _group_1_binding_0_cs.x;
            uint _e51 = group;
            vec4 _e52 = sky_group(_e47, _e50, _e13, _e51);
            _group_1_binding_3_cs[at] = _e52;
            uint _e55 = _group_1_binding_1_cs.polarised;
            if ((_e55 != 0u)) {
                SkyHeader _e59 = _group_1_binding_1_cs;
                uint _e62 = _group_1_binding_0_cs.x;
                uint _e63 = group;
                vec4 _e64[2] = sky_polarisation(_e59, _e62, _e13, _e63);
                _group_1_binding_3_cs[(at + 1u)] = _e64[0];
                _group_1_binding_3_cs[(at + 2u)] = _e64[1];
            }
        }
    }
    return;
}

