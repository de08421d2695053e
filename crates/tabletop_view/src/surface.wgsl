// The light of the original program, worked out in display values: no gamma, no specular, no shadows. Vertices may have
// colours of their own, as displayed, by which that of the material is multiplied.

#import bevy_pbr::forward_io::VertexOutput

const AMBIENT: f32 = 0.8;
// The one white lamp, in units.
const LAMP_LOCATION: vec3<f32> = vec3<f32>(0.0, 0.0, 10.0);
const LAMP_RANGE: f32 = 50.0;

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> color: vec4<f32>;

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
    let light = AMBIENT + light_of_lamp(in.world_position.xyz, normalize(in.world_normal));
#ifdef VERTEX_COLORS
    let own_color = color.rgb * in.color.rgb;
#else
    let own_color = color.rgb;
#endif
    let shown = clamp(own_color * light, vec3<f32>(0.0), vec3<f32>(1.0));
    return vec4<f32>(linear_from_display(shown), color.a);
}

fn light_of_lamp(location: vec3<f32>, normal: vec3<f32>) -> f32 {
    let to_lamp = LAMP_LOCATION - location;
    let distance = max(length(to_lamp), 1e-6);
    let fall_off = max(1.0 - distance / LAMP_RANGE, 0.0);
    return max(dot(normal, to_lamp / distance), 0.0) * fall_off;
}

// The picture is stored as sRGB: the hardware encodes what a shader returns, and this undoes it.
fn linear_from_display(shown: vec3<f32>) -> vec3<f32> {
    let dark = shown / 12.92;
    let bright = pow((shown + 0.055) / 1.055, vec3<f32>(2.4));
    return select(bright, dark, shown <= vec3<f32>(0.04045));
}
