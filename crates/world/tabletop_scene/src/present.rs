//! The present state as a scene.

mod marks;

use bevy::prelude::*;
use tabletop_core::{
    ChainSpec, Composition, Held, LidBoxSpec, Manipulator, ObjectIndex, ObjectSpec, SceneItem,
    SceneSpec, Shape, Table,
};
use tabletop_geometry::Pose;

use crate::{
    Assembly, IdAllocator,
    compound::{Compound, Compounds},
};
use marks::{mark_parts, with_ids, with_marks_of_ids};

/// Distance, in units, of a compound's part from where the next load puts it, up to which nothing is reported.
const UNNOTICED: f32 = 0.01;

/// The most links that a chain of a task file can have.
const MOST_LINKS: u32 = 1000;

/// The present state of the table as a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PresentScene {
    /// The table and everything on it.
    pub scene: SceneSpec,
    /// Parts of the state that a task file cannot express, each as a sentence.
    pub unsaid: Vec<String>,
}

/// The present table as a scene with ids that a task file can have: in the order of creation, with chains and lid
/// boxes as single elements as long as they are whole.
pub fn present_scene(world: &World) -> PresentScene {
    let tables = world.try_query::<&Table>();
    let table = tables.and_then(|mut tables| tables.iter(world).next().copied());
    let mut present = Inventory {
        world,
        ids: IdAllocator::default(),
        renamed: Vec::new(),
        present: PresentScene {
            scene: SceneSpec {
                table: table.unwrap_or_default(),
                items: Vec::new(),
            },
            unsaid: Vec::new(),
        },
    };
    present.take();
    present.present
}

struct Inventory<'w> {
    world: &'w World,
    /// The ids that the next load will give.
    ids: IdAllocator,
    renamed: Vec<String>,
    present: PresentScene,
}

impl Inventory<'_> {
    fn take(&mut self) {
        let world = self.world;
        let objects: Vec<_> = world.resource::<ObjectIndex>().iter().collect();
        let mut compounds = world.resource::<Compounds>().clone();
        compounds.forget_broken(|member| objects.contains(&member));
        for &object in &objects {
            let compound = compounds.of(object);
            let whole = compound.and_then(|compound| Some((compound, self.whole(compound)?)));
            match whole {
                Some((compound, item)) if compound.members[0] == object => {
                    self.add_compound(compound, item);
                }
                Some(_) => {}
                None => self.add_object(object),
            }
            self.note_holder(object);
        }
        self.note_renamed();
        self.present.unsaid.dedup();
    }

    fn spec(&self, object: Entity) -> Option<&ObjectSpec> {
        self.world.get(object)
    }

    fn pose(&self, object: Entity) -> Option<Pose> {
        self.world.get::<Transform>(object).map(Pose::from)
    }

    fn add_object(&mut self, object: Entity) {
        if let (Some(spec), Some(pose)) = (self.spec(object), self.pose(object)) {
            let (shape, unsaid) = sayable(&spec.shape);
            let mut spec = ObjectSpec {
                pose,
                shape,
                ..spec.clone()
            };
            spec.dynamics.velocity = Vec3::ZERO;
            self.add(SceneItem::Object(spec), &[object]);
            self.present.unsaid.extend(unsaid.map(str::to_owned));
        }
    }

    fn add_compound(&mut self, compound: &Compound, item: SceneItem) {
        let loaded = self.add(item, &compound.members);
        let is_there = |(loaded, &member): (&ObjectSpec, &Entity)| {
            self.pose(member).is_some_and(|pose| {
                pose.location.distance(loaded.pose.location) < UNNOTICED
                    && pose.rotation.angle_between(loaded.pose.rotation) < UNNOTICED
            })
        };
        if !loaded.iter().zip(&compound.members).all(is_there) {
            let id = self
                .spec(compound.members[0])
                .map_or("", |first| first.id.as_str());
            let unsaid = match compound.item {
                SceneItem::Chain(_) => format!(
                    "a task file cannot express how a chain hangs: that of `{id}` is saved in a straight line"
                ),
                SceneItem::Jointed(_) => format!(
                    "a task file says where jointed objects are to {UNNOTICED}: `{id}` and the object at the other end of its joint are farther apart"
                ),
                SceneItem::LidBox(_) | SceneItem::Object(_) => {
                    format!(
                        "a task file cannot express that a lid is open: that of `{id}` is saved shut"
                    )
                }
            };
            self.present.unsaid.push(unsaid);
        }
    }

    /// Adds an item, under the id from which its objects get their ids again. Returns the objects that the next load makes of it.
    fn add(&mut self, mut item: SceneItem, objects: &[Entity]) -> Vec<ObjectSpec> {
        mark_parts(&mut item);
        let ids: Vec<_> = objects
            .iter()
            .filter_map(|&object| self.spec(object).map(|spec| spec.id.clone()))
            .collect();
        self.note_meshes(objects);
        let base = |id: &str| id.split('#').next().unwrap_or_default().to_owned();
        let loads = [with_ids(&item, base), with_ids(&item, with_marks_of_ids)].map(|item| {
            let mut allocator = self.ids.clone();
            let mut assembly = Assembly::on(Table::default());
            assembly.add(&item, &mut allocator);
            (item, allocator, assembly.objects)
        });
        let gives_ids = |(item, _, objects): &(SceneItem, IdAllocator, Vec<ObjectSpec>)| {
            with_ids(item, with_marks_of_ids) == *item
                && objects.iter().map(|object| &object.id).eq(&ids)
        };
        let [as_base, as_marks] = loads;
        let (item, allocator, loaded) = match gives_ids(&as_base) {
            true => as_base,
            false => as_marks,
        };
        for (old, new) in ids.iter().zip(&loaded) {
            if *old != new.id {
                self.renamed.push(format!("`{old}` as `{}`", new.id));
            }
        }
        self.ids = allocator;
        self.present.scene.items.push(item);
        loaded
    }

    /// The item of a compound in its present state, unless a task file cannot express it.
    fn whole(&self, compound: &Compound) -> Option<SceneItem> {
        let first = self.pose(*compound.members.first()?)?;
        match &compound.item {
            SceneItem::Chain(chain) => {
                let chain = ChainSpec {
                    start: first.location,
                    end: self.pose(*compound.members.last()?)?.location,
                    link_count: compound.members.len() as u32 - 2,
                    ..chain.clone()
                };
                let reaches = chain.least_links() <= chain.link_count;
                (reaches && chain.link_count <= MOST_LINKS).then_some(SceneItem::Chain(chain))
            }
            SceneItem::LidBox(lidbox) => Some(SceneItem::LidBox(LidBoxSpec {
                pose: first,
                ..lidbox.clone()
            })),
            SceneItem::Jointed(jointed) => {
                let second = self.pose(*compound.members.get(1)?)?;
                let mut jointed = jointed.clone();
                jointed.init = jointed.displacement([first, second]);
                jointed.pose = first * jointed.objects[0].pose.inverse();
                for (object, &member) in jointed.objects.iter_mut().zip(&compound.members) {
                    object.id.clone_from(&self.spec(member)?.id);
                }
                Some(SceneItem::Jointed(jointed))
            }
            SceneItem::Object(_) => None,
        }
    }

    fn note_holder(&mut self, object: Entity) {
        let holder = self.world.get::<Held>(object).map(|held| held.by);
        if let (Some(Manipulator::Hand(hand)), Some(spec)) = (holder, self.spec(object)) {
            let unsaid = format!(
                "a task file has no hands: `{}`, which {hand} holds, is saved as released",
                spec.id
            );
            self.present.unsaid.push(unsaid);
        }
    }

    fn note_meshes(&mut self, objects: &[Entity]) {
        let shapes = objects
            .iter()
            .filter_map(|&object| Some(self.spec(object)?.shape.simple_parts()));
        let files: Vec<_> = shapes
            .flatten()
            .filter_map(|part| {
                if let Shape::Mesh { mesh, .. } = part.shape {
                    Some(mesh.file().to_owned())
                } else {
                    None
                }
            })
            .collect();
        let unsaid = |file| {
            format!(
                "a task file only names meshes: `{file}` must be there, seen from the saved file's folder"
            )
        };
        self.present.unsaid.extend(files.into_iter().map(unsaid));
    }

    fn note_renamed(&mut self) {
        if !self.renamed.is_empty() {
            let renamed = self.renamed.join(", ");
            self.present.unsaid.push(format!(
                "a task file cannot express all ids: saved are {renamed}"
            ));
        }
    }
}

/// The nearest shape that an object of a task file can have, and the loss.
fn sayable(shape: &Shape) -> (Shape, Option<&'static str>) {
    if let Shape::Link { span, color, .. } = *shape {
        let unsaid =
            "a task file cannot express that a chain is broken: its links are saved as blocks";
        return (Shape::Block { span, color }, Some(unsaid));
    }
    match shape.composition() {
        Composition::Lid(parts) => (
            Shape::Composite {
                parts: (*parts).into(),
            },
            Some("a task file has no lid without its box: it is saved as a composite"),
        ),
        Composition::Simple
        | Composition::Parts(_)
        | Composition::Control(_)
        | Composition::BondPoint(_) => (shape.clone(), None),
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Hand, JointMotion, JointedSpec, StepApp as _, prelude::*};

    use super::*;
    use crate::test_app::test_app;

    fn app(items: Vec<SceneItem>) -> App {
        let mut app = test_app();
        let table = Table {
            xspan: 30.0,
            yspan: 8.0,
        };
        let scene = SceneSpec { table, items };
        app.world_mut()
            .write_command(SceneCommand::Set(Box::new(scene)));
        app.step(1);
        app
    }

    fn block(id: &str, x: f32) -> SceneItem {
        let shape = Shape::Block {
            span: Vec3::ONE,
            color: Rgb::RED,
        };
        let pose = Pose::at(Vec3::new(x, 0.0, 0.5));
        SceneItem::Object(ObjectSpec::new(id, pose, 1.0, shape))
    }

    fn chain() -> ChainSpec {
        ChainSpec {
            id: "c".into(),
            start: Vec3::new(6.0, 2.0, 4.0),
            end: Vec3::new(-6.0, 2.0, 4.0),
            link_span: Vec3::new(0.1, 1.0, 0.1),
            link_count: 0,
            link_padding: 0.05,
            link_mass: 1.0,
            color: Rgb::GRAY,
        }
    }

    fn lidbox() -> LidBoxSpec {
        LidBoxSpec {
            id: "b".into(),
            pose: Pose::at(Vec3::new(0.0, 0.0, 1.5)),
            span: Vec3::splat(3.0),
            thickness: 0.25,
            box_mass: 9.0,
            lid_mass: 1.0,
            color: Rgb::GRAY,
            handle_span: Vec3::splat(0.5),
            handle_thickness: 0.125,
            handle_color: Rgb::BLUE,
            descriptions: vec![("use".into(), "chest".into())],
        }
    }

    fn object(app: &App, id: &str) -> Entity {
        app.world().resource::<ObjectIndex>().get(id).unwrap()
    }

    fn unsaid(present: &PresentScene) -> Vec<&str> {
        present.unsaid.iter().map(String::as_str).collect()
    }

    #[test]
    fn objects_are_saved_where_they_are_now_in_their_order() {
        let mut app = app(vec![block("b", 0.0), block("a", 3.0)]);
        let moved = object(&app, "b");
        let place = Transform::from_xyz(1.0, 2.0, 0.5);
        app.world_mut().entity_mut(moved).insert(place);
        let PresentScene { scene, unsaid } = present_scene(app.world());
        assert_eq!((scene.table.xspan, unsaid), (30.0, Vec::new()));
        let [SceneItem::Object(b), SceneItem::Object(a)] = &scene.items[..] else {
            panic!("{:?}", scene.items);
        };
        assert_eq!((&*b.id, &*a.id), ("b", "a"));
        assert_eq!(b.pose, Pose::at(place.translation));
    }

    #[test]
    fn ids_that_the_program_has_made_come_back_by_themselves() {
        let blocks = ["a", "a", "", "", "a"];
        let items = (0..).zip(blocks).map(|(i, id)| block(id, i as f32 * 2.0));
        let present = present_scene(app(items.collect()).world());
        assert_eq!(unsaid(&present), [""; 0]);
        let ids: Vec<_> = present.scene.items.iter().flat_map(ids_of).collect();
        assert_eq!(ids, ["a", "a", "obj", "obj", "a"]);
    }

    #[test]
    fn an_id_that_a_file_cannot_say_is_reported_with_the_nearest() {
        let mut app = app(vec![block("a", 0.0), block("a", 2.0)]);
        let first = object(&app, "a");
        app.world_mut().despawn(first);
        let present = present_scene(app.world());
        assert_eq!(ids_of(&present.scene.items[0]), ["a_0"]);
        assert_eq!(
            unsaid(&present),
            ["a task file cannot express all ids: saved are `a#0` as `a_0`"]
        );
    }

    #[test]
    fn a_chain_is_saved_as_one_and_how_it_hangs_is_reported() {
        let mut app = app(vec![SceneItem::Chain(chain())]);
        let links = ChainSpec {
            link_count: 12,
            ..chain()
        };
        let saved = [SceneItem::Chain(links)];
        app.step(120);
        let present = present_scene(app.world());
        assert_eq!(present.scene.items, saved);
        assert_eq!(
            unsaid(&present),
            [
                "a task file cannot express how a chain hangs: that of `c-start` is saved in a straight line"
            ]
        );
    }

    fn ids_of(item: &SceneItem) -> Vec<String> {
        let mut ids = Vec::new();
        let _unchanged = with_ids(item, |id| {
            ids.push(id.to_owned());
            id.to_owned()
        });
        ids
    }

    #[test]
    fn jointed_objects_are_saved_where_they_are() {
        // The spring of shears moves them meanwhile.
        for (motion, drift) in [
            (JointMotion::Slide, 0.1),
            (JointMotion::Turn, 0.1),
            (JointMotion::Shear, 4.0),
        ] {
            let color = Rgb::GRAY;
            let ball = |id: &str, pose, mass| {
                ObjectSpec::new(id, pose, mass, Shape::Sphere { radius: 0.5, color })
            };
            let spec = JointedSpec {
                pose: Pose::from_degrees(Vec3::Z * 3.0, Vec3::Z * 30.0),
                objects: [
                    ball("a", Pose::at(Vec3::Z), 0.0),
                    ball("a", Pose::from_degrees(Vec3::Y, Vec3::X * 20.0), 1.0),
                ],
                motion,
                limits: [-3.0, 3.0],
                init: 1.0,
                collides: false,
                damping: 1.0,
            };
            let app = app(vec![SceneItem::Jointed(spec.clone())]);
            let present = present_scene(app.world());
            assert_eq!(unsaid(&present), [""; 0]);
            let [SceneItem::Jointed(saved)] = &present.scene.items[..] else {
                panic!("{:?}", present.scene.items);
            };
            assert!((saved.init - 1.0).abs() < drift, "{saved:?}");
            assert!(saved.pose.location.distance(spec.pose.location) < 1e-3);
            let (pose, init) = (saved.pose, saved.init);
            assert_eq!(*saved, JointedSpec { pose, init, ..spec });
        }
    }

    #[test]
    fn a_broken_chain_is_saved_as_blocks() {
        let mut app = app(vec![SceneItem::Chain(chain())]);
        let link = object(&app, "c-link3");
        app.world_mut().despawn(link);
        let present = present_scene(app.world());
        assert_eq!(present.scene.items.len(), 13);
        let is_block = |item: &SceneItem| matches!(item, SceneItem::Object(object) if matches!(object.shape, Shape::Block { .. }));
        assert!(present.scene.items.iter().all(is_block));
        assert_eq!(present.unsaid.len(), 2, "{:?}", present.unsaid);
    }

    #[test]
    fn a_lid_box_is_saved_as_one_and_an_open_lid_is_reported() {
        let mut app = app(vec![SceneItem::LidBox(lidbox())]);
        let present = present_scene(app.world());
        let [SceneItem::LidBox(saved)] = &present.scene.items[..] else {
            panic!("{:?}", present.scene.items);
        };
        let pose = saved.pose;
        assert!(pose.location.distance(lidbox().pose.location) < 1e-3);
        assert_eq!(*saved, LidBoxSpec { pose, ..lidbox() });
        assert_eq!(unsaid(&present), [""; 0]);

        let lid = object(&app, "b-lid");
        let mut lid = app.world_mut().get_mut::<Transform>(lid).unwrap();
        lid.translation.x -= 1.0;
        let present = present_scene(app.world());
        assert_eq!(
            unsaid(&present),
            ["a task file cannot express that a lid is open: that of `b-box` is saved shut"]
        );
    }

    #[test]
    fn a_held_object_is_saved_as_released() {
        let mut app = app(vec![block("a", 0.0)]);
        let held = object(&app, "a");
        let by = Manipulator::Hand(Hand::Left);
        app.world_mut().entity_mut(held).insert(Held { by });
        let present = present_scene(app.world());
        assert_eq!(present.scene.items.len(), 1);
        assert_eq!(
            unsaid(&present),
            ["a task file has no hands: `a`, which LeftHand holds, is saved as released"]
        );
    }

    #[test]
    fn presets_are_saved_without_loss() {
        let mut app = app(Vec::new());
        for preset in [Preset::Stack(3), Preset::BoxContainer] {
            app.world_mut()
                .write_command(SceneCommand::Make { preset, seed: 1 });
        }
        app.step(1);
        let present = present_scene(app.world());
        let ids: Vec<_> = present.scene.items.iter().flat_map(ids_of).collect();
        assert_eq!(ids, ["smallblock", "smallblock", "smallblock", "container"]);
        assert_eq!(unsaid(&present), [""; 0]);
    }
}
