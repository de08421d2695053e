//! The scene of a file: which geometry it shows, and where.

use std::collections::BTreeMap;

use bevy::math::{Mat4, Vec3};
use tabletop_geometry::turn_about;

use super::element::{ColladaElement, ColladaFault};

/// Nodes may be this deep inside each other.
const DEEPEST: usize = 64;

/// Most nodes of a scene; each counts as often as it is shown.
const MOST_NODES: usize = 100_000;

/// A geometry in the scene.
pub(super) struct PlacedGeometry<'a> {
    /// The element that names it.
    pub geometry: &'a ColladaElement,
    /// From its frame to the scene's, in the file's unit.
    pub to_scene: Mat4,
    /// The ids of its materials, by the symbols of its surfaces.
    pub materials: BTreeMap<&'a str, &'a str>,
}

/// All geometries of the scene that a file shows; of a file that shows none, those of its first scene.
pub(super) fn placed(root: &ColladaElement) -> Result<Vec<PlacedGeometry<'_>>, ColladaFault> {
    let library = root.children_called("library_visual_scenes");
    let mut scenes = library.flat_map(|library| library.children_called("visual_scene"));
    let shown = root.child("scene");
    let shown = shown.and_then(|scene| scene.child("instance_visual_scene"));
    let scene = match shown {
        Some(shown) => {
            let id = shown.reference("url")?;
            let scene = scenes.find(|scene| scene.attribute("id") == Some(id));
            Some(scene.ok_or_else(|| shown.fault(&format!("there is no visual_scene {id}")))?)
        }
        None => scenes.next(),
    };
    let mut walk = SceneWalk {
        nodes: BTreeMap::new(),
        count: 0,
        found: Vec::new(),
    };
    for library in root.children_called("library_nodes") {
        walk.learn(library);
    }
    if let Some(scene) = scene {
        walk.learn(scene);
        for node in scene.children_called("node") {
            walk.visit(node, Mat4::IDENTITY, 1)?;
        }
    }
    Ok(walk.found)
}

struct SceneWalk<'a> {
    /// The nodes that others can show, by id.
    nodes: BTreeMap<&'a str, &'a ColladaElement>,
    count: usize,
    found: Vec<PlacedGeometry<'a>>,
}

impl<'a> SceneWalk<'a> {
    /// Remembers the nodes in an element, which are no deeper than elements can be.
    fn learn(&mut self, element: &'a ColladaElement) {
        for node in element.children_called("node") {
            if let Some(id) = node.attribute("id") {
                self.nodes.insert(id, node);
            }
            self.learn(node);
        }
    }

    fn visit(
        &mut self,
        node: &'a ColladaElement,
        outer: Mat4,
        depth: usize,
    ) -> Result<(), ColladaFault> {
        self.count += 1;
        if depth > DEEPEST {
            return Err(node.fault(&format!("nodes are nested more than {DEEPEST} deep")));
        }
        if self.count > MOST_NODES {
            return Err(node.fault(&format!("there are more than {MOST_NODES} nodes")));
        }
        let mut to_scene = outer;
        // All transforms come before what they place.
        for child in &node.children {
            match &*child.name {
                "matrix" => to_scene *= Mat4::from_cols_array(&child.exactly()?).transpose(),
                "translate" => to_scene *= Mat4::from_translation(child.exactly()?.into()),
                "scale" => to_scene *= Mat4::from_scale(child.exactly()?.into()),
                "rotate" => {
                    let [x, y, z, degrees] = child.exactly()?;
                    let axis = Vec3::new(x, y, z).try_normalize();
                    let axis = axis.ok_or_else(|| child.fault("its axis has no direction"))?;
                    to_scene *= Mat4::from_quat(turn_about(axis, degrees.to_radians()));
                }
                "lookat" | "skew" => return Err(child.unread("give its node a <matrix>")),
                "instance_geometry" => self.found.push(PlacedGeometry {
                    geometry: child,
                    to_scene,
                    materials: bound(child)?,
                }),
                "instance_controller" => {
                    return Err(
                        child.unread("it moves a mesh by a skeleton; export the mesh alone")
                    );
                }
                "instance_node" => {
                    let id = child.reference("url")?;
                    let shown = self.nodes.get(id).copied();
                    let shown =
                        shown.ok_or_else(|| child.fault(&format!("there is no node {id}")))?;
                    self.visit(shown, to_scene, depth + 1)?;
                }
                "node" => self.visit(child, to_scene, depth + 1)?,
                // Cameras, lights, and what programs note.
                _ => {}
            }
        }
        Ok(())
    }
}

/// The materials of an instance, by the symbols of its surfaces.
fn bound(instance: &ColladaElement) -> Result<BTreeMap<&str, &str>, ColladaFault> {
    let bindings = instance.children_called("bind_material");
    let common = bindings.flat_map(|binding| binding.children_called("technique_common"));
    let materials = common.flat_map(|common| common.children_called("instance_material"));
    materials
        .map(|material| Ok((material.required("symbol")?, material.reference("target")?)))
        .collect()
}
