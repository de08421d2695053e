//! Variations of a table: the smallest changes on which programs may act differently.

use bevy::math::Vec3;
use tabletop_core::ObjectSpec;
use tabletop_geometry::Rgb;
use tabletop_task::{Relation, color_name};

use crate::{
    look::color_of,
    placement::Room,
    program::TaskProgram,
    run::ProgramRun,
    scene::{SceneView, TableScene},
    step::named,
};

/// A table that differs a little from a demonstrated one.
#[derive(Clone, Debug)]
pub struct SceneVariation {
    /// What is different, in words.
    pub sentence: String,
    /// The table.
    pub scene: TableScene,
}

/// The most pairs of objects that are exchanged.
const MOST_EXCHANGED: usize = 4;
/// Colours that an object is given, if it does not have them.
const COLORS: [Rgb; 2] = [Rgb::RED, Rgb::GREEN];

impl SceneVariation {
    /// Variations of a table, with the objects that matter first.
    pub(crate) fn all(scene: &TableScene, touched: &[&str]) -> Vec<Self> {
        let view = scene.view();
        let mut movable: Vec<_> = scene
            .objects
            .iter()
            .filter(|object| view.is_movable(&object.id) && is_alone(&view, &object.id))
            .collect();
        movable.sort_by_key(|object| !touched.contains(&object.id.as_str()));
        // The first of each look stands for the others.
        let mut looks = Vec::new();
        let representative: Vec<_> = movable
            .iter()
            .filter(|object| {
                let look = (color_of(object), touched.contains(&object.id.as_str()));
                let is_new = !looks.contains(&look);
                looks.push(look);
                is_new
            })
            .copied()
            .collect();
        let twins = representative
            .iter()
            .filter_map(|object| twin(&view, object));
        let gone = representative.iter().map(|object| without(scene, object));
        let painted = representative
            .iter()
            .flat_map(|object| painted(scene, object));
        let exchanged = movable
            .windows(2)
            .take(MOST_EXCHANGED)
            .map(|pair| exchanged(scene, pair[0], pair[1]));
        let grown = representative.iter().map(|object| grown(scene, object));
        twins
            .chain(gone)
            .chain(painted)
            .chain(exchanged)
            .chain(grown)
            .collect()
    }
}

/// True if nothing is on an object, and it stands on the table.
fn is_alone(view: &SceneView, id: &str) -> bool {
    view.stack_above(id).is_empty() && view.standing.is_on_table(id)
}

fn with(scene: &TableScene, id: &str, change: impl FnOnce(&mut ObjectSpec)) -> TableScene {
    let mut scene = scene.clone();
    if let Some(object) = scene.objects.iter_mut().find(|object| object.id == id) {
        change(object);
    }
    scene
}

/// One more object of this kind.
fn twin(view: &SceneView, object: &ObjectSpec) -> Option<SceneVariation> {
    let pose = Room::new(view, object).free_spot(object.pose.location + Vec3::X, None)?;
    let mut twin = object.clone();
    twin.id = format!("Another{}", object.id);
    twin.pose = pose;
    let mut scene = view.scene.clone();
    scene.objects.push(twin);
    Some(SceneVariation {
        sentence: format!(
            "if there is another one like {}",
            called(view.scene, object)
        ),
        scene,
    })
}

fn without(scene: &TableScene, object: &ObjectSpec) -> SceneVariation {
    let mut less = scene.clone();
    less.objects.retain(|other| other.id != object.id);
    SceneVariation {
        sentence: format!("if {} is not there", called(scene, object)),
        scene: less,
    }
}

fn painted(scene: &TableScene, object: &ObjectSpec) -> Vec<SceneVariation> {
    let others = COLORS.into_iter().filter(|color| {
        let own = color_of(object);
        own.is_some_and(|own| own != color_name(*color))
    });
    let all = others.map(|color| SceneVariation {
        sentence: format!("if {} is {}", called(scene, object), color_name(color)),
        scene: with(scene, &object.id, |object| object.shape.paint(color)),
    });
    all.collect()
}

/// Two objects in each other's place.
fn exchanged(scene: &TableScene, one: &ObjectSpec, other: &ObjectSpec) -> SceneVariation {
    let place = |object: &ObjectSpec, at: &ObjectSpec| {
        let z = object.pose.location.z;
        at.pose.location.with_z(z)
    };
    let (first, second) = (place(one, other), place(other, one));
    let moved = with(scene, &one.id, |object| object.pose.location = first);
    let moved = with(&moved, &other.id, |object| object.pose.location = second);
    let [one, other] = [one, other].map(|object| called(scene, object));
    SceneVariation {
        sentence: format!("if {one} and {other} are in each other's place"),
        scene: moved,
    }
}

/// An object that is larger than all others of its kind.
fn grown(scene: &TableScene, object: &ObjectSpec) -> SceneVariation {
    SceneVariation {
        sentence: format!("if {} is larger", called(scene, object)),
        scene: with(scene, &object.id, |object| {
            let lengths = object.shape.lengths_mut();
            lengths
                .into_iter()
                .for_each(|(_, length)| *length *= GROWTH);
            object.pose.location.z *= GROWTH;
        }),
    }
}

/// The share by which an object grows that is to be the largest.
const GROWTH: f32 = 1.25;

fn called(scene: &TableScene, object: &ObjectSpec) -> String {
    named(scene, &object.id).to_string()
}

/// What a program does on a table, for comparison with what others do.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Effect {
    Impossible,
    /// The objects with their relations, and their places if they are on the table.
    Done(Vec<(String, String, [i32; 2])>),
}

impl Effect {
    pub fn of(program: &TaskProgram, scene: &TableScene) -> Self {
        let (steps, after, failure) = ProgramRun::rehearsed(program, scene);
        if failure.is_some() {
            return Self::Impossible;
        }
        let mut ends: Vec<_> = steps
            .iter()
            .map(|step| {
                let at = after
                    .object(&step.object)
                    .map(|object| object.pose.location);
                let at = at
                    .filter(|_| step.relation == Relation::OnTable)
                    .unwrap_or_default();
                let place = [at.x, at.y].map(|at| at.round() as i32);
                let other = step.relation.object().unwrap_or_default();
                let relation = format!("{} {other}", step.relation.name());
                (step.object.clone(), relation, place)
            })
            .collect();
        ends.sort();
        Self::Done(ends)
    }
}
