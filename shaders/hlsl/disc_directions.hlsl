struct DiscHeader {
    float3 centre;
    float chord;
    float3 up;
    float floor_;
    float3 left;
    float area;
    float2 lowest;
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
    int _pad2_0;
    int _pad2_1;
    float4 weight;
    float mu;
    int _end_pad_0;
    int _end_pad_1;
    int _end_pad_2;
};

ByteAddressBuffer welkin_table : register(t0);
cbuffer place : register(b0, space1) { uint4 place; }
cbuffer disc : register(b1, space1) { DiscHeader disc; }
ByteAddressBuffer directions : register(t2, space1);
RWByteAddressBuffer out_ : register(u3, space1);

float disc_square(DiscHeader h, float3 d)
{
    float3 way = ((d - h.centre) / (h.chord).xxx);
    return dot(way, way);
}

float4 disc_weights(float u)
{
    float b = (u - 1.0);
    float c = (u - 2.0);
    float d_3 = (u - 3.0);
    return float4((((b * c) * d_3) * -0.16666667), (((u * c) * d_3) * 0.5), (((u * b) * d_3) * -0.5), (((u * b) * c) * 0.16666667));
}

uint naga_f2u32(float value) {
    return uint(clamp(value, 0.0, 4294967000.0));
}

DiscPoint disc_point(DiscHeader h_1, float3 d_1)
{
    DiscPoint point_ = (DiscPoint)0;
    bool local = (bool)0;
    bool local_1 = (bool)0;

    const float _e3 = disc_square(h_1, d_1);
    if (!((h_1.visible == 0u))) {
        local = (_e3 > 1.0);
    } else {
        local = true;
    }
    bool _e13 = local;
    if (_e13) {
        DiscPoint _e14 = point_;
        const DiscPoint discpoint = _e14;
        return discpoint;
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
    point_.seen = _e48;
    point_.node = (naga_f2u32(clamp(u_1, 1.0, float((h_1.nodes - 3u)))) - 1u);
    uint _e61 = point_.node;
    const float4 _e64 = disc_weights((u_1 - float(_e61)));
    point_.weight = _e64;
    point_.mu = sqrt((1.0 - _e3));
    DiscPoint _e69 = point_;
    const DiscPoint discpoint_1 = _e69;
    return discpoint_1;
}

float4 ZeroValuefloat4() {
    return (float4)0;
}

float4 disc_relative(DiscHeader h_2, uint first, DiscPoint point_1, uint group_1)
{
    float4 depth = ZeroValuefloat4();
    uint k = 0u;
    float4 limb = (float4)0;
    uint i = 5u;

    if (!(point_1.seen)) {
        return ZeroValuefloat4();
    }
    uint2 loop_bound = uint2(4294967295u, 4294967295u);
    bool loop_init = true;
    while(true) {
        if (all(loop_bound == uint2(0u, 0u))) { break; }
        loop_bound -= uint2(loop_bound.y == 0u, 1u);
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
            float4 _e14 = depth;
            uint _e16 = k;
            uint _e20 = k;
            float4 _e27 = asfloat(welkin_table.Load4(((first + ((point_1.node + _e20) * h_2.groups)) + group_1)*16));
            depth = (_e14 + (point_1.weight[min(uint(_e16), 3u)] * _e27));
        }
    }
    uint profile = ((first + (h_2.nodes * h_2.groups)) + (6u * group_1));
    float4 _e44 = asfloat(welkin_table.Load4((profile + 5u)*16));
    limb = _e44;
    uint2 loop_bound_1 = uint2(4294967295u, 4294967295u);
    bool loop_init_1 = true;
    while(true) {
        if (all(loop_bound_1 == uint2(0u, 0u))) { break; }
        loop_bound_1 -= uint2(loop_bound_1.y == 0u, 1u);
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
            float4 _e51 = limb;
            uint _e55 = i;
            float4 _e60 = asfloat(welkin_table.Load4(((profile + _e55) - 1u)*16));
            limb = ((_e51 * point_1.mu) + _e60);
        }
    }
    float4 _e65 = depth;
    float4 _e72 = limb;
    return ((exp(-(max(_e65, ZeroValuefloat4()))) * h_2.mean) * _e72);
}

uint disc_weight(DiscHeader h_3, uint first_1, uint group_2)
{
    return ((first_1 + ((h_3.nodes + 6u) * h_3.groups)) + (4u * group_2));
}

float4 disc_group(DiscHeader h_4, uint first_2, DiscPoint point_2, uint group_3)
{
    const float4 _e4 = disc_relative(h_4, first_2, point_2, group_3);
    const uint _e6 = disc_weight(h_4, first_2, group_3);
    float4 _e10 = asfloat(welkin_table.Load4((_e6 + 3u)*16));
    return (_e4 * _e10);
}

float3 ZeroValuefloat3() {
    return (float3)0;
}

float3 disc_xyz(DiscHeader h_5, uint first_3, float3 d_2)
{
    float3 xyz = ZeroValuefloat3();
    uint group_4 = 0u;

    const DiscPoint _e3 = disc_point(h_5, d_2);
    if (!(_e3.seen)) {
        float3 _e8 = xyz;
        return _e8;
    }
    uint2 loop_bound_2 = uint2(4294967295u, 4294967295u);
    bool loop_init_2 = true;
    while(true) {
        if (all(loop_bound_2 == uint2(0u, 0u))) { break; }
        loop_bound_2 -= uint2(loop_bound_2.y == 0u, 1u);
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
            const float4 _e15 = disc_relative(h_5, first_3, _e3, _e14);
            uint _e16 = group_4;
            const uint _e17 = disc_weight(h_5, first_3, _e16);
            float3 _e18 = xyz;
            float4 _e21 = asfloat(welkin_table.Load4(_e17*16));
            float4 _e27 = asfloat(welkin_table.Load4((_e17 + 1u)*16));
            float4 _e33 = asfloat(welkin_table.Load4((_e17 + 2u)*16));
            xyz = (_e18 + float3(dot(_e15, _e21), dot(_e15, _e27), dot(_e15, _e33)));
        }
    }
    float3 _e40 = xyz;
    return _e40;
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

    if ((id.x >= ((NagaBufferLength(directions) - 0) / 16))) {
        return;
    }
    float4 _e8 = asfloat(directions.Load4(id.x*16));
    float3 d_4 = normalize(_e8.xyz);
    uint _e15 = disc.groups;
    uint at = (id.x * (1u + _e15));
    DiscHeader _e21 = disc;
    uint _e24 = place.x;
    const float3 _e25 = disc_xyz(_e21, _e24, d_4);
    out_.Store4(at*16, asuint(float4(_e25, 0.0)));
    DiscHeader _e29 = disc;
    const DiscPoint _e30 = disc_point(_e29, d_4);
    uint2 loop_bound_3 = uint2(4294967295u, 4294967295u);
    bool loop_init_3 = true;
    while(true) {
        if (all(loop_bound_3 == uint2(0u, 0u))) { break; }
        loop_bound_3 -= uint2(loop_bound_3.y == 0u, 1u);
        if (!loop_init_3) {
            uint _e52 = group;
            group = (_e52 + 1u);
        }
        loop_init_3 = false;
        uint _e33 = group;
        uint _e36 = disc.groups;
        if ((_e33 < _e36)) {
        } else {
            break;
        }
        {
            uint _e41 = group;
            DiscHeader _e45 = disc;
            uint _e48 = place.x;
            uint _e49 = group;
            const float4 _e50 = disc_group(_e45, _e48, _e30, _e49);
            out_.Store4(((at + 1u) + _e41)*16, asuint(_e50));
        }
    }
    return;
}
