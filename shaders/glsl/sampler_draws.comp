#version 450 core
#extension GL_ARB_compute_shader : require
#extension GL_ARB_shader_storage_buffer_object : require
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;

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
struct SamplerHeader {
    vec2 azimuth;
    vec2 shrink;
    float horizon;
    float share;
    uvec2 rows;
    uint columns;
    uint unused_a;
    uint unused_b;
    uint layout_version;
};
struct SkyDraw {
    vec3 direction;
    float pdf;
    bool disc;
};
struct Drawn {
    uint index;
    float rest;
};
struct Request {
    vec2 numbers;
    vec2 unused;
    vec4 direction;
};
const float WELKIN_PI = 3.1415927;

layout(std430, binding = 0) readonly buffer type_2_block_0Compute { vec4 _group_0_binding_0_cs[]; };

layout(std140, binding = 1) uniform type_9_block_1Compute { uvec4 _group_1_binding_0_cs; };

layout(std140, binding = 2) uniform SamplerHeader_block_2Compute { SamplerHeader _group_1_binding_1_cs; };

layout(std140, binding = 3) uniform DiscHeader_block_3Compute { DiscHeader _group_1_binding_2_cs; };

layout(std430, binding = 4) readonly buffer type_10_block_4Compute { Request _group_1_binding_3_cs[]; };

layout(std430, binding = 5) buffer type_2_block_5Compute { vec4 _group_1_binding_4_cs[]; };


vec2 quarter_turn(float x) {
    float t_1 = (x - 0.7853982);
    float s = (t_1 * t_1);
    float sine = (t_1 * (1.0 - (s * (0.16666667 - (s * (0.008333334 - (s * (0.0001984127 - (s / 362880.0)))))))));
    float cosine_1 = (1.0 - (s * (0.5 - (s * (0.041666668 - (s * (0.0013888889 - (s / 40320.0))))))));
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

float disc_square(DiscHeader h, vec3 d_1) {
    vec3 way_1 = ((d_1 - h.centre) / vec3(h.chord));
    return dot(way_1, way_1);
}

vec4 disc_weights(float u) {
    float b_1 = (u - 1.0);
    float c_1 = (u - 2.0);
    float d_6 = (u - 3.0);
    return vec4((((b_1 * c_1) * d_6) * -0.16666667), (((u * c_1) * d_6) * 0.5), (((u * b_1) * d_6) * -0.5), (((u * b_1) * c_1) * 0.16666667));
}

DiscPoint disc_point(DiscHeader h_1, vec3 d_2) {
    DiscPoint point = DiscPoint(false, 0u, vec4(0.0), 0.0);
    bool local = false;
    bool local_1 = false;
    float _e3 = disc_square(h_1, d_2);
    if (!((h_1.visible == 0u))) {
        local = (_e3 > 1.0);
    } else {
        local = true;
    }
    bool _e13 = local;
    if (_e13) {
        DiscPoint _e14 = point;
        return _e14;
    }
    float sine_2 = ((d_2.z * h_1.lowest.x) - (length(d_2.xy) * h_1.lowest.y));
    float elevation = (sine_2 + (((sine_2 * sine_2) * sine_2) * 0.16666667));
    float u_1 = clamp((elevation * h_1.nodes_per_radian), 0.0, float((h_1.nodes - 1u)));
    if (!((h_1.cut == 0u))) {
        local_1 = (sine_2 >= 0.0);
    } else {
        local_1 = true;
    }
    bool _e48 = local_1;
    point.seen = _e48;
    point.node = (uint(clamp(u_1, 1.0, float((h_1.nodes - 3u)))) - 1u);
    uint _e61 = point.node;
    vec4 _e64 = disc_weights((u_1 - float(_e61)));
    point.weight = _e64;
    point.mu = sqrt((1.0 - _e3));
    DiscPoint _e69 = point;
    return _e69;
}

vec4 disc_relative(DiscHeader h_2, uint first, DiscPoint point_1, uint group) {
    vec4 depth = vec4(0.0);
    uint k = 0u;
    vec4 limb = vec4(0.0);
    uint i = 5u;
    if (!(point_1.seen)) {
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
            vec4 _e27 = _group_0_binding_0_cs[((first + ((point_1.node + _e20) * h_2.groups)) + group)];
            depth = (_e14 + (point_1.weight[_e16] * _e27));
        }
    }
    uint profile = ((first + (h_2.nodes * h_2.groups)) + (6u * group));
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
            limb = ((_e51 * point_1.mu) + _e60);
        }
    }
    vec4 _e65 = depth;
    vec4 _e72 = limb;
    return ((exp(-(max(_e65, vec4(0.0)))) * h_2.mean) * _e72);
}

uint disc_weight(DiscHeader h_3, uint first_1, uint group_1) {
    return ((first_1 + ((h_3.nodes + 6u) * h_3.groups)) + (4u * group_1));
}

vec4 disc_group(DiscHeader h_4, uint first_2, DiscPoint point_2, uint group_2) {
    vec4 _e4 = disc_relative(h_4, first_2, point_2, group_2);
    uint _e6 = disc_weight(h_4, first_2, group_2);
    vec4 _e10 = _group_0_binding_0_cs[(_e6 + 3u)];
    return (_e4 * _e10);
}

vec3 disc_xyz(DiscHeader h_5, uint first_3, vec3 d_3) {
    vec3 xyz = vec3(0.0);
    uint group_3 = 0u;
    DiscPoint _e3 = disc_point(h_5, d_3);
    if (!(_e3.seen)) {
        vec3 _e8 = xyz;
        return _e8;
    }
    bool loop_init_2 = true;
    while(true) {
        if (!loop_init_2) {
            uint _e38 = group_3;
            group_3 = (_e38 + 1u);
        }
        loop_init_2 = false;
        uint _e11 = group_3;
        if ((_e11 < h_5.groups)) {
        } else {
            break;
        }
        {
            uint _e14 = group_3;
            vec4 _e15 = disc_relative(h_5, first_3, _e3, _e14);
            uint _e16 = group_3;
            uint _e17 = disc_weight(h_5, first_3, _e16);
            vec3 _e18 = xyz;
            vec4 _e21 = _group_0_binding_0_cs[_e17];
            vec4 _e27 = _group_0_binding_0_cs[(_e17 + 1u)];
            vec4 _e33 = _group_0_binding_0_cs[(_e17 + 2u)];
            xyz = (_e18 + vec3(dot(_e15, _e21), dot(_e15, _e27), dot(_e15, _e33)));
        }
    }
    vec3 _e40 = xyz;
    return _e40;
}

float segment_angle(float area) {
    float e = 0.0;
    int i_1 = 0;
    float bounded = clamp(area, 0.0, WELKIN_PI);
    float small = min(bounded, (WELKIN_PI - bounded));
    float s_1 = ((small < 1e-30) ? 0.0 : pow((12.0 * small), 0.33333334));
    float q = (s_1 * s_1);
    float series = (0.0007142857 + (q * (3.9682538e-5 + (q * 2.4930428e-6))));
    e = (s_1 * (1.0 + (q * (0.016666668 + (q * series)))));
    float _e31 = e;
    if ((_e31 > 0.5)) {
        bool loop_init_3 = true;
        while(true) {
            if (!loop_init_3) {
                int _e56 = i_1;
                i_1 = (_e56 + 1);
            }
            loop_init_3 = false;
            int _e36 = i_1;
            if ((_e36 < 2)) {
            } else {
                break;
            }
            {
                float _e39 = e;
                vec2 _e42 = half_turn(min(_e39, WELKIN_PI));
                float _e43 = e;
                float _e44 = e;
                e = (_e43 - (((_e44 - _e42.y) - (2.0 * small)) / (1.0 - _e42.x)));
            }
        }
    }
    float _e58 = e;
    float _e62 = e;
    return ((bounded > small) ? (WELKIN_PI - (0.5 * _e62)) : (0.5 * _e58));
}

vec3 disc_draw(DiscHeader h_6, vec2 numbers) {
    vec2 place = vec2(0.0);
    float _e7 = segment_angle(((1.0 - numbers.x) * h_6.area));
    vec2 _e8 = half_turn(_e7);
    place = vec2((((2.0 * numbers.y) - 1.0) * _e8.y), _e8.x);
    vec2 _e19 = place;
    float radius = length(_e19);
    vec2 _e21 = place;
    place = (_e21 * ((radius > (1.0 - h_6.margin)) ? ((1.0 - h_6.margin) / radius) : 1.0));
    vec2 _e36 = place;
    vec2 _e37 = place;
    float square_1 = ((h_6.chord * h_6.chord) * dot(_e36, _e37));
    vec2 _e40 = place;
    place = (_e40 * (h_6.chord * sqrt(max((1.0 - (0.25 * square_1)), 0.0))));
    float _e59 = place.x;
    float _e64 = place.y;
    return (((h_6.centre * (1.0 - (0.5 * square_1))) + (h_6.left * _e59)) + (h_6.up * _e64));
}

float disc_density(DiscHeader h_7, vec3 d_4) {
    bool local_2 = false;
    bool local_3 = false;
    float reach = (1.0 + h_7.margin);
    float height = dot((d_4 - h_7.centre), h_7.up);
    if ((h_7.visible != 0u)) {
        float _e14 = disc_square(h_7, d_4);
        local_2 = (_e14 <= (reach * reach));
    } else {
        local_2 = false;
    }
    bool _e18 = local_2;
    if (_e18) {
        local_3 = (height >= ((h_7.floor_ - (2.0 * h_7.margin)) * h_7.chord));
    } else {
        local_3 = false;
    }
    bool covered = local_3;
    return (covered ? (1.0 / ((h_7.area * h_7.chord) * h_7.chord)) : 0.0);
}

float sampler_number(uint first_4, uint i_2) {
    float _e10 = _group_0_binding_0_cs[(first_4 + (i_2 / 4u))][(i_2 % 4u)];
    return _e10;
}

float into_unit(float x_2) {
    return clamp(x_2, 0.0, 0.99999994);
}

Drawn sampler_find(uint first_5, uint edges, uint count, float x_3) {
    uint low = 0u;
    uint high = 0u;
    high = count;
    while(true) {
        uint _e7 = high;
        uint _e8 = low;
        if (((_e7 - _e8) > 1u)) {
        } else {
            break;
        }
        {
            uint _e12 = low;
            uint _e13 = high;
            uint middle = ((_e12 + _e13) / 2u);
            float _e18 = sampler_number(first_5, (edges + middle));
            if ((_e18 <= x_3)) {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
    uint _e20 = low;
    float _e22 = sampler_number(first_5, (edges + _e20));
    uint _e23 = low;
    float _e27 = sampler_number(first_5, ((edges + _e23) + 1u));
    float width = (_e27 - _e22);
    uint _e29 = low;
    return Drawn(_e29, ((width > 0.0) ? ((x_3 - _e22) / width) : 0.5));
}

float sampler_mix(uint first_6, uint edge, float t) {
    float _e3 = sampler_number(first_6, edge);
    float _e6 = sampler_number(first_6, (edge + 1u));
    return (_e3 + (t * (_e6 - _e3)));
}

vec3 sampler_sky(SamplerHeader h_8, uint first_7, vec2 numbers_1) {
    uint rows = (h_8.rows.x + h_8.rows.y);
    uint azimuths = (2u * rows);
    Drawn _e15 = sampler_find(first_7, ((azimuths + h_8.columns) + 1u), rows, numbers_1.x);
    bool right = (numbers_1.y >= 0.5);
    float _e28 = into_unit((right ? ((2.0 * numbers_1.y) - 1.0) : (2.0 * numbers_1.y)));
    uint columns = ((((azimuths + h_8.columns) + 1u) + rows) + 1u);
    Drawn _e43 = sampler_find(first_7, (columns + (_e15.index * (h_8.columns + 1u))), h_8.columns, _e28);
    float _e48 = sampler_mix(first_7, (2u * _e15.index), _e15.rest);
    float _e52 = sampler_mix(first_7, (azimuths + _e43.index), _e43.rest);
    vec2 _e53 = half_turn(_e52);
    vec2 level = (sqrt(max((1.0 - (_e48 * _e48)), 0.0)) * vec2(_e53.x, (right ? -(_e53.y) : _e53.y)));
    return vec3(((level.x * h_8.azimuth.x) - (level.y * h_8.azimuth.y)), ((level.x * h_8.azimuth.y) + (level.y * h_8.azimuth.x)), _e48);
}

float sampler_pdf(SamplerHeader h_9, uint first_8, DiscHeader disc, vec3 d_5) {
    uint _e6 = side_of(d_5.z, h_9.horizon);
    float _e9 = pole_cosine(d_5.z, _e6, h_9.shrink);
    float height_1 = sqrt((1.0 - _e9));
    uint row = (min(uint((height_1 * float(h_9.rows[_e6]))), (h_9.rows[_e6] - 1u)) + (_e6 * h_9.rows.x));
    vec2 turned = vec2(dot(d_5.xy, h_9.azimuth), ((d_5.y * h_9.azimuth.x) - (d_5.x * h_9.azimuth.y)));
    vec2 _e40 = azimuth_of(turned);
    float _e42 = half_sine(_e40.x);
    uint column = min(uint((_e42 * float(h_9.columns))), (h_9.columns - 1u));
    uint rows_1 = (h_9.rows.x + h_9.rows.y);
    uint density = ((((((2u * rows_1) + h_9.columns) + 1u) + rows_1) + 1u) + (rows_1 * (h_9.columns + 1u)));
    float _e74 = sampler_number(first_8, ((density + (row * h_9.columns)) + column));
    if ((h_9.share <= 0.0)) {
        return _e74;
    }
    float _e83 = disc_density(disc, d_5);
    return (((1.0 - h_9.share) * _e74) + (h_9.share * _e83));
}

SkyDraw sampler_draw(SamplerHeader h_10, uint first_9, DiscHeader disc_1, vec2 numbers_2) {
    SkyDraw draw = SkyDraw(vec3(0.0), 0.0, false);
    float x_4 = 0.0;
    float _e6 = into_unit(numbers_2.x);
    x_4 = _e6;
    float _e9 = into_unit(numbers_2.y);
    float _e11 = x_4;
    draw.disc = (_e11 < h_10.share);
    bool _e15 = draw.disc;
    if (_e15) {
        float _e17 = x_4;
        vec3 _e21 = disc_draw(disc_1, vec2((_e17 / h_10.share), _e9));
        draw.direction = _e21;
    } else {
        float _e22 = x_4;
        float _e29 = into_unit(((_e22 - h_10.share) / (1.0 - h_10.share)));
        x_4 = _e29;
        float _e31 = x_4;
        vec3 _e33 = sampler_sky(h_10, first_9, vec2(_e31, _e9));
        draw.direction = _e33;
    }
    vec3 _e36 = draw.direction;
    float _e37 = sampler_pdf(h_10, first_9, disc_1, _e36);
    draw.pdf = _e37;
    SkyDraw _e38 = draw;
    return _e38;
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if ((id.x >= uint(_group_1_binding_3_cs.length()))) {
        return;
    }
    SamplerHeader _e6 = _group_1_binding_1_cs;
    uint _e9 = _group_1_binding_0_cs.x;
    DiscHeader _e11 = _group_1_binding_2_cs;
    vec2 _e16 = _group_1_binding_3_cs[id.x].numbers;
    SkyDraw _e17 = sampler_draw(_e6, _e9, _e11, _e16);
    vec4 _e22 = _group_1_binding_3_cs[id.x].direction;
    vec3 d_7 = normalize(_e22.xyz);
    _group_1_binding_4_cs[(2u * id.x)] = vec4(_e17.direction, _e17.pdf);
    SamplerHeader _e41 = _group_1_binding_1_cs;
    uint _e44 = _group_1_binding_0_cs.x;
    DiscHeader _e46 = _group_1_binding_2_cs;
    float _e47 = sampler_pdf(_e41, _e44, _e46, d_7);
    _group_1_binding_4_cs[((2u * id.x) + 1u)] = vec4(_e47, (_e17.disc ? 1.0 : 0.0), 0.0, 0.0);
    return;
}

