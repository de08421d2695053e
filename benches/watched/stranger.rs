//! Recordings in whose pictures something stands that nobody has told of, in the colour of an object that is.

use bevy::math::{Quat, Vec2, Vec3, Vec3Swizzles as _};
use tabletop::{
    camera::{Camera, DrawnSolid, Rasterizer, Scene},
    core::{ObjectSpec, Picture, Random, Shape, SimTick, Table},
    geometry::Pose,
    recorder::{RecordingReader, StateRow},
};

/// The least distance of the stranger from the middle of anything else, in units.
const APART: f32 = 1.8;
/// Its extents, in units.
const EXTENTS: (f32, f32) = (0.6, 1.6);
/// By how much it differs from the object in one extent at least, in units.
const UNLIKE: f32 = 0.2;
/// Number of places among which a free one in the picture is looked for.
const DRAWS: usize = 10_000;

/// A recording with a stranger in its pictures.
pub struct WithStranger {
    camera: Camera,
    table: Table,
    objects: Vec<ObjectSpec>,
    states: Vec<StateRow>,
    stranger: ObjectSpec,
}

/// A recording with a stranger that this seed decides.
pub fn with_stranger(recording: &RecordingReader, seed: u64) -> WithStranger {
    let scene = &recording.session().scene;
    let table = scene.table.unwrap_or_default();
    let head = recording.header().camera.unwrap_or_default();
    let camera = Camera::of_head(&head, &table);
    let objects: Vec<_> = scene
        .objects
        .iter()
        .map(|object| ObjectSpec {
            pose: object.pose,
            ..object.spec.clone()
        })
        .collect();
    let states = recording.states().unwrap();
    let mut random = Random::new(seed);
    let movable: Vec<_> = objects.iter().filter(|object| !object.is_fixed()).collect();
    let like = movable[(random.bits() % movable.len() as u64) as usize];
    let color = like.shape.drawn()[0].color;
    let bounds = like.shape.bounds(Pose::new(Vec3::ZERO, like.pose.rotation));
    let size = bounds.high - bounds.low;
    let draw = |random: &mut Random| {
        let mut any = || random.between(EXTENTS);
        Vec3::new(any(), any(), any())
    };
    let mut span = draw(&mut random);
    while (span - size).abs().max_element() < UNLIKE {
        span = draw(&mut random);
    }
    let starts = objects.iter().map(|object| object.pose.location.xy());
    let ways = states.iter().map(|row| row.pose.location.xy());
    let taken: Vec<_> = starts.chain(ways).collect();
    let half = Vec2::new(table.xspan, table.yspan) / 2.0 - 1.0;
    let size = Vec2::new(camera.width as f32, camera.height as f32);
    let place = (0..DRAWS).map(|_| {
        Vec2::new(
            random.between((-half.x, half.x)),
            random.between((-half.y, half.y)),
        )
    });
    let mut place = place.filter(|place| {
        let corners = [-1.0, 1.0]
            .into_iter()
            .flat_map(|x| [0.0, span.z].map(|z| (*place + 0.8 * Vec2::new(x, x)).extend(z)));
        let mut seen = corners.map(|corner| camera.pixel_of(corner));
        seen.all(|pixel| {
            pixel.is_some_and(|at| at.cmpgt(Vec2::ZERO).all() && at.cmplt(size - 1.0).all())
        }) && taken.iter().all(|other| other.distance(*place) > APART)
    });
    // Where there is no room, it stands at the far edge.
    let place = place.next().unwrap_or(Vec2::new(0.0, half.y));
    let turn = Quat::from_rotation_z(random.between((0.0, 3.0)));
    let pose = Pose::new(place.extend(span.z / 2.0), turn);
    let shape = Shape::Block { span, color };
    WithStranger {
        camera,
        table,
        stranger: ObjectSpec::new("stranger", pose, 1.0, shape),
        objects,
        states,
    }
}

impl WithStranger {
    /// The picture at the end of a tick.
    pub fn picture(&self, tick: SimTick) -> Picture {
        let mut objects = self.objects.clone();
        for row in self.states.iter().take_while(|row| row.tick <= tick) {
            if let Some(object) = objects.iter_mut().find(|object| object.id == row.id) {
                object.pose = row.pose;
            }
        }
        let mut scene = Scene {
            solids: vec![DrawnSolid::of_table(&self.table, 1)],
            ..Scene::default()
        };
        for (object, number) in objects.iter().chain([&self.stranger]).zip(2..) {
            let solids = object.shape.drawn();
            let solids = solids.iter();
            scene
                .solids
                .extend(solids.map(|solid| DrawnSolid::of(object.pose, solid, number)));
        }
        let mut picture = Picture::default();
        Rasterizer::alone().draw(&scene, &self.camera, &mut picture);
        picture
    }
}
