//! The elements of joints.

use tabletop_core::{JointMotion, JointedSpec, ObjectSpec};

use crate::{
    document::tree::Element,
    elements::{
        ElementReader,
        attributes::AttributeReader,
        blades::blades,
        names::OBJECTS,
        value::{self, ANGLES, DISPLACEMENTS, PROPORTIONS},
    },
};

impl ElementReader<'_, '_> {
    /// Reads two objects that slide or turn against each other.
    pub fn jointed(&mut self, element: &Element, motion: JointMotion) -> Option<JointedSpec> {
        let objects = self.jointed_objects(element);
        let mut attributes = AttributeReader::of(element, self.faults);
        let _has_no_effect = attributes.id();
        let pose = attributes.pose();
        let (range, greatest) = match motion {
            JointMotion::Slide | JointMotion::Press => (DISPLACEMENTS, 1.0),
            JointMotion::Turn | JointMotion::Shear => (ANGLES, 90.0),
        };
        let min = attributes.number("min", 0.0, &range);
        let max = attributes.number("max", greatest, &range);
        let init = attributes.number("init", 0.0, &range);
        let collides = attributes.read("collision", false, value::boolean);
        let damping = attributes.number("damping", 0.0, &PROPORTIONS);
        let softness = attributes.number("softness", 1.0, &PROPORTIONS);
        attributes.ignore("restitution", 0.7, |text| value::number(text, &PROPORTIONS));
        if attributes.is_sound() && min > max {
            let problem = format_args!("{min} is more than the maximum");
            attributes.fault("min", problem, format_args!("at most {max}"));
        }
        attributes.finish(objects.map(|objects| JointedSpec {
            pose,
            objects,
            motion,
            limits: [min, max],
            init: init.max(min).min(max),
            collides,
            damping: damping * softness,
        }))
    }

    /// Reads a pair of scissors: two blades on a hinge, or two objects that replace them.
    pub fn scissors(&mut self, element: &Element) -> Option<JointedSpec> {
        let objects = match element.children.is_empty() {
            true => None,
            false => Some(self.jointed_objects(element)?),
        };
        let mut attributes = AttributeReader::of(element, self.faults);
        let id = attributes.id();
        let pose = attributes.pose();
        let min = attributes.number("min", 0.0, &ANGLES);
        let max = attributes.number("max", 40.0, &ANGLES);
        let init = attributes.number("init", max, &ANGLES);
        let own = objects.unwrap_or_else(|| {
            let length = attributes.span("length", 1.5);
            let mass = attributes.mass("mass", 0.2);
            blades(&id, length, mass, attributes.color("color"))
        });
        if attributes.is_sound() && min > max {
            let problem = format_args!("{min} is more than the maximum");
            attributes.fault("min", problem, format_args!("at most {max}"));
        }
        attributes.finish(Some(JointedSpec {
            pose,
            objects: own,
            motion: JointMotion::Shear,
            limits: [min, max],
            init: init.max(min).min(max),
            collides: false,
            damping: 0.0,
        }))
    }

    /// The two objects in a joint; `None` unless there are two without a fault.
    fn jointed_objects(&mut self, element: &Element) -> Option<[ObjectSpec; 2]> {
        let mut objects = Vec::new();
        let mut is_faulty = false;
        for child in &element.children {
            let object = match self.is_allowed(child, element.name, &OBJECTS) {
                true => self.object(child),
                false => None,
            };
            is_faulty |= object.is_none();
            objects.extend(object);
        }
        if !is_faulty && objects.len() != 2 && !element.is_broken {
            let problem = format_args!("it has {} objects", objects.len());
            self.faults.report(element.place(), problem, "two objects");
        }
        objects.try_into().ok().filter(|_| !is_faulty)
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::SceneItem;
    use tabletop_geometry::Pose;

    use super::*;
    use crate::test_support::{items_of, lines_of};

    const OBJECTS: &str =
        "<block id='a' location='(0,0,-1)' mass='0'/><sphere id='b' location='(0,0,1)'/>";

    fn only_joint(content: &str) -> JointedSpec {
        match items_of(content).as_slice() {
            [SceneItem::Jointed(joint)] => joint.clone(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn joints_have_the_defaults_of_the_later_program() {
        let slider = only_joint(&format!(
            "<sliderJoint location='(0,0,2)'>{OBJECTS}</sliderJoint>"
        ));
        assert_eq!(slider.pose, Pose::at(Vec3::Z * 2.0));
        assert_eq!(slider.motion, JointMotion::Slide);
        assert_eq!((slider.limits, slider.init), ([0.0, 1.0], 0.0));
        assert_eq!((slider.collides, slider.damping), (false, 0.0));
        let ids = slider.objects.map(|object| object.id);
        assert_eq!(ids, ["a", "b"]);
        let hinge = only_joint(&format!(
            "<hingeJoint location='(0,0,2)'>{OBJECTS}</hingeJoint>"
        ));
        assert_eq!(hinge.motion, JointMotion::Turn);
        assert_eq!(hinge.limits, [0.0, 90.0]);
    }

    #[test]
    fn joints_have_the_attributes_of_the_later_program() {
        let slider = only_joint(&format!(
            "<sliderJoint id='j' location='(0,0,2)' rotation='(0,0,90)' min='-1' max='4' init='9' \
             collision='true' damping='.5' softness='.5' restitution='.2'>{OBJECTS}</sliderJoint>"
        ));
        assert_eq!((slider.limits, slider.init), ([-1.0, 4.0], 4.0));
        assert_eq!((slider.collides, slider.damping), (true, 0.25));
        let hinge = only_joint(&format!(
            "<hingeJoint location='(0,0,2)' min='-30' max='30' init='-45'>{OBJECTS}</hingeJoint>"
        ));
        assert_eq!(hinge.init, -30.0);
    }

    #[test]
    fn scissors_have_blades_of_their_own_or_two_objects() {
        let shears = only_joint("<scissors id='S' location='(0,0,2)' length='2' mass='.5'/>");
        assert_eq!(shears.motion, JointMotion::Shear);
        assert_eq!((shears.limits, shears.init), ([0.0, 40.0], 40.0));
        let blades = shears
            .objects
            .each_ref()
            .map(|blade| (blade.id.as_str(), blade.mass));
        assert_eq!(blades, [("S_lower", 0.25), ("S_upper", 0.25)]);
        let own = only_joint(&format!(
            "<scissors location='(0,0,2)' max='60' init='5'>{OBJECTS}</scissors>"
        ));
        assert_eq!((own.limits, own.init), ([0.0, 60.0], 5.0));
        assert_eq!(own.objects.map(|object| object.id), ["a", "b"]);
        assert_eq!(
            lines_of("<scissors location='(0,0,2)'><sphere location='(0,0,1)'/></scissors>"),
            ["scissors: it has 1 objects, expected two objects"]
        );
    }

    #[test]
    fn joints_hold_two_objects() {
        for (content, fault) in [
            (
                "<sphere location='(0,0,1)'/>",
                "sliderJoint: it has 1 objects, expected two objects",
            ),
            ("", "sliderJoint: it has 0 objects, expected two objects"),
            (
                "<sphere location='(0,0,1)'/><sphere/>",
                "sphere, location: it is missing, expected location=\"(x,y,z)\"",
            ),
        ] {
            let content = format!("<sliderJoint location='(0,0,2)'>{content}</sliderJoint>");
            assert_eq!(lines_of(&content), [fault], "{content}");
        }
        let three = format!("<hingeJoint location='(0,0,2)'>{OBJECTS}{OBJECTS}</hingeJoint>");
        assert_eq!(
            lines_of(&three),
            ["hingeJoint: it has 4 objects, expected two objects"]
        );
        let chain = format!(
            "<hingeJoint location='(0,0,2)'>{OBJECTS}<chain start='(0,0,1)' end='(1,0,1)'/></hingeJoint>"
        );
        assert!(lines_of(&chain)[0].starts_with("chain: it cannot stand in <hingeJoint>"));
        let crossed = format!("<sliderJoint location='(0,0,2)' min='2'>{OBJECTS}</sliderJoint>");
        assert_eq!(
            lines_of(&crossed),
            ["sliderJoint, min: 2 is more than the maximum, expected at most 1"]
        );
    }
}
