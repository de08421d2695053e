//! The joints of a robot.

use bevy::prelude::World;
use numpy::ToPyArray as _;
use pyo3::{prelude::*, types::PyDict};
use tabletop::core::{Robot, RobotLayout};

/// Names, positions, velocities, torques, least and greatest positions of the joints of a world's robot.
pub fn joints<'py>(py: Python<'py>, world: &World) -> PyResult<Bound<'py, PyDict>> {
    let layout = world.resource::<RobotLayout>();
    let robot = world.resource::<Robot>();
    let columns = PyDict::new(py);
    let names: Vec<_> = layout.joints.iter().map(|it| it.name.to_string()).collect();
    columns.set_item("name", names)?;
    let states = || robot.joints.iter();
    let array = |numbers: Vec<f64>| numbers.to_pyarray(py);
    columns.set_item("position", array(states().map(|it| it.position).collect()))?;
    columns.set_item("velocity", array(states().map(|it| it.velocity).collect()))?;
    columns.set_item("torque", array(states().map(|it| it.torque).collect()))?;
    for (name, end) in [("low", 0), ("high", 1)] {
        let limits = layout.joints.iter().map(|it| it.limits[end]);
        columns.set_item(name, array(limits.collect()))?;
    }
    Ok(columns)
}
