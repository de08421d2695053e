//! Worlds.

use std::path::PathBuf;

use bevy::math::{Quat, Vec3};
use numpy::{PyArray1, PyArray2, PyArrayMethods as _, PyReadonlyArray1, ToPyArray as _};
use pyo3::{IntoPyObjectExt as _, prelude::*, types::PyDict};
use tabletop::{
    core::{
        Drive, JointName, LimbId, LimbName, ObjectSpec, Robot, RobotCommand, RobotLayout,
        WriteCommand as _,
    },
    environment::{TableWorld, WorldMoment, WorldOptions, WorldOrigin},
    geometry::Pose,
    robot::{end_effector_at, reach},
};

use crate::{
    camera::{camera, depth, rgb, things},
    error::{raise, refuse},
    joints::joints,
};

/// A world; `tabletop.World` is made of it.
#[pyclass(module = "tabletop._tabletop", subclass)]
pub struct World(TableWorld);

/// A world at a moment.
#[pyclass(module = "tabletop._tabletop", frozen)]
pub struct Snapshot(WorldMoment);

/// A pose: location, and rotation as x, y, z, w.
type PoseNumbers = ([f32; 3], [f32; 4]);

fn numbers(pose: Pose) -> PoseNumbers {
    (pose.location.to_array(), pose.rotation.to_array())
}

fn rows<'py, const N: usize>(
    py: Python<'py>,
    rows: Vec<[f32; N]>,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let count = rows.len();
    rows.concat().to_pyarray(py).reshape([count, N])
}

#[pymethods]
impl World {
    #[new]
    #[pyo3(signature = (setup=None, scenario=None, recording=None, robot=None, dynamic=false, show_robot=true, seed=0, allow_paths=Vec::new()))]
    fn new(
        py: Python<'_>,
        setup: Option<PathBuf>,
        scenario: Option<PathBuf>,
        recording: Option<PathBuf>,
        robot: Option<PathBuf>,
        dynamic: bool,
        show_robot: bool,
        seed: u64,
        allow_paths: Vec<PathBuf>,
    ) -> PyResult<Self> {
        let beginning = match (setup, scenario, recording) {
            (None, None, None) => WorldOrigin::Empty,
            (Some(setup), None, None) => WorldOrigin::Setup(setup),
            (None, Some(scenario), None) => WorldOrigin::Scenario(scenario),
            (None, None, Some(recording)) => WorldOrigin::Recording(recording),
            _ => return Err(refuse("expected one of setup, scenario and recording")),
        };
        let options = WorldOptions {
            beginning,
            robot,
            is_dynamic: dynamic,
            shows_robot: show_robot,
            seed,
            is_recordable: true,
            allowed: allow_paths,
        };
        let world = py.detach(|| TableWorld::new(&options));
        world.map(Self).map_err(raise)
    }

    fn step(&mut self, py: Python<'_>, ticks: u64) {
        py.detach(|| self.0.step(ticks));
    }

    fn perform(&mut self, py: Python<'_>, steps: &str) -> PyResult<()> {
        py.detach(|| self.0.perform(steps)).map_err(raise)
    }

    #[getter]
    fn tick(&self) -> u64 {
        self.0.tick()
    }

    /// The facts since the last call, as JSON.
    fn facts(&mut self) -> PyResult<String> {
        serde_json::to_string(&self.0.take_facts()).map_err(refuse)
    }

    /// The objects, as arrays.
    fn objects<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let objects = self.0.objects();
        let each = |of: fn(&ObjectSpec) -> bool| -> Vec<bool> {
            objects.iter().map(|object| of(&object.spec)).collect()
        };
        let color = |spec: &ObjectSpec| {
            let drawn = spec.shape.drawn();
            drawn.first().map_or([0.0; 3], |solid| {
                let color = solid.color;
                [color.red, color.green, color.blue]
            })
        };
        let columns = PyDict::new(py);
        let ids: Vec<_> = objects
            .iter()
            .map(|object| object.spec.id.clone())
            .collect();
        columns.set_item("id", ids)?;
        let location = objects.iter().map(|it| it.pose.location.to_array());
        columns.set_item("location", rows(py, location.collect())?)?;
        let rotation = objects.iter().map(|it| it.pose.rotation.to_array());
        columns.set_item("rotation", rows(py, rotation.collect())?)?;
        let linear = objects.iter().map(|it| it.twist.linear.to_array());
        columns.set_item("velocity", rows(py, linear.collect())?)?;
        let angular = objects.iter().map(|it| it.twist.angular.to_array());
        columns.set_item("angular_velocity", rows(py, angular.collect())?)?;
        let colors = objects.iter().map(|it| color(&it.spec));
        columns.set_item("color", rows(py, colors.collect())?)?;
        let masses: Vec<_> = objects.iter().map(|it| it.spec.mass).collect();
        columns.set_item("mass", masses.to_pyarray(py))?;
        columns.set_item("is_fixed", each(ObjectSpec::is_fixed).to_pyarray(py))?;
        Ok(columns)
    }

    /// Names, positions, velocities, torques, least and greatest positions of the joints.
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        joints(py, self.0.world())
    }

    /// For each limb its name, joints, gripper, end effector, held objects, obstacle and motion.
    fn limbs<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let world = self.0.world();
        let layout = world.resource::<RobotLayout>();
        let robot = world.resource::<Robot>();
        let limbs = layout.limbs.iter().zip(&robot.limbs).map(|(limb, state)| {
            let row = PyDict::new(py);
            row.set_item("name", limb.name.to_string())?;
            let joints = limb
                .joints
                .iter()
                .map(|&it| layout.joint(it).name.to_string());
            row.set_item("joints", joints.collect::<Vec<_>>())?;
            row.set_item("gripper", layout.joint(limb.gripper.joint).name.to_string())?;
            row.set_item("end_effector", numbers(state.end_effector))?;
            let held = state
                .holds
                .iter()
                .filter_map(|&it| world.get::<ObjectSpec>(it));
            row.set_item("holds", held.map(|it| it.id.clone()).collect::<Vec<_>>())?;
            let obstacle = state.blocked_by.as_ref().map(ToString::to_string);
            row.set_item("blocked_by", obstacle)?;
            row.set_item("is_moving", state.is_moving)?;
            Ok(row)
        });
        limbs.collect()
    }

    /// Whether the robot stands at the table.
    #[getter]
    fn robot_is_shown(&self) -> bool {
        self.0.world().resource::<Robot>().is_shown
    }

    /// The robot's name.
    #[getter]
    fn robot_name(&self) -> String {
        self.0.world().resource::<RobotLayout>().name.clone()
    }

    /// The contacts of the robot: body, thing, place on it, impulse.
    fn contacts(&self) -> Vec<(String, String, [f32; 3], f32)> {
        let world = self.0.world();
        let contacts = world.resource::<Robot>().contacts.iter();
        contacts
            .map(|contact| {
                let object = world.get::<ObjectSpec>(contact.thing);
                let thing = object.map_or("table".to_owned(), |object| object.id.clone());
                (
                    contact.body.clone(),
                    thing,
                    contact.point.to_array(),
                    contact.impulse,
                )
            })
            .collect()
    }

    /// Gives joints orders for the next tick.
    fn drive(&mut self, joints: Vec<(String, f64)>, how: &str) -> PyResult<()> {
        let drive = match how {
            "velocity" => Drive::Velocity,
            "position" => Drive::Position,
            "toward" => Drive::Toward,
            "torque" => Drive::Torque,
            other => {
                return Err(refuse(format!(
                    "expected velocity, position, toward or torque, found {other}"
                )));
            }
        };
        let layout = self.0.world().resource::<RobotLayout>();
        let drives = joints.into_iter().map(|(name, value)| {
            let joint = JointName::new(&name).map_err(refuse)?;
            let joint = layout
                .find_joint(joint)
                .ok_or_else(|| refuse(format!("the robot {} has no joint {name}", layout.name)))?;
            Ok((layout.joint(joint).name, drive(value)))
        });
        let drives = drives.collect::<PyResult<Vec<_>>>()?;
        self.0
            .world_mut()
            .write_command(RobotCommand::Drive(drives));
        Ok(())
    }

    /// The end effector's pose at these angles.
    fn fk(&mut self, limb: &str, angles: PyReadonlyArray1<'_, f64>) -> PyResult<PoseNumbers> {
        let limb = self.limb(limb)?;
        let angles = angles.as_slice().map_err(refuse)?;
        let layout = self.0.world().resource::<RobotLayout>();
        let joints = layout.limb(limb).joints.len();
        if angles.len() != joints {
            return Err(refuse(format!(
                "expected {joints} angles, found {}",
                angles.len()
            )));
        }
        Ok(numbers(end_effector_at(self.0.world_mut(), limb, angles)))
    }

    /// Angles that bring the end effector to a pose, near the present ones.
    fn ik<'py>(
        &mut self,
        py: Python<'py>,
        limb: &str,
        location: [f32; 3],
        rotation: [f32; 4],
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let limb = self.limb(limb)?;
        let pose = Pose::new(Vec3::from(location), Quat::from_array(rotation).normalize());
        let angles = reach(self.0.world_mut(), limb, pose).map_err(refuse)?;
        Ok(angles.to_pyarray(py))
    }

    /// The present world before a camera: colours, depths, numbers of things, and their names.
    #[pyo3(signature = (name, size, smooth=true))]
    fn shoot<'py>(
        &mut self,
        py: Python<'py>,
        name: &str,
        size: (u32, u32),
        smooth: bool,
    ) -> PyResult<(Py<PyAny>, Py<PyAny>, Py<PyAny>, Vec<String>)> {
        let cameras = [camera(name, size)?];
        self.0.set_smooth(smooth);
        let shots = py.detach(|| self.0.shoot(&cameras)).map_err(raise)?;
        let shot = &shots[0];
        let (ids, names) = things(py, shot)?;
        Ok((
            rgb(py, &shot.picture)?.into_py_any(py)?,
            depth(py, &shot.picture)?.into_py_any(py)?,
            ids.into_py_any(py)?,
            names,
        ))
    }

    fn snapshot(&mut self, py: Python<'_>) -> Snapshot {
        Snapshot(py.detach(|| self.0.snapshot()))
    }

    fn restore(&mut self, py: Python<'_>, snapshot: &Snapshot) -> PyResult<()> {
        py.detach(|| self.0.restore(&snapshot.0)).map_err(raise)
    }

    /// Saves the table as a task file; returns what a task file cannot express.
    fn save(&self, file: PathBuf) -> PyResult<Vec<String>> {
        self.0.save(&file).map_err(raise)
    }

    /// The folder of the next recording.
    fn record_into(&mut self, folder: PathBuf) -> PyResult<()> {
        self.0.record_into(&folder).map_err(raise)
    }

    /// Ends the recording, if one runs; returns the number of recordings.
    fn finish_recording(&mut self, py: Python<'_>) -> PyResult<usize> {
        py.detach(|| self.0.finish_recording()).map_err(raise)
    }
}

impl World {
    fn limb(&self, name: &str) -> PyResult<LimbId> {
        let layout = self.0.world().resource::<RobotLayout>();
        let limb = LimbName::new(name).ok().and_then(|it| layout.find_limb(it));
        limb.ok_or_else(|| {
            let names: Vec<_> = layout.limbs.iter().map(|it| it.name.to_string()).collect();
            refuse(format!(
                "the robot has no limb {name}, only {}",
                names.join(", ")
            ))
        })
    }
}
