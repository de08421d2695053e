//! A world without physics that acts on commands as the demonstrator does: where an object is follows from the tick alone.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
};

use bevy::{ecs::system::SystemState, prelude::*};
use tabletop_core::{
    CommandId, CommandSystems, CorePlugin, Hand, HandCamera, HandCameras, HandCommand, HandFact,
    HandImages, Hands, HistoryCommand, HistoryFact, IssuedCommand, ObjectEdit, ObjectIndex,
    ObjectSpec, Picture, PictureDemand, PictureSystems, Recording, SceneCommand, SceneFact,
    SceneItem, SceneSpec, SensorImage, Shape, SimCommand, SimFact, SimSystems, SimTick,
    StepApp as _, WriteCommand as _, carry_out,
};
use tabletop_geometry::{Pose, Rgb};
use tabletop_recorder::RecorderPlugin;

/// A folder for the recordings of a test, removed in the end.
pub struct Place(PathBuf);

impl Place {
    pub fn new() -> Self {
        Self::in_folder(&std::env::temp_dir())
    }

    /// In memory, where that is a folder: for thousands of recordings.
    pub fn in_memory() -> Self {
        let memory = Path::new("/dev/shm");
        match memory.is_dir() {
            true => Self::in_folder(memory),
            false => Self::new(),
        }
    }

    fn in_folder(folder: &Path) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("tabletop_recorder_{}_{number}", std::process::id());
        let path = folder.join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    pub fn demo(&self) -> PathBuf {
        self.0.join("demo")
    }

    pub fn read(&self, file: &str) -> String {
        let path = self.demo().join(file);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// The files of the recording with their content; folders end with a slash.
    pub fn tree(&self) -> BTreeMap<String, Vec<u8>> {
        files_in(&self.demo())
    }

    /// The names of the pictures of a segment, in the order of their frames.
    pub fn frames(&self, segment: u32) -> Vec<u64> {
        let folder = self.demo().join(segment.to_string());
        let mut frames: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| {
                let name = entry.unwrap().file_name().into_string().unwrap();
                name.strip_suffix(".png").unwrap().parse().unwrap()
            })
            .collect();
        frames.sort_unstable();
        frames
    }
}

/// The files in a folder with their content; folders end with a slash.
pub fn files_in(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fn collect(folder: &Path, name: &str, tree: &mut BTreeMap<String, Vec<u8>>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = format!("{name}{}", path.file_name().unwrap().to_string_lossy());
            if path.is_dir() {
                let name = format!("{name}/");
                collect(&path, &name, tree);
                tree.insert(name, Vec::new());
            } else {
                tree.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    let mut tree = BTreeMap::new();
    collect(folder, "", &mut tree);
    tree
}

impl Drop for Place {
    fn drop(&mut self) {
        let _already_gone = fs::remove_dir_all(&self.0);
    }
}

/// The facts of the tests' last steps.
#[derive(Resource, Default)]
pub struct Heard(pub Vec<SimFact>);

#[derive(Clone)]
struct Moment {
    tick: SimTick,
    objects: Vec<ObjectSpec>,
    hands: Vec<Option<String>>,
}

#[derive(Resource, Default)]
struct Moments {
    undoable: Vec<Moment>,
    redoable: Vec<(Moment, Moment)>,
}

/// An app that records into `demo` of this place.
pub fn app(place: &Place) -> App {
    app_into(place.demo())
}

pub fn app_into(folder: PathBuf) -> App {
    app_with(RecorderPlugin {
        folder,
        ..default()
    })
}

pub fn app_with(recorder: RecorderPlugin) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, CorePlugin::default(), recorder))
        .insert_resource(HandCameras(
            ["left_camera", "right_camera"].map(hand_camera).into(),
        ))
        .init_resource::<Heard>()
        .init_resource::<Moments>()
        .init_resource::<PictureDemand>()
        .init_resource::<SensorImage>()
        .add_systems(
            FixedUpdate,
            (
                undo_and_redo.in_set(CommandSystems::History),
                act.in_set(SimSystems::Ingest),
                move_objects.in_set(SimSystems::Physics),
                take_picture.in_set(PictureSystems::Draw),
                hear.in_set(SimSystems::Record),
            ),
        )
        .start();
    app
}

fn hand_camera(name: &str) -> HandCamera {
    HandCamera {
        name: name.into(),
        link: "hand".into(),
        mount: Pose::IDENTITY,
        vertical_fov: 1.0,
        width: 5,
        height: 2,
    }
}

pub fn block(id: &str) -> ObjectSpec {
    let shape = Shape::Block {
        span: Vec3::ONE,
        color: Rgb::new(1.0, 0.0, 0.0),
    };
    ObjectSpec::new(id, Pose::IDENTITY, 1.0, shape)
}

pub fn scene(ids: &[&str]) -> SimCommand {
    SimCommand::Scene(SceneCommand::Set(Box::new(SceneSpec {
        items: ids.iter().map(|id| SceneItem::Object(block(id))).collect(),
        ..default()
    })))
}

pub fn grasp(hand: Hand, object: &str) -> SimCommand {
    let object = object.into();
    SimCommand::Hand(HandCommand::Grasp { hand, object })
}

/// Carries out commands, each after so many ticks.
pub fn run(app: &mut App, script: &[(u64, SimCommand)]) {
    for (ticks, command) in script {
        app.step(*ticks);
        app.world_mut().write_command(command.clone());
    }
    app.step(1);
}

pub fn heard(app: &mut App) -> Vec<SimFact> {
    std::mem::take(&mut app.world_mut().resource_mut::<Heard>().0)
}

/// Objects whose id begins with `still` stand, the others move by a hundredth of a unit a tick.
pub fn location(id: &str, tick: SimTick) -> Vec3 {
    let way = if id.starts_with("still") { 0 } else { tick.0 };
    Vec3::new(way as f32 * 0.01, id.len() as f32, 0.5)
}

fn move_objects(tick: Res<SimTick>, mut objects: Query<(&ObjectSpec, &mut Transform)>) {
    for (spec, mut transform) in &mut objects {
        transform.translation = location(&spec.id, *tick);
    }
}

fn take_picture(
    mut demand: ResMut<PictureDemand>,
    mut image: ResMut<SensorImage>,
    mut hand_images: ResMut<HandImages>,
    tick: Res<SimTick>,
) {
    if demand.take() {
        image.tick = *tick;
        image.picture.resize(4, 3);
        image.picture.rgb.fill(tick.0 as u8);
    }
    if let Some(cameras) = hand_images.take() {
        hand_images.tick = *tick;
        hand_images.pictures = (cameras.iter().enumerate())
            .map(|(i, camera)| {
                let mut picture = Picture::default();
                picture.resize(camera.width, camera.height);
                picture.rgb.fill((tick.0 + i as u64) as u8);
                picture
            })
            .collect();
    }
}

fn hear(mut facts: MessageReader<SimFact>, mut heard: ResMut<Heard>) {
    heard.0.extend(facts.read().cloned());
}

fn undo_and_redo(
    world: &mut World,
    reader: &mut SystemState<MessageReader<IssuedCommand>>,
) -> Result {
    carry_out(world, reader, |world, cause, command| {
        let now = moment(world);
        let mut moments = world.resource_mut::<Moments>();
        match command {
            HistoryCommand::Undo => {
                if let Some(before) = moments.undoable.pop() {
                    moments.redoable.push((before.clone(), now));
                    let undone = HistoryFact::Undone { cause };
                    turn(world, &before, SimFact::History(undone));
                }
            }
            HistoryCommand::Redo => {
                if let Some((before, after)) = moments.redoable.pop() {
                    moments.undoable.push(before);
                    let redone = HistoryFact::Redone { cause };
                    turn(world, &after, SimFact::History(redone));
                }
            }
        }
        Ok(())
    })
}

fn act(world: &mut World, reader: &mut SystemState<MessageReader<IssuedCommand>>) -> Result {
    let mut commands: Vec<_> = reader.get_mut(world)?.read().cloned().collect();
    commands.sort_by_key(|issued| issued.command.phase());
    for IssuedCommand {
        id: cause, command, ..
    } in commands
    {
        match command {
            SimCommand::Scene(SceneCommand::Set(scene)) => {
                clear(world, cause);
                for item in scene.items {
                    if let SceneItem::Object(spec) = item {
                        let fact = create(world, Some(cause), spec);
                        world.write_message(fact);
                    }
                }
            }
            SimCommand::Scene(SceneCommand::Clear) => clear(world, cause),
            SimCommand::Hand(HandCommand::Grasp { hand, object }) => {
                let Some(entity) = world.resource::<ObjectIndex>().get(&object) else {
                    continue;
                };
                if let Some(other) = world.resource::<Hands>().holder_of(entity) {
                    release(world, cause, other);
                }
                begin_segment(world, cause);
                world.resource_mut::<Hands>().set_held(hand, Some(entity));
                world.write_message(SimFact::Hand(HandFact::Grasped {
                    cause,
                    hand,
                    id: object,
                }));
            }
            SimCommand::Hand(HandCommand::Release(hand)) => release(world, cause, hand),
            SimCommand::Hand(HandCommand::Destroy(hand)) => {
                let Some(id) = held(world, hand) else {
                    continue;
                };
                begin_segment(world, cause);
                let fact = delete(world, Some(cause), &id);
                world.write_message(fact);
                world.resource_mut::<Hands>().set_held(hand, None);
                world.write_message(SimFact::Hand(HandFact::Destroyed { cause, hand, id }));
            }
            SimCommand::Scene(SceneCommand::Edit(edits)) => {
                for edit in edits {
                    let (gone, come) = match edit {
                        ObjectEdit::Add(spec) => (None, Some(spec)),
                        ObjectEdit::Change { object, spec } => (Some(object), Some(spec)),
                        ObjectEdit::Remove(object) => (Some(object), None),
                    };
                    if let Some(id) = gone {
                        let fact = delete(world, Some(cause), &id);
                        world.write_message(fact);
                    }
                    if let Some(spec) = come {
                        let fact = create(world, Some(cause), *spec);
                        world.write_message(fact);
                    }
                }
            }
            SimCommand::Scene(SceneCommand::Load(_) | SceneCommand::Make { .. })
            | SimCommand::Hand(
                HandCommand::Select(_)
                | HandCommand::MoveTo { .. }
                | HandCommand::MoveBy { .. }
                | HandCommand::Turn { .. },
            )
            | SimCommand::Recording(_)
            | SimCommand::Clock(_)
            | SimCommand::History(_)
            | SimCommand::Mechanism(_)
            | SimCommand::Robot(_) => {}
        }
    }
    Ok(())
}

fn begin_segment(world: &mut World, cause: CommandId) {
    if world.resource::<Recording>().0 {
        let now = moment(world);
        let mut moments = world.resource_mut::<Moments>();
        moments.undoable.push(now);
        moments.redoable.clear();
    }
    world.write_message(SimFact::History(HistoryFact::SegmentBegun { cause }));
}

fn release(world: &mut World, cause: CommandId, hand: Hand) {
    if let Some(id) = held(world, hand) {
        begin_segment(world, cause);
        world.resource_mut::<Hands>().set_held(hand, None);
        world.write_message(SimFact::Hand(HandFact::Released {
            cause: Some(cause),
            hand,
            id,
        }));
    }
}

fn held(world: &World, hand: Hand) -> Option<String> {
    let object = world.resource::<Hands>().held_by(hand)?;
    Some(world.get::<ObjectSpec>(object)?.id.clone())
}

fn objects(world: &World) -> Vec<ObjectSpec> {
    let index = world.resource::<ObjectIndex>().iter();
    index
        .map(|object| world.get::<ObjectSpec>(object).unwrap().clone())
        .collect()
}

fn clear(world: &mut World, cause: CommandId) {
    for object in objects(world) {
        let fact = delete(world, Some(cause), &object.id);
        world.write_message(fact);
    }
}

fn create(world: &mut World, cause: Option<CommandId>, spec: ObjectSpec) -> SimFact {
    let id = spec.id.clone();
    let object = world.spawn(spec).id();
    world.resource_mut::<ObjectIndex>().insert(&id, object);
    SimFact::Scene(SceneFact::ObjectCreated { cause, id, object })
}

fn delete(world: &mut World, cause: Option<CommandId>, id: &str) -> SimFact {
    let object = world.resource_mut::<ObjectIndex>().remove(id);
    world.despawn(object.unwrap());
    SimFact::Scene(SceneFact::ObjectDeleted {
        cause,
        id: id.into(),
    })
}

fn moment(world: &World) -> Moment {
    Moment {
        tick: *world.resource::<SimTick>(),
        objects: objects(world),
        hands: Hand::ALL.map(|hand| held(world, hand)).to_vec(),
    }
}

/// Turns the world to a moment. Objects that come back or go cause no facts: nothing is reported while the world rolls back.
fn turn(world: &mut World, to: &Moment, fact: SimFact) {
    let now = objects(world);
    for spec in now.iter().filter(|spec| !to.objects.contains(spec)) {
        delete(world, None, &spec.id);
    }
    for spec in to.objects.iter().filter(|spec| !now.contains(spec)) {
        create(world, None, spec.clone());
    }
    for (hand, held) in Hand::ALL.into_iter().zip(&to.hands) {
        let index = world.resource::<ObjectIndex>();
        let held = held.as_ref().and_then(|id| index.get(id));
        world.resource_mut::<Hands>().set_held(hand, held);
    }
    *world.resource_mut::<SimTick>() = to.tick;
    world.write_message(fact);
}
