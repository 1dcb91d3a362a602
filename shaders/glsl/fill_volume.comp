#version 450 core
#extension GL_ARB_compute_shader : require
#extension GL_ARB_shader_storage_buffer_object : require
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;

struct Taps {
    uint first;
    vec4 weight;
};
struct AerialHeader {
    vec3 sun;
    float horizon;
    vec3 up;
    float height;
    vec3 forward;
    float top;
    vec3 left;
    float bend;
    vec3 white;
    float pole;
    vec2 shrink;
    vec2 crowding;
    uvec3 intervals;
    uint sun_intervals;
    uint distances;
    float steepness;
    float haze;
    float nearness;
    float per_stretch;
    uint unused_a;
    uint unused_b;
    uint layout_version;
};
struct AerialWay {
    float rise;
    float end;
    float rate;
    bool grounded;
};
struct AerialRay {
    uint cell;
    uint columns;
    uint cells;
    vec4 row;
    vec4 column;
    vec4 envelope;
    AerialWay way;
};
struct AerialNode {
    vec4 light;
    vec4 depth;
};
struct Aerial {
    vec3 light;
    vec3 factors;
};
struct Volume {
    vec3 axis;
    uint columns;
    vec3 right;
    uint rows;
    vec3 up;
    uint slices;
};
const float WELKIN_PI = 3.1415927;
const float AERIAL_BEYOND = 20.0;

layout(std430, binding = 0) readonly buffer type_2_block_0Compute { vec4 _group_0_binding_0_cs[]; };

layout(std140, binding = 1) uniform type_9_block_1Compute { uvec4 _group_1_binding_0_cs; };

layout(std140, binding = 2) uniform AerialHeader_block_2Compute { AerialHeader _group_1_binding_1_cs; };

layout(std140, binding = 3) uniform Volume_block_3Compute { Volume _group_1_binding_2_cs; };

layout(std430, binding = 4) readonly buffer type_10_block_4Compute { float _group_1_binding_3_cs[]; };

layout(std430, binding = 5) buffer type_2_block_5Compute { vec4 _group_1_binding_4_cs[]; };

layout(std430, binding = 6) buffer type_2_block_6Compute { vec4 _group_1_binding_5_cs[]; };


Taps spline_taps(float u, uint intervals) {
    float cell = clamp(floor(u), 0.0, (float(intervals) - 1.0));
    float t = (u - cell);
    float s = (1.0 - t);
    vec2 inner = (vec2(((t * t) * ((t * 3.0) - 6.0)), ((s * s) * ((s * 3.0) - 6.0))) + vec2(4.0));
    vec4 weight_2 = (vec4(((s * s) * s), inner.x, inner.y, ((t * t) * t)) * 0.16666667);
    return Taps(uint(cell), weight_2);
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
    vec3 way_1 = (a - b);
    return min((0.5 * sqrt(dot(way_1, way_1))), 1.0);
}

vec3 linear_srgb(vec3 xyz) {
    return vec3(dot(xyz, vec3(3.24097, -1.5373832, -0.49861076)), dot(xyz, vec3(-0.96924365, 1.8759675, 0.04155506)), dot(xyz, vec3(0.05563008, -0.20397696, 1.0569715)));
}

float aerial_measure(AerialHeader h, float rise, float distance_) {
    float w = (distance_ * (rise + (distance_ * h.bend)));
    float p = sqrt((h.height + h.haze));
    float q = sqrt(max(((h.height + h.haze) + w), (0.5 * h.haze)));
    float turn = (distance_ / (p + q));
    return (turn / ((p * q) * (1.0 - ((h.bend * turn) * turn))));
}

AerialWay aerial_way(AerialHeader h_1, float z_3, uint side_2) {
    AerialWay way = AerialWay(0.0, 0.0, 0.0, false);
    way.rise = (z_3 * h_1.steepness);
    way.grounded = (side_2 == 1u);
    bool _e11 = way.grounded;
    if (_e11) {
        float root = (sqrt(max(((z_3 - h_1.horizon) * (z_3 + h_1.horizon)), 0.0)) * h_1.steepness);
        float _e27 = way.rise;
        way.end = ((2.0 * h_1.height) / (root - _e27));
    } else {
        float _e31 = way.rise;
        float _e33 = way.rise;
        float root_1 = sqrt(max(((_e31 * _e33) + ((4.0 * h_1.bend) * (h_1.top - h_1.height))), 0.0));
        float _e47 = way.rise;
        if ((_e47 > 0.0)) {
            float _e57 = way.rise;
            way.end = ((2.0 * (h_1.top - h_1.height)) / (root_1 + _e57));
        } else {
            float _e62 = way.rise;
            way.end = ((root_1 - _e62) / (2.0 * h_1.bend));
        }
    }
    float _e70 = way.end;
    way.end = (max(_e70, 0.0) + AERIAL_BEYOND);
    float _e78 = way.rise;
    float _e80 = way.end;
    float _e81 = aerial_measure(h_1, _e78, _e80);
    way.rate = (h_1.nearness / _e81);
    AerialWay _e83 = way;
    return _e83;
}

AerialRay aerial_ray(AerialHeader h_2, uint first_2, vec3 d_1) {
    AerialRay ray = AerialRay(0u, 0u, 0u, vec4(0.0), vec4(0.0), vec4(0.0), AerialWay(0.0, 0.0, 0.0, false));
    float z_4 = clamp(dot(d_1, h_2.up), -1.0, 1.0);
    uint _e9 = side_of(z_4, h_2.horizon);
    vec2 _e15 = azimuth_of(vec2(dot(d_1, h_2.forward), dot(d_1, h_2.left)));
    float _e20 = row_of(z_4, h_2.horizon, _e9, h_2.shrink, h_2.crowding, h_2.pole);
    Taps _e27 = spline_taps((_e20 * float(h_2.intervals[_e9])), h_2.intervals[_e9]);
    float _e29 = half_sine(_e15.x);
    Taps _e36 = spline_taps((_e29 * float(h_2.intervals.z)), h_2.intervals.z);
    float _e38 = half_chord(d_1, h_2.sun);
    Taps _e43 = spline_taps((_e38 * float(h_2.sun_intervals)), h_2.sun_intervals);
    ray.columns = (h_2.intervals.z + 3u);
    uint _e59 = ray.columns;
    ray.cells = (((h_2.intervals.x + h_2.intervals.y) + 6u) * _e59);
    uint _e74 = ray.columns;
    ray.cell = ((((first_2 + h_2.sun_intervals) + 3u) + ((_e27.first + (_e9 * (h_2.intervals.x + 3u))) * _e74)) + _e36.first);
    ray.row = _e27.weight;
    ray.column = _e36.weight;
    vec4 _e87 = spline_line((first_2 + _e43.first), _e43.weight);
    ray.envelope = _e87;
    AerialWay _e89 = aerial_way(h_2, z_4, _e9);
    ray.way = _e89;
    AerialRay _e90 = ray;
    return _e90;
}

AerialNode aerial_node(AerialHeader h_3, AerialRay ray_1, uint node) {
    uint cell_1 = (ray_1.cell + (node * ray_1.cells));
    uint depths_1 = ((h_3.distances + 3u) * ray_1.cells);
    vec4 _e15 = spline_surface(cell_1, ray_1.columns, ray_1.row, ray_1.column);
    vec4 _e20 = spline_surface((cell_1 + depths_1), ray_1.columns, ray_1.row, ray_1.column);
    return AerialNode(_e15, _e20);
}

Taps aerial_taps(AerialHeader h_4, AerialRay ray_2, float distance_1) {
    float _e9 = aerial_measure(h_4, ray_2.way.rise, clamp(distance_1, 0.0, ray_2.way.end));
    float share = min((log2((1.0 + (_e9 * ray_2.way.rate))) * h_4.per_stretch), 1.0);
    Taps _e24 = spline_taps((share * float(h_4.distances)), h_4.distances);
    return _e24;
}

Aerial aerial_below(Aerial seen, vec3 depth, float times) {
    vec3 factors_2 = exp2((-(depth) * times));
    vec3 more = ((vec3(1.0) - factors_2) / max((vec3(1.0) - seen.factors), vec3(1e-6)));
    return Aerial((seen.light * mix(more, vec3(times), lessThan(depth, vec3(0.001)))), factors_2);
}

Aerial aerial_blend(AerialHeader h_5, AerialRay ray_3, AerialNode nodes_1[4], vec4 weight_1, float distance_2) {
    bool local_1 = false;
    float way_2 = min(distance_2, ray_3.way.end);
    vec4 light_1 = ((((nodes_1[0].light * weight_1.x) + (nodes_1[1].light * weight_1.y)) + (nodes_1[2].light * weight_1.z)) + (nodes_1[3].light * weight_1.w));
    vec4 depth_1 = ((((nodes_1[0].depth * weight_1.x) + (nodes_1[1].depth * weight_1.y)) + (nodes_1[2].depth * weight_1.z)) + (nodes_1[3].depth * weight_1.w));
    vec3 whole = (way_2 * max(depth_1.xyz, vec3(0.0)));
    Aerial seen_1 = Aerial((exp2((light_1 + ray_3.envelope).xyz) * way_2), exp2(-(whole)));
    if (ray_3.way.grounded) {
        local_1 = (distance_2 > way_2);
    } else {
        local_1 = false;
    }
    bool _e64 = local_1;
    if (_e64) {
        Aerial _e66 = aerial_below(seen_1, whole, (distance_2 / way_2));
        return _e66;
    }
    return seen_1;
}

Aerial aerial_at(AerialHeader h_6, uint first_3, vec3 d_2, float distance_3) {
    AerialRay _e4 = aerial_ray(h_6, first_3, d_2);
    Taps _e5 = aerial_taps(h_6, _e4, distance_3);
    AerialNode _e7 = aerial_node(h_6, _e4, _e5.first);
    AerialNode _e11 = aerial_node(h_6, _e4, (_e5.first + 1u));
    AerialNode _e15 = aerial_node(h_6, _e4, (_e5.first + 2u));
    AerialNode _e19 = aerial_node(h_6, _e4, (_e5.first + 3u));
    AerialNode nodes_2[4] = AerialNode[4](_e7, _e11, _e15, _e19);
    Aerial _e22 = aerial_blend(h_6, _e4, nodes_2, _e5.weight, distance_3);
    return _e22;
}

vec3 aerial_srgb_factors(AerialHeader h_7, vec3 factors) {
    vec3 _e4 = linear_srgb((factors * h_7.white));
    vec3 _e6 = linear_srgb(h_7.white);
    return clamp((_e4 / _e6), vec3(0.0), vec3(1.0));
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    bool local = false;
    AerialNode nodes[4] = AerialNode[4](AerialNode(vec4(0.0), vec4(0.0)), AerialNode(vec4(0.0), vec4(0.0)), AerialNode(vec4(0.0), vec4(0.0)), AerialNode(vec4(0.0), vec4(0.0)));
    uint next = 0u;
    uint slice = 0u;
    uint _e4 = _group_1_binding_2_cs.columns;
    if (!((id.x >= _e4))) {
        uint _e12 = _group_1_binding_2_cs.rows;
        local = (id.y >= _e12);
    } else {
        local = true;
    }
    bool _e15 = local;
    if (_e15) {
        return;
    }
    uint _e24 = _group_1_binding_2_cs.columns;
    float x_2 = ((float(((2u * id.x) + 1u)) / float(_e24)) - 1.0);
    uint _e37 = _group_1_binding_2_cs.rows;
    float y = (1.0 - (float(((2u * id.y) + 1u)) / float(_e37)));
    vec3 _e44 = _group_1_binding_2_cs.axis;
    vec3 _e47 = _group_1_binding_2_cs.right;
    vec3 _e52 = _group_1_binding_2_cs.up;
    vec3 way_3 = ((_e44 + (x_2 * _e47)) + (y * _e52));
    float stretch = length(way_3);
    AerialHeader _e57 = _group_1_binding_1_cs;
    uint _e60 = _group_1_binding_0_cs.x;
    AerialRay _e63 = aerial_ray(_e57, _e60, (way_3 / vec3(stretch)));
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e140 = slice;
            slice = (_e140 + 1u);
        }
        loop_init = false;
        uint _e69 = slice;
        uint _e72 = _group_1_binding_2_cs.slices;
        if ((_e69 < _e72)) {
        } else {
            break;
        }
        {
            uint _e75 = slice;
            float _e77 = _group_1_binding_3_cs[_e75];
            float distance_4 = (_e77 * stretch);
            AerialHeader _e80 = _group_1_binding_1_cs;
            Taps _e81 = aerial_taps(_e80, _e63, distance_4);
            uint _e82 = next;
            next = max(_e82, _e81.first);
            while(true) {
                uint _e85 = next;
                if ((_e85 < (_e81.first + 4u))) {
                } else {
                    break;
                }
                {
                    AerialNode _e92 = nodes[1];
                    nodes[0] = _e92;
                    AerialNode _e95 = nodes[2];
                    nodes[1] = _e95;
                    AerialNode _e98 = nodes[3];
                    nodes[2] = _e98;
                    AerialHeader _e101 = _group_1_binding_1_cs;
                    uint _e102 = next;
                    AerialNode _e103 = aerial_node(_e101, _e63, _e102);
                    nodes[3] = _e103;
                    uint _e105 = next;
                    next = (_e105 + 1u);
                }
            }
            AerialHeader _e108 = _group_1_binding_1_cs;
            AerialNode _e109[4] = nodes;
            Aerial _e111 = aerial_blend(_e108, _e63, _e109, _e81.weight, distance_4);
            uint _e115 = _group_1_binding_2_cs.columns;
            uint _e121 = _group_1_binding_2_cs.slices;
            uint _e123 = slice;
            uint at = ((((id.y * _e115) + id.x) * _e121) + _e123);
            vec3 _e128 = linear_srgb(_e111.light);
            _group_1_binding_4_cs[at] = vec4(_e128, 0.0);
            AerialHeader _e134 = _group_1_binding_1_cs;
            vec3 _e136 = aerial_srgb_factors(_e134, _e111.factors);
            _group_1_binding_5_cs[at] = vec4(_e136, 0.0);
        }
    }
    return;
}

