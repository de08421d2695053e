// The floor: brightest around the table, which takes some of its light, and like the distance far from it.

#import bevy_pbr::forward_io::VertexOutput

struct Floor {
    near: vec4<f32>,
    far: vec4<f32>,
    span: vec2<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> floor: Floor;

// In units: as far from the table as it darkens the floor, and as far as the floor is seen.
const GLOOM: f32 = 3.5;
const REACH: f32 = 60.0;

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
    let place = in.world_position.xy;
    let beyond = length(max(abs(place) - 0.5 * floor.span, vec2<f32>(0.0)));
    let gloom = 0.6 * exp(-beyond / GLOOM);
    let distance = smoothstep(0.0, REACH, beyond);
    return vec4<f32>(mix(floor.near.rgb * (1.0 - gloom), floor.far.rgb, distance), 1.0);
}
