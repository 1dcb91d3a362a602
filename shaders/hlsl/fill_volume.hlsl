struct Taps {
    uint first;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float4 weight;
};

struct AerialHeader {
    float3 sun;
    float horizon;
    float3 up;
    float height;
    float3 forward;
    float top;
    float3 left;
    float bend;
    float3 white;
    float pole;
    float2 shrink;
    float2 crowding;
    uint3 intervals;
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
    int _pad3_0;
    float4 row;
    float4 column;
    float4 envelope;
    AerialWay way;
};

struct AerialNode {
    float4 light;
    float4 depth;
};

struct Aerial {
    float3 light;
    int _pad1_0;
    float3 factors;
    int _end_pad_0;
};

struct Volume {
    float3 axis;
    uint columns;
    float3 right;
    uint rows;
    float3 up;
    uint slices;
};

static const float WELKIN_PI = 3.1415927;
static const float AERIAL_BEYOND = 20.0;

ByteAddressBuffer welkin_table : register(t0);
cbuffer place : register(b0, space1) { uint4 place; }
cbuffer aerial : register(b1, space1) { AerialHeader aerial; }
cbuffer volume : register(b2, space1) { Volume volume; }
ByteAddressBuffer depths : register(t3, space1);
RWByteAddressBuffer light : register(u4, space1);
RWByteAddressBuffer factors_1 : register(u5, space1);

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
    float4 weight_2 = (float4(((s * s) * s), inner.x, inner.y, ((t * t) * t)) * 0.16666667);
    const Taps taps = ConstructTaps(naga_f2u32(cell), weight_2);
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
    float3 way_1 = (a - b);
    return min((0.5 * sqrt(dot(way_1, way_1))), 1.0);
}

float3 linear_srgb(float3 xyz)
{
    return float3(dot(xyz, float3(3.24097, -1.5373832, -0.49861076)), dot(xyz, float3(-0.96924365, 1.8759675, 0.04155506)), dot(xyz, float3(0.05563008, -0.20397696, 1.0569715)));
}

float aerial_measure(AerialHeader h, float rise, float distance_)
{
    float w = (distance_ * (rise + (distance_ * h.bend)));
    float p = sqrt((h.height + h.haze));
    float q = sqrt(max(((h.height + h.haze) + w), (0.5 * h.haze)));
    float turn = (distance_ / (p + q));
    return (turn / ((p * q) * (1.0 - ((h.bend * turn) * turn))));
}

AerialWay aerial_way(AerialHeader h_1, float z_3, uint side_2)
{
    AerialWay way = (AerialWay)0;

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
    const float _e81 = aerial_measure(h_1, _e78, _e80);
    way.rate = (h_1.nearness / _e81);
    AerialWay _e83 = way;
    const AerialWay aerialway = _e83;
    return aerialway;
}

AerialRay aerial_ray(AerialHeader h_2, uint first_2, float3 d_1)
{
    AerialRay ray = (AerialRay)0;

    float z_4 = clamp(dot(d_1, h_2.up), -1.0, 1.0);
    const uint _e9 = side_of(z_4, h_2.horizon);
    const float2 _e15 = azimuth_of(float2(dot(d_1, h_2.forward), dot(d_1, h_2.left)));
    const float _e20 = row_of(z_4, h_2.horizon, _e9, h_2.shrink, h_2.crowding, h_2.pole);
    const Taps _e27 = spline_taps((_e20 * float(h_2.intervals[min(uint(_e9), 2u)])), h_2.intervals[min(uint(_e9), 2u)]);
    const float _e29 = half_sine(_e15.x);
    const Taps _e36 = spline_taps((_e29 * float(h_2.intervals.z)), h_2.intervals.z);
    const float _e38 = half_chord(d_1, h_2.sun);
    const Taps _e43 = spline_taps((_e38 * float(h_2.sun_intervals)), h_2.sun_intervals);
    ray.columns = (h_2.intervals.z + 3u);
    uint _e59 = ray.columns;
    ray.cells = (((h_2.intervals.x + h_2.intervals.y) + 6u) * _e59);
    uint _e74 = ray.columns;
    ray.cell = ((((first_2 + h_2.sun_intervals) + 3u) + ((_e27.first + (_e9 * (h_2.intervals.x + 3u))) * _e74)) + _e36.first);
    ray.row = _e27.weight;
    ray.column = _e36.weight;
    const float4 _e87 = spline_line((first_2 + _e43.first), _e43.weight);
    ray.envelope = _e87;
    const AerialWay _e89 = aerial_way(h_2, z_4, _e9);
    ray.way = _e89;
    AerialRay _e90 = ray;
    const AerialRay aerialray = _e90;
    return aerialray;
}

AerialNode ConstructAerialNode(float4 arg0, float4 arg1) {
    AerialNode ret = (AerialNode)0;
    ret.light = arg0;
    ret.depth = arg1;
    return ret;
}

AerialNode aerial_node(AerialHeader h_3, AerialRay ray_1, uint node)
{
    uint cell_1 = (ray_1.cell + (node * ray_1.cells));
    uint depths_1 = ((h_3.distances + 3u) * ray_1.cells);
    const float4 _e15 = spline_surface(cell_1, ray_1.columns, ray_1.row, ray_1.column);
    const float4 _e20 = spline_surface((cell_1 + depths_1), ray_1.columns, ray_1.row, ray_1.column);
    const AerialNode aerialnode = ConstructAerialNode(_e15, _e20);
    return aerialnode;
}

Taps aerial_taps(AerialHeader h_4, AerialRay ray_2, float distance_1)
{
    const float _e9 = aerial_measure(h_4, ray_2.way.rise, clamp(distance_1, 0.0, ray_2.way.end));
    float share = min((log2((1.0 + (_e9 * ray_2.way.rate))) * h_4.per_stretch), 1.0);
    const Taps _e24 = spline_taps((share * float(h_4.distances)), h_4.distances);
    const Taps taps_1 = _e24;
    return taps_1;
}

Aerial ConstructAerial(float3 arg0, float3 arg1) {
    Aerial ret = (Aerial)0;
    ret.light = arg0;
    ret.factors = arg1;
    return ret;
}

Aerial aerial_below(Aerial seen, float3 depth, float times)
{
    float3 factors_2 = exp2((-(depth) * times));
    float3 more = (((1.0).xxx - factors_2) / max(((1.0).xxx - seen.factors), (1e-6).xxx));
    const Aerial aerial_1 = ConstructAerial((seen.light * ((depth < (0.001).xxx) ? (times).xxx : more)), factors_2);
    return aerial_1;
}

float3 ZeroValuefloat3() {
    return (float3)0;
}

Aerial aerial_blend(AerialHeader h_5, AerialRay ray_3, AerialNode nodes_1[4], float4 weight_1, float distance_2)
{
    bool local_1 = (bool)0;

    float way_2 = min(distance_2, ray_3.way.end);
    float4 light_1 = ((((nodes_1[0].light * weight_1.x) + (nodes_1[1].light * weight_1.y)) + (nodes_1[2].light * weight_1.z)) + (nodes_1[3].light * weight_1.w));
    float4 depth_1 = ((((nodes_1[0].depth * weight_1.x) + (nodes_1[1].depth * weight_1.y)) + (nodes_1[2].depth * weight_1.z)) + (nodes_1[3].depth * weight_1.w));
    float3 whole = (way_2 * max(depth_1.xyz, ZeroValuefloat3()));
    Aerial seen_1 = ConstructAerial((exp2((light_1 + ray_3.envelope).xyz) * way_2), exp2(-(whole)));
    if (ray_3.way.grounded) {
        local_1 = (distance_2 > way_2);
    } else {
        local_1 = false;
    }
    bool _e64 = local_1;
    if (_e64) {
        const Aerial _e66 = aerial_below(seen_1, whole, (distance_2 / way_2));
        const Aerial aerial_2 = _e66;
        return aerial_2;
    }
    const Aerial aerial_3 = seen_1;
    return aerial_3;
}

typedef AerialNode ret_Constructarray4_AerialNode_[4];
ret_Constructarray4_AerialNode_ Constructarray4_AerialNode_(AerialNode arg0, AerialNode arg1, AerialNode arg2, AerialNode arg3) {
    AerialNode ret[4] = { arg0, arg1, arg2, arg3 };
    return ret;
}

Aerial aerial_at(AerialHeader h_6, uint first_3, float3 d_2, float distance_3)
{
    const AerialRay _e4 = aerial_ray(h_6, first_3, d_2);
    const Taps _e5 = aerial_taps(h_6, _e4, distance_3);
    const AerialNode _e7 = aerial_node(h_6, _e4, _e5.first);
    const AerialNode _e11 = aerial_node(h_6, _e4, (_e5.first + 1u));
    const AerialNode _e15 = aerial_node(h_6, _e4, (_e5.first + 2u));
    const AerialNode _e19 = aerial_node(h_6, _e4, (_e5.first + 3u));
    AerialNode nodes_2[4] = Constructarray4_AerialNode_(_e7, _e11, _e15, _e19);
    const Aerial _e22 = aerial_blend(h_6, _e4, nodes_2, _e5.weight, distance_3);
    const Aerial aerial_4 = _e22;
    return aerial_4;
}

float3 aerial_srgb_factors(AerialHeader h_7, float3 factors)
{
    const float3 _e4 = linear_srgb((factors * h_7.white));
    const float3 _e6 = linear_srgb(h_7.white);
    return clamp((_e4 / _e6), ZeroValuefloat3(), (1.0).xxx);
}

[numthreads(8, 8, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    bool local = (bool)0;
    AerialNode nodes[4] = (AerialNode[4])0;
    uint next = 0u;
    uint slice = 0u;

    uint _e4 = volume.columns;
    if (!((id.x >= _e4))) {
        uint _e12 = volume.rows;
        local = (id.y >= _e12);
    } else {
        local = true;
    }
    bool _e15 = local;
    if (_e15) {
        return;
    }
    uint _e24 = volume.columns;
    float x_2 = ((float(((2u * id.x) + 1u)) / float(_e24)) - 1.0);
    uint _e37 = volume.rows;
    float y = (1.0 - (float(((2u * id.y) + 1u)) / float(_e37)));
    float3 _e44 = volume.axis;
    float3 _e47 = volume.right;
    float3 _e52 = volume.up;
    float3 way_3 = ((_e44 + (x_2 * _e47)) + (y * _e52));
    float stretch = length(way_3);
    AerialHeader _e57 = aerial;
    uint _e60 = place.x;
    const AerialRay _e63 = aerial_ray(_e57, _e60, (way_3 / (stretch).xxx));
    uint2 loop_bound = uint2(4294967295u, 4294967295u);
    bool loop_init = true;
    while(true) {
        if (all(loop_bound == uint2(0u, 0u))) { break; }
        loop_bound -= uint2(loop_bound.y == 0u, 1u);
        if (!loop_init) {
            uint _e140 = slice;
            slice = (_e140 + 1u);
        }
        loop_init = false;
        uint _e69 = slice;
        uint _e72 = volume.slices;
        if ((_e69 < _e72)) {
        } else {
            break;
        }
        {
            uint _e75 = slice;
            float _e77 = asfloat(depths.Load(_e75*4));
            float distance_4 = (_e77 * stretch);
            AerialHeader _e80 = aerial;
            const Taps _e81 = aerial_taps(_e80, _e63, distance_4);
            uint _e82 = next;
            next = max(_e82, _e81.first);
            uint2 loop_bound_1 = uint2(4294967295u, 4294967295u);
            while(true) {
                if (all(loop_bound_1 == uint2(0u, 0u))) { break; }
                loop_bound_1 -= uint2(loop_bound_1.y == 0u, 1u);
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
                    AerialHeader _e101 = aerial;
                    uint _e102 = next;
                    const AerialNode _e103 = aerial_node(_e101, _e63, _e102);
                    nodes[3] = _e103;
                    uint _e105 = next;
                    next = (_e105 + 1u);
                }
            }
            AerialHeader _e108 = aerial;
            AerialNode _e109[4] = nodes;
            const Aerial _e111 = aerial_blend(_e108, _e63, _e109, _e81.weight, distance_4);
            uint _e115 = volume.columns;
            uint _e121 = volume.slices;
            uint _e123 = slice;
            uint at = ((((id.y * _e115) + id.x) * _e121) + _e123);
            const float3 _e128 = linear_srgb(_e111.light);
            light.Store4(at*16, asuint(float4(_e128, 0.0)));
            AerialHeader _e134 = aerial;
            const float3 _e136 = aerial_srgb_factors(_e134, _e111.factors);
            factors_1.Store4(at*16, asuint(float4(_e136, 0.0)));
        }
    }
    return;
}
