//! Lines are drawn in frames, never in ticks. Bevy's systems for those of ticks would make every tick run, even at rest.

use bevy::{
    app::FixedLast,
    ecs::schedule::ScheduleCleanupPolicy,
    gizmos::{
        aabb::AabbGizmoConfigGroup, clear_gizmo_context, collect_requested_gizmos,
        frustum::FrustumGizmoConfigGroup, skinned_mesh_bounds::SkinnedMeshBoundsGizmoConfigGroup,
    },
    light::gizmos::LightGizmoConfigGroup,
    prelude::*,
};

use crate::{
    aids::{ThickLines, ThinLines},
    ghosts::GhostLines,
    measured::MeasuredLines,
};

/// To be called when all plugins have added their lines.
pub(crate) fn finish(app: &mut App) {
    draw_none_in_ticks::<ThinLines>(app);
    draw_none_in_ticks::<ThickLines>(app);
    draw_none_in_ticks::<GhostLines>(app);
    draw_none_in_ticks::<MeasuredLines>(app);
    draw_none_in_ticks::<DefaultGizmoConfigGroup>(app);
    draw_none_in_ticks::<AabbGizmoConfigGroup>(app);
    draw_none_in_ticks::<FrustumGizmoConfigGroup>(app);
    draw_none_in_ticks::<SkinnedMeshBoundsGizmoConfigGroup>(app);
    draw_none_in_ticks::<LightGizmoConfigGroup>(app);
}

fn draw_none_in_ticks<G: GizmoConfigGroup>(app: &mut App) {
    let policy = ScheduleCleanupPolicy::RemoveSetAndSystems;
    // Where they are missing, there is nothing to remove.
    drop(app.remove_systems_in_set(FixedFirst, clear_gizmo_context::<G, Fixed>, policy));
    drop(app.remove_systems_in_set(FixedLast, collect_requested_gizmos::<G, Fixed>, policy));
}

#[cfg(test)]
mod tests {
    use bevy::gizmos::AppGizmoBuilder as _;
    use tabletop_core::{CorePlugin, RestingSystems, StepApp as _};

    use super::*;

    #[derive(Resource, Default)]
    struct Ticks(u64);

    #[test]
    fn lines_keep_no_world_from_resting() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .init_resource::<Ticks>()
            .init_gizmo_group::<ThinLines>()
            .init_gizmo_group::<DefaultGizmoConfigGroup>()
            .add_systems(
                FixedUpdate,
                (|mut ticks: ResMut<Ticks>| ticks.0 += 1).in_set(RestingSystems),
            );
        finish(&mut app);
        app.start().step(1000);
        let ticks = app.world().resource::<Ticks>().0;
        assert!(ticks < 100, "{ticks} ticks have been run");
    }
}
