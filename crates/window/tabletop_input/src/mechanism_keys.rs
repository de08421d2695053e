//! Keys that trigger, point, fasten, loosen and cut, with the held object or the one under the cursor.

use bevy::prelude::*;
use tabletop_core::{Actor, CommandWriter, Paused};
use tabletop_user::{KeySystems, Keys, Notices, Tone};

use crate::{
    operable::{Deed, Operable},
    pointer::Pointer,
};

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Pointer>()
        .init_resource::<Notices>()
        .add_systems(
            RunFixedMainLoop,
            act.in_set(KeySystems).run_if(Paused::is_running),
        );
}

fn act(
    keys: Keys,
    pointer: Res<Pointer>,
    operable: Operable,
    mut commands: CommandWriter,
    mut notices: ResMut<Notices>,
) {
    let struck = Deed::ALL
        .into_iter()
        .filter(|deed| keys.was_struck(deed.action()));
    for deed in struck {
        let ray = pointer.ray.filter(|_| !pointer.is_panels);
        match operable.command(deed, ray) {
            Ok(command) => {
                commands.write(Actor::Key, command);
            }
            Err(reason) => notices.add(Tone::Fault, &reason),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::TestWorld;
    use tabletop_core::{Hand, Joint, JointKind, MechanismCommand};
    use tabletop_geometry::Pose;

    #[test]
    fn a_key_points_to_the_object_under_the_cursor() {
        let mut test = TestWorld::new(plugin);
        test.block("red", Vec3::Z);
        test.point_at(Vec3::Z);
        test.keys().press(KeyCode::KeyX);
        let point_to = MechanismCommand::PointTo {
            hand: Hand::Any,
            target: "red".into(),
        };
        assert_eq!(test.hold_still(), [point_to.into()]);
    }

    #[test]
    fn a_key_cuts_with_the_scissors_that_are_held() {
        let mut test = TestWorld::new(plugin);
        let lower = test.hold("lower", Vec3::Z);
        let upper = test.block("upper", Vec3::Z * 4.0);
        let shears = Joint {
            objects: [lower, upper],
            frames: [Pose::IDENTITY; 2],
            kind: JointKind::Shears { min: 0.0, max: 1.0 },
            collides: false,
        };
        let shears = test.app.world_mut().spawn(shears).id();
        test.keys().press(KeyCode::ShiftLeft);
        test.keys().press(KeyCode::KeyE);
        let (hand, blade) = (Hand::Any, "lower".into());
        let cut = MechanismCommand::Cut { hand, blade };
        assert_eq!(test.hold_still(), [cut.into()]);
        test.app.world_mut().despawn(shears);
        test.keys().release(KeyCode::KeyE);
        test.hold_still();
        test.keys().press(KeyCode::KeyE);
        assert_eq!(test.hold_still(), []);
        let notices = test.app.world().resource::<Notices>();
        assert!(notices.iter().any(|notice| notice.contains("no scissors")));
    }

    #[test]
    fn an_impossible_fastening_is_reported() {
        let mut test = TestWorld::new(plugin);
        test.hold("red", Vec3::Z);
        test.point_at(Vec3::Z);
        test.keys().press(KeyCode::KeyF);
        assert_eq!(test.hold_still(), []);
        let notices = test.app.world().resource::<Notices>();
        assert!(
            notices
                .iter()
                .any(|notice| notice.contains("no guest point"))
        );
    }
}
