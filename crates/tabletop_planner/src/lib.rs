//! Imitation of demonstrated tasks by a robot: grasps from the geometry of objects, collision-free paths, and a closed loop that looks after
//! each step, compares with the relations of the task, and corrects.
//!
//! [`imitate`] does a [`Task`](tabletop_task::Task) on a [`PlanningStage`], which advances time tick by tick, reports what is seen, and takes
//! joint velocities. It knows the robot as a [`RobotBody`]: the URDF's links and the frames of the grippers.

mod body;
mod clearance;
mod execution;
mod failure;
mod feasible;
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
pub use feasible::is_feasible;
pub use goals::{Before, is_met};
pub use grasp::{Grasp, GraspSide, grasps};
pub use imitation::{Doing, Imitation, goal_poses, imitate, undone};
pub use scatter::{Piece, scatter};
pub use sight::{LimbSight, SeenObject, Sight};
pub use stage::{LimbOrder, PlanningStage, Stopped};
