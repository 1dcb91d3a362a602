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
    float4 start;
    float4 end;
};

static const uint AIR_QUADS = 4u;

ByteAddressBuffer welkin_table : register(t0);
cbuffer place : register(b0, space1) { uint4 place; }
cbuffer air : register(b1, space1) { AirHeader air; }
ByteAddressBuffer segments : register(t2, space1);
RWByteAddressBuffer out_ : register(u3, space1);

AirLine ConstructAirLine(float arg0, float arg1) {
    AirLine ret = (AirLine)0;
    ret.w = arg0;
    ret.b = arg1;
    return ret;
}

AirLine air_line(AirHeader h, float3 start, float3 direction)
{
    float w_1 = (start.z + (dot(start, start) / (2.0 * h.radius)));
    const AirLine airline = ConstructAirLine(w_1, (dot(start, direction) + (h.radius * direction.z)));
    return airline;
}

float air_down(AirHeader h_1, AirLine line_, float edge)
{
    bool local = (bool)0;

    float c = max(((2.0 * h_1.radius) * (line_.w - edge)), 0.0);
    float square = ((line_.b * line_.b) - c);
    if ((line_.b < 0.0)) {
        local = (square > 0.0);
    } else {
        local = false;
    }
    bool _e29 = local;
    return (_e29 ? (c / (sqrt(max(square, 0.0)) - line_.b)) : 1e30);
}

float air_up(AirHeader h_2, AirLine line_1, float edge_1)
{
    float c_1 = ((2.0 * h_2.radius) * (edge_1 - line_1.w));
    float root = sqrt(max(((line_1.b * line_1.b) + c_1), 0.0));
    if ((line_1.b > 0.0)) {
        return (c_1 / (line_1.b + root));
    }
    return (root - line_1.b);
}

float2 air_end(AirHeader h_3, float3 start_1, float3 direction_1)
{
    bool local_1 = (bool)0;

    const AirLine _e3 = air_line(h_3, start_1, direction_1);
    float c_2 = ((2.0 * h_3.radius) * _e3.w);
    if ((_e3.b < 0.0)) {
        local_1 = ((_e3.b * _e3.b) > c_2);
    } else {
        local_1 = false;
    }
    bool _e19 = local_1;
    if (_e19) {
        float height = max(c_2, 0.0);
        return float2((height / (sqrt(((_e3.b * _e3.b) - c_2)) - _e3.b)), 1.0);
    }
    float top = (h_3.top + ((h_3.top * h_3.top) / (2.0 * h_3.radius)));
    const float _e41 = air_up(h_3, _e3, top);
    return float2(max(_e41, 0.0), 0.0);
}

float4 ZeroValuefloat4() {
    return (float4)0;
}

void air_piece(AirHeader h_4, uint first, AirLine line_2, uint layer, float2 ends, inout float4 sums[4])
{
    uint q = 0u;

    float4 edges = asfloat(welkin_table.Load4((first + layer)*16));
    float d = (ends.y - ends.x);
    float m = (0.5 * (ends.x + ends.y));
    float w_2 = (line_2.w + (((m * (m + (2.0 * line_2.b))) + ((d * d) * 0.083333336)) / (2.0 * h_4.radius)));
    float mean = ((w_2 - edges.x) * edges.y);
    float slope = (((m + line_2.b) * edges.z) * d);
    float bent = ((d * d) * edges.z);
    float square_1 = (((mean * mean) + ((slope * slope) * 0.33333334)) + ((bent * bent) * 0.0055555557));
    uint row = ((first + h_4.layers) + ((3u * layer) * h_4.quads));
    uint2 loop_bound = uint2(4294967295u, 4294967295u);
    bool loop_init = true;
    while(true) {
        if (all(loop_bound == uint2(0u, 0u))) { break; }
        loop_bound -= uint2(loop_bound.y == 0u, 1u);
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
            float4 _e70 = asfloat(welkin_table.Load4((row + _e67)*16));
            uint _e74 = q;
            float4 _e77 = asfloat(welkin_table.Load4(((row + h_4.quads) + _e74)*16));
            uint _e85 = q;
            float4 _e88 = asfloat(welkin_table.Load4(((row + (2u * h_4.quads)) + _e85)*16));
            float4 density = ((_e70 + (_e77 * mean)) + (_e88 * square_1));
            uint _e91 = q;
            float4 _e93 = sums[min(uint(_e91), 3u)];
            sums[min(uint(_e91), 3u)] = (_e93 + (max(density, ZeroValuefloat4()) * d));
        }
    }
    return;
}

uint naga_div(uint lhs, uint rhs) {
    return lhs / (rhs == 0u ? 1u : rhs);
}

uint air_layer(AirHeader h_5, uint first_1, float w)
{
    uint low = 0u;
    uint high = (uint)0;

    high = h_5.layers;
    uint2 loop_bound_1 = uint2(4294967295u, 4294967295u);
    while(true) {
        if (all(loop_bound_1 == uint2(0u, 0u))) { break; }
        loop_bound_1 -= uint2(loop_bound_1.y == 0u, 1u);
        uint _e7 = high;
        uint _e8 = low;
        if (((_e7 - _e8) > 1u)) {
        } else {
            break;
        }
        {
            uint _e12 = low;
            uint _e13 = high;
            uint middle = naga_div((_e12 + _e13), 2u);
            float _e21 = asfloat(welkin_table.Load(0+(first_1 + middle)*16));
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

typedef float4 ret_Constructarray4_float4_[4];
ret_Constructarray4_float4_ Constructarray4_float4_(float4 arg0, float4 arg1, float4 arg2, float4 arg3) {
    float4 ret[4] = { arg0, arg1, arg2, arg3 };
    return ret;
}

typedef float4 ret_air_columns[4];
ret_air_columns air_columns(AirHeader h_6, uint first_2, float3 start_2, float3 direction_2, float length_)
{
    float4 sums_1[4] = (float4[4])0;
    float s = 0.0;
    uint layer_1 = (uint)0;
    bool local_2 = (bool)0;
    bool local_3 = (bool)0;
    bool local_4 = (bool)0;

    sums_1 = Constructarray4_float4_(ZeroValuefloat4(), ZeroValuefloat4(), ZeroValuefloat4(), ZeroValuefloat4());
    const AirLine _e8 = air_line(h_6, start_2, direction_2);
    float top_1 = asfloat(welkin_table.Load(12+((first_2 + h_6.layers) - 1u)*16));
    if ((_e8.w > top_1)) {
        const float _e21 = air_down(h_6, _e8, top_1);
        s = _e21;
    }
    float _e22 = s;
    if ((_e22 >= length_)) {
        float4 _e24[4] = sums_1;
        return _e24;
    }
    const uint _e27 = air_layer(h_6, first_2, min(_e8.w, top_1));
    layer_1 = _e27;
    uint2 loop_bound_2 = uint2(4294967295u, 4294967295u);
    while(true) {
        if (all(loop_bound_2 == uint2(0u, 0u))) { break; }
        loop_bound_2 -= uint2(loop_bound_2.y == 0u, 1u);
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
            float _e43 = asfloat(welkin_table.Load(0+(first_2 + _e39)*16));
            const float _e44 = air_down(h_6, _e8, _e43);
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
            air_piece(h_6, first_2, _e8, _e54, float2(_e55, max(_e44, _e56)), sums_1);
            float _e59 = s;
            s = max(_e44, _e59);
            uint _e61 = layer_1;
            layer_1 = (_e61 - 1u);
        }
    }
    uint2 loop_bound_3 = uint2(4294967295u, 4294967295u);
    while(true) {
        if (all(loop_bound_3 == uint2(0u, 0u))) { break; }
        loop_bound_3 -= uint2(loop_bound_3.y == 0u, 1u);
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
            float _e78 = asfloat(welkin_table.Load(12+(first_2 + _e74)*16));
            const float _e79 = air_up(h_6, _e8, _e78);
            float _e80 = s;
            float end = max(_e79, _e80);
            uint _e82 = layer_1;
            float _e83 = s;
            air_piece(h_6, first_2, _e8, _e82, float2(_e83, min(end, length_)), sums_1);
            s = end;
            uint _e86 = layer_1;
            layer_1 = (_e86 + 1u);
        }
    }
    float4 _e89[4] = sums_1;
    return _e89;
}

uint naga_mod(uint lhs, uint rhs) {
    return lhs % (rhs == 0u ? 1u : rhs);
}

float4 air_depth(AirHeader h_7, uint first_3, float4 columns[4], uint group_1)
{
    float4 sums_2[4] = (float4[4])0;
    float4 depth = ZeroValuefloat4();
    uint k = 0u;

    uint extinction = ((first_3 + (h_7.layers * (1u + (3u * h_7.quads)))) + group_1);
    sums_2 = columns;
    uint2 loop_bound_4 = uint2(4294967295u, 4294967295u);
    bool loop_init_1 = true;
    while(true) {
        if (all(loop_bound_4 == uint2(0u, 0u))) { break; }
        loop_bound_4 -= uint2(loop_bound_4.y == 0u, 1u);
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
            float4 _e23 = depth;
            uint _e25 = k;
            float4 _e30 = asfloat(welkin_table.Load4((extinction + (_e25 * h_7.groups))*16));
            uint _e31 = k;
            uint _e35 = k;
            float _e39 = sums_2[min(uint(naga_div(_e31, 4u)), 3u)][min(uint(naga_mod(_e35, 4u)), 3u)];
            depth = (_e23 + (_e30 * _e39));
        }
    }
    float4 _e45 = depth;
    return _e45;
}

uint NagaBufferLength(ByteAddressBuffer buffer)
{
    uint ret;
    buffer.GetDimensions(ret);
    return ret;
}

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    uint group = 0u;

    if ((id.x >= ((NagaBufferLength(segments) - 0) / 32))) {
        return;
    }
    float4 _e9 = asfloat(segments.Load4(0+id.x*32));
    float3 start_3 = _e9.xyz;
    float4 _e15 = asfloat(segments.Load4(16+id.x*32));
    float3 way = (_e15.xyz - start_3);
    float distance_ = length(way);
    float3 direction_3 = ((distance_ > 0.0) ? (way / (distance_).xxx) : float3(0.0, 0.0, 1.0));
    AirHeader _e29 = air;
    const float2 _e30 = air_end(_e29, start_3, direction_3);
    AirHeader _e32 = air;
    uint _e35 = place.x;
    const float4 _e36[4] = air_columns(_e32, _e35, start_3, direction_3, distance_);
    AirHeader _e38 = air;
    uint _e41 = place.x;
    const float4 _e43[4] = air_columns(_e38, _e41, start_3, direction_3, _e30.x);
    uint2 loop_bound_5 = uint2(4294967295u, 4294967295u);
    bool loop_init_2 = true;
    while(true) {
        if (all(loop_bound_5 == uint2(0u, 0u))) { break; }
        loop_bound_5 -= uint2(loop_bound_5.y == 0u, 1u);
        if (!loop_init_2) {
            uint _e91 = group;
            group = (_e91 + 1u);
        }
        loop_init_2 = false;
        uint _e46 = group;
        uint _e49 = air.groups;
        if ((_e46 < _e49)) {
        } else {
            break;
        }
        {
            uint _e56 = air.groups;
            uint _e58 = group;
            uint at = (((2u * id.x) * _e56) + _e58);
            AirHeader _e63 = air;
            uint _e66 = place.x;
            uint _e67 = group;
            const float4 _e68 = air_depth(_e63, _e66, _e36, _e67);
            out_.Store4(at*16, asuint(exp(-(_e68))));
            uint _e74 = air.groups;
            AirHeader _e78 = air;
            uint _e81 = place.x;
            uint _e82 = group;
            const float4 _e83 = air_depth(_e78, _e81, _e43, _e82);
            out_.Store4((at + _e74)*16, asuint((exp(-(_e83)) * (1.0 - _e30.y))));
        }
    }
    return;
}
