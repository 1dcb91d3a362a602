struct Taps {
    uint first;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float4 weight;
};

struct SkyHeader {
    float3 sun;
    float horizon;
    float2 azimuth;
    float2 shrink;
    float2 crowding;
    float pole;
    float opaque_length;
    uint3 intervals;
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
    int _pad3_0;
    Taps angle;
    float4 row;
    float4 column;
    float opacity;
    float sine;
    int _end_pad_0;
    int _end_pad_1;
};

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

static const float WELKIN_PI = 3.1415927;

ByteAddressBuffer welkin_table : register(t0);
cbuffer place : register(b0, space1) { uint4 place; }
cbuffer sky : register(b1, space1) { SkyHeader sky; }
cbuffer disc : register(b2, space1) { DiscHeader disc; }
RWByteAddressBuffer out_ : register(u3, space1);

Taps ConstructTaps(uint arg0, float4 arg1) {
    Taps ret = (Taps)0;
    ret.first = arg0;
    ret.weight = arg1;
    return ret;
}

uint naga_f2u32(float value) {
    return uint(clamp(value, 0.0, 4294967000.0));
}

Taps spline_taps(float u, uint intervals)
{
    float cell = clamp(floor(u), 0.0, (float(intervals) - 1.0));
    float t = (u - cell);
    float s = (1.0 - t);
    float2 inner = (float2(((t * t) * ((t * 3.0) - 6.0)), ((s * s) * ((s * 3.0) - 6.0))) + (4.0).xx);
    float4 weight_1 = (float4(((s * s) * s), inner.x, inner.y, ((t * t) * t)) * 0.16666667);
    const Taps taps = ConstructTaps(naga_f2u32(cell), weight_1);
    return taps;
}

float4 spline_line(uint first, float4 weight)
{
    float4 _e4 = asfloat(welkin_table.Load4(first*16));
    float4 _e11 = asfloat(welkin_table.Load4((first + 1u)*16));
    float4 _e19 = asfloat(welkin_table.Load4((first + 2u)*16));
    float4 _e26 = asfloat(welkin_table.Load4((first + 3u)*16));
    return (((_e4 * weight.x) + (_e11 * weight.y)) + ((_e19 * weight.z) + (_e26 * weight.w)));
}

float4 spline_surface(uint first_1, uint stride, float4 rows, float4 columns)
{
    const float4 _e4 = spline_line(first_1, columns);
    const float4 _e8 = spline_line((first_1 + stride), columns);
    const float4 _e15 = spline_line((first_1 + (2u * stride)), columns);
    const float4 _e22 = spline_line((first_1 + (3u * stride)), columns);
    return ((((_e4 * rows.x) + (_e8 * rows.y)) + (_e15 * rows.z)) + (_e22 * rows.w));
}

float2 quarter_turn(float x)
{
    float t_1 = (x - 0.7853982);
    float s_1 = (t_1 * t_1);
    float sine = (t_1 * (1.0 - (s_1 * (0.16666667 - (s_1 * (0.008333334 - (s_1 * (0.0001984127 - (s_1 / 362880.0)))))))));
    float cosine_1 = (1.0 - (s_1 * (0.5 - (s_1 * (0.041666668 - (s_1 * (0.0013888889 - (s_1 / 40320.0))))))));
    return (float2((cosine_1 - sine), (cosine_1 + sine)) * 0.70710677);
}

float2 half_turn(float x_1)
{
    const float2 _e3 = quarter_turn((0.5 * x_1));
    return float2(((_e3.x - _e3.y) * (_e3.x + _e3.y)), ((2.0 * _e3.x) * _e3.y));
}

uint side_of(float z, float horizon)
{
    return ((z >= horizon) ? 0u : 1u);
}

float pole_cosine(float z_1, uint side, float2 shrink)
{
    float sign_ = (1.0 - (2.0 * float(side)));
    return sqrt(clamp(((1.0 - (sign_ * z_1)) * shrink[min(uint(side), 1u)]), 0.0, 1.0));
}

float row_of(float z_2, float horizon_1, uint side_1, float2 shrink_1, float2 crowding, float pole)
{
    float sine_1 = sqrt(min((abs((z_2 - horizon_1)) * shrink_1[min(uint(side_1), 1u)]), 1.0));
    const float _e13 = pole_cosine(z_2, side_1, shrink_1);
    float c = crowding[min(uint(side_1), 1u)];
    return (((c * sine_1) + sine_1) / ((c * sine_1) + ((_e13 * pole) + 1.0)));
}

float2 azimuth_of(float2 d)
{
    float square = dot(d, d);
    if ((square < 1e-37)) {
        return float2(1.0, 0.0);
    }
    return (d / (sqrt(square)).xx);
}

float half_sine(float cosine)
{
    return sqrt(clamp((0.5 - (0.5 * cosine)), 0.0, 1.0));
}

float half_chord(float3 a, float3 b)
{
    float3 way = (a - b);
    return min((0.5 * sqrt(dot(way, way))), 1.0);
}

float3 linear_srgb(float3 xyz)
{
    return float3(dot(xyz, float3(3.24097, -1.5373832, -0.49861076)), dot(xyz, float3(-0.96924365, 1.8759675, 0.04155506)), dot(xyz, float3(0.05563008, -0.20397696, 1.0569715)));
}

float sky_opacity(SkyHeader h, float z_3, uint side_2)
{
    float root = (sqrt(max(((z_3 + h.horizon) * (z_3 - h.horizon)), 0.0)) + abs(z_3));
    return ((side_2 == 0u) ? 1.0 : (h.opaque_length / (h.opaque_length + max(root, 1e-20))));
}

SkyPoint sky_point(SkyHeader h_1, float3 d_1)
{
    SkyPoint point_ = (SkyPoint)0;

    const uint _e4 = side_of(d_1.z, h_1.horizon);
    float2 turned = float2(dot(d_1.xy, h_1.azimuth), ((d_1.y * h_1.azimuth.x) - (d_1.x * h_1.azimuth.y)));
    const float2 _e18 = azimuth_of(turned);
    const float _e24 = row_of(d_1.z, h_1.horizon, _e4, h_1.shrink, h_1.crowding, h_1.pole);
    const Taps _e31 = spline_taps((_e24 * float(h_1.intervals[min(uint(_e4), 2u)])), h_1.intervals[min(uint(_e4), 2u)]);
    const float _e33 = half_sine(_e18.x);
    const Taps _e40 = spline_taps((_e33 * float(h_1.intervals.z)), h_1.intervals.z);
    uint columns_1 = (h_1.intervals.z + 3u);
    point_.cell = (((_e31.first + (_e4 * (h_1.intervals.x + 3u))) * columns_1) + _e40.first);
    point_.columns = columns_1;
    point_.cells = (((h_1.intervals.x + h_1.intervals.y) + 6u) * columns_1);
    const float _e69 = half_chord(d_1, h_1.sun);
    const Taps _e74 = spline_taps((_e69 * float(h_1.sun_intervals)), h_1.sun_intervals);
    point_.angle = _e74;
    point_.row = _e31.weight;
    point_.column = _e40.weight;
    const float _e81 = sky_opacity(h_1, d_1.z, _e4);
    point_.opacity = _e81;
    point_.sine = _e18.y;
    SkyPoint _e84 = point_;
    const SkyPoint skypoint = _e84;
    return skypoint;
}

uint sky_scale(SkyHeader h_2, uint first_2, SkyPoint point_1)
{
    return (first_2 + (h_2.groups * ((h_2.sun_intervals + 3u) + (point_1.cells * (1u + (2u * h_2.polarised))))));
}

float4 sky_group(SkyHeader h_3, uint first_3, SkyPoint point_2, uint group)
{
    uint envelope = (h_3.sun_intervals + 3u);
    uint cells = ((first_3 + (h_3.groups * envelope)) + (group * point_2.cells));
    const float4 _e20 = spline_line(((first_3 + (group * envelope)) + point_2.angle.first), point_2.angle.weight);
    const float4 _e26 = spline_surface((cells + point_2.cell), point_2.columns, point_2.row, point_2.column);
    float4 logarithm = (_e20 + _e26);
    const uint _e32 = sky_scale(h_3, first_3, point_2);
    float4 _e35 = asfloat(welkin_table.Load4((_e32 + group)*16));
    return ((exp2(logarithm) * point_2.opacity) * _e35);
}

typedef float4 ret_Constructarray2_float4_[2];
ret_Constructarray2_float4_ Constructarray2_float4_(float4 arg0, float4 arg1) {
    float4 ret[2] = { arg0, arg1 };
    return ret;
}

typedef float4 ret_sky_polarisation[2];
ret_sky_polarisation sky_polarisation(SkyHeader h_4, uint first_4, SkyPoint point_3, uint group_1)
{
    uint q = (((first_4 + (h_4.groups * ((h_4.sun_intervals + 3u) + point_3.cells))) + ((2u * group_1) * point_3.cells)) + point_3.cell);
    const float4 _e22 = spline_surface(q, point_3.columns, point_3.row, point_3.column);
    const float4 _e28 = spline_surface((q + point_3.cells), point_3.columns, point_3.row, point_3.column);
    float4 other = (_e28 * point_3.sine);
    float4 shrink_2 = rsqrt(max(((_e22 * _e22) + (other * other)), (1.0).xxxx));
    return Constructarray2_float4_((_e22 * shrink_2), (other * shrink_2));
}

float3 sky_xyz(SkyHeader h_5, uint first_5, float3 d_2)
{
    const SkyPoint _e3 = sky_point(h_5, d_2);
    const float4 _e5 = sky_group(h_5, first_5, _e3, 0u);
    return _e5.xyz;
}

float disc_square(DiscHeader h_6, float3 d_3)
{
    float3 way_1 = ((d_3 - h_6.centre) / (h_6.chord).xxx);
    return dot(way_1, way_1);
}

float4 disc_weights(float u_1)
{
    float b_1 = (u_1 - 1.0);
    float c_1 = (u_1 - 2.0);
    float d_6 = (u_1 - 3.0);
    return float4((((b_1 * c_1) * d_6) * -0.16666667), (((u_1 * c_1) * d_6) * 0.5), (((u_1 * b_1) * d_6) * -0.5), (((u_1 * b_1) * c_1) * 0.16666667));
}

DiscPoint disc_point(DiscHeader h_7, float3 d_4)
{
    DiscPoint point_4 = (DiscPoint)0;
    bool local_1 = (bool)0;
    bool local_2 = (bool)0;

    const float _e3 = disc_square(h_7, d_4);
    if (!((h_7.visible == 0u))) {
        local_1 = (_e3 > 1.0);
    } else {
        local_1 = true;
    }
    bool _e13 = local_1;
    if (_e13) {
        DiscPoint _e14 = point_4;
        const DiscPoint discpoint = _e14;
        return discpoint;
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
    point_4.node = (naga_f2u32(clamp(u_2, 1.0, float((h_7.nodes - 3u)))) - 1u);
    uint _e61 = point_4.node;
    const float4 _e64 = disc_weights((u_2 - float(_e61)));
    point_4.weight = _e64;
    point_4.mu = sqrt((1.0 - _e3));
    DiscPoint _e69 = point_4;
    const DiscPoint discpoint_1 = _e69;
    return discpoint_1;
}

float4 ZeroValuefloat4() {
    return (float4)0;
}

float4 disc_relative(DiscHeader h_8, uint first_6, DiscPoint point_5, uint group_2)
{
    float4 depth = ZeroValuefloat4();
    uint k = 0u;
    float4 limb = (float4)0;
    uint i = 5u;

    if (!(point_5.seen)) {
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
            float4 _e27 = asfloat(welkin_table.Load4(((first_6 + ((point_5.node + _e20) * h_8.groups)) + group_2)*16));
            depth = (_e14 + (point_5.weight[min(uint(_e16), 3u)] * _e27));
        }
    }
    uint profile = ((first_6 + (h_8.nodes * h_8.groups)) + (6u * group_2));
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
            limb = ((_e51 * point_5.mu) + _e60);
        }
    }
    float4 _e65 = depth;
    float4 _e72 = limb;
    return ((exp(-(max(_e65, ZeroValuefloat4()))) * h_8.mean) * _e72);
}

uint disc_weight(DiscHeader h_9, uint first_7, uint group_3)
{
    return ((first_7 + ((h_9.nodes + 6u) * h_9.groups)) + (4u * group_3));
}

float4 disc_group(DiscHeader h_10, uint first_8, DiscPoint point_6, uint group_4)
{
    const float4 _e4 = disc_relative(h_10, first_8, point_6, group_4);
    const uint _e6 = disc_weight(h_10, first_8, group_4);
    float4 _e10 = asfloat(welkin_table.Load4((_e6 + 3u)*16));
    return (_e4 * _e10);
}

float3 ZeroValuefloat3() {
    return (float3)0;
}

float3 disc_xyz(DiscHeader h_11, uint first_9, float3 d_5)
{
    float3 xyz_1 = ZeroValuefloat3();
    uint group_5 = 0u;

    const DiscPoint _e3 = disc_point(h_11, d_5);
    if (!(_e3.seen)) {
        float3 _e8 = xyz_1;
        return _e8;
    }
    uint2 loop_bound_2 = uint2(4294967295u, 4294967295u);
    bool loop_init_2 = true;
    while(true) {
        if (all(loop_bound_2 == uint2(0u, 0u))) { break; }
        loop_bound_2 -= uint2(loop_bound_2.y == 0u, 1u);
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
            const float4 _e15 = disc_relative(h_11, first_9, _e3, _e14);
            uint _e16 = group_5;
            const uint _e17 = disc_weight(h_11, first_9, _e16);
            float3 _e18 = xyz_1;
            float4 _e21 = asfloat(welkin_table.Load4(_e17*16));
            float4 _e27 = asfloat(welkin_table.Load4((_e17 + 1u)*16));
            float4 _e33 = asfloat(welkin_table.Load4((_e17 + 2u)*16));
            xyz_1 = (_e18 + float3(dot(_e15, _e21), dot(_e15, _e27), dot(_e15, _e33)));
        }
    }
    float3 _e40 = xyz_1;
    return _e40;
}

[numthreads(8, 8, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    bool local = (bool)0;

    uint _e4 = place.z;
    if (!((id.x >= _e4))) {
        uint _e12 = place.z;
        local = (id.y >= _e12);
    } else {
        local = true;
    }
    bool _e15 = local;
    if (_e15) {
        return;
    }
    uint _e23 = place.z;
    float2 spot = (((float2(id.xy) + (0.5).xx) * (2.0 / float(_e23))) - (1.0).xx);
    float radius = length(spot);
    if ((radius >= 1.0)) {
        uint _e38 = place.z;
        out_.Store4(((id.y * _e38) + id.x)*16, asuint(ZeroValuefloat4()));
        return;
    }
    const float2 _e48 = half_turn(((radius * 0.5) * WELKIN_PI));
    float2 level = (float2(-(spot.y), spot.x) * (_e48.y / max(radius, 1e-9)));
    float3 d_7 = float3(level, _e48.x);
    SkyHeader _e61 = sky;
    uint _e64 = place.x;
    const float3 _e65 = sky_xyz(_e61, _e64, d_7);
    DiscHeader _e67 = disc;
    uint _e70 = place.y;
    const float3 _e71 = disc_xyz(_e67, _e70, d_7);
    float3 xyz_2 = (_e65 + _e71);
    uint _e77 = place.z;
    const float3 _e82 = linear_srgb(xyz_2);
    out_.Store4(((id.y * _e77) + id.x)*16, asuint(float4(_e82, 1.0)));
    return;
}
