//! The task that a recording demonstrates: the manipulations, the relations that each establishes, the goals with the freedoms that
//! symmetry leaves, the order that matters, and the requirements on the objects that take its roles (report sections 1 and 4).
//!
//! A [`Demonstration`] is the relevant part of a recording: the objects, their motions and the acts of the hands. A [`Task`] is its meaning.
//! [`Requirements`] restrict which objects may take its roles, and [`Task::bind`] finds such objects on another table.
//!
//! ```no_run
//! use tabletop_task::Task;
//!
//! let task = Task::read("demo")?;
//! for step in &task.steps {
//!     println!("{}. {}", step.number, step.sentence);
//! }
//! # Ok::<_, Box<dyn std::error::Error>>(())
//! ```

mod arrangement;
mod assignment;
mod binding;
mod comparison;
mod demonstration;
mod described;
mod detour;
mod furniture;
mod goal;
mod inference;
mod instruction;
mod load;
mod manipulation;
mod noun;
mod operation;
mod order;
mod possibility;
mod property;
mod push;
mod reading;
mod relation;
mod requirement;
mod role;
mod rotation;
mod sentence;
mod spot;
mod step;
mod symmetry;
mod task;
mod tipping;
mod track;
mod understanding;

pub use arrangement::Arrangement;
pub use binding::{Binding, Unbound};
pub use comparison::{ComparedObject, compare};
pub use demonstration::{ActDeed, Demonstration, ShownAct, ShownObject};
pub use detour::{Detour, DetourKind};
pub use furniture::Furniture;
pub use goal::{Freedom, Goal, PlaceRange, Reference};
pub use load::CarriedObject;
pub use manipulation::{Ending, Manipulation, Spill};
pub use noun::color_name;
pub use operation::{Operation, OperationDeed};
pub use possibility::ImpossibleRequirement;
pub use property::{has_value, properties, property};
pub use push::Push;
pub use relation::{Relation, RelativeSide};
pub use requirement::{RequirementEdit, RequirementError, Requirements};
pub use role::Role;
pub use rotation::{angle_between, twist_about};
pub use step::TaskStep;
pub use symmetry::{Symmetry, Turns};
pub use task::Task;
pub use tipping::Tipping;
pub use track::Track;
