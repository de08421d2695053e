//! Reflection: the types of the simulation, for inspectors and scenes.

use bevy::prelude::*;
use tabletop_geometry::Twist;

use crate::{
    Agent, CarriesHeadCamera, Hands, HeadCamera, Held, History, Joint, Markers, ObjectIndex,
    ObjectSpec, Paused, Playback, Recording, Replaying, Robot, Rollback, SimBlocked, SimTick,
    Table,
};

/// Registers components and resources with all the types in them.
pub(crate) fn register(app: &mut App) {
    app.register_type::<Agent>()
        .register_type::<CarriesHeadCamera>()
        .register_type::<Hands>()
        .register_type::<HeadCamera>()
        .register_type::<Held>()
        .register_type::<History>()
        .register_type::<Joint>()
        .register_type::<Markers>()
        .register_type::<ObjectIndex>()
        .register_type::<ObjectSpec>()
        .register_type::<Paused>()
        .register_type::<Playback>()
        .register_type::<Recording>()
        .register_type::<Replaying>()
        .register_type::<Robot>()
        .register_type::<Rollback>()
        .register_type::<SimBlocked>()
        .register_type::<SimTick>()
        .register_type::<Table>()
        .register_type::<Twist>();
}

#[cfg(test)]
mod tests {
    use bevy::{prelude::*, reflect::TypeRegistry};
    use tabletop_geometry::{Pose, Rgb};

    use crate::{BondPoint, CorePlugin, Hands, MeshSpec, ObjectSpec, Shape, ToggleSwitch};

    #[test]
    fn objects_and_their_parts_are_registered() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()));
        let registry = app.world().resource::<AppTypeRegistry>().read();
        let registry: &TypeRegistry = &registry;
        assert!(
            registry
                .get_type_data::<ReflectComponent>(std::any::TypeId::of::<ObjectSpec>())
                .is_some()
        );
        assert!(
            registry
                .get_type_data::<ReflectResource>(std::any::TypeId::of::<Hands>())
                .is_some()
        );
        for part in [
            std::any::TypeId::of::<Shape>(),
            std::any::TypeId::of::<Pose>(),
            std::any::TypeId::of::<ToggleSwitch>(),
            std::any::TypeId::of::<BondPoint>(),
            std::any::TypeId::of::<MeshSpec>(),
        ] {
            assert!(registry.contains(part));
        }
    }

    #[test]
    fn an_inspector_can_change_the_sizes_of_a_shape() {
        let color = Rgb::GRAY;
        let ball = Shape::Sphere { radius: 1.0, color };
        let mut object = ObjectSpec::new("it", Pose::IDENTITY, 1.0, ball);
        let radius = object.path_mut::<f32>("shape.radius");
        *radius.unwrap_or_else(|error| panic!("{error}")) = 2.0;
        assert_eq!(object.shape, Shape::Sphere { radius: 2.0, color });
    }
}
