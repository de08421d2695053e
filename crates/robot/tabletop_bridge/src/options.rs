//! How a robot is driven.

/// How a robot is driven.
#[derive(Clone, Debug, PartialEq)]
pub struct BridgeOptions {
    /// The limbs that are driven, by name; all if there is none.
    pub limbs: Vec<String>,
    /// The share of the joints' greatest speeds that they may have, above 0 and at most 1.
    pub speed: f64,
    /// Whether positions may be farther away than [`FARTHEST_STEP`](crate::FARTHEST_STEP).
    pub allow_moves: bool,
    /// Whether its motors may be switched on at the start. They are never switched on again.
    pub enable: bool,
    /// Whether grippers that do not know their range may find it out at the start, by closing and opening.
    pub calibrate: bool,
    /// Whether a robot is driven whose software is not known.
    pub any_software: bool,
}

impl Default for BridgeOptions {
    fn default() -> Self {
        Self {
            limbs: Vec::new(),
            speed: 0.3, // as Baxter's SDK has it
            allow_moves: false,
            enable: false,
            calibrate: false,
            any_software: false,
        }
    }
}
