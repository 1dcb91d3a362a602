struct Values {
values: array<vec4<f32>, 50>,
}

struct Light {
xyz: vec3<f32>,
q: vec3<f32>,
u: vec3<f32>,
}

struct Table {
horizon: vec4<f32>,
ends: vec3<f32>,
intervals: vec3<i32>,
azimuth: vec2<f32>,
}

struct FragmentOutput {
@location(0) colour: vec4<f32>,
}

const PI: f32 = 3.1415927f;
const HEIGHT_SCALE: f32 = 0.06f;
const AZIMUTH_SCALE: f32 = 0.8f;
const DEEPEST: f32 = -0.2095f;

@group(0) @binding(0)
var<uniform> global: Values;
@group(0) @binding(1)
var roots: texture_2d<f32>;
@group(0) @binding(2)
var degrees_: texture_2d<f32>;
@group(0) @binding(3)
var moon_roots: texture_2d<f32>;
@group(0) @binding(4)
var moon_degrees: texture_2d<f32>;
@group(0) @binding(5)
var space_roots: texture_2d<f32>;
@group(0) @binding(6)
var slopes: texture_2d<f32>;
@group(0) @binding(7)
var normals: texture_2d<f32>;
@group(0) @binding(8)
var shadows: texture_2d<f32>;
@group(0) @binding(9)
var air: texture_2d<f32>;
@group(0) @binding(10)
var sunlight: texture_2d<f32>;
@group(0) @binding(11)
var disc: texture_2d<f32>;
var<private> colour_1: vec4<f32>;
var<private> place_in_picture: vec4<f32>;
var<private> size: vec2<f32>;
var<private> projection: i32;
var<private> axes: mat3x3<f32>;
var<private> half_field: f32;
var<private> sun_horizon: vec4<f32>;
var<private> moon_horizon: vec4<f32>;
var<private> sun_ends: vec3<f32>;
var<private> moon_ends: vec3<f32>;
var<private> sun_intervals: vec3<i32>;
var<private> moon_intervals: vec3<i32>;
var<private> sun_azimuth: vec2<f32>;
var<private> moon_azimuth: vec2<f32>;
var<private> quantity: i32;
var<private> polariser: f32;
var<private> has_polariser: bool;
var<private> white: f32;
var<private> tone: i32;
var<private> is_daylight: bool;
var<private> is_beyond: bool;
var<private> eye: f32;
var<private> space_sun: vec3<f32>;
var<private> space_ends: vec4<f32>;
var<private> space_layers: vec2<f32>;
var<private> space_counts: vec3<i32>;
var<private> space_columns: i32;
var<private> hosek: array<vec4<f32>, 10>;
var<private> hosek_sun: vec3<f32>;
var<private> divider: f32;
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
let _e53 = pixel_1;
let _e54 = size;
place = (((_e53 / _e54) * 2f) - vec2(1f));
let _e62 = projection;
if (_e62 == 2i) {
{
let _e65 = place;
let _e68 = place;
angle = vec2<f32>((_e65.x * PI), ((_e68.y * 0.5f) * PI));
let _e75 = angle;
let _e78 = angle;
let _e82 = angle;
let _e85 = angle;
let _e88 = angle;
(*local) = vec3<f32>((cos(_e75.y) * sin(_e78.x)), sin(_e82.y), (cos(_e85.y) * cos(_e88.x)));
return true;
}
}
let _e94 = projection;
if (_e94 == 3i) {
{
let _e97 = place;
let _e99 = half_field;
let _e103 = place;
let _e105 = half_field;
(*local) = normalize(vec3<f32>(((_e97.x * _e99) * 1.5f), (_e103.y * _e105), 1f));
return true;
}
}
let _e111 = place;
radius = length(_e111);
let _e114 = radius;
angle_1 = ((_e114 * 0.5f) * PI);
let _e119 = place;
let _e120 = radius;
if (_e120 > 0f) {
let _e123 = angle_1;
let _e125 = radius;
local_1 = (sin(_e123) / _e125);
} else {
local_1 = 0f;
}
let _e129 = local_1;
let _e130 = (_e119 * _e129);
let _e131 = angle_1;
(*local) = vec3<f32>(_e130.x, _e130.y, cos(_e131));
let _e136 = radius;
return (_e136 < 1f);
}

fn from_horizon(angle_2: f32) -> f32 {
var angle_3: f32;
var x: f32;

angle_3 = angle_2;
let _e54 = angle_3;
x = (_e54 / HEIGHT_SCALE);
let _e59 = x;
let _e63 = x;
let _e64 = x;
return log(((1f + (2f * _e59)) + (2f * sqrt((_e63 * (_e64 + 1f))))));
}

fn arsinh(x_1: f32) -> f32 {
var x_2: f32;

x_2 = x_1;
let _e54 = x_2;
let _e56 = x_2;
let _e58 = x_2;
let _e59 = x_2;
return (sign(_e54) * log((abs(_e56) + sqrt(((_e58 * _e59) + 1f)))));
}

fn up_coordinate(height: f32, horizon: vec4<f32>) -> f32 {
var height_1: f32;
var horizon_1: vec4<f32>;

height_1 = height;
horizon_1 = horizon;
let _e56 = height_1;
let _e58 = horizon_1;
if (_e56 < (0.5f * _e58.y)) {
let _e62 = height_1;
let _e63 = from_horizon(_e62);
return _e63;
}
let _e64 = horizon_1;
let _e66 = height_1;
let _e67 = horizon_1;
let _e71 = arsinh(((_e66 - _e67.y) / HEIGHT_SCALE));
return (_e64.z + _e71);
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
let _e59 = coordinate_1;
let _e61 = count_1;
cell = min(i32(_e59), (_e61 - 1i));
let _e66 = coordinate_1;
let _e67 = cell;
t = (_e66 - f32(_e67));
let _e71 = t;
let _e73 = t;
let _e77 = t;
first = ((_e71 * (1f - _e73)) * (1f - _e77));
let _e81 = t;
let _e82 = t;
let _e84 = t;
second = ((_e81 * _e82) * (_e84 - 1f));
let _e89 = t;
let _e90 = t;
let _e94 = t;
rise = ((_e89 * _e90) * (3f - (2f * _e94)));
let _e101 = rise;
let _e103 = rise;
w = vec4<f32>(0f, (1f - _e101), _e103, 0f);
let _e107 = cell;
if (_e107 > 0i) {
let _e110 = w;
let _e111 = first;
w = (_e110 + (_e111 * vec4<f32>(-0.5f, 0f, 0.5f, 0f)));
} else {
let _e120 = is_level_1;
if !(_e120) {
let _e122 = w;
let _e123 = first;
w = (_e122 + (_e123 * vec4<f32>(0f, -1.5f, 2f, -0.5f)));
}
}
let _e133 = cell;
let _e136 = count_1;
if ((_e133 + 1i) < _e136) {
let _e138 = w;
let _e139 = second;
w = (_e138 + (_e139 * vec4<f32>(0f, -0.5f, 0f, 0.5f)));
} else {
let _e148 = is_level_1;
if !(_e148) {
let _e150 = w;
let _e151 = second;
w = (_e150 + (_e151 * vec4<f32>(0.5f, -2f, 1.5f, 0f)));
}
}
let _e160 = cell;
(*first_node) = (_e160 - 1i);
let _e163 = w;
return _e163;
}

fn place_in(of_: Table, v: vec3<f32>) -> vec3<f32> {
var of_1: Table;
var v_1: vec3<f32>;
var height_2: f32;
var along: f32;
var across: f32;
var up: bool;
var local_2: i32;
var rows: i32;
var local_3: f32;
var end: f32;
var local_4: f32;
var coordinate_2: f32;
var row: f32;
var azimuth: f32;
var column: f32;
var local_5: f32;

of_1 = of_;
v_1 = v;
let _e56 = v_1;
let _e58 = v_1;
let _e62 = of_1;
height_2 = (atan2(_e56.z, length(_e58.xy)) + _e62.horizon.x);
let _e67 = v_1;
let _e69 = of_1;
along = dot(_e67.xy, _e69.azimuth);
let _e73 = v_1;
let _e75 = of_1;
let _e79 = v_1;
let _e81 = of_1;
across = ((_e73.y * _e75.azimuth.x) - (_e79.x * _e81.azimuth.y));
let _e87 = height_2;
up = (_e87 >= 0f);
let _e91 = up;
if _e91 {
let _e92 = of_1;
local_2 = _e92.intervals.x;
} else {
let _e95 = of_1;
local_2 = _e95.intervals.y;
}
let _e99 = local_2;
rows = _e99;
let _e101 = up;
if _e101 {
let _e102 = of_1;
local_3 = _e102.ends.x;
} else {
let _e105 = of_1;
local_3 = _e105.ends.y;
}
let _e109 = local_3;
end = _e109;
let _e111 = up;
if _e111 {
let _e112 = height_2;
let _e113 = of_1;
let _e115 = up_coordinate(_e112, _e113.horizon);
local_4 = _e115;
} else {
let _e116 = height_2;
let _e118 = from_horizon(-(_e116));
local_4 = _e118;
}
let _e120 = local_4;
coordinate_2 = _e120;
let _e122 = rows;
let _e124 = coordinate_2;
let _e126 = end;
let _e129 = rows;
row = clamp(((f32(_e122) * _e124) / _e126), 0f, f32(_e129));
let _e133 = across;
let _e135 = along;
let _e138 = arsinh((atan2(abs(_e133), _e135) / AZIMUTH_SCALE));
azimuth = _e138;
let _e140 = of_1;
let _e144 = azimuth;
let _e146 = of_1;
let _e151 = of_1;
column = clamp(((f32(_e140.intervals.z) * _e144) / _e146.ends.z), 0f, f32(_e151.intervals.z));
let _e157 = row;
let _e158 = column;
let _e159 = up;
if _e159 {
local_5 = 0f;
} else {
local_5 = 1f;
}
let _e163 = local_5;
return vec3<f32>(_e157, _e158, _e163);
}

fn sun_light(v_2: vec3<f32>, has_degrees: bool) -> Light {
var v_3: vec3<f32>;
var has_degrees_1: bool;
var light: Light = Light(vec3(0f), vec3(0f), vec3(0f));
var intervals: vec3<i32>;
var there: vec3<f32>;
var up_1: bool;
var local_6: i32;
var rows_1: i32;
var row_1: f32;
var column_1: f32;
var first_row: i32;
var first_column: i32;
var by_row: vec4<f32>;
var by_column: vec4<f32>;
var root: vec3<f32> = vec3(0f);
var q: vec3<f32> = vec3(0f);
var u: vec3<f32> = vec3(0f);
var i: i32 = 0i;
var local_7: i32;
var y: i32;
var j: i32;
var x_3: i32;
var weight: f32;
var across_1: f32;
var xyz: vec3<f32>;

v_3 = v_2;
has_degrees_1 = has_degrees;
let _e64 = sun_intervals;
intervals = _e64;
let _e66 = intervals;
if (_e66.z == 0i) {
let _e70 = light;
return _e70;
}
let _e71 = sun_horizon;
let _e72 = sun_ends;
let _e73 = intervals;
let _e74 = sun_azimuth;
let _e76 = v_3;
let _e77 = place_in(Table(_e71, _e72, _e73, _e74), _e76);
there = _e77;
let _e79 = there;
up_1 = (_e79.z == 0f);
let _e84 = up_1;
if _e84 {
let _e85 = intervals;
local_6 = _e85.x;
} else {
let _e87 = intervals;
local_6 = _e87.y;
}
let _e90 = local_6;
rows_1 = _e90;
let _e92 = there;
row_1 = _e92.x;
let _e95 = there;
column_1 = _e95.y;
let _e100 = row_1;
let _e101 = rows_1;
let _e105 = between(_e100, _e101, false, (&first_row));
by_row = _e105;
let _e107 = column_1;
let _e108 = intervals;
let _e113 = between(_e107, _e108.z, true, (&first_column));
by_column = _e113;
loop {
let _e126 = i;
if !((_e126 < 4i)) {
break;
}
{
let _e133 = first_row;
let _e134 = i;
let _e137 = rows_1;
let _e139 = up_1;
if _e139 {
local_7 = 0i;
} else {
let _e141 = intervals;
local_7 = (_e141.x + 1i);
}
let _e146 = local_7;
y = (clamp((_e133 + _e134), 0i, _e137) + _e146);
j = 0i;
loop {
let _e151 = j;
if !((_e151 < 4i)) {
break;
}
{
let _e158 = first_column;
let _e159 = j;
let _e162 = intervals;
x_3 = clamp((_e158 + _e159), 0i, _e162.z);
let _e166 = i;
let _e168 = by_row[_e166];
let _e169 = j;
let _e171 = by_column[_e169];
weight = (_e168 * _e171);
let _e174 = root;
let _e175 = weight;
let _e176 = x_3;
let _e177 = y;
let _e180 = textureLoad(roots, vec2<i32>(_e176, _e177), 0i);
root = (_e174 + (_e175 * _e180.xyz));
let _e184 = has_degrees_1;
if _e184 {
{
let _e185 = q;
let _e186 = weight;
let _e188 = x_3;
let _e190 = y;
let _e193 = textureLoad(degrees_, vec2<i32>((2i * _e188), _e190), 0i);
q = (_e185 + (_e186 * _e193.xyz));
let _e197 = u;
let _e198 = weight;
let _e200 = x_3;
let _e204 = y;
let _e207 = textureLoad(degrees_, vec2<i32>(((2i * _e200) + 1i), _e204), 0i);
u = (_e197 + (_e198 * _e207.xyz));
}
}
}
continuing {
let _e155 = j;
j = (_e155 + 1i);
}
}
}
continuing {
let _e130 = i;
i = (_e130 + 1i);
}
}
let _e211 = v_3;
let _e213 = sun_azimuth;
let _e216 = v_3;
let _e218 = sun_azimuth;
let _e222 = v_3;
across_1 = (((_e211.y * _e213.x) - (_e216.x * _e218.y)) / max(length(_e222.xy), 0.000000000001f));
let _e229 = root;
let _e230 = root;
xyz = (_e229 * _e230);
let _e233 = xyz;
let _e234 = xyz;
let _e235 = q;
let _e237 = xyz;
let _e238 = u;
let _e240 = across_1;
return Light(_e233, (_e234 * _e235), ((_e237 * _e238) * _e240));
}

fn moon_light(v_4: vec3<f32>, has_degrees_2: bool) -> Light {
var v_5: vec3<f32>;
var has_degrees_3: bool;
var light_1: Light = Light(vec3(0f), vec3(0f), vec3(0f));
var intervals_1: vec3<i32>;
var there_1: vec3<f32>;
var up_2: bool;
var local_8: i32;
var rows_2: i32;
var row_2: f32;
var column_2: f32;
var first_row_1: i32;
var first_column_1: i32;
var by_row_1: vec4<f32>;
var by_column_1: vec4<f32>;
var root_1: vec3<f32> = vec3(0f);
var q_1: vec3<f32> = vec3(0f);
var u_1: vec3<f32> = vec3(0f);
var i_1: i32 = 0i;
var local_9: i32;
var y_1: i32;
var j_1: i32;
var x_4: i32;
var weight_1: f32;
var across_2: f32;
var xyz_1: vec3<f32>;

v_5 = v_4;
has_degrees_3 = has_degrees_2;
let _e64 = moon_intervals;
intervals_1 = _e64;
let _e66 = intervals_1;
if (_e66.z == 0i) {
let _e70 = light_1;
return _e70;
}
let _e71 = moon_horizon;
let _e72 = moon_ends;
let _e73 = intervals_1;
let _e74 = moon_azimuth;
let _e76 = v_5;
let _e77 = place_in(Table(_e71, _e72, _e73, _e74), _e76);
there_1 = _e77;
let _e79 = there_1;
up_2 = (_e79.z == 0f);
let _e84 = up_2;
if _e84 {
let _e85 = intervals_1;
local_8 = _e85.x;
} else {
let _e87 = intervals_1;
local_8 = _e87.y;
}
let _e90 = local_8;
rows_2 = _e90;
let _e92 = there_1;
row_2 = _e92.x;
let _e95 = there_1;
column_2 = _e95.y;
let _e100 = row_2;
let _e101 = rows_2;
let _e105 = between(_e100, _e101, false, (&first_row_1));
by_row_1 = _e105;
let _e107 = column_2;
let _e108 = intervals_1;
let _e113 = between(_e107, _e108.z, true, (&first_column_1));
by_column_1 = _e113;
loop {
let _e126 = i_1;
if !((_e126 < 4i)) {
break;
}
{
let _e133 = first_row_1;
let _e134 = i_1;
let _e137 = rows_2;
let _e139 = up_2;
if _e139 {
local_9 = 0i;
} else {
let _e141 = intervals_1;
local_9 = (_e141.x + 1i);
}
let _e146 = local_9;
y_1 = (clamp((_e133 + _e134), 0i, _e137) + _e146);
j_1 = 0i;
loop {
let _e151 = j_1;
if !((_e151 < 4i)) {
break;
}
{
let _e158 = first_column_1;
let _e159 = j_1;
let _e162 = intervals_1;
x_4 = clamp((_e158 + _e159), 0i, _e162.z);
let _e166 = i_1;
let _e168 = by_row_1[_e166];
let _e169 = j_1;
let _e171 = by_column_1[_e169];
weight_1 = (_e168 * _e171);
let _e174 = root_1;
let _e175 = weight_1;
let _e176 = x_4;
let _e177 = y_1;
let _e180 = textureLoad(moon_roots, vec2<i32>(_e176, _e177), 0i);
root_1 = (_e174 + (_e175 * _e180.xyz));
let _e184 = has_degrees_3;
if _e184 {
{
let _e185 = q_1;
let _e186 = weight_1;
let _e188 = x_4;
let _e190 = y_1;
let _e193 = textureLoad(moon_degrees, vec2<i32>((2i * _e188), _e190), 0i);
q_1 = (_e185 + (_e186 * _e193.xyz));
let _e197 = u_1;
let _e198 = weight_1;
let _e200 = x_4;
let _e204 = y_1;
let _e207 = textureLoad(moon_degrees, vec2<i32>(((2i * _e200) + 1i), _e204), 0i);
u_1 = (_e197 + (_e198 * _e207.xyz));
}
}
}
continuing {
let _e155 = j_1;
j_1 = (_e155 + 1i);
}
}
}
continuing {
let _e130 = i_1;
i_1 = (_e130 + 1i);
}
}
let _e211 = v_5;
let _e213 = moon_azimuth;
let _e216 = v_5;
let _e218 = moon_azimuth;
let _e222 = v_5;
across_2 = (((_e211.y * _e213.x) - (_e216.x * _e218.y)) / max(length(_e222.xy), 0.000000000001f));
let _e229 = root_1;
let _e230 = root_1;
xyz_1 = (_e229 * _e230);
let _e233 = xyz_1;
let _e234 = xyz_1;
let _e235 = q_1;
let _e237 = xyz_1;
let _e238 = u_1;
let _e240 = across_2;
return Light(_e233, (_e234 * _e235), ((_e237 * _e238) * _e240));
}

fn lights(v_6: vec3<f32>, has_degrees_4: bool) -> Light {
var v_7: vec3<f32>;
var has_degrees_5: bool;
var a: Light;
var b: Light;

v_7 = v_6;
has_degrees_5 = has_degrees_4;
let _e56 = v_7;
let _e57 = has_degrees_5;
let _e58 = sun_light(_e56, _e57);
a = _e58;
let _e60 = v_7;
let _e61 = has_degrees_5;
let _e62 = moon_light(_e60, _e61);
b = _e62;
let _e64 = a;
let _e66 = b;
let _e69 = a;
let _e71 = b;
let _e74 = a;
let _e76 = b;
return Light((_e64.xyz + _e66.xyz), (_e69.q + _e71.q), (_e74.u + _e76.u));
}

fn beyond(direction: vec3<f32>) -> vec3<f32> {
var direction_1: vec3<f32>;
var v_8: vec3<f32>;
var nearest: f32;
var half_chord: f32;
var distance_: f32;
var up_3: vec3<f32>;
var sine: f32;
var elevation: f32;
var own: vec3<f32>;
var light_2: vec3<f32>;
var azimuth_1: f32;
var height_3: f32;
var above: bool;
var local_10: i32;
var rows_3: i32;
var local_11: f32;
var end_1: f32;
var layer: f32;
var first_layer: i32;
var first_row_2: i32;
var first_column_2: i32;
var by_layer: vec4<f32>;
var by_row_2: vec4<f32>;
var column_3: f32;
var by_column_2: vec4<f32>;
var root_2: vec3<f32> = vec3(0f);
var i_2: i32 = 0i;
var z: i32;
var j_2: i32;
var local_12: i32;
var y_2: i32;
var k: i32;
var x_5: i32;

direction_1 = direction;
let _e55 = direction_1;
let _e56 = direction_1;
v_8 = (_e55 / vec3(length(_e56)));
let _e61 = eye;
let _e62 = v_8;
nearest = (_e61 * length(_e62.xy));
let _e67 = v_8;
let _e71 = nearest;
if ((_e67.z >= 0f) || (_e71 >= 1f)) {
return vec3(0f);
}
let _e78 = nearest;
let _e81 = nearest;
half_chord = sqrt(((1f - _e78) * (1f + _e81)));
let _e86 = eye;
let _e89 = eye;
let _e93 = half_chord;
let _e94 = eye;
let _e95 = v_8;
distance_ = (((_e86 - 1f) * (_e89 + 1f)) / (_e93 - (_e94 * _e95.z)));
let _e101 = distance_;
let _e102 = v_8;
let _e104 = (_e101 * _e102.xy);
let _e105 = eye;
let _e106 = distance_;
let _e107 = v_8;
up_3 = normalize(vec3<f32>(_e104.x, _e104.y, (_e105 + (_e106 * _e107.z))));
let _e116 = up_3;
let _e117 = space_sun;
sine = clamp(dot(_e116, _e117), -1f, 1f);
let _e124 = sine;
elevation = asin(_e124);
let _e127 = elevation;
if (_e127 < DEEPEST) {
return vec3(0f);
}
let _e131 = v_8;
let _e132 = v_8;
let _e133 = up_3;
let _e135 = up_3;
own = (_e131 - (dot(_e132, _e133) * _e135));
let _e139 = space_sun;
let _e140 = sine;
let _e141 = up_3;
light_2 = (_e139 - (_e140 * _e141));
let _e145 = own;
let _e146 = light_2;
let _e151 = own;
let _e152 = light_2;
azimuth_1 = atan2((length(cross(_e145, _e146)) + 0.00000000000000000001f), dot(_e151, _e152));
let _e156 = space_ends;
let _e158 = half_chord;
let _e159 = nearest;
height_3 = (_e156.x - atan2(_e158, _e159));
let _e163 = height_3;
above = (_e163 >= 0f);
let _e167 = above;
if _e167 {
let _e168 = space_counts;
local_10 = _e168.y;
} else {
let _e170 = space_counts;
local_10 = _e170.z;
}
let _e173 = local_10;
rows_3 = _e173;
let _e175 = above;
if _e175 {
let _e176 = space_ends;
local_11 = _e176.y;
} else {
let _e178 = space_ends;
local_11 = _e178.z;
}
let _e181 = local_11;
end_1 = _e181;
let _e183 = elevation;
let _e191 = arsinh(((_e183 - -0.034906585f) / 0.10471976f));
let _e192 = space_layers;
let _e195 = space_layers;
layer = ((_e191 - _e192.x) / _e195.y);
let _e202 = layer;
let _e204 = space_counts;
let _e208 = space_counts;
let _e213 = between(clamp(_e202, 0f, f32(_e204.x)), _e208.x, false, (&first_layer));
by_layer = _e213;
let _e215 = rows_3;
let _e217 = height_3;
let _e219 = from_horizon(abs(_e217));
let _e221 = end_1;
let _e224 = rows_3;
let _e227 = rows_3;
let _e231 = between(clamp(((f32(_e215) * _e219) / _e221), 0f, f32(_e224)), _e227, false, (&first_row_2));
by_row_2 = _e231;
let _e233 = space_columns;
let _e235 = azimuth_1;
let _e237 = arsinh((_e235 / AZIMUTH_SCALE));
let _e239 = space_ends;
column_3 = ((f32(_e233) * _e237) / _e239.w);
let _e243 = column_3;
let _e245 = space_columns;
let _e248 = space_columns;
let _e252 = between(clamp(_e243, 0f, f32(_e245)), _e248, true, (&first_column_2));
by_column_2 = _e252;
loop {
let _e259 = i_2;
if !((_e259 < 4i)) {
break;
}
{
let _e266 = first_layer;
let _e267 = i_2;
let _e270 = space_counts;
let _e273 = space_counts;
let _e275 = space_counts;
z = (clamp((_e266 + _e267), 0i, _e270.x) * ((_e273.y + _e275.z) + 2i));
j_2 = 0i;
loop {
let _e284 = j_2;
if !((_e284 < 4i)) {
break;
}
{
let _e291 = z;
let _e292 = first_row_2;
let _e293 = j_2;
let _e296 = rows_3;
let _e299 = above;
if _e299 {
local_12 = 0i;
} else {
let _e301 = space_counts;
local_12 = (_e301.y + 1i);
}
let _e306 = local_12;
y_2 = ((_e291 + clamp((_e292 + _e293), 0i, _e296)) + _e306);
k = 0i;
loop {
let _e311 = k;
if !((_e311 < 4i)) {
break;
}
{
let _e318 = first_column_2;
let _e319 = k;
let _e322 = space_columns;
x_5 = clamp((_e318 + _e319), 0i, _e322);
let _e325 = root_2;
let _e326 = i_2;
let _e328 = by_layer[_e326];
let _e329 = j_2;
let _e331 = by_row_2[_e329];
let _e333 = k;
let _e335 = by_column_2[_e333];
let _e337 = x_5;
let _e338 = y_2;
let _e341 = textureLoad(space_roots, vec2<i32>(_e337, _e338), 0i);
root_2 = (_e325 + (((_e328 * _e331) * _e335) * _e341.xyz));
}
continuing {
let _e315 = k;
k = (_e315 + 1i);
}
}
}
continuing {
let _e288 = j_2;
j_2 = (_e288 + 1i);
}
}
}
continuing {
let _e263 = i_2;
i_2 = (_e263 + 1i);
}
}
let _e345 = root_2;
let _e346 = root_2;
return (_e345 * _e346);
}

fn hosek_wilkie(v_9: vec3<f32>) -> vec3<f32> {
var v_10: vec3<f32>;
var cosine: f32;
var gamma: f32;
var square: f32;
var haze: vec3<f32>;
var level: vec3<f32>;
var around: vec3<f32>;

v_10 = v_9;
let _e55 = v_10;
if (_e55.z < 0f) {
return vec3(0f);
}
let _e61 = v_10;
let _e62 = hosek_sun;
cosine = clamp(dot(_e61, _e62), -1f, 1f);
let _e69 = cosine;
gamma = acos(_e69);
let _e72 = cosine;
let _e73 = cosine;
square = (_e72 * _e73);
let _e77 = square;
let _e82 = hosek[8];
let _e86 = hosek[8];
let _e94 = hosek[8];
let _e97 = cosine;
haze = (vec3((1f + _e77)) / pow(((vec3(1f) + (_e82.xyz * _e86.xyz)) - ((2f * _e94.xyz) * _e97)), vec3(1.5f)));
let _e109 = hosek[0];
let _e113 = hosek[1];
let _e115 = v_10;
level = (vec3(1f) + (_e109.xyz * exp((_e113.xyz / vec3((_e115.z + 0.01f))))));
let _e128 = hosek[2];
let _e132 = hosek[3];
let _e136 = hosek[4];
let _e138 = gamma;
let _e145 = hosek[5];
let _e147 = square;
let _e152 = hosek[6];
let _e154 = haze;
let _e159 = hosek[7];
let _e161 = v_10;
around = ((((_e128.xyz + (_e132.xyz * exp((_e136.xyz * _e138)))) + (_e145.xyz * _e147)) + (_e152.xyz * _e154)) + (_e159.xyz * sqrt(_e161.z)));
let _e169 = hosek[9];
let _e171 = level;
let _e173 = around;
return ((_e169.xyz * _e171) * _e173);
}

fn pass_(v_11: vec3<f32>, light_3: Light) -> vec3<f32> {
var v_12: vec3<f32>;
var light_4: Light;
var level_1: f32;
var e1_: vec3<f32>;
var e2_: vec3<f32>;
var local_13: vec3<f32>;
var top: vec3<f32>;
var angle_4: f32;
var part: vec3<f32>;

v_12 = v_11;
light_4 = light_3;
let _e57 = v_12;
level_1 = max(length(_e57.xy), 0.000001f);
let _e63 = v_12;
let _e66 = v_12;
let _e69 = level_1;
let _e71 = ((-(_e63.z) * _e66.xy) / vec2(_e69));
let _e72 = level_1;
e1_ = vec3<f32>(_e71.x, _e71.y, _e72);
let _e77 = v_12;
let _e79 = v_12;
let _e84 = level_1;
e2_ = (vec3<f32>(_e77.y, -(_e79.x), 0f) / vec3(_e84));
let _e88 = projection;
let _e91 = projection;
if ((_e88 == 2i) || (_e91 == 1i)) {
local_13 = vec3<f32>(0f, 0f, 1f);
} else {
let _e101 = axes[1];
local_13 = _e101;
}
let _e103 = local_13;
top = _e103;
let _e105 = e2_;
let _e106 = top;
let _e108 = e1_;
let _e109 = top;
let _e112 = polariser;
angle_4 = (atan2(dot(_e105, _e106), dot(_e108, _e109)) + _e112);
let _e115 = light_4;
let _e118 = angle_4;
let _e122 = light_4;
let _e125 = angle_4;
part = ((_e115.q * cos((2f * _e118))) + (_e122.u * sin((2f * _e125))));
let _e132 = light_4;
let _e134 = part;
return max((0.5f * (_e132.xyz + _e134)), vec3(0f));
}

fn sequential(x_6: f32) -> vec3<f32> {
var x_7: f32;
var stops: array<vec3<f32>, 6> = array<vec3<f32>, 6>(vec3<f32>(0f, 0f, 0.02f), vec3<f32>(0.25f, 0.05f, 0.42f), vec3<f32>(0.58f, 0.15f, 0.4f), vec3<f32>(0.87f, 0.31f, 0.22f), vec3<f32>(0.98f, 0.62f, 0.12f), vec3<f32>(0.98f, 0.99f, 0.66f));
var u_2: f32;
var i_3: i32;

x_7 = x_6;
let _e81 = x_7;
u_2 = (clamp(_e81, 0f, 1f) * 5f);
let _e88 = u_2;
i_3 = min(i32(_e88), 4i);
let _e93 = i_3;
let _e95 = stops[_e93];
let _e96 = i_3;
let _e100 = stops[(_e96 + 1i)];
let _e101 = u_2;
let _e102 = i_3;
return mix(_e95, _e100, vec3((_e101 - f32(_e102))));
}

fn linear_srgb(c: vec3<f32>) -> vec3<f32> {
var c_1: vec3<f32>;

c_1 = c;
let _e61 = c_1;
let _e68 = c_1;
let _e75 = c_1;
return vec3<f32>(dot(vec3<f32>(3.24097f, -1.5373832f, -0.49861076f), _e61), dot(vec3<f32>(-0.96924365f, 1.8759675f, 0.04155506f), _e68), dot(vec3<f32>(0.05563008f, -0.20397696f, 1.0569715f), _e75));
}

fn columns_at(v_13: vec3<f32>, t_1: ptr<function, f32>) -> vec2<i32> {
var v_14: vec3<f32>;
var u_3: f32;
var local_14: f32;
var first_1: i32;

v_14 = v_13;
let _e56 = v_14;
let _e58 = v_14;
u_3 = ((atan2(_e56.y, _e58.x) * 768f) / PI);
let _e65 = u_3;
if (_e65 < 0f) {
let _e68 = u_3;
local_14 = (_e68 + 1536f);
} else {
let _e71 = u_3;
local_14 = _e71;
}
let _e73 = local_14;
u_3 = _e73;
let _e74 = u_3;
first_1 = i32(_e74);
let _e77 = u_3;
let _e78 = first_1;
(*t_1) = (_e77 - f32(_e78));
let _e81 = first_1;
let _e84 = first_1;
return vec2<i32>((_e81 % 1536i), ((_e84 + 1i) % 1536i));
}

fn slope_of(columns: vec2<i32>, t_2: f32, ring: i32) -> f32 {
var columns_1: vec2<i32>;
var t_3: f32;
var ring_1: i32;

columns_1 = columns;
t_3 = t_2;
ring_1 = ring;
let _e59 = columns_1;
let _e61 = ring_1;
let _e64 = textureLoad(slopes, vec2<i32>(_e59.x, _e61), 0i);
let _e66 = columns_1;
let _e68 = ring_1;
let _e71 = textureLoad(slopes, vec2<i32>(_e66.y, _e68), 0i);
let _e73 = t_3;
return mix(_e64.x, _e71.x, _e73);
}

fn meet(v_15: vec3<f32>, ring_2: ptr<function, f32>) -> f32 {
var v_16: vec3<f32>;
var t_4: f32;
var level_2: f32;
var slope: f32;
var columns_2: vec2<i32>;
var near: i32 = 0i;
var far: i32 = 511i;
var below: f32;
var above_1: f32;
var middle: i32;
var here: f32;

v_16 = v_15;
let _e57 = v_16;
level_2 = max(length(_e57.xy), 0.000000001f);
let _e63 = v_16;
let _e65 = level_2;
slope = (_e63.z / _e65);
let _e68 = v_16;
let _e71 = columns_at(_e68, (&t_4));
columns_2 = _e71;
(*ring_2) = 0f;
let _e78 = columns_2;
let _e79 = t_4;
let _e80 = near;
let _e81 = slope_of(_e78, _e79, _e80);
below = _e81;
let _e83 = columns_2;
let _e84 = t_4;
let _e85 = far;
let _e86 = slope_of(_e83, _e84, _e85);
above_1 = _e86;
let _e88 = above_1;
let _e89 = slope;
if (_e88 < _e89) {
return 0f;
}
let _e92 = below;
let _e93 = slope;
if (_e92 >= _e93) {
let _e97 = land[1];
let _e99 = v_16;
let _e106 = level_2;
return min((_e97.w / max(-(_e99.z), 0.000001f)), (20f / _e106));
}
loop {
let _e109 = far;
let _e110 = near;
if !(((_e109 - _e110) > 1i)) {
break;
}
{
let _e115 = near;
let _e116 = far;
middle = ((_e115 + _e116) / 2i);
let _e121 = columns_2;
let _e122 = t_4;
let _e123 = middle;
let _e124 = slope_of(_e121, _e122, _e123);
here = _e124;
let _e126 = here;
let _e127 = slope;
if (_e126 < _e127) {
{
let _e129 = middle;
near = _e129;
let _e130 = here;
below = _e130;
}
} else {
{
let _e131 = middle;
far = _e131;
let _e132 = here;
above_1 = _e132;
}
}
}
}
let _e133 = near;
let _e135 = slope;
let _e136 = below;
let _e138 = above_1;
let _e139 = below;
(*ring_2) = (f32(_e133) + ((_e135 - _e136) / max((_e138 - _e139), 0.000000001f)));
let _e147 = (*ring_2);
let _e151 = level_2;
return ((20f * exp((0.021530528f * _e147))) / _e151);
}

fn normal_at(v_17: vec3<f32>, ring_3: f32) -> vec3<f32> {
var v_18: vec3<f32>;
var ring_4: f32;
var t_5: f32;
var columns_3: vec2<i32>;
var near_1: i32;
var first_2: vec2<f32>;
var second_1: vec2<f32>;
var level_3: vec2<f32>;

v_18 = v_17;
ring_4 = ring_3;
let _e58 = v_18;
let _e61 = columns_at(_e58, (&t_5));
columns_3 = _e61;
let _e63 = ring_4;
near_1 = min(i32(_e63), 510i);
let _e68 = columns_3;
let _e70 = near_1;
let _e73 = textureLoad(normals, vec2<i32>(_e68.x, _e70), 0i);
let _e75 = columns_3;
let _e77 = near_1;
let _e80 = textureLoad(normals, vec2<i32>(_e75.y, _e77), 0i);
let _e82 = t_5;
first_2 = mix(_e73.xy, _e80.xy, vec2(_e82));
let _e86 = columns_3;
let _e88 = near_1;
let _e93 = textureLoad(normals, vec2<i32>(_e86.x, (_e88 + 1i)), 0i);
let _e95 = columns_3;
let _e97 = near_1;
let _e102 = textureLoad(normals, vec2<i32>(_e95.y, (_e97 + 1i)), 0i);
let _e104 = t_5;
second_1 = mix(_e93.xy, _e102.xy, vec2(_e104));
let _e108 = first_2;
let _e109 = second_1;
let _e110 = ring_4;
let _e111 = near_1;
level_3 = mix(_e108, _e109, vec2((_e110 - f32(_e111))));
let _e117 = level_3;
let _e119 = level_3;
let _e120 = level_3;
return vec3<f32>(_e117.x, _e117.y, sqrt(max((1f - dot(_e119, _e120)), 0f)));
}

fn sunlit(point: vec3<f32>) -> f32 {
var point_1: vec3<f32>;
var u_4: vec2<f32>;
var cell_1: vec2<i32>;
var t_6: vec2<f32>;
var low: f32;
var high: f32;

point_1 = point;
let _e55 = point_1;
u_4 = ((_e55.xy / vec2(250f)) + vec2(255.5f));
let _e64 = u_4;
let _e66 = u_4;
let _e71 = u_4;
let _e73 = u_4;
if ((min(_e64.x, _e66.y) < 0f) || (max(_e71.x, _e73.y) >= 511f)) {
return 1f;
}
let _e80 = u_4;
cell_1 = vec2<i32>(_e80);
let _e83 = u_4;
let _e84 = cell_1;
t_6 = (_e83 - vec2<f32>(_e84));
let _e88 = cell_1;
let _e90 = textureLoad(shadows, _e88, 0i);
let _e92 = cell_1;
let _e98 = textureLoad(shadows, (_e92 + vec2<i32>(1i, 0i)), 0i);
let _e100 = t_6;
low = mix(_e90.x, _e98.x, _e100.x);
let _e104 = cell_1;
let _e110 = textureLoad(shadows, (_e104 + vec2<i32>(0i, 1i)), 0i);
let _e112 = cell_1;
let _e118 = textureLoad(shadows, (_e112 + vec2<i32>(1i, 1i)), 0i);
let _e120 = t_6;
high = mix(_e110.x, _e118.x, _e120.x);
let _e124 = point_1;
let _e126 = low;
let _e127 = high;
let _e128 = t_6;
return clamp((((_e124.z - mix(_e126, _e127, _e128.y)) / 20f) + 0.5f), 0f, 1f);
}

fn sunlight_at(altitude: f32, elevation_1: f32, here_1: f32) -> vec3<f32> {
var altitude_1: f32;
var elevation_2: f32;
var here_2: f32;
var turn: f32;
var u_5: f32;
var w_1: f32;
var node: vec2<i32>;
var t_7: vec2<f32>;
var low_1: vec3<f32>;
var high_1: vec3<f32>;

altitude_1 = altitude;
elevation_2 = elevation_1;
here_2 = here_1;
let _e59 = elevation_2;
let _e60 = here_2;
turn = clamp(((_e59 - _e60) / 0.19f), -1f, 1f);
let _e69 = turn;
let _e71 = turn;
u_5 = (((sign(_e69) * sqrt(abs(_e71))) + 1f) * 32f);
let _e80 = altitude_1;
w_1 = (sqrt(clamp((_e80 / 4000f), 0f, 1f)) * 11f);
let _e90 = u_5;
let _e91 = w_1;
node = min(vec2<i32>(i32(_e90), i32(_e91)), vec2<i32>(63i, 10i));
let _e100 = u_5;
let _e101 = w_1;
let _e103 = node;
t_7 = (vec2<f32>(_e100, _e101) - vec2<f32>(_e103));
let _e107 = node;
let _e109 = textureLoad(sunlight, _e107, 0i);
let _e111 = node;
let _e117 = textureLoad(sunlight, (_e111 + vec2<i32>(1i, 0i)), 0i);
let _e119 = t_7;
low_1 = mix(_e109.xyz, _e117.xyz, vec3(_e119.x));
let _e124 = node;
let _e130 = textureLoad(sunlight, (_e124 + vec2<i32>(0i, 1i)), 0i);
let _e132 = node;
let _e138 = textureLoad(sunlight, (_e132 + vec2<i32>(1i, 1i)), 0i);
let _e140 = t_7;
high_1 = mix(_e130.xyz, _e138.xyz, vec3(_e140.x));
let _e145 = low_1;
let _e146 = high_1;
let _e147 = t_7;
let _e152 = linear_srgb(exp2(mix(_e145, _e146, vec3(_e147.y))));
return max(_e152, vec3(0f));
}

fn cover(altitude_2: f32, level_4: f32) -> vec3<f32> {
var altitude_3: f32;
var level_5: f32;
var colour: vec3<f32>;

altitude_3 = altitude_2;
level_5 = level_4;
let _e66 = level_5;
let _e71 = altitude_3;
colour = mix(vec3<f32>(0.09f, 0.12f, 0.05f), vec3<f32>(0.03f, 0.045f, 0.02f), vec3(clamp(min(((0.995f - _e66) / 0.02f), ((1400f - _e71) / 200f)), 0f, 1f)));
let _e82 = colour;
let _e88 = level_5;
let _e92 = altitude_3;
colour = mix(_e82, vec3<f32>(0.19f, 0.17f, 0.15f), vec3(clamp(max(((0.85f - _e88) / 0.08f), ((_e92 - 1500f) / 400f)), 0f, 1f)));
let _e103 = colour;
let _e108 = altitude_3;
return mix(_e103, vec3<f32>(0.75f, 0.77f, 0.8f), vec3(clamp(((_e108 - 1900f) / 150f), 0f, 1f)));
}

fn surface(v_19: vec3<f32>, distance_1: f32, ring_5: f32) -> vec3<f32> {
var v_20: vec3<f32>;
var distance_2: f32;
var ring_6: f32;
var radius_1: f32;
var point_2: vec3<f32>;
var up_4: vec3<f32>;
var way: f32;
var altitude_4: f32;
var normal: vec3<f32>;
var sun: f32;
var facing: f32;
var local_15: vec3<f32>;
var direct: vec3<f32>;
var sky: vec3<f32>;

v_20 = v_19;
distance_2 = distance_1;
ring_6 = ring_5;
let _e61 = land[2];
radius_1 = _e61.w;
let _e64 = distance_2;
let _e65 = v_20;
let _e67 = (_e64 * _e65.xy);
let _e70 = land[1];
let _e72 = distance_2;
let _e73 = v_20;
point_2 = vec3<f32>(_e67.x, _e67.y, (_e70.w + (_e72 * _e73.z)));
let _e81 = point_2;
let _e84 = radius_1;
up_4 = normalize((_e81 + vec3<f32>(0f, 0f, _e84)));
let _e89 = point_2;
let _e91 = point_2;
let _e92 = point_2;
let _e95 = radius_1;
way = (_e89.z + (dot(_e91, _e92) / (2f * _e95)));
let _e101 = way;
let _e106 = way;
let _e108 = radius_1;
altitude_4 = ((2f * _e101) / (1f + sqrt(max((1f + ((2f * _e106) / _e108)), 0f))));
let _e117 = v_20;
let _e118 = ring_6;
let _e119 = normal_at(_e117, _e118);
let _e120 = up_4;
let _e121 = _e120.xy;
normal = normalize((_e119 + vec3<f32>(_e121.x, _e121.y, 0f)));
let _e129 = up_4;
let _e130 = land_sun;
sun = asin(clamp(dot(_e129, _e130), -1f, 1f));
let _e138 = normal;
let _e139 = land_sun;
let _e143 = point_2;
let _e149 = sunlit((_e143 + vec3<f32>(0f, 0f, 3f)));
facing = (max(dot(_e138, _e139), 0f) * _e149);
let _e152 = facing;
if (_e152 > 0f) {
let _e155 = facing;
let _e156 = altitude_4;
let _e157 = sun;
let _e158 = land_sun;
let _e165 = sunlight_at(_e156, _e157, asin(clamp(_e158.z, -1f, 1f)));
local_15 = (_e155 * _e165);
} else {
local_15 = vec3(0f);
}
let _e170 = local_15;
direct = _e170;
let _e174 = normal;
let _e180 = land[3];
let _e184 = land[4];
let _e185 = _e184.xy;
sky = ((0.5f + (0.5f * _e174.z)) * vec3<f32>(_e180.w, _e185.x, _e185.y));
let _e191 = altitude_4;
let _e192 = normal;
let _e194 = cover(_e191, _e192.z);
let _e198 = direct;
let _e199 = sky;
return ((_e194 / vec3(3.1415927f)) * (_e198 + _e199));
}

fn lobe(weight_2: f32, g: f32, cosine_1: f32) -> f32 {
var weight_3: f32;
var g_1: f32;
var cosine_2: f32;
var x_8: f32;

weight_3 = weight_2;
g_1 = g;
cosine_2 = cosine_1;
let _e60 = g_1;
let _e63 = g_1;
let _e67 = g_1;
let _e70 = cosine_2;
x_8 = (((1f - _e60) * (1f - _e63)) + ((2f * _e67) * (1f - _e70)));
let _e75 = weight_3;
let _e77 = g_1;
let _e78 = g_1;
let _e82 = x_8;
let _e83 = x_8;
return ((_e75 * (1f - (_e77 * _e78))) / (_e82 * sqrt(_e83)));
}

fn shape(v_21: vec3<f32>) -> f32 {
var v_22: vec3<f32>;
var way_1: vec3<f32>;
var cosine_3: f32;

v_22 = v_21;
let _e55 = v_22;
let _e56 = land_sun;
way_1 = (_e55 - _e56);
let _e61 = way_1;
let _e62 = way_1;
cosine_3 = (1f - (0.5f * dot(_e61, _e62)));
let _e69 = land[1];
let _e73 = land[1];
let _e78 = cosine_3;
let _e79 = cosine_3;
let _e86 = land[2];
let _e90 = land[3];
let _e92 = cosine_3;
let _e93 = lobe(_e86.x, _e90.x, _e92);
let _e97 = land[2];
let _e101 = land[3];
let _e103 = cosine_3;
let _e104 = lobe(_e97.y, _e101.y, _e103);
let _e108 = land[2];
let _e112 = land[3];
let _e114 = cosine_3;
let _e115 = lobe(_e108.z, _e112.z, _e114);
return ((((_e69.y + ((_e73.z * 0.75f) * (1f + (_e78 * _e79)))) + _e93) + _e104) + _e115);
}

fn air_before(v_23: vec3<f32>, distance_3: f32, factors: ptr<function, vec3<f32>>) -> vec3<f32> {
var v_24: vec3<f32>;
var distance_4: f32;
var rows_4: i32;
var columns_4: i32;
var first_row_3: i32;
var level_6: f32;
var cosine_4: f32;
var column_4: f32;
var first_3: i32;
var row_3: f32;
var by_row_3: vec4<f32>;
var far_1: f32;
var first_slice: i32;
var by_slice: vec4<f32>;
var light_5: vec3<f32> = vec3(0f);
var depth: vec3<f32> = vec3(0f);
var k_1: i32 = 0i;
var slice: i32;
var i_4: i32;
var y_3: i32;
var j_3: i32;
var along_1: f32;
var local_16: f32;
var weight_4: f32;

v_24 = v_23;
distance_4 = distance_3;
let _e60 = land[0];
rows_4 = i32(_e60.w);
let _e66 = land[1];
columns_4 = i32(_e66.x);
let _e71 = v_24;
level_6 = max(length(_e71.xy), 0.000000001f);
let _e77 = v_24;
let _e79 = land_sun;
let _e82 = level_6;
let _e83 = land_sun;
cosine_4 = clamp((dot(_e77.xy, _e79.xy) / (_e82 * max(length(_e83.xy), 0.000000001f))), -1f, 1f);
let _e95 = cosine_4;
let _e98 = columns_4;
column_4 = ((acos(_e95) / PI) * f32((_e98 - 1i)));
let _e104 = column_4;
let _e106 = columns_4;
first_3 = min(i32(_e104), (_e106 - 2i));
let _e111 = v_24;
let _e113 = level_6;
let _e117 = land[0];
let _e122 = arsinh(((atan2(_e111.z, _e113) + _e117.x) / 0.04f));
let _e125 = land[0];
let _e130 = land[0];
row_3 = ((_e122 - _e125.y) * _e130.z);
let _e134 = row_3;
let _e136 = rows_4;
let _e141 = rows_4;
let _e147 = between(clamp(_e134, 0f, f32((_e136 - 1i))), (_e141 - 1i), false, (&first_row_3));
by_row_3 = _e147;
let _e149 = distance_4;
let _e152 = land[5];
let _e158 = land[5];
far_1 = clamp((log((_e149 / _e152.x)) * _e158.y), 0f, 47f);
let _e166 = far_1;
let _e171 = between(_e166, 47i, false, (&first_slice));
by_slice = _e171;
loop {
let _e181 = k_1;
if !((_e181 < 4i)) {
break;
}
{
let _e188 = first_slice;
let _e189 = k_1;
slice = clamp((_e188 + _e189), 0i, 47i);
i_4 = 0i;
loop {
let _e197 = i_4;
if !((_e197 < 4i)) {
break;
}
{
let _e204 = slice;
let _e205 = rows_4;
let _e207 = first_row_3;
let _e208 = i_4;
let _e211 = rows_4;
y_3 = ((_e204 * _e205) + clamp((_e207 + _e208), 0i, (_e211 - 1i)));
j_3 = 0i;
loop {
let _e219 = j_3;
if !((_e219 < 2i)) {
break;
}
{
let _e226 = column_4;
let _e227 = first_3;
along_1 = (_e226 - f32(_e227));
let _e231 = k_1;
let _e233 = by_slice[_e231];
let _e234 = i_4;
let _e236 = by_row_3[_e234];
let _e238 = j_3;
if (_e238 == 0i) {
let _e242 = along_1;
local_16 = (1f - _e242);
} else {
let _e244 = along_1;
local_16 = _e244;
}
let _e246 = local_16;
weight_4 = ((_e233 * _e236) * _e246);
let _e249 = light_5;
let _e250 = weight_4;
let _e252 = first_3;
let _e253 = j_3;
let _e256 = y_3;
let _e259 = textureLoad(air, vec2<i32>((2i * (_e252 + _e253)), _e256), 0i);
light_5 = (_e249 + (_e250 * _e259.xyz));
let _e263 = depth;
let _e264 = weight_4;
let _e266 = first_3;
let _e267 = j_3;
let _e272 = y_3;
let _e275 = textureLoad(air, vec2<i32>(((2i * (_e266 + _e267)) + 1i), _e272), 0i);
depth = (_e263 + (_e264 * _e275.xyz));
}
continuing {
let _e223 = j_3;
j_3 = (_e223 + 1i);
}
}
}
continuing {
let _e201 = i_4;
i_4 = (_e201 + 1i);
}
}
}
continuing {
let _e185 = k_1;
k_1 = (_e185 + 1i);
}
}
let _e279 = distance_4;
let _e281 = depth;
(*factors) = exp((-(_e279) * max(_e281, vec3(0f))));
let _e287 = light_5;
let _e289 = distance_4;
let _e291 = v_24;
let _e292 = shape(_e291);
return ((exp2(_e287) * _e289) * _e292);
}

fn land_light(v_25: vec3<f32>, distance_5: f32, ring_7: f32) -> vec3<f32> {
var v_26: vec3<f32>;
var distance_6: f32;
var ring_8: f32;
var factors_1: vec3<f32>;
var light_6: vec3<f32>;
var local_17: vec3<f32>;

v_26 = v_25;
distance_6 = distance_5;
ring_8 = ring_7;
let _e60 = v_26;
let _e61 = distance_6;
let _e64 = air_before(_e60, _e61, (&factors_1));
let _e65 = linear_srgb(_e64);
light_6 = _e65;
let _e67 = light_6;
let _e70 = land[4];
if (_e70.w > 0.5f) {
let _e74 = factors_1;
let _e75 = v_26;
let _e76 = distance_6;
let _e77 = ring_8;
let _e78 = surface(_e75, _e76, _e77);
local_17 = (_e74 * _e78);
} else {
local_17 = vec3(0f);
}
let _e83 = local_17;
return (_e67 + _e83);
}

fn sky_share(v_27: vec3<f32>, light_7: ptr<function, vec3<f32>>) -> f32 {
var v_28: vec3<f32>;
var ring_9: f32;
var here_3: f32;
var around_1: f32;
var local_18: f32;
var nearest_1: f32;
var local_19: f32;
var farthest: f32;
var local_20: vec3<f32>;
var i_5: i32 = 0i;
var corner: vec2<f32>;
var ignored: f32;
var local_21: f32;
var local_22: f32;
var sky_1: f32 = 0f;
var i_6: i32 = 0i;
var corner_1: vec2<f32>;
var way_2: vec3<f32>;
var distance_7: f32;

v_28 = v_27;
(*light_7) = vec3(0f);
let _e60 = land[4];
if (_e60.z < 0.5f) {
return 1f;
}
let _e66 = v_28;
let _e69 = meet(_e66, (&ring_9));
here_3 = _e69;
let _e71 = here_3;
around_1 = _e71;
let _e73 = here_3;
if (_e73 > 0f) {
let _e76 = here_3;
local_18 = _e76;
} else {
local_18 = 1000000000f;
}
let _e79 = local_18;
nearest_1 = _e79;
let _e81 = here_3;
if (_e81 > 0f) {
let _e84 = here_3;
local_19 = _e84;
} else {
local_19 = 1000000000f;
}
let _e87 = local_19;
farthest = _e87;
loop {
let _e92 = i_5;
if !((_e92 < 4i)) {
break;
}
{
let _e99 = i_5;
let _e102 = i_5;
corner = (vec2<f32>(f32((_e99 % 2i)), f32((_e102 / 2i))) - vec2(0.5f));
let _e113 = place_in_picture;
let _e115 = corner;
let _e119 = look((_e113.xy + _e115), (&local_20));
if !(_e119) {
continue;
}
let _e121 = axes;
let _e122 = local_20;
let _e126 = meet((_e121 * _e122), (&ignored));
around_1 = _e126;
let _e127 = around_1;
if (_e127 > 0f) {
let _e130 = around_1;
local_21 = _e130;
} else {
local_21 = 1000000000f;
}
let _e133 = local_21;
around_1 = _e133;
let _e134 = nearest_1;
let _e135 = around_1;
nearest_1 = min(_e134, _e135);
let _e137 = farthest;
let _e138 = around_1;
farthest = max(_e137, _e138);
}
continuing {
let _e96 = i_5;
i_5 = (_e96 + 1i);
}
}
let _e140 = farthest;
let _e142 = nearest_1;
if (_e140 <= (1.1f * _e142)) {
{
let _e145 = here_3;
if (_e145 > 0f) {
let _e148 = v_28;
let _e149 = here_3;
let _e150 = ring_9;
let _e151 = land_light(_e148, _e149, _e150);
(*light_7) = _e151;
}
let _e152 = here_3;
if (_e152 > 0f) {
local_22 = 0f;
} else {
local_22 = 1f;
}
let _e158 = local_22;
return _e158;
}
}
loop {
let _e163 = i_6;
if !((_e163 < 8i)) {
break;
}
{
let _e170 = i_6;
let _e176 = i_6;
corner_1 = (vec2<f32>(((f32(_e170) + 0.5f) / 8f), fract((((f32(_e176) + 0.5f) * 0.625f) + 0.125f))) - vec2(0.5f));
let _e190 = place_in_picture;
let _e192 = corner_1;
let _e196 = look((_e190.xy + _e192), (&local_20));
if !(_e196) {
continue;
}
let _e198 = axes;
let _e199 = local_20;
way_2 = (_e198 * _e199);
let _e202 = way_2;
let _e205 = meet(_e202, (&ring_9));
distance_7 = _e205;
let _e207 = distance_7;
if (_e207 > 0f) {
let _e210 = (*light_7);
let _e211 = way_2;
let _e212 = distance_7;
let _e213 = ring_9;
let _e214 = land_light(_e211, _e212, _e213);
(*light_7) = (_e210 + (_e214 / vec3(8f)));
} else {
let _e219 = sky_1;
sky_1 = (_e219 + 0.125f);
}
}
continuing {
let _e167 = i_6;
i_6 = (_e167 + 1i);
}
}
let _e222 = sky_1;
return _e222;
}

fn is_open(v_29: vec3<f32>) -> bool {
var v_30: vec3<f32>;
var t_8: f32;
var columns_5: vec2<i32>;

v_30 = v_29;
let _e56 = v_30;
let _e59 = columns_at(_e56, (&t_8));
columns_5 = _e59;
let _e63 = land[4];
let _e67 = columns_5;
let _e68 = t_8;
let _e70 = slope_of(_e67, _e68, 511i);
let _e71 = v_30;
let _e73 = v_30;
return ((_e63.z < 0.5f) || (_e70 < (_e71.z / max(length(_e73.xy), 0.000000001f))));
}

fn disc_light(v_31: vec3<f32>) -> vec3<f32> {
var v_32: vec3<f32>;
var way_3: vec3<f32>;
var square_1: f32;
var elevation_3: f32;
var mu: f32;
var u_6: f32;
var row_4: i32;
var sum: vec3<f32> = vec3(0f);
var k_2: i32 = 5i;

v_32 = v_31;
let _e55 = v_32;
let _e56 = disc_sun;
let _e58 = disc_axis;
way_3 = ((_e55 - _e56) / vec3(_e58.w));
let _e63 = way_3;
let _e64 = way_3;
square_1 = dot(_e63, _e64);
let _e67 = v_32;
let _e69 = v_32;
elevation_3 = atan2(_e67.z, length(_e69.xy));
let _e74 = square_1;
let _e77 = elevation_3;
let _e78 = disc_axis;
if ((_e74 > 1f) || (_e77 < _e78.z)) {
return vec3(0f);
}
let _e85 = square_1;
mu = sqrt((1f - _e85));
let _e89 = elevation_3;
let _e90 = disc_axis;
let _e93 = disc_axis;
u_6 = clamp(((_e89 - _e90.x) * _e93.y), 0f, 64f);
let _e100 = u_6;
row_4 = min(i32(_e100), 63i);
loop {
let _e110 = k_2;
if !((_e110 >= 0i)) {
break;
}
{
let _e117 = sum;
let _e118 = mu;
let _e120 = k_2;
let _e121 = row_4;
let _e124 = textureLoad(disc, vec2<i32>(_e120, _e121), 0i);
let _e126 = k_2;
let _e127 = row_4;
let _e132 = textureLoad(disc, vec2<i32>(_e126, (_e127 + 1i)), 0i);
let _e134 = u_6;
let _e135 = row_4;
sum = ((_e117 * _e118) + mix(_e124.xyz, _e132.xyz, vec3((_e134 - f32(_e135)))));
}
continuing {
let _e114 = k_2;
k_2 = (_e114 - 1i);
}
}
let _e141 = sum;
return max(_e141, vec3(0f));
}

fn spread(local_23: vec3<f32>) -> f32 {
var local_24: vec3<f32>;
var angle_5: f32;
var local_25: f32;

local_24 = local_23;
let _e55 = projection;
if (_e55 == 2i) {
let _e58 = local_24;
return length(_e58.xz);
}
let _e61 = projection;
if (_e61 == 3i) {
let _e64 = local_24;
let _e66 = local_24;
let _e69 = local_24;
return ((_e64.z * _e66.z) * _e69.z);
}
let _e72 = local_24;
angle_5 = acos(clamp(_e72.z, -1f, 1f));
let _e80 = angle_5;
if (_e80 > 0.001f) {
let _e83 = angle_5;
let _e85 = angle_5;
local_25 = (sin(_e83) / _e85);
} else {
local_25 = 1f;
}
let _e89 = local_25;
return _e89;
}

fn disc_mean() -> vec3<f32> {
var low_2: vec2<f32>;
var step_: vec2<f32>;
var sum_1: vec3<f32> = vec3(0f);
var local_26: vec3<f32>;
var whole: f32 = 0f;
var i_7: i32 = 0i;
var i_8: i32 = 0i;
var j_4: i32;
var v_33: vec3<f32>;
var local_27: vec3<f32>;

let _e53 = place_in_picture;
let _e58 = disc_box;
low_2 = max((_e53.xy - vec2(0.5f)), _e58.xy);
let _e62 = place_in_picture;
let _e67 = disc_box;
let _e70 = low_2;
step_ = (min((_e62.xy + vec2(0.5f)), _e67.zw) - _e70);
let _e73 = disc_axis;
let _e77 = step_;
let _e82 = step_;
if (((_e73.y <= 0f) || (_e77.x <= 0f)) || (_e82.y <= 0f)) {
return vec3(0f);
}
loop {
let _e97 = i_7;
if !((_e97 < 9i)) {
break;
}
{
let _e104 = place_in_picture;
let _e106 = i_7;
let _e109 = i_7;
let _e124 = look((_e104.xy + ((vec2<f32>(f32((_e106 % 3i)), f32((_e109 / 3i))) - vec2(1f)) / vec2(3f))), (&local_26));
if _e124 {
let _e125 = whole;
let _e126 = local_26;
let _e127 = spread(_e126);
whole = (_e125 + (_e127 / 9f));
}
}
continuing {
let _e101 = i_7;
i_7 = (_e101 + 1i);
}
}
let _e131 = step_;
let _e132 = disc_parts;
step_ = (_e131 / vec2(f32(_e132)));
loop {
let _e138 = i_8;
let _e139 = disc_parts;
if !((_e138 < _e139)) {
break;
}
{
j_4 = 0i;
loop {
let _e147 = j_4;
let _e148 = disc_parts;
if !((_e147 < _e148)) {
break;
}
{
let _e154 = low_2;
let _e155 = step_;
let _e156 = i_8;
let _e157 = j_4;
let _e168 = look((_e154 + (_e155 * (vec2<f32>(f32(_e156), f32(_e157)) + vec2(0.5f)))), (&local_26));
if !(_e168) {
continue;
}
let _e170 = axes;
let _e171 = local_26;
v_33 = (_e170 * _e171);
let _e174 = v_33;
let _e175 = is_open(_e174);
if _e175 {
let _e176 = sum_1;
let _e177 = local_26;
let _e178 = spread(_e177);
let _e179 = v_33;
let _e180 = disc_light(_e179);
sum_1 = (_e176 + (_e178 * _e180));
}
}
continuing {
let _e151 = j_4;
j_4 = (_e151 + 1i);
}
}
}
continuing {
let _e142 = i_8;
i_8 = (_e142 + 1i);
}
}
let _e183 = whole;
if (_e183 > 0f) {
let _e186 = sum_1;
let _e187 = step_;
let _e190 = step_;
let _e193 = whole;
local_27 = (((_e186 * _e187.x) * _e190.y) / vec3(_e193));
} else {
local_27 = vec3(0f);
}
let _e199 = local_27;
return _e199;
}

fn into_gamut(rgb: vec3<f32>) -> vec3<f32> {
var rgb_1: vec3<f32>;
var least: f32;
var luminance: f32;

rgb_1 = rgb;
let _e55 = rgb_1;
let _e57 = rgb_1;
let _e60 = rgb_1;
least = min(min(_e55.x, _e57.y), min(_e60.z, 0f));
let _e66 = rgb_1;
luminance = dot(_e66, vec3<f32>(0.2126f, 0.7152f, 0.0722f));
let _e73 = least;
if (_e73 == 0f) {
let _e76 = rgb_1;
return _e76;
}
let _e77 = luminance;
if (_e77 <= 0f) {
return vec3(0f);
}
let _e82 = luminance;
let _e83 = luminance;
let _e84 = luminance;
let _e85 = least;
let _e88 = rgb_1;
let _e89 = luminance;
return max((vec3(_e82) + ((_e83 / (_e84 - _e85)) * (_e88 - vec3(_e89)))), vec3(0f));
}

fn hable(x_9: vec3<f32>) -> vec3<f32> {
var x_10: vec3<f32>;

x_10 = x_9;
let _e55 = x_10;
let _e57 = x_10;
let _e66 = x_10;
let _e68 = x_10;
return ((((_e55 * ((0.15f * _e57) + vec3(0.05f))) + vec3(0.004f)) / ((_e66 * ((0.15f * _e68) + vec3(0.5f))) + vec3(0.06f))) - vec3(0.06666666f));
}

fn aces(v_34: vec3<f32>) -> vec3<f32> {
var v_35: vec3<f32>;

v_35 = v_34;
let _e55 = v_35;
let _e56 = v_35;
let _e64 = v_35;
let _e66 = v_35;
return (((_e55 * (_e56 + vec3(0.0245786f))) - vec3(0.000090537f)) / ((_e64 * ((0.983729f * _e66) + vec3(0.432951f))) + vec3(0.238081f)));
}

fn develop(rgb_2: vec3<f32>) -> vec3<f32> {
var rgb_3: vec3<f32>;
var scene: vec3<f32>;
var s: vec3<f32>;

rgb_3 = rgb_2;
let _e55 = rgb_3;
let _e56 = white;
scene = (_e55 / vec3(_e56));
let _e60 = is_daylight;
if _e60 {
{
let _e67 = scene;
let _e74 = scene;
let _e80 = scene;
scene = vec3<f32>(dot(vec3<f32>(0.963048f, -0.055734f, -0.01005f), _e67), dot(vec3<f32>(0.002642f, 1.013428f, -0.003697f), _e74), dot(vec3<f32>(0.004656f, 0.01677f, 1.188038f), _e80));
}
}
let _e83 = scene;
let _e84 = into_gamut(_e83);
scene = min(_e84, vec3(10000f));
let _e88 = tone;
if (_e88 == 1i) {
let _e92 = scene;
let _e97 = hable(min((2.927523f * _e92), vec3(11.2f)));
let _e100 = hable(vec3(11.2f));
scene = (_e97 / _e100);
}
let _e102 = tone;
if (_e102 == 2i) {
{
let _e106 = scene;
s = (1.461926f * _e106);
let _e113 = s;
let _e119 = s;
let _e125 = s;
let _e128 = aces(vec3<f32>(dot(vec3<f32>(0.59719f, 0.35458f, 0.04823f), _e113), dot(vec3<f32>(0.076f, 0.90834f, 0.01566f), _e119), dot(vec3<f32>(0.0284f, 0.13383f, 0.83777f), _e125)));
s = _e128;
let _e135 = s;
let _e143 = s;
let _e151 = s;
scene = vec3<f32>(dot(vec3<f32>(1.60475f, -0.53108f, -0.07367f), _e135), dot(vec3<f32>(-0.10208f, 1.10813f, -0.00605f), _e143), dot(vec3<f32>(-0.00327f, -0.07276f, 1.07602f), _e151));
}
}
let _e154 = scene;
scene = clamp(_e154, vec3(0f), vec3(1f));
let _e161 = scene;
let _e172 = scene;
let _e174 = scene;
return select(((1.055f * pow(_e161, vec3(0.41666666f))) - vec3(0.055f)), (12.92f * _e172), (_e174 <= vec3(0.0031308f)));
}

fn main_1() {
var local_28: vec3<f32>;
var v_36: vec3<f32>;
var is_other: bool;
var light_8: Light = Light(vec3(0f), vec3(0f), vec3(0f));
var local_29: f32;
var degree: f32;
var local_30: f32;
var half_of: f32;
var rgb_4: vec3<f32>;
var local_31: vec3<f32>;
var land_rgb: vec3<f32>;
var disc_xyz: vec3<f32>;
var sky_2: f32;
var local_32: vec3<f32>;
var rgb_5: vec3<f32>;
var local_33: vec3<f32>;

let _e55 = global.values[0];
size = _e55.xy;
let _e59 = global.values[1];
projection = i32(_e59.x);
let _e64 = global.values[2];
let _e65 = _e64.xyz;
let _e68 = global.values[3];
let _e69 = _e68.xyz;
let _e72 = global.values[4];
let _e73 = _e72.xyz;
axes = mat3x3<f32>(vec3<f32>(_e65.x, _e65.y, _e65.z), vec3<f32>(_e69.x, _e69.y, _e69.z), vec3<f32>(_e73.x, _e73.y, _e73.z));
let _e89 = global.values[5];
half_field = _e89.x;
let _e93 = global.values[6];
sun_horizon = _e93;
let _e96 = global.values[7];
moon_horizon = _e96;
let _e99 = global.values[8];
sun_ends = _e99.xyz;
let _e103 = global.values[9];
moon_ends = _e103.xyz;
let _e107 = global.values[10];
sun_intervals = vec3<i32>(_e107.xyz);
let _e112 = global.values[11];
moon_intervals = vec3<i32>(_e112.xyz);
let _e117 = global.values[12];
sun_azimuth = _e117.xy;
let _e121 = global.values[13];
moon_azimuth = _e121.xy;
let _e125 = global.values[14];
quantity = i32(_e125.x);
let _e130 = global.values[15];
polariser = _e130.x;
let _e134 = global.values[16];
has_polariser = (_e134.x != 0f);
let _e140 = global.values[17];
white = _e140.x;
let _e144 = global.values[18];
tone = i32(_e144.x);
let _e149 = global.values[19];
is_daylight = (_e149.x != 0f);
let _e155 = global.values[20];
is_beyond = (_e155.x != 0f);
let _e161 = global.values[21];
eye = _e161.x;
let _e165 = global.values[22];
space_sun = _e165.xyz;
let _e169 = global.values[23];
space_ends = _e169;
let _e172 = global.values[24];
space_layers = _e172.xy;
let _e176 = global.values[25];
space_counts = vec3<i32>(_e176.xyz);
let _e181 = global.values[26];
space_columns = i32(_e181.x);
let _e188 = global.values[27];
hosek[0i] = _e188;
let _e193 = global.values[28];
hosek[1i] = _e193;
let _e198 = global.values[29];
hosek[2i] = _e198;
let _e203 = global.values[30];
hosek[3i] = _e203;
let _e208 = global.values[31];
hosek[4i] = _e208;
let _e213 = global.values[32];
hosek[5i] = _e213;
let _e218 = global.values[33];
hosek[6i] = _e218;
let _e223 = global.values[34];
hosek[7i] = _e223;
let _e228 = global.values[35];
hosek[8i] = _e228;
let _e233 = global.values[36];
hosek[9i] = _e233;
let _e236 = global.values[37];
hosek_sun = _e236.xyz;
let _e240 = global.values[38];
divider = _e240.x;
let _e246 = global.values[39];
land[0i] = _e246;
let _e251 = global.values[40];
land[1i] = _e251;
let _e256 = global.values[41];
land[2i] = _e256;
let _e261 = global.values[42];
land[3i] = _e261;
let _e266 = global.values[43];
land[4i] = _e266;
let _e271 = global.values[44];
land[5i] = _e271;
let _e274 = global.values[45];
land_sun = _e274.xyz;
let _e278 = global.values[46];
disc_axis = _e278;
let _e281 = global.values[47];
disc_sun = _e281.xyz;
let _e285 = global.values[48];
disc_box = _e285;
let _e288 = global.values[49];
disc_parts = i32(_e288.x);
let _e292 = gl_FragCoord_1;
let _e294 = size;
let _e296 = gl_FragCoord_1;
place_in_picture = vec4<f32>(_e292.x, (_e294.y - _e296.y), 0f, 1f);
let _e303 = place_in_picture;
let _e307 = look(_e303.xy, (&local_28));
if !(_e307) {
{
colour_1 = vec4<f32>(0f, 0f, 0f, 1f);
return;
}
}
let _e314 = axes;
let _e315 = local_28;
v_36 = (_e314 * _e315);
let _e318 = place_in_picture;
let _e320 = divider;
let _e321 = size;
is_other = (_e318.x > (_e320 * _e321.x));
let _e334 = is_beyond;
if _e334 {
let _e336 = v_36;
let _e337 = beyond(_e336);
light_8.xyz = _e337;
} else {
let _e338 = is_other;
if !(_e338) {
let _e340 = v_36;
let _e341 = has_polariser;
let _e342 = quantity;
let _e346 = lights(_e340, (_e341 || (_e342 == 1i)));
light_8 = _e346;
}
}
let _e347 = quantity;
if (_e347 == 1i) {
{
let _e350 = light_8;
if (_e350.xyz.y > 0f) {
let _e355 = light_8;
let _e358 = light_8;
let _e363 = light_8;
local_29 = (length(vec2<f32>(_e355.q.y, _e358.u.y)) / _e363.xyz.y);
} else {
local_29 = 0f;
}
let _e369 = local_29;
degree = _e369;
let _e371 = degree;
let _e374 = sequential(min(_e371, 1f));
colour_1 = vec4<f32>(_e374.x, _e374.y, _e374.z, 1f);
return;
}
}
let _e380 = has_polariser;
if _e380 {
local_30 = 0.5f;
} else {
local_30 = 1f;
}
let _e384 = local_30;
half_of = _e384;
let _e386 = is_other;
if _e386 {
{
let _e387 = half_of;
let _e388 = v_36;
let _e389 = hosek_wilkie(_e388);
rgb_4 = (_e387 * _e389);
let _e392 = tone;
if (_e392 < 0i) {
let _e395 = rgb_4;
local_31 = _e395;
} else {
let _e396 = rgb_4;
let _e397 = develop(_e396);
local_31 = _e397;
}
let _e399 = local_31;
colour_1 = vec4<f32>(_e399.x, _e399.y, _e399.z, 1f);
return;
}
}
let _e406 = disc_mean();
disc_xyz = _e406;
let _e408 = v_36;
let _e411 = sky_share(_e408, (&land_rgb));
sky_2 = _e411;
let _e413 = sky_2;
let _e414 = has_polariser;
if _e414 {
let _e415 = v_36;
let _e416 = light_8;
let _e417 = pass_(_e415, _e416);
local_32 = _e417;
} else {
let _e418 = light_8;
local_32 = _e418.xyz;
}
let _e421 = local_32;
let _e422 = linear_srgb(_e421);
rgb_5 = (_e413 * _e422);
let _e425 = rgb_5;
let _e426 = half_of;
let _e427 = disc_xyz;
let _e428 = linear_srgb(_e427);
let _e429 = land_rgb;
rgb_5 = (_e425 + (_e426 * (_e428 + _e429)));
let _e433 = tone;
if (_e433 < 0i) {
let _e436 = rgb_5;
local_33 = _e436;
} else {
let _e437 = rgb_5;
let _e438 = develop(_e437);
local_33 = _e438;
}
let _e440 = local_33;
colour_1 = vec4<f32>(_e440.x, _e440.y, _e440.z, 1f);
return;
}

@fragment
fn main(@builtin(position) gl_FragCoord: vec4<f32>) -> FragmentOutput {
gl_FragCoord_1 = gl_FragCoord;
main_1();
let _e107 = colour_1;
return FragmentOutput(_e107);
}
