//! Dynamics of limbs whose masses are moved by motors.

pub(crate) mod contact_loads;
pub(crate) mod impulse;
pub(crate) mod limb_dynamics;
pub(crate) mod matrix;
pub(crate) mod motor;
pub(crate) mod motors;
