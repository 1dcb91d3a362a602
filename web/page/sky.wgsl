struct Values {
values: array<vec4<f32>, 27>,
}

struct Light {
root: vec3<f32>,
q: vec3<f32>,
u: vec3<f32>,
}

struct FragmentOutput {
@location(0) colour: vec4<f32>,
}

const PI: f32 = 3.1415927f;
const HEIGHT_SCALE: f32 = 0.06f;
const AZIMUTH_SCALE: f32 = 0.8f;

@group(0) @binding(0)
var<uniform> global: Values;
@group(0) @binding(1)
var roots: texture_2d<f32>;
@group(0) @binding(2)
var degrees_: texture_2d<f32>;
@group(0) @binding(3)
var slopes: texture_2d<f32>;
@group(0) @binding(4)
var normals: texture_2d<f32>;
@group(0) @binding(5)
var shadows: texture_2d<f32>;
@group(0) @binding(6)
var air: texture_2d<f32>;
@group(0) @binding(7)
var sunlight: texture_2d<f32>;
@group(0) @binding(8)
var disc: texture_2d<f32>;
var<private> colour_1: vec4<f32>;
var<private> place_in_picture: vec4<f32>;
var<private> size: vec2<f32>;
var<private> projection: i32;
var<private> axes: mat3x3<f32>;
var<private> half_field: f32;
var<private> horizon: vec4<f32>;
var<private> ends: vec3<f32>;
var<private> intervals: vec3<i32>;
var<private> sun_1: vec2<f32>;
var<private> quantity: i32;
var<private> polariser: f32;
var<private> has_polariser: bool;
var<private> white: f32;
var<private> tone: i32;
var<private> is_daylight: bool;
var<private> land: array<vec4<f32>, 6>;
var<private> land_sun: vec3<f32>;
var<private> disc_axis: vec4<f32>;
var<private> disc_sun: vec3<f32>;
var<private> disc_box: vec4<f32>;
var<private> disc_parts: i32;
var<private> gl_FragCoord_1: vec4<f32>;

fn look(pixel: vec2<f32>, local: ptr<function, vec3<f32>>) -> bool {
var pixel_1: vec2<f32>;
var place: vec2<f32>;
var angle: vec2<f32>;
var radius: f32;
var angle_1: f32;
var local_1: f32;

pixel_1 = pixel;
let _e36 = pixel_1;
let _e37 = size;
place = (((_e36 / _e37) * 2f) - vec2(1f));
let _e45 = projection;
if (_e45 == 2i) {
{
let _e48 = place;
let _e51 = place;
angle = vec2<f32>((_e48.x * PI), ((_e51.y * 0.5f) * PI));
let _e58 = angle;
let _e61 = angle;
let _e65 = angle;
let _e68 = angle;
let _e71 = angle;
(*local) = vec3<f32>((cos(_e58.y) * sin(_e61.x)), sin(_e65.y), (cos(_e68.y) * cos(_e71.x)));
return true;
}
}
let _e77 = projection;
if (_e77 == 3i) {
{
let _e80 = place;
let _e82 = half_field;
let _e86 = place;
let _e88 = half_field;
(*local) = normalize(vec3<f32>(((_e80.x * _e82) * 1.5f), (_e86.y * _e88), 1f));
return true;
}
}
let _e94 = place;
radius = length(_e94);
let _e97 = radius;
angle_1 = ((_e97 * 0.5f) * PI);
let _e102 = place;
let _e103 = radius;
if (_e103 > 0f) {
let _e106 = angle_1;
let _e108 = radius;
local_1 = (sin(_e106) / _e108);
} else {
local_1 = 0f;
}
let _e112 = local_1;
let _e113 = (_e102 * _e112);
let _e114 = angle_1;
(*local) = vec3<f32>(_e113.x, _e113.y, cos(_e114));
let _e119 = radius;
return (_e119 < 1f);
}

fn from_horizon(angle_2: f32) -> f32 {
var angle_3: f32;
var x: f32;

angle_3 = angle_2;
let _e37 = angle_3;
x = (_e37 / HEIGHT_SCALE);
let _e42 = x;
let _e46 = x;
let _e47 = x;
return log(((1f + (2f * _e42)) + (2f * sqrt((_e46 * (_e47 + 1f))))));
}

fn arsinh(x_1: f32) -> f32 {
var x_2: f32;

x_2 = x_1;
let _e37 = x_2;
let _e39 = x_2;
let _e41 = x_2;
let _e42 = x_2;
return (sign(_e37) * log((abs(_e39) + sqrt(((_e41 * _e42) + 1f)))));
}

fn up_coordinate(height: f32) -> f32 {
var height_1: f32;

height_1 = height;
let _e37 = height_1;
let _e39 = horizon;
if (_e37 < (0.5f * _e39.y)) {
let _e43 = height_1;
let _e44 = from_horizon(_e43);
return _e44;
}
let _e45 = horizon;
let _e47 = height_1;
let _e48 = horizon;
let _e52 = arsinh(((_e47 - _e48.y) / HEIGHT_SCALE));
return (_e45.z + _e52);
}

fn between(coordinate: f32, count: i32, is_level: bool, first_node: ptr<function, i32>) -> vec4<f32> {
var coordinate_1: f32;
var count_1: i32;
var is_level_1: bool;
var cell: i32;
var t: f32;
var first: f32;
var second: f32;
var rise: f32;
var w: vec4<f32>;

coordinate_1 = coordinate;
count_1 = count;
is_level_1 = is_level;
let _e42 = coordinate_1;
let _e44 = count_1;
cell = min(i32(_e42), (_e44 - 1i));
let _e49 = coordinate_1;
let _e50 = cell;
t = (_e49 - f32(_e50));
let _e54 = t;
let _e56 = t;
let _e60 = t;
first = ((_e54 * (1f - _e56)) * (1f - _e60));
let _e64 = t;
let _e65 = t;
let _e67 = t;
second = ((_e64 * _e65) * (_e67 - 1f));
let _e72 = t;
let _e73 = t;
let _e77 = t;
rise = ((_e72 * _e73) * (3f - (2f * _e77)));
let _e84 = rise;
let _e86 = rise;
w = vec4<f32>(0f, (1f - _e84), _e86, 0f);
let _e90 = cell;
if (_e90 > 0i) {
let _e93 = w;
let _e94 = first;
w = (_e93 + (_e94 * vec4<f32>(-0.5f, 0f, 0.5f, 0f)));
} else {
let _e103 = is_level_1;
if !(_e103) {
let _e105 = w;
let _e106 = first;
w = (_e105 + (_e106 * vec4<f32>(0f, -1.5f, 2f, -0.5f)));
}
}
let _e116 = cell;
let _e119 = count_1;
if ((_e116 + 1i) < _e119) {
let _e121 = w;
let _e122 = second;
w = (_e121 + (_e122 * vec4<f32>(0f, -0.5f, 0f, 0.5f)));
} else {
let _e131 = is_level_1;
if !(_e131) {
let _e133 = w;
let _e134 = second;
w = (_e133 + (_e134 * vec4<f32>(0.5f, -2f, 1.5f, 0f)));
}
}
let _e143 = cell;
(*first_node) = (_e143 - 1i);
let _e146 = w;
return _e146;
}

fn table(v: vec3<f32>, has_degrees: bool) -> Light {
var v_1: vec3<f32>;
var has_degrees_1: bool;
var height_2: f32;
var along: f32;
var across: f32;
var up: bool;
var local_2: i32;
var rows: i32;
var local_3: f32;
var end: f32;
var local_4: f32;
var row: f32;
var azimuth: f32;
var column: f32;
var first_row: i32;
var first_column: i32;
var by_row: vec4<f32>;
var by_column: vec4<f32>;
var light: Light = Light(vec3(0f), vec3(0f), vec3(0f));
var i: i32 = 0i;
var local_5: i32;
var y: i32;
var j: i32;
var x_3: i32;
var weight: f32;

v_1 = v;
has_degrees_1 = has_degrees;
let _e39 = v_1;
let _e41 = v_1;
let _e45 = horizon;
height_2 = (atan2(_e39.z, length(_e41.xy)) + _e45.x);
let _e49 = v_1;
let _e51 = sun_1;
along = dot(_e49.xy, _e51);
let _e54 = v_1;
let _e56 = sun_1;
let _e59 = v_1;
let _e61 = sun_1;
across = ((_e54.y * _e56.x) - (_e59.x * _e61.y));
let _e66 = height_2;
up = (_e66 >= 0f);
let _e70 = up;
if _e70 {
let _e71 = intervals;
local_2 = _e71.x;
} else {
let _e73 = intervals;
local_2 = _e73.y;
}
let _e76 = local_2;
rows = _e76;
let _e78 = up;
if _e78 {
let _e79 = ends;
local_3 = _e79.x;
} else {
let _e81 = ends;
local_3 = _e81.y;
}
let _e84 = local_3;
end = _e84;
let _e86 = rows;
let _e88 = up;
if _e88 {
let _e89 = height_2;
let _e90 = up_coordinate(_e89);
local_4 = _e90;
} else {
let _e91 = height_2;
let _e93 = from_horizon(-(_e91));
local_4 = _e93;
}
let _e95 = local_4;
let _e97 = end;
let _e100 = rows;
row = clamp(((f32(_e86) * _e95) / _e97), 0f, f32(_e100));
let _e104 = across;
let _e106 = along;
let _e109 = arsinh((atan2(abs(_e104), _e106) / AZIMUTH_SCALE));
azimuth = _e109;
let _e111 = intervals;
let _e114 = azimuth;
let _e116 = ends;
let _e120 = intervals;
column = clamp(((f32(_e111.z) * _e114) / _e116.z), 0f, f32(_e120.z));
let _e127 = row;
let _e128 = rows;
let _e132 = between(_e127, _e128, false, (&first_row));
by_row = _e132;
let _e134 = column;
let _e135 = intervals;
let _e140 = between(_e134, _e135.z, true, (&first_column));
by_column = _e140;
loop {
let _e152 = i;
if !((_e152 < 4i)) {
break;
}
{
let _e159 = first_row;
let _e160 = i;
let _e163 = rows;
let _e165 = up;
if _e165 {
local_5 = 0i;
} else {
let _e167 = intervals;
local_5 = (_e167.x + 1i);
}
let _e172 = local_5;
y = (clamp((_e159 + _e160), 0i, _e163) + _e172);
j = 0i;
loop {
let _e177 = j;
if !((_e177 < 4i)) {
break;
}
{
let _e184 = first_column;
let _e185 = j;
let _e188 = intervals;
x_3 = clamp((_e184 + _e185), 0i, _e188.z);
let _e192 = i;
let _e194 = by_row[_e192];
let _e195 = j;
let _e197 = by_column[_e195];
weight = (_e194 * _e197);
let _e201 = light;
let _e203 = weight;
let _e204 = x_3;
let _e205 = y;
let _e208 = textureLoad(roots, vec2<i32>(_e204, _e205), 0i);
light.root = (_e201.root + (_e203 * _e208.xyz));
let _e212 = has_degrees_1;
if _e212 {
{
let _e214 = light;
let _e216 = weight;
let _e218 = x_3;
let _e220 = y;
let _e223 = textureLoad(degrees_, vec2<i32>((2i * _e218), _e220), 0i);
light.q = (_e214.q + (_e216 * _e223.xyz));
let _e228 = light;
let _e230 = weight;
let _e232 = x_3;
let _e236 = y;
let _e239 = textureLoad(degrees_, vec2<i32>(((2i * _e232) + 1i), _e236), 0i);
light.u = (_e228.u + (_e230 * _e239.xyz));
}
}
}
continuing {
let _e181 = j;
j = (_e181 + 1i);
}
}
}
continuing {
let _e156 = i;
i = (_e156 + 1i);
}
}
let _e244 = light;
let _e246 = across;
let _e247 = v_1;
light.u = (_e244.u * (_e246 / max(length(_e247.xy), 0.000000000001f)));
let _e254 = light;
return _e254;
}

fn pass_(v_2: vec3<f32>, xyz: vec3<f32>, light_1: Light) -> vec3<f32> {
var v_3: vec3<f32>;
var xyz_1: vec3<f32>;
var light_2: Light;
var level: f32;
var e1_: vec3<f32>;
var e2_: vec3<f32>;
var local_6: vec3<f32>;
var top: vec3<f32>;
var angle_4: f32;
var part: vec3<f32>;

v_3 = v_2;
xyz_1 = xyz;
light_2 = light_1;
let _e41 = v_3;
level = max(length(_e41.xy), 0.000001f);
let _e47 = v_3;
let _e50 = v_3;
let _e53 = level;
let _e55 = ((-(_e47.z) * _e50.xy) / vec2(_e53));
let _e56 = level;
e1_ = vec3<f32>(_e55.x, _e55.y, _e56);
let _e61 = v_3;
let _e63 = v_3;
let _e68 = level;
e2_ = (vec3<f32>(_e61.y, -(_e63.x), 0f) / vec3(_e68));
let _e72 = projection;
let _e75 = projection;
if ((_e72 == 2i) || (_e75 == 1i)) {
local_6 = vec3<f32>(0f, 0f, 1f);
} else {
let _e85 = axes[1];
local_6 = _e85;
}
let _e87 = local_6;
top = _e87;
let _e89 = e2_;
let _e90 = top;
let _e92 = e1_;
let _e93 = top;
let _e96 = polariser;
angle_4 = (atan2(dot(_e89, _e90), dot(_e92, _e93)) + _e96);
let _e99 = light_2;
let _e102 = angle_4;
let _e106 = light_2;
let _e109 = angle_4;
part = ((_e99.q * cos((2f * _e102))) + (_e106.u * sin((2f * _e109))));
let _e116 = xyz_1;
let _e119 = part;
return max(((0.5f * _e116) * (vec3(1f) + _e119)), vec3(0f));
}

fn sequential(x_4: f32) -> vec3<f32> {
var x_5: f32;
var stops: array<vec3<f32>, 6> = array<vec3<f32>, 6>(vec3<f32>(0f, 0f, 0.02f), vec3<f32>(0.25f, 0.05f, 0.42f), vec3<f32>(0.58f, 0.15f, 0.4f), vec3<f32>(0.87f, 0.31f, 0.22f), vec3<f32>(0.98f, 0.62f, 0.12f), vec3<f32>(0.98f, 0.99f, 0.66f));
var u: f32;
var i_1: i32;

x_5 = x_4;
let _e63 = x_5;
u = (clamp(_e63, 0f, 1f) * 5f);
let _e70 = u;
i_1 = min(i32(_e70), 4i);
let _e75 = i_1;
let _e77 = stops[_e75];
let _e78 = i_1;
let _e82 = stops[(_e78 + 1i)];
let _e83 = u;
let _e84 = i_1;
return mix(_e77, _e82, vec3((_e83 - f32(_e84))));
}

fn linear_srgb(c: vec3<f32>) -> vec3<f32> {
var c_1: vec3<f32>;

c_1 = c;
let _e43 = c_1;
let _e50 = c_1;
let _e57 = c_1;
return vec3<f32>(dot(vec3<f32>(3.24097f, -1.5373832f, -0.49861076f), _e43), dot(vec3<f32>(-0.96924365f, 1.8759675f, 0.04155506f), _e50), dot(vec3<f32>(0.05563008f, -0.20397696f, 1.0569715f), _e57));
}

fn columns_at(v_4: vec3<f32>, t_1: ptr<function, f32>) -> vec2<i32> {
var v_5: vec3<f32>;
var u_1: f32;
var local_7: f32;
var first_1: i32;

v_5 = v_4;
let _e38 = v_5;
let _e40 = v_5;
u_1 = ((atan2(_e38.y, _e40.x) * 768f) / PI);
let _e47 = u_1;
if (_e47 < 0f) {
let _e50 = u_1;
local_7 = (_e50 + 1536f);
} else {
let _e53 = u_1;
local_7 = _e53;
}
let _e55 = local_7;
u_1 = _e55;
let _e56 = u_1;
first_1 = i32(_e56);
let _e59 = u_1;
let _e60 = first_1;
(*t_1) = (_e59 - f32(_e60));
let _e63 = first_1;
let _e66 = first_1;
return vec2<i32>((_e63 % 1536i), ((_e66 + 1i) % 1536i));
}

fn slope_of(columns: vec2<i32>, t_2: f32, ring: i32) -> f32 {
var columns_1: vec2<i32>;
var t_3: f32;
var ring_1: i32;

columns_1 = columns;
t_3 = t_2;
ring_1 = ring;
let _e41 = columns_1;
let _e43 = ring_1;
let _e46 = textureLoad(slopes, vec2<i32>(_e41.x, _e43), 0i);
let _e48 = columns_1;
let _e50 = ring_1;
let _e53 = textureLoad(slopes, vec2<i32>(_e48.y, _e50), 0i);
let _e55 = t_3;
return mix(_e46.x, _e53.x, _e55);
}

fn meet(v_6: vec3<f32>, ring_2: ptr<function, f32>) -> f32 {
var v_7: vec3<f32>;
var t_4: f32;
var level_1: f32;
var slope: f32;
var columns_2: vec2<i32>;
var near: i32 = 0i;
var far: i32 = 511i;
var below: f32;
var above: f32;
var middle: i32;
var here: f32;

v_7 = v_6;
let _e39 = v_7;
level_1 = max(length(_e39.xy), 0.000000001f);
let _e45 = v_7;
let _e47 = level_1;
slope = (_e45.z / _e47);
let _e50 = v_7;
let _e53 = columns_at(_e50, (&t_4));
columns_2 = _e53;
(*ring_2) = 0f;
let _e60 = columns_2;
let _e61 = t_4;
let _e62 = near;
let _e63 = slope_of(_e60, _e61, _e62);
below = _e63;
let _e65 = columns_2;
let _e66 = t_4;
let _e67 = far;
let _e68 = slope_of(_e65, _e66, _e67);
above = _e68;
let _e70 = above;
let _e71 = slope;
if (_e70 < _e71) {
return 0f;
}
let _e74 = below;
let _e75 = slope;
if (_e74 >= _e75) {
let _e79 = land[1];
let _e81 = v_7;
let _e88 = level_1;
return min((_e79.w / max(-(_e81.z), 0.000001f)), (20f / _e88));
}
loop {
let _e91 = far;
let _e92 = near;
if !(((_e91 - _e92) > 1i)) {
break;
}
{
let _e97 = near;
let _e98 = far;
middle = ((_e97 + _e98) / 2i);
let _e103 = columns_2;
let _e104 = t_4;
let _e105 = middle;
let _e106 = slope_of(_e103, _e104, _e105);
here = _e106;
let _e108 = here;
let _e109 = slope;
if (_e108 < _e109) {
{
let _e111 = middle;
near = _e111;
let _e112 = here;
below = _e112;
}
} else {
{
let _e113 = middle;
far = _e113;
let _e114 = here;
above = _e114;
}
}
}
}
let _e115 = near;
let _e117 = slope;
let _e118 = below;
let _e120 = above;
let _e121 = below;
(*ring_2) = (f32(_e115) + ((_e117 - _e118) / max((_e120 - _e121), 0.000000001f)));
let _e129 = (*ring_2);
let _e133 = level_1;
return ((20f * exp((0.021530528f * _e129))) / _e133);
}

fn normal_at(v_8: vec3<f32>, ring_3: f32) -> vec3<f32> {
var v_9: vec3<f32>;
var ring_4: f32;
var t_5: f32;
var columns_3: vec2<i32>;
var near_1: i32;
var first_2: vec2<f32>;
var second_1: vec2<f32>;
var level_2: vec2<f32>;

v_9 = v_8;
ring_4 = ring_3;
let _e40 = v_9;
let _e43 = columns_at(_e40, (&t_5));
columns_3 = _e43;
let _e45 = ring_4;
near_1 = min(i32(_e45), 510i);
let _e50 = columns_3;
let _e52 = near_1;
let _e55 = textureLoad(normals, vec2<i32>(_e50.x, _e52), 0i);
let _e57 = columns_3;
let _e59 = near_1;
let _e62 = textureLoad(normals, vec2<i32>(_e57.y, _e59), 0i);
let _e64 = t_5;
first_2 = mix(_e55.xy, _e62.xy, vec2(_e64));
let _e68 = columns_3;
let _e70 = near_1;
let _e75 = textureLoad(normals, vec2<i32>(_e68.x, (_e70 + 1i)), 0i);
let _e77 = columns_3;
let _e79 = near_1;
let _e84 = textureLoad(normals, vec2<i32>(_e77.y, (_e79 + 1i)), 0i);
let _e86 = t_5;
second_1 = mix(_e75.xy, _e84.xy, vec2(_e86));
let _e90 = first_2;
let _e91 = second_1;
let _e92 = ring_4;
let _e93 = near_1;
level_2 = mix(_e90, _e91, vec2((_e92 - f32(_e93))));
let _e99 = level_2;
let _e101 = level_2;
let _e102 = level_2;
return vec3<f32>(_e99.x, _e99.y, sqrt(max((1f - dot(_e101, _e102)), 0f)));
}

fn sunlit(point: vec3<f32>) -> f32 {
var point_1: vec3<f32>;
var u_2: vec2<f32>;
var cell_1: vec2<i32>;
var t_6: vec2<f32>;
var low: f32;
var high: f32;

point_1 = point;
let _e37 = point_1;
u_2 = ((_e37.xy / vec2(250f)) + vec2(255.5f));
let _e46 = u_2;
let _e48 = u_2;
let _e53 = u_2;
let _e55 = u_2;
if ((min(_e46.x, _e48.y) < 0f) || (max(_e53.x, _e55.y) >= 511f)) {
return 1f;
}
let _e62 = u_2;
cell_1 = vec2<i32>(_e62);
let _e65 = u_2;
let _e66 = cell_1;
t_6 = (_e65 - vec2<f32>(_e66));
let _e70 = cell_1;
let _e72 = textureLoad(shadows, _e70, 0i);
let _e74 = cell_1;
let _e80 = textureLoad(shadows, (_e74 + vec2<i32>(1i, 0i)), 0i);
let _e82 = t_6;
low = mix(_e72.x, _e80.x, _e82.x);
let _e86 = cell_1;
let _e92 = textureLoad(shadows, (_e86 + vec2<i32>(0i, 1i)), 0i);
let _e94 = cell_1;
let _e100 = textureLoad(shadows, (_e94 + vec2<i32>(1i, 1i)), 0i);
let _e102 = t_6;
high = mix(_e92.x, _e100.x, _e102.x);
let _e106 = point_1;
let _e108 = low;
let _e109 = high;
let _e110 = t_6;
return clamp((((_e106.z - mix(_e108, _e109, _e110.y)) / 20f) + 0.5f), 0f, 1f);
}

fn sunlight_at(altitude: f32, elevation: f32, here_1: f32) -> vec3<f32> {
var altitude_1: f32;
var elevation_1: f32;
var here_2: f32;
var turn: f32;
var u_3: f32;
var w_1: f32;
var node: vec2<i32>;
var t_7: vec2<f32>;
var low_1: vec3<f32>;
var high_1: vec3<f32>;

altitude_1 = altitude;
elevation_1 = elevation;
here_2 = here_1;
let _e41 = elevation_1;
let _e42 = here_2;
turn = clamp(((_e41 - _e42) / 0.19f), -1f, 1f);
let _e51 = turn;
let _e53 = turn;
u_3 = (((sign(_e51) * sqrt(abs(_e53))) + 1f) * 32f);
let _e62 = altitude_1;
w_1 = (sqrt(clamp((_e62 / 4000f), 0f, 1f)) * 11f);
let _e72 = u_3;
let _e73 = w_1;
node = min(vec2<i32>(i32(_e72), i32(_e73)), vec2<i32>(63i, 10i));
let _e82 = u_3;
let _e83 = w_1;
let _e85 = node;
t_7 = (vec2<f32>(_e82, _e83) - vec2<f32>(_e85));
let _e89 = node;
let _e91 = textureLoad(sunlight, _e89, 0i);
let _e93 = node;
let _e99 = textureLoad(sunlight, (_e93 + vec2<i32>(1i, 0i)), 0i);
let _e101 = t_7;
low_1 = mix(_e91.xyz, _e99.xyz, vec3(_e101.x));
let _e106 = node;
let _e112 = textureLoad(sunlight, (_e106 + vec2<i32>(0i, 1i)), 0i);
let _e114 = node;
let _e120 = textureLoad(sunlight, (_e114 + vec2<i32>(1i, 1i)), 0i);
let _e122 = t_7;
high_1 = mix(_e112.xyz, _e120.xyz, vec3(_e122.x));
let _e127 = low_1;
let _e128 = high_1;
let _e129 = t_7;
let _e134 = linear_srgb(exp2(mix(_e127, _e128, vec3(_e129.y))));
return max(_e134, vec3(0f));
}

fn cover(altitude_2: f32, level_3: f32) -> vec3<f32> {
var altitude_3: f32;
var level_4: f32;
var colour: vec3<f32>;

altitude_3 = altitude_2;
level_4 = level_3;
let _e48 = level_4;
let _e53 = altitude_3;
colour = mix(vec3<f32>(0.09f, 0.12f, 0.05f), vec3<f32>(0.03f, 0.045f, 0.02f), vec3(clamp(min(((0.995f - _e48) / 0.02f), ((1400f - _e53) / 200f)), 0f, 1f)));
let _e64 = colour;
let _e70 = level_4;
let _e74 = altitude_3;
colour = mix(_e64, vec3<f32>(0.19f, 0.17f, 0.15f), vec3(clamp(max(((0.85f - _e70) / 0.08f), ((_e74 - 1500f) / 400f)), 0f, 1f)));
let _e85 = colour;
let _e90 = altitude_3;
return mix(_e85, vec3<f32>(0.75f, 0.77f, 0.8f), vec3(clamp(((_e90 - 1900f) / 150f), 0f, 1f)));
}

fn surface(v_10: vec3<f32>, distance_: f32, ring_5: f32) -> vec3<f32> {
var v_11: vec3<f32>;
var distance_1: f32;
var ring_6: f32;
var radius_1: f32;
var point_2: vec3<f32>;
var up_1: vec3<f32>;
var way: f32;
var altitude_4: f32;
var normal: vec3<f32>;
var sun: f32;
var facing: f32;
var local_8: vec3<f32>;
var direct: vec3<f32>;
var sky: vec3<f32>;

v_11 = v_10;
distance_1 = distance_;
ring_6 = ring_5;
let _e43 = land[2];
radius_1 = _e43.w;
let _e46 = distance_1;
let _e47 = v_11;
let _e49 = (_e46 * _e47.xy);
let _e52 = land[1];
let _e54 = distance_1;
let _e55 = v_11;
point_2 = vec3<f32>(_e49.x, _e49.y, (_e52.w + (_e54 * _e55.z)));
let _e63 = point_2;
let _e66 = radius_1;
up_1 = normalize((_e63 + vec3<f32>(0f, 0f, _e66)));
let _e71 = point_2;
let _e73 = point_2;
let _e74 = point_2;
let _e77 = radius_1;
way = (_e71.z + (dot(_e73, _e74) / (2f * _e77)));
let _e83 = way;
let _e88 = way;
let _e90 = radius_1;
altitude_4 = ((2f * _e83) / (1f + sqrt(max((1f + ((2f * _e88) / _e90)), 0f))));
let _e99 = v_11;
let _e100 = ring_6;
let _e101 = normal_at(_e99, _e100);
let _e102 = up_1;
let _e103 = _e102.xy;
normal = normalize((_e101 + vec3<f32>(_e103.x, _e103.y, 0f)));
let _e111 = up_1;
let _e112 = land_sun;
sun = asin(clamp(dot(_e111, _e112), -1f, 1f));
let _e120 = normal;
let _e121 = land_sun;
let _e125 = point_2;
let _e131 = sunlit((_e125 + vec3<f32>(0f, 0f, 3f)));
facing = (max(dot(_e120, _e121), 0f) * _e131);
let _e134 = facing;
if (_e134 > 0f) {
let _e137 = facing;
let _e138 = altitude_4;
let _e139 = sun;
let _e140 = land_sun;
let _e147 = sunlight_at(_e138, _e139, asin(clamp(_e140.z, -1f, 1f)));
local_8 = (_e137 * _e147);
} else {
local_8 = vec3(0f);
}
let _e152 = local_8;
direct = _e152;
let _e156 = normal;
let _e162 = land[3];
let _e166 = land[4];
let _e167 = _e166.xy;
sky = ((0.5f + (0.5f * _e156.z)) * vec3<f32>(_e162.w, _e167.x, _e167.y));
let _e173 = altitude_4;
let _e174 = normal;
let _e176 = cover(_e173, _e174.z);
let _e180 = direct;
let _e181 = sky;
return ((_e176 / vec3(3.1415927f)) * (_e180 + _e181));
}

fn lobe(weight_1: f32, g: f32, cosine: f32) -> f32 {
var weight_2: f32;
var g_1: f32;
var cosine_1: f32;
var x_6: f32;

weight_2 = weight_1;
g_1 = g;
cosine_1 = cosine;
let _e42 = g_1;
let _e45 = g_1;
let _e49 = g_1;
let _e52 = cosine_1;
x_6 = (((1f - _e42) * (1f - _e45)) + ((2f * _e49) * (1f - _e52)));
let _e57 = weight_2;
let _e59 = g_1;
let _e60 = g_1;
let _e64 = x_6;
let _e65 = x_6;
return ((_e57 * (1f - (_e59 * _e60))) / (_e64 * sqrt(_e65)));
}

fn shape(v_12: vec3<f32>) -> f32 {
var v_13: vec3<f32>;
var way_1: vec3<f32>;
var cosine_2: f32;

v_13 = v_12;
let _e37 = v_13;
let _e38 = land_sun;
way_1 = (_e37 - _e38);
let _e43 = way_1;
let _e44 = way_1;
cosine_2 = (1f - (0.5f * dot(_e43, _e44)));
let _e51 = land[1];
let _e55 = land[1];
let _e60 = cosine_2;
let _e61 = cosine_2;
let _e68 = land[2];
let _e72 = land[3];
let _e74 = cosine_2;
let _e75 = lobe(_e68.x, _e72.x, _e74);
let _e79 = land[2];
let _e83 = land[3];
let _e85 = cosine_2;
let _e86 = lobe(_e79.y, _e83.y, _e85);
let _e90 = land[2];
let _e94 = land[3];
let _e96 = cosine_2;
let _e97 = lobe(_e90.z, _e94.z, _e96);
return ((((_e51.y + ((_e55.z * 0.75f) * (1f + (_e60 * _e61)))) + _e75) + _e86) + _e97);
}

fn air_before(v_14: vec3<f32>, distance_2: f32, factors: ptr<function, vec3<f32>>) -> vec3<f32> {
var v_15: vec3<f32>;
var distance_3: f32;
var rows_1: i32;
var columns_4: i32;
var first_row_1: i32;
var level_5: f32;
var cosine_3: f32;
var column_1: f32;
var first_3: i32;
var row_1: f32;
var by_row_1: vec4<f32>;
var far_1: f32;
var first_slice: i32;
var by_slice: vec4<f32>;
var light_3: vec3<f32> = vec3(0f);
var depth: vec3<f32> = vec3(0f);
var k: i32 = 0i;
var slice: i32;
var i_2: i32;
var y_1: i32;
var j_1: i32;
var along_1: f32;
var local_9: f32;
var weight_3: f32;

v_15 = v_14;
distance_3 = distance_2;
let _e42 = land[0];
rows_1 = i32(_e42.w);
let _e48 = land[1];
columns_4 = i32(_e48.x);
let _e53 = v_15;
level_5 = max(length(_e53.xy), 0.000000001f);
let _e59 = v_15;
let _e61 = land_sun;
let _e64 = level_5;
let _e65 = land_sun;
cosine_3 = clamp((dot(_e59.xy, _e61.xy) / (_e64 * max(length(_e65.xy), 0.000000001f))), -1f, 1f);
let _e77 = cosine_3;
let _e80 = columns_4;
column_1 = ((acos(_e77) / PI) * f32((_e80 - 1i)));
let _e86 = column_1;
let _e88 = columns_4;
first_3 = min(i32(_e86), (_e88 - 2i));
let _e93 = v_15;
let _e95 = level_5;
let _e99 = land[0];
let _e104 = arsinh(((atan2(_e93.z, _e95) + _e99.x) / 0.04f));
let _e107 = land[0];
let _e112 = land[0];
row_1 = ((_e104 - _e107.y) * _e112.z);
let _e116 = row_1;
let _e118 = rows_1;
let _e123 = rows_1;
let _e129 = between(clamp(_e116, 0f, f32((_e118 - 1i))), (_e123 - 1i), false, (&first_row_1));
by_row_1 = _e129;
let _e131 = distance_3;
let _e134 = land[5];
let _e140 = land[5];
far_1 = clamp((log((_e131 / _e134.x)) * _e140.y), 0f, 47f);
let _e148 = far_1;
let _e153 = between(_e148, 47i, false, (&first_slice));
by_slice = _e153;
loop {
let _e163 = k;
if !((_e163 < 4i)) {
break;
}
{
let _e170 = first_slice;
let _e171 = k;
slice = clamp((_e170 + _e171), 0i, 47i);
i_2 = 0i;
loop {
let _e179 = i_2;
if !((_e179 < 4i)) {
break;
}
{
let _e186 = slice;
let _e187 = rows_1;
let _e189 = first_row_1;
let _e190 = i_2;
let _e193 = rows_1;
y_1 = ((_e186 * _e187) + clamp((_e189 + _e190), 0i, (_e193 - 1i)));
j_1 = 0i;
loop {
let _e201 = j_1;
if !((_e201 < 2i)) {
break;
}
{
let _e208 = column_1;
let _e209 = first_3;
along_1 = (_e208 - f32(_e209));
let _e213 = k;
let _e215 = by_slice[_e213];
let _e216 = i_2;
let _e218 = by_row_1[_e216];
let _e220 = j_1;
if (_e220 == 0i) {
let _e224 = along_1;
local_9 = (1f - _e224);
} else {
let _e226 = along_1;
local_9 = _e226;
}
let _e228 = local_9;
weight_3 = ((_e215 * _e218) * _e228);
let _e231 = light_3;
let _e232 = weight_3;
let _e234 = first_3;
let _e235 = j_1;
let _e238 = y_1;
let _e241 = textureLoad(air, vec2<i32>((2i * (_e234 + _e235)), _e238), 0i);
light_3 = (_e231 + (_e232 * _e241.xyz));
let _e245 = depth;
let _e246 = weight_3;
let _e248 = first_3;
let _e249 = j_1;
let _e254 = y_1;
let _e257 = textureLoad(air, vec2<i32>(((2i * (_e248 + _e249)) + 1i), _e254), 0i);
depth = (_e245 + (_e246 * _e257.xyz));
}
continuing {
let _e205 = j_1;
j_1 = (_e205 + 1i);
}
}
}
continuing {
let _e183 = i_2;
i_2 = (_e183 + 1i);
}
}
}
continuing {
let _e167 = k;
k = (_e167 + 1i);
}
}
let _e261 = distance_3;
let _e263 = depth;
(*factors) = exp((-(_e261) * max(_e263, vec3(0f))));
let _e269 = light_3;
let _e271 = distance_3;
let _e273 = v_15;
let _e274 = shape(_e273);
return ((exp2(_e269) * _e271) * _e274);
}

fn land_light(v_16: vec3<f32>, distance_4: f32, ring_7: f32) -> vec3<f32> {
var v_17: vec3<f32>;
var distance_5: f32;
var ring_8: f32;
var factors_1: vec3<f32>;
var light_4: vec3<f32>;
var local_10: vec3<f32>;

v_17 = v_16;
distance_5 = distance_4;
ring_8 = ring_7;
let _e42 = v_17;
let _e43 = distance_5;
let _e46 = air_before(_e42, _e43, (&factors_1));
let _e47 = linear_srgb(_e46);
light_4 = _e47;
let _e49 = light_4;
let _e52 = land[4];
if (_e52.w > 0.5f) {
let _e56 = factors_1;
let _e57 = v_17;
let _e58 = distance_5;
let _e59 = ring_8;
let _e60 = surface(_e57, _e58, _e59);
local_10 = (_e56 * _e60);
} else {
local_10 = vec3(0f);
}
let _e65 = local_10;
return (_e49 + _e65);
}

fn sky_share(v_18: vec3<f32>, light_5: ptr<function, vec3<f32>>) -> f32 {
var v_19: vec3<f32>;
var ring_9: f32;
var here_3: f32;
var around: f32;
var local_11: f32;
var nearest: f32;
var local_12: f32;
var farthest: f32;
var local_13: vec3<f32>;
var i_3: i32 = 0i;
var corner: vec2<f32>;
var ignored: f32;
var local_14: f32;
var local_15: f32;
var sky_1: f32 = 0f;
var i_4: i32 = 0i;
var corner_1: vec2<f32>;
var way_2: vec3<f32>;
var distance_6: f32;

v_19 = v_18;
(*light_5) = vec3(0f);
let _e42 = land[4];
if (_e42.z < 0.5f) {
return 1f;
}
let _e48 = v_19;
let _e51 = meet(_e48, (&ring_9));
here_3 = _e51;
let _e53 = here_3;
around = _e53;
let _e55 = here_3;
if (_e55 > 0f) {
let _e58 = here_3;
local_11 = _e58;
} else {
local_11 = 1000000000f;
}
let _e61 = local_11;
nearest = _e61;
let _e63 = here_3;
if (_e63 > 0f) {
let _e66 = here_3;
local_12 = _e66;
} else {
local_12 = 1000000000f;
}
let _e69 = local_12;
farthest = _e69;
loop {
let _e74 = i_3;
if !((_e74 < 4i)) {
break;
}
{
let _e81 = i_3;
let _e84 = i_3;
corner = (vec2<f32>(f32((_e81 % 2i)), f32((_e84 / 2i))) - vec2(0.5f));
let _e95 = place_in_picture;
let _e97 = corner;
let _e101 = look((_e95.xy + _e97), (&local_13));
if !(_e101) {
continue;
}
let _e103 = axes;
let _e104 = local_13;
let _e108 = meet((_e103 * _e104), (&ignored));
around = _e108;
let _e109 = around;
if (_e109 > 0f) {
let _e112 = around;
local_14 = _e112;
} else {
local_14 = 1000000000f;
}
let _e115 = local_14;
around = _e115;
let _e116 = nearest;
let _e117 = around;
nearest = min(_e116, _e117);
let _e119 = farthest;
let _e120 = around;
farthest = max(_e119, _e120);
}
continuing {
let _e78 = i_3;
i_3 = (_e78 + 1i);
}
}
let _e122 = farthest;
let _e124 = nearest;
if (_e122 <= (1.1f * _e124)) {
{
let _e127 = here_3;
if (_e127 > 0f) {
let _e130 = v_19;
let _e131 = here_3;
let _e132 = ring_9;
let _e133 = land_light(_e130, _e131, _e132);
(*light_5) = _e133;
}
let _e134 = here_3;
if (_e134 > 0f) {
local_15 = 0f;
} else {
local_15 = 1f;
}
let _e140 = local_15;
return _e140;
}
}
loop {
let _e145 = i_4;
if !((_e145 < 8i)) {
break;
}
{
let _e152 = i_4;
let _e158 = i_4;
corner_1 = (vec2<f32>(((f32(_e152) + 0.5f) / 8f), fract((((f32(_e158) + 0.5f) * 0.625f) + 0.125f))) - vec2(0.5f));
let _e172 = place_in_picture;
let _e174 = corner_1;
let _e178 = look((_e172.xy + _e174), (&local_13));
if !(_e178) {
continue;
}
let _e180 = axes;
let _e181 = local_13;
way_2 = (_e180 * _e181);
let _e184 = way_2;
let _e187 = meet(_e184, (&ring_9));
distance_6 = _e187;
let _e189 = distance_6;
if (_e189 > 0f) {
let _e192 = (*light_5);
let _e193 = way_2;
let _e194 = distance_6;
let _e195 = ring_9;
let _e196 = land_light(_e193, _e194, _e195);
(*light_5) = (_e192 + (_e196 / vec3(8f)));
} else {
let _e201 = sky_1;
sky_1 = (_e201 + 0.125f);
}
}
continuing {
let _e149 = i_4;
i_4 = (_e149 + 1i);
}
}
let _e204 = sky_1;
return _e204;
}

fn is_open(v_20: vec3<f32>) -> bool {
var v_21: vec3<f32>;
var t_8: f32;
var columns_5: vec2<i32>;

v_21 = v_20;
let _e38 = v_21;
let _e41 = columns_at(_e38, (&t_8));
columns_5 = _e41;
let _e45 = land[4];
let _e49 = columns_5;
let _e50 = t_8;
let _e52 = slope_of(_e49, _e50, 511i);
let _e53 = v_21;
let _e55 = v_21;
return ((_e45.z < 0.5f) || (_e52 < (_e53.z / max(length(_e55.xy), 0.000000001f))));
}

fn disc_light(v_22: vec3<f32>) -> vec3<f32> {
var v_23: vec3<f32>;
var way_3: vec3<f32>;
var square: f32;
var elevation_2: f32;
var mu: f32;
var u_4: f32;
var row_2: i32;
var sum: vec3<f32> = vec3(0f);
var k_1: i32 = 5i;

v_23 = v_22;
let _e37 = v_23;
let _e38 = disc_sun;
let _e40 = disc_axis;
way_3 = ((_e37 - _e38) / vec3(_e40.w));
let _e45 = way_3;
let _e46 = way_3;
square = dot(_e45, _e46);
let _e49 = v_23;
let _e51 = v_23;
elevation_2 = atan2(_e49.z, length(_e51.xy));
let _e56 = square;
let _e59 = elevation_2;
let _e60 = disc_axis;
if ((_e56 > 1f) || (_e59 < _e60.z)) {
return vec3(0f);
}
let _e67 = square;
mu = sqrt((1f - _e67));
let _e71 = elevation_2;
let _e72 = disc_axis;
let _e75 = disc_axis;
u_4 = clamp(((_e71 - _e72.x) * _e75.y), 0f, 64f);
let _e82 = u_4;
row_2 = min(i32(_e82), 63i);
loop {
let _e92 = k_1;
if !((_e92 >= 0i)) {
break;
}
{
let _e99 = sum;
let _e100 = mu;
let _e102 = k_1;
let _e103 = row_2;
let _e106 = textureLoad(disc, vec2<i32>(_e102, _e103), 0i);
let _e108 = k_1;
let _e109 = row_2;
let _e114 = textureLoad(disc, vec2<i32>(_e108, (_e109 + 1i)), 0i);
let _e116 = u_4;
let _e117 = row_2;
sum = ((_e99 * _e100) + mix(_e106.xyz, _e114.xyz, vec3((_e116 - f32(_e117)))));
}
continuing {
let _e96 = k_1;
k_1 = (_e96 - 1i);
}
}
let _e123 = sum;
return max(_e123, vec3(0f));
}

fn spread(local_16: vec3<f32>) -> f32 {
var local_17: vec3<f32>;
var angle_5: f32;
var local_18: f32;

local_17 = local_16;
let _e37 = projection;
if (_e37 == 2i) {
let _e40 = local_17;
return length(_e40.xz);
}
let _e43 = projection;
if (_e43 == 3i) {
let _e46 = local_17;
let _e48 = local_17;
let _e51 = local_17;
return ((_e46.z * _e48.z) * _e51.z);
}
let _e54 = local_17;
angle_5 = acos(clamp(_e54.z, -1f, 1f));
let _e62 = angle_5;
if (_e62 > 0.001f) {
let _e65 = angle_5;
let _e67 = angle_5;
local_18 = (sin(_e65) / _e67);
} else {
local_18 = 1f;
}
let _e71 = local_18;
return _e71;
}

fn disc_mean() -> vec3<f32> {
var low_2: vec2<f32>;
var step_: vec2<f32>;
var sum_1: vec3<f32> = vec3(0f);
var local_19: vec3<f32>;
var whole: f32 = 0f;
var i_5: i32 = 0i;
var i_6: i32 = 0i;
var j_2: i32;
var v_24: vec3<f32>;
var local_20: vec3<f32>;

let _e35 = place_in_picture;
let _e40 = disc_box;
low_2 = max((_e35.xy - vec2(0.5f)), _e40.xy);
let _e44 = place_in_picture;
let _e49 = disc_box;
let _e52 = low_2;
step_ = (min((_e44.xy + vec2(0.5f)), _e49.zw) - _e52);
let _e55 = disc_axis;
let _e59 = step_;
let _e64 = step_;
if (((_e55.y <= 0f) || (_e59.x <= 0f)) || (_e64.y <= 0f)) {
return vec3(0f);
}
loop {
let _e79 = i_5;
if !((_e79 < 9i)) {
break;
}
{
let _e86 = place_in_picture;
let _e88 = i_5;
let _e91 = i_5;
let _e106 = look((_e86.xy + ((vec2<f32>(f32((_e88 % 3i)), f32((_e91 / 3i))) - vec2(1f)) / vec2(3f))), (&local_19));
if _e106 {
let _e107 = whole;
let _e108 = local_19;
let _e109 = spread(_e108);
whole = (_e107 + (_e109 / 9f));
}
}
continuing {
let _e83 = i_5;
i_5 = (_e83 + 1i);
}
}
let _e113 = step_;
let _e114 = disc_parts;
step_ = (_e113 / vec2(f32(_e114)));
loop {
let _e120 = i_6;
let _e121 = disc_parts;
if !((_e120 < _e121)) {
break;
}
{
j_2 = 0i;
loop {
let _e129 = j_2;
let _e130 = disc_parts;
if !((_e129 < _e130)) {
break;
}
{
let _e136 = low_2;
let _e137 = step_;
let _e138 = i_6;
let _e139 = j_2;
let _e150 = look((_e136 + (_e137 * (vec2<f32>(f32(_e138), f32(_e139)) + vec2(0.5f)))), (&local_19));
if !(_e150) {
continue;
}
let _e152 = axes;
let _e153 = local_19;
v_24 = (_e152 * _e153);
let _e156 = v_24;
let _e157 = is_open(_e156);
if _e157 {
let _e158 = sum_1;
let _e159 = local_19;
let _e160 = spread(_e159);
let _e161 = v_24;
let _e162 = disc_light(_e161);
sum_1 = (_e158 + (_e160 * _e162));
}
}
continuing {
let _e133 = j_2;
j_2 = (_e133 + 1i);
}
}
}
continuing {
let _e124 = i_6;
i_6 = (_e124 + 1i);
}
}
let _e165 = whole;
if (_e165 > 0f) {
let _e168 = sum_1;
let _e169 = step_;
let _e172 = step_;
let _e175 = whole;
local_20 = (((_e168 * _e169.x) * _e172.y) / vec3(_e175));
} else {
local_20 = vec3(0f);
}
let _e181 = local_20;
return _e181;
}

fn into_gamut(rgb: vec3<f32>) -> vec3<f32> {
var rgb_1: vec3<f32>;
var least: f32;
var luminance: f32;

rgb_1 = rgb;
let _e37 = rgb_1;
let _e39 = rgb_1;
let _e42 = rgb_1;
least = min(min(_e37.x, _e39.y), min(_e42.z, 0f));
let _e48 = rgb_1;
luminance = dot(_e48, vec3<f32>(0.2126f, 0.7152f, 0.0722f));
let _e55 = least;
if (_e55 == 0f) {
let _e58 = rgb_1;
return _e58;
}
let _e59 = luminance;
if (_e59 <= 0f) {
return vec3(0f);
}
let _e64 = luminance;
let _e65 = luminance;
let _e66 = luminance;
let _e67 = least;
let _e70 = rgb_1;
let _e71 = luminance;
return max((vec3(_e64) + ((_e65 / (_e66 - _e67)) * (_e70 - vec3(_e71)))), vec3(0f));
}

fn hable(x_7: vec3<f32>) -> vec3<f32> {
var x_8: vec3<f32>;

x_8 = x_7;
let _e37 = x_8;
let _e39 = x_8;
let _e48 = x_8;
let _e50 = x_8;
return ((((_e37 * ((0.15f * _e39) + vec3(0.05f))) + vec3(0.004f)) / ((_e48 * ((0.15f * _e50) + vec3(0.5f))) + vec3(0.06f))) - vec3(0.06666666f));
}

fn aces(v_25: vec3<f32>) -> vec3<f32> {
var v_26: vec3<f32>;

v_26 = v_25;
let _e37 = v_26;
let _e38 = v_26;
let _e46 = v_26;
let _e48 = v_26;
return (((_e37 * (_e38 + vec3(0.0245786f))) - vec3(0.000090537f)) / ((_e46 * ((0.983729f * _e48) + vec3(0.432951f))) + vec3(0.238081f)));
}

fn develop(rgb_2: vec3<f32>) -> vec3<f32> {
var rgb_3: vec3<f32>;
var scene: vec3<f32>;
var s: vec3<f32>;

rgb_3 = rgb_2;
let _e37 = rgb_3;
let _e38 = white;
scene = (_e37 / vec3(_e38));
let _e42 = is_daylight;
if _e42 {
{
let _e49 = scene;
let _e56 = scene;
let _e62 = scene;
scene = vec3<f32>(dot(vec3<f32>(0.963048f, -0.055734f, -0.01005f), _e49), dot(vec3<f32>(0.002642f, 1.013428f, -0.003697f), _e56), dot(vec3<f32>(0.004656f, 0.01677f, 1.188038f), _e62));
}
}
let _e65 = scene;
let _e66 = into_gamut(_e65);
scene = min(_e66, vec3(10000f));
let _e70 = tone;
if (_e70 == 1i) {
let _e74 = scene;
let _e79 = hable(min((2.927523f * _e74), vec3(11.2f)));
let _e82 = hable(vec3(11.2f));
scene = (_e79 / _e82);
}
let _e84 = tone;
if (_e84 == 2i) {
{
let _e88 = scene;
s = (1.461926f * _e88);
let _e95 = s;
let _e101 = s;
let _e107 = s;
let _e110 = aces(vec3<f32>(dot(vec3<f32>(0.59719f, 0.35458f, 0.04823f), _e95), dot(vec3<f32>(0.076f, 0.90834f, 0.01566f), _e101), dot(vec3<f32>(0.0284f, 0.13383f, 0.83777f), _e107)));
s = _e110;
let _e117 = s;
let _e125 = s;
let _e133 = s;
scene = vec3<f32>(dot(vec3<f32>(1.60475f, -0.53108f, -0.07367f), _e117), dot(vec3<f32>(-0.10208f, 1.10813f, -0.00605f), _e125), dot(vec3<f32>(-0.00327f, -0.07276f, 1.07602f), _e133));
}
}
let _e136 = scene;
scene = clamp(_e136, vec3(0f), vec3(1f));
let _e143 = scene;
let _e154 = scene;
let _e156 = scene;
return select(((1.055f * pow(_e143, vec3(0.41666666f))) - vec3(0.055f)), (12.92f * _e154), (_e156 <= vec3(0.0031308f)));
}

fn main_1() {
var local_21: vec3<f32>;
var v_27: vec3<f32>;
var light_6: Light;
var xyz_2: vec3<f32>;
var local_22: f32;
var local_23: f32;
var half_of: f32;
var land_rgb: vec3<f32>;
var disc_xyz: vec3<f32>;
var sky_2: f32;
var rgb_4: vec3<f32>;
var local_24: vec3<f32>;

let _e37 = global.values[0];
size = _e37.xy;
let _e41 = global.values[1];
projection = i32(_e41.x);
let _e46 = global.values[2];
let _e47 = _e46.xyz;
let _e50 = global.values[3];
let _e51 = _e50.xyz;
let _e54 = global.values[4];
let _e55 = _e54.xyz;
axes = mat3x3<f32>(vec3<f32>(_e47.x, _e47.y, _e47.z), vec3<f32>(_e51.x, _e51.y, _e51.z), vec3<f32>(_e55.x, _e55.y, _e55.z));
let _e71 = global.values[5];
half_field = _e71.x;
let _e75 = global.values[6];
horizon = _e75;
let _e78 = global.values[7];
ends = _e78.xyz;
let _e82 = global.values[8];
intervals = vec3<i32>(_e82.xyz);
let _e87 = global.values[9];
sun_1 = _e87.xy;
let _e91 = global.values[10];
quantity = i32(_e91.x);
let _e96 = global.values[11];
polariser = _e96.x;
let _e100 = global.values[12];
has_polariser = (_e100.x != 0f);
let _e106 = global.values[13];
white = _e106.x;
let _e110 = global.values[14];
tone = i32(_e110.x);
let _e115 = global.values[15];
is_daylight = (_e115.x != 0f);
let _e123 = global.values[16];
land[0i] = _e123;
let _e128 = global.values[17];
land[1i] = _e128;
let _e133 = global.values[18];
land[2i] = _e133;
let _e138 = global.values[19];
land[3i] = _e138;
let _e143 = global.values[20];
land[4i] = _e143;
let _e148 = global.values[21];
land[5i] = _e148;
let _e151 = global.values[22];
land_sun = _e151.xyz;
let _e155 = global.values[23];
disc_axis = _e155;
let _e158 = global.values[24];
disc_sun = _e158.xyz;
let _e162 = global.values[25];
disc_box = _e162;
let _e165 = global.values[26];
disc_parts = i32(_e165.x);
let _e169 = gl_FragCoord_1;
let _e171 = size;
let _e173 = gl_FragCoord_1;
place_in_picture = vec4<f32>(_e169.x, (_e171.y - _e173.y), 0f, 1f);
let _e180 = place_in_picture;
let _e184 = look(_e180.xy, (&local_21));
if !(_e184) {
{
colour_1 = vec4<f32>(0f, 0f, 0f, 1f);
return;
}
}
let _e191 = axes;
let _e192 = local_21;
v_27 = (_e191 * _e192);
let _e195 = v_27;
let _e196 = has_polariser;
let _e197 = quantity;
let _e201 = table(_e195, (_e196 || (_e197 == 1i)));
light_6 = _e201;
let _e203 = light_6;
let _e205 = light_6;
xyz_2 = (_e203.root * _e205.root);
let _e209 = quantity;
if (_e209 == 1i) {
{
let _e212 = xyz_2;
if (_e212.y > 0f) {
let _e216 = light_6;
let _e219 = light_6;
local_22 = min(length(vec2<f32>(_e216.q.y, _e219.u.y)), 1f);
} else {
local_22 = 0f;
}
let _e228 = local_22;
let _e229 = sequential(_e228);
colour_1 = vec4<f32>(_e229.x, _e229.y, _e229.z, 1f);
return;
}
}
let _e235 = has_polariser;
if _e235 {
let _e236 = v_27;
let _e237 = xyz_2;
let _e238 = light_6;
let _e239 = pass_(_e236, _e237, _e238);
xyz_2 = _e239;
}
let _e240 = has_polariser;
if _e240 {
local_23 = 0.5f;
} else {
local_23 = 1f;
}
let _e244 = local_23;
half_of = _e244;
let _e247 = disc_mean();
disc_xyz = _e247;
let _e249 = v_27;
let _e252 = sky_share(_e249, (&land_rgb));
sky_2 = _e252;
let _e254 = sky_2;
let _e255 = xyz_2;
let _e256 = linear_srgb(_e255);
let _e258 = half_of;
let _e259 = disc_xyz;
let _e260 = linear_srgb(_e259);
let _e261 = land_rgb;
rgb_4 = ((_e254 * _e256) + (_e258 * (_e260 + _e261)));
let _e266 = tone;
if (_e266 < 0i) {
let _e269 = rgb_4;
local_24 = _e269;
} else {
let _e270 = rgb_4;
let _e271 = develop(_e270);
local_24 = _e271;
}
let _e273 = local_24;
colour_1 = vec4<f32>(_e273.x, _e273.y, _e273.z, 1f);
return;
}

@fragment
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> FragmentOutput {
gl_FragCoord_1 = gl_FragCoord;
main_1();
let _e71 = colour_1;
return FragmentOutput(_e71);
}
