//! Scenes as task files.

pub(crate) mod angles;
mod bond;
mod control;
pub(crate) mod expanded;
mod markup;
mod text;

use bevy::math::Vec3;
use tabletop_core::{
    AttributeValue, ChainSpec, Composition, Dynamics, JointMotion, JointedSpec, LidBoxSpec,
    ObjectSpec, Part, SceneItem, SceneSpec, Shape,
};

use crate::{
    NAMESPACE,
    write::text::{as_attribute, as_literal},
};

/// Writes a scene as a task file, which [reads](crate::parse()) back as the same scene: numbers exactly, colours to
/// within their 8 bits a channel, rotations exactly or, if they are no [rotation of a file](tabletop_geometry::quat_from_degrees), as the nearest
/// of those: nowhere off by more than 2e-7.
///
/// Parts that a file cannot express are written as the nearest that it can: characters that ids cannot have become underscores, a
/// link that is no longer in a chain becomes a block, a lid without its box a composite of plate and handle.
/// Numbers that are not finite or out of the language's ranges are written unchanged, and do not read back.
///
/// ```
/// use std::path::Path;
/// use tabletop_core::SceneSpec;
///
/// let text = tabletop_xml::write(&SceneSpec::default());
/// let task = tabletop_xml::parse(Path::new("empty.xml"), text.as_bytes());
/// assert_eq!((task.scene, task.faults.len()), (SceneSpec::default(), 0));
/// ```
pub fn write(scene: &SceneSpec) -> String {
    let mut writer = Writer::default();
    writer
        .text
        .push_str("<?xml version=\"1.0\" encoding=\"UTF-8\"?>");
    writer.open("tabletop");
    writer.attribute("xmlns", NAMESPACE);
    writer.attribute("xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
    writer.attribute("xsi:schemaLocation", &format!("{NAMESPACE} tabletop.xsd"));
    writer.number("xspan", scene.table.xspan);
    writer.number("yspan", scene.table.yspan);
    for item in &scene.items {
        match item {
            SceneItem::Object(object) => writer.object(object),
            SceneItem::Chain(chain) => writer.chain(chain),
            SceneItem::LidBox(lidbox) => writer.lidbox(lidbox),
            SceneItem::Jointed(jointed) => writer.jointed(jointed),
        }
    }
    writer.close();
    writer.text.push('\n');
    writer.text
}

#[derive(Default)]
struct Writer {
    text: String,
    open: Vec<&'static str>,
    /// True if the innermost element is empty so far.
    is_empty: bool,
}

impl Writer {
    fn object(&mut self, object: &ObjectSpec) {
        self.open(element_name(&object.shape));
        self.id(&object.id);
        self.pose(object.pose);
        self.number("mass", object.mass);
        self.dynamics(object.dynamics);
        self.attributes_of(&object.shape);
        self.descriptions(&object.descriptions);
        self.parts_of(&object.shape);
        self.close();
    }

    fn dynamics(&mut self, dynamics: Dynamics) {
        let Dynamics {
            friction,
            restitution,
            velocity,
        } = dynamics;
        for (name, value) in [("friction", friction), ("restitution", restitution)] {
            if let Some(value) = value {
                self.number(name, value);
            }
        }
        if velocity != Vec3::ZERO {
            self.vector("linearVelocity", velocity);
        }
    }

    fn part(&mut self, part: &Part) {
        self.part_in_state(part, &mut std::iter::empty());
    }

    /// Writes a part, and the states to which triggering its simple parts leads.
    pub(super) fn part_in_state(
        &mut self,
        part: &Part,
        next: &mut dyn Iterator<Item = Option<u32>>,
    ) {
        self.open(element_name(&part.shape));
        self.id(&part.id);
        self.pose(part.pose);
        if part.pointable {
            self.attribute("pointable", "true");
        }
        self.attributes_of(&part.shape);
        if let Shape::Composite { parts } = &part.shape {
            for part in parts {
                self.part_in_state(part, next);
            }
        } else {
            if let Some(next) = next.next().flatten() {
                self.attribute("nextStateWhenTriggered", &next.to_string());
            }
            self.parts_of(&part.shape);
        }
        self.close();
    }

    fn parts_of(&mut self, shape: &Shape) {
        match shape.composition() {
            Composition::Simple => {}
            Composition::Parts(parts) => parts.iter().for_each(|part| self.part(part)),
            Composition::Lid(parts) => parts.iter().for_each(|part| self.part(part)),
            Composition::Control(control) => self.content_of_control(control),
            Composition::BondPoint(point) => self.steps_of(point),
        }
    }

    fn attributes_of(&mut self, shape: &Shape) {
        match shape.composition() {
            Composition::Simple => {
                for (name, value) in shape.attributes() {
                    match value {
                        AttributeValue::Number(number) => self.number(name, number),
                        AttributeValue::Count(count) => self.attribute(name, &count.to_string()),
                        AttributeValue::Text(text) => {
                            self.attribute(name, &as_attribute(&as_literal(text)));
                        }
                        AttributeValue::Color(color) => self.color(name, color),
                    }
                }
            }
            Composition::Control(control) => self.attributes_of_control(control),
            Composition::BondPoint(point) => self.attributes_of_bond_point(point),
            Composition::Parts(_) | Composition::Lid(_) => {}
        }
    }

    fn chain(&mut self, chain: &ChainSpec) {
        self.open("chain");
        self.id(&chain.id);
        self.vector("start", chain.start);
        self.vector("end", chain.end);
        self.spans(["linkXspan", "linkYspan", "linkZspan"], chain.link_span);
        self.attribute("linkCount", &chain.link_count.to_string());
        self.number("linkPadding", chain.link_padding);
        self.number("linkMass", chain.link_mass);
        self.color("color", chain.color);
        self.close();
    }

    fn lidbox(&mut self, lidbox: &LidBoxSpec) {
        self.open("lidbox");
        self.id(&lidbox.id);
        self.pose(lidbox.pose);
        self.number("mass", lidbox.box_mass);
        self.number("lidMass", lidbox.lid_mass);
        self.spans(["xspan", "yspan", "zspan"], lidbox.span);
        self.number("thickness", lidbox.thickness);
        self.color("color", lidbox.color);
        self.spans(
            ["handleXspan", "handleYspan", "handleZspan"],
            lidbox.handle_span,
        );
        self.number("handleThickness", lidbox.handle_thickness);
        self.color("handleColor", lidbox.handle_color);
        self.descriptions(&lidbox.descriptions);
        self.close();
    }

    /// Writes a push button; its housing follows from its cap.
    fn push_button(&mut self, button: &JointedSpec) {
        let [housing, cap] = &button.objects;
        self.open("pushButton");
        self.id(&cap.id);
        self.pose(button.pose);
        self.number("mass", housing.mass);
        self.number("init", button.init);
        self.attributes_of(&cap.shape);
        self.descriptions(&cap.descriptions);
        self.parts_of(&cap.shape);
        self.close();
    }

    fn jointed(&mut self, jointed: &JointedSpec) {
        self.open(match jointed.motion {
            JointMotion::Press => return self.push_button(jointed),
            JointMotion::Slide => "sliderJoint",
            JointMotion::Turn => "hingeJoint",
            JointMotion::Shear => "scissors",
        });
        self.pose(jointed.pose);
        let [min, max] = jointed.limits;
        self.number("min", min);
        self.number("max", max);
        self.number("init", jointed.init);
        match jointed.motion {
            JointMotion::Slide | JointMotion::Turn => {
                self.attribute("collision", &jointed.collides.to_string());
                self.number("damping", jointed.damping);
            }
            JointMotion::Shear | JointMotion::Press => {}
        }
        for object in &jointed.objects {
            self.object(object);
        }
        self.close();
    }
}

fn element_name(shape: &Shape) -> &'static str {
    if let Shape::Lid { .. } = shape {
        "composite"
    } else {
        shape.name()
    }
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::{Pose, Rgb};

    use super::*;
    use crate::test_support::scene_of;

    fn read_back(scene: &SceneSpec) -> SceneSpec {
        let task = crate::parse("f".as_ref(), write(scene).as_bytes());
        assert_eq!(task.faults, []);
        task.scene
    }

    #[test]
    fn every_element_reads_back() {
        let scene = scene_of(
            "xspan='7'",
            "<block id='b' location='(1,2,3)' mass='0' color='pink'><description name='a' \
             value='&#9;&lt;&quot;&amp;é&#10;&#13;'/></block>\
             <composite location='(0,0,9)'><description name='a' value=''/><cylinder location='(0,0,0)'/>\
             <composite id='c' location='(0,1,0)'><sphere location='(0,0,0)' color='#010203'/>\
             <box location='(0,1,0)'/></composite></composite>\
             <chain start='(0,0,1)' end='(5,0,1)'/>\
             <lidbox location='(0,0,1)' mass='3'><description name='d' value='e'/></lidbox>\
             <toggleSwitch id='s' location='(0,0,1)' mass='0' numStates='3' initState='2' leftPressed='false' \
             angle='9'><description name='d' value='e'/><downstream id='l'/><downstream id='c'/></toggleSwitch>\
             <composite location='(5,0,1)'><indicatorLights id='l' location='(0,0,1)' numLights='3' pointable='true'>\
             <state/><state descriptionName='on'><light id='2' color='green'/><light id='0'/></state></indicatorLights>\
             <hostBondPoint id='h' type='nut' downstream='s' downstreamOverride='l' downstreamLock='k'>\
             <tightness/><tightness location='(0,0,-.5)' rotation='(0,0,90)' downstreamState='1' downstreamLock='true'/>\
             </hostBondPoint><guestBondPoint location='(0,0,2)' type='nut' initBondHostId='h' initBondTightness='2'/>\
             </composite>\
             <customControl id='c' location='(0,0,1)' name='dial' initState='1'><state/><state descriptionName='two'>\
             <recolor id='b' color='pink'/><remove id='b'/><spawn><sphere id='n' location='(0,0,3)'/></spawn>\
             <block location='(0,0,0)' nextStateWhenTriggered='0'/><composite location='(1,0,0)' nextStateWhenTriggered='1'>\
             <sphere location='(0,0,0)'/><box location='(0,0,1)' nextStateWhenTriggered='0'/></composite></state></customControl>",
        );
        assert_eq!(scene.items.len(), 7);
        assert_eq!(read_back(&scene), scene);
    }

    #[test]
    fn inexpressible_values_are_written_as_the_nearest() {
        let object = |id: &str, shape| {
            SceneItem::Object(ObjectSpec {
                id: id.into(),
                pose: Pose::IDENTITY,
                mass: 1.0,
                shape,
                dynamics: Dynamics::default(),
                descriptions: vec![("a b".into(), "\0".into())],
            })
        };
        let link = Shape::Link {
            span: Vec3::ONE,
            padding: 0.5,
            color: Rgb::GRAY,
        };
        let lid = Shape::Lid {
            span: Vec3::ONE,
            color: Rgb::BLACK,
            handle_span: Vec3::ONE,
            handle_thickness: 0.1,
            handle_color: Rgb::WHITE,
        };
        let scene = SceneSpec {
            items: vec![object("c-link#0", link), object("l", lid.clone())],
            ..Default::default()
        };
        let items = read_back(&scene).items;
        let [SceneItem::Object(link), SceneItem::Object(read_lid)] = items.as_slice() else {
            panic!("{items:?}");
        };
        assert_eq!(link.id, "c_link_0");
        assert_eq!(
            link.descriptions,
            [("a_b".to_owned(), "\u{fffd}".to_owned())]
        );
        assert_eq!(link.shape.name(), "block");
        assert_eq!(read_lid.shape.colliding(), lid.colliding());
    }
}
