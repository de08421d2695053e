//! The senses of scripts.

use std::path::Path;

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{
    JointId, JointState, ObjectIndex, ObjectSpec, Recording, Replaying, Robot, RobotLayout,
    RobotMode, SensorImage, ShownTask, SimTick, TICK_SECONDS, Table,
};
use tabletop_engine::{
    Aux, JointMatrix, RgbImage, SensedBelief, SensedContact, SensedControl, SensedObject,
    SensedStep, Sensor,
};
use tabletop_geometry::Pose;
use tabletop_vision::{PerceivedObject, Perception};

use crate::{ScriptSettings, mentions::mention};

/// The fields of `sensor` that a script gets beside those that all scripts get.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SensorFields {
    objects: bool,
    controls: bool,
    trackers: bool,
    pub seen: bool,
    task: bool,
}

impl SensorFields {
    /// Those that this agent gets.
    pub fn of(agent: &Path, settings: &ScriptSettings) -> Self {
        let objects = &["objects", "contacts", "held"];
        Self {
            objects: settings.objects.holds_for(agent, objects),
            controls: settings.objects.holds_for(agent, &["controls"]),
            trackers: settings.trackers.holds_for(agent, &["trackerLoc"]),
            seen: mention(agent, &["seen"]),
            task: mention(agent, &["task"]),
        }
    }
}

/// Everything that can be sensed.
#[derive(SystemParam)]
pub(crate) struct Senses<'w, 's> {
    layout: Res<'w, RobotLayout>,
    robot: Res<'w, Robot>,
    image: Res<'w, SensorImage>,
    index: Res<'w, ObjectIndex>,
    objects: Query<'w, 's, (&'static ObjectSpec, &'static Transform)>,
    tables: Query<'w, 's, (), With<Table>>,
    recording: Res<'w, Recording>,
    replaying: Res<'w, Replaying>,
    task: Res<'w, ShownTask>,
    perception: Res<'w, Perception>,
}

impl Senses<'_, '_> {
    /// The limbs and joints of the robot.
    pub fn layout(&self) -> &RobotLayout {
        &self.layout
    }

    /// The knowledge of an init script.
    pub fn aux(&self) -> Aux {
        let limits = |end: usize| self.of_limbs(|joint| self.layout.joint(joint).limits[end]);
        Aux {
            min_joint_angles: limits(0),
            max_joint_angles: limits(1),
        }
    }

    /// A number for each joint of each limb.
    fn of_limbs(&self, of: impl Fn(JointId) -> f64) -> JointMatrix {
        let limbs = self.layout.limbs.iter();
        let rows = limbs.map(|limb| limb.joints.iter().map(|joint| of(*joint)).collect());
        JointMatrix::from_rows(&rows.collect::<Vec<_>>())
    }

    fn state(&self, joint: JointId) -> &JointState {
        &self.robot.joints[joint.index()]
    }

    /// The mode in which the robot's joints move.
    pub fn mode(&self) -> RobotMode {
        self.robot.mode
    }

    /// The senses of a callback script, `ticks` ticks after its last call. Beside a real robot, they have nothing of what only the simulation knows.
    pub fn sensor(&self, ticks: u64, picture: Option<RgbImage>, fields: SensorFields) -> Sensor {
        let is_real = self.robot.is_mirror;
        let feels_torques = is_real || self.mode() == RobotMode::Dynamic;
        let knows = |asked: bool| asked && !is_real;
        let grippers = self.layout.limbs.iter().map(|limb| limb.gripper.joint);
        let limbs = self.robot.limbs.iter();
        Sensor {
            time_elapsed: ticks as f64 * f64::from(TICK_SECONDS),
            joint_angles: self.of_limbs(|joint| self.state(joint).position),
            end_eff_pos: limbs
                .map(|limb| point(limb.end_effector.location))
                .collect(),
            gripper_opening: grippers.map(|joint| self.state(joint).position).collect(),
            picture,
            tracker_loc: fields.trackers.then(|| self.trackers()),
            demo_cue: self.recording.0 || self.replaying.0,
            head_angle: self.layout.neck.map(|neck| self.state(neck).position),
            objects: knows(fields.objects).then(|| self.objects()),
            seen: (fields.seen && !self.perception.objects.is_empty()).then(|| self.beliefs()),
            contacts: knows(fields.objects).then(|| self.contacts()),
            held: fields.objects.then(|| self.held()),
            controls: knows(fields.controls).then(|| self.controls()),
            task: (fields.task && !self.task.steps.is_empty()).then(|| self.task()),
            joint_torques: feels_torques.then(|| self.of_limbs(|joint| self.state(joint).torque)),
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

    /// The points on the limbs, by the names that they have in the original program.
    fn trackers(&self) -> Vec<(String, [f64; 3])> {
        let mut trackers = Vec::new();
        for (limb, state) in self.layout.limbs.iter().zip(&self.robot.limbs) {
            let prefix = &limb.prefix;
            for (joint, origin) in limb.trackers.iter().zip(&state.joint_origins) {
                let name = format!("{prefix}-{}", self.layout.joint(*joint).label);
                trackers.push((name, point(*origin)));
            }
            let [_, widest] = self.layout.joint(limb.gripper.joint).limits;
            // They do not follow the opening.
            let ends = limb.gripper.finger_ends(widest);
            for (finger, side) in [("l", -1.0), ("r", 1.0)] {
                for (end, along) in [("n", 1.0), ("f", -1.0)] {
                    let place = Vec3::new(side * ends.x, 0.0, along * ends.y);
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

    fn beliefs(&self) -> Vec<SensedBelief> {
        let beliefs = self.perception.objects.iter();
        let beliefs = beliefs.map(|PerceivedObject { id, seen, .. }| {
            let place = seen.pose.map(|pose| {
                let degrees = pose.degrees().to_array().map(f64::from);
                (point(pose.location), degrees.map(f64::to_radians))
            });
            let (position, rotation) = place.unwrap_or(([f64::NAN; 3], [f64::NAN; 3]));
            SensedBelief {
                id: id.clone(),
                position,
                rotation,
                deviation: point(seen.deviation.location),
                is_sure: seen.is_sure,
            }
        });
        beliefs.collect()
    }

    fn controls(&self) -> Vec<SensedControl> {
        let objects = self.index.iter().filter_map(|id| self.objects.get(id).ok());
        objects
            .flat_map(|(spec, _)| {
                let controls = spec.controls().into_iter();
                controls.map(|control| SensedControl {
                    id: control.id.to_owned(),
                    kind: control.what.type_name().to_owned(),
                    object: spec.id.clone(),
                    state: f64::from(control.what.shown_state()),
                    state_name: control.what.state_name(),
                })
            })
            .collect()
    }

    fn task(&self) -> Vec<SensedStep> {
        let steps = self.task.steps.iter().map(|step| SensedStep {
            sentence: step.sentence.clone(),
            object: step.object.clone(),
            relation: step.relation.clone(),
            reference: step.reference.clone(),
            goal: step.goal.map_or([[f64::NAN; 3]; 2], |goal| {
                [
                    point(goal.location),
                    goal.degrees().to_array().map(|d| f64::from(d).to_radians()),
                ]
            }),
        });
        steps.collect()
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

    /// The name of an object or the table.
    fn name(&self, thing: Entity) -> Option<String> {
        match self.objects.get(thing) {
            Ok((spec, _)) => Some(spec.id.clone()),
            Err(_) => self.tables.contains(thing).then(|| "table".into()),
        }
    }

    fn held(&self) -> Vec<(String, Vec<String>)> {
        let limbs = self.layout.limbs.iter().zip(&self.robot.limbs);
        let held = limbs.map(|(limb, state)| {
            let held = state.holds.iter();
            let specs = held.filter_map(|&object| self.objects.get(object).ok());
            let ids = specs.map(|(spec, _)| spec.id.clone());
            (limb.name.as_str().to_owned(), ids.collect())
        });
        held.collect()
    }
}

fn point(point: Vec3) -> [f64; 3] {
    point.to_array().map(f64::from)
}
