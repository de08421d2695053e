//! The element of push buttons.

use tabletop_core::{JointedSpec, PressMode, PushButton, Shape};
use tabletop_geometry::Rgb;

use crate::{
    document::tree::Element,
    elements::{
        ElementReader,
        attributes::AttributeReader,
        role::ObjectRole,
        value::{self, DISPLACEMENTS, PRESSED_STATES, PRESSING_FORCES, TRAVELS, ValueError},
    },
};

/// The id of a button without one: that of its housing is made of it.
const ID: &str = "button";
/// The least height of a housing where nothing is said.
const ZSPAN: f32 = 0.2;

impl ElementReader<'_, '_> {
    /// Reads a push button: a housing and its cap.
    pub fn push_button(&mut self, element: &Element) -> Option<JointedSpec> {
        let descriptions = self.descriptions(element);
        let (content, is_sound) = self.control_content(element, ObjectRole::Whole);
        let mut attributes = AttributeReader::of(element, self.faults);
        let id = Some(attributes.id()).filter(|id| !id.is_empty());
        let pose = attributes.pose();
        let mass = attributes.mass("mass", 1.0);
        attributes.ignore("pointable", false, value::boolean);
        let radius = attributes.span("radius", 0.3);
        let travel = attributes.number("travel", 0.1, &TRAVELS);
        let least = PushButton::least_zspan(travel);
        let zspan = attributes.span("zspan", ZSPAN.max(least));
        let button = PushButton {
            radius,
            zspan,
            travel,
            force: attributes.number("force", 5.0, &PRESSING_FORCES),
            color: attributes.read("color", Rgb::RED, value::color),
            mode: attributes.read("mode", PressMode::Once, mode),
            state: attributes.read("state", 1, |text| value::count(text, &PRESSED_STATES)),
        };
        let init = attributes.number("init", 0.0, &DISPLACEMENTS);
        if attributes.is_sound() && zspan < least {
            let problem = format_args!("{zspan} leaves no room for the cap");
            attributes.fault("zspan", problem, format_args!("at least {least}"));
        }
        let init = init.clamp(0.0, travel);
        let mut jointed = button.jointed(id.as_deref().unwrap_or(ID), pose, mass, init);
        let cap = &mut jointed.objects[1];
        cap.descriptions = descriptions;
        if let Shape::Control(control) = &mut cap.shape {
            control.downstream = content.downstream;
        }
        attributes.finish(Some(jointed).filter(|_| is_sound))
    }
}

fn mode(text: &str) -> Result<PressMode, ValueError> {
    match value::trim(text) {
        "once" => Ok(PressMode::Once),
        "held" => Ok(PressMode::Held),
        _ => Err(ValueError::new(text, "is no mode", "once or held")),
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::SceneItem;
    use tabletop_geometry::Pose;

    use super::*;
    use crate::test_support::{items_of, lines_of, scene_of};

    fn only_button(content: &str) -> JointedSpec {
        match items_of(content).as_slice() {
            [SceneItem::Jointed(joint)] => joint.clone(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_button_has_defaults_and_its_attributes() {
        let plain = only_button("<pushButton location='(0,0,2)'/>");
        assert_eq!(plain.pose, Pose::at(Vec3::Z * 2.0));
        let ids = plain.objects.each_ref().map(|object| object.id.as_str());
        assert_eq!(ids, ["button_housing", "button"]);
        let (control, button) = plain.push_button().unwrap();
        let expected = PushButton {
            radius: 0.3,
            zspan: 0.2,
            travel: 0.1,
            force: 5.0,
            color: Rgb::RED,
            mode: PressMode::Once,
            state: 1,
        };
        assert_eq!((control.state, button), (0, &expected));
        assert_eq!(plain.objects[0].mass, 1.0);

        let all = only_button(
            "<pushButton id='stop' location='(0,0,2)' mass='0' radius='.5' zspan='1' travel='.4' \
             force='20' color='green' mode='held' state='3' init='.4' pointable='true'>\
             <description name='use' value='stopping'/><downstream id='lights'/></pushButton>",
        );
        let (control, button) = all.push_button().unwrap();
        let expected = PushButton {
            radius: 0.5,
            zspan: 1.0,
            travel: 0.4,
            force: 20.0,
            color: Rgb::GREEN,
            mode: PressMode::Held,
            state: 3,
        };
        assert_eq!((control.state, button), (3, &expected));
        assert_eq!(control.downstream, ["lights"]);
        let [housing, cap] = &all.objects;
        assert_eq!(cap.descriptions, [("use".into(), "stopping".into())]);
        assert_eq!((&*housing.id, housing.mass), ("stop_housing", 0.0));
    }

    #[test]
    fn a_housing_is_as_high_as_its_cap_needs_where_nothing_is_said() {
        let button = only_button("<pushButton location='(0,0,2)' travel='.4'/>");
        assert_eq!(button.push_button().unwrap().1.zspan, 0.7);
    }

    #[test]
    fn a_button_is_written_as_it_is_read() {
        let scene = scene_of(
            "",
            "<pushButton id='stop' location='(1,2,3)' rotation='(10,20,30)' mass='0' radius='.5' zspan='1' travel='.4' \
             force='20' color='green' mode='held' state='3' init='.3'>\
             <description name='use' value='stopping'/><downstream id='lights'/></pushButton>\
             <pushButton location='(0,0,2)'/>",
        );
        let text = crate::write(&scene);
        let task = crate::parse("written.xml".as_ref(), text.as_bytes());
        assert_eq!((task.scene, task.faults), (scene, vec![]), "{text}");
    }

    #[test]
    fn faults_have_their_places() {
        for (content, fault) in [
            (
                "<pushButton/>",
                "pushButton, location: it is missing, expected location=\"(x,y,z)\"",
            ),
            (
                "<pushButton location='(0,0,1)' mode='twice'/>",
                "pushButton, mode: `twice` is no mode, expected once or held",
            ),
            (
                "<pushButton location='(0,0,1)' state='0'/>",
                "pushButton, state: `0` is out of range, expected a whole number from 1 to 999",
            ),
            (
                "<pushButton location='(0,0,1)' force='0'/>",
                "pushButton, force: `0` is out of range, expected a number from 0.1 to 1000",
            ),
            (
                "<pushButton location='(0,0,1)' zspan='.1' travel='.2'/>",
                "pushButton, zspan: 0.1 leaves no room for the cap, expected at least 0.35",
            ),
            (
                "<pushButton location='(0,0,1)'><state/></pushButton>",
                "state: it cannot stand in <pushButton>, expected one of downstream, description",
            ),
            (
                "<composite location='(0,0,1)'><block location='(0,0,0)'/><pushButton location='(0,0,1)'/></composite>",
                "pushButton: it cannot stand in <composite>, expected one of block, cylinder, frustum, ring, sphere, box, custom, composite, toggleSwitch, indicatorLights, customControl, guestBondPoint, hostBondPoint, description",
            ),
        ] {
            assert_eq!(lines_of(content), [fault], "{content}");
        }
    }
}
