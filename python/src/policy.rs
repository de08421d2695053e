//! Learned policies.

use std::{f32::consts::PI, path::PathBuf};

use numpy::{PyArray1, PyReadonlyArray3, PyUntypedArrayMethods as _};
use pyo3::prelude::*;
use tabletop::{
    camera::Camera,
    core::{HeadCamera, Picture, Table},
    policy::{self, Decision},
};

use crate::error::refuse;

/// A policy that `tabletop learn` has made.
#[pyclass(module = "tabletop", frozen)]
pub struct Policy(policy::Policy);

#[pymethods]
impl Policy {
    /// Reads a policy's file.
    ///
    /// Raises `Error` if it cannot be read, or is none.
    #[new]
    fn new(file: PathBuf) -> PyResult<Self> {
        policy::Policy::read(&file).map(Self).map_err(refuse)
    }

    /// The action of `pick_place` that comes next after a picture of the head camera, rows x columns x 3 numbers from 0 to 255: five numbers from -1 to
    /// 1, or `None` if the task is done. `table`: its extents in units.
    ///
    /// Raises `Error` if the picture has not three colours.
    #[pyo3(signature = (picture, table=(20.0, 12.0)))]
    fn decide<'py>(
        &self,
        py: Python<'py>,
        picture: PyReadonlyArray3<'py, u8>,
        table: (f32, f32),
    ) -> PyResult<Option<Bound<'py, PyArray1<f32>>>> {
        let &[rows, columns, 3] = picture.shape() else {
            return Err(refuse("a picture has rows x columns x 3 numbers"));
        };
        let size = [columns, rows].map(u32::try_from);
        let [Ok(width), Ok(height)] = size else {
            return Err(refuse("the picture is too large"));
        };
        let mut seen = Picture::default();
        seen.resize(width, height);
        seen.rgb = picture.as_array().iter().copied().collect();
        let table = Table {
            xspan: table.0,
            yspan: table.1,
        };
        let head = HeadCamera {
            width,
            height,
            ..HeadCamera::default()
        };
        let camera = Camera::of_head(&head, &table);
        let decision = py.detach(|| self.0.decide(&seen, &camera));
        let Decision::Move { pick, place } = decision else {
            return Ok(None);
        };
        let half = |span: f32| (span / 2.0).max(f32::MIN_POSITIVE);
        let across = [half(table.xspan), half(table.yspan)];
        let (from, to) = (pick.location, place.location);
        let action = [
            from.x / across[0],
            from.y / across[1],
            to.x / across[0],
            to.y / across[1],
            decision.turn() / PI,
        ];
        let action = action.map(|number| number.clamp(-1.0, 1.0));
        Ok(Some(PyArray1::from_vec(py, action.to_vec())))
    }
}
