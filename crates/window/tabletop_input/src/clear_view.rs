//! A clear view of an imitation: where the robot hides from the user what it is to do, the camera goes to the other side of the table.

use bevy::prelude::*;
use tabletop_core::{ObjectIndex, ObjectSpec};
use tabletop_user::{CameraMotion, CameraView, Imitating, RobotLook, UserCamera};

use crate::pick::Pickable;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, go_across.run_if(resource_changed::<Imitating>));
}

/// Looks once for an imitation, when the robot stands at the table.
fn go_across(
    mut has_looked: Local<bool>,
    imitating: Res<Imitating>,
    look: Res<RobotLook>,
    index: Res<ObjectIndex>,
    pickable: Pickable,
    objects: Query<&Transform, With<ObjectSpec>>,
    camera: Single<&Transform, With<UserCamera>>,
    mut motions: MessageWriter<CameraMotion>,
) {
    let is_at_work = matches!(*imitating, Imitating::Step(_));
    let begins = is_at_work && !std::mem::replace(&mut *has_looked, is_at_work);
    if !begins || look.is_translucent {
        return;
    }
    let eye = camera.translation;
    let places = objects.iter_many(index.iter());
    let mut places = places.map(|place| place.translation).chain([Vec3::ZERO]);
    if places.any(|place| pickable.is_behind_figure(eye, place)) {
        motions.write(CameraMotion::Look(CameraView::Across));
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::Figure;
    use tabletop_geometry::{Rgb, Triangles};
    use tabletop_user::ImitatedStep;

    use super::*;
    use crate::test_world::TestWorld;

    /// An imitation of which the robot, if there is one, hides what is right of the eye.
    fn motions(has_robot: bool, object: f32, is_translucent: bool) -> usize {
        let mut test = TestWorld::new(plugin);
        test.block("red", Vec3::new(object, 0.0, 1.0));
        test.app.insert_resource(RobotLook { is_translucent });
        if has_robot {
            let plate = Triangles {
                positions: vec![
                    Vec3::new(1.0, -8.0, -20.0),
                    Vec3::new(1.0, -8.0, 20.0),
                    Vec3::new(20.0, -8.0, 0.0),
                ],
                normals: vec![Vec3::NEG_Y; 3],
                colors: vec![Rgb::GRAY; 3],
                indices: vec![[0, 2, 1]],
            };
            let figure = Figure {
                fine: Triangles::default().into(),
                coarse: plate.into(),
            };
            let place = (Transform::default(), GlobalTransform::default());
            test.app.world_mut().spawn((figure, place));
        }
        for number in 1..3 {
            let step = ImitatedStep {
                number,
                ..default()
            };
            test.app.insert_resource(Imitating::Step(step));
            test.hold_still();
        }
        let mut motions = test
            .app
            .world_mut()
            .resource_mut::<Messages<CameraMotion>>();
        let across = CameraMotion::Look(CameraView::Across);
        motions.drain().filter(|motion| *motion == across).count()
    }

    #[test]
    fn the_camera_goes_across_once_if_the_robot_hides_the_objects() {
        for (has_robot, object, is_translucent, expected) in [
            (true, 6.0, false, 1),
            (true, -6.0, false, 0),
            (true, 6.0, true, 0),
            (false, 6.0, false, 0),
        ] {
            let actual = motions(has_robot, object, is_translucent);
            assert_eq!(actual, expected, "{has_robot} {object} {is_translucent}");
        }
    }
}
