//! How a robot does what was shown: grasps from the geometry of objects, ways free of collisions, and a closed loop that looks after
//! each step, compares with the relations of the task, and corrects.
//!
//! [`imitate`] does a [`Task`](tabletop_task::Task) on a [`PlanningStage`]: whatever lets time pass tick by tick, tells what is seen, and takes
//! velocities of joints. It knows the robot by a [`RobotBody`]: the URDF's links and the frames of the grippers.

mod body;
mod clearance;
mod execution;
mod failure;
mod free_spot;
mod goals;
mod grasp;
mod imitation;
mod motion;
mod path;
mod rrt;
mod scatter;
mod sight;
mod stage;
mod transfer;
mod transit;

pub use body::{Angles, LimbBody, RobotBody, angles};
pub use execution::{Execution, ExecutionTurn};
pub use failure::PlanFailure;
pub use goals::{Before, is_met};
pub use grasp::{Grasp, grasps};
pub use imitation::{Doing, Imitation, goal_poses, imitate, undone};
pub use scatter::{Piece, scatter};
pub use sight::{LimbSight, SeenObject, Sight};
pub use stage::{LimbOrder, PlanningStage, Stopped};
