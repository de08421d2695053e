//! A table for testing hands.

use bevy::prelude::*;
use bevy_rapier3d::prelude::Velocity;
use tabletop_core::prelude::*;
use tabletop_demonstrator::DemonstratorPlugin;
use tabletop_history::HistoryPlugin;
use tabletop_physics::PhysicsPlugin;
use tabletop_scene::ScenePlugin;

/// A table with objects at rest, and the facts so far.
pub struct Desk(pub App);

#[derive(Resource, Default)]
struct Heard(Vec<SimFact>);

fn hear(mut heard: ResMut<Heard>, mut facts: MessageReader<SimFact>) {
    heard.0.extend(facts.read().cloned());
}

impl Desk {
    pub fn new(items: Vec<SceneItem>) -> Self {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            CorePlugin::default(),
            HistoryPlugin::default(),
            PhysicsPlugin::default(),
            ScenePlugin,
            DemonstratorPlugin,
        ))
        .init_resource::<Heard>()
        .add_systems(FixedUpdate, hear.in_set(SimSystems::Record))
        .start();
        let scene = SceneSpec { items, ..default() };
        app.world_mut()
            .write_command(SceneCommand::Set(Box::new(scene)));
        app.step(60);
        app.world_mut().resource_mut::<Heard>().0.clear();
        Self(app)
    }

    pub fn tell(&mut self, command: impl Into<SimCommand>) -> &mut Self {
        self.0.world_mut().write_command(command);
        self
    }

    pub fn grasp(&mut self, hand: Hand, object: &str) -> &mut Self {
        self.tell(HandCommand::Grasp {
            hand,
            object: object.into(),
        })
    }

    pub fn move_to(&mut self, hand: Hand, location: Vec3) -> &mut Self {
        self.tell(HandCommand::MoveTo { hand, location })
    }

    pub fn step(&mut self, ticks: u64) -> &mut Self {
        self.0.step(ticks);
        self
    }

    pub fn entity(&self, id: &str) -> Entity {
        self.0.world().resource::<ObjectIndex>().get(id).unwrap()
    }

    pub fn pose(&self, id: &str) -> Pose {
        Pose::from(self.0.world().get::<Transform>(self.entity(id)).unwrap())
    }

    pub fn speed(&self, id: &str) -> f32 {
        let velocity = self.0.world().get::<Velocity>(self.entity(id)).unwrap();
        velocity.linear.length()
    }

    pub fn heard(&mut self) -> Vec<String> {
        let facts = std::mem::take(&mut self.0.world_mut().resource_mut::<Heard>().0);
        facts.iter().map(line).collect()
    }
}

#[expect(clippy::wildcard_enum_match_arm, reason = "other facts are of no hand")]
fn line(fact: &SimFact) -> String {
    match fact {
        SimFact::History(HistoryFact::SegmentBegun { .. }) => "segment".into(),
        SimFact::History(HistoryFact::Kept { .. }) => "kept".into(),
        SimFact::Hand(HandFact::Grasped { hand, id, .. }) => format!("{hand} grasps {id}"),
        SimFact::Hand(HandFact::Released { hand, id, .. }) => format!("{hand} releases {id}"),
        SimFact::Hand(HandFact::Destroyed { hand, id, .. }) => format!("{hand} destroys {id}"),
        SimFact::Scene(SceneFact::ObjectDeleted { id, .. }) => format!("{id} is gone"),
        SimFact::Refused { reason, .. } => format!("refused: {reason}"),
        other => format!("{other:?}"),
    }
}

pub fn object(id: &str, location: (f32, f32, f32), mass: f32, shape: Shape) -> SceneItem {
    SceneItem::Object(ObjectSpec::new(id, Pose::at(location.into()), mass, shape))
}

pub fn block(span: impl Into<Vec3>) -> Shape {
    Shape::Block {
        span: span.into(),
        color: Rgb::GRAY,
    }
}

pub fn two_blocks() -> Vec<SceneItem> {
    vec![
        object("red", (2.0, 0.0, 0.5), 1.0, block(Vec3::ONE)),
        object("green", (-2.0, 0.0, 0.5), 1.0, block(Vec3::ONE)),
    ]
}
