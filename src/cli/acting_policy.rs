//! The options of a policy that acts for the robot: one of a file, or one that somebody serves.

use std::path::{Path, PathBuf};

use crate::{
    benchmark::AnswerDelay,
    core::TICKS_PER_SECOND,
    policy::{ActingPolicy, PicturePolicy, Policy, RemoteError, RemotePolicy, ThinkingTime},
    robot::RobotPlugin,
    wire::{MappedActions, PolicyAddress, PolicyMapping, RecordedExchanges},
};
use clap::Args;

use super::{Failure, range::NumberRange, result_file::require_outside};

#[derive(Args)]
pub(super) struct PolicyOptions {
    /// Let this policy act: one that `tabletop learn` has made of the recording, an ONNX file of somebody else's (docs/learning.md), one that is served at
    /// ws://HOST:PORT by openpi's protocol, or the recorded exchanges of one (docs/policies.md)
    #[arg(long, value_name = "FILE")]
    policy: Option<PathBuf>,
    /// What the served policy sees and does: tabletop, oracle, droid, libero, so101, or a file of your own [default: tabletop or oracle, if the server wants that]
    #[arg(long, value_name = "FILE", requires = "policy")]
    mapping: Option<PathBuf>,
    /// Write what the served policy is asked and answers into this new file; --policy FILE then does the same without the server
    #[arg(long, value_name = "FILE", requires = "policy")]
    exchanges: Option<PathBuf>,
    /// Let the simulation run on while the policy thinks, for as long as it does; the robot stands still meanwhile, and no run repeats another [default: the
    /// simulation waits]
    #[arg(long, requires = "policy")]
    realtime: bool,
    /// Let each answer take this time, from 0 to 60000 ms, however long it really takes, so that runs repeat
    #[arg(long, value_name = "MS", requires = "realtime", value_parser = DELAYS, allow_negative_numbers = true)]
    delay: Option<u64>,
}

const DELAYS: NumberRange<u64> = NumberRange::whole(0, 60_000).of("ms");

impl PolicyOptions {
    /// The policy's file or address.
    pub fn name(&self) -> Option<&Path> {
        self.policy.as_deref()
    }

    /// The mapping's name or file, if one is named.
    pub fn mapping(&self) -> Option<&Path> {
        self.mapping.as_deref()
    }

    /// What the simulation does while the policy thinks.
    pub fn thinking(&self) -> ThinkingTime {
        match (self.realtime, self.delay) {
            (false, _) => ThinkingTime::Waited,
            (true, None) => ThinkingTime::Measured,
            (true, Some(delay)) => {
                ThinkingTime::Given((delay * u64::from(TICKS_PER_SECOND)).div_ceil(1000))
            }
        }
    }

    /// The time that an answer takes, if the simulation runs on meanwhile.
    pub const fn delay(&self) -> Option<AnswerDelay> {
        match (self.realtime, self.delay) {
            (false, _) => None,
            (true, None) => Some(AnswerDelay::Measured),
            (true, Some(delay)) => Some(AnswerDelay::Ms(delay)),
        }
    }

    /// The policy that is to act for this robot, if one is.
    pub fn read(&self, robot: &RobotPlugin) -> Result<Option<ActingPolicy>, Failure> {
        let Some(policy) = &self.policy else {
            return Ok(None);
        };
        let address = policy.to_str().filter(|text| text.contains("://"));
        if let Some(address) = address {
            let address: PolicyAddress = address.parse().map_err(Failure::input)?;
            let connected = RemotePolicy::connect(address, self.read_mapping()?);
            return self.fitted(connected, robot).map(Some);
        }
        let is_recorded = RecordedExchanges::are_in(policy);
        let for_servers = [
            ("mapping", self.mapping.is_some() && !is_recorded),
            ("exchanges", self.exchanges.is_some()),
        ];
        if let Some((option, _)) = for_servers.into_iter().find(|(_, is_given)| *is_given) {
            return Err(Failure::input(format!(
                "--{option} is for a policy that is served, as in --policy ws://HOST:8000"
            )));
        }
        if is_recorded {
            let recorded = RemotePolicy::recorded(policy, self.read_mapping()?);
            return self.fitted(recorded, robot).map(Some);
        }
        read_file(policy).map(|policy| Some(ActingPolicy::Places(policy)))
    }

    fn read_mapping(&self) -> Result<Option<PolicyMapping>, Failure> {
        let mapping = self.mapping.as_deref().map(PolicyMapping::named);
        mapping.transpose().map_err(Failure::input)
    }

    /// A policy that may act for this robot.
    fn fitted(
        &self,
        policy: Result<RemotePolicy, RemoteError>,
        robot: &RobotPlugin,
    ) -> Result<ActingPolicy, Failure> {
        let failure = |error| match error {
            RemoteError::Wire(error) => Failure::run(error),
            RemoteError::Mapping(error) => Failure::input(error),
            RemoteError::Unmapped(_) => Failure::input(error),
        };
        let mut policy = policy.map_err(failure)?;
        policy.check_for(robot.layout()).map_err(Failure::input)?;
        if let Some(file) = &self.exchanges {
            require_outside(file, &[])?;
            policy.note_in(file).map_err(failure)?;
        }
        Ok(match policy.mapping().actions {
            MappedActions::Places => ActingPolicy::ServedPlaces(Box::new(policy)),
            MappedActions::Columns { .. } => ActingPolicy::Motions(Box::new(policy)),
        })
    }
}

/// The policy of a file.
pub(super) fn read_file(file: &Path) -> Result<Box<dyn PicturePolicy>, Failure> {
    if file.extension().is_some_and(|kind| kind == "onnx") {
        return read_onnx(file);
    }
    Ok(Box::new(Policy::read(file).map_err(Failure::input)?))
}

#[cfg(feature = "onnx")]
fn read_onnx(file: &Path) -> Result<Box<dyn PicturePolicy>, Failure> {
    let policy = crate::policy::OnnxPolicy::read(file).map_err(Failure::input)?;
    Ok(Box::new(policy))
}

#[cfg(not(feature = "onnx"))]
fn read_onnx(file: &Path) -> Result<Box<dyn PicturePolicy>, Failure> {
    Err(Failure::input(format!(
        "{}: this program was built without ONNX; build it with cargo build --release --features onnx",
        file.display()
    )))
}
