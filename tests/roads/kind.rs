//! The kinds of recordings.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use bevy::math::Vec3;
use tabletop::{
    environment::{
        ActionSpace, EnvironmentOptions, EnvironmentTask, TableWorld, TaskEnvironment,
        WorldOptions, WorldOrigin,
    },
    prelude::*,
};

use super::{mock::MockServer, program::run, shown::Sentences};

/// A kind of recording, by what made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    Scenario,
    Undone,
    Presets,
    Controls,
    Bonds,
    Rings,
    Box,
    Drawer,
    Dragged,
    HandedOver,
    Imitated,
    ImitatedByMotors,
    ImitatedBySight,
    ImitatedByPolicy,
    ImitatedByPanda,
    ImitatedBySo101,
    RobotScenario,
    Multiplied,
    MultipliedByRobot,
    MultipliedByPanda,
    Original,
    Imported,
    Watched,
    Edited,
    World,
    Gymnasium,
    Spliced,
    CutOff,
    BesideRealRobot,
}

/// The stack that most kinds show.
const STACK: Sentences = &[
    "1. Put the green block on the blue block.",
    "2. Put the red block on the green block.",
];

impl Kind {
    pub const ALL: [Self; 29] = [
        Self::Scenario,
        Self::Undone,
        Self::Presets,
        Self::Controls,
        Self::Bonds,
        Self::Rings,
        Self::Box,
        Self::Drawer,
        Self::Dragged,
        Self::HandedOver,
        Self::Imitated,
        Self::ImitatedByMotors,
        Self::ImitatedBySight,
        Self::ImitatedByPolicy,
        Self::ImitatedByPanda,
        Self::ImitatedBySo101,
        Self::RobotScenario,
        Self::Multiplied,
        Self::MultipliedByRobot,
        Self::MultipliedByPanda,
        Self::Original,
        Self::Imported,
        Self::Watched,
        Self::Edited,
        Self::World,
        Self::Gymnasium,
        Self::Spliced,
        Self::CutOff,
        Self::BesideRealRobot,
    ];

    /// What made it, in words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scenario => "scenario",
            Self::Undone => "scenario with undo",
            Self::Presets => "presets during it",
            Self::Controls => "controls",
            Self::Bonds => "bonds",
            Self::Rings => "rings on pegs",
            Self::Box => "box with a lid",
            Self::Drawer => "drawer",
            Self::Dragged => "dragged by the mouse",
            Self::HandedOver => "from hand to hand",
            Self::Imitated => "`imitate`",
            Self::ImitatedByMotors => "`imitate --dynamic`",
            Self::ImitatedBySight => "`imitate --eyes`",
            Self::ImitatedByPolicy => "`imitate --policy`",
            Self::ImitatedByPanda => "`imitate` by Panda",
            Self::ImitatedBySo101 => "`imitate` by SO-101",
            Self::RobotScenario => "scenario of the robot",
            Self::Multiplied => "`multiply`",
            Self::MultipliedByRobot => "`multiply --robot`",
            Self::MultipliedByPanda => "`multiply --robot` Panda",
            Self::Original => "original program",
            Self::Imported => "`import`",
            Self::Watched => "`watch --record`",
            Self::Edited => "`edit --retime`",
            Self::Spliced => "`edit --splice`",
            Self::CutOff => "cut off",
            Self::BesideRealRobot => "beside a real robot",
            Self::World => "Python's `World`",
            Self::Gymnasium => "Gymnasium",
        }
    }

    /// The sentences of its task.
    pub const fn shown(self) -> Sentences {
        match self {
            Self::Scenario
            | Self::Imitated
            | Self::ImitatedByMotors
            | Self::ImitatedBySight
            | Self::ImitatedByPanda
            | Self::ImitatedBySo101
            | Self::Multiplied
            | Self::MultipliedByRobot
            | Self::MultipliedByPanda
            | Self::Watched
            | Self::Edited
            | Self::CutOff
            | Self::BesideRealRobot => STACK,
            Self::Undone | Self::Dragged | Self::Gymnasium => {
                &["1. Put the red block on the blue block."]
            }
            Self::HandedOver => &[
                "1. Hand the red block from the left hand to the right hand and put it on the blue block.",
            ],
            Self::Presets => &[
                "1. Remove the yellow block.",
                "2. Pick up the gray box. (at any time)",
            ],
            Self::Controls => &[
                "- Trigger start: lamp shows green.",
                "- Trigger ring: bell shows ringing, bell shows silent.",
                "- Trigger stop: lamp shows red.",
            ],
            Self::Bonds => &["- Trigger power: lights shows off.", "1. Open drawer."],
            Self::Rings => &[
                "1. Put the blue ring around Peg.",
                "2. Put the red ring around Peg, on the blue ring.",
            ],
            Self::Box => &[
                "1. Open the blue box.",
                "2. Put the yellow block into the blue box.",
                "3. Close the blue box.",
            ],
            Self::Drawer => &["1. Open the orange box."],
            Self::RobotScenario | Self::ImitatedByPolicy => &[],
            Self::Original | Self::Imported => &[
                "1. Open the blue box.",
                "2. Put the red block into the blue box.",
                "3. Close the blue box.",
            ],
            Self::World => &["1. Put the green block on the table at (0, -4)."],
            Self::Spliced => &[
                "1. Put the red block on the blue block.",
                "2. Put the green block on the table at (0, -4). (at any time)",
            ],
        }
    }

    /// Makes one. Those before it in the list are there.
    fn make(self, made: &Recordings, folder: &Path) {
        let recorded = |arguments: &[&str]| {
            let out = folder.to_str().unwrap();
            let arguments: Vec<_> = arguments
                .iter()
                .map(|argument| if *argument == "OUT" { out } else { argument })
                .collect();
            let ended = run(&arguments, &made.folder);
            assert!(ended.is_success(), "{self:?}: {ended:?}");
        };
        let scenario = |name: &str| {
            let path = format!("shipped:scenarios/{name}.ron");
            recorded(&["run", &path, "--record", "OUT", "--quiet"]);
        };
        let demo = made.path(Self::Scenario);
        let demo = demo.to_str().unwrap();
        let imitate = |options: &[&str]| {
            recorded(&[&["imitate", demo, "--record", "OUT"], options].concat());
        };
        let multiply = |options: &[&str]| {
            let many = made.folder.join(format!("{self:?}-many"));
            let out = many.to_str().unwrap();
            recorded(&[&["multiply", demo, "--count", "1", "--out", out], options].concat());
            fs::rename(many.join("0000"), folder).unwrap();
        };
        let panda = "shipped:assets/panda/robot.ron";
        match self {
            Self::Scenario => scenario("stack_small"),
            Self::Undone => {
                let path = made.folder.join("undone.ron");
                fs::write(&path, UNDONE).unwrap();
                recorded(&["run", path.to_str().unwrap(), "--record", "OUT", "--quiet"]);
            }
            Self::Presets => scenario("presets"),
            Self::Controls => scenario("buttons"),
            Self::Bonds => scenario("dock"),
            Self::Rings => scenario("rings"),
            Self::Box => scenario("lidbox"),
            Self::Drawer => scenario("drawer"),
            Self::HandedOver => scenario("hand_over"),
            Self::ImitatedByPolicy => {
                let policy = made.folder.join("policy.safetensors");
                let policy = policy.to_str().unwrap();
                let little = ["--count", "4", "--samples", "16", "--trials", "1"];
                let learned = run(
                    &[&["learn", demo, "--out", policy], &little[..]].concat(),
                    &made.folder,
                );
                assert!(learned.is_success(), "{learned:?}");
                let out = folder.to_str().unwrap();
                // One that has hardly learned does something else than was shown.
                let ended = run(
                    &["imitate", demo, "--policy", policy, "--record", out],
                    &made.folder,
                );
                assert!(ended.is_success() || ended.is_refusal(), "{ended:?}");
            }
            Self::Imitated => imitate(&[]),
            Self::ImitatedByMotors => imitate(&["--dynamic"]),
            Self::ImitatedBySight => imitate(&["--eyes"]),
            Self::ImitatedByPanda => imitate(&["--robot", panda]),
            Self::ImitatedBySo101 => imitate(&["--robot", "shipped:assets/so101/robot.ron"]),
            Self::RobotScenario => scenario("robot_stack"),
            Self::Multiplied => multiply(&[]),
            Self::MultipliedByRobot => multiply(&["--robot"]),
            Self::MultipliedByPanda => multiply(&["--robot", panda]),
            Self::Original => copy(Path::new("tests/cli/originals/2014"), folder),
            Self::Imported => recorded(&[
                "import",
                "tests/cli/originals/2014",
                "OUT",
                "--setup",
                "tests/cli/originals/2014.xml",
            ]),
            Self::Watched => recorded(&["watch", demo, "--record", "OUT"]),
            Self::Edited => recorded(&["edit", demo, "OUT", "--retime", "1=2"]),
            Self::Spliced => {
                let [undone, second] = [Self::Undone, Self::World].map(|kind| made.path(kind));
                let [undone, second] = [&undone, &second].map(|path| path.to_str().unwrap());
                recorded(&["edit", undone, "OUT", "--splice", second]);
            }
            Self::BesideRealRobot => {
                let server = MockServer::start("baxter");
                let path = "shipped:scenarios/stack_small.ron";
                let address = server.address().to_string();
                recorded(&[
                    "run", path, "--shadow", &address, "--record", "OUT", "--quiet",
                ]);
            }
            Self::CutOff => {
                copy(Path::new(demo), folder);
                let log = folder.join("session.jsonl");
                let text = fs::read_to_string(&log).unwrap();
                let (beginning, end) = text.trim_end().rsplit_once('\n').unwrap();
                assert!(end.contains("Finish"), "{end}");
                fs::write(&log, format!("{beginning}\n")).unwrap();
            }
            Self::World => {
                let mut world = small_blocks();
                world.record_into(folder).unwrap();
                world.perform(BY_WORLD).unwrap();
                world.finish_recording().unwrap();
            }
            Self::Dragged => {
                let mut world = small_blocks();
                world.record_into(folder).unwrap();
                drag(&mut world);
                world.finish_recording().unwrap();
            }
            Self::Gymnasium => {
                let episodes = made.folder.join("Gymnasium-episodes");
                act(&episodes);
                fs::rename(episodes.join("000000"), folder).unwrap();
            }
        }
    }
}

/// The red block is put on the blue one after another try, which is taken back.
const UNDONE: &str = r#"(setup: "shipped:tablesetup/small-blocks.xml", steps: [
    WaitUntilRest(2), Start, Select(Right),
    Grasp("Green"), MoveBy((0, 0, 1)), WaitUntilThere(1), Glide(to: (0, -4, 0.3), seconds: 1), Release, WaitUntilRest(3),
    Undo, Undo,
    Grasp("Red"), Glide(to: (-0.9, -3, 2), seconds: 0.4),
    Glide(to: (0.9, -3, 2), seconds: 0.8), Glide(to: (0.9, -3, 0.375), seconds: 0.5), WaitUntilThere(1), Release,
    WaitUntilRest(5), Finish,
])"#;

/// The green block is put elsewhere.
const BY_WORLD: &str = r#"Start, Select(Right), Grasp("Green"), MoveBy((0, 0, 1)), WaitUntilThere(1),
    Glide(to: (0, -4, 0.3), seconds: 1), Release, WaitUntilRest(5), Finish"#;

/// A world in which small blocks have come to rest.
fn small_blocks() -> TableWorld {
    let options = WorldOptions {
        beginning: WorldOrigin::Setup("tablesetup/small-blocks.xml".into()),
        ..WorldOptions::default()
    };
    let mut world = TableWorld::new(&options).unwrap();
    world.step(60);
    world
}

/// The red block goes onto the blue one in small steps of any hand, a command a tick, as the mouse drags.
fn drag(world: &mut TableWorld) {
    let hand = Hand::Any;
    let mut give = |command: SimCommand| {
        world.world_mut().write_command(command);
        world.step(1);
    };
    give(RecordingCommand::Start.into());
    let object = "Red".to_owned();
    give(HandCommand::Grasp { hand, object }.into());
    let corners = [
        [-0.9, -3.0, 0.25],
        [-0.9, -3.0, 2.0],
        [0.9, -3.0, 2.0],
        [0.9, -3.0, 0.76],
    ];
    for ends in corners.map(Vec3::from_array).windows(2) {
        for step in 1..=40_u8 {
            let location = ends[0].lerp(ends[1], f32::from(step) / 40.0);
            give(HandCommand::MoveTo { hand, location }.into());
        }
    }
    for _ in 0..20 {
        world.step(1);
    }
    world.world_mut().write_command(HandCommand::Release(hand));
    world.step(120);
}

/// An environment in which the red block is picked and placed onto the blue one.
fn act(episodes: &Path) {
    let goal = r#"OnTopOf(object: "Red", of: "Blue")"#;
    let task = EnvironmentTask::of_setup(
        Path::new("tablesetup/small-blocks.xml"),
        &[goal.to_owned()],
        false,
        &[],
    );
    let options = EnvironmentOptions {
        action: ActionSpace::PickPlace,
        record: Some(episodes.to_owned()),
        ..EnvironmentOptions::default()
    };
    let mut environment = TaskEnvironment::new(task.unwrap(), &options).unwrap();
    environment.reset(Some(1)).unwrap();
    let action = [-0.9 / 10.0, -3.0 / 6.0, 0.9 / 10.0, -3.0 / 6.0, 0.0];
    assert!(environment.step(&action).unwrap().is_success);
    environment.finish_recording().unwrap();
}

/// A recording of each kind.
pub struct Recordings {
    pub folder: PathBuf,
    seconds: BTreeMap<Kind, f64>,
}

impl Recordings {
    pub fn make() -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("roads");
        drop(fs::remove_dir_all(&folder));
        fs::create_dir_all(&folder).unwrap();
        let mut made = Self {
            folder,
            seconds: BTreeMap::new(),
        };
        for kind in Kind::ALL {
            let began = std::time::Instant::now();
            kind.make(&made, &made.path(kind));
            made.seconds.insert(kind, began.elapsed().as_secs_f64());
        }
        made
    }

    pub fn path(&self, kind: Kind) -> PathBuf {
        self.folder.join(format!("{kind:?}"))
    }
}

/// Copies a recording.
pub fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        match entry.path().is_dir() {
            true => copy(&entry.path(), &target),
            false => drop(fs::copy(entry.path(), target).unwrap()),
        }
    }
}
