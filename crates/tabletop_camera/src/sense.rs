//! Taking the picture of a tick.

use bevy::prelude::*;
use tabletop_core::{
    HeadCamera, ObjectIndex, ObjectSpec, PictureDemand, Primitive, SensorImage, SimTick, Table,
};

use crate::{Camera, DrawnSolid, Painter};

/// The solids that an object is drawn as, in its own frame: they are worked out once.
#[derive(Component, Debug)]
#[component(immutable)]
pub(crate) struct Looks(Vec<Primitive>);

/// What is kept from picture to picture.
#[derive(Resource, Debug, Default)]
pub(crate) struct Eye {
    painter: Painter,
    scene: Vec<DrawnSolid>,
}

/// Works out what an object looks like as soon as it appears or becomes another.
pub(crate) fn note_looks(
    insert: On<Insert, ObjectSpec>,
    objects: Query<&ObjectSpec>,
    mut commands: Commands,
) -> Result {
    let looks = Looks(objects.get(insert.entity)?.shape.drawn());
    commands.entity(insert.entity).try_insert(looks);
    Ok(())
}

/// Draws what the head camera sees at this moment, if a picture was asked for.
pub(crate) fn take_picture(
    mut demand: ResMut<PictureDemand>,
    tick: Res<SimTick>,
    head: Res<HeadCamera>,
    index: Res<ObjectIndex>,
    tables: Query<(Entity, &Table)>,
    objects: Query<(&Transform, &Looks), With<ObjectSpec>>,
    mut eye: ResMut<Eye>,
    mut image: ResMut<SensorImage>,
) {
    if !demand.take() {
        return;
    }
    let Eye { painter, scene } = &mut *eye;
    let SensorImage { picture, shown, .. } = &mut *image;
    scene.clear();
    shown.clear();
    let table = tables.iter().next();
    if let Some((entity, table)) = table {
        shown.push(entity);
        scene.push(DrawnSolid::of_table(table, shown.len() as u32));
    }
    for entity in index.iter() {
        if let Ok((place, looks)) = objects.get(entity) {
            shown.push(entity);
            let number = shown.len() as u32;
            let solids = looks.0.iter();
            scene.extend(solids.map(|solid| DrawnSolid::of(place.into(), solid, number)));
        }
    }
    let table = table.map_or_else(Table::default, |(_, table)| *table);
    let camera = Camera::of_head(&head, &table);
    painter.draw(scene.iter().copied(), &camera, picture);
    image.tick = *tick;
}
