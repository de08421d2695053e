//! A world after undo goes on bit for bit like one that never took the detour.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use bevy::prelude::*;
use bevy_rapier3d::prelude::{Sleeping, Velocity};
use tabletop_core::{ChainSpec, History, LidBoxSpec, Recording, prelude::*};
use tabletop_demonstrator::DemonstratorPlugin;
use tabletop_physics::PhysicsPlugin;
use tabletop_scene::ScenePlugin;

/// A small random stream (SplitMix64).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % limit as u64) as usize
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.below(10_000) as f32 / 10_000.0
    }

    fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }
}

const IDS: [&str; 13] = [
    "block0", "block1", "block2", "block3", "block4", "ball", "wall", "log", "c-link2", "c-link5",
    "c-start", "b-lid", "b-box",
];

fn object(id: &str, location: (f32, f32, f32), mass: f32, shape: Shape) -> SceneItem {
    SceneItem::Object(ObjectSpec {
        id: id.into(),
        pose: Pose::at(location.into()),
        mass,
        shape,
        descriptions: Vec::new(),
    })
}

fn scene() -> SimCommand {
    let color = Rgb::GRAY;
    let span = Vec3::ONE;
    let mut items: Vec<_> = (0..5)
        .map(|i| {
            let location = (-5.0, 0.0, i as f32 * 1.2 + 0.6);
            object(
                &format!("block{i}"),
                location,
                1.0,
                Shape::Block { span, color },
            )
        })
        .collect();
    let (radius, yspan) = (0.5, 2.0);
    items.extend([
        object(
            "ball",
            (-5.2, 0.2, 12.0),
            1.0,
            Shape::Sphere { radius, color },
        ),
        object(
            "log",
            (-1.0, 3.0, 3.0),
            1.0,
            Shape::Cylinder {
                radius,
                yspan,
                color,
            },
        ),
        object(
            "wall",
            (-2.0, 0.0, 1.0),
            0.0,
            Shape::Block {
                span: Vec3::new(0.2, 6.0, 2.0),
                color,
            },
        ),
        SceneItem::Chain(ChainSpec {
            id: "c".into(),
            start: Vec3::new(-6.0, -4.0, 4.0),
            end: Vec3::new(1.0, -4.0, 4.0),
            link_span: Vec3::new(0.1, 1.0, 0.1),
            link_count: 8,
            link_padding: 0.05,
            link_mass: 1.0,
            color,
        }),
        SceneItem::LidBox(LidBoxSpec {
            id: "b".into(),
            pose: Pose::at(Vec3::new(5.0, 0.0, 2.5)),
            span: Vec3::new(4.0, 4.0, 5.0),
            thickness: 0.4,
            box_mass: 9.0,
            lid_mass: 1.0,
            color,
            handle_span: Vec3::ONE,
            handle_thickness: 0.2,
            handle_color: color,
            descriptions: Vec::new(),
        }),
    ]);
    SimCommand::SetScene(Box::new(SceneSpec { items, ..default() }))
}

fn hand_command(random: &mut Random) -> SimCommand {
    let hand = random.of(&Hand::ALL);
    match random.below(8) {
        0..=2 => SimCommand::Grasp {
            hand,
            object: random.of(&IDS).into(),
        },
        3 => SimCommand::Turn {
            hand,
            axis: random.of(&[Vec3::X, Vec3::Y, Vec3::Z]),
            degrees: random.between(-90.0, 90.0),
        },
        4 => SimCommand::Release(hand),
        5 if random.below(3) == 0 => SimCommand::Destroy(hand),
        _ => SimCommand::MoveTo {
            hand,
            location: Vec3::new(
                random.between(-9.0, 9.0),
                random.between(-5.0, 5.0),
                random.between(-1.0, 7.0),
            ),
        },
    }
}

/// What is told at which tick.
fn script(random: &mut Random, ticks: u64) -> Vec<Vec<SimCommand>> {
    (0..ticks)
        .map(|_| match random.below(6) {
            0 => vec![hand_command(random)],
            _ => Vec::new(),
        })
        .collect()
}

struct Recorded(App);

impl Recorded {
    fn new() -> Self {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            CorePlugin::default(),
            PhysicsPlugin::default(),
            ScenePlugin,
            DemonstratorPlugin,
        ))
        .start();
        app.world_mut().write_message(scene());
        app.step(1);
        app.insert_resource(Recording(true));
        Self(app)
    }

    fn tick(&mut self, commands: &[SimCommand]) {
        for command in commands {
            self.0.world_mut().write_message(command.clone());
        }
        self.0.step(1);
    }

    fn undoable(&self) -> usize {
        self.0.world().resource::<History>().undoable
    }

    /// Every bit that tells the state of the objects.
    fn bits(&self) -> Vec<(String, Vec<u32>)> {
        let world = self.0.world();
        let tick = world.resource::<SimTick>().0 as u32;
        let objects = world.resource::<ObjectIndex>().iter().map(|object| {
            let place = world.get::<Transform>(object).unwrap();
            let velocity = world.get::<Velocity>(object).copied().unwrap_or_default();
            let numbers = [place.translation, velocity.linear, velocity.angular]
                .into_iter()
                .flat_map(|vector| vector.to_array())
                .chain(place.rotation.to_array())
                .map(f32::to_bits);
            let sleeps = world
                .get::<Sleeping>(object)
                .is_some_and(|state| state.sleeping);
            let id = world.get::<ObjectSpec>(object).unwrap().id.clone();
            (id, numbers.chain([u32::from(sleeps)]).collect())
        });
        std::iter::once(("tick".into(), vec![tick]))
            .chain(objects)
            .collect()
    }
}

const TICKS: u64 = 150;

#[test]
fn undo_leaves_no_trace() {
    let mut detours = 0;
    for seed in 0..100 {
        let mut random = Random(seed);
        let script = script(&mut random, TICKS);
        let turning_point = random.below(TICKS as usize - 20);
        let detour = self::script(&mut random, 5 + seed % 60);

        let mut straight = Recorded::new();
        let mut with_detour = Recorded::new();
        for (tick, commands) in script.iter().enumerate() {
            straight.tick(commands);
            if tick != turning_point {
                with_detour.tick(commands);
                continue;
            }
            let before = with_detour.undoable();
            let first = SimCommand::Grasp {
                hand: Hand::Both,
                object: "ball".into(),
            };
            with_detour.tick(std::slice::from_ref(&first));
            let begun = with_detour.undoable() > before;
            if begun {
                detours += 1;
                detour
                    .iter()
                    .for_each(|commands| with_detour.tick(commands));
                let undos = with_detour.undoable() - before;
                let mut last = vec![SimCommand::Undo; undos];
                last.extend_from_slice(commands);
                with_detour.tick(&last);
            } else {
                break;
            }
            assert_eq!(
                with_detour.bits(),
                straight.bits(),
                "seed {seed}, right after undo"
            );
        }
        if with_detour.bits()[0] == straight.bits()[0] {
            assert_eq!(with_detour.bits(), straight.bits(), "seed {seed}");
        }
    }
    assert!(detours > 50, "only {detours} detours were taken");
}

#[test]
fn redo_brings_back_what_was_undone() {
    for seed in 0..20 {
        let mut random = Random(1000 + seed);
        let mut world = Recorded::new();
        script(&mut random, 80)
            .iter()
            .for_each(|commands| world.tick(commands));
        let segments = world.undoable();
        let mut expected = Recorded::new();
        let mut random = Random(1000 + seed);
        script(&mut random, 80)
            .iter()
            .for_each(|commands| expected.tick(commands));

        // A tick that undoes everything and brings it back simulates one tick more.
        let mut there_and_back = vec![SimCommand::Undo; segments];
        there_and_back.extend(vec![SimCommand::Redo; segments]);
        world.tick(&there_and_back);
        expected.tick(&[]);
        for _ in 0..40 {
            assert_eq!(
                world.bits(),
                expected.bits(),
                "seed {seed}, {segments} segments"
            );
            world.tick(&[]);
            expected.tick(&[]);
        }
        assert_eq!(world.undoable(), segments);
    }
}

#[test]
fn what_is_kept_for_undo_goes_when_the_recording_ends() {
    let mut world = Recorded::new();
    world.tick(&[
        SimCommand::Grasp {
            hand: Hand::Left,
            object: "ball".into(),
        },
        SimCommand::Destroy(Hand::Left),
        scene(),
    ]);
    world.tick(&[SimCommand::Undo]);
    assert_eq!(world.undoable(), 1);
    world.0.insert_resource(Recording(false));
    world.tick(&[SimCommand::Undo]);
    assert_eq!(world.undoable(), 0);
    let mut hidden = world.0.world_mut().query_filtered::<(), (
        With<ObjectSpec>,
        With<bevy::ecs::entity_disabling::Disabled>,
    )>();
    assert_eq!(hidden.iter(world.0.world()).count(), 0);
}
