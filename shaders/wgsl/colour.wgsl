// From CIE XYZ to linear sRGB (IEC 61966-2-1).
fn linear_srgb(xyz: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(xyz, vec3<f32>(3.24097, -1.5373832, -0.49861076)),
        dot(xyz, vec3<f32>(-0.96924365, 1.8759675, 0.04155506)),
        dot(xyz, vec3<f32>(0.05563008, -0.20397696, 1.0569715)),
    );
}
