//! The world as cameras see it.

use std::sync::Arc;

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{CarriesHeadCamera, Figure, Markers, ObjectIndex, ObjectSpec, Table};
use tabletop_geometry::Primitive;

use crate::{DrawnFigure, DrawnSolid, Facets, Scene, scene::facets_of};

/// The drawn solids of an object, in its own frame, computed once.
#[derive(Component, Debug)]
#[component(immutable)]
pub(crate) struct ObjectSolids(Vec<Primitive>);

/// A figure, prepared for drawing.
#[derive(Component, Clone, Debug)]
#[component(immutable)]
pub(crate) struct DrawnFacets {
    facets: Arc<Facets>,
    /// Number of figures before it.
    order: u64,
}

/// The number of figures so far.
#[derive(Resource, Debug, Default)]
pub(crate) struct FigureCount(u64);

/// The present world as cameras see it, for systems that draw pictures of their own with a [`Rasterizer`](crate::Rasterizer).
#[derive(SystemParam)]
pub struct VisibleWorld<'w, 's> {
    index: Res<'w, ObjectIndex>,
    tables: Query<'w, 's, (Entity, &'static Table)>,
    objects: Query<'w, 's, (&'static Transform, &'static ObjectSolids), With<ObjectSpec>>,
    figures: Query<
        'w,
        's,
        (
            Entity,
            &'static GlobalTransform,
            &'static DrawnFacets,
            Has<CarriesHeadCamera>,
        ),
    >,
    markers: Res<'w, Markers>,
}

/// The figures that a camera sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FiguresSeen {
    /// All but those that carry the head camera.
    FromHead,
    /// All.
    FromElsewhere,
}

/// Computes the drawn solids of an object when it appears or changes.
pub(crate) fn prepare_object(
    insert: On<Insert, ObjectSpec>,
    objects: Query<&ObjectSpec>,
    mut commands: Commands,
) -> Result {
    let solids = ObjectSolids(objects.get(insert.entity)?.shape.drawn());
    commands.entity(insert.entity).try_insert(solids);
    Ok(())
}

/// Prepares a figure when it appears or changes.
pub(crate) fn prepare_figure(
    insert: On<Insert, Figure>,
    figures: Query<(&Figure, Option<&DrawnFacets>)>,
    mut count: ResMut<FigureCount>,
    mut commands: Commands,
) -> Result {
    let (figure, before) = figures.get(insert.entity)?;
    let order = before.map_or(count.0, |drawn| drawn.order);
    count.0 = count.0.max(order + 1);
    let facets = facets_of(&figure.coarse);
    commands
        .entity(insert.entity)
        .try_insert(DrawnFacets { facets, order });
    Ok(())
}

/// Stops drawing an entity that is no longer a figure.
pub(crate) fn remove_figure(remove: On<Remove, Figure>, mut commands: Commands) {
    commands.entity(remove.entity).try_remove::<DrawnFacets>();
}

impl VisibleWorld<'_, '_> {
    /// The table, or the usual one if there is none.
    pub fn table(&self) -> Table {
        let table = self.tables.iter().next();
        table.map_or_else(Table::default, |(_, table)| *table)
    }

    /// Replaces a scene by everything that is there. `shown` has the entities behind its numbers, from 1.
    pub fn draw(&self, seen: FiguresSeen, scene: &mut Scene, shown: &mut Vec<Entity>) {
        scene.solids.clear();
        scene.figures.clear();
        shown.clear();
        if let Some((entity, table)) = self.tables.iter().next() {
            shown.push(entity);
            scene
                .solids
                .push(DrawnSolid::of_table(table, shown.len() as u32));
        }
        for entity in self.index.iter() {
            if let Ok((place, ObjectSolids(primitives))) = self.objects.get(entity) {
                shown.push(entity);
                let number = shown.len() as u32;
                let solids = primitives.iter();
                scene
                    .solids
                    .extend(solids.map(|solid| DrawnSolid::of(place.into(), solid, number)));
            }
        }
        let figures = self.figures.iter();
        let mut in_order: Vec<_> = figures
            .filter(|(.., is_head)| !is_head || seen == FiguresSeen::FromElsewhere)
            .collect();
        in_order.sort_by_key(|(_, _, drawn, _)| drawn.order);
        for (entity, place, drawn, _) in in_order {
            shown.push(entity);
            scene.figures.push(DrawnFigure {
                pose: (&place.compute_transform()).into(),
                facets: Arc::clone(&drawn.facets),
                object: shown.len() as u32,
            });
        }
        scene.markers.clone_from(&self.markers.0);
    }
}
