//! Moving joints of the robot by hand (report section 5.1): each at a constant speed while its key or button is held down.

use bevy::prelude::*;
use tabletop_core::{
    Actor, CommandWriter, Drive, JointId, JointName, OrderSystems, Paused, RestApp as _,
    RestingSystems, RobotCommand, RobotLayout, SimSystems,
};

/// The directions in which the joints are to go: 1 and -1 are the directions of manual control, 0 is to stay.
#[derive(Clone, Debug, Default)]
pub struct Directions(Vec<i8>);

impl Directions {
    /// The directions that a function gives for every joint of a layout.
    pub fn of(layout: &RobotLayout, direction: impl FnMut(JointId) -> i8) -> Self {
        Self(layout.joint_ids().map(direction).collect())
    }

    /// The direction of a joint.
    pub fn get(&self, joint: JointId) -> i8 {
        self.0.get(joint.index()).copied().unwrap_or(0)
    }

    /// Lets a joint go somewhere.
    pub fn set(&mut self, joint: JointId, direction: i8) {
        if self.0.len() <= joint.index() {
            self.0.resize(joint.index() + 1, 0);
        }
        self.0[joint.index()] = direction;
    }

    /// True if nothing is to go anywhere.
    pub fn are_none(&self) -> bool {
        self.0.iter().all(|&direction| direction == 0)
    }
}

/// Joints without an entry stay in place.
impl PartialEq for Directions {
    fn eq(&self, other: &Self) -> bool {
        let joints = self.0.len().max(other.0.len()) as u16;
        (0..joints)
            .map(JointId)
            .all(|joint| self.get(joint) == other.get(joint))
    }
}

impl Eq for Directions {}

/// The keys, or the buttons, that move joints.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Controls {
    held: Directions,
    struck: Directions,
}

impl Controls {
    /// Takes the directions that are held down now, and those that have gone down since the last time.
    pub fn update(&mut self, held: Directions, struck: Directions) {
        self.held = held;
        for (joint, &struck) in (0..).map(JointId).zip(&struck.0) {
            if struck != 0 {
                self.struck.set(joint, struck);
            }
        }
    }

    /// True if nothing is or was held down.
    fn are_idle(&self) -> bool {
        self.held.are_none() && self.struck.are_none()
    }

    /// A key that has gone down counts until a tick has seen it, even if it is up again.
    fn direction(&self, joint: JointId) -> i8 {
        match self.struck.get(joint) {
            0 => self.held.get(joint),
            struck => struck,
        }
    }
}

/// The keys and buttons that the user holds down to move joints.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct Jog {
    pub(crate) keys: Controls,
    buttons: Controls,
}

impl Jog {
    /// Takes the directions of the buttons that are held down now, and of those that have gone down since the last time.
    pub fn press_buttons(&mut self, held: Directions, struck: Directions) {
        self.buttons.update(held, struck);
    }

    /// The keyboard or the panel, by which the user moves the joints.
    fn actor(&self) -> Actor {
        match self.keys.are_idle() {
            false => Actor::Key,
            true => Actor::Panel,
        }
    }

    /// The orders to the joints in a tick. The arms move as mirror images.
    fn drives(&self, layout: &RobotLayout) -> Vec<(JointName, Drive)> {
        layout
            .joint_ids()
            .filter_map(|id| {
                let joint = layout.joint(id);
                let direction = self.keys.direction(id) + self.buttons.direction(id);
                let velocity = joint.manual_speed() * joint.sign * f64::from(direction.signum());
                (direction != 0).then_some((joint.name, Drive::Velocity(velocity)))
            })
            .collect()
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Jog>()
        .add_systems(
            FixedUpdate,
            (
                give_orders
                    .in_set(OrderSystems::User)
                    .run_if(not(Paused::will_be)),
                forget_struck.in_set(SimSystems::Load),
            )
                .in_set(RestingSystems),
        )
        .wake_while(|jog: Res<Jog>| !jog.keys.are_idle() || !jog.buttons.are_idle());
}

fn give_orders(jog: Res<Jog>, layout: Res<RobotLayout>, mut commands: CommandWriter) {
    let drives = jog.drives(&layout);
    if !drives.is_empty() {
        commands.write(jog.actor(), RobotCommand::Drive(drives));
    }
}

/// Forgets the struck keys once a tick has seen them.
fn forget_struck(mut jog: ResMut<Jog>) {
    let mut forgetful = jog.clone();
    for controls in [&mut forgetful.keys, &mut forgetful.buttons] {
        controls.struck = Directions::default();
    }
    jog.set_if_neq(forgetful);
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabletop_core::RobotJoint::{self, HeadPan, LeftE1, RightE0};

    fn towards(joint: RobotJoint, direction: i8) -> Directions {
        let mut directions = Directions::default();
        directions.set(joint.into(), direction);
        directions
    }

    #[test]
    fn keys_and_buttons_add_up_to_one_speed() {
        let mut jog = Jog::default();
        jog.keys.update(towards(LeftE1, 1), Directions::default());
        jog.buttons
            .update(towards(LeftE1, 1), Directions::default());
        assert_eq!(
            jog.drives(RobotLayout::baxter()),
            [(LeftE1.name(), Drive::Velocity(1.0))]
        );
        jog.buttons
            .update(towards(LeftE1, -1), Directions::default());
        assert_eq!(jog.drives(RobotLayout::baxter()), []);
    }

    #[test]
    fn arms_move_as_mirror_images() {
        let mut jog = Jog::default();
        jog.keys.update(towards(RightE0, 1), Directions::default());
        jog.buttons
            .update(towards(HeadPan, 1), Directions::default());
        let drives = [
            (RightE0.name(), Drive::Velocity(-1.0)),
            (HeadPan.name(), Drive::Velocity(1.0)),
        ];
        assert_eq!(jog.drives(RobotLayout::baxter()), drives);
    }

    #[test]
    fn a_key_struck_between_two_ticks_counts_once() {
        let mut jog = Jog::default();
        jog.keys.update(Directions::default(), towards(LeftE1, -1));
        jog.keys
            .update(Directions::default(), Directions::default());
        assert_eq!(
            jog.drives(RobotLayout::baxter()),
            [(LeftE1.name(), Drive::Velocity(-1.0))]
        );
        let mut app = App::new();
        app.insert_resource(jog).add_systems(Update, forget_struck);
        app.update();
        assert_eq!(*app.world().resource::<Jog>(), Jog::default());
    }
}
