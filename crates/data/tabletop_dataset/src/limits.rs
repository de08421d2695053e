//! Every tuned number of this crate, each with its unit and the test that holds it in place.

/// The farthest that an object goes within a tick, in units: 12 m/s. Nothing in the shipped scenarios is faster; a hand's glide is a tenth of
/// it (`check::poses` tests a jump of 3 units).
pub(crate) const FARTHEST_IN_TICK: f32 = 2.0;

/// The farthest that an object goes within a frame of a dataset, in units: 2 m/s (`tests/cli/dataset.rs`).
pub(crate) const FARTHEST_IN_FRAME: f32 = 5.0;

/// The farthest that a `move` line may be from the state of its tick, in units and in each number of the rotation; lines have angles of 32 bits
/// (`tests/cli/dataset.rs`).
pub(crate) const NEAR_STATE: f32 = 1e-3;

/// Seconds after the end of a recording for which the goals of its task must hold.
pub(crate) const SECONDS_AFTER: u64 = 5;

/// The farthest that an object may go in this time, in units, and still be where it was put (`tests/cli/dataset.rs`).
pub(crate) const STILL_THERE: f32 = 0.5;

/// Below these speeds, in units/s, rad/s, and of joints in rad/s, nothing moves (`tests/cli/dataset.rs`).
pub(crate) const STILL: f32 = 0.01;

/// Frames that stay before the first and after the last motion when still ends are cut off (`tests/cli/dataset.rs`).
pub(crate) const MARGIN_FRAMES: u64 = 2;

/// Bytes of a file of a recording that are read at most to compare it with others.
pub(crate) const MOST_COMPARED_BYTES: u64 = 1 << 30;

/// Number of episodes of which a card shows pictures.
pub(crate) const SHOWN_EPISODES: usize = 3;
