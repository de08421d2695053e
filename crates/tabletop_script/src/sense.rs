//! What a script senses.

use std::path::Path;

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{
    Arm, ObjectIndex, ObjectSpec, Pose, Recording, Replaying, Robot, RobotJoint, RobotMode,
    SensorImage, SimTick, TICK_SECONDS, Table,
};
use tabletop_engine::{Aux, RgbImage, SensedContact, SensedObject, Sensor};

use crate::ScriptSettings;

/// How far fingers' ends are from the end effector: across and along it, in units. They do not follow the opening.
const FINGER_ENDS: Vec2 = Vec2::new(1.15, 0.75);

/// The fields of `sensor` that a script gets beside those that all scripts get.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SensorFields {
    objects: bool,
    trackers: bool,
}

impl SensorFields {
    /// Those that this agent gets.
    pub fn of(agent: &Path, settings: &ScriptSettings) -> Self {
        let objects = &["objects", "contacts", "held"];
        Self {
            objects: settings.objects.holds_for(agent, objects),
            trackers: settings.trackers.holds_for(agent, &["trackerLoc"]),
        }
    }
}

/// What can be sensed.
#[derive(SystemParam)]
pub(crate) struct Senses<'w, 's> {
    robot: Res<'w, Robot>,
    image: Res<'w, SensorImage>,
    index: Res<'w, ObjectIndex>,
    objects: Query<'w, 's, (&'static ObjectSpec, &'static Transform)>,
    tables: Query<'w, 's, (), With<Table>>,
    recording: Res<'w, Recording>,
    replaying: Res<'w, Replaying>,
}

/// What an init script gets to know.
pub(crate) fn aux() -> Aux {
    let limits = Arm::BOTH.map(|arm| RobotJoint::of_arm(arm).map(RobotJoint::limits));
    Aux {
        min_joint_angles: limits.map(|arm| arm.map(|(least, _)| least)),
        max_joint_angles: limits.map(|arm| arm.map(|(_, largest)| largest)),
    }
}

impl Senses<'_, '_> {
    /// How the robot's joints move.
    pub fn mode(&self) -> RobotMode {
        self.robot.mode
    }

    /// What a callback script gets to know, so many ticks after it was called before.
    pub fn sensor(&self, ticks: u64, picture: Option<RgbImage>, fields: SensorFields) -> Sensor {
        let robot = &self.robot;
        let of_arms = |value: fn(&Robot, RobotJoint) -> f64| {
            Arm::BOTH.map(|arm| RobotJoint::of_arm(arm).map(|joint| value(robot, joint)))
        };
        let dynamic = robot.mode == RobotMode::Dynamic;
        Sensor {
            time_elapsed: ticks as f64 * f64::from(TICK_SECONDS),
            joint_angles: of_arms(|robot, joint| robot.joint(joint).position),
            end_eff_pos: Arm::BOTH.map(|arm| point(robot.arm(arm).end_effector.location)),
            gripper_opening: Arm::BOTH.map(|arm| robot.joint(RobotJoint::gripper(arm)).position),
            picture,
            tracker_loc: fields.trackers.then(|| self.trackers()),
            demo_cue: self.recording.0 || self.replaying.0,
            head_angle: Some(robot.joint(RobotJoint::HeadPan).position),
            objects: fields.objects.then(|| self.objects()),
            contacts: fields.objects.then(|| self.contacts()),
            held: fields.objects.then(|| self.held()),
            joint_torques: dynamic.then(|| of_arms(|robot, joint| robot.joint(joint).torque)),
        }
    }

    /// The picture of a tick, or of a later one, if it has been taken.
    pub fn picture_since(&self, tick: SimTick) -> Option<RgbImage> {
        let picture = &self.image.picture;
        if self.image.tick < tick || picture.rgb.is_empty() {
            return None;
        }
        RgbImage::new(picture.width, picture.height, picture.rgb.clone())
    }

    /// The points on the arms that the original program names.
    fn trackers(&self) -> Vec<(String, [f64; 3])> {
        let mut trackers = Vec::new();
        for (arm, prefix) in Arm::BOTH.into_iter().zip(["l", "r"]) {
            let state = self.robot.arm(arm);
            for (name, origin) in ["S1", "E1", "W1"].into_iter().zip(&state.joint_origins) {
                trackers.push((format!("{prefix}-{name}"), point(*origin)));
            }
            for (finger, side) in [("l", -1.0), ("r", 1.0)] {
                for (end, along) in [("n", 1.0), ("f", -1.0)] {
                    let place = Vec3::new(side * FINGER_ENDS.x, 0.0, along * FINGER_ENDS.y);
                    let name = format!("{prefix}g-{finger}{end}");
                    trackers.push((name, point(state.end_effector * place)));
                }
            }
        }
        trackers
    }

    fn objects(&self) -> Vec<SensedObject> {
        let objects = self.index.iter().filter_map(|id| self.objects.get(id).ok());
        objects
            .map(|(spec, transform)| {
                let pose = Pose::from(transform);
                let descriptions = spec.all_descriptions();
                let words = descriptions
                    .iter()
                    .map(|(name, value)| format!("{name}={value}"));
                SensedObject {
                    id: spec.id.clone(),
                    position: point(pose.location),
                    rotation: pose.degrees().to_array().map(|d| f64::from(d).to_radians()),
                    mass: f64::from(spec.mass),
                    description: words.collect::<Vec<_>>().join(", "),
                }
            })
            .collect()
    }

    fn contacts(&self) -> Vec<SensedContact> {
        let contacts = self.robot.contacts.iter();
        contacts
            .filter_map(|contact| {
                Some(SensedContact {
                    ids: [contact.body.clone(), self.name(contact.thing)?],
                    point: point(contact.point),
                    impulse: f64::from(contact.impulse),
                })
            })
            .collect()
    }

    /// What an object or the table is called.
    fn name(&self, thing: Entity) -> Option<String> {
        match self.objects.get(thing) {
            Ok((spec, _)) => Some(spec.id.clone()),
            Err(_) => self.tables.contains(thing).then(|| "table".into()),
        }
    }

    fn held(&self) -> [Vec<String>; 2] {
        Arm::BOTH.map(|arm| {
            let held = self.robot.arm(arm).holds.iter();
            let specs = held.filter_map(|&object| self.objects.get(object).ok());
            specs.map(|(spec, _)| spec.id.clone()).collect()
        })
    }
}

fn point(point: Vec3) -> [f64; 3] {
    point.to_array().map(f64::from)
}
