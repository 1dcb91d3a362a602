#version 450 core
#extension GL_ARB_compute_shader : require
#extension GL_ARB_shader_storage_buffer_object : require
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;

struct AirHeader {
    float radius;
    float top;
    uint layers;
    uint quads;
    uint groups;
    uint wavelengths;
    uint unused;
    uint layout_version;
};
struct AirLine {
    float w;
    float b;
};
struct Segment {
    vec4 start;
    vec4 end;
};
const uint AIR_QUADS = 4u;

layout(std430, binding = 0) readonly buffer type_2_block_0Compute { vec4 _group_0_binding_0_cs[]; };

layout(std140, binding = 1) uniform type_9_block_1Compute { uvec4 _group_1_binding_0_cs; };

layout(std140, binding = 2) uniform AirHeader_block_2Compute { AirHeader _group_1_binding_1_cs; };

layout(std430, binding = 3) readonly buffer type_10_block_3Compute { Segment _group_1_binding_2_cs[]; };

layout(std430, binding = 4) buffer type_2_block_4Compute { vec4 _group_1_binding_3_cs[]; };


AirLine air_line(AirHeader h, vec3 start, vec3 direction) {
    float w_1 = (start.z + (dot(start, start) / (2.0 * h.radius)));
    return AirLine(w_1, (dot(start, direction) + (h.radius * direction.z)));
}

float air_down(AirHeader h_1, AirLine line, float edge) {
    bool local = false;
    float c = max(((2.0 * h_1.radius) * (line.w - edge)), 0.0);
    float square = ((line.b * line.b) - c);
    if ((line.b < 0.0)) {
        local = (square > 0.0);
    } else {
        local = false;
    }
    bool _e29 = local;
    return (_e29 ? (c / (sqrt(max(square, 0.0)) - line.b)) : 1e30);
}

float air_up(AirHeader h_2, AirLine line_1, float edge_1) {
    float c_1 = ((2.0 * h_2.radius) * (edge_1 - line_1.w));
    float root = sqrt(max(((line_1.b * line_1.b) + c_1), 0.0));
    if ((line_1.b > 0.0)) {
        return (c_1 / (line_1.b + root));
    }
    return (root - line_1.b);
}

vec2 air_end(AirHeader h_3, vec3 start_1, vec3 direction_1) {
    bool local_1 = false;
    AirLine _e3 = air_line(h_3, start_1, direction_1);
    float c_2 = ((2.0 * h_3.radius) * _e3.w);
    if ((_e3.b < 0.0)) {
        local_1 = ((_e3.b * _e3.b) > c_2);
    } else {
        local_1 = false;
    }
    bool _e19 = local_1;
    if (_e19) {
        float height = max(c_2, 0.0);
        return vec2((height / (sqrt(((_e3.b * _e3.b) - c_2)) - _e3.b)), 1.0);
    }
    float top = (h_3.top + ((h_3.top * h_3.top) / (2.0 * h_3.radius)));
    float _e41 = air_up(h_3, _e3, top);
    return vec2(max(_e41, 0.0), 0.0);
}

void air_piece(AirHeader h_4, uint first, AirLine line_2, uint layer, vec2 ends, inout vec4 sums[4]) {
    uint q = 0u;
    vec4 edges = _group_0_binding_0_cs[(first + layer)];
    float d = (ends.y - ends.x);
    float m = (0.5 * (ends.x + ends.y));
    float w_2 = (line_2.w + (((m * (m + (2.0 * line_2.b))) + ((d * d) * 0.083333336)) / (2.0 * h_4.radius)));
    float mean = ((w_2 - edges.x) * edges.y);
    float slope = (((m + line_2.b) * edges.z) * d);
    float bent = ((d * d) * edges.z);
    float square_1 = (((mean * mean) + ((slope * slope) * 0.33333334)) + ((bent * bent) * 0.0055555557));
    uint row = ((first + h_4.layers) + ((3u * layer) * h_4.quads));
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e99 = q;
            q = (_e99 + 1u);
        }
        loop_init = false;
        uint _e63 = q;
        if ((_e63 < h_4.quads)) {
        } else {
            break;
        }
        {
            uint _e67 = q;
            vec4 _e70 = _group_0_binding_0_cs[(row + _e67)];
            uint _e74 = q;
            vec4 _e77 = _group_0_binding_0_cs[((row + h_4.quads) + _e74)];
            uint _e85 = q;
            vec4 _e88 = _group_0_binding_0_cs[((row + (2u * h_4.quads)) + _e85)];
            vec4 density = ((_e70 + (_e77 * mean)) + (_e88 * square_1));
            uint _e91 = q;
            vec4 _e93 = sums[_e91];
            sums[_e91] = (_e93 + (max(density, vec4(0.0)) * d));
        }
    }
    return;
}

uint air_layer(AirHeader h_5, uint first_1, float w) {
    uint low = 0u;
    uint high = 0u;
    high = h_5.layers;
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
            float _e21 = _group_0_binding_0_cs[(first_1 + middle)].x;
            if ((_e21 <= w)) {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
    uint _e23 = low;
    return _e23;
}

vec4[4] air_columns(AirHeader h_6, uint first_2, vec3 start_2, vec3 direction_2, float length_) {
    vec4 sums_1[4] = vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    float s = 0.0;
    uint layer_1 = 0u;
    bool local_2 = false;
    bool local_3 = false;
    bool local_4 = false;
    sums_1 = vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    AirLine _e8 = air_line(h_6, start_2, direction_2);
    float top_1 = _group_0_binding_0_cs[((first_2 + h_6.layers) - 1u)].w;
    if ((_e8.w > top_1)) {
        float _e21 = air_down(h_6, _e8, top_1);
        s = _e21;
    }
    float _e22 = s;
    if ((_e22 >= length_)) {
        vec4 _e24[4] = sums_1;
        return _e24;
    }
    uint _e27 = air_layer(h_6, first_2, min(_e8.w, top_1));
    layer_1 = _e27;
    while(true) {
        float _e29 = s;
        if ((_e29 < length_)) {
            local_2 = (_e8.b < 0.0);
        } else {
            local_2 = false;
        }
        bool _e37 = local_2;
        if (_e37) {
        } else {
            break;
        }
        {
            uint _e39 = layer_1;
            float _e43 = _group_0_binding_0_cs[(first_2 + _e39)].x;
            float _e44 = air_down(h_6, _e8, _e43);
            if (!((_e44 >= length_))) {
                uint _e49 = layer_1;
                local_3 = (_e49 == 0u);
            } else {
                local_3 = true;
            }
            bool _e53 = local_3;
            if (_e53) {
                break;
            }
            uint _e54 = layer_1;
            float _e55 = s;
            float _e56 = s;
            air_piece(h_6, first_2, _e8, _e54, vec2(_e55, max(_e44, _e56)), sums_1);
            float _e59 = s;
            s = max(_e44, _e59);
            uint _e61 = layer_1;
            layer_1 = (_e61 - 1u);
        }
    }
    while(true) {
        float _e64 = s;
        if ((_e64 < length_)) {
            uint _e68 = layer_1;
            local_4 = (_e68 < h_6.layers);
        } else {
            local_4 = false;
        }
        bool _e72 = local_4;
        if (_e72) {
        } else {
            break;
        }
        {
            uint _e74 = layer_1;
            float _e78 = _group_0_binding_0_cs[(first_2 + _e74)].w;
            float _e79 = air_up(h_6, _e8, _e78);
            float _e80 = s;
            float end = max(_e79, _e80);
            uint _e82 = layer_1;
            float _e83 = s;
            air_piece(h_6, first_2, _e8, _e82, vec2(_e83, min(end, length_)), sums_1);
            s = end;
            uint _e86 = layer_1;
            layer_1 = (_e86 + 1u);
        }
    }
    vec4 _e89[4] = sums_1;
    return _e89;
}

vec4 air_depth(AirHeader h_7, uint first_3, vec4 columns[4], uint group_1) {
    vec4 sums_2[4] = vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    vec4 depth = vec4(0.0);
    uint k = 0u;
    uint extinction = ((first_3 + (h_7.layers * (1u + (3u * h_7.quads)))) + group_1);
    sums_2 = columns;
    bool loop_init_1 = true;
    while(true) {
        if (!loop_init_1) {
            uint _e43 = k;
            k = (_e43 + 1u);
        }
        loop_init_1 = false;
        uint _e18 = k;
        if ((_e18 < (4u * h_7.quads))) {
        } else {
            break;
        }
        {
            vec4 _e23 = depth;
            uint _e25 = k;
            vec4 _e30 = _group_0_binding_0_cs[(extinction + (_e25 * h_7.groups))];
            uint _e31 = k;
            uint _e35 = k;
            float _e39 = sums_2[(_e31 / 4u)][(_e35 % 4u)];
            depth = (_e23 + (_e30 * _e39));
        }
    }
    vec4 _e45 = depth;
    return _e45;
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    uint group = 0u;
    if ((id.x >= uint(_group_1_binding_2_cs.length()))) {
        return;
    }
    vec4 _e9 = _group_1_binding_2_cs[id.x].start;
    vec3 start_3 = _e9.xyz;
    vec4 _e15 = _group_1_binding_2_cs[id.x].end;
    vec3 way = (_e15.xyz - start_3);
    float distance_ = length(way);
    vec3 direction_3 = ((distance_ > 0.0) ? (way / vec3(distance_)) : vec3(0.0, 0.0, 1.0));
    AirHeader _e29 = _group_1_binding_1_cs;
    vec2 _e30 = air_end(_e29, start_3, direction_3);
    AirHeader _e32 = _group_1_binding_1_cs;
    uint _e35 = _group_1_binding_0_cs.x;
    vec4 _e36[4] = air_columns(_e32, _e35, start_3, direction_3, distance_);
    AirHeader _e38 = _group_1_binding_1_cs;
    uint _e41 = _group_1_binding_0_cs.x;
    vec4 _e43[4] = air_columns(_e38, _e41, start_3, direction_3, _e30.x);
    bool loop_init_2 = true;
    while(true) {
        if (!loop_init_2) {
            uint _e91 = group;
            group = (_e91 + 1u);
        }
        loop_init_2 = false;
        uint _e46 = group;
        uint _e49 = _group_1_binding_1_cs.groups;
        if ((_e46 < _e49)) {
        } else {
            break;
        }
        {
            uint _e56 = _group_1_binding_1_cs.groups;
            uint _e58 = group;
            uint at = (((2u * id.x) * _e56) + _e58);
            AirHeader _e63 = _group_1_binding_1_cs;
            uint _e66 = _group_1_binding_0_cs.x;
            uint _e67 = group;
            vec4 _e68 = air_depth(_e63, _e66, _e36, _e67);
            _group_1_binding_3_cs[at] = exp(-(_e68));
            uint _e74 = _group_1_binding_1_cs.groups;
            AirHeader _e78 = _group_1_binding_1_cs;
            uint _e81 = _group_1_binding_0_cs.x;
            uint _e82 = group;
            vec4 _e83 = air_depth(_e78, _e81, _e43, _e82);
            _group_1_binding_3_cs[(at + _e74)] = (exp(-(_e83)) * (1.0 - _e30.y));
        }
    }
    return;
}

