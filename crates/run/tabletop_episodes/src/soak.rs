//! Soak test: hours of random acts of a user in one process, with checks after every tick.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use tabletop_core::{
    Actor, Arm, ClockCommand, Drive, Hand, HandCommand, Held, HistoryCommand, ObjectIndex,
    ObjectSpec, Preset, Random, RecordingCommand, RobotCommand, RobotJoint, SceneCommand,
    SceneItem, SceneSpec, Shape, SimCommand, StepApp as _, TICKS_PER_SECOND, Table,
    WriteCommand as _,
};
use tabletop_geometry::{Pose, Rgb, Twist};
use tabletop_physics::{Convex, collider, convex_parts, depth};
use tabletop_recorder::{Durability, RecorderPlugin, finish_recording};

use tabletop_replay::Replay;
use tabletop_sim::{TabletopSimPlugins, headless_app_with};

/// Number of ticks of a round before its recording begins.
const BEFORE: u64 = 30 * TICKS_PER_SECOND as u64;

/// Number of ticks of a round's recording.
const RECORDED: u64 = 30 * TICKS_PER_SECOND as u64;

/// Largest depth of a body in the table, or in an immovable object, in units.
const DEEPEST: f32 = 0.05;

/// Largest number of objects of a scene.
const OBJECTS: usize = 10;

/// A round: random commands in a new simulator, a recording of the second half, and its replay.
#[derive(Clone, Debug)]
pub struct Round {
    /// Seed of all randomness in it.
    pub seed: u64,
    /// Folder of its recording, and of that of its replay; it must exist.
    pub folder: PathBuf,
}

impl Round {
    /// Number of simulated ticks of a round, without its replay.
    pub const TICKS: u64 = BEFORE + RECORDED;

    /// Runs the round.
    ///
    /// # Errors
    /// A failed check, with its tick.
    pub fn run(&self) -> Result<(), String> {
        let mut random = Random::new(self.seed);
        let recorded = self.folder.join("recorded");
        let recorder = RecorderPlugin {
            folder: recorded.clone(),
            durability: Durability::None,
            ..default()
        };
        let mut app = headless_app_with(TabletopSimPlugins.build().set(recorder));
        give(&mut app, SceneCommand::Set(Box::new(scene(&mut random))));
        for tick in 0..Self::TICKS {
            if tick == BEFORE {
                give(&mut app, RecordingCommand::Start);
            }
            if below(&mut random, 20) == 0 {
                give(&mut app, command(&mut random));
            }
            app.step(1);
            look(&mut app).map_err(|fault| format!("tick {tick}: {fault}"))?;
        }
        give(&mut app, ClockCommand::SetPaused(false));
        finish_recording(app.world_mut())?;
        drop(app);
        self.replay(&recorded)
    }

    fn replay(&self, recorded: &Path) -> Result<(), String> {
        let replayed = self.folder.join("replayed");
        let recorder = RecorderPlugin {
            folder: replayed.clone(),
            durability: Durability::None,
            ..default()
        };
        let replay = Replay::read(recorded).map_err(|error| error.to_string())?;
        replay
            .record(recorder, replay.camera())
            .map_err(|error| error.to_string())?;
        match replay.first_difference(&replayed) {
            Ok(None) => Ok(()),
            Ok(Some(difference)) => Err(format!("the replay differs: {difference}")),
            Err(error) => Err(error.to_string()),
        }
    }
}

fn give(app: &mut App, command: impl Into<SimCommand>) {
    app.world_mut().write_command_of(Actor::App, command);
}

/// Something that nothing moves.
struct FixedParts {
    id: String,
    parts: Vec<Convex>,
}

/// Looks at every object: it is somewhere, and in nothing that does not move.
fn look(app: &mut App) -> Result<(), String> {
    let obstacles = obstacles(app);
    let world = app.world();
    for object in world.resource::<ObjectIndex>().iter() {
        let (Some(spec), Some(place)) = (
            world.get::<ObjectSpec>(object),
            world.get::<Transform>(object),
        ) else {
            continue;
        };
        let id = &spec.id;
        let twist = world.get::<Twist>(object);
        let is_calm =
            twist.is_none_or(|twist| twist.linear.is_finite() && twist.angular.is_finite());
        if !place.is_finite() || !is_calm {
            return Err(format!("{id} is nowhere: {place:?}, {twist:?}"));
        }
        if spec.is_fixed() {
            continue;
        }
        let parts = solids(&spec.shape, Pose::IDENTITY);
        let depths = obstacles.iter().map(|obstacle| {
            let depth = depth(&parts, Pose::from(place), &obstacle.parts);
            (depth, &obstacle.id)
        });
        let deepest = depths.max_by(|(one, _), (other, _)| one.total_cmp(other));
        if let Some((depth, other)) = deepest.filter(|(depth, _)| *depth > DEEPEST) {
            let (at, held) = (place.translation, world.get::<Held>(object));
            return Err(format!(
                "{id} is {depth} deep in {other}, at {at}; {twist:?}, {held:?}"
            ));
        }
    }
    Ok(())
}

/// Immovable obstacles: the table, and fixed objects that nobody holds.
fn obstacles(app: &mut App) -> Vec<FixedParts> {
    let mut tables = app.world_mut().query::<&Table>();
    let table = tables.iter(app.world()).next().map(|table| {
        let slab = Shape::Block {
            span: Vec3::new(table.xspan, table.yspan, Table::THICKNESS),
            color: Rgb::GRAY,
        };
        FixedParts {
            id: "the table".into(),
            parts: solids(&slab, Pose::at(Vec3::NEG_Z * Table::THICKNESS / 2.0)),
        }
    });
    let world = app.world();
    let fixed = world.resource::<ObjectIndex>().iter().filter_map(|object| {
        let spec = world.get::<ObjectSpec>(object)?;
        let stands = spec.is_fixed() && !world.entity(object).contains::<Held>();
        let place = world.get::<Transform>(object)?;
        stands.then(|| FixedParts {
            id: spec.id.clone(),
            parts: solids(&spec.shape, Pose::from(place)),
        })
    });
    table.into_iter().chain(fixed).collect()
}

fn solids(shape: &Shape, at: Pose) -> Vec<Convex> {
    convex_parts(at, &collider(shape).raw)
}

/// A random scene of towers and single objects, none in another.
fn scene(random: &mut Random) -> SceneSpec {
    let color = Rgb::GRAY;
    let count = 2 + below(random, OBJECTS - 1);
    let items = (0..count).map(|number| {
        // A place of its own for each, on a grid.
        let place = Vec3::new(
            (number % 4) as f32 * 4.5 - 6.75,
            (number / 4) as f32 * 3.5 - 3.5,
            random.between((1.5, 4.0)),
        );
        let span = Vec3::new(
            random.between((0.4, 2.0)),
            random.between((0.4, 2.0)),
            random.between((0.4, 2.0)),
        );
        let shape = match below(random, 4) {
            0 => Shape::Sphere {
                radius: span.x / 2.0,
                color,
            },
            1 => Shape::Cylinder {
                radius: span.x / 2.0,
                yspan: span.y,
                color,
            },
            _ => Shape::Block { span, color },
        };
        let mass = if below(random, 6) == 0 {
            0.0
        } else {
            random.between((0.2, 5.0))
        };
        let turned = Vec3::new(0.0, 0.0, random.between((0.0, 90.0)));
        let pose = Pose::from_degrees(place, turned);
        SceneItem::Object(ObjectSpec::new(id(number), pose, mass, shape))
    });
    SceneSpec {
        items: items.collect(),
        ..default()
    }
}

fn id(number: usize) -> String {
    format!("object{number}")
}

/// A number below this one.
fn below(random: &mut Random, limit: usize) -> usize {
    (random.bits() % limit as u64) as usize
}

fn command(random: &mut Random) -> SimCommand {
    let hand = random.one_of(Hand::ALL);
    let to = Vec3::new(
        random.between((-9.0, 9.0)),
        random.between((-5.0, 5.0)),
        random.between((0.5, 7.0)),
    );
    match below(random, 24) {
        0..=6 => HandCommand::Grasp {
            hand,
            object: id(below(random, OBJECTS)),
        }
        .into(),
        7..=10 => HandCommand::MoveTo { hand, location: to }.into(),
        11 => HandCommand::Turn {
            hand,
            axis: random.one_of([Vec3::X, Vec3::Y, Vec3::Z]),
            degrees: random.between((-90.0, 90.0)),
        }
        .into(),
        12 | 13 => HandCommand::Release(hand).into(),
        14 => HandCommand::Destroy(hand).into(),
        15 | 16 => HistoryCommand::Undo.into(),
        17 => HistoryCommand::Redo.into(),
        18 => RobotCommand::Show(below(random, 3) != 0).into(),
        19 => RobotCommand::drive([(
            random.one_of(RobotJoint::ALL),
            Drive::Toward(f64::from(random.between((-3.0, 3.0)))),
        )])
        .into(),
        20 => RobotCommand::drive([(
            RobotJoint::gripper(random.one_of(Arm::BOTH)),
            Drive::Toward(f64::from(random.between((0.0, 2.0)))),
        )])
        .into(),
        21 | 22 => RobotCommand::ReachTo {
            arm: random.one_of(Arm::BOTH).name(),
            pose: Pose::at(Vec3::new(to.x / 2.0, -3.0, to.z / 2.0 + 0.5)),
        }
        .into(),
        _ => SceneCommand::Make {
            preset: random.one_of([Preset::BigBlock, Preset::Stack(3), Preset::BoxContainer]),
            seed: random.bits() % 1000,
        }
        .into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_in_the_table_or_at_nan_are_noticed() {
        let mut app = headless_app_with(TabletopSimPlugins);
        let color = Rgb::GRAY;
        let sphere = Shape::Sphere { radius: 1.0, color };
        let ball = ObjectSpec::new("ball", Pose::at(Vec3::Z), 1.0, sphere);
        let scene = SceneSpec {
            items: vec![SceneItem::Object(ball)],
            ..default()
        };
        give(&mut app, SceneCommand::Set(Box::new(scene)));
        app.step(1);
        assert_eq!(look(&mut app), Ok(()));
        let ball = app.world().resource::<ObjectIndex>().get("ball").unwrap();
        let mut fault = |z: f32| {
            let mut place = app.world_mut().get_mut::<Transform>(ball).unwrap();
            place.translation.z = z;
            look(&mut app).err().map(|fault| fault[..11].to_owned())
        };
        assert_eq!(fault(0.96), None);
        assert_eq!(fault(0.88), Some("ball is 0.1".into()));
        assert_eq!(fault(0.38), Some("ball is 0.6".into()));
        assert_eq!(fault(f32::NAN), Some("ball is now".into()));
    }
}
