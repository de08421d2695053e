//! The simulator for Python: the part of the package `tabletop` that is not written in Python.

mod camera;
mod environment;
mod error;
mod joints;
mod options;
mod policy;
mod vector;
mod world;

use pyo3::prelude::*;

/// The part of the package that is not written in Python.
#[pymodule]
mod _tabletop {
    use std::{ffi::OsString, path::PathBuf, process::ExitCode};

    use numpy::PyArray3;
    use pyo3::prelude::*;
    use tabletop::{environment, recorder::RecordingReader};

    #[pymodule_export]
    use crate::{
        environment::{Environment, EnvironmentSnapshot},
        error::Error,
        policy::Policy,
        vector::Vector,
        world::{Snapshot, World},
    };

    /// The command line: carries out arguments, of which the first is the program's name, and returns the exit code.
    #[pyfunction]
    fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
        let code = py.detach(|| tabletop::cli::main(arguments));
        let codes = 0..=u8::MAX;
        let code = codes.clone().find(|&it| ExitCode::from(it) == code);
        code.unwrap_or(u8::MAX)
    }

    /// The names of the environments that come with the program.
    #[pyfunction]
    fn registered() -> Vec<String> {
        let tasks = environment::registered_tasks().into_iter();
        tasks.map(|task| task.name).collect()
    }

    /// The pictures of a recording, in order: segment, number, tick, file.
    #[pyfunction]
    fn recorded_frames(py: Python<'_>, folder: PathBuf) -> PyResult<Vec<(u32, u64, u64, PathBuf)>> {
        let segments = py.detach(|| RecordingReader::open(folder)?.segments());
        let segments = segments.map_err(crate::error::refuse)?.into_iter();
        let frames = segments.flat_map(|segment| {
            let frames = segment.frames.into_iter();
            frames.map(move |it| (segment.number, it.number, it.tick.0, it.picture.path()))
        });
        Ok(frames.collect())
    }

    /// A picture of a recording: rows x columns x 3 numbers from 0 to 255.
    #[pyfunction]
    fn read_png(py: Python<'_>, file: PathBuf) -> PyResult<Bound<'_, PyArray3<u8>>> {
        crate::camera::read_png(py, &file)
    }

    /// The version of the program.
    #[pyfunction]
    const fn version() -> &'static str {
        env!("CARGO_PKG_VERSION")
    }
}
