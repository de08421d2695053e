//! Controllers, and the one that acts for the robot.

use std::any::Any;

use bevy::prelude::*;
use tabletop_core::{Actor, Drive, JointName, Paused, RobotCommand, WriteCommand as _};

use crate::{observer::Observer, sight::Sight};

/// The drives of a tick: joints, and how each is to move. The joints that are missing stand still.
pub type Drives = Vec<(JointName, Drive)>;

/// An actor for the robot. The same sights must lead to the same drives: time and chance come from the sight and a seed.
pub trait Controller: Any + Send + Sync {
    /// The drives for the tick that is beginning. The sight is that of the end of the tick before.
    fn act(&mut self, sight: &Sight) -> Drives;
}

/// The controller that acts for the robot, if one does.
#[derive(Resource, Default)]
pub struct RobotController {
    controller: Option<Box<dyn Controller>>,
    observer: Observer,
}

impl RobotController {
    /// This controller acts from now on.
    pub fn new(controller: impl Controller) -> Self {
        Self {
            controller: Some(Box::new(controller)),
            observer: Observer::default(),
        }
    }

    /// The controller, if it is a `C`.
    pub fn get<C: Controller>(&self) -> Option<&C> {
        let controller: &dyn Any = self.controller.as_deref()?;
        controller.downcast_ref()
    }

    /// Nobody acts from now on.
    pub fn stop(&mut self) {
        *self = Self::default();
    }

    /// Run condition: a controller acts.
    pub(crate) fn acts(this: Res<Self>) -> bool {
        this.controller.is_some()
    }
}

/// Lets the controller see the world, and gives its drives to the robot.
pub(crate) fn act(world: &mut World) {
    if world.resource::<Paused>().0 {
        return;
    }
    let mut this = std::mem::take(&mut *world.resource_mut::<RobotController>());
    let sight = this.observer.look(world);
    let drives = this.controller.as_mut().map(|it| it.act(sight));
    if let Some(drives) = drives.filter(|drives| !drives.is_empty()) {
        world.write_command_of(Actor::Controller, RobotCommand::Drive(drives));
    }
    *world.resource_mut::<RobotController>() = this;
}

#[cfg(test)]
mod tests {
    use tabletop_core::{
        ClockCommand, CorePlugin, IssuedCommand, RobotJoint, SimCommand, StepApp as _,
    };

    use super::*;
    use crate::ControllerPlugin;

    /// Opens the left gripper for some ticks.
    struct Opening(usize);

    impl Controller for Opening {
        fn act(&mut self, _: &Sight) -> Drives {
            self.0 = self.0.saturating_sub(1);
            let drive = (RobotJoint::LeftGripper.name(), Drive::Velocity(1.0));
            (self.0 > 0).then_some(drive).into_iter().collect()
        }
    }

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), ControllerPlugin));
        app.insert_resource(RobotController::new(Opening(3)));
        app.start();
        app
    }

    fn drives(app: &mut App) -> usize {
        let commands = app.world_mut().resource_mut::<Messages<IssuedCommand>>();
        let all = commands.into_inner().drain();
        all.filter(|it| matches!(it.command, SimCommand::Robot(RobotCommand::Drive(_))))
            .count()
    }

    #[test]
    fn a_controller_gives_one_command_a_tick_and_none_without_drives() {
        let mut app = app();
        for expected in [1, 1, 0, 0] {
            app.step(1);
            assert_eq!(drives(&mut app), expected);
        }
    }

    #[test]
    fn a_paused_controller_does_not_act() {
        let mut app = app();
        app.world_mut().write_command(ClockCommand::SetPaused(true));
        app.step(1);
        drives(&mut app);
        app.step(5);
        assert_eq!(drives(&mut app), 0);
    }

    #[test]
    fn a_controller_is_known_by_its_type_until_it_is_stopped() {
        let mut controller = RobotController::new(Opening(3));
        assert!(controller.get::<Opening>().is_some());
        controller.stop();
        assert!(controller.get::<Opening>().is_none());
    }
}
