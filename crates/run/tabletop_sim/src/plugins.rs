//! The plugins of the simulator.

use bevy::{app::PluginGroupBuilder, prelude::*};
use tabletop_camera::CameraPlugin;
use tabletop_controller::ControllerPlugin;
use tabletop_core::CorePlugin;
use tabletop_demonstrator::DemonstratorPlugin;
use tabletop_drive::DrivePlugin;
use tabletop_history::HistoryPlugin;
use tabletop_mechanism::MechanismPlugin;
use tabletop_physics::PhysicsPlugin;
use tabletop_recorder::RecorderPlugin;
use tabletop_robot::RobotPlugin;
use tabletop_scenario::ScenarioPlugin;
use tabletop_scene::ScenePlugin;
use tabletop_script::ScriptPlugin;
use tabletop_vision::PerceptionPlugin;
use tabletop_xml::XmlPlugin;

use crate::{reset::ResetPlugin, settings::RecordedSettingsPlugin, shipped::ShippedFilesPlugin};

/// The simulator without display: [`CorePlugin`], [`HistoryPlugin`], [`XmlPlugin`], [`PhysicsPlugin`], [`ScenePlugin`],
/// [`DemonstratorPlugin`], [`MechanismPlugin`], [`RobotPlugin`], [`DrivePlugin`], [`CameraPlugin`], [`PerceptionPlugin`], [`ControllerPlugin`], [`RecorderPlugin`],
/// [`ScriptPlugin`], [`ScenarioPlugin`], [`RecordedSettingsPlugin`], [`ShippedFilesPlugin`] and [`ResetPlugin`].
#[derive(Clone, Copy, Debug, Default)]
pub struct TabletopSimPlugins;

impl PluginGroup for TabletopSimPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(CorePlugin::default())
            .add(HistoryPlugin::default())
            .add(XmlPlugin)
            .add(PhysicsPlugin::default())
            .add(ScenePlugin)
            .add(DemonstratorPlugin)
            .add(MechanismPlugin)
            .add(RobotPlugin::default())
            .add(DrivePlugin)
            .add(CameraPlugin)
            .add(PerceptionPlugin)
            .add(ControllerPlugin)
            .add(RecorderPlugin::default())
            .add(ScriptPlugin::default())
            .add(ScenarioPlugin)
            .add(RecordedSettingsPlugin)
            .add(ShippedFilesPlugin)
            .add(ResetPlugin)
    }
}
