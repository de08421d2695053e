//! A policy learned from one demonstration: from the head camera's picture to what is to be taken next, and where it is to be put.
//!
//! A [`Curriculum`] draws scenes in which the task of a demonstration begins, and shows the task step by step. A [`Training`] makes a [`Policy`] of it, a network that
//! looks at the picture, warped onto the table, and answers with two marks: pick and place, each with height and yaw; or that the task is done.
//! The network is our own: a small U-Net with the same bits on every processor and with any number of threads.
//!
//! ```no_run
//! use std::{ops::ControlFlow, path::Path};
//! use tabletop_episodes::multiplication::{Multiplication, Variation};
//! use tabletop_policy::{Curriculum, Training};
//! use tabletop_recorder::RecordingReader;
//!
//! let recording = RecordingReader::open("demo")?;
//! let multiplication = Multiplication::of(&recording, None, Variation::default(), 0)?;
//! let curriculum = Curriculum::new(&multiplication, 2000)?;
//! let file = Path::new("policy.safetensors");
//! let mut training = Training::resume(file, &curriculum, 40_000, 0)?;
//! training.run(&curriculum, 2, file, |_| ControlFlow::Continue(()))?;
//! println!("{} of 100", training.policy().evaluate(&curriculum, 100)?.done.len());
//! # Ok::<_, Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod acting;
mod acting_policy;
mod adam;
mod attempt;
mod convolution;
mod curriculum;
mod driven_task;
mod driving;
mod error;
mod evaluation;
mod heading;
mod known_table;
mod label;
mod loss_curve;
#[cfg(feature = "onnx")]
mod onnx;
mod oracle;
mod picture_policy;
mod place_numbers;
mod planes;
mod policy;
mod remote_policy;
mod resampling;
mod robot_view;
mod served_policy;
mod table_view;
mod tensor_file;
#[cfg(test)]
mod test_recording;
mod thinking_time;
mod training;
mod unet;

pub use acting::{follow_policy, left_undone};
pub use acting_policy::ActingPolicy;
pub use attempt::{Attempt, AttemptProgress};
pub use curriculum::Curriculum;
pub use driven_task::DrivenTask;
pub use driving::follow_actions;
pub use error::PolicyError;
pub use evaluation::{Evaluation, PolicyFailure};
pub use known_table::ToldTask;
pub use label::Yaw;
pub use loss_curve::{LOSS_CURVE, loss_curve};
#[cfg(feature = "onnx")]
pub use onnx::OnnxPolicy;
pub use oracle::OraclePolicy;
pub use picture_policy::PicturePolicy;
pub use policy::{Decision, ObjectPlace, Policy};
pub use remote_policy::{RemoteError, RemotePolicy};
pub use served_policy::ServedPolicy;
pub use thinking_time::ThinkingTime;
pub use training::{Training, TrainingProgress};
