// All tables of welkin, one after the other: what the buffers of each have as `table`, from the element on that the
// functions are told as `first`. Declare it elsewhere to bind it elsewhere; the functions need only the name.
@group(0) @binding(0) var<storage, read> welkin_table: array<vec4<f32>>;
