//! The present state as a scene.

use bevy::prelude::*;
use tabletop_core::{
    ChainSpec, Held, LidBoxSpec, ObjectIndex, ObjectSpec, Pose, SceneItem, SceneSpec, Shape, Table,
};

use crate::{
    Assembly, IdAllocator,
    compound::{Compound, Compounds},
};

/// How far a part of a compound may be from where the next load puts it, in units, without a word about it.
const UNNOTICED: f32 = 0.01;

/// The most links that a chain of a task file can have.
const MOST_LINKS: u32 = 1000;

/// The scene that puts everything where it is now.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PresentScene {
    /// The table and everything on it.
    pub scene: SceneSpec,
    /// What it cannot say, each in a sentence.
    pub unsaid: Vec<String>,
}

/// What is on the table now, as a scene with ids that a task file can have: in the order of creation, with chains and lid
/// boxes as such as long as they are whole.
pub fn present_scene(world: &mut World) -> PresentScene {
    let mut tables = world.query::<&Table>();
    let table = tables.iter(world).next().copied().unwrap_or_default();
    let mut present = Inventory {
        world,
        ids: IdAllocator::default(),
        renamed: Vec::new(),
        present: PresentScene {
            scene: SceneSpec {
                table,
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
    /// The ids as the next load will give them.
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
            let spec = ObjectSpec {
                pose,
                shape,
                ..spec.clone()
            };
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
                    "a task file cannot say how a chain hangs: that of `{id}` is saved in a straight line"
                ),
                SceneItem::LidBox(_) | SceneItem::Object(_) => {
                    format!(
                        "a task file cannot say that a lid is open: that of `{id}` is saved shut"
                    )
                }
            };
            self.present.unsaid.push(unsaid);
        }
    }

    /// Adds an item, under the id under which its objects get their ids again. Returns what the next load makes of it.
    fn add(&mut self, item: SceneItem, objects: &[Entity]) -> Vec<ObjectSpec> {
        let ids: Vec<_> = objects
            .iter()
            .filter_map(|&object| self.spec(object).map(|spec| spec.id.clone()))
            .collect();
        let written = id(&item).to_owned();
        let base = written.split('#').next().unwrap_or_default().to_owned();
        let loads = [base, with_marks_of_ids(&written)].map(|id| {
            let item = with_id(&item, id);
            let mut allocator = self.ids.clone();
            let mut assembly = Assembly::on(Table::default());
            assembly.add(&item, &mut allocator);
            (item, allocator, assembly.objects)
        });
        let gives_ids = |(item, _, objects): &(SceneItem, IdAllocator, Vec<ObjectSpec>)| {
            with_marks_of_ids(id(item)) == id(item)
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

    /// The item of a compound as it is now, unless it cannot be said so.
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
            SceneItem::Object(_) => None,
        }
    }

    fn note_holder(&mut self, object: Entity) {
        let holder = self.world.get::<Held>(object).map(|held| held.by);
        if let (Some(hand), Some(spec)) = (holder, self.spec(object)) {
            let unsaid = format!(
                "a task file has no hands: `{}`, which the {} holds, is saved as let go",
                spec.id,
                hand.name()
            );
            self.present.unsaid.push(unsaid);
        }
    }

    fn note_renamed(&mut self) {
        if !self.renamed.is_empty() {
            let renamed = self.renamed.join(", ");
            self.present.unsaid.push(format!(
                "a task file cannot say all ids: {renamed} is what they will be"
            ));
        }
    }
}

/// The nearest shape that an object of a task file can have, and what is lost.
fn sayable(shape: &Shape) -> (Shape, Option<&'static str>) {
    match *shape {
        Shape::Link { span, color, .. } => (
            Shape::Block { span, color },
            Some("a task file cannot say that a chain is broken: its links are saved as blocks"),
        ),
        Shape::Lid { .. } => (
            Shape::Composite {
                parts: shape.simple_parts(),
            },
            Some("a task file has no lid without its box: it is saved as a composite"),
        ),
        Shape::Block { .. }
        | Shape::Cylinder { .. }
        | Shape::Sphere { .. }
        | Shape::Box { .. }
        | Shape::Composite { .. } => (shape.clone(), None),
    }
}

fn id(item: &SceneItem) -> &str {
    match item {
        SceneItem::Object(spec) => &spec.id,
        SceneItem::Chain(spec) => &spec.id,
        SceneItem::LidBox(spec) => &spec.id,
    }
}

fn with_id(item: &SceneItem, new: String) -> SceneItem {
    let mut item = item.clone();
    match &mut item {
        SceneItem::Object(ObjectSpec { id, .. })
        | SceneItem::Chain(ChainSpec { id, .. })
        | SceneItem::LidBox(LidBoxSpec { id, .. }) => *id = new,
    }
    item
}

/// The nearest id that a task file can have.
fn with_marks_of_ids(id: &str) -> String {
    id.replace(
        |mark: char| mark != '_' && !mark.is_ascii_alphanumeric(),
        "_",
    )
}
