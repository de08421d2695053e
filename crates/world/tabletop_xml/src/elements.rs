//! Elements of the task file language and their meaning (report section 6.2): the table, and the places of elements.

pub(crate) mod attributes;
mod blades;
mod bond;
mod chain;
mod control;
mod cost;
mod hollow;
mod jointed;
mod lidbox;
pub(crate) mod mesh_files;
mod names;
mod nearness;
mod object;
mod push_button;
mod role;
mod simple_shape;
pub(crate) mod value;

use tabletop_core::{JointMotion, SceneItem, SceneSpec, Table, nearest_name};

use crate::{
    NAMESPACE,
    document::{ROOT, tree::Element},
    elements::{
        attributes::AttributeReader,
        cost::{Cost, Excess},
        mesh_files::MeshFiles,
        names::{DESCRIPTION, INNER, ITEMS, TEMPLATES},
    },
    fault::{Excerpt, Faults},
};

/// Reads the scene of the root element.
pub(crate) fn scene(root: &Element, meshes: &mut MeshFiles, faults: &mut Faults) -> SceneSpec {
    let mut reader = ElementReader { meshes, faults };
    SceneSpec {
        table: reader.table(root),
        items: reader.items(root),
    }
}

/// Reads elements, and notes their faults.
pub(crate) struct ElementReader<'f, 'm> {
    pub meshes: &'f mut MeshFiles<'m>,
    pub faults: &'f mut Faults,
}

impl ElementReader<'_, '_> {
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
        let mut cost = Cost::default();
        for child in &root.children {
            if !self.is_allowed(child, root.name, &ITEMS) {
                continue;
            }
            let item = match child.name {
                "chain" => self.chain(child).map(SceneItem::Chain),
                "lidbox" => self.lidbox(child).map(SceneItem::LidBox),
                "sliderJoint" => self
                    .jointed(child, JointMotion::Slide)
                    .map(SceneItem::Jointed),
                "hingeJoint" => self
                    .jointed(child, JointMotion::Turn)
                    .map(SceneItem::Jointed),
                "scissors" => self.scissors(child).map(SceneItem::Jointed),
                "pushButton" => self.push_button(child).map(SceneItem::Jointed),
                _ => self.object(child).map(SceneItem::Object),
            };
            let Some(item) = item else {
                continue;
            };
            match cost.add(&item) {
                Ok(()) => items.push(item),
                Err(Excess { problem, expected }) => {
                    self.faults.report(child.place(), problem, expected);
                }
            }
        }
        items
    }

    /// Notes a fault for each element in this one.
    pub fn forbid_children(&mut self, element: &Element) {
        for child in &element.children {
            self.is_allowed(child, element.name, &[]);
        }
    }

    /// True if an element may stand in its parent; otherwise a fault has the reason.
    pub fn is_allowed(&mut self, element: &Element, parent: &str, allowed: &[&str]) -> bool {
        if !element.is_of_the_language() {
            let expected = format_args!("the namespace {NAMESPACE}");
            let problem = element.namespace.problem();
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
        let problem = if [&ITEMS[..], &INNER, &[ROOT, DESCRIPTION]]
            .concat()
            .contains(&name)
        {
            format!("it cannot stand in <{}>", Excerpt(parent))
        } else {
            "it is not known".to_owned()
        };
        let known = [allowed, &TEMPLATES].concat();
        let expected = match nearest_name(name, &known) {
            Some(known) => format!("<{known}>"),
            None if allowed.is_empty() => format!("no element in <{}>", Excerpt(parent)),
            None => format!("one of {}", allowed.join(", ")),
        };
        self.faults.report(element.place(), problem, expected);
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{faults_of, lines_of, scene_of};

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
    fn elements_have_their_place() {
        let whole = "block, cylinder, frustum, ring, sphere, box, custom, composite, toggleSwitch, indicatorLights, customControl, chain, lidbox, sliderJoint, hingeJoint, scissors, pushButton";
        for (content, fault) in [
            ("<cube/>", format!("cube: it is not known, expected one of {whole}")),
            ("<Sphere/>", "Sphere: it is not known, expected <sphere>".into()),
            ("<description name='a' value='b'/>", format!("description: it cannot stand in <tabletop>, expected one of {whole}")),
            ("<block location='(0,0,1)'><sphere/></block>", "sphere: it cannot stand in <block>, expected one of description".into()),
            ("<chain start='(0,0,1)' end='(0,0,2)'><sphere/></chain>", "sphere: it cannot stand in <chain>, expected no element in <chain>".into()),
            ("<composite location='(0,0,1)'><chain/></composite>", "chain: it cannot stand in <composite>, expected one of block, cylinder, frustum, ring, sphere, box, custom, composite, toggleSwitch, indicatorLights, customControl, guestBondPoint, hostBondPoint, description".into()),
            ("<composite location='(0,0,1)'><block location='(0,0,0)'><description name='a' value='b'/></block></composite>", "description: it cannot stand in <block>, expected no element in <block>".into()),
            ("<u:block location='(0,0,1)'/>", format!("block: its prefix is not declared, expected the namespace {NAMESPACE}")),
            ("<block xmlns='' location='(0,0,1)'/>", format!("block: it has no namespace, expected the namespace {NAMESPACE}")),
        ] {
            assert_eq!(lines_of(content), [fault], "{content}");
        }
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
