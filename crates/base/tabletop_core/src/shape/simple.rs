//! The simple shapes of which a shape consists.

use tabletop_geometry::Pose;

use crate::{Control, Part, Shape, shape::Composition};

impl Shape {
    /// The simple shapes that can be seen of it: all but composites and lids. They come in the order of the task file, each with its pose in
    /// the frame of this shape.
    pub fn simple_parts(&self) -> Vec<Part> {
        self.simple_parts_with(Control::seen)
    }

    /// The simple shapes that can be touched, some of which may be invisible.
    pub(crate) fn simple_touched(&self) -> Vec<Part> {
        self.simple_parts_with(Control::touched)
    }

    fn simple_parts_with(&self, of_control: fn(&Control) -> Vec<Part>) -> Vec<Part> {
        fn collect(
            id: &str,
            pose: Pose,
            shape: &Shape,
            of_control: fn(&Control) -> Vec<Part>,
            simple: &mut Vec<Part>,
        ) {
            let mut collect_all = |parts: &[Part]| {
                for part in parts {
                    let pose = pose * part.pose;
                    collect(&part.id, pose, &part.shape, of_control, simple);
                }
            };
            match shape.composition() {
                Composition::Simple => simple.push(Part::new(id, pose, shape.clone())),
                Composition::Parts(parts) => collect_all(parts),
                Composition::Lid(parts) => {
                    collect_all(&(*parts).map(|part| Part {
                        id: id.to_owned(),
                        ..part
                    }));
                }
                Composition::Control(control) => collect_all(&of_control(control)),
                Composition::BondPoint(_) => {}
            }
        }
        let mut simple = Vec::new();
        collect("", Pose::IDENTITY, self, of_control, &mut simple);
        simple
    }
}

#[cfg(test)]
mod tests {
    use bevy::prelude::*;

    use super::*;
    use tabletop_geometry::Rgb;

    #[test]
    fn poses_of_nested_parts_compose() {
        let block = Shape::Block {
            span: Vec3::ONE,
            color: Rgb::GRAY,
        };
        let inner = Shape::Composite {
            parts: vec![Part {
                pointable: false,
                id: "inner".into(),
                pose: Pose::at(Vec3::X),
                shape: block,
            }],
        };
        let shape = Shape::Composite {
            parts: vec![Part {
                id: String::new(),
                pose: Pose::from_degrees(Vec3::Z, Vec3::new(0.0, 0.0, 90.0)),
                shape: inner,
                pointable: false,
            }],
        };
        let [part] = &shape.simple_parts()[..] else {
            panic!("{:?}", shape.simple_parts());
        };
        assert_eq!(part.id, "inner");
        assert!((part.pose.location - Vec3::new(0.0, 1.0, 1.0)).length() < 1e-6);
    }
}
