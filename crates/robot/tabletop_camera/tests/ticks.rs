//! Pictures of ticks: when they are taken, and that they show their tick however the app runs.

use std::time::Duration;

use bevy::{prelude::*, time::TimeUpdateStrategy};
use tabletop_camera::{Camera, CameraPlugin, DrawnFigure, DrawnSolid, Facets, Rasterizer, Scene};
use tabletop_core::{Figure, HeadCamera, Markers, Picture, PictureDemand, SensorImage, prelude::*};
use tabletop_geometry::Triangles;

/// Every object moves this far along X in a tick.
const STEP: f32 = 0.125;

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, CorePlugin::default(), CameraPlugin))
        .init_resource::<Seen>()
        .add_systems(
            FixedUpdate,
            (
                ask_every_fourth_tick.in_set(SimSystems::Ingest),
                move_objects.in_set(SimSystems::Physics),
                keep_new_pictures.in_set(SimSystems::Record),
            ),
        );
    app
}

fn ask_every_fourth_tick(tick: Res<SimTick>, demand: Res<PictureDemand>) {
    if tick.0 % 4 == 2 {
        demand.ask();
    }
}

fn move_objects(mut objects: Query<&mut Transform, With<ObjectSpec>>) {
    for mut place in &mut objects {
        place.translation.x += STEP;
    }
}

/// The pictures that came, each with the tick of its arrival.
#[derive(Resource, Default)]
struct Seen(Vec<(u64, SensorImage)>);

fn keep_new_pictures(tick: Res<SimTick>, image: Res<SensorImage>, mut seen: ResMut<Seen>) {
    if image.is_changed() && image.picture.width > 0 {
        seen.0.push((tick.0, image.clone()));
    }
}

fn block(id: &str, location: Vec3, shape: Shape) -> ObjectSpec {
    ObjectSpec {
        id: id.into(),
        pose: Pose::at(location),
        mass: 1.0,
        shape,
        dynamics: Default::default(),
        descriptions: Vec::new(),
    }
}

fn red_cube() -> Shape {
    Shape::Block {
        span: Vec3::ONE,
        color: Rgb::new(1.0, 0.0, 0.0),
    }
}

fn put(world: &mut World, spec: ObjectSpec) -> Entity {
    let id = spec.id.clone();
    let object = world.spawn((Transform::from(spec.pose), spec)).id();
    world.resource_mut::<ObjectIndex>().insert(id, object);
    object
}

fn put_table_and_cube(app: &mut App) -> [Entity; 2] {
    let world = app.world_mut();
    let table = world.spawn(Table::default()).id();
    [
        table,
        put(world, block("cube", Vec3::new(-1.0, 0.0, 0.5), red_cube())),
    ]
}

fn pictures(app: &App) -> &[(u64, SensorImage)] {
    &app.world().resource::<Seen>().0
}

fn expected(solids: &[DrawnSolid], table: &Table) -> Picture {
    let scene = Scene {
        solids: solids.to_vec(),
        ..default()
    };
    expected_of(&scene, table)
}

fn expected_of(scene: &Scene, table: &Table) -> Picture {
    let camera = Camera::of_head(&HeadCamera::default(), table);
    let mut picture = Picture::default();
    Rasterizer::default().draw(scene, &camera, &mut picture);
    picture
}

fn with_cube_at(location: Vec3, table: &Table) -> Picture {
    let cube = &red_cube().drawn()[0];
    let solids = [
        DrawnSolid::of_table(table, 1),
        DrawnSolid::of(Pose::at(location), cube, 2),
    ];
    expected(&solids, table)
}

#[test]
fn a_picture_is_taken_only_when_asked_for_and_shows_the_end_of_its_tick() {
    let mut app = app();
    app.start();
    let shown = put_table_and_cube(&mut app);
    app.step(13);
    let pictures = pictures(&app);
    let ticks: Vec<_> = pictures
        .iter()
        .map(|(tick, image)| (*tick, image.tick.0))
        .collect();
    assert_eq!(ticks, [(2, 2), (6, 6), (10, 10)]);
    for (tick, image) in pictures {
        let location = Vec3::new(-1.0 + STEP * (tick + 1) as f32, 0.0, 0.5);
        assert!(
            image.picture == with_cube_at(location, &Table::default()),
            "tick {tick}"
        );
        assert_eq!(image.shown, shown);
    }
}

#[test]
fn frames_of_three_ticks_take_the_same_pictures_as_stepping() {
    let mut stepped = app();
    stepped.start();
    put_table_and_cube(&mut stepped);
    stepped.step(24);

    let mut framed = app();
    framed.finish();
    framed.cleanup();
    framed.insert_resource(TimeUpdateStrategy::FixedTimesteps(3));
    let mut clock = framed.world_mut().resource_mut::<Time<Virtual>>();
    clock.set_max_delta(Duration::from_secs(1));
    put_table_and_cube(&mut framed);
    for _ in 0..9 {
        framed.update();
    }
    assert_eq!(framed.world().resource::<SimTick>().0, 24);
    assert_eq!(pictures(&stepped).len(), 6);
    assert!(pictures(&stepped) == pictures(&framed));
}

#[test]
fn the_camera_is_mounted_at_the_table_that_is_there() {
    let mut app = app();
    app.start();
    let [table, _] = put_table_and_cube(&mut app);
    app.step(3);
    app.world_mut().despawn(table);
    let large = Table {
        xspan: 16.0,
        yspan: 20.0,
    };
    app.world_mut().spawn(large);
    app.step(4);
    let (tick, image) = &pictures(&app)[1];
    assert_eq!(*tick, 6);
    let location = Vec3::new(-1.0 + STEP * 7.0, 0.0, 0.5);
    assert!(image.picture == with_cube_at(location, &large));
}

#[test]
fn an_object_that_becomes_another_or_goes_is_drawn_so() {
    let mut app = app();
    app.start();
    let [_, cube] = put_table_and_cube(&mut app);
    app.step(3);
    let ball = Shape::Sphere {
        radius: 0.7,
        color: Rgb::GRAY,
    };
    let ball_there = block("cube", Vec3::ZERO, ball.clone());
    app.world_mut().entity_mut(cube).insert(ball_there);
    app.step(4);
    app.world_mut().resource_mut::<ObjectIndex>().remove("cube");
    app.world_mut().despawn(cube);
    app.step(4);
    let [_, (_, with_ball), (_, without)] = pictures(&app) else {
        panic!("{} pictures", pictures(&app).len());
    };
    let table = Table::default();
    let location = Vec3::new(-1.0 + STEP * 7.0, 0.0, 0.5);
    let empty = DrawnSolid::of_table(&table, 1);
    let drawn = DrawnSolid::of(Pose::at(location), &ball.drawn()[0], 2);
    assert!(with_ball.picture == expected(&[empty.clone(), drawn], &table));
    assert!(without.picture == expected(&[empty], &table));
    assert_eq!(without.shown.len(), 1);
}

#[test]
fn numbers_follow_the_order_of_creation() {
    let mut app = app();
    app.start();
    let world = app.world_mut();
    let gone = world.spawn_empty().id();
    let first = put(world, block("z", Vec3::new(-3.0, 0.0, 0.5), red_cube()));
    let table = world.spawn(Table::default()).id();
    world.despawn(gone);
    let second = put(world, block("a", Vec3::new(2.0, 0.0, 0.5), red_cube()));
    app.step(3);
    let image = app.world().resource::<SensorImage>();
    assert_eq!(image.shown, [table, first, second]);
    let camera = Camera::of_head(&HeadCamera::default(), &Table::default());
    for object in [first, second] {
        let place = app.world().get::<Transform>(object).unwrap().translation;
        let pixel = camera.pixel_of(place).unwrap().round();
        assert_eq!(image.shown_at(pixel.x as u32, pixel.y as u32), Some(object));
    }
    assert_eq!(image.shown_at(100, 120), Some(table));
    assert_eq!(image.shown_at(0, 0), None);
}

#[test]
fn a_demand_waits_for_the_end_of_a_pause() {
    let mut app = app();
    app.start();
    put_table_and_cube(&mut app);
    app.insert_resource(Paused(true));
    app.world().resource::<PictureDemand>().ask();
    app.step(5);
    assert_eq!(
        app.world().resource::<SensorImage>().picture,
        Picture::default()
    );
    app.insert_resource(Paused(false));
    app.step(1);
    assert_eq!(app.world().resource::<SensorImage>().picture.width, 200);
}

#[test]
fn a_demand_that_is_insisted_on_is_met_in_a_pause() {
    let mut app = app();
    app.start();
    put_table_and_cube(&mut app);
    app.insert_resource(Paused(true));
    app.world().resource::<PictureDemand>().insist();
    app.step(1);
    let picture = |app: &mut App| {
        let mut image = app.world_mut().resource_mut::<SensorImage>();
        std::mem::take(&mut image.picture)
    };
    assert_eq!(picture(&mut app).width, 200);
    app.world().resource::<PictureDemand>().ask();
    app.step(1);
    assert_eq!(picture(&mut app).width, 0, "that demand waits again");
}

fn plate(size: f32) -> Triangles {
    Triangles {
        positions: vec![Vec3::ZERO, Vec3::X * size, Vec3::Y * size],
        normals: vec![Vec3::Z; 3],
        colors: vec![Rgb::new(0.0, 0.0, 1.0); 3],
        indices: vec![[0, 1, 2]],
    }
}

fn figure(size: f32) -> Figure {
    Figure {
        fine: Triangles::default().into(),
        coarse: plate(size).into(),
    }
}

#[test]
fn figures_are_seen_where_their_global_transforms_are_in_the_order_of_their_creation() {
    let mut app = app();
    app.add_plugins(TransformPlugin).start();
    let world = app.world_mut();
    let table = world.spawn(Table::default()).id();
    let turned = Transform::from_xyz(1.0, 0.0, 2.0).with_rotation(Quat::from_rotation_z(0.5));
    let arm = world.spawn(turned).id();
    let first = world
        .spawn((
            Transform::from_xyz(0.0, 1.0, 0.0),
            ChildOf(arm),
            figure(2.0),
        ))
        .id();
    let second = world
        .spawn((Transform::from_xyz(-4.0, 0.0, 1.0), figure(1.0)))
        .id();
    world
        .resource_mut::<Markers>()
        .0
        .push(Vec3::new(3.0, 3.0, 1.0));
    let drawn = |size: f32, place: Transform, object| DrawnFigure {
        pose: (&place).into(),
        facets: Facets::from(&plate(size)).into(),
        object,
    };
    let place_of_first = turned * Transform::from_xyz(0.0, 1.0, 0.0);
    let scene = |size| Scene {
        solids: vec![DrawnSolid::of_table(&Table::default(), 1)],
        figures: vec![
            drawn(size, place_of_first, 2),
            drawn(1.0, Transform::from_xyz(-4.0, 0.0, 1.0), 3),
        ],
        markers: vec![Vec3::new(3.0, 3.0, 1.0)],
    };
    app.update();
    app.step(3);
    let image = app.world().resource::<SensorImage>();
    assert_eq!(image.shown, [table, first, second]);
    assert!(image.picture == expected_of(&scene(2.0), &Table::default()));
    assert!(image.picture.objects.contains(&3));

    // A figure that changes keeps its place.
    app.world_mut().entity_mut(first).insert(figure(3.0));
    app.step(4);
    let image = app.world().resource::<SensorImage>();
    assert_eq!(image.shown, [table, first, second]);
    assert!(image.picture == expected_of(&scene(3.0), &Table::default()));

    app.world_mut().entity_mut(first).remove::<Figure>();
    app.world_mut().despawn(second);
    app.step(4);
    assert_eq!(app.world().resource::<SensorImage>().shown, [table]);
}
