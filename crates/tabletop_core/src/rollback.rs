//! What undo and redo take back.

use bevy::prelude::*;

/// Marks an entity whose components undo and redo take back: objects, joints, the table, links of the robot.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct Rollback;

/// Puts the world back to what it was when this was made.
type Restore = Box<dyn Fn(&mut World) + Send + Sync>;

/// The resources that undo and redo take back.
#[derive(Resource, Clone, Debug, Default)]
pub struct RollbackRegistry(Vec<fn(&World) -> Restore>);

impl RollbackRegistry {
    /// Adds a resource.
    pub fn add<R: Resource + Clone>(&mut self) {
        self.0.push(|world| {
            let value = world.get_resource::<R>().cloned();
            Box::new(move |world| {
                if let Some(value) = &value {
                    world.insert_resource(value.clone());
                }
            })
        });
    }

    /// Remembers the resources as they are.
    pub fn remember(&self, world: &World) -> ResourceSnapshot {
        ResourceSnapshot(self.0.iter().map(|remember| remember(world)).collect())
    }
}

/// The resources as they were at a moment.
pub struct ResourceSnapshot(Vec<Restore>);

impl ResourceSnapshot {
    /// Puts them back.
    pub fn restore(&self, world: &mut World) {
        for restore in &self.0 {
            restore(world);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Resource, Clone)]
    struct Count(u32);

    #[test]
    fn a_resource_is_put_back() {
        let mut world = World::new();
        world.insert_resource(Count(1));
        let mut registry = RollbackRegistry::default();
        registry.add::<Count>();
        let before = registry.remember(&world);
        world.resource_mut::<Count>().0 = 2;
        before.restore(&mut world);
        assert_eq!(world.resource::<Count>().0, 1);
    }
}
