//! Presets: objects made without a task file.

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use bevy_rapier3d::prelude::{DefaultRapierContext, RapierContextColliders, RigidBodyDisabled};
use tabletop_core::{Held, ObjectSpec, Preset, Random, Shape, Table};
use tabletop_geometry::{Pose, Rgb};
use tabletop_physics::{Convex, collider, convex_parts};

use crate::edit::spawn;

/// Least distance, in units, to anything else.
const CLEARANCE: f32 = 0.05;

/// Number of places that are tried.
const TRIES: u32 = 1000;

/// Height from which big blocks and boxes fall, in units.
const DROP_HEIGHT: f32 = 10.0;

/// Least distance of turned falling objects from the edges of the table, in units: they may tumble when they land.
const ROOM_TO_TUMBLE: f32 = 1.5;

/// Edge of a big block, in units.
const BIG_BLOCK_SPAN: f32 = 1.5;

/// Outer extents of a box, in units.
const BOX_SPAN: Vec3 = Vec3::new(5.0, 5.0, 3.0);

/// Thickness of a box's floor and walls, in units.
const BOX_THICKNESS: f32 = 0.5;

/// Mass of a box in kg.
const BOX_MASS: f32 = 3.0;

/// Mass of a block in kg.
const BLOCK_MASS: f32 = 1.0;

const COLORS: [Rgb; 8] = [
    Rgb::RED,
    Rgb::BLUE,
    Rgb::YELLOW,
    Rgb::GREEN,
    Rgb::BROWN,
    Rgb::CYAN,
    Rgb::MAGENTA,
    Rgb::ORANGE,
];

/// Puts a preset at a random free place, or reports that there is none.
pub(crate) fn make(world: &mut World, preset: Preset, seed: u64) -> Result<(), String> {
    let mut random = Random::new(seed);
    let surroundings = Surroundings::of(world);
    if let Some(fault) = preset.fault() {
        return Err(fault);
    }
    let pose = surroundings
        .free_place(preset, &mut random)
        .ok_or_else(|| {
            format!("there is no free place over the table for {preset}; clear a part of it")
        })?;
    for spec in objects(preset, pose, &mut random) {
        spawn(world, spec);
    }
    Ok(())
}

/// The objects of a preset whose [`extents`] stand at a pose.
fn objects(preset: Preset, pose: Pose, random: &mut Random) -> Vec<ObjectSpec> {
    let mut block = |id, pose, edge| {
        let shape = Shape::Block {
            span: Vec3::splat(edge),
            color: random.one_of(COLORS),
        };
        ObjectSpec::new(id, pose, BLOCK_MASS, shape)
    };
    match preset {
        Preset::BigBlock => vec![block("largeblock", pose, BIG_BLOCK_SPAN)],
        Preset::Stack(count) => (0..count)
            .map(|below| {
                let location = pose.location.with_z(below as f32 + 0.5);
                block("smallblock", Pose { location, ..pose }, 1.0)
            })
            .collect(),
        Preset::BoxContainer => {
            let shape = Shape::Box {
                span: BOX_SPAN,
                thickness: BOX_THICKNESS,
                color: Rgb::GRAY,
            };
            vec![ObjectSpec::new("container", pose, BOX_MASS, shape)]
        }
    }
}

/// The extents of a cuboid around all of a preset.
fn extents(preset: Preset) -> Vec3 {
    match preset {
        Preset::BigBlock => Vec3::splat(BIG_BLOCK_SPAN),
        Preset::Stack(count) => Vec3::new(1.0, 1.0, count as f32),
        Preset::BoxContainer => BOX_SPAN,
    }
}

/// A random pose of a preset's [`extents`]: all of it over the table, if it fits.
fn pose(preset: Preset, table: &Table, random: &mut Random) -> Pose {
    let turn = random.between((0.0, FRAC_PI_2));
    let (height, margin, rotation) = match preset {
        // About the diagonal (1, 1, 1) of the original program's frame, whose Z is our -Y.
        Preset::BigBlock => {
            let diagonal = Vec3::new(1.0, -1.0, 1.0).normalize();
            let rotation = Quat::from_axis_angle(diagonal, turn);
            (DROP_HEIGHT, ROOM_TO_TUMBLE, rotation)
        }
        Preset::Stack(count) => (count as f32 / 2.0, 0.0, Quat::from_rotation_z(turn)),
        Preset::BoxContainer => (DROP_HEIGHT, 0.0, Quat::from_rotation_z(turn)),
    };
    let reach = Mat3::from_quat(rotation).abs() * extents(preset) / 2.0 + margin;
    let room = (Vec2::new(table.xspan, table.yspan) / 2.0 - reach.xy()).max(Vec2::ZERO);
    let mut coordinate = |room: f32| random.between((-room, room));
    let (x, y) = (coordinate(room.x), coordinate(room.y));
    Pose::new(Vec3::new(x, y, height), rotation)
}

/// The surroundings of a new object.
struct Surroundings {
    table: Table,
    /// The solids of everything but the table.
    solids: Vec<Convex>,
    /// Those of the robot and of held objects.
    held: Vec<Convex>,
}

impl Surroundings {
    fn of(world: &mut World) -> Self {
        let mut tables = world.query::<&Table>();
        let mut surroundings = Self {
            table: tables.iter(world).next().copied().unwrap_or_default(),
            solids: Vec::new(),
            held: Vec::new(),
        };
        let mut things = world.query_filtered::<
            (Entity, &Transform, Option<&ObjectSpec>, Has<Held>),
            (Without<Table>, Without<RigidBodyDisabled>),
        >();
        let mut contexts =
            world.query_filtered::<&RapierContextColliders, With<DefaultRapierContext>>();
        let colliders = contexts.single(world).ok();
        for (thing, place, spec, is_held) in things.iter(world) {
            // Of an object that has changed its shape, undo restores the body, and not the component that describes it.
            let body = colliders.and_then(|colliders| {
                let handle = colliders.entity2collider().get(&thing)?;
                Some(colliders.colliders.get(*handle)?.shared_shape().clone())
            });
            // An object that has just appeared has no body yet.
            let own = || spec.map(|spec| collider(&spec.shape).raw);
            let Some(body) = body.or_else(own) else {
                continue;
            };
            let solids = convex_parts(place.into(), &body);
            if is_held || spec.is_none() {
                surroundings.held.extend(solids.iter().cloned());
            }
            surroundings.solids.extend(solids);
        }
        surroundings
    }

    /// The first of many random places at which the preset touches nothing, preferably one from which it does not fall onto the
    /// robot or onto a held object.
    fn free_place(&self, preset: Preset, random: &mut Random) -> Option<Pose> {
        let mut second_best = None;
        for _ in 0..TRIES {
            let pose = pose(preset, &self.table, random);
            if !is_free(&cuboid(extents(preset), pose), &self.solids) {
                continue;
            }
            if is_free(&way_down(preset, pose), &self.held) {
                return Some(pose);
            }
            second_best.get_or_insert(pose);
        }
        second_best
    }
}

fn is_free(place: &Convex, solids: &[Convex]) -> bool {
    !solids.iter().any(|solid| place.is_near(solid, CLEARANCE))
}

/// The upright cuboid that a preset at a pose falls through.
fn way_down(preset: Preset, pose: Pose) -> Convex {
    let span = Mat3::from_quat(pose.rotation).abs() * extents(preset);
    let top = pose.location.z + span.z / 2.0;
    let center = pose.location.with_z(top / 2.0);
    cuboid(span.with_z(top), Pose::at(center))
}

fn cuboid(span: Vec3, pose: Pose) -> Convex {
    let color = Rgb::GRAY;
    let shape = collider(&Shape::Block { span, color }).raw;
    Convex { pose, shape }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Hand, Manipulator, StepApp as _, prelude::*};

    use super::*;
    use crate::test_app::test_app;

    fn app() -> App {
        let mut app = test_app();
        tell(&mut app, SceneCommand::Set(Box::default()));
        app
    }

    fn tell(app: &mut App, command: SceneCommand) {
        app.world_mut().write_command(command);
        app.step(1);
    }

    fn make(app: &mut App, preset: Preset, seed: u64) {
        tell(app, SceneCommand::Make { preset, seed });
    }

    fn specs(app: &App) -> Vec<&ObjectSpec> {
        let objects = app.world().resource::<ObjectIndex>().iter();
        objects
            .filter_map(|object| app.world().get(object))
            .collect()
    }

    fn refusals(app: &App) -> Vec<String> {
        let facts = app.world().resource::<Messages<SimFact>>();
        let mut all = facts.get_cursor();
        all.read(facts)
            .filter_map(|fact| {
                if let SimFact::Refused { reason, .. } = fact {
                    Some(reason.clone())
                } else {
                    None
                }
            })
            .collect()
    }

    fn solids(spec: &ObjectSpec) -> Vec<Convex> {
        convex_parts(spec.pose, &collider(&spec.shape).raw)
    }

    #[test]
    fn a_stack_stands_still_where_it_was_made() {
        let mut app = app();
        make(&mut app, Preset::Stack(5), 3);
        app.step(120);
        let specs = specs(&app);
        let ids: Vec<_> = specs.iter().map(|spec| &*spec.id).collect();
        let expected = ["smallblock", "smallblock#0", "smallblock#1", "smallblock#2"];
        assert_eq!(ids[..4], expected);
        for (below, spec) in specs.iter().enumerate() {
            assert_eq!((spec.pose.location.z, spec.mass), (below as f32 + 0.5, 1.0));
            assert_eq!(spec.pose.rotation, specs[0].pose.rotation);
            let object = app.world().resource::<ObjectIndex>().get(&spec.id);
            let place = app.world().get::<Transform>(object.unwrap()).unwrap();
            assert!(place.translation.distance(spec.pose.location) < 0.01);
        }
    }

    #[test]
    fn a_big_block_and_a_box_fall_onto_the_table() {
        for (preset, id, low, high) in [
            (Preset::BigBlock, "largeblock", 0.74, 1.3),
            (Preset::BoxContainer, "container", 1.49, 1.51),
        ] {
            for seed in 0..100 {
                let mut app = app();
                make(&mut app, preset, seed);
                assert_eq!(specs(&app)[0].pose.location.z, 10.0);
                app.step(240);
                let object = app.world().resource::<ObjectIndex>().get(id).unwrap();
                let height = app.world().get::<Transform>(object).unwrap().translation.z;
                assert!((low..high).contains(&height), "{preset} {seed}: {height}");
            }
        }
    }

    #[test]
    fn the_seed_decides() {
        let made = |seed| {
            let mut app = app();
            make(&mut app, Preset::Stack(3), seed);
            specs(&app).into_iter().cloned().collect::<Vec<_>>()
        };
        assert_eq!(made(7), made(7));
        assert_ne!(made(7), made(8));
    }

    #[test]
    fn presets_overlap_nothing_until_there_is_no_room() {
        for seed in 0..4 {
            let mut app = app();
            app.world_mut().write_command(ClockCommand::SetPaused(true));
            let mut made = 0;
            for more in 0..200 {
                let preset = [Preset::BigBlock, Preset::Stack(12), Preset::BoxContainer][more % 3];
                make(&mut app, preset, 1000 * seed + more as u64);
                made = specs(&app).len();
                if let [reason] = &refusals(&app)[..] {
                    assert!(reason.starts_with("there is no free place"), "{reason}");
                    break;
                }
            }
            assert!((20..600).contains(&made), "{made}");
            let specs = specs(&app);
            for (index, one) in specs.iter().enumerate() {
                for other in &specs[..index] {
                    let is_of_one_stack = one.pose.location.xy() == other.pose.location.xy();
                    let overlap = solids(one).iter().any(|solid| {
                        let mut others = solids(other);
                        others.iter_mut().any(|other| solid.is_near(other, 0.0))
                    });
                    assert!(is_of_one_stack || !overlap, "{} {}", one.id, other.id);
                }
                assert!(one.pose.location.x.abs() <= 9.5 && one.pose.location.y.abs() <= 5.5);
            }
        }
    }

    #[test]
    fn presets_avoid_the_held_object_if_there_is_another_place() {
        let wall = Shape::Block {
            span: Vec3::new(14.0, 12.0, 1.0),
            color: Rgb::GRAY,
        };
        let wall = ObjectSpec::new("wall", Pose::at(Vec3::new(3.0, 0.0, 5.0)), 1.0, wall);
        for seed in 0..20 {
            let mut app = app();
            let held = Held {
                by: Manipulator::Hand(Hand::Left),
            };
            app.world_mut()
                .spawn((Transform::from(wall.pose), wall.clone(), held));
            make(&mut app, Preset::BigBlock, seed);
            assert!(specs(&app)[1].pose.location.x < -4.7, "seed {seed}");
            make(&mut app, Preset::BoxContainer, seed);
            assert_eq!(specs(&app).len(), 3, "{:?}", refusals(&app));
        }
    }

    #[test]
    fn ids_are_not_given_twice_before_the_next_scene() {
        let mut app = app();
        let made = |app: &mut App| {
            make(app, Preset::BigBlock, 1);
            let id = specs(app)[0].id.clone();
            tell(app, SceneCommand::Clear);
            id
        };
        assert_eq!(made(&mut app), "largeblock");
        assert_eq!(made(&mut app), "largeblock#0");
        tell(&mut app, SceneCommand::Set(Box::default()));
        assert_eq!(made(&mut app), "largeblock");
    }

    #[test]
    fn no_stack_is_too_high_for_the_machine() {
        let mut app = app();
        make(&mut app, Preset::Stack(u32::MAX), 1);
        assert_eq!(
            refusals(&app),
            [format!("a stack has 1 to 50 blocks, not {}", u32::MAX)]
        );
        assert!(specs(&app).is_empty());
    }
}
