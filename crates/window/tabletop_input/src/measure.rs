//! The left mouse button while the user measures: it sets points on what is seen.

use bevy::prelude::*;
use tabletop_user::Measuring;

use crate::{
    pick::Pickable,
    pointer::{Buttons, MouseSystems, Pointer},
};

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Pointer>().add_systems(
        RunFixedMainLoop,
        set_point
            .in_set(MouseSystems)
            .run_if(|measuring: Res<Measuring>| measuring.is_on),
    );
}

fn set_point(
    buttons: Res<Buttons>,
    pointer: Res<Pointer>,
    pickable: Pickable,
    mut measuring: ResMut<Measuring>,
) {
    if !buttons.just_pressed(MouseButton::Left) || pointer.is_panels {
        return;
    }
    if let Some(point) = pointer.ray.and_then(|ray| pickable.surface_along(ray)) {
        measuring.add(point);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{mouse, test_world::TestWorld};

    #[test]
    fn clicks_set_points_and_take_nothing_while_the_user_measures() {
        let mut test = TestWorld::new(|app: &mut App| {
            app.add_plugins((mouse::plugin, plugin));
        });
        test.block("red", Vec3::Z);
        let corner = Vec3::new(5.0, 3.0, 0.0);
        let click = |test: &mut TestWorld, at: Vec3| {
            test.point_at(at);
            [test.press(), test.come_up()].concat()
        };
        test.app.world_mut().resource_mut::<Measuring>().switch();
        assert_eq!(click(&mut test, Vec3::Z), []);
        assert_eq!(click(&mut test, corner), []);
        let measuring = test.app.world().resource::<Measuring>();
        let [on_block, on_table] = measuring.points()[..] else {
            panic!("{measuring:?}");
        };
        assert!((on_block.y + 1.0).abs() < 1e-4, "{on_block}");
        assert!(on_table.distance(corner) < 1e-4, "{on_table}");
        test.app.world_mut().resource_mut::<Measuring>().switch();
        assert_eq!(click(&mut test, Vec3::Z).len(), 1);
    }
}
