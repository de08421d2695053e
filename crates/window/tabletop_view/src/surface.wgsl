// Surfaces show a share of their colour that depends on the direction in which they face (`tabletop_core::Light`), in display
// values. Vertices may have colours of their own, as displayed, by which that of the material is multiplied.

#import bevy_pbr::forward_io::VertexOutput
#import tabletop_view::display::linear_from_display

struct Surface {
    color: vec4<f32>,
    along: vec3<f32>,
    against: vec3<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> surface: Surface;

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
#ifdef VERTEX_COLORS
    let own_color = surface.color.rgb * in.color.rgb;
#else
    let own_color = surface.color.rgb;
#endif
    let shown = clamp(own_color * share(normalize(in.world_normal)), vec3<f32>(0.0), vec3<f32>(1.0));
    // The nearest bytes, by the rule of the robot's eye.
    let bytes = floor(shown * 255.0 + 0.5);
    return vec4<f32>(linear_from_display(bytes / 255.0), surface.color.a);
}

fn share(normal: vec3<f32>) -> f32 {
    let shares = select(surface.against, surface.along, normal > vec3<f32>(0.0));
    return dot(normal * normal, shares);
}
