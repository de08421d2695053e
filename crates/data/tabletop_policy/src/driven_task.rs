//! What a served policy is told of a task, and the circumstances in which it does it.

use tabletop_episodes::multiplication::CameraDisplacement;

use crate::thinking_time::ThinkingTime;

/// A task that a served policy does by moving joints.
#[derive(Clone, Copy, Debug)]
pub struct DrivenTask<'a> {
    /// The task in words.
    pub prompt: &'a str,
    /// Number of ticks in which it must be done.
    pub most: u64,
    /// What the simulation does while the policy thinks.
    pub thinking: ThinkingTime,
    /// How far the cameras that stand are from where the mapping has them.
    pub displacement: Option<CameraDisplacement>,
}
