// One translucent colour, whatever the light: as it is within a box, and fading away around it.

#import bevy_pbr::forward_io::VertexOutput

struct Sheet {
    color: vec4<f32>,
    least: vec3<f32>,
    most: vec3<f32>,
    fade: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> sheet: Sheet;

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
    let point = in.world_position.xyz;
    let outside = max(max(sheet.least - point, point - sheet.most), vec3<f32>(0.0));
    let opacity = 1.0 - smoothstep(0.0, sheet.fade, length(outside));
    return vec4<f32>(sheet.color.rgb, sheet.color.a * opacity);
}
