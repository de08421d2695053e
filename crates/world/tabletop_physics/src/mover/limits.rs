//! The constants by which hands and robots move bodies. Lengths are in units of 10 cm.

// Free objects.

/// Gap at which a free object is touched: it is reached in one tick, and pushed from the next one on.
pub const TOUCHING: f32 = 0.01;

/// Depth to which anything is squeezed before its pusher stops.
pub const SQUEEZE: f32 = 0.05;

/// Depth to which a free object is squeezed between its pusher and an immovable solid. A hand yields to a deeper one.
pub const PRESSED: f32 = 0.02;

/// Way by which it is tried whether a free object gives way.
pub const PROBE: f32 = 0.05;

/// Increase of a depth with the way from which on something is in the way.
pub const STEEP: f32 = 0.2;

/// Distance of the objects that a moved body may push in turn.
pub const REACH: f32 = 5.0;

/// Distance at which something is near: more than that at which Rapier looks for contacts.
pub const VICINITY: f32 = 0.5;

/// Largest way in a tick while things in the way are pushed; anything faster has jumped.
pub const JUMP: f32 = 1.0;

/// Largest difference of equal lengths.
pub const SAME_LENGTH: f32 = 1e-4;

/// Largest difference of equal depths.
pub const SAME_DEPTH: f32 = 1e-5;

// Hands, which slide along immovable solids and touch them.

/// Greatest speeds of held objects: in units/s, and in rad/s for turning.
pub const FASTEST: (f32, f32) = (40.0, 10.0);

/// Greatest speed, in units/s, at which a hand pushes free objects. An arm's joints have greatest speeds of their own.
pub const FASTEST_PUSH: f32 = 6.0;

/// Depth from which something is inside an obstacle, and leaves it.
pub const INSIDE: f32 = 0.01;

/// Greatest way in a tick on which something leaves an obstacle.
pub const LEAVING: f32 = 0.1;

/// Least step towards the target near an obstacle: small against the thinnest wall.
pub const SLIDING_STEP: f32 = 0.02;

/// Largest number of steps in a move; a move that needs more continues in the next tick.
pub const MOST_SLIDING_STEPS: usize = 96;

/// Largest number of attempts to slide along obstacles without squeezing a free object.
pub const MOST_SLIDES: usize = 4;

// Arms, which go along a path of joint positions and keep away from immovable solids.

/// Distance that is kept from obstacles. Boxes that are no farther apart are near.
pub const MARGIN: f32 = 0.01;

/// Depth to which an object in a gripper may enter its support: it gives way between the fingers.
pub const GIVE: f32 = 0.03;

/// Largest distance of a body between two checks for obstacles: less than the thickness of a finger.
pub const SWEEPING_STEP: f32 = 0.2;

/// Largest number of checks in a tick: a faster body is checked less densely.
pub const MOST_SWEEPING_STEPS: f32 = 400.0;

/// Number of halvings of the last step, to come as near as possible.
pub const HALVINGS: u32 = 6;

/// Least part of a tick's way that is made.
pub const LEAST_PART: f64 = 0.05;
