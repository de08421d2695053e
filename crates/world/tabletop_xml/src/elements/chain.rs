//! The element of a chain.

use bevy::math::Vec3;
use tabletop_core::ChainSpec;

use crate::{
    document::tree::Element,
    elements::ElementReader,
    elements::attributes::AttributeReader,
    elements::value::{self, LINK_COUNTS, PADDINGS},
};

impl ElementReader<'_, '_> {
    /// Reads a chain.
    pub fn chain(&mut self, element: &Element) -> Option<ChainSpec> {
        self.forbid_children(element);
        let mut attributes = AttributeReader::of(element, self.faults);
        let chain = ChainSpec {
            id: attributes.id(),
            start: attributes.location("start"),
            end: attributes.location("end"),
            link_span: attributes.spans(
                ["linkXspan", "linkYspan", "linkZspan"],
                Vec3::new(0.1, 1.0, 0.1),
            ),
            link_count: attributes.read("linkCount", 0, |text| value::count(text, &LINK_COUNTS)),
            link_padding: attributes.number("linkPadding", 0.05, &PADDINGS),
            link_mass: attributes.mass("linkMass", 1.0),
            color: attributes.color("color"),
        };
        if attributes.is_sound() {
            check_links(&chain, &mut attributes);
        }
        attributes.finish(Some(chain))
    }
}

/// Notes a fault where the links of a chain cannot reach from its start to its end.
fn check_links(chain: &ChainSpec, attributes: &mut AttributeReader) {
    let (least, most) = (chain.least_links(), *LINK_COUNTS.end());
    let least_distance = *value::SPANS.start();
    if chain.start.distance(chain.end) < least_distance {
        let expected = format_args!("a location at least {least_distance} away");
        attributes.fault("end", "it is where the chain starts", expected);
    } else if least.max(chain.links()) > most {
        let problem = format_args!("the distance needs {} links", chain.links().max(least));
        attributes.fault("linkYspan", problem, format_args!("at most {most} links"));
    } else if chain.link_count > 0 && chain.link_count < least {
        let problem = format_args!("{} links do not reach from start to end", chain.link_count);
        attributes.fault("linkCount", problem, format_args!("at least {least}"));
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::SceneItem;
    use tabletop_geometry::Rgb;

    use super::*;
    use crate::test_support::{items_of, lines_of};

    #[test]
    fn a_chain_is_read() {
        let content = "<chain color='magenta' start='(6,-2,4)' end='(-6,-2,4)' linkCount='12'/>";
        let chain = ChainSpec {
            id: String::new(),
            start: Vec3::new(6.0, -2.0, 4.0),
            end: Vec3::new(-6.0, -2.0, 4.0),
            link_span: Vec3::new(0.1, 1.0, 0.1),
            link_count: 12,
            link_padding: 0.05,
            link_mass: 1.0,
            color: Rgb::new(1.0, 0.0, 1.0),
        };
        assert_eq!(items_of(content), [SceneItem::Chain(chain)]);
        let content = "<chain id='c' start='(0,0,1)' end='(0,5,1)' linkXspan='.2' linkYspan='.5' \
                       linkZspan='.3' linkPadding='0' linkMass='.1'/>";
        let items = items_of(content);
        let [SceneItem::Chain(chain)] = items.as_slice() else {
            panic!()
        };
        assert_eq!(chain.link_span, Vec3::new(0.2, 0.5, 0.3));
        assert_eq!(
            (chain.links(), chain.link_padding, chain.link_mass),
            (10, 0.0, 0.1)
        );
    }

    #[test]
    fn a_chain_must_reach() {
        for (attributes, fault) in [
            (
                "start='(0,0,1)' end='(0,0,1)'",
                "end: it is where the chain starts, expected a location at least 0.001 away",
            ),
            (
                "start='(0,0,1)' end='(9,0,1)' linkCount='8'",
                "linkCount: 8 links do not reach from start to end, expected at least 9",
            ),
            (
                "start='(0,0,1)' end='(9,0,1)' linkYspan='.001'",
                "linkYspan: the distance needs 9000 links, expected at most 1000 links",
            ),
            (
                "end='(9,0,1)'",
                "start: it is missing, expected start=\"(x,y,z)\"",
            ),
            (
                "start='(0,0,1)' end='(9,0,1)' linkPadding='-1'",
                "linkPadding: `-1` is out of range, expected a number from 0 to 1000",
            ),
        ] {
            assert_eq!(
                lines_of(&format!("<chain {attributes}/>")),
                [format!("chain, {fault}")]
            );
        }
    }
}
