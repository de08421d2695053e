//! Random scenes that a task file can describe.

use bevy::math::Vec3;
use proptest::prelude::*;
use tabletop_core::{
    ChainSpec, Dynamics, JointMotion, JointedSpec, LidBoxSpec, ObjectSpec, Part, SceneItem,
    SceneSpec, Shape, Table,
};
use tabletop_geometry::{NAMED_COLORS, Pose, Rgb};

fn vectors(most: f32) -> impl Strategy<Value = Vec3> {
    let part = move || prop_oneof![-most..most, Just(0.0), Just(most), Just(-0.1)];
    (part(), part(), part()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn spans() -> impl Strategy<Value = Vec3> {
    let span = || prop_oneof![0.1..10.0_f32, Just(1000.0)];
    (span(), span(), span()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn poses() -> impl Strategy<Value = Pose> {
    let right_angles = prop::array::uniform3(-4..5_i32)
        .prop_map(|turns| Vec3::from_array(turns.map(|turn| turn as f32 * 90.0)));
    let degrees = prop_oneof![vectors(360.0), right_angles];
    (vectors(10_000.0), degrees)
        .prop_map(|(location, degrees)| Pose::from_degrees(location, degrees))
}

fn colors() -> impl Strategy<Value = Rgb> {
    let hex = any::<[u8; 3]>().prop_map(|bytes| {
        let [red, green, blue] = bytes.map(|byte| f32::from(byte) / 255.0);
        Rgb::new(red, green, blue)
    });
    prop_oneof![
        hex,
        prop::sample::select(&NAMED_COLORS[..]).prop_map(|(_, color)| color)
    ]
}

fn masses() -> impl Strategy<Value = f32> {
    prop_oneof![Just(0.0), 0.0..1e6_f32, 1e-30..1e-3_f32]
}

fn descriptions() -> impl Strategy<Value = Vec<(String, String)>> {
    let value = "[ -~\t\n\r\u{e9}\u{2028}\u{fffd}\u{1f600}]{0,12}";
    prop::collection::vec(("[_a-zA-Z0-9]{1,6}", value), 0..3)
}

/// The outer spans of a container, and a thickness of walls that leaves a hollow.
fn containers() -> impl Strategy<Value = (Vec3, f32)> {
    (spans(), 0.02..0.98_f32).prop_map(|(span, part)| {
        let most = (span.x / 2.0).min(span.y / 2.0).min(span.z);
        (span, part * most)
    })
}

fn shapes() -> impl Strategy<Value = Shape> {
    let length = || 0.001..1000.0_f32;
    let simple = prop_oneof![
        (spans(), colors()).prop_map(|(span, color)| Shape::Block { span, color }),
        (length(), length(), colors()).prop_map(|(radius, yspan, color)| Shape::Cylinder {
            radius,
            yspan,
            color
        }),
        (length(), colors()).prop_map(|(radius, color)| Shape::Sphere { radius, color }),
        (length(), length(), 3..32_u32, colors()).prop_map(|(radius, yspan, sides, color)| {
            Shape::Prism {
                radius,
                yspan,
                sides,
                color,
            }
        }),
        (length(), length(), length(), 3..1000_u32, colors()).prop_map(
            |(radius_top, radius_bottom, zspan, sides, color)| Shape::Frustum {
                radius_top,
                radius_bottom,
                zspan,
                sides,
                color,
            }
        ),
        (
            0.2..1000.0_f32,
            0.01..0.99_f32,
            length(),
            3..1000_u32,
            colors()
        )
            .prop_map(|(radius_outer, share, zspan, sides, color)| Shape::Ring {
                radius_outer,
                radius_inner: radius_outer * share,
                zspan,
                sides,
                color,
            }),
        (containers(), colors()).prop_map(|((span, thickness), color)| Shape::Box {
            span,
            thickness,
            color
        }),
    ];
    simple.prop_recursive(4, 12, 3, |inner| {
        let part = ("[_a-zA-Z0-9]{0,3}", poses(), inner).prop_map(|(id, pose, shape)| Part {
            pointable: false,
            id,
            pose,
            shape,
        });
        prop::collection::vec(part, 1..4).prop_map(|parts| Shape::Composite { parts })
    })
}

fn objects() -> impl Strategy<Value = ObjectSpec> {
    (
        "[_a-zA-Z0-9]{0,5}",
        poses(),
        masses(),
        shapes(),
        dynamics(),
        descriptions(),
    )
        .prop_map(
            |(id, pose, mass, shape, dynamics, descriptions)| ObjectSpec {
                id,
                pose,
                mass,
                shape,
                dynamics,
                descriptions,
            },
        )
}

fn dynamics() -> impl Strategy<Value = Dynamics> {
    let some = |most: f32| prop::option::of(0.0..most);
    (some(1000.0), some(1.0), vectors(1000.0)).prop_map(|(friction, restitution, velocity)| {
        Dynamics {
            friction,
            restitution,
            velocity,
        }
    })
}

fn chains() -> impl Strategy<Value = ChainSpec> {
    let ends = (vectors(100.0), vectors(100.0))
        .prop_filter("two places", |(start, end)| start.distance(*end) > 0.001);
    let link = (
        1.0..10.0_f32,
        prop::option::of(0..10_u32),
        0.0..2.0_f32,
        masses(),
    );
    ("[_a-zA-Z0-9]{0,5}", ends, link, colors()).prop_map(
        |(id, (start, end), (yspan, spare_links, link_padding, link_mass), color)| {
            let chain = ChainSpec {
                id,
                start,
                end,
                link_span: Vec3::new(0.1, yspan, 0.2),
                link_count: 0,
                link_padding,
                link_mass,
                color,
            };
            let link_count = spare_links.map_or(0, |spare| chain.least_links().max(1) + spare);
            ChainSpec {
                link_count,
                ..chain
            }
        },
    )
}

fn lidboxes() -> impl Strategy<Value = LidBoxSpec> {
    let boxes = (containers(), colors(), masses());
    let lids = (containers(), colors(), masses());
    ("[_a-zA-Z0-9]{0,5}", poses(), boxes, lids, descriptions()).prop_map(
        |(
            id,
            pose,
            ((span, thickness), color, box_mass),
            (handle, handle_color, lid_mass),
            descriptions,
        )| LidBoxSpec {
            id,
            pose,
            span,
            thickness,
            box_mass,
            lid_mass,
            color,
            handle_span: handle.0,
            handle_thickness: handle.1,
            handle_color,
            descriptions,
        },
    )
}

fn joints() -> impl Strategy<Value = JointedSpec> {
    let motion = prop_oneof![Just(JointMotion::Slide), Just(JointMotion::Turn)];
    let limits = (-180.0..180.0_f32, -180.0..180.0_f32, 0.0..=1.0_f32);
    (
        poses(),
        objects(),
        objects(),
        motion,
        limits,
        any::<bool>(),
        0.0..=1.0_f32,
    )
        .prop_map(
            |(pose, first, second, motion, (one, other, share), collides, damping)| {
                let limits = [one.min(other), one.max(other)];
                JointedSpec {
                    pose,
                    objects: [first, second],
                    motion,
                    limits,
                    init: (limits[0] + share * (limits[1] - limits[0])).min(limits[1]),
                    collides,
                    damping,
                }
            },
        )
}

/// Whole scenes.
pub fn scenes() -> impl Strategy<Value = SceneSpec> {
    let table =
        (0.001..1000.0_f32, 0.001..1000.0_f32).prop_map(|(xspan, yspan)| Table { xspan, yspan });
    let item = prop_oneof![
        4 => objects().prop_map(SceneItem::Object),
        1 => chains().prop_map(SceneItem::Chain),
        1 => lidboxes().prop_map(SceneItem::LidBox),
        1 => joints().prop_map(SceneItem::Jointed),
    ];
    (table, prop::collection::vec(item, 0..5)).prop_map(|(table, items)| SceneSpec { table, items })
}
