//! Taking the picture of a tick.

use std::sync::Arc;

use bevy::prelude::*;
use tabletop_core::{
    CarriesHeadCamera, Figure, HeadCamera, Markers, ObjectIndex, ObjectSpec, PictureDemand,
    Primitive, SensorImage, SimTick, Table,
};

use crate::{Camera, DrawnFigure, DrawnSolid, Facets, Rasterizer, Scene};

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

/// Memory kept from picture to picture.
#[derive(Resource, Debug, Default)]
pub(crate) struct HeadCameraRenderer {
    rasterizer: Rasterizer,
    scene: Scene,
    /// Number of figures so far.
    figures: u64,
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
    mut renderer: ResMut<HeadCameraRenderer>,
    mut commands: Commands,
) -> Result {
    let (figure, before) = figures.get(insert.entity)?;
    let order = before.map_or(renderer.figures, |drawn| drawn.order);
    renderer.figures = renderer.figures.max(order + 1);
    let facets = Facets::from(&*figure.coarse).into();
    commands
        .entity(insert.entity)
        .try_insert(DrawnFacets { facets, order });
    Ok(())
}

/// Stops drawing what is no longer a figure.
pub(crate) fn remove_figure(remove: On<Remove, Figure>, mut commands: Commands) {
    commands.entity(remove.entity).try_remove::<DrawnFacets>();
}

/// Draws the present view of the head camera, if a picture was asked for.
pub(crate) fn render_head_camera(
    mut demand: ResMut<PictureDemand>,
    tick: Res<SimTick>,
    head: Res<HeadCamera>,
    index: Res<ObjectIndex>,
    tables: Query<(Entity, &Table)>,
    objects: Query<(&Transform, &ObjectSolids), With<ObjectSpec>>,
    figures: Query<(Entity, &GlobalTransform, &DrawnFacets), Without<CarriesHeadCamera>>,
    markers: Res<Markers>,
    mut renderer: ResMut<HeadCameraRenderer>,
    mut image: ResMut<SensorImage>,
) {
    if !demand.take() {
        return;
    }
    let HeadCameraRenderer {
        rasterizer, scene, ..
    } = &mut *renderer;
    let SensorImage { picture, shown, .. } = &mut *image;
    scene.solids.clear();
    scene.figures.clear();
    shown.clear();
    let table = tables.iter().next();
    if let Some((entity, table)) = table {
        shown.push(entity);
        scene
            .solids
            .push(DrawnSolid::of_table(table, shown.len() as u32));
    }
    for entity in index.iter() {
        if let Ok((place, ObjectSolids(primitives))) = objects.get(entity) {
            shown.push(entity);
            let number = shown.len() as u32;
            let solids = primitives.iter();
            scene
                .solids
                .extend(solids.map(|solid| DrawnSolid::of(place.into(), solid, number)));
        }
    }
    let mut in_order: Vec<_> = figures.iter().collect();
    in_order.sort_by_key(|(_, _, drawn)| drawn.order);
    for (entity, place, drawn) in in_order {
        shown.push(entity);
        scene.figures.push(DrawnFigure {
            pose: (&place.compute_transform()).into(),
            facets: Arc::clone(&drawn.facets),
            object: shown.len() as u32,
        });
    }
    scene.markers.clone_from(&markers.0);
    let table = table.map_or_else(Table::default, |(_, table)| *table);
    let camera = Camera::of_head(&head, &table);
    rasterizer.draw(scene, &camera, picture);
    image.tick = *tick;
}
