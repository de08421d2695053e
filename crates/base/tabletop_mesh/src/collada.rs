//! COLLADA files: the triangles and diffuse colours of their scene.
//!
//! Their coordinates are taken as they are, in metres by the file's unit. The `up_axis` is passed over, as RViz and MoveIt do: makers write either
//! one over meshes whose z is up.

mod element;
mod scene;
mod surfaces;

use bevy::math::{Mat4, Vec3};

use crate::error::MeshFileError;
use element::{ColladaElement, ColladaFault};
use scene::PlacedGeometry;
use surfaces::ColladaLibrary;

pub use surfaces::ColoredTriangles;

/// The scene of a COLLADA file, in m: its triangles and polygons, each where its nodes place it, with the diffuse colours of their materials.
/// Textures, lights, cameras and lines are passed over.
///
/// # Errors
/// It is none, has more than `most` triangles, or has meshes of another kind; the error names the line.
pub fn read_collada(bytes: &[u8], most: usize) -> Result<Vec<ColoredTriangles>, MeshFileError> {
    let text = str::from_utf8(bytes)
        .map_err(|error| MeshFileError::Collada(format!("it is no text: {error}")))?;
    let root = ColladaElement::read(text)?;
    if root.name != "COLLADA" {
        return Err(root.fault("its root is no <COLLADA>").into());
    }
    let scale = unit(&root)?;
    let mut library = ColladaLibrary::of(&root, most)?;
    let mut found = Vec::new();
    let mut count = 0;
    for PlacedGeometry {
        geometry,
        to_scene,
        materials,
    } in scene::placed(&root)?
    {
        let to_meters = Mat4::from_scale(Vec3::splat(scale)) * to_scene;
        count += library.count(geometry)?;
        if count > most {
            return Err(MeshFileError::TooManyTriangles(most));
        }
        for mut surface in library.surfaces(geometry, &materials)? {
            for corner in surface.triangles.iter_mut().flatten() {
                *corner = to_meters.transform_point3(*corner);
            }
            // A mirrored mesh is inside out.
            if to_meters.determinant() < 0.0 {
                for [_, second, third] in &mut surface.triangles {
                    std::mem::swap(second, third);
                }
            }
            found.push(surface);
        }
    }
    Ok(found)
}

/// The file's unit, in m.
fn unit(root: &ColladaElement) -> Result<f32, ColladaFault> {
    let unit = root.child("asset").and_then(|asset| asset.child("unit"));
    let Some((unit, meter)) = unit.and_then(|unit| Some((unit, unit.attribute("meter")?))) else {
        return Ok(1.0);
    };
    let meter: Option<f32> = meter.trim().parse().ok();
    let meter = meter.filter(|meter| meter.is_finite() && *meter > 0.0);
    meter.ok_or_else(|| unit.fault("its meter is no length"))
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::Rgb;

    use super::*;

    /// A square of two colours, placed by nodes.
    fn file(nodes: &str, primitives: &str) -> String {
        format!(
            r##"<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
  <library_effects>
    <effect id="red-effect"><profile_COMMON><technique sid="common"><phong>
      <diffuse><color sid="diffuse">1 0 0 1</color></diffuse></phong></technique></profile_COMMON></effect>
  </library_effects>
  <library_materials><material id="red-material"><instance_effect url="#red-effect"/></material></library_materials>
  <library_geometries><geometry id="square"><mesh>
    <source id="corners"><float_array id="numbers" count="12">0 0 0  1 0 0
      1 1 0  0 1 0</float_array>
      <technique_common><accessor source="#numbers" count="4" stride="3"/></technique_common></source>
    <vertices id="vertices"><input semantic="POSITION" source="#corners"/></vertices>
    {primitives}
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="all">{nodes}</visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#all"/></scene>
</COLLADA>"##
        )
    }

    const INSTANCE: &str = r##"<instance_geometry url="#square"><bind_material><technique_common>
        <instance_material symbol="paint" target="#red-material"/></technique_common></bind_material></instance_geometry>"##;

    const TRIANGLES: &str = r##"<triangles material="paint" count="2"><input semantic="VERTEX" source="#vertices" offset="1"/>
        <input semantic="NORMAL" source="#corners" offset="0"/><p>9 0 9 1 9 2  9 0 9 2 9 3</p></triangles>"##;

    const POLYLIST: &str = r##"<polylist count="1"><input semantic="VERTEX" source="#vertices" offset="0"/>
        <vcount>4</vcount><p>0 1 2 3</p></polylist>"##;

    fn read(nodes: &str, primitives: &str) -> Result<Vec<ColoredTriangles>, MeshFileError> {
        read_collada(file(nodes, primitives).as_bytes(), 2)
    }

    fn node(inside: &str) -> String {
        format!("<node>{inside}{INSTANCE}</node>")
    }

    #[test]
    fn triangles_have_the_unit_and_the_colour_of_their_file() {
        let found = read(&node(""), TRIANGLES).unwrap();
        let [part] = &found[..] else {
            panic!("{found:?}")
        };
        assert_eq!(part.color, Some(Rgb::new(1.0, 0.0, 0.0)));
        // Centimetres, and Y is not turned up.
        let corners = [[0.0, 0.0], [0.01, 0.0], [0.01, 0.01], [0.0, 0.01]];
        let [a, b, c, d] = corners.map(|[x, y]| Vec3::new(x, y, 0.0));
        assert_eq!(part.triangles, [[a, b, c], [a, c, d]]);

        let polygons = read(&node(""), POLYLIST).unwrap();
        assert_eq!(polygons[0].triangles, part.triangles);
        assert_eq!(polygons[0].color, None, "its material is not bound");
        let single = POLYLIST
            .replace("polylist", "polygons")
            .replace("<vcount>4</vcount>", "");
        assert_eq!(read(&node(""), &single).unwrap(), polygons);
    }

    #[test]
    fn nodes_place_their_geometry_in_the_order_of_their_transforms() {
        let farthest = |nodes: &str| {
            let found = read(nodes, TRIANGLES).unwrap();
            let corners = found
                .iter()
                .flat_map(|part| part.triangles.iter().flatten());
            corners.fold(Vec3::NEG_INFINITY, |far, corner| far.max(*corner)) * 100.0
        };
        let is_near = |nodes: &str, expected: [f32; 3]| {
            let found = farthest(nodes);
            assert!(found.distance(expected.into()) < 1e-4, "{nodes}: {found}");
        };
        is_near(
            &node("<translate>1 2 3</translate><scale>2 2 2</scale>"),
            [3.0, 4.0, 3.0],
        );
        is_near(
            &node("<scale>2 2 2</scale><translate>1 2 3</translate>"),
            [4.0, 6.0, 6.0],
        );
        is_near(&node("<rotate>0 1 0 -90</rotate>"), [0.0, 1.0, 1.0]);
        is_near(
            &node("<matrix>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1</matrix>"),
            [6.0, 7.0, 7.0],
        );
        let nested = format!(
            "<node><translate>1 0 0</translate>{}</node>",
            node("<translate>0 1 0</translate>")
        );
        is_near(&nested, [2.0, 2.0, 0.0]);
    }

    #[test]
    fn a_mirrored_mesh_keeps_its_outside_outside() {
        let found = read(&node("<scale>1 1 -1</scale>"), TRIANGLES).unwrap();
        let [a, b, c] = found[0].triangles[0];
        assert!((b - a).cross(c - a).z < 0.0);
    }

    #[test]
    fn faults_name_their_line() {
        let refused = |text: &str| match read_collada(text.as_bytes(), 2) {
            Ok(found) => panic!("{found:?}"),
            Err(error) => error.to_string(),
        };
        let whole = file(&node(""), TRIANGLES);
        for (from, to, expected) in [
            (
                "9 0 9 1 9 2",
                "9 0 9 1 9 4",
                "line 15: <p>: there is no corner 4",
            ),
            (
                "9 0 9 1 9 2",
                "9 0 9 1",
                "line 15: <p>: it has 10 numbers, expected a multiple of 6",
            ),
            (
                "9 0 9 1 9 2",
                "9 0 9 -1 9 2",
                "line 15: <p>: `-1` is no index",
            ),
            (
                "1 1 0  0 1 0",
                "1 1 0  0 x 0",
                "line 10: <float_array>: `x` is no number",
            ),
            (
                "source=\"#corners\"/></vert",
                "source=\"#corner\"/></vert",
                "there is no source corner",
            ),
            (
                "stride=\"3\"",
                "stride=\"2\"",
                "line 12: <accessor>: a stride of 2",
            ),
            (
                "count=\"4\" stride",
                "count=\"5\" stride",
                "line 12: <accessor>: 5 corners of 3 numbers are more than the 12 that are there",
            ),
            (
                "meter=\"0.01\"",
                "meter=\"0\"",
                "line 3: <unit>: its meter is no length",
            ),
            (
                "url=\"#square\"",
                "url=\"#circle\"",
                "there is no geometry circle",
            ),
            (
                "url=\"#all\"",
                "url=\"#some\"",
                "there is no visual_scene some",
            ),
            (
                "<triangles",
                "<tristrips><p>0 1 2</p></tristrips><triangles",
                "line 14: <tristrips> is not read",
            ),
            (
                "<node>",
                "<node><matrix>1 2 3</matrix>",
                "line 17: <matrix>: it has 3 numbers, expected 16",
            ),
            (
                "<node>",
                "<node><lookat>1 2 3</lookat>",
                "line 17: <lookat> is not read",
            ),
            ("COLLADA xmlns", "COLLADO xmlns", "COLLADO"),
            ("</COLLADA>", "", "it does not end"),
            ("<asset>", "<!DOCTYPE a><asset>", "DOCTYPE"),
        ] {
            assert!(whole.contains(from), "{from}");
            let said = refused(&whole.replacen(from, to, 1));
            assert!(said.contains(expected), "{from}: {said}");
        }
        assert!(refused("hello").contains("there is no element"));
        let more = file(&node(""), TRIANGLES).replace("</node>", &format!("{INSTANCE}</node>"));
        assert_eq!(refused(&more), "it has more than 2 triangles");
    }

    #[test]
    fn nodes_that_hold_themselves_are_refused() {
        let ring = r##"<node id="a"><instance_node url="#a"/></node>"##;
        let error = read(ring, TRIANGLES).unwrap_err().to_string();
        assert!(error.contains("nested more than"), "{error}");
        let many = (0..40).fold(String::from("<node id=\"n0\"/>"), |nodes, number| {
            let inner = format!("<instance_node url=\"#n{number}\"/>").repeat(2);
            nodes + &format!("<node id=\"n{}\">{inner}</node>", number + 1)
        });
        let error = read(&many, TRIANGLES).unwrap_err().to_string();
        assert!(error.contains("more than"), "{error}");
    }
}
