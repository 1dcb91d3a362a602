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

struct SamplerHeader {
    float2 azimuth;
    float2 shrink;
    float horizon;
    float share;
    uint2 rows;
    uint columns;
    uint unused_a;
    uint unused_b;
    uint layout_version;
};

struct SkyDraw {
    float3 direction;
    float pdf;
    bool disc;
    int _end_pad_0;
    int _end_pad_1;
    int _end_pad_2;
};

struct Drawn {
    uint index;
    float rest;
};

struct Request {
    float2 numbers;
    float2 unused;
    float4 direction;
};

static const float WELKIN_PI = 3.1415927;

ByteAddressBuffer welkin_table : register(t0);
cbuffer place_1 : register(b0, space1) { uint4 place_1; }
cbuffer sampler_header : register(b1, space1) { SamplerHeader sampler_header; }
cbuffer disc_2 : register(b2, space1) { DiscHeader disc_2; }
ByteAddressBuffer requests : register(t3, space1);
RWByteAddressBuffer out_ : register(u4, space1);

float2 quarter_turn(float x)
{
    float t_1 = (x - 0.7853982);
    float s = (t_1 * t_1);
    float sine = (t_1 * (1.0 - (s * (0.16666667 - (s * (0.008333334 - (s * (0.0001984127 - (s / 362880.0)))))))));
    float cosine_1 = (1.0 - (s * (0.5 - (s * (0.041666668 - (s * (0.0013888889 - (s / 40320.0))))))));
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

float disc_square(DiscHeader h, float3 d_1)
{
    float3 way_1 = ((d_1 - h.centre) / (h.chord).xxx);
    return dot(way_1, way_1);
}

float4 disc_weights(float u)
{
    float b_1 = (u - 1.0);
    float c_1 = (u - 2.0);
    float d_6 = (u - 3.0);
    return float4((((b_1 * c_1) * d_6) * -0.16666667), (((u * c_1) * d_6) * 0.5), (((u * b_1) * d_6) * -0.5), (((u * b_1) * c_1) * 0.16666667));
}

uint naga_f2u32(float value) {
    return uint(clamp(value, 0.0, 4294967000.0));
}

DiscPoint disc_point(DiscHeader h_1, float3 d_2)
{
    DiscPoint point_ = (DiscPoint)0;
    bool local = (bool)0;
    bool local_1 = (bool)0;

    const float _e3 = disc_square(h_1, d_2);
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
    float sine_2 = ((d_2.z * h_1.lowest.x) - (length(d_2.xy) * h_1.lowest.y));
    float elevation = (sine_2 + (((sine_2 * sine_2) * sine_2) * 0.16666667));
    float u_1 = clamp((elevation * h_1.nodes_per_radian), 0.0, float((h_1.nodes - 1u)));
    if (!((h_1.cut == 0u))) {
        local_1 = (sine_2 >= 0.0);
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

float4 disc_relative(DiscHeader h_2, uint first, DiscPoint point_1, uint group)
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
            float4 _e27 = asfloat(welkin_table.Load4(((first + ((point_1.node + _e20) * h_2.groups)) + group)*16));
            depth = (_e14 + (point_1.weight[min(uint(_e16), 3u)] * _e27));
        }
    }
    uint profile = ((first + (h_2.nodes * h_2.groups)) + (6u * group));
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

uint disc_weight(DiscHeader h_3, uint first_1, uint group_1)
{
    return ((first_1 + ((h_3.nodes + 6u) * h_3.groups)) + (4u * group_1));
}

float4 disc_group(DiscHeader h_4, uint first_2, DiscPoint point_2, uint group_2)
{
    const float4 _e4 = disc_relative(h_4, first_2, point_2, group_2);
    const uint _e6 = disc_weight(h_4, first_2, group_2);
    float4 _e10 = asfloat(welkin_table.Load4((_e6 + 3u)*16));
    return (_e4 * _e10);
}

float3 ZeroValuefloat3() {
    return (float3)0;
}

float3 disc_xyz(DiscHeader h_5, uint first_3, float3 d_3)
{
    float3 xyz = ZeroValuefloat3();
    uint group_3 = 0u;

    const DiscPoint _e3 = disc_point(h_5, d_3);
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
            const float4 _e15 = disc_relative(h_5, first_3, _e3, _e14);
            uint _e16 = group_3;
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

float segment_angle(float area)
{
    float e = (float)0;
    int i_1 = int(0);

    float bounded = clamp(area, 0.0, WELKIN_PI);
    float small = min(bounded, (WELKIN_PI - bounded));
    float s_1 = ((small < 1e-30) ? 0.0 : pow((12.0 * small), 0.33333334));
    float q = (s_1 * s_1);
    float series = (0.0007142857 + (q * (3.9682538e-5 + (q * 2.4930428e-6))));
    e = (s_1 * (1.0 + (q * (0.016666668 + (q * series)))));
    float _e31 = e;
    if ((_e31 > 0.5)) {
        uint2 loop_bound_3 = uint2(4294967295u, 4294967295u);
        bool loop_init_3 = true;
        while(true) {
            if (all(loop_bound_3 == uint2(0u, 0u))) { break; }
            loop_bound_3 -= uint2(loop_bound_3.y == 0u, 1u);
            if (!loop_init_3) {
                int _e56 = i_1;
                i_1 = asint(asuint(_e56) + asuint(int(1)));
            }
            loop_init_3 = false;
            int _e36 = i_1;
            if ((_e36 < int(2))) {
            } else {
                break;
            }
            {
                float _e39 = e;
                const float2 _e42 = half_turn(min(_e39, WELKIN_PI));
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

float3 disc_draw(DiscHeader h_6, float2 numbers)
{
    float2 place = (float2)0;

    const float _e7 = segment_angle(((1.0 - numbers.x) * h_6.area));
    const float2 _e8 = half_turn(_e7);
    place = float2((((2.0 * numbers.y) - 1.0) * _e8.y), _e8.x);
    float2 _e19 = place;
    float radius = length(_e19);
    float2 _e21 = place;
    place = (_e21 * ((radius > (1.0 - h_6.margin)) ? ((1.0 - h_6.margin) / radius) : 1.0));
    float2 _e36 = place;
    float2 _e37 = place;
    float square_1 = ((h_6.chord * h_6.chord) * dot(_e36, _e37));
    float2 _e40 = place;
    place = (_e40 * (h_6.chord * sqrt(max((1.0 - (0.25 * square_1)), 0.0))));
    float _e59 = place.x;
    float _e64 = place.y;
    return (((h_6.centre * (1.0 - (0.5 * square_1))) + (h_6.left * _e59)) + (h_6.up * _e64));
}

float disc_density(DiscHeader h_7, float3 d_4)
{
    bool local_2 = (bool)0;
    bool local_3 = (bool)0;

    float reach = (1.0 + h_7.margin);
    float height = dot((d_4 - h_7.centre), h_7.up);
    if ((h_7.visible != 0u)) {
        const float _e14 = disc_square(h_7, d_4);
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

uint naga_div(uint lhs, uint rhs) {
    return lhs / (rhs == 0u ? 1u : rhs);
}

uint naga_mod(uint lhs, uint rhs) {
    return lhs % (rhs == 0u ? 1u : rhs);
}

float sampler_number(uint first_4, uint i_2)
{
    float _e10 = asfloat(welkin_table.Load(naga_mod(i_2, 4u)*4+(first_4 + naga_div(i_2, 4u))*16));
    return _e10;
}

float into_unit(float x_2)
{
    return clamp(x_2, 0.0, 0.99999994);
}

Drawn ConstructDrawn(uint arg0, float arg1) {
    Drawn ret = (Drawn)0;
    ret.index = arg0;
    ret.rest = arg1;
    return ret;
}

Drawn sampler_find(uint first_5, uint edges, uint count, float x_3)
{
    uint low = 0u;
    uint high = (uint)0;

    high = count;
    uint2 loop_bound_4 = uint2(4294967295u, 4294967295u);
    while(true) {
        if (all(loop_bound_4 == uint2(0u, 0u))) { break; }
        loop_bound_4 -= uint2(loop_bound_4.y == 0u, 1u);
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
            const float _e18 = sampler_number(first_5, (edges + middle));
            if ((_e18 <= x_3)) {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
    uint _e20 = low;
    const float _e22 = sampler_number(first_5, (edges + _e20));
    uint _e23 = low;
    const float _e27 = sampler_number(first_5, ((edges + _e23) + 1u));
    float width = (_e27 - _e22);
    uint _e29 = low;
    const Drawn drawn = ConstructDrawn(_e29, ((width > 0.0) ? ((x_3 - _e22) / width) : 0.5));
    return drawn;
}

float sampler_mix(uint first_6, uint edge, float t)
{
    const float _e3 = sampler_number(first_6, edge);
    const float _e6 = sampler_number(first_6, (edge + 1u));
    return (_e3 + (t * (_e6 - _e3)));
}

float3 sampler_sky(SamplerHeader h_8, uint first_7, float2 numbers_1)
{
    uint rows = (h_8.rows.x + h_8.rows.y);
    uint azimuths = (2u * rows);
    const Drawn _e15 = sampler_find(first_7, ((azimuths + h_8.columns) + 1u), rows, numbers_1.x);
    bool right = (numbers_1.y >= 0.5);
    const float _e28 = into_unit((right ? ((2.0 * numbers_1.y) - 1.0) : (2.0 * numbers_1.y)));
    uint columns = ((((azimuths + h_8.columns) + 1u) + rows) + 1u);
    const Drawn _e43 = sampler_find(first_7, (columns + (_e15.index * (h_8.columns + 1u))), h_8.columns, _e28);
    const float _e48 = sampler_mix(first_7, (2u * _e15.index), _e15.rest);
    const float _e52 = sampler_mix(first_7, (azimuths + _e43.index), _e43.rest);
    const float2 _e53 = half_turn(_e52);
    float2 level = (sqrt(max((1.0 - (_e48 * _e48)), 0.0)) * float2(_e53.x, (right ? -(_e53.y) : _e53.y)));
    return float3(((level.x * h_8.azimuth.x) - (level.y * h_8.azimuth.y)), ((level.x * h_8.azimuth.y) + (level.y * h_8.azimuth.x)), _e48);
}

float sampler_pdf(SamplerHeader h_9, uint first_8, DiscHeader disc, float3 d_5)
{
    const uint _e6 = side_of(d_5.z, h_9.horizon);
    const float _e9 = pole_cosine(d_5.z, _e6, h_9.shrink);
    float height_1 = sqrt((1.0 - _e9));
    uint row = (min(naga_f2u32((height_1 * float(h_9.rows[min(uint(_e6), 1u)]))), (h_9.rows[min(uint(_e6), 1u)] - 1u)) + (_e6 * h_9.rows.x));
    float2 turned = float2(dot(d_5.xy, h_9.azimuth), ((d_5.y * h_9.azimuth.x) - (d_5.x * h_9.azimuth.y)));
    const float2 _e40 = azimuth_of(turned);
    const float _e42 = half_sine(_e40.x);
    uint column = min(naga_f2u32((_e42 * float(h_9.columns))), (h_9.columns - 1u));
    uint rows_1 = (h_9.rows.x + h_9.rows.y);
    uint density = ((((((2u * rows_1) + h_9.columns) + 1u) + rows_1) + 1u) + (rows_1 * (h_9.columns + 1u)));
    const float _e74 = sampler_number(first_8, ((density + (row * h_9.columns)) + column));
    if ((h_9.share <= 0.0)) {
        return _e74;
    }
    const float _e83 = disc_density(disc, d_5);
    return (((1.0 - h_9.share) * _e74) + (h_9.share * _e83));
}

SkyDraw sampler_draw(SamplerHeader h_10, uint first_9, DiscHeader disc_1, float2 numbers_2)
{
    SkyDraw draw = (SkyDraw)0;
    float x_4 = (float)0;

    const float _e6 = into_unit(numbers_2.x);
    x_4 = _e6;
    const float _e9 = into_unit(numbers_2.y);
    float _e11 = x_4;
    draw.disc = (_e11 < h_10.share);
    bool _e15 = draw.disc;
    if (_e15) {
        float _e17 = x_4;
        const float3 _e21 = disc_draw(disc_1, float2((_e17 / h_10.share), _e9));
        draw.direction = _e21;
    } else {
        float _e22 = x_4;
        const float _e29 = into_unit(((_e22 - h_10.share) / (1.0 - h_10.share)));
        x_4 = _e29;
        float _e31 = x_4;
        const float3 _e33 = sampler_sky(h_10, first_9, float2(_e31, _e9));
        draw.direction = _e33;
    }
    float3 _e36 = draw.direction;
    const float _e37 = sampler_pdf(h_10, first_9, disc_1, _e36);
    draw.pdf = _e37;
    SkyDraw _e38 = draw;
    const SkyDraw skydraw = _e38;
    return skydraw;
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
    if ((id.x >= ((NagaBufferLength(requests) - 0) / 32))) {
        return;
    }
    SamplerHeader _e6 = sampler_header;
    uint _e9 = place_1.x;
    DiscHeader _e11 = disc_2;
    float2 _e16 = asfloat(requests.Load2(0+id.x*32));
    const SkyDraw _e17 = sampler_draw(_e6, _e9, _e11, _e16);
    float4 _e22 = asfloat(requests.Load4(16+id.x*32));
    float3 d_7 = normalize(_e22.xyz);
    out_.Store4((2u * id.x)*16, asuint(float4(_e17.direction, _e17.pdf)));
    SamplerHeader _e41 = sampler_header;
    uint _e44 = place_1.x;
    DiscHeader _e46 = disc_2;
    const float _e47 = sampler_pdf(_e41, _e44, _e46, d_7);
    out_.Store4(((2u * id.x) + 1u)*16, asuint(float4(_e47, (_e17.disc ? 1.0 : 0.0), 0.0, 0.0)));
    return;
}
