//! Polyhedra, which are drawn as figures are.

use std::{collections::BTreeMap, sync::Arc};

use tabletop_geometry::{Polyhedron, Rgb, Solid};

use crate::scene::{DrawnFigure, DrawnSolid, Facets};

/// The polyhedra of a scene as figures. Their facets are kept as long as they are in the picture.
#[derive(Clone, Debug, Default)]
pub(crate) struct Polyhedra {
    facets: BTreeMap<Look, Arc<Facets>>,
    figures: Vec<DrawnFigure>,
}

/// A polyhedron's number and the bits of its colour.
type Look = (usize, [u32; 3]);

impl Polyhedra {
    /// Those among these solids, in their order.
    pub fn find(&mut self, solids: &[DrawnSolid]) {
        self.figures.clear();
        for drawn in solids {
            if let Solid::Polyhedron(polyhedron) = &drawn.solid {
                let facets = self.facets_of(polyhedron, drawn.color);
                self.figures.push(DrawnFigure {
                    pose: drawn.pose,
                    facets,
                    object: drawn.object,
                });
            }
        }
        self.facets
            .retain(|_, facets| Arc::strong_count(facets) > 1);
    }

    fn facets_of(&mut self, polyhedron: &Polyhedron, color: Rgb) -> Arc<Facets> {
        let Rgb { red, green, blue } = color;
        let look = (polyhedron.number(), [red, green, blue].map(f32::to_bits));
        let facets = self
            .facets
            .entry(look)
            .or_insert_with(|| Facets::from(&polyhedron.surface(color)).into());
        Arc::clone(facets)
    }

    /// The figures that were found.
    pub fn figures(&self) -> &[DrawnFigure] {
        &self.figures
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Vec3;
    use tabletop_geometry::Pose;

    #[test]
    fn facets_are_made_once_and_kept_while_they_are_seen() {
        let solid = |solid| DrawnSolid {
            pose: Pose::IDENTITY,
            solid,
            color: Rgb::GRAY,
            object: 1,
        };
        let ring = solid(Solid::Polyhedron(Polyhedron::ring(1.0, 0.5, 0.4, 32)));
        let block = solid(Solid::Cuboid(Vec3::ONE));
        let mut polyhedra = Polyhedra::default();
        polyhedra.find(&[block.clone(), ring.clone(), ring.clone()]);
        let [a, b] = polyhedra.figures() else {
            panic!("{:?}", polyhedra.figures());
        };
        assert!(Arc::ptr_eq(&a.facets, &b.facets));
        let before = Arc::clone(&a.facets);
        polyhedra.find(&[ring]);
        assert!(Arc::ptr_eq(&polyhedra.figures()[0].facets, &before));
        drop(before);
        polyhedra.find(&[block]);
        assert!(polyhedra.figures().is_empty() && polyhedra.facets.is_empty());
    }
}
