//! A headless world for tests.

use bevy::prelude::*;
use tabletop_core::{ChainSpec, LidBoxSpec, prelude::*};
use tabletop_geometry::quat_from_degrees;
use tabletop_physics::{PhysicsPlugin, PhysicsSettings};
use tabletop_scene::ScenePlugin;

pub const WHITE: Rgb = Rgb::WHITE;

pub struct TestWorld(pub App);

impl TestWorld {
    pub fn new(items: impl IntoIterator<Item = SceneItem>) -> Self {
        Self::with_settings(PhysicsSettings::default(), items)
    }

    pub fn with_settings(
        settings: PhysicsSettings,
        items: impl IntoIterator<Item = SceneItem>,
    ) -> Self {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            CorePlugin::default(),
            PhysicsPlugin { settings },
            ScenePlugin,
        ))
        .start();
        let scene = SceneSpec {
            items: items.into_iter().collect(),
            ..default()
        };
        app.world_mut()
            .write_command(SceneCommand::Set(Box::new(scene)));
        app.step(1);
        Self(app)
    }

    pub fn seconds(&mut self, seconds: f32) -> &mut Self {
        self.0.step((seconds * 60.0).round() as u64);
        self
    }

    pub fn entity(&self, id: &str) -> Entity {
        self.0
            .world()
            .resource::<ObjectIndex>()
            .get(id)
            .unwrap_or_else(|| panic!("no object {id}"))
    }

    pub fn pose(&self, id: &str) -> Pose {
        Pose::from(self.0.world().get::<Transform>(self.entity(id)).unwrap())
    }

    pub fn poses(&self) -> Vec<(String, Pose)> {
        let world = self.0.world();
        world
            .resource::<ObjectIndex>()
            .iter()
            .map(|object| {
                let id = world.get::<ObjectSpec>(object).unwrap().id.clone();
                (id.clone(), self.pose(&id))
            })
            .collect()
    }

    /// The greatest displacement and turn of any object in these seconds, in units and degrees.
    pub fn motion_in(&mut self, seconds: f32) -> (f32, f32) {
        let before = self.poses();
        self.seconds(seconds);
        let after = self.poses();
        assert_eq!(before.len(), after.len());
        before
            .iter()
            .zip(&after)
            .fold((0.0f32, 0.0f32), |(far, turn), ((_, a), (_, b))| {
                (
                    far.max(a.location.distance(b.location)),
                    turn.max(a.rotation.angle_between(b.rotation).to_degrees()),
                )
            })
    }

    pub fn remove(&mut self, id: &str) {
        let entity = self.entity(id);
        self.0.world_mut().despawn(entity);
    }
}

pub fn object(id: &str, location: impl Into<Vec3>, mass: f32, shape: Shape) -> SceneItem {
    turned(id, location, Vec3::ZERO, mass, shape)
}

pub fn turned(
    id: &str,
    location: impl Into<Vec3>,
    degrees: Vec3,
    mass: f32,
    shape: Shape,
) -> SceneItem {
    let pose = Pose::from_degrees(location.into(), degrees);
    SceneItem::Object(ObjectSpec::new(id, pose, mass, shape))
}

pub fn block(span: impl Into<Vec3>) -> Shape {
    Shape::Block {
        span: span.into(),
        color: WHITE,
    }
}

pub fn cylinder(radius: f32, yspan: f32) -> Shape {
    Shape::Cylinder {
        radius,
        yspan,
        color: WHITE,
    }
}

pub fn sphere(radius: f32) -> Shape {
    Shape::Sphere {
        radius,
        color: WHITE,
    }
}

pub fn open_box(span: impl Into<Vec3>, thickness: f32) -> Shape {
    Shape::Box {
        span: span.into(),
        thickness,
        color: WHITE,
    }
}

/// Unit blocks of 1 kg, one on the other.
pub fn tower(blocks: usize) -> Vec<SceneItem> {
    (0..blocks)
        .map(|i| {
            let location = Vec3::new(0.0, 0.0, i as f32 + 0.5);
            object(&format!("block{i}"), location, 1.0, block(Vec3::ONE))
        })
        .collect()
}

/// The chain of figure 16.
pub fn report_chain(link_count: u32) -> SceneItem {
    SceneItem::Chain(ChainSpec {
        id: "chain".into(),
        start: Vec3::new(6.0, -2.0, 4.0),
        end: Vec3::new(-6.0, -2.0, 4.0),
        link_span: Vec3::new(0.1, 1.0, 0.1),
        link_count,
        link_padding: 0.05,
        link_mass: 1.0,
        color: WHITE,
    })
}

/// The lid box of figure 17.
pub fn report_lidbox(location: Vec3, degrees: Vec3) -> SceneItem {
    SceneItem::LidBox(LidBoxSpec {
        id: "lidbox".into(),
        pose: Pose::new(location, quat_from_degrees(degrees)),
        span: Vec3::new(6.0, 5.0, 5.0),
        thickness: 0.6,
        box_mass: 9.0,
        lid_mass: 1.0,
        color: WHITE,
        handle_span: Vec3::new(1.0, 2.0, 0.6),
        handle_thickness: 0.2,
        handle_color: WHITE,
        descriptions: Vec::new(),
    })
}
