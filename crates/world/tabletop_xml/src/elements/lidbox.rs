//! The element of a box with a lid.

use bevy::math::Vec3;
use tabletop_core::LidBoxSpec;

use crate::{
    document::tree::Element, elements::ElementReader, elements::attributes::AttributeReader,
    elements::hollow::check_hollow, elements::names::DESCRIPTION, elements::simple_shape::SPANS,
    elements::value,
};

impl ElementReader<'_, '_> {
    /// Reads a box with a lid.
    pub fn lidbox(&mut self, element: &Element) -> Option<LidBoxSpec> {
        for child in &element.children {
            self.is_allowed(child, element.name, &[DESCRIPTION]);
        }
        let descriptions = self.descriptions(element);
        let mut attributes = AttributeReader::of(element, self.faults);
        let (id, pose) = (attributes.id(), attributes.pose());
        let mass = attributes.mass("mass", 1.0);
        let (box_mass, lid_mass) = match attributes.has("lidMass") {
            true => (mass, attributes.mass("lidMass", mass)),
            false => (0.9 * mass, attributes.mass("lidMass", 0.1 * mass)),
        };
        let span = attributes.spans(SPANS, Vec3::ONE);
        let handle_span = attributes.spans(
            ["handleXspan", "handleYspan", "handleZspan"],
            Vec3::splat(0.5),
        );
        let lidbox = LidBoxSpec {
            id,
            pose,
            span,
            thickness: attributes.span("thickness", 0.05),
            box_mass,
            lid_mass,
            color: attributes.color("color"),
            handle_span,
            handle_thickness: attributes
                .span("handleThickness", usual_handle_thickness(handle_span)),
            handle_color: attributes.color("handleColor"),
            descriptions,
        };
        attributes.ignore("pointable", false, value::boolean);
        check_hollow("thickness", span, lidbox.thickness, &mut attributes);
        check_hollow(
            "handleThickness",
            handle_span,
            lidbox.handle_thickness,
            &mut attributes,
        );
        attributes.finish(Some(lidbox))
    }
}

/// A third of the smaller of X and Z, or of Y where those walls would leave no hollow.
fn usual_handle_thickness(span: Vec3) -> f32 {
    let usual = span.x.min(span.z) / 3.0;
    match 2.0 * usual < span.y {
        true => usual,
        false => span.y / 3.0,
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::SceneItem;
    use tabletop_geometry::Pose;

    use super::*;
    use crate::test_support::items_of;

    #[test]
    fn a_lidbox_is_read() {
        let content = "<lidbox xspan='6' yspan='5' zspan='5' thickness='0.6' location='(0,0,2.5)' \
                       rotation='(0,0,0)' color='#3333bb' mass='10' handleXspan='1' handleYspan='2' \
                       handleZspan='0.6' handleColor='#33bb33'/>";
        let lidbox = LidBoxSpec {
            id: String::new(),
            pose: Pose::at(Vec3::Z * 2.5),
            span: Vec3::new(6.0, 5.0, 5.0),
            thickness: 0.6,
            box_mass: 9.0,
            lid_mass: 1.0,
            color: "#3333bb".parse().unwrap(),
            handle_span: Vec3::new(1.0, 2.0, 0.6),
            handle_thickness: 0.6 / 3.0,
            handle_color: "#33bb33".parse().unwrap(),
            descriptions: vec![],
        };
        assert_eq!(items_of(content), [SceneItem::LidBox(lidbox)]);
        let items =
            items_of("<lidbox location='(0,0,1)' mass='3' lidMass='.5' handleThickness='.1'/>");
        let [SceneItem::LidBox(lidbox)] = items.as_slice() else {
            panic!()
        };
        assert_eq!((lidbox.box_mass, lidbox.lid_mass), (3.0, 0.5));
        assert_eq!(
            (lidbox.handle_span, lidbox.handle_thickness),
            (Vec3::splat(0.5), 0.1)
        );
    }

    #[test]
    fn a_narrow_handle_is_hollow_too() {
        assert_eq!(usual_handle_thickness(Vec3::new(0.5, 0.4, 0.6)), 0.5 / 3.0);
        assert_eq!(usual_handle_thickness(Vec3::new(2.0, 0.3, 2.0)), 0.3 / 3.0);
        items_of("<lidbox location='(0,0,1)' handleXspan='2' handleYspan='.3' handleZspan='2'/>");
    }
}
