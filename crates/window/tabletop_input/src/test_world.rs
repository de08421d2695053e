//! A table without a window, for tests: the cursor is a line of sight, commands are read back.

use bevy::{prelude::*, time::TimeUpdateStrategy};
use tabletop_core::{
    CorePlugin, Hands, IssuedCommand, ObjectIndex, ObjectSpec, Shape, SimCommand, Table,
};
use tabletop_geometry::{Pose, Rgb};
use tabletop_user::{UserCamera, UserPlugin};

use crate::{Buttons, Pointer};

/// Location of the user's camera, which looks along Y.
pub(crate) const EYE: Vec3 = Vec3::new(0.0, -12.0, 8.0);

/// The line of sight to a point.
pub(crate) fn towards(point: Vec3) -> Ray3d {
    Ray3d::new(EYE, Dir3::new(point - EYE).expect("it is not at the eye"))
}

pub(crate) struct TestWorld {
    pub app: App,
}

impl TestWorld {
    pub fn new(plugin: impl Plugin) -> Self {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .init_resource::<ButtonInput<KeyCode>>()
            .init_resource::<Buttons>();
        app.world_mut().spawn(Table::default());
        app.world_mut().spawn((
            UserCamera,
            Transform::from_translation(EYE).looking_to(Vec3::Y, Vec3::Z),
        ));
        app.finish();
        app.cleanup();
        app.update();
        Self { app }
    }

    /// Puts a block of edge 2 somewhere.
    pub fn block(&mut self, id: &str, location: Vec3) -> Entity {
        block(self.app.world_mut(), id, location)
    }

    /// Puts a block into the selected hand.
    pub fn hold(&mut self, id: &str, location: Vec3) -> Entity {
        let object = self.block(id, location);
        let mut hands = self.app.world_mut().resource_mut::<Hands>();
        let hand = hands.selected;
        hands.set_held(hand, Some(object));
        object
    }

    pub fn let_go(&mut self) {
        let mut hands = self.app.world_mut().resource_mut::<Hands>();
        let hand = hands.selected;
        hands.set_held(hand, None);
    }

    pub fn held(&self) -> Option<Entity> {
        let hands = self.app.world().resource::<Hands>();
        hands.held_by(hands.selected)
    }

    pub fn look_along(&mut self, ray: Ray3d) {
        self.app.insert_resource(Pointer {
            ray: Some(ray),
            ..default()
        });
    }

    pub fn point_at(&mut self, point: Vec3) {
        self.look_along(towards(point));
    }

    /// Puts a panel in front of the thing under the cursor.
    pub fn point_at_panel(&mut self) {
        self.app.world_mut().resource_mut::<Pointer>().is_panels = true;
    }

    pub fn point_nowhere(&mut self) {
        self.app.insert_resource(Pointer::default());
    }

    /// A frame in which the button goes down; returns its commands.
    pub fn press(&mut self) -> Vec<SimCommand> {
        self.buttons().press(MouseButton::Left);
        self.frame()
    }

    /// A frame in which the button comes up.
    pub fn come_up(&mut self) -> Vec<SimCommand> {
        self.buttons().release(MouseButton::Left);
        self.frame()
    }

    /// A frame in which no button changes.
    pub fn hold_still(&mut self) -> Vec<SimCommand> {
        self.frame()
    }

    pub fn keys(&mut self) -> Mut<'_, ButtonInput<KeyCode>> {
        self.app.world_mut().resource_mut()
    }

    fn buttons(&mut self) -> Mut<'_, Buttons> {
        self.app.world_mut().resource_mut()
    }

    fn frame(&mut self) -> Vec<SimCommand> {
        self.app
            .world_mut()
            .resource_mut::<Messages<IssuedCommand>>()
            .clear();
        self.app.update();
        self.buttons().clear();
        self.keys().clear();
        let messages = self.app.world().resource::<Messages<IssuedCommand>>();
        let issued = messages.iter_current_update_messages();
        issued.map(|issued| issued.command.clone()).collect()
    }
}

/// Puts a block of edge 2 somewhere in a world.
pub fn block(world: &mut World, id: &str, location: Vec3) -> Entity {
    let shape = Shape::Block {
        span: Vec3::splat(2.0),
        color: Rgb::GRAY,
    };
    let spec = ObjectSpec::new(id, Pose::at(location), 1.0, shape);
    let place = Transform::from_translation(location);
    let object = world.spawn((spec, place)).id();
    world.resource_mut::<ObjectIndex>().insert(id, object);
    object
}
