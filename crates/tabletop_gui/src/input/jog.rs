//! Moving joints of the robot by hand (report section 5.1): each at a constant speed while its key or button is held down.

use bevy::prelude::*;
use tabletop_core::{
    Actor, CommandWriter, Drive, OrderSystems, Paused, RobotCommand, RobotJoint, SimSystems,
};

/// Speed of manual control, in rad/s, and units/s for grippers.
const SPEED: f64 = 1.0;

/// Where the joints are to go, by [`RobotJoint::index`]: 1 and -1 are the directions of manual control, 0 is to stay.
pub(crate) type Directions = [i8; RobotJoint::ALL.len()];

/// The keys, or the buttons, that move joints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Controls {
    held: Directions,
    struck: Directions,
}

impl Controls {
    /// Takes what is held down now, and what has gone down since the last time.
    pub fn update(&mut self, held: Directions, struck: Directions) {
        self.held = held;
        for (direction, struck) in self.struck.iter_mut().zip(struck) {
            if struck != 0 {
                *direction = struck;
            }
        }
    }

    /// What has gone down counts until a tick has seen it, even if it is up again.
    fn direction(&self, joint: RobotJoint) -> i8 {
        match self.struck[joint.index()] {
            0 => self.held[joint.index()],
            struck => struck,
        }
    }
}

/// What the user holds down to move joints.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Jog {
    pub keys: Controls,
    pub buttons: Controls,
}

impl Jog {
    /// With what the user moves the joints.
    fn actor(&self) -> Actor {
        let by_keys = |joint| self.keys.direction(joint) != 0;
        match RobotJoint::ALL.into_iter().any(by_keys) {
            true => Actor::Key,
            false => Actor::Panel,
        }
    }

    /// What the joints are told in a tick. The arms move as mirror images.
    fn drives(&self) -> Vec<(RobotJoint, Drive)> {
        RobotJoint::ALL
            .into_iter()
            .filter_map(|joint| {
                let direction = self.keys.direction(joint) + self.buttons.direction(joint);
                let velocity = SPEED * joint.mirror() * f64::from(direction.signum());
                (direction != 0).then_some((joint, Drive::Velocity(velocity)))
            })
            .collect()
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Jog>().add_systems(
        FixedUpdate,
        (
            give_orders
                .in_set(OrderSystems::User)
                .run_if(not(Paused::will_be)),
            forget_struck.in_set(SimSystems::Load),
        ),
    );
}

fn give_orders(jog: Res<Jog>, mut commands: CommandWriter) {
    let drives = jog.drives();
    if !drives.is_empty() {
        commands.write(jog.actor(), RobotCommand::Drive(drives));
    }
}

/// A tick has seen what has gone down.
fn forget_struck(mut jog: ResMut<Jog>) {
    let mut forgetful = *jog;
    for controls in [&mut forgetful.keys, &mut forgetful.buttons] {
        controls.struck = Directions::default();
    }
    jog.set_if_neq(forgetful);
}

#[cfg(test)]
mod tests {
    use super::*;
    use RobotJoint::{HeadPan, LeftE1, RightE0};

    fn towards(joint: RobotJoint, direction: i8) -> Directions {
        let mut directions = Directions::default();
        directions[joint.index()] = direction;
        directions
    }

    #[test]
    fn keys_and_buttons_add_up_to_one_speed() {
        let mut jog = Jog::default();
        jog.keys.update(towards(LeftE1, 1), Directions::default());
        jog.buttons
            .update(towards(LeftE1, 1), Directions::default());
        assert_eq!(jog.drives(), [(LeftE1, Drive::Velocity(1.0))]);
        jog.buttons
            .update(towards(LeftE1, -1), Directions::default());
        assert_eq!(jog.drives(), []);
    }

    #[test]
    fn arms_move_as_mirror_images() {
        let mut jog = Jog::default();
        jog.keys.update(towards(RightE0, 1), Directions::default());
        jog.buttons
            .update(towards(HeadPan, 1), Directions::default());
        let drives = [
            (RightE0, Drive::Velocity(-1.0)),
            (HeadPan, Drive::Velocity(1.0)),
        ];
        assert_eq!(jog.drives(), drives);
    }

    #[test]
    fn what_went_down_and_up_between_two_ticks_counts_once() {
        let mut jog = Jog::default();
        jog.keys.update(Directions::default(), towards(LeftE1, -1));
        jog.keys
            .update(Directions::default(), Directions::default());
        assert_eq!(jog.drives(), [(LeftE1, Drive::Velocity(-1.0))]);
        let mut app = App::new();
        app.insert_resource(jog).add_systems(Update, forget_struck);
        app.update();
        assert_eq!(*app.world().resource::<Jog>(), Jog::default());
    }
}
