//! Options for a real robot, which is followed or driven.

use std::{
    io::{BufRead as _, IsTerminal as _, stdin},
    path::Path,
};

use crate::{
    bridge::{Address, Bridge, BridgeOptions, BridgeProfile, PictureFeed, Sentinel, Shadow},
    core::{RobotCommand, RobotMode, Table, WriteCommand as _},
    real::{RealLink, RealRobot, head_pictures, interface_of, sentinel_command, shipped_body},
    robot::RobotPlugin,
    robot_body,
};
use bevy::prelude::*;
use clap::Args;
use serde_json::{Map, Value};

use super::{Failure, range::NumberRange, robot_options::describe, terminal::say};

const SHARES: NumberRange<f64> = NumberRange::decimal(0.01, 1.0);

/// A real robot that is followed or driven.
#[derive(Args, Clone)]
pub(super) struct RealOptions {
    /// Follow a real robot, such as `baxter:ros://HOST:11311` or `baxter:ws://HOST:9090`: it is only looked at, and the simulated robot is where it is
    #[arg(
        long,
        value_name = "ADDRESS",
        group = "real_robot",
        conflicts_with = "real"
    )]
    shadow: Option<Address>,
    #[command(flatten)]
    driven: DrivenOptions,
}

/// A real robot that is driven.
#[derive(Args, Clone)]
pub(super) struct DrivenOptions {
    /// Drive a real robot: whatever moves the simulated robot moves that one, and the simulated one is where it was measured (docs/real-robots.md)
    #[arg(long, value_name = "ADDRESS", group = "real_robot")]
    real: Option<Address>,
    /// The limbs of the real robot that are driven, such as `left` or `left,right` [default: all]
    #[arg(long, value_name = "LIMBS", value_delimiter = ',', requires = "real")]
    arms: Vec<String>,
    /// The share of the greatest speeds that its joints may have, from 0.01 to 1 [default: 0.3]
    #[arg(long, value_name = "SHARE", value_parser = SHARES, requires = "real", default_value = "0.3", hide_default_value = true, allow_negative_numbers = true)]
    speed: f64,
    /// Let the real robot move to angles that are more than 0.2 rad away, such as those of an init script
    #[arg(long, requires = "real")]
    allow_moves: bool,
    /// Switch its motors on at the start, if they are off
    #[arg(long, requires = "real")]
    enable: bool,
    /// Let grippers that do not know their range find it out at the start, by closing and opening
    #[arg(long, requires = "real")]
    calibrate_grippers: bool,
    /// Drive a robot of unknown software, too
    #[arg(long, requires = "real")]
    any_software: bool,
    /// Drive it without asking first
    #[arg(long, requires = "real")]
    yes: bool,
}

impl RealOptions {
    /// The address of the real robot, if there is one.
    pub fn address(&self) -> Option<&Address> {
        self.shadow.as_ref().or(self.driven.address())
    }

    /// The robot that stands for the real one: the one that was chosen, or the body of the address' robot.
    pub fn body(&self, chosen: RobotPlugin) -> Result<RobotPlugin, Failure> {
        body_of(self.address(), chosen)
    }

    /// Connects to the real robot, if there is one.
    pub fn connect(
        &self,
        robot: &RobotPlugin,
        table: &Table,
    ) -> Result<Option<RealRobot>, Failure> {
        match &self.shadow {
            None => self.driven.connect(robot, table),
            Some(address) => follow(address, robot).map(Some),
        }
    }

    /// Connects to the real robot, if there is one, and lets it stand in for the simulated one of an app with a `RealRobotPlugin`.
    pub fn attach(&self, app: &mut App, robot: &RobotPlugin, table: &Table) -> Result<(), Failure> {
        if let Some(real) = self.connect(robot, table)? {
            stand_in(app, real);
        }
        Ok(())
    }
}

impl DrivenOptions {
    /// The address of the real robot, if there is one.
    pub const fn address(&self) -> Option<&Address> {
        self.real.as_ref()
    }

    /// The robot that stands for the real one: the one that was chosen, or the body of the address' robot.
    pub fn body(&self, chosen: RobotPlugin) -> Result<RobotPlugin, Failure> {
        body_of(self.address(), chosen)
    }

    /// Its entry in the header of a recording.
    pub fn header(&self) -> Map<String, Value> {
        header(self.address())
    }

    /// Connects to the real robot, if there is one.
    pub fn connect(
        &self,
        robot: &RobotPlugin,
        table: &Table,
    ) -> Result<Option<RealRobot>, Failure> {
        let Some(address) = &self.real else {
            return Ok(None);
        };
        refuse_simulated_motors(robot)?;
        let profile = profile(address, robot)?;
        let link = self.drive(address, &profile, robot, table)?;
        Ok(Some(RealRobot::new(link, feed(address, &profile))))
    }

    fn drive(
        &self,
        address: &Address,
        profile: &BridgeProfile,
        robot: &RobotPlugin,
        table: &Table,
    ) -> Result<RealLink, Failure> {
        let options = BridgeOptions {
            limbs: self.arms.clone(),
            speed: self.speed,
            allow_moves: self.allow_moves,
            enable: self.enable,
            calibrate: self.calibrate_grippers,
            any_software: self.any_software,
        };
        self.ask(address)?;
        let mut bridge = Bridge::connect(address, profile, &options).map_err(Failure::run)?;
        if profile.needs_sentinel() {
            bridge.set_sentinel(self.sentinel(address, robot)?);
        }
        let body = robot_body(robot, table).map_err(Failure::run)?;
        Ok(RealLink::guarded(bridge, body, *table))
    }

    /// A process that brings the robot to rest if this one is killed.
    fn sentinel(&self, address: &Address, robot: &RobotPlugin) -> Result<Sentinel, Failure> {
        let command = sentinel_command(address, folder(robot), &self.arms);
        let command = command.map_err(|error| Failure::run(format!("this program: {error}")))?;
        Sentinel::start(command).map_err(Failure::run)
    }

    /// Asks whether the robot may move.
    fn ask(&self, address: &Address) -> Result<(), Failure> {
        if self.yes {
            return Ok(());
        }
        let limbs = match self.arms.is_empty() {
            true => "all limbs".to_owned(),
            false => self.arms.join(", "),
        };
        if !stdin().is_terminal() {
            return Err(Failure::input(
                "a real robot is driven only after a question on the terminal, or with --yes",
            ));
        }
        say(format_args!(
            "tabletop: {address} will move ({limbs}, at most {:.0} % of the greatest speed). Is somebody at the emergency stop, and nobody within reach? [y/N]",
            100.0 * self.speed
        ));
        let mut answer = String::new();
        let read = stdin().lock().read_line(&mut answer);
        read.map_err(|error| Failure::run(format!("standard input: {error}")))?;
        match answer.trim() {
            "y" | "Y" | "yes" => Ok(()),
            _ => Err(Failure::input("nothing was moved")),
        }
    }
}

/// A real robot that is only looked at.
fn follow(address: &Address, robot: &RobotPlugin) -> Result<RealRobot, Failure> {
    refuse_simulated_motors(robot)?;
    let profile = profile(address, robot)?;
    let shadow = Shadow::connect(address, &profile).map_err(Failure::run)?;
    Ok(RealRobot::new(
        RealLink::Shadow(shadow),
        feed(address, &profile),
    ))
}

/// The entry of a real robot in the header of a recording.
pub(super) fn header(address: Option<&Address>) -> Map<String, Value> {
    let entry = address.map(|address| ("real".into(), Value::from(address.to_string())));
    entry.into_iter().collect()
}

fn refuse_simulated_motors(robot: &RobotPlugin) -> Result<(), Failure> {
    match robot.mode {
        RobotMode::Dynamic => Err(Failure::input(
            "--dynamic: a real robot has motors of its own",
        )),
        RobotMode::Kinematic => Ok(()),
    }
}

/// Lets a real robot stand in for the simulated one of an app with a `RealRobotPlugin`.
pub(super) fn stand_in(app: &mut App, real: RealRobot) {
    app.insert_resource(real);
    app.world_mut().write_command(RobotCommand::Show(true));
}

/// The robot that stands for the one at an address.
fn body_of(address: Option<&Address>, chosen: RobotPlugin) -> Result<RobotPlugin, Failure> {
    let file = address.and_then(shipped_body);
    let Some(file) = file.filter(|_| chosen.description.is_none()) else {
        return Ok(chosen);
    };
    Ok(RobotPlugin {
        description: Some(describe(Path::new(file))?),
        ..chosen
    })
}

/// The folder of a robot's description, if it has one.
fn folder(robot: &RobotPlugin) -> Option<&Path> {
    robot.description.as_ref()?.folder()
}

fn profile(address: &Address, robot: &RobotPlugin) -> Result<BridgeProfile, Failure> {
    interface_of(address, folder(robot), robot.layout()).map_err(Failure::input)
}

/// The pictures of the head camera, if the robot has one that shows them.
fn feed(address: &Address, profile: &BridgeProfile) -> Option<PictureFeed> {
    let feed = head_pictures(address, profile)?;
    feed.inspect_err(|error| {
        say(format_args!(
            "tabletop: no pictures of the real robot: {error}"
        ));
    })
    .ok()
}

/// The failure of a real robot that is followed or driven no longer.
pub(super) fn check(app: &App) -> Result<(), Failure> {
    let real = app.world().get_resource::<RealRobot>();
    let end = real.and_then(RealRobot::end);
    end.map_or(Ok(()), |end| {
        Err(Failure::run(format!("the real robot: {end}")))
    })
}

/// Lets go of the real robot: one that was driven holds its position.
pub(super) fn release(app: &mut App) {
    let real = app.world_mut().remove_resource::<RealRobot>();
    if let Some(reason) = real.and_then(RealRobot::stop) {
        say(format_args!("tabletop: the real robot rests: {reason}"));
    }
}
