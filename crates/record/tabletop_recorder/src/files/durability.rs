//! The durability of recordings over a loss of power.

/// The durability of recordings over a loss of power. A crash or a kill of the program costs at most a tick in any case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Durability {
    /// As much as the operating system has written by then: for recordings that are thrown away.
    None,
    /// All of it, once it is finished. Until then nothing waits for the disk, which would hold up a real robot's orders.
    #[default]
    AtFinish,
    /// All of it up to its last tick. Costs several writes to the disk a tick.
    EveryTick,
}
