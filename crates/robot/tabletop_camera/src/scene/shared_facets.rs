//! Facets that all worlds of the process share.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, PoisonError, Weak},
};

use tabletop_geometry::Triangles;

use super::Facets;

/// The facets of surfaces, by the surfaces' addresses, which stay theirs as long as they are in here.
static SHARED: Mutex<BTreeMap<usize, SharedFacets>> = Mutex::new(BTreeMap::new());

struct SharedFacets {
    facets: Weak<Facets>,
    /// Keeps the surface's address from being given to another.
    _surface: Weak<Triangles>,
}

/// The facets of a surface, made where nobody has them.
pub(crate) fn facets_of(surface: &Arc<Triangles>) -> Arc<Facets> {
    let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    let address = Arc::as_ptr(surface).addr();
    let known = shared.get(&address);
    if let Some(known) = known.and_then(|known| known.facets.upgrade()) {
        return known;
    }
    shared.retain(|_, known| known.facets.strong_count() > 0);
    let facets = Arc::new(Facets::from(&**surface));
    let known = SharedFacets {
        facets: Arc::downgrade(&facets),
        _surface: Arc::downgrade(surface),
    };
    shared.insert(address, known);
    facets
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Vec3;
    use tabletop_geometry::Rgb;

    fn triangle(size: f32) -> Arc<Triangles> {
        Arc::new(Triangles {
            positions: vec![Vec3::ZERO, Vec3::X * size, Vec3::Y * size],
            normals: vec![Vec3::Z; 3],
            colors: vec![Rgb::GRAY; 3],
            indices: vec![[0, 1, 2]],
        })
    }

    #[test]
    fn a_surface_has_one_set_of_facets_as_long_as_somebody_has_them() {
        let (one, other) = (triangle(1.0), triangle(1.0));
        let facets = facets_of(&one);
        assert!(Arc::ptr_eq(&facets, &facets_of(&one)));
        assert!(!Arc::ptr_eq(&facets, &facets_of(&other)));
        let gone = Arc::downgrade(&facets);
        drop(facets);
        assert!(gone.upgrade().is_none());
    }

    #[test]
    fn a_surface_in_the_place_of_another_has_its_own_facets() {
        for size in 1..100u8 {
            let size = f32::from(size);
            let facets = facets_of(&triangle(size));
            assert_eq!(facets.bounds[1], Vec3::new(size, size, 0.0));
        }
    }
}
