//! Many environments.

use std::sync::{Mutex, MutexGuard, PoisonError};

use numpy::{PyArray1, PyArray3, PyArrayMethods as _, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::{prelude::*, types::PyDict};
use tabletop::environment::{Autoreset, VectorEnvironment, VectorResults};

use crate::{
    camera::rgb,
    error::{raise, refuse},
    options::Options,
};

/// Many environments; `tabletop.TabletopVectorEnv` is their face in Gymnasium.
#[pyclass(module = "tabletop._tabletop", frozen)]
pub struct Vector {
    vector: Mutex<VectorEnvironment>,
    /// The process that made it: its threads are in no other.
    process: u32,
    size: [usize; 2],
}

impl Vector {
    fn get(&self) -> PyResult<MutexGuard<'_, VectorEnvironment>> {
        if self.process != std::process::id() {
            return Err(refuse(
                "these environments were made before the process was forked, and their threads are not here; make them in the child",
            ));
        }
        Ok(self.vector.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Asks Python whether the user has pressed Ctrl-C.
fn goes_on() -> bool {
    Python::attach(|py| py.check_signals().is_ok())
}

/// The exception of a wait that Ctrl-C has ended is that of Ctrl-C.
fn raise_unless_interrupted(
    py: Python<'_>,
    error: tabletop::environment::EnvironmentError,
) -> PyErr {
    match PyErr::take(py) {
        Some(interrupt) => interrupt,
        None if error.to_string() == "interrupted" => {
            pyo3::exceptions::PyKeyboardInterrupt::new_err(())
        }
        None => raise(error),
    }
}

#[pymethods]
impl Vector {
    #[new]
    fn new(
        py: Python<'_>,
        options: Options,
        count: usize,
        threads: usize,
        autoreset: &str,
    ) -> PyResult<Self> {
        let autoreset = match autoreset {
            "next_step" => Autoreset::NextStep,
            "same_step" => Autoreset::SameStep,
            "disabled" => Autoreset::Disabled,
            other => {
                return Err(refuse(format!(
                    "autoreset: expected next_step, same_step or disabled, found {other}"
                )));
            }
        };
        let (task, options) = options.read()?;
        let [width, height] = options.camera.size.unwrap_or_default();
        let vector =
            py.detach(|| VectorEnvironment::new(&task, &options, count, threads, autoreset));
        Ok(Self {
            vector: Mutex::new(vector.map_err(raise)?),
            process: std::process::id(),
            size: [height as usize, width as usize],
        })
    }

    /// Begins an episode in those of these numbers, each with its seed.
    fn reset(&self, py: Python<'_>, seeds: Vec<(usize, Option<u64>)>) -> PyResult<()> {
        let done = py.detach(|| Ok::<_, PyErr>(self.get()?.reset_some(&seeds, goes_on)))?;
        done.map_err(|error| raise_unless_interrupted(py, error))
    }

    /// Acts for a step in each.
    fn step(&self, py: Python<'_>, actions: PyReadonlyArray2<'_, f32>) -> PyResult<()> {
        let actions = actions.as_slice().map_err(refuse)?;
        let done = py.detach(|| Ok::<_, PyErr>(self.get()?.step(actions, goes_on)))?;
        done.map_err(|error| raise_unless_interrupted(py, error))
    }

    /// Lets some be stepped.
    fn send(
        &self,
        py: Python<'_>,
        numbers: PyReadonlyArray1<'_, i64>,
        actions: PyReadonlyArray2<'_, f32>,
    ) -> PyResult<()> {
        let actions = actions.as_slice().map_err(refuse)?;
        let numbers: Vec<_> = numbers
            .as_slice()
            .map_err(refuse)?
            .iter()
            .map(|&number| usize::try_from(number).unwrap_or(usize::MAX))
            .collect();
        py.detach(|| Ok::<_, PyErr>(self.get()?.send(&numbers, actions)))?
            .map_err(raise)
    }

    /// Waits for so many that are ready.
    fn receive<'py>(&self, py: Python<'py>, count: usize) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let numbers = py.detach(|| Ok::<_, PyErr>(self.get()?.receive(count, goes_on)))?;
        let numbers = numbers.map_err(|error| raise_unless_interrupted(py, error))?;
        let numbers: Vec<_> = numbers.into_iter().map(|number| number as i64).collect();
        Ok(PyArray1::from_vec(py, numbers))
    }

    /// Copies the results into arrays that Python has made, by their names; of those that are missing nothing.
    fn copy_results(&self, into: &Bound<'_, PyDict>) -> PyResult<()> {
        let vector = self.get()?;
        let VectorResults {
            states,
            rgb,
            depth,
            rewards,
            successes,
            truncations,
            last,
            ..
        } = vector.results();
        copy(into, "state", states)?;
        copy(into, "rgb", rgb)?;
        copy(into, "depth", depth)?;
        copy(into, "reward", rewards)?;
        copy(into, "success", successes)?;
        copy(into, "truncation", truncations)?;
        copy(into, "last_state", &last.states)?;
        copy(into, "last_rgb", &last.rgb)?;
        copy(into, "last_depth", &last.depth)
    }

    /// What is not yet as it should be in each, and what was not at the end of those episodes that have ended in this step.
    fn failures(&self) -> PyResult<[Vec<Vec<String>>; 2]> {
        let vector = self.get()?;
        let results = vector.results();
        Ok([results.failures.clone(), results.last.failures.clone()])
    }

    /// What is to be done in each, and what was in those episodes that have ended in this step; empty if it is not said.
    fn instructions(&self) -> PyResult<[Vec<String>; 2]> {
        let vector = self.get()?;
        let results = vector.results();
        Ok([
            results.instructions.clone(),
            results.last.instructions.clone(),
        ])
    }

    /// The pictures of all: rows x columns x 3.
    fn pictures<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray3<u8>>>> {
        let mut vector = self.get()?;
        let numbers = 0..vector.len();
        let pictures = numbers.map(|number| {
            let environment = vector.environment(number).ok_or_else(|| {
                refuse(format!("environment {number} is stepped; receive it first"))
            })?;
            let picture = py.detach(|| environment.picture()).map_err(raise)?;
            rgb(py, picture)
        });
        pictures.collect()
    }

    /// Ends the recordings of the episodes.
    fn finish_recordings(&self, py: Python<'_>) -> PyResult<()> {
        let done = py.detach(|| Ok::<_, PyErr>(self.get()?.finish_recordings()))?;
        done.map_err(raise)
    }

    /// Rows and columns of pictures.
    #[getter]
    const fn size(&self) -> [usize; 2] {
        self.size
    }
}

fn copy<T: numpy::Element + Copy>(
    into: &Bound<'_, PyDict>,
    name: &str,
    from: &[T],
) -> PyResult<()> {
    let Some(array) = into.get_item(name)? else {
        return Ok(());
    };
    let array = array
        .cast::<PyArray1<T>>()
        .map_err(|_| refuse(format!("{name}: expected a flat array of its type")))?;
    let mut array = array.try_readwrite().map_err(refuse)?;
    let slice = array.as_slice_mut().map_err(refuse)?;
    if slice.len() != from.len() {
        return Err(refuse(format!(
            "{name}: expected {} numbers, found {}",
            from.len(),
            slice.len()
        )));
    }
    slice.copy_from_slice(from);
    Ok(())
}
