//! Single environments.

use numpy::{PyArray1, PyArray2, PyArray3, PyReadonlyArray1};
use pyo3::{prelude::*, types::PyDict};
use tabletop::{core::RobotLayout, environment};

use crate::{
    camera::{camera, depth, rgb},
    error::{raise, refuse},
    joints::joints,
    options::Options,
};

/// An environment; `tabletop.TabletopEnv` is its face in Gymnasium.
#[pyclass(module = "tabletop._tabletop")]
pub struct Environment(environment::TaskEnvironment);

/// An environment at a moment.
#[pyclass(module = "tabletop._tabletop", frozen)]
pub struct EnvironmentSnapshot(environment::EnvironmentMoment);

#[pymethods]
impl Environment {
    #[new]
    fn new(py: Python<'_>, options: Options) -> PyResult<Self> {
        let (task, options) = options.read()?;
        let made = py.detach(|| environment::TaskEnvironment::new(task, &options));
        made.map(Self).map_err(raise)
    }

    /// Begins an episode.
    #[pyo3(signature = (seed=None))]
    fn reset(&mut self, py: Python<'_>, seed: Option<u64>) -> PyResult<()> {
        py.detach(|| self.0.reset(seed)).map_err(raise)
    }

    /// Acts for a step: reward, success, truncation.
    fn step(
        &mut self,
        py: Python<'_>,
        action: PyReadonlyArray1<'_, f32>,
    ) -> PyResult<(f32, bool, bool)> {
        let action = action.as_slice().map_err(refuse)?;
        let result = py.detach(|| self.0.step(action)).map_err(raise)?;
        Ok((result.reward, result.is_success, result.is_truncated))
    }

    /// Ends the recording of the episode, if there is one.
    fn finish_recording(&mut self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.0.finish_recording()).map_err(raise)
    }

    /// The state.
    fn state<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        let mut state = vec![0.0; self.0.state_layout().numbers()];
        self.0.observe_state(&mut state);
        PyArray1::from_vec(py, state)
    }

    /// Colours and depths of the camera's picture.
    fn picture<'py>(
        &mut self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyArray3<u8>>, Bound<'py, PyArray2<f32>>)> {
        let picture = py.detach(|| self.0.picture()).map_err(raise)?;
        Ok((rgb(py, picture)?, depth(py, picture)?))
    }

    /// Names and colours of the pictures of these cameras, as options name them, all of this size.
    fn shoot<'py>(
        &mut self,
        py: Python<'py>,
        cameras: Vec<String>,
        size: (u32, u32),
    ) -> PyResult<Vec<(String, Bound<'py, PyArray3<u8>>)>> {
        let cameras = cameras.iter().map(|text| camera(text, size));
        let cameras = cameras.collect::<PyResult<Vec<_>>>()?;
        let world = self.0.table_world();
        let shots = py.detach(|| world.shoot(&cameras)).map_err(raise)?;
        let pictures = cameras.iter().zip(shots);
        pictures
            .map(|(camera, shot)| Ok((camera.name.clone(), rgb(py, &shot.picture)?)))
            .collect()
    }

    /// Names, positions, velocities, torques, least and greatest positions of the joints.
    fn joints<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        joints(py, self.0.table_world().world())
    }

    /// For each check of the goal its failure, if it fails, and the two places that it compares.
    fn verdicts(&self) -> Vec<(Option<String>, [f32; 3], [f32; 3])> {
        let verdicts = self.0.verdicts();
        verdicts
            .iter()
            .map(|it| {
                let gap = it.gap;
                (
                    it.failure.clone(),
                    gap.achieved.to_array(),
                    gap.desired.to_array(),
                )
            })
            .collect()
    }

    /// What is to be done in this episode, if it is said.
    #[getter]
    fn instruction(&self) -> Option<&str> {
        self.0.instruction()
    }

    /// The numbers of an action.
    #[getter]
    fn action_length(&self) -> usize {
        self.0.action_len()
    }

    /// The names of the numbers of a state.
    #[getter]
    fn state_names(&mut self) -> Vec<String> {
        let layout = self
            .0
            .table_world()
            .world()
            .resource::<RobotLayout>()
            .clone();
        self.0.state_layout().names(&layout)
    }

    /// The joints that the numbers of the actions `joint_velocity` and `joint_position` move: those of the limbs, then the grippers.
    #[getter]
    fn driven_joints(&mut self) -> Vec<String> {
        let layout = self.0.table_world().world().resource::<RobotLayout>();
        let of_limbs = layout.limbs.iter().flat_map(|limb| limb.joints.iter());
        let grippers = layout.limbs.iter().map(|limb| &limb.gripper.joint);
        let driven = of_limbs.chain(grippers);
        driven
            .map(|&joint| layout.joint(joint).name.to_string())
            .collect()
    }

    /// The number of the robot's numbers in a state.
    #[getter]
    fn robot_numbers(&self) -> usize {
        self.0.state_layout().of_robot()
    }

    /// The number of checks.
    #[getter]
    fn checks(&self) -> usize {
        self.0.state_layout().checks
    }

    /// The ids of the objects of a state.
    #[getter]
    fn objects(&self) -> Vec<String> {
        self.0.state_layout().objects.clone()
    }

    /// The present moment.
    fn snapshot(&mut self, py: Python<'_>) -> EnvironmentSnapshot {
        EnvironmentSnapshot(py.detach(|| self.0.snapshot()))
    }

    /// Returns to a moment.
    fn restore(&mut self, py: Python<'_>, snapshot: &EnvironmentSnapshot) -> PyResult<()> {
        py.detach(|| self.0.restore(&snapshot.0)).map_err(raise)
    }
}
