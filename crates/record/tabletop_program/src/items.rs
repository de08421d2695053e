//! The scene of a table: what stands in a task file that puts its objects and joints there.

use tabletop_core::{
    JointKind, JointMotion, JointSpec, JointedSpec, ObjectSpec, SceneItem, SceneSpec,
};

use crate::scene::TableScene;

impl TableScene {
    /// The scene with these objects where they are. Lids and drawers, which are all that programs know of joints, are sliders; of other joints only the
    /// objects are there.
    pub fn items(&self) -> SceneSpec {
        let jointed: Vec<_> = self
            .joints
            .iter()
            .filter_map(|joint| jointed(self, joint))
            .collect();
        let is_alone = |object: &&ObjectSpec| {
            let mut parts = jointed.iter().flat_map(|joint| &joint.objects);
            parts.all(|part| part.id != object.id)
        };
        let alone: Vec<_> = self.objects.iter().filter(is_alone).cloned().collect();
        SceneSpec {
            table: self.table,
            items: jointed
                .into_iter()
                .map(SceneItem::Jointed)
                .chain(alone.into_iter().map(SceneItem::Object))
                .collect(),
        }
    }
}

/// A slider as it stands in a task file. `None` for other joints.
fn jointed(table: &TableScene, joint: &JointSpec) -> Option<JointedSpec> {
    let JointKind::Slider {
        min, max, damping, ..
    } = joint.kind
    else {
        return None;
    };
    let [holder, part] = joint.objects.each_ref().map(|id| table.object(id).cloned());
    let (mut holder, mut part) = (holder?, part?);
    let pose = holder.pose * joint.frames[0];
    let moved = pose.inverse() * part.pose * joint.frames[1];
    (holder.pose, part.pose) = (joint.frames[0].inverse(), joint.frames[1].inverse());
    Some(JointedSpec {
        pose,
        objects: [holder, part],
        motion: JointMotion::Slide,
        limits: [min, max],
        init: (-moved.location.x).clamp(min, max),
        collides: joint.collides,
        damping,
    })
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::Shape;
    use tabletop_geometry::{Pose, Rgb};

    use super::*;

    #[test]
    fn what_slides_stays_where_it_is() {
        let block = |id: &str, at: Vec3| {
            let shape = Shape::Block {
                span: Vec3::ONE,
                color: Rgb::RED,
            };
            ObjectSpec::new(id, Pose::at(at), 1.0, shape)
        };
        let objects = vec![
            block("Alone", Vec3::new(4.0, 0.0, 0.5)),
            block("Chest", Vec3::new(0.0, 1.0, 0.5)),
            block("Lid", Vec3::new(-0.7, 1.0, 1.5)),
        ];
        let joint = JointSpec {
            objects: ["Chest".into(), "Lid".into()],
            frames: [Pose::at(Vec3::Z * 0.5), Pose::at(Vec3::NEG_Z * 0.5)],
            kind: JointKind::Slider {
                min: 0.0,
                max: 1.0,
                friction: 0.0,
                damping: 0.0,
            },
            collides: false,
        };
        let table = TableScene {
            objects: objects.clone(),
            joints: vec![joint.clone()],
            ..TableScene::default()
        };
        let scene = table.items();
        let [SceneItem::Jointed(slider), SceneItem::Object(alone)] = &scene.items[..] else {
            panic!("{scene:?}");
        };
        assert_eq!(alone.id, "Alone");
        assert!((slider.init - 0.7).abs() < 1e-5, "{}", slider.init);
        for (placed, object) in slider.placed().iter().zip(&objects[1..]) {
            assert_eq!(placed.id, object.id);
            assert!(placed.pose.location.distance(object.pose.location) < 1e-5);
        }
        for (made, frame) in slider.frames().iter().zip(joint.frames) {
            assert!(made.location.distance(frame.location) < 1e-5);
        }
    }
}
