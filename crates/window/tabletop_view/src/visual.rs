//! The pictures of the table, the objects on it and the figures around it. They are entities of their own that follow the
//! bodies, which the view never touches.

use bevy::{ecs::entity::EntityHashMap, platform::collections::HashMap, prelude::*, time::Fixed};
use tabletop_core::{Figure, ObjectSpec, RestingSystems, Table};
use tabletop_geometry::{Primitive, Rgb, Solid};
use tabletop_user::RobotLook;

use crate::{mesh, motion::BodyMotion, surface::Surface};

/// The picture of an object, of the table or of a figure; its children are the drawn solids or the figure's surface.
#[derive(Component, Clone, Copy, Debug)]
#[require(Transform, Visibility)]
pub struct Visual {
    /// The entity that has the [`ObjectSpec`], the [`Table`] or the [`Figure`].
    pub of: Entity,
}

/// Convex solids that fill the drawn shape, in the frame of its body.
#[derive(Component, Clone, Debug)]
pub(crate) struct Filled(pub Vec<Primitive>);

/// Everything that has a picture: the table, the objects and the figures.
type Drawable = Or<(With<ObjectSpec>, With<Table>, With<Figure>)>;

/// The surface of a figure.
#[derive(Component)]
struct FigureSurface;

/// The picture of each body.
#[derive(Resource, Default)]
pub(crate) struct Visuals(EntityHashMap<Entity>);

impl Visuals {
    /// The picture of a body.
    pub fn of(&self, body: Entity) -> Option<Entity> {
        self.0.get(&body).copied()
    }
}

/// Meshes and materials that pictures share.
#[derive(Resource)]
pub(crate) struct Looks {
    cuboid: Handle<Mesh>,
    cylinder: Handle<Mesh>,
    ball: Handle<Mesh>,
    /// By the polyhedra's numbers; only as long as they are shown.
    polyhedra: HashMap<usize, AssetId<Mesh>>,
    surfaces: HashMap<[u32; 3], Handle<Surface>>,
    /// That of figures through which the user sees.
    translucent: Option<Handle<Surface>>,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Visuals>()
        .init_resource::<Looks>()
        .add_systems(FixedPostUpdate, note_moves.in_set(RestingSystems))
        .add_systems(
            RunFixedMainLoop,
            (
                drop_pictures,
                make_pictures,
                look_through.run_if(resource_changed::<RobotLook>),
                follow_bodies,
            )
                .chain()
                .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
        );
}

/// Once a tick: where each body has come to.
fn note_moves(mut visuals: Query<(&Visual, &mut BodyMotion)>, bodies: Query<&Transform, Drawable>) {
    for (visual, mut motion) in &mut visuals {
        if let Ok(body) = bodies.get(visual.of) {
            let moved = motion.moved_to(body.into());
            motion.set_if_neq(moved);
        }
    }
}

/// Removes the pictures of bodies that have gone or have become something else.
fn drop_pictures(
    mut commands: Commands,
    mut visuals: ResMut<Visuals>,
    bodies: Query<
        (
            Option<Ref<ObjectSpec>>,
            Option<Ref<Table>>,
            Option<Ref<Figure>>,
        ),
        Drawable,
    >,
) {
    visuals.0.retain(|body, visual| {
        let is_drawn = bodies.get(*body).is_ok_and(|(object, table, figure)| {
            !object.is_some_and(|object| object.is_changed())
                && !table.is_some_and(|table| table.is_changed())
                && !figure.is_some_and(|figure| figure.is_changed())
        });
        if !is_drawn {
            commands.entity(*visual).despawn();
        }
        is_drawn
    });
}

/// Makes the pictures that are missing.
fn make_pictures(
    mut commands: Commands,
    mut visuals: ResMut<Visuals>,
    mut looks: ResMut<Looks>,
    mut surfaces: ResMut<Assets<Surface>>,
    mut meshes: ResMut<Assets<Mesh>>,
    look: Res<RobotLook>,
    bodies: Query<
        (
            Entity,
            &Transform,
            Option<&ObjectSpec>,
            Option<&Table>,
            Option<&Figure>,
        ),
        Drawable,
    >,
) {
    for (body, place, object, table, figure) in &bodies {
        if visuals.0.contains_key(&body) {
            continue;
        }
        let mut drawn = object.map_or_else(Vec::new, |object| object.shape.drawn());
        let mut filled = object.map_or_else(Vec::new, |object| object.shape.filled());
        drawn.extend(table.map(Table::slab));
        filled.extend(table.map(Table::slab));
        let visual = commands
            .spawn((
                Visual { of: body },
                BodyMotion::standing_at(place.into()),
                *place,
            ))
            .with_children(|parts| {
                for primitive in &drawn {
                    parts.spawn(looks.of(primitive, &mut meshes, &mut surfaces));
                }
                if let Some(figure) = figure {
                    parts.spawn((
                        FigureSurface,
                        Mesh3d(meshes.add(mesh::of_triangles(&figure.fine))),
                        MeshMaterial3d(looks.of_figure(*look, &mut surfaces)),
                    ));
                }
            })
            .insert(Filled(filled))
            .id();
        visuals.0.insert(body, visual);
    }
}

/// Figures become translucent, or no longer.
fn look_through(
    look: Res<RobotLook>,
    mut looks: ResMut<Looks>,
    mut surfaces: ResMut<Assets<Surface>>,
    mut figures: Query<&mut MeshMaterial3d<Surface>, With<FigureSurface>>,
) {
    for mut figure in &mut figures {
        let surface = MeshMaterial3d(looks.of_figure(*look, &mut surfaces));
        figure.set_if_neq(surface);
    }
}

/// Once a frame: pictures move to where their bodies are at this moment.
fn follow_bodies(time: Res<Time<Fixed>>, mut visuals: Query<(&BodyMotion, &mut Transform)>) {
    for (motion, mut transform) in &mut visuals {
        transform.set_if_neq(motion.at(time.overstep_fraction()).into());
    }
}

impl FromWorld for Looks {
    fn from_world(world: &mut World) -> Self {
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        Self {
            cuboid: meshes.add(mesh::unit_cuboid()),
            cylinder: meshes.add(mesh::unit_cylinder()),
            ball: meshes.add(mesh::unit_ball()),
            polyhedra: HashMap::default(),
            surfaces: HashMap::default(),
            translucent: None,
        }
    }
}

impl Looks {
    fn of(
        &mut self,
        primitive: &Primitive,
        meshes: &mut Assets<Mesh>,
        surfaces: &mut Assets<Surface>,
    ) -> impl Bundle + use<> {
        (
            Mesh3d(self.mesh(&primitive.solid, meshes)),
            MeshMaterial3d(self.surface(primitive.color, surfaces)),
            Transform::from(primitive.pose).with_scale(mesh::scale_of(&primitive.solid)),
        )
    }

    pub(crate) fn mesh(&mut self, solid: &Solid, meshes: &mut Assets<Mesh>) -> Handle<Mesh> {
        match solid {
            Solid::Cuboid(_) => self.cuboid.clone(),
            Solid::Cylinder { .. } => self.cylinder.clone(),
            Solid::Ball(_) => self.ball.clone(),
            Solid::Polyhedron(polyhedron) => {
                let known = self.polyhedra.get(&polyhedron.number());
                let shown = known.and_then(|&known| meshes.get_strong_handle(known));
                shown.unwrap_or_else(|| {
                    let mesh = meshes.add(mesh::of_triangles(&polyhedron.surface(Rgb::WHITE)));
                    self.polyhedra.insert(polyhedron.number(), mesh.id());
                    mesh
                })
            }
        }
    }

    fn of_figure(&mut self, look: RobotLook, surfaces: &mut Assets<Surface>) -> Handle<Surface> {
        match look.is_translucent {
            true => self
                .translucent
                .get_or_insert_with(|| {
                    surfaces.add(Surface::translucent(Rgb::WHITE, RobotLook::OPACITY))
                })
                .clone(),
            false => self.surface(Rgb::WHITE, surfaces),
        }
    }

    fn surface(&mut self, color: Rgb, surfaces: &mut Assets<Surface>) -> Handle<Surface> {
        let key = [color.red, color.green, color.blue].map(f32::to_bits);
        self.surfaces
            .entry(key)
            .or_insert_with(|| surfaces.add(Surface::from(color)))
            .clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_app::test_app;
    use tabletop_core::Shape;
    use tabletop_geometry::{Pose, Triangles};

    fn app() -> App {
        test_app(plugin)
    }

    fn ball(radius: f32) -> ObjectSpec {
        ObjectSpec {
            id: "ball".into(),
            pose: Pose::IDENTITY,
            mass: 1.0,
            shape: Shape::Sphere {
                radius,
                color: Rgb::GRAY,
            },
            dynamics: Default::default(),
            descriptions: Vec::new(),
        }
    }

    /// Each drawn body with its location and the scales of its parts.
    fn drawn(app: &mut App) -> Vec<(Entity, Vec3, Vec<Vec3>)> {
        let world = app.world_mut();
        let mut visuals = world.query::<(&Visual, &Transform, &Children)>();
        let mut parts = world.query_filtered::<&Transform, With<Mesh3d>>();
        visuals
            .iter(world)
            .map(|(visual, transform, children)| {
                let scales = parts.iter_many(world, children).map(|part| part.scale);
                (visual.of, transform.translation, scales.collect())
            })
            .collect()
    }

    #[test]
    fn a_picture_comes_and_goes_with_its_object() {
        let mut app = app();
        let object = app.world_mut().spawn(ball(2.0)).id();
        app.update();
        assert_eq!(
            drawn(&mut app),
            [(object, Vec3::ZERO, vec![Vec3::splat(2.0)])]
        );
        app.world_mut().entity_mut(object).despawn();
        app.update();
        assert_eq!(drawn(&mut app), []);
        let mut meshes = app.world_mut().query::<&Mesh3d>();
        assert_eq!(meshes.iter(app.world()).count(), 0);
    }

    #[test]
    fn an_object_that_becomes_another_is_drawn_anew() {
        let mut app = app();
        let object = app.world_mut().spawn(ball(2.0)).id();
        app.update();
        app.world_mut().entity_mut(object).insert(ball(3.0));
        app.update();
        assert_eq!(
            drawn(&mut app),
            [(object, Vec3::ZERO, vec![Vec3::splat(3.0)])]
        );
    }

    #[test]
    fn the_table_is_drawn_with_its_top_at_zero() {
        let mut app = app();
        app.world_mut().spawn(Table::default());
        app.update();
        let mut tops = app.world_mut().query_filtered::<&Transform, With<Mesh3d>>();
        let slab = tops.single(app.world()).unwrap();
        assert_eq!(slab.scale, Vec3::new(20.0, 12.0, 4.0));
        assert_eq!(slab.translation.z + slab.scale.z / 2.0, 0.0);
    }

    #[test]
    fn a_picture_follows_its_object_one_tick_behind() {
        let mut app = app();
        let object = app.world_mut().spawn(ball(1.0)).id();
        app.update();
        let mut seen = Vec::new();
        for x in [1.0, 2.0, 2.0] {
            let mut body = app.world_mut().entity_mut(object);
            body.get_mut::<Transform>().unwrap().translation.x = x;
            app.update();
            seen.push(drawn(&mut app)[0].1.x);
        }
        assert_eq!(seen, [0.0, 1.0, 2.0]);
    }

    fn figure(x: f32) -> Figure {
        let surface = Triangles {
            positions: vec![Vec3::X * x, Vec3::Y, Vec3::Z],
            normals: vec![Vec3::ONE.normalize(); 3],
            colors: vec![Rgb::GRAY; 3],
            indices: vec![[0, 1, 2]],
        };
        Figure {
            fine: surface.into(),
            coarse: Triangles::default().into(),
        }
    }

    #[test]
    fn a_figure_is_drawn_while_it_is_there_and_anew_when_it_changes() {
        let mut app = app();
        let link = app.world_mut().spawn(figure(1.0)).id();
        let mesh_of_picture = |app: &mut App| {
            app.update();
            let world = app.world_mut();
            let mut pictures = world.query::<&Visual>();
            assert!(pictures.iter(world).all(|visual| visual.of == link));
            let mut parts = world.query::<&Mesh3d>();
            let mesh = parts.single(world).ok()?.id();
            let meshes = world.resource::<Assets<Mesh>>();
            Some((mesh, meshes.get(mesh)?.count_vertices()))
        };
        let first = mesh_of_picture(&mut app).unwrap();
        assert_eq!(first.1, 3);
        assert_eq!(mesh_of_picture(&mut app), Some(first));
        app.world_mut().entity_mut(link).insert(figure(2.0));
        assert_ne!(mesh_of_picture(&mut app).unwrap().0, first.0);
        app.world_mut().entity_mut(link).remove::<Figure>();
        assert_eq!(mesh_of_picture(&mut app), None);
    }

    #[test]
    fn figures_become_translucent_and_opaque_again() {
        let mut app = app();
        app.world_mut().spawn(figure(1.0));
        let mut alpha = |is_translucent: bool| {
            app.insert_resource(RobotLook { is_translucent });
            app.update();
            let world = app.world_mut();
            let mut parts = world.query::<&MeshMaterial3d<Surface>>();
            let surface = parts.single(world).unwrap().id();
            let surfaces = world.resource::<Assets<Surface>>();
            surfaces.get(surface).unwrap().alpha_mode()
        };
        let modes = [false, true, false].map(&mut alpha);
        assert_eq!(
            modes,
            [AlphaMode::Opaque, AlphaMode::Blend, AlphaMode::Opaque]
        );
    }

    #[test]
    fn equal_polyhedra_share_a_mesh_as_long_as_they_are_shown() {
        let mut app = app();
        let ring = |id: &str| {
            let shape = Shape::Ring {
                radius_outer: 1.0,
                radius_inner: 0.5,
                zspan: 0.4,
                sides: 32,
                color: Rgb::RED,
            };
            ObjectSpec::new(id, Pose::IDENTITY, 1.0, shape)
        };
        let objects = ["a", "b"].map(|id| app.world_mut().spawn(ring(id)).id());
        app.update();
        let meshes = |app: &App| app.world().resource::<Assets<Mesh>>().len();
        assert_eq!(meshes(&app), 4);
        assert_eq!(drawn(&mut app)[0].2, [Vec3::ONE]);
        for object in objects {
            app.world_mut().entity_mut(object).despawn();
        }
        app.update();
        app.world_mut().spawn(ring("c"));
        app.update();
        assert_eq!(drawn(&mut app).len(), 1);
    }

    #[test]
    fn equal_colours_share_a_material() {
        let mut app = app();
        for radius in [1.0, 2.0, 3.0] {
            app.world_mut().spawn(ball(radius));
        }
        app.world_mut().spawn(Table::default());
        app.update();
        assert_eq!(drawn(&mut app).len(), 4);
        assert_eq!(app.world().resource::<Assets<Surface>>().len(), 2);
    }
}
