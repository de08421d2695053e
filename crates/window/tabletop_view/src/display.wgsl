// Colours as displayed. The picture is stored as sRGB: the hardware encodes what a shader returns, and this undoes it.

#define_import_path tabletop_view::display

fn linear_from_display(shown: vec3<f32>) -> vec3<f32> {
    let dark = shown / 12.92;
    let bright = pow((shown + 0.055) / 1.055, vec3<f32>(2.4));
    return select(bright, dark, shown <= vec3<f32>(0.04045));
}
