//! Figures of a robot that several worlds share.

use std::sync::{Arc, OnceLock};

use tabletop_core::{Face, Figure};

/// The figures of a robot, each made when it is shown for the first time in any of the worlds that have clones of its description.
#[derive(Clone, Debug, Default)]
pub(crate) struct SharedFigures(Arc<Figures>);

#[derive(Debug, Default)]
struct Figures {
    bodies: OnceLock<Vec<Option<Figure>>>,
    /// The screens with each face.
    screens: [OnceLock<Option<Figure>>; Face::ALL.len()],
}

impl SharedFigures {
    /// The figures of its bodies, made if they are not there yet.
    pub fn bodies(&self, make: impl FnOnce() -> Vec<Option<Figure>>) -> &[Option<Figure>] {
        self.0.bodies.get_or_init(make)
    }

    /// Its screen with a face, made if it is not there yet.
    pub fn screen(&self, face: Face, make: impl FnOnce() -> Option<Figure>) -> Option<Figure> {
        self.0.screens[face as usize].get_or_init(make).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabletop_geometry::Triangles;

    #[test]
    fn each_face_has_a_screen_of_its_own_that_clones_share() {
        let figures = SharedFigures::default();
        let make = || {
            let surface = Arc::new(Triangles::default());
            Some(Figure {
                fine: Arc::clone(&surface),
                coarse: surface,
            })
        };
        let mut known: Vec<Figure> = Vec::new();
        for face in Face::ALL {
            let screen = figures.screen(face, make).unwrap();
            let again = figures.clone().screen(face, || None).unwrap();
            assert!(Arc::ptr_eq(&screen.coarse, &again.coarse), "{face:?}");
            let is_same = |it: &Figure| Arc::ptr_eq(&it.coarse, &screen.coarse);
            assert!(!known.iter().any(is_same), "{face:?}");
            known.push(screen);
        }
    }
}
