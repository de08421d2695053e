//! The lines that help the user to place the held object (report section 4, figure 8): its outline, the axes about which
//! it can be turned, its shadow, and where the plane in which it is dragged meets table and objects. What the other hand holds and what the
//! keyboard has chosen have outlines of their own.

use bevy::prelude::*;
use tabletop_core::{Hand, Hands, ObjectSpec};
use tabletop_geometry::{Pose, Primitive};
use tabletop_user::{Chosen, DragPlane, HeldAxes, UserCamera};

use crate::{
    held::HeldVisual,
    section::Plane,
    silhouette,
    visual::{Filled, Visual},
};

/// Length of their arrowheads in units.
const ARROW_TIP: f32 = 0.3;

/// Edge of the cube at a bond point, in units.
const BOND_POINT: f32 = 0.1;

/// Length of the arms of the cross at the foot of the shadow line, in units.
const FOOT: f32 = 0.3;

/// Bias of thin and thick lines towards the viewer, so that they are wholly visible on the surfaces along which they
/// run: a twentieth and a seventh of a unit at the distance of the table.
const THIN_IN_FRONT: f32 = -0.0004;
const THICK_IN_FRONT: f32 = -0.001;

/// Outlines of what the other hand holds, and of what the keyboard has chosen.
const OTHER_HAND: Color = Color::srgb(1.0, 0.6, 0.1);
const CHOSEN: Color = Color::srgb(0.25, 0.77, 0.71);

/// Axes, shadow and sections.
#[derive(Default, Reflect, GizmoConfigGroup)]
pub(crate) struct ThinLines;

/// The outline of the held object.
#[derive(Default, Reflect, GizmoConfigGroup)]
pub(crate) struct ThickLines;

pub(crate) fn plugin(app: &mut App) {
    app.insert_gizmo_config(ThinLines, lines(2.0, THIN_IN_FRONT))
        .insert_gizmo_config(ThickLines, lines(3.0, THICK_IN_FRONT))
        .add_systems(
            Update,
            (
                (draw_outline, draw_other_outlines),
                draw_axes,
                draw_shadow,
                draw_sections,
                draw_bond_points,
            ),
        );
}

/// Lines of this width in pixels at any distance.
fn lines(width: f32, depth_bias: f32) -> GizmoConfig {
    GizmoConfig {
        line: GizmoLineConfig {
            width,
            joints: GizmoLineJoint::Round(4),
            ..default()
        },
        depth_bias,
        ..default()
    }
}

fn draw_outline(
    mut gizmos: Gizmos<ThickLines>,
    held: HeldVisual,
    camera: Single<&Transform, With<UserCamera>>,
) {
    if let Some(held) = held.get() {
        let eye = Pose::from(*camera);
        for line in silhouette::outline(eye, held.pose, held.solids) {
            gizmos.linestrip(line, Color::BLACK);
        }
    }
}

fn draw_other_outlines(
    mut gizmos: Gizmos<ThickLines>,
    held: HeldVisual,
    hands: Res<Hands>,
    chosen: Res<Chosen>,
    camera: Single<&Transform, With<UserCamera>>,
) {
    let eye = Pose::from(*camera);
    let selected = hands.held_by(hands.selected);
    let others = Hand::ALL.into_iter().filter_map(|hand| hands.held_by(hand));
    let others = others.filter(|&object| Some(object) != selected);
    let marked = others.map(|object| (object, OTHER_HAND));
    for (object, color) in marked.chain(chosen.0.map(|object| (object, CHOSEN))) {
        if let Some(drawn) = held.of(object) {
            for line in silhouette::outline(eye, drawn.pose, drawn.solids) {
                gizmos.linestrip(line, color);
            }
        }
    }
}

/// Draws yellow cubes at the bond points of the held object, and at those where others can be fastened to it.
fn draw_bond_points(
    mut gizmos: Gizmos<ThinLines>,
    held: HeldVisual,
    hands: Res<Hands>,
    objects: Query<&ObjectSpec>,
) {
    let object = hands.held_by(hands.selected);
    let spec = object.and_then(|object| objects.get(object).ok());
    let (Some(held), Some(spec)) = (held.get(), spec) else {
        return;
    };
    for point in spec.bond_points() {
        let place = Transform::from(held.pose * point.pose);
        let cube = place.with_scale(Vec3::splat(BOND_POINT));
        gizmos.cube(cube, Color::srgb(1.0, 1.0, 0.0));
    }
}

fn draw_axes(mut gizmos: Gizmos<ThinLines>, held: HeldVisual) {
    let Some(held) = held.get() else {
        return;
    };
    for (axis, color) in [
        (Vec3::X, Color::srgb(1.0, 0.0, 0.0)),
        (Vec3::Y, Color::srgb(0.0, 1.0, 0.0)),
        (Vec3::Z, Color::srgb(0.0, 0.0, 1.0)),
    ] {
        let half = axis * HeldAxes::LENGTH / 2.0;
        let center = held.pose.location;
        gizmos
            .arrow(center - half, center + half, color)
            .with_tip_length(ARROW_TIP);
    }
}

/// Below the end of the upright axis the shadow line goes on to the first object or the table; a cross marks the place.
fn draw_shadow(
    mut gizmos: Gizmos<ThinLines>,
    held: HeldVisual,
    others: Query<(Entity, &Transform, &Filled), With<Visual>>,
) {
    let Some(held) = held.get() else {
        return;
    };
    let center = held.pose.location;
    let below = others
        .iter()
        .filter(|(visual, ..)| *visual != held.visual)
        .flat_map(|(_, place, filled)| filled.0.iter().map(move |solid| (solid, place.into())));
    if let Some(foot) = foot_of_shadow(center, below) {
        let end_of_axis = center - Vec3::Z * HeldAxes::LENGTH / 2.0;
        if foot.z < end_of_axis.z {
            gizmos.line(end_of_axis, foot, Color::BLACK);
        }
        for arm in [Vec3::X, Vec3::Y] {
            gizmos.line(foot - arm * FOOT, foot + arm * FOOT, Color::BLACK);
        }
    }
}

/// The point right below this one on the highest of these surfaces.
fn foot_of_shadow<'a>(
    center: Vec3,
    surfaces: impl Iterator<Item = (&'a Primitive, Pose)>,
) -> Option<Vec3> {
    let down = Ray3d::new(center, Dir3::NEG_Z);
    surfaces
        .filter_map(|(solid, body)| solid.distance_along(down, body))
        .min_by(f32::total_cmp)
        .map(|distance| down.get_point(distance))
}

fn draw_sections(
    mut gizmos: Gizmos<ThinLines>,
    held: HeldVisual,
    plane: Res<DragPlane>,
    others: Query<(Entity, &Transform, &Filled), With<Visual>>,
) {
    let Some(held) = held.get() else {
        return;
    };
    let plane = Plane {
        point: held.pose.location,
        normal: plane.normal(),
    };
    for (visual, place, filled) in &others {
        if visual == held.visual {
            continue;
        }
        for primitive in &filled.0 {
            let cut = plane.cut(&primitive.solid, Pose::from(place) * primitive.pose);
            let back_to_start = cut.first().copied();
            gizmos.linestrip(cut.into_iter().chain(back_to_start), Color::BLACK);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabletop_core::Table;
    use tabletop_geometry::{Rgb, Solid};

    #[test]
    fn the_shadow_falls_on_the_highest_surface_below() {
        let slab = Table::default().slab();
        let block = Primitive {
            pose: Pose::IDENTITY,
            solid: Solid::Cuboid(Vec3::splat(2.0)),
            color: Rgb::GRAY,
        };
        let foot = |x: f32| {
            let surfaces = [
                (&slab, Pose::IDENTITY),
                (&block, Pose::at(Vec3::Z)),
                (&block, Pose::at(Vec3::Z * 20.0)),
            ];
            foot_of_shadow(Vec3::new(x, 0.0, 10.0), surfaces.into_iter())
        };
        assert_eq!(foot(0.5), Some(Vec3::new(0.5, 0.0, 2.0)));
        assert_eq!(foot(5.0), Some(Vec3::new(5.0, 0.0, 0.0)));
        assert_eq!(foot(50.0), None);
    }
}
