//! Chains: links and two fixed ends, joined by ball joints.

use bevy::prelude::*;
use tabletop_core::{ChainSpec, JointKind, JointSpec, ObjectSpec, Shape};
use tabletop_geometry::{Pose, Rgb};

use crate::ids::IdAllocator;

/// Edge of the fixed cube at each end, in units.
const END_SPAN: f32 = 0.1;

/// Distance of the first and last joint from the centre of the cube at that end, in units.
const END_PIVOT: f32 = 0.1;

/// The objects and joints of a chain, from its start on.
pub(super) fn build(spec: &ChainSpec, ids: &mut IdAllocator) -> (Vec<ObjectSpec>, Vec<JointSpec>) {
    let (mut objects, mut joints) = (Vec::new(), Vec::new());
    let id = ids.unique(&spec.id);
    let along = (spec.end - spec.start).normalize_or(Vec3::Y);
    let half_link = Vec3::Y * spec.link_span.y / 2.0;
    let mut add = |suffix: &str, pose, mass, shape| {
        let id = ids.unique(&format!("{id}-{suffix}"));
        let object = ObjectSpec::new(&id, pose, mass, shape);
        objects.push(object);
        id
    };
    let end_cube = Shape::Block {
        span: Vec3::splat(END_SPAN),
        color: Rgb::WHITE,
    };
    let mut joint = |first: &str, pivot, second: &str, second_pivot| {
        joints.push(JointSpec {
            objects: [first.to_owned(), second.to_owned()],
            frames: [Pose::at(pivot), Pose::at(second_pivot)],
            kind: JointKind::Ball,
            collides: false,
        });
    };

    let mut previous = add("start", Pose::at(spec.start), 0.0, end_cube.clone());
    let mut pivot = along * END_PIVOT;
    for link in 0..spec.links() {
        let shape = Shape::Link {
            span: spec.link_span,
            padding: spec.link_padding,
            color: spec.color,
        };
        let id = add(
            &format!("link{link}"),
            spec.link_pose(link),
            spec.link_mass,
            shape,
        );
        joint(&previous, pivot, &id, -half_link);
        previous = id;
        pivot = half_link;
    }
    let end = add("end", Pose::at(spec.end), 0.0, end_cube);
    joint(&end, -along * END_PIVOT, &previous, pivot);
    (objects, joints)
}

#[cfg(test)]
mod tests {
    use tabletop_core::{SceneItem, SceneSpec};

    use super::*;
    use crate::{Assembly, assemble};

    fn chain(link_count: u32) -> Assembly {
        let spec = ChainSpec {
            id: "c".into(),
            start: Vec3::new(6.0, -2.0, 4.0),
            end: Vec3::new(-6.0, -2.0, 4.0),
            link_span: Vec3::new(0.1, 1.0, 0.1),
            link_count,
            link_padding: 0.05,
            link_mass: 1.0,
            color: Rgb::GRAY,
        };
        let scene = SceneSpec {
            items: vec![SceneItem::Chain(spec)],
            ..default()
        };
        assemble(&scene, &mut IdAllocator::default())
    }

    #[test]
    fn links_stand_in_a_row_from_start_to_end() {
        let chain = chain(12);
        let ids: Vec<_> = chain.objects.iter().map(|object| &*object.id).collect();
        assert_eq!(ids.len(), 14);
        assert_eq!(ids[..2], ["c-start", "c-link0"]);
        assert_eq!(ids[12..], ["c-link11", "c-end"]);
        let first = &chain.objects[1].pose;
        assert!((first.location - Vec3::new(5.5, -2.0, 4.0)).length() < 1e-5);
        assert!((first.rotation * Vec3::Y - Vec3::NEG_X).length() < 1e-5);
    }

    #[test]
    fn every_link_is_joined_to_both_neighbours() {
        let chain = chain(0);
        assert_eq!(chain.joints.len(), 13);
        for pair in chain.joints.windows(2) {
            let shared = pair[0]
                .objects
                .iter()
                .filter(|id| pair[1].objects.contains(id));
            assert_eq!(shared.count(), 1);
        }
    }
}
