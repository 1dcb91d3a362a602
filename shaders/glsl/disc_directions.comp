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
layout(std430, binding = 0) readonly buffer type_2_block_0Compute { vec4 _group_0_binding_0_cs[]; };

layout(std140, binding = 1) uniform type_7_block_1Compute { uvec4 _group_1_binding_0_cs; };

layout(std140, binding = 2) uniform DiscHeader_block_2Compute { DiscHeader _group_1_binding_1_cs; };

layout(std430, binding = 3) readonly buffer type_2_block_3Compute { vec4 _group_1_binding_2_cs[]; };

layout(std430, binding = 4) buffer type_2_block_4Compute { vec4 _group_1_binding_3_cs[]; };


float disc_square(DiscHeader h, vec3 d) {
    vec3 way = ((d - h.centre) / vec3(h.chord));
    return dot(way, way);
}

vec4 disc_weights(float u) {
    float b = (u - 1.0);
    float c = (u - 2.0);
    float d_3 = (u - 3.0);
    return vec4((((b * c) * d_3) * -0.16666667), (((u * c) * d_3) * 0.5), (((u * b) * d_3) * -0.5), (((u * b) * c) * 0.16666667));
}

DiscPoint disc_point(DiscHeader h_1, vec3 d_1) {
    DiscPoint point = DiscPoint(false, 0u, vec4(0.0), 0.0);
    bool local = false;
    bool local_1 = false;
    float _e3 = disc_square(h_1, d_1);
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
    float sine = ((d_1.z * h_1.lowest.x) - (length(d_1.xy) * h_1.lowest.y));
    float elevation = (sine + (((sine * sine) * sine) * 0.16666667));
    float u_1 = clamp((elevation * h_1.nodes_per_radian), 0.0, float((h_1.nodes - 1u)));
    if (!((h_1.cut == 0u))) {
        local_1 = (sine >= 0.0);
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

vec4 disc_relative(DiscHeader h_2, uint first, DiscPoint point_1, uint group_1) {
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
            vec4 _e27 = _group_0_binding_0_cs[((first + ((point_1.node + _e20) * h_2.groups)) + group_1)];
            depth = (_e14 + (point_1.weight[_e16] * _e27));
        }
    }
    uint profile = ((first + (h_2.nodes * h_2.groups)) + (6u * group_1));
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

uint disc_weight(DiscHeader h_3, uint first_1, uint group_2) {
    return ((first_1 + ((h_3.nodes + 6u) * h_3.groups)) + (4u * group_2));
}

vec4 disc_group(DiscHeader h_4, uint first_2, DiscPoint point_2, uint group_3) {
    vec4 _e4 = disc_relative(h_4, first_2, point_2, group_3);
    uint _e6 = disc_weight(h_4, first_2, group_3);
    vec4 _e10 = _group_0_binding_0_cs[(_e6 + 3u)];
    return (_e4 * _e10);
}

vec3 disc_xyz(DiscHeader h_5, uint first_3, vec3 d_2) {
    vec3 xyz = vec3(0.0);
    uint group_4 = 0u;
    DiscPoint _e3 = disc_point(h_5, d_2);
    if (!(_e3.seen)) {
        vec3 _e8 = xyz;
        return _e8;
    }
    bool loop_init_2 = true;
    while(true) {
        if (!loop_init_2) {
            uint _e38 = group_4;
            group_4 = (_e38 + 1u);
        }
        loop_init_2 = false;
        uint _e11 = group_4;
        if ((_e11 < h_5.groups)) {
        } else {
            break;
        }
        {
            uint _e14 = group_4;
            vec4 _e15 = disc_relative(h_5, first_3, _e3, _e14);
            uint _e16 = group_4;
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

void main() {
    uvec3 id = gl_GlobalInvocationID;
    uint group = 0u;
    if ((id.x >= uint(_group_1_binding_2_cs.length()))) {
        return;
    }
    vec4 _e8 = _group_1_binding_2_cs[id.x];
    vec3 d_4 = normalize(_e8.xyz);
    uint _e15 = _group_1_binding_1_cs.groups;
    uint at = (id.x * (1u + _e15));
    DiscHeader _e21 = _group_1_binding_1_cs;
    uint _e24 = _group_1_binding_0_cs.x;
    vec3 _e25 = disc_xyz(_e21, _e24, d_4);
    _group_1_binding_3_cs[at] = vec4(_e25, 0.0);
    DiscHeader _e29 = _group_1_binding_1_cs;
    DiscPoint _e30 = disc_point(_e29, d_4);
    bool loop_init_3 = true;
    while(true) {
        if (!loop_init_3) {
            uint _e52 = group;
            group = (_e52 + 1u);
        }
        loop_init_3 = false;
        uint _e33 = group;
        uint _e36 = _group_1_binding_1_cs.groups;
        if ((_e33 < _e36)) {
        } else {
            break;
        }
        {
            uint _e41 = group;
            DiscHeader _e45 = _group_1_binding_1_cs;
            uint _e48 = _group_1_binding_0_cs.x;
            uint _e49 = group;
            vec4 _e50 = disc_group(_e45, _e48, _e30, _e49);
            _group_1_binding_3_cs[((at + 1u) + _e41)] = _e50;
        }
    }
    return;
}

