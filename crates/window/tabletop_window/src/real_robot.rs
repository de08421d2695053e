//! The real robot: the user connects to it, and lets go of it.

use std::path::{Path, PathBuf};

use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, futures::check_ready},
};
use serde_json::Value;
use tabletop_core::{
    Actor, CommandWriter, Robot, RobotCommand, RobotLayout, RobotMode, Table, WriteCommand as _,
};
use tabletop_recorder::SessionSettings;
use tabletop_robot::Description;
use tabletop_user::{Connection, ConnectionOrder, DrivingLeave, Notices, Tone};

use tabletop_bridge::{Address, Bridge, BridgeOptions, Sentinel, Shadow, is_interrupted};
use tabletop_planner::RobotBody;
use tabletop_real::{
    RealLink, RealRobot, RealRobotPlugin, head_pictures, interface_of, sentinel_command,
};

/// The attempt to connect, and the address.
#[derive(Resource, Default)]
struct PendingConnection(Option<(String, Task<Result<RealRobot, String>>)>);

pub(super) fn plugin(app: &mut App) {
    app.add_plugins(RealRobotPlugin::default())
        .init_resource::<PendingConnection>()
        .add_systems(
            Update,
            (obey, take_robot, note_end, note_address, leave).chain(),
        );
}

/// A robot that was connected to before there was a window, and its address.
pub struct Connected {
    /// The address.
    pub address: String,
    /// The robot.
    pub robot: RealRobot,
}

impl Connected {
    /// Lets it stand in for the simulated robot of an app.
    pub(super) fn stand_in(self, app: &mut App) {
        app.insert_resource(connection_to(self.address, &self.robot))
            .insert_resource(self.robot);
        app.world_mut()
            .write_command_of(Actor::Panel, RobotCommand::Show(true));
    }
}

fn connection_to(address: String, robot: &RealRobot) -> Connection {
    match robot.is_driven() {
        true => Connection::Driving(address),
        false => Connection::Following(address),
    }
}

/// The simulated robot, as a model of the one that is driven.
struct GuardedRobot {
    layout: RobotLayout,
    kinematics: tabletop_kinematics::RobotModel,
    /// The folder of its description.
    folder: Option<PathBuf>,
    table: Table,
}

fn obey(
    mut orders: MessageReader<ConnectionOrder>,
    mut attempt: ResMut<PendingConnection>,
    mut connection: ResMut<Connection>,
    mut notices: ResMut<Notices>,
    mut commands: Commands,
    description: Option<Res<Description>>,
    robot: Res<Robot>,
    tables: Query<&Table>,
    real: Option<Res<RealRobot>>,
) {
    for order in orders.read() {
        let (address, leave) = match order {
            ConnectionOrder::Stop => {
                attempt.0 = None;
                *connection = match *connection {
                    Connection::Driving(_) => {
                        let end = "it was stopped, and holds its position";
                        notices.append(Tone::Event, &format!("the real robot: {end}"));
                        Connection::Ended(end.into())
                    }
                    Connection::None
                    | Connection::Connecting(_)
                    | Connection::Following(_)
                    | Connection::Ended(_) => Connection::None,
                };
                // Dropping it brings it to rest.
                commands.remove_resource::<RealRobot>();
                continue;
            }
            ConnectionOrder::Follow { address } => (address, None),
            ConnectionOrder::Drive { address, leave } => (address, Some(*leave)),
        };
        if real.is_some() || attempt.0.is_some() {
            continue;
        }
        let Some(description) = &description else {
            *connection = Connection::Ended("there is no simulated robot".into());
            continue;
        };
        if robot.mode == RobotMode::Dynamic {
            let reason = "a real robot has motors of its own: begin without --dynamic";
            *connection = Connection::Ended(reason.into());
            continue;
        }
        let model = GuardedRobot {
            layout: description.layout.clone(),
            kinematics: description.model.clone(),
            folder: description.folder().map(Path::to_owned),
            table: tables.iter().next().copied().unwrap_or_default(),
        };
        *connection = Connection::Connecting(address.clone());
        let name = address.clone();
        let connect = async move { connect(&name, leave, model) };
        let task = AsyncComputeTaskPool::get().spawn(connect);
        attempt.0 = Some((address.clone(), task));
    }
}

/// Connects, in the background. It takes some seconds if nobody answers.
fn connect(
    address: &str,
    leave: Option<DrivingLeave>,
    model: GuardedRobot,
) -> Result<RealRobot, String> {
    let address: Address = address.parse().map_err(|error| format!("{error}"))?;
    let profile = interface_of(&address, model.folder.as_deref(), &model.layout)?;
    let link = match leave {
        None => RealLink::Shadow(Shadow::connect(&address, &profile).map_err(|it| it.to_string())?),
        Some(leave) => {
            let options = BridgeOptions {
                speed: leave.speed,
                enable: leave.enable,
                calibrate: leave.calibrate,
                allow_moves: leave.moves,
                ..BridgeOptions::default()
            };
            let bridge = Bridge::connect(&address, &profile, &options);
            let mut bridge = bridge.map_err(|error| error.to_string())?;
            if profile.needs_sentinel() {
                let command = sentinel_command(&address, model.folder.as_deref(), &[]);
                let command = command.map_err(|error| error.to_string())?;
                bridge.set_sentinel(Sentinel::start(command).map_err(|error| error.to_string())?);
            }
            let body = RobotBody::new(&model.layout, model.kinematics, &model.table);
            let body = body.map_err(|error| error.to_string())?;
            RealLink::guarded(bridge, body, model.table)
        }
    };
    let feed = head_pictures(&address, &profile);
    Ok(RealRobot::new(link, feed.and_then(Result::ok)))
}

/// Lets a robot that was found stand in for the simulated one.
fn take_robot(
    mut attempt: ResMut<PendingConnection>,
    mut connection: ResMut<Connection>,
    mut commands: Commands,
    mut orders: CommandWriter,
) {
    let Some((address, task)) = &mut attempt.bypass_change_detection().0 else {
        return;
    };
    let Some(result) = check_ready(task) else {
        return;
    };
    let address = address.clone();
    attempt.0 = None;
    *connection = match result {
        Err(reason) => Connection::Ended(reason),
        Ok(real) => {
            let connection = connection_to(address, &real);
            commands.insert_resource(real);
            orders.write(Actor::Panel, RobotCommand::Show(true));
            connection
        }
    };
}

/// Recordings say which robot stood in for the simulated one.
fn note_address(connection: Res<Connection>, mut settings: ResMut<SessionSettings>) {
    const REAL: &str = "real";
    match &*connection {
        Connection::Following(address) | Connection::Driving(address) => {
            if settings.0.get(REAL).and_then(Value::as_str) != Some(address) {
                settings.0.insert(REAL.into(), address.as_str().into());
            }
        }
        Connection::None | Connection::Connecting(_) | Connection::Ended(_) => {
            if settings.0.contains_key(REAL) {
                settings.0.remove(REAL);
            }
        }
    }
}

/// Closes the window once a signal has ended the program: the robot rests by then.
fn leave(mut exits: MessageWriter<AppExit>) {
    if is_interrupted() {
        exits.write(AppExit::error());
    }
}

/// Lets go of a robot that is followed or driven no longer, and says why.
fn note_end(
    real: Option<Res<RealRobot>>,
    mut connection: ResMut<Connection>,
    mut notices: ResMut<Notices>,
    mut commands: Commands,
) {
    let Some(end) = real.as_ref().and_then(|real| real.end()) else {
        return;
    };
    notices.append(Tone::Fault, &format!("the real robot: {end}"));
    *connection = Connection::Ended(end.to_owned());
    commands.remove_resource::<RealRobot>();
}
