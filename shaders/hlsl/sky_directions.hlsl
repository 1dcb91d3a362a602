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

static const float WELKIN_PI = 3.1415927;

ByteAddressBuffer welkin_table : register(t0);
cbuffer place : register(b0, space1) { uint4 place; }
cbuffer sky : register(b1, space1) { SkyHeader sky; }
ByteAddressBuffer directions : register(t2, space1);
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

float4 sky_group(SkyHeader h_3, uint first_3, SkyPoint point_2, uint group_1)
{
    uint envelope = (h_3.sun_intervals + 3u);
    uint cells = ((first_3 + (h_3.groups * envelope)) + (group_1 * point_2.cells));
    const float4 _e20 = spline_line(((first_3 + (group_1 * envelope)) + point_2.angle.first), point_2.angle.weight);
    const float4 _e26 = spline_surface((cells + point_2.cell), point_2.columns, point_2.row, point_2.column);
    float4 logarithm = (_e20 + _e26);
    const uint _e32 = sky_scale(h_3, first_3, point_2);
    float4 _e35 = asfloat(welkin_table.Load4((_e32 + group_1)*16));
    return ((exp2(logarithm) * point_2.opacity) * _e35);
}

typedef float4 ret_Constructarray2_float4_[2];
ret_Constructarray2_float4_ Constructarray2_float4_(float4 arg0, float4 arg1) {
    float4 ret[2] = { arg0, arg1 };
    return ret;
}

typedef float4 ret_sky_polarisation[2];
ret_sky_polarisation sky_polarisation(SkyHeader h_4, uint first_4, SkyPoint point_3, uint group_2)
{
    uint q = (((first_4 + (h_4.groups * ((h_4.sun_intervals + 3u) + point_3.cells))) + ((2u * group_2) * point_3.cells)) + point_3.cell);
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
    SkyHeader _e6 = sky;
    float4 _e10 = asfloat(directions.Load4(id.x*16));
    const SkyPoint _e13 = sky_point(_e6, normalize(_e10.xyz));
    uint _e16 = sky.groups;
    uint _e21 = sky.polarised;
    uint stride_1 = (_e16 * (1u + (2u * _e21)));
    uint2 loop_bound = uint2(4294967295u, 4294967295u);
    bool loop_init = true;
    while(true) {
        if (all(loop_bound == uint2(0u, 0u))) { break; }
        loop_bound -= uint2(loop_bound.y == 0u, 1u);
        if (!loop_init) {
            uint _e76 = group;
            group = (_e76 + 1u);
        }
        loop_init = false;
        uint _e27 = group;
        uint _e30 = sky.groups;
        if ((_e27 < _e30)) {
        } else {
            break;
        }
        {
            uint _e34 = group;
            uint _e39 = sky.polarised;
            uint at = ((id.x * stride_1) + (_e34 * (1u + (2u * _e39))));
            SkyHeader _e47 = sky;
            uint _e50 = place.x;
            uint _e51 = group;
            const float4 _e52 = sky_group(_e47, _e50, _e13, _e51);
            out_.Store4(at*16, asuint(_e52));
            uint _e55 = sky.polarised;
            if ((_e55 != 0u)) {
                SkyHeader _e59 = sky;
                uint _e62 = place.x;
                uint _e63 = group;
                const float4 _e64[2] = sky_polarisation(_e59, _e62, _e13, _e63);
                out_.Store4((at + 1u)*16, asuint(_e64[0]));
                out_.Store4((at + 2u)*16, asuint(_e64[1]));
            }
        }
    }
    return;
}
