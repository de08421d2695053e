//! Elements of the task file language as what they stand for (report section 6.2).

use bevy::math::Vec3;
use tabletop_core::{ChainSpec, LidBoxSpec, ObjectSpec, Part, SceneItem, SceneSpec, Shape, Table};

use crate::{
    NAMESPACE,
    attributes::AttributeReader,
    fault::{Excerpt, Faults},
    suggestion::nearest,
    tree::{Element, Namespace},
    value::{self, LINK_COUNTS, PADDINGS, SIDES},
};

const ROOT: &str = "tabletop";
const DESCRIPTION: &str = "description";
const SHAPES: [&str; 5] = ["block", "cylinder", "sphere", "box", "composite"];
const ITEMS: [&str; 7] = [
    "block",
    "cylinder",
    "sphere",
    "box",
    "composite",
    "chain",
    "lidbox",
];
const SPANS: [&str; 3] = ["xspan", "yspan", "zspan"];

/// Elements that only the later program has.
const OF_THE_LATER_PROGRAM: [&str; 13] = [
    "frustum",
    "ring",
    "custom",
    "include",
    "def",
    "var",
    "instance",
    "sliderJoint",
    "toggleSwitch",
    "indicatorLights",
    "customControl",
    "guestBondPoint",
    "hostBondPoint",
];

/// Reads what the root element stands for.
pub(crate) fn scene(root: &Element, faults: &mut Faults) -> SceneSpec {
    if root.name != ROOT {
        let problem = "it is not the root of a task file";
        faults.report(root.place(), problem, "<tabletop>");
        if nearest(root.name, &[ROOT]).is_none() {
            return SceneSpec::default();
        }
    }
    if root.namespace != Namespace::Task {
        let expected = format_args!("xmlns=\"{NAMESPACE}\" on <{ROOT}>");
        faults.report(root.place(), namespace_problem(root.namespace), expected);
    }
    let mut reader = ElementReader {
        namespace: root.namespace,
        faults,
    };
    SceneSpec {
        table: reader.table(root),
        items: reader.items(root),
    }
}

/// What is wrong with a namespace that is not that of task files.
const fn namespace_problem(namespace: Namespace) -> &'static str {
    match namespace {
        Namespace::Undeclared => "its prefix is not declared",
        Namespace::Absent => "it has no namespace",
        Namespace::Task | Namespace::Other => "it is of another namespace",
    }
}

/// Where a shape stands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    /// It is an object of its own.
    Whole,
    /// It is a part of a composite.
    Part,
}

struct ElementReader<'f> {
    /// The namespace of the root element.
    namespace: Namespace,
    faults: &'f mut Faults,
}

impl ElementReader<'_> {
    fn table(&mut self, root: &Element) -> Table {
        let default = Table::default();
        let mut attributes = AttributeReader::of(root, self.faults);
        let table = Table {
            xspan: attributes.span("xspan", default.xspan),
            yspan: attributes.span("yspan", default.yspan),
        };
        attributes.report_unknown();
        table
    }

    fn items(&mut self, root: &Element) -> Vec<SceneItem> {
        let mut items = Vec::new();
        for child in &root.children {
            if self.is_allowed(child, root.name, &ITEMS) {
                items.extend(match child.name {
                    "chain" => self.chain(child).map(SceneItem::Chain),
                    "lidbox" => self.lidbox(child).map(SceneItem::LidBox),
                    _ => self.object(child).map(SceneItem::Object),
                });
            }
        }
        items
    }

    fn object(&mut self, element: &Element) -> Option<ObjectSpec> {
        let descriptions = self.descriptions(element);
        let parts = self.parts(element, Role::Whole);
        let mut attributes = AttributeReader::of(element, self.faults);
        let (id, pose) = (attributes.id(), attributes.pose());
        let mass = attributes.mass("mass", 1.0);
        let shape = shape(element, parts, &mut attributes);
        attributes.finish(shape.map(|shape| ObjectSpec {
            id,
            pose,
            mass,
            shape,
            descriptions,
        }))
    }

    fn part(&mut self, element: &Element) -> Option<Part> {
        let parts = self.parts(element, Role::Part);
        let mut attributes = AttributeReader::of(element, self.faults);
        let (id, pose) = (attributes.id(), attributes.pose());
        attributes.forbid(
            "mass",
            "a part has no mass of its own",
            "a mass of the outermost composite only",
        );
        let shape = shape(element, parts, &mut attributes);
        attributes.finish(shape.map(|shape| Part { id, pose, shape }))
    }

    /// The parts of a composite; none for a simple shape, whose content is checked.
    fn parts(&mut self, element: &Element, role: Role) -> Vec<Part> {
        let is_composite = element.name == "composite";
        let mut allowed = Vec::new();
        if is_composite {
            allowed.extend(SHAPES);
        }
        if role == Role::Whole {
            allowed.push(DESCRIPTION);
        }
        let mut parts = Vec::new();
        let mut is_empty = true;
        for child in &element.children {
            let is_description = child.name == DESCRIPTION;
            is_empty &= is_description;
            if self.is_allowed(child, element.name, &allowed) && !is_description {
                parts.extend(self.part(child));
            }
        }
        if is_composite && is_empty && !element.is_broken {
            let expected = format_args!("at least one of {}", SHAPES.join(", "));
            self.faults
                .report(element.place(), "it has no parts", expected);
        }
        parts
    }

    fn descriptions(&mut self, element: &Element) -> Vec<(String, String)> {
        let mut descriptions = Vec::new();
        for child in &element.children {
            if child.name == DESCRIPTION && self.is_of_the_language(child) {
                self.forbid_children(child);
                let mut attributes = AttributeReader::of(child, self.faults);
                let description = (
                    attributes.require("name", String::new(), "name", value::name),
                    attributes.require("value", String::new(), "text", |text| Ok(text.to_owned())),
                );
                descriptions.extend(attributes.finish(Some(description)));
            }
        }
        descriptions
    }

    fn chain(&mut self, element: &Element) -> Option<ChainSpec> {
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

    fn lidbox(&mut self, element: &Element) -> Option<LidBoxSpec> {
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

    fn forbid_children(&mut self, element: &Element) {
        for child in &element.children {
            self.is_allowed(child, element.name, &[]);
        }
    }

    /// Whether an element may stand in its parent; a fault says why not.
    fn is_allowed(&mut self, element: &Element, parent: &str, allowed: &[&str]) -> bool {
        if !self.is_of_the_language(element) {
            let expected = format_args!("the namespace {NAMESPACE}");
            let problem = namespace_problem(element.namespace);
            self.faults.report(element.place(), problem, expected);
            return false;
        }
        let name = element.name;
        if allowed.contains(&name) {
            return true;
        }
        if self.faults.is_full() {
            return false;
        }
        let problem = if OF_THE_LATER_PROGRAM.contains(&name) {
            "it is of the later program and not supported".to_owned()
        } else if ITEMS.contains(&name) || [ROOT, DESCRIPTION].contains(&name) {
            format!("it cannot stand in <{}>", Excerpt(parent))
        } else {
            "it is not known".to_owned()
        };
        let expected = match nearest(name, allowed) {
            Some(known) => format!("<{known}>"),
            None if allowed.is_empty() => format!("no element in <{}>", Excerpt(parent)),
            None => format!("one of {}", allowed.join(", ")),
        };
        self.faults.report(element.place(), problem, expected);
        false
    }

    fn is_of_the_language(&self, element: &Element) -> bool {
        match element.namespace {
            Namespace::Task => true,
            Namespace::Undeclared => false,
            namespace => namespace == self.namespace,
        }
    }
}

/// The shape of an element that is one of [`SHAPES`]; absent for a composite of no parts.
fn shape(element: &Element, parts: Vec<Part>, attributes: &mut AttributeReader) -> Option<Shape> {
    attributes.ignore("pointable", false, value::boolean);
    Some(match element.name {
        "block" => Shape::Block {
            span: attributes.spans(SPANS, Vec3::ONE),
            color: attributes.color("color"),
        },
        "cylinder" => {
            attributes.ignore("sides", 32, |text| value::count(text, &SIDES));
            Shape::Cylinder {
                radius: attributes.span("radius", 0.5),
                yspan: attributes.span("yspan", 1.0),
                color: attributes.color("color"),
            }
        }
        "sphere" => Shape::Sphere {
            radius: attributes.span("radius", 0.5),
            color: attributes.color("color"),
        },
        "box" => {
            let span = attributes.spans(SPANS, Vec3::ONE);
            let thickness = attributes.span("thickness", 0.05);
            check_hollow("thickness", span, thickness, attributes);
            Shape::Box {
                span,
                thickness,
                color: attributes.color("color"),
            }
        }
        _ if parts.is_empty() => return None,
        _ => Shape::Composite { parts },
    })
}

/// A third of the smaller of X and Z, or of Y where those walls would leave no hollow.
fn usual_handle_thickness(span: Vec3) -> f32 {
    let usual = span.x.min(span.z) / 3.0;
    match 2.0 * usual < span.y {
        true => usual,
        false => span.y / 3.0,
    }
}

/// Notes a fault where the walls of a container leave no hollow.
fn check_hollow(name: &'static str, span: Vec3, thickness: f32, attributes: &mut AttributeReader) {
    let most = (span.x / 2.0).min(span.y / 2.0).min(span.z);
    if attributes.is_sound() && thickness >= most {
        let problem = format_args!("walls of {thickness} leave no hollow");
        attributes.fault(name, problem, format_args!("less than {most}"));
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
    use tabletop_core::{Pose, Rgb};

    use super::*;
    use crate::test_support::{faults_of, items_of, lines_of, scene_of};

    fn only_object(content: &str) -> ObjectSpec {
        match items_of(content).as_slice() {
            [SceneItem::Object(object)] => object.clone(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_root_gives_the_table() {
        assert_eq!(
            scene_of("xspan='30' yspan='7.5'", "").table,
            Table {
                xspan: 30.0,
                yspan: 7.5
            }
        );
        assert_eq!(scene_of("", "").table, Table::default());
        let scene = scene_of("xspan='-1' yspan='7'", "<sphere location='(0,0,1)'/>");
        assert_eq!(
            scene.table,
            Table {
                xspan: 20.0,
                yspan: 7.0
            }
        );
        assert_eq!(scene.items.len(), 1);
    }

    #[test]
    fn simple_shapes_have_the_defaults_of_the_report() {
        for (name, shape) in [
            (
                "block",
                Shape::Block {
                    span: Vec3::ONE,
                    color: Rgb::GRAY,
                },
            ),
            (
                "cylinder",
                Shape::Cylinder {
                    radius: 0.5,
                    yspan: 1.0,
                    color: Rgb::GRAY,
                },
            ),
            (
                "sphere",
                Shape::Sphere {
                    radius: 0.5,
                    color: Rgb::GRAY,
                },
            ),
            (
                "box",
                Shape::Box {
                    span: Vec3::ONE,
                    thickness: 0.05,
                    color: Rgb::GRAY,
                },
            ),
        ] {
            let expected = ObjectSpec {
                id: String::new(),
                pose: Pose::at(Vec3::new(1.0, 2.0, 3.0)),
                mass: 1.0,
                shape,
                descriptions: vec![],
            };
            assert_eq!(
                only_object(&format!("<{name} location='(1,2,3)'/>")),
                expected
            );
        }
    }

    #[test]
    fn simple_shapes_have_the_attributes_of_the_report() {
        let object = only_object(
            "<block id='b_1' location='(-2,0,1)' rotation='(0,0,45)' mass='0' color='#00A57F' \
             xspan='2' yspan='3' zspan='4' pointable='true'>\
             <description name='use' value='a &amp; b'/><description name='shape' value=''/></block>",
        );
        assert_eq!(object.id, "b_1");
        let pose = Pose::from_degrees(Vec3::new(-2.0, 0.0, 1.0), Vec3::new(0.0, 0.0, 45.0));
        assert_eq!(object.pose, pose);
        assert!(object.is_fixed());
        let color = "#00a57f".parse().unwrap();
        assert_eq!(
            object.shape,
            Shape::Block {
                span: Vec3::new(2.0, 3.0, 4.0),
                color
            }
        );
        let descriptions = [("use", "a & b"), ("shape", "")].map(|(n, v)| (n.into(), v.into()));
        assert_eq!(object.descriptions, descriptions);
        let shape =
            only_object("<cylinder location='(0,0,2)' yspan='7' radius='2' sides='6'/>").shape;
        assert_eq!(
            shape,
            Shape::Cylinder {
                radius: 2.0,
                yspan: 7.0,
                color: Rgb::GRAY
            }
        );
        let shape = only_object("<box location='(0,0,2)' thickness='.2'/>").shape;
        assert_eq!(
            shape,
            Shape::Box {
                span: Vec3::ONE,
                thickness: 0.2,
                color: Rgb::GRAY
            }
        );
    }

    #[test]
    fn composites_nest() {
        let object = only_object(
            "<composite location='(0,0,1)' mass='10'><composite id='head' location='(-1,0,0)'>\
             <block id='x' location='(0,0,0)'/><block id='x' location='(0,1,0)'/></composite>\
             <sphere location='(2.8,0,0)'/></composite>",
        );
        assert_eq!(object.mass, 10.0);
        let parts = object.shape.simple_parts();
        let places: Vec<_> = parts
            .iter()
            .map(|part| (part.id.as_str(), part.pose.location.x))
            .collect();
        assert_eq!(places, [("x", -1.0), ("x", -1.0), ("", 2.8)]);
    }

    #[test]
    fn only_the_faulty_part_is_skipped() {
        let content = "<composite location='(0,0,1)'><block location='(0,0,0)' mass='1'/>\
                       <sphere location='(0,0,0)'/></composite>";
        let shape = only_object_in_spite_of_faults(content).shape;
        assert_eq!(shape.simple_parts().len(), 1);
        assert_eq!(
            lines_of(content),
            [
                "block, mass: a part has no mass of its own, expected a mass of the outermost composite only"
            ]
        );
    }

    fn only_object_in_spite_of_faults(content: &str) -> ObjectSpec {
        match scene_of("", content).items.as_slice() {
            [SceneItem::Object(object)] => object.clone(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_composite_needs_parts() {
        for content in [
            "<composite location='(0,0,1)'/>",
            "<composite location='(0,0,1)'><description name='a' value='b'/></composite>",
        ] {
            assert_eq!(
                lines_of(content),
                [
                    "composite: it has no parts, expected at least one of block, cylinder, sphere, box, composite"
                ]
            );
            assert!(scene_of("", content).items.is_empty());
        }
        let content = "<composite location='(0,0,1)'><block/></composite>";
        assert_eq!(lines_of(content).len(), 1);
        assert!(scene_of("", content).items.is_empty());
    }

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

    #[test]
    fn an_element_of_another_namespace_has_one_fault() {
        let content =
            "<block location='(0,0,1)'><description xmlns='x' name='a' value='b'/></block>";
        assert_eq!(
            lines_of(content),
            [format!(
                "description: it is of another namespace, expected the namespace {NAMESPACE}"
            )]
        );
    }

    #[test]
    fn walls_leave_a_hollow() {
        assert_eq!(
            lines_of("<box location='(0,0,1)' zspan='3' thickness='.5'/>"),
            ["box, thickness: walls of 0.5 leave no hollow, expected less than 0.5"]
        );
        assert_eq!(
            lines_of("<box location='(0,0,1)' zspan='.05'/>"),
            ["box, thickness: walls of 0.05 leave no hollow, expected less than 0.05"]
        );
        assert_eq!(
            lines_of("<lidbox location='(0,0,1)' handleThickness='.25'/>"),
            ["lidbox, handleThickness: walls of 0.25 leave no hollow, expected less than 0.25"]
        );
    }

    #[test]
    fn elements_have_their_place() {
        let whole = "block, cylinder, sphere, box, composite, chain, lidbox";
        for (content, fault) in [
            ("<cube/>", format!("cube: it is not known, expected one of {whole}")),
            ("<Sphere/>", "Sphere: it is not known, expected <sphere>".into()),
            ("<ring location='(0,0,1)'/>", format!("ring: it is of the later program and not supported, expected one of {whole}")),
            ("<description name='a' value='b'/>", format!("description: it cannot stand in <tabletop>, expected one of {whole}")),
            ("<block location='(0,0,1)'><sphere/></block>", "sphere: it cannot stand in <block>, expected one of description".into()),
            ("<chain start='(0,0,1)' end='(0,0,2)'><sphere/></chain>", "sphere: it cannot stand in <chain>, expected no element in <chain>".into()),
            ("<composite location='(0,0,1)'><chain/></composite>", "chain: it cannot stand in <composite>, expected one of block, cylinder, sphere, box, composite, description".into()),
            ("<composite location='(0,0,1)'><block location='(0,0,0)'><description name='a' value='b'/></block></composite>", "description: it cannot stand in <block>, expected no element in <block>".into()),
            ("<u:block location='(0,0,1)'/>", format!("block: its prefix is not declared, expected the namespace {NAMESPACE}")),
            ("<block xmlns='' location='(0,0,1)'/>", format!("block: it has no namespace, expected the namespace {NAMESPACE}")),
        ] {
            assert_eq!(lines_of(content), [fault], "{content}");
        }
    }

    #[test]
    fn a_faulty_description_leaves_its_object() {
        let content = "<block location='(0,0,1)'><description name='a b' value=''/>\
                       <description name='c'/><description name='d' value=' e '/></block>";
        let object = only_object_in_spite_of_faults(content);
        assert_eq!(object.descriptions, [("d".to_owned(), " e ".to_owned())]);
        assert_eq!(lines_of(content).len(), 2);
    }

    #[test]
    fn other_roots_are_faults() {
        let fault = |text: &str| {
            faults_of(text)
                .iter()
                .map(|f| f.problem.clone())
                .collect::<Vec<_>>()
        };
        assert_eq!(fault("<tabletop/>"), ["it has no namespace"]);
        assert_eq!(
            fault("<tabletop xmlns='x'><block location='(0,0,1)'/></tabletop>"),
            ["it is of another namespace"]
        );
        assert_eq!(
            fault(&format!("<html xmlns='{NAMESPACE}'><a/><b/></html>")),
            ["it is not the root of a task file"]
        );
        let text = format!("<Tabletop xmlns='{NAMESPACE}'><block location='(0,0,1)'/></Tabletop>");
        assert_eq!(fault(&text), ["it is not the root of a task file"]);
        let parsed = crate::parse(std::path::Path::new("f"), text.as_bytes());
        assert_eq!(parsed.scene.items.len(), 1);
    }
}
