// The light on the table's top: a soft pool of it, less where the vertices' colours are shadows. What is drawn takes it where it is darker.

#import bevy_pbr::forward_io::VertexOutput
#import tabletop_view::display::linear_from_display

struct Shade {
    span: vec2<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> shade: Shade;

// As displayed: in the middle of the pool, and far from it.
const BRIGHT: vec3<f32> = vec3<f32>(0.95, 0.945, 0.93);
const DIM: vec3<f32> = vec3<f32>(0.86, 0.85, 0.835);

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
    let place = in.world_position.xy;
    if any(abs(place) > 0.5 * shade.span) {
        discard;
    }
    let pool = smoothstep(0.2, 1.1, length(place / (0.62 * shade.span)));
    // How dark the shadow is, and which part of that is here.
    let shadow = in.color.r * smoothstep(0.0, 1.0, in.color.g);
    let shown = mix(BRIGHT, DIM, pool) * (1.0 - shadow);
    return vec4<f32>(linear_from_display(shown), 1.0);
}
