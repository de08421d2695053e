//! The depths of a face that stays where it is: the table.

use crate::{
    camera::{PinholeView, SampleOffset},
    raster::face::RasterFace,
};

/// Depths of a plane all over the picture, if the plane was the same in the previous picture.
#[derive(Clone, Debug, Default)]
pub(crate) struct Backdrop {
    /// The key on which the depths depend.
    key: Option<Key>,
    /// The depths, row by row; empty as long as they are not known.
    depths: Vec<f32>,
}

/// The bits of a plane, and the size of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Key {
    plane: [u32; 3],
    width: u32,
    height: u32,
}

impl Backdrop {
    /// Gets ready for a picture with this face.
    pub fn prepare(&mut self, face: Option<&RasterFace>, view: &PinholeView) {
        let key = face.map(|face| Key {
            plane: face.plane.inverse_depth.bits(),
            width: view.width,
            height: view.height,
        });
        if self.key != key {
            self.key = key;
            self.depths.clear();
        } else if self.depths.is_empty()
            && let Some(face) = face
        {
            let plane = face.plane.inverse_depth;
            for row in 0..view.height {
                let inverse_depth = plane.on_row(row, SampleOffset::CENTER);
                let columns = 0..view.width as i32;
                self.depths
                    .extend(columns.map(|x| 1.0 / inverse_depth.at(x as f32)));
            }
        }
    }

    /// The depths of a row, if they are known.
    pub fn row(&self, row: u32) -> Option<&[f32]> {
        let width = self.key?.width as usize;
        let start = row as usize * width;
        self.depths.get(start..start + width)
    }
}
