//! The surfaces of geometries, and the colours of materials.

use std::{collections::BTreeMap, sync::Arc};

use bevy::math::Vec3;
use tabletop_geometry::Rgb;

use super::element::{ColladaElement, ColladaFault};
use crate::{Triangle, error::MeshFileError};

/// Most inputs of a primitive: numbers for each of its corners.
const MOST_INPUTS: usize = 32;

/// The triangles of a file that have one colour.
#[derive(Clone, Debug, PartialEq)]
pub struct ColoredTriangles {
    /// Their colour, if the file gives one.
    pub color: Option<Rgb>,
    /// The triangles, in m.
    pub triangles: Vec<Triangle>,
}

/// The geometries and materials of a file.
pub(super) struct ColladaLibrary<'a> {
    geometries: BTreeMap<&'a str, &'a ColladaElement>,
    /// The diffuse colours of materials.
    colors: BTreeMap<&'a str, Rgb>,
    /// The geometries that were read.
    read: BTreeMap<&'a str, Vec<GeometryTriangles<'a>>>,
    /// Most triangles of a geometry.
    most: usize,
}

/// Triangles of a geometry, and the symbol of their material.
struct GeometryTriangles<'a> {
    symbol: Option<&'a str>,
    triangles: Vec<Triangle>,
}

impl<'a> ColladaLibrary<'a> {
    pub fn of(root: &'a ColladaElement, most: usize) -> Result<Self, ColladaFault> {
        let all = |library: &'static str, name: &'static str| {
            let libraries = root.children_called(library);
            let elements = libraries.flat_map(move |library| library.children_called(name));
            elements.filter_map(|element| Some((element.attribute("id")?, element)))
        };
        let effects: BTreeMap<_, _> = all("library_effects", "effect").collect();
        let mut colors = BTreeMap::new();
        for (id, material) in all("library_materials", "material") {
            let Some(instance) = material.child("instance_effect") else {
                continue;
            };
            let effect = effects.get(instance.reference("url")?).copied();
            if let Some(color) = effect.map(diffuse).transpose()?.flatten() {
                colors.insert(id, color);
            }
        }
        Ok(Self {
            geometries: all("library_geometries", "geometry").collect(),
            colors,
            read: BTreeMap::new(),
            most,
        })
    }

    /// The number of triangles of the geometry that an element shows.
    pub fn count(&mut self, instance: &'a ColladaElement) -> Result<usize, MeshFileError> {
        let surfaces = self.geometry(instance)?.iter();
        Ok(surfaces.map(|surface| surface.triangles.len()).sum())
    }

    /// The surfaces of the geometry that an element shows, in the file's unit, each with the colour of its material.
    pub fn surfaces(
        &mut self,
        instance: &'a ColladaElement,
        materials: &BTreeMap<&str, &str>,
    ) -> Result<Vec<ColoredTriangles>, MeshFileError> {
        self.geometry(instance)?;
        let surfaces = self.read.get(instance.reference("url")?);
        let surfaces = surfaces.into_iter().flatten().map(|surface| {
            // Some programs bind nothing and name the material itself.
            let named = surface.symbol;
            let material = named.map(|symbol| materials.get(symbol).copied().unwrap_or(symbol));
            ColoredTriangles {
                color: material.and_then(|material| self.colors.get(material).copied()),
                triangles: surface.triangles.clone(),
            }
        });
        Ok(surfaces.collect())
    }

    fn geometry(
        &mut self,
        instance: &'a ColladaElement,
    ) -> Result<&[GeometryTriangles<'a>], MeshFileError> {
        let id = instance.reference("url")?;
        let geometry = self.geometries.get(id);
        let geometry =
            geometry.ok_or_else(|| instance.fault(&format!("there is no geometry {id}")))?;
        if !self.read.contains_key(id) {
            let surfaces = surfaces_of(geometry, self.most)?;
            self.read.insert(id, surfaces);
        }
        Ok(self.read.get(id).map(Vec::as_slice).unwrap_or_default())
    }
}

fn surfaces_of(
    geometry: &ColladaElement,
    most: usize,
) -> Result<Vec<GeometryTriangles<'_>>, MeshFileError> {
    let mut surfaces = Vec::new();
    let mut count = 0;
    for mesh in geometry.children_called("mesh") {
        let mut sources = MeshSources::of(mesh);
        for primitive in &mesh.children {
            let triangles = match &*primitive.name {
                "triangles" => triangles(&mut sources, primitive)?,
                "polylist" => polygons_of_list(&mut sources, primitive)?,
                "polygons" => polygons(&mut sources, primitive)?,
                "tristrips" | "trifans" => {
                    return Err(primitive.unread("export the mesh as triangles").into());
                }
                // Sources, vertices, and lines, which have no surface.
                _ => continue,
            };
            count += triangles.len();
            if count > most {
                return Err(MeshFileError::TooManyTriangles(most));
            }
            surfaces.push(GeometryTriangles {
                symbol: primitive.attribute("material"),
                triangles,
            });
        }
    }
    Ok(surfaces)
}

/// The diffuse colour of an effect; `None` if it has a texture or none.
fn diffuse(effect: &ColladaElement) -> Result<Option<Rgb>, ColladaFault> {
    let profile = effect.child("profile_COMMON");
    let technique = profile.and_then(|profile| profile.child("technique"));
    let shaders = technique.map(|technique| technique.children.iter());
    let mut diffuse = shaders
        .into_iter()
        .flatten()
        .filter_map(|shader| shader.child("diffuse"));
    let Some(color) = diffuse.next().and_then(|diffuse| diffuse.child("color")) else {
        return Ok(None);
    };
    let [red, green, blue, _] = color.exactly()?.map(|part: f32| part.clamp(0.0, 1.0));
    Ok(Some(Rgb::new(red, green, blue)))
}

/// The places that the vertices of a mesh can have, each source read once.
struct MeshSources<'a> {
    vertices: BTreeMap<&'a str, &'a ColladaElement>,
    sources: BTreeMap<&'a str, &'a ColladaElement>,
    places: BTreeMap<&'a str, Arc<[Vec3]>>,
}

impl<'a> MeshSources<'a> {
    fn of(mesh: &'a ColladaElement) -> Self {
        let all = |name: &'static str| {
            let elements = mesh.children_called(name);
            elements.filter_map(|element| Some((element.attribute("id")?, element)))
        };
        Self {
            vertices: all("vertices").collect(),
            sources: all("source").collect(),
            places: BTreeMap::new(),
        }
    }

    /// The places of the vertices that an input names.
    fn places(&mut self, input: &'a ColladaElement) -> Result<Arc<[Vec3]>, ColladaFault> {
        let id = input.reference("source")?;
        if let Some(known) = self.places.get(id) {
            return Ok(Arc::clone(known));
        }
        let vertices = self.vertices.get(id);
        let vertices =
            vertices.ok_or_else(|| input.fault(&format!("there are no vertices {id}")))?;
        let mut inputs = vertices.children_called("input");
        let position = inputs.find(|input| input.attribute("semantic") == Some("POSITION"));
        let position = position.ok_or_else(|| vertices.fault("no <input> has its POSITION"))?;
        let name = position.reference("source")?;
        let source = self.sources.get(name);
        let source = source.ok_or_else(|| position.fault(&format!("there is no source {name}")))?;
        let places: Arc<[Vec3]> = places(source)?.into();
        self.places.insert(id, Arc::clone(&places));
        Ok(places)
    }
}

/// The corners of a primitive, and how its indices name them.
struct PrimitiveCorners {
    places: Arc<[Vec3]>,
    /// Numbers of indices for a corner, and the place of the one that names its location.
    stride: usize,
    offset: usize,
}

impl PrimitiveCorners {
    fn of<'a>(
        sources: &mut MeshSources<'a>,
        primitive: &'a ColladaElement,
    ) -> Result<Self, ColladaFault> {
        let mut stride = 0;
        let mut vertex = None;
        for input in primitive.children_called("input") {
            let offset = input.attribute("offset").unwrap_or("0");
            let offset = offset.parse().ok().filter(|offset| *offset < MOST_INPUTS);
            let offset = offset.ok_or_else(|| {
                input.fault(&format!("its offset is no number below {MOST_INPUTS}"))
            })?;
            stride = stride.max(offset + 1);
            if input.required("semantic")? == "VERTEX" {
                vertex = Some((input, offset));
            }
        }
        let (input, offset) = vertex.ok_or_else(|| primitive.fault("no <input> has its VERTEX"))?;
        Ok(Self {
            places: sources.places(input)?,
            stride,
            offset,
        })
    }

    /// The corners that the text of a `<p>` names.
    fn named(&self, p: &ColladaElement) -> Result<Vec<Vec3>, ColladaFault> {
        let indices = p.indices()?;
        let corners = indices.chunks(self.stride).map(|indices| {
            let index = indices.get(self.offset).copied();
            let index = index.ok_or_else(|| p.fault("its last corner is not whole"))?;
            let place = self.places.get(index).copied();
            place.ok_or_else(|| p.fault(&format!("there is no corner {index}")))
        });
        corners.collect()
    }
}

/// The places in a source.
fn places(source: &ColladaElement) -> Result<Vec<Vec3>, ColladaFault> {
    let array = source.child("float_array");
    let array = array.ok_or_else(|| source.fault("it has no <float_array>"))?;
    let numbers = array.numbers()?;
    let common = source.child("technique_common");
    let accessor = common.and_then(|common| common.child("accessor"));
    let accessor = accessor.ok_or_else(|| source.fault("it has no <accessor>"))?;
    let count = |name: &str, usual: usize| match accessor.attribute(name) {
        None => Ok(usual),
        Some(text) => text
            .parse::<usize>()
            .map_err(|_| accessor.fault(&format!("its {name} is no number"))),
    };
    let (stride, first) = (count("stride", 3)?, count("offset", 0)?);
    if stride < 3 {
        return Err(accessor.fault(&format!("a stride of {stride}, expected at least 3")));
    }
    let there = numbers.get(first..).unwrap_or_default();
    let count = count("count", there.len() / stride)?;
    if count
        .checked_mul(stride)
        .is_none_or(|needed| needed > there.len())
    {
        return Err(accessor.fault(&format!(
            "{count} corners of {stride} numbers are more than the {} that are there",
            there.len()
        )));
    }
    let places = there.chunks(stride).take(count);
    Ok(places.map(Vec3::from_slice).collect())
}

fn triangles<'a>(
    sources: &mut MeshSources<'a>,
    primitive: &'a ColladaElement,
) -> Result<Vec<[Vec3; 3]>, ColladaFault> {
    let Some(p) = primitive.child("p") else {
        return Ok(Vec::new());
    };
    let corners = PrimitiveCorners::of(sources, primitive)?;
    let named = corners.named(p)?;
    let (whole, rest) = named.as_chunks::<3>();
    match rest.is_empty() {
        true => Ok(whole.to_vec()),
        false => {
            let (numbers, expected) = (named.len() * corners.stride, 3 * corners.stride);
            Err(p.fault(&format!(
                "it has {numbers} numbers, expected a multiple of {expected}"
            )))
        }
    }
}

fn polygons_of_list<'a>(
    sources: &mut MeshSources<'a>,
    primitive: &'a ColladaElement,
) -> Result<Vec<[Vec3; 3]>, ColladaFault> {
    let Some(p) = primitive.child("p") else {
        return Ok(Vec::new());
    };
    let corners = PrimitiveCorners::of(sources, primitive)?.named(p)?;
    let counts = primitive.child("vcount");
    let counts = counts.ok_or_else(|| primitive.fault("it has no <vcount>"))?;
    let mut rest = &corners[..];
    let mut triangles = Vec::new();
    for count in counts.indices()? {
        let Some((polygon, others)) = rest.split_at_checked(count) else {
            return Err(counts.fault("it counts more corners than there are"));
        };
        triangles.extend(fan(polygon));
        rest = others;
    }
    Ok(triangles)
}

fn polygons<'a>(
    sources: &mut MeshSources<'a>,
    primitive: &'a ColladaElement,
) -> Result<Vec<[Vec3; 3]>, ColladaFault> {
    let mut triangles = Vec::new();
    let mut corners = None;
    for p in primitive.children_called("p") {
        let corners = match &corners {
            Some(corners) => corners,
            None => corners.insert(PrimitiveCorners::of(sources, primitive)?),
        };
        triangles.extend(fan(&corners.named(p)?));
    }
    Ok(triangles)
}

/// A polygon as triangles around its first corner.
fn fan(polygon: &[Vec3]) -> impl Iterator<Item = [Vec3; 3]> {
    let (first, rest) = match polygon.split_first() {
        Some((first, rest)) => (*first, rest),
        None => (Vec3::ZERO, &[][..]),
    };
    rest.windows(2).map(move |pair| [first, pair[0], pair[1]])
}
