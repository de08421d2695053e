//! Imitation of demonstrated tasks by a robot: grasps from the geometry of objects, collision-free paths, and a closed loop that looks after
//! each step, compares with the relations of the task, and corrects.
//!
//! [`imitate`] does a [`Task`](tabletop_task::Task) on a [`PlanningStage`], which advances time tick by tick, reports what is seen, and takes
//! joint velocities. [`Execution`] does the same as a [`Controller`](tabletop_controller::Controller). It knows the robot as a [`RobotBody`]: the URDF's links and the frames of the grippers.
//!
//! | from the whole to its parts | |
//! |---|---|
//! | `imitation` | the steps of the task one after the other, with a look after each: `step` does one, `clearing` makes room for it, `regrasp` goes by way of another place, `arms` chooses the arm |
//! | `transfer` | one arm moves one object: `choice` of the grasp, `ways`, `acts`, `slide` along a joint |
//! | `goals`, `grasp`, `standing`, `free_spot` | where an object may go, how it is taken, on which sides it lies, where there is room |
//! | `transit`, `path`, `rrt`, `clearance` | free paths of an arm |
//! | `body`, `arm_length`, `reach` | the robot |
//! | `proximity` | the gaps between its parts, and above the table |
//! | `motion`, `stage`, `sight`, `execution` | the world: acting on it and seeing it, at a stretch or tick by tick |
//! | `scatter`, `feasible` | random places for trials |

mod arm_length;
mod body;
mod clearance;
mod execution;
mod failure;
mod feasible;
mod free_spot;
mod goals;
mod grasp;
mod guarded_gaps;
mod imitation;
mod inside;
mod motion;
mod path;
mod proximity;
mod reach;
mod rrt;
mod scatter;
mod sight;
mod stage;
mod standing;
mod transfer;
mod transit;

pub use body::{LimbBody, RobotBody};
pub use execution::{Execution, ExecutionPace};
pub use failure::PlanFailure;
pub use feasible::is_feasible;
pub use goals::{Before, goal_poses, is_met};
pub use grasp::{Grasp, GraspSide, grasps};
pub use guarded_gaps::GuardedGaps;
pub use imitation::{Doing, Imitation, imitate, undone};
pub use proximity::{NearThing, PartGap, Posed, Ways};
pub use scatter::{Piece, scatter};
pub use sight::{Arranged, Solids};
pub use stage::{Following, LimbOrder, PlanningStage, Stopped, drives};
