//! Placing objects of a scene at random.

use bevy::prelude::*;
use serde::Deserialize;
use tabletop_core::{Random, SceneItem, SceneSpec};
use tabletop_geometry::{Bounds, Pose, turn_about};

/// Least distance, in units, of a placed object from any other.
const CLEARANCE: f32 = 0.05;

/// The number of places that are tried for an object.
const TRIES: u32 = 1000;

/// A random place for an object of a task file. The object keeps its height, and a distance from everything else.
/// Lengths are in units of 10 cm, angles in degrees.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RandomPlace {
    /// Its id in the task file.
    pub object: String,
    /// Its origin's least and greatest X.
    pub x: (f32, f32),
    /// Its origin's least and greatest Y.
    pub y: (f32, f32),
    /// Least and greatest angle by which it is turned about the vertical from the orientation in the file.
    #[serde(default)]
    pub turn: (f32, f32),
}

impl RandomPlace {
    /// Its fault, if it makes no sense.
    pub(crate) fn fault(&self) -> Option<String> {
        [("x", self.x), ("y", self.y), ("turn", self.turn)]
            .into_iter()
            .find(|(_, (low, high))| !(low <= high && low.is_finite() && high.is_finite()))
            .map(|(name, range)| format!("expected `{name}` as (least, greatest), found {range:?}"))
    }
}

/// Moves objects of a scene, one after the other.
pub(crate) fn place_all(
    scene: &mut SceneSpec,
    places: &[RandomPlace],
    random: &mut Random,
) -> Result<(), String> {
    let placed = places
        .iter()
        .map(|place| index_of(scene, &place.object))
        .collect::<Result<Vec<_>, _>>()?;
    let is_yet_to_be_placed = |index: &usize, done: usize| placed[done..].contains(index);
    for (done, (place, &index)) in places.iter().zip(&placed).enumerate() {
        let obstacles: Vec<Bounds> = scene
            .items
            .iter()
            .enumerate()
            .filter(|(other, _)| !is_yet_to_be_placed(other, done))
            .map(|(_, item)| item.bounds())
            .collect();
        let item = &scene.items[index];
        scene.items[index] = (0..TRIES)
            .map(|_| moved(item, place, random))
            .find(|candidate| {
                let bounds = candidate.bounds();
                !obstacles
                    .iter()
                    .any(|&obstacle| bounds.is_crowded_by(obstacle, CLEARANCE))
            })
            .ok_or_else(|| {
                let id = &place.object;
                format!("no free place for `{id}` in {TRIES} tries; give it more room")
            })?;
    }
    Ok(())
}

fn index_of(scene: &SceneSpec, id: &str) -> Result<usize, String> {
    scene
        .items
        .iter()
        .position(|item| match item {
            SceneItem::Object(object) => object.id == id,
            SceneItem::LidBox(lidbox) => lidbox.id == id,
            SceneItem::Jointed(jointed) => jointed.objects[0].id == id,
            SceneItem::Chain(_) => false,
        })
        .ok_or_else(|| {
            format!("the task file has no object or lid box `{id}` that could be placed")
        })
}

/// The item at a random pose.
fn moved(item: &SceneItem, place: &RandomPlace, random: &mut Random) -> SceneItem {
    let (x, y) = (random.between(place.x), random.between(place.y));
    let turn = turn_about(Vec3::Z, random.between(place.turn).to_radians());
    let mut item = item.clone();
    let pose = match &mut item {
        SceneItem::Object(object) => &mut object.pose,
        SceneItem::LidBox(lidbox) => &mut lidbox.pose,
        SceneItem::Jointed(jointed) => &mut jointed.pose,
        SceneItem::Chain(_) => return item,
    };
    *pose = Pose::new(
        Vec3::new(x, y, pose.location.z),
        (turn * pose.rotation).normalize(),
    );
    item
}

#[cfg(test)]
mod tests {
    use tabletop_core::{ObjectSpec, Shape};
    use tabletop_geometry::Rgb;

    use super::*;

    fn scene(count: usize) -> SceneSpec {
        let block = |index: usize| {
            SceneItem::Object(ObjectSpec {
                id: format!("b{index}"),
                pose: Pose::at(Vec3::new(index as f32 * 1.5, 0.0, 0.5)),
                mass: 1.0,
                shape: Shape::Block {
                    span: Vec3::ONE,
                    color: Rgb::GRAY,
                },
                dynamics: Default::default(),
                descriptions: Vec::new(),
            })
        };
        SceneSpec {
            items: (0..count).map(block).collect(),
            ..default()
        }
    }

    fn place(object: &str, half: f32) -> RandomPlace {
        RandomPlace {
            object: object.into(),
            x: (-half, half),
            y: (-half, half),
            turn: (0.0, 360.0),
        }
    }

    #[test]
    fn placed_objects_keep_their_distance_and_height() {
        for seed in 0..50 {
            let mut scene = scene(6);
            let places = ["b0", "b1", "b2", "b3"].map(|id| place(id, 3.0));
            assert_eq!(
                place_all(&mut scene, &places, &mut Random::new(seed)),
                Ok(())
            );
            let bounds: Vec<_> = scene.items.iter().map(SceneItem::bounds).collect();
            for (index, a) in bounds.iter().enumerate() {
                assert_eq!((a.low.z, a.high.z), (0.0, 1.0));
                for b in &bounds[..index] {
                    assert!(!a.is_crowded_by(*b, CLEARANCE * 0.9), "seed {seed}");
                }
            }
        }
    }

    #[test]
    fn the_seed_decides() {
        let placed = |seed| {
            let mut scene = scene(2);
            place_all(&mut scene, &[place("b0", 5.0)], &mut Random::new(seed)).map(|()| scene)
        };
        assert_eq!(placed(7), placed(7));
        assert_ne!(placed(7), placed(8));
    }

    #[test]
    fn an_impossible_place_is_an_error() {
        let mut random = Random::new(0);
        for (id, half, words) in [("b0", 0.0, "no free place"), ("x", 1.0, "has no object")] {
            let mut scene = scene(2);
            let RandomPlace { turn, .. } = place(id, half);
            let place = RandomPlace {
                object: id.into(),
                x: (1.5 - half, 1.5 + half),
                y: (-half, half),
                turn,
            };
            let error = place_all(&mut scene, &[place], &mut random);
            assert!(error.is_err_and(|error| error.contains(words)));
        }
    }
}
