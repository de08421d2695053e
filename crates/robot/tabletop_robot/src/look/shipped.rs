//! The shapes of links that ship inside the program.

macro_rules! shapes {
    ($($robot:literal: $($name:literal),* $(,)?;)*) => {
        /// Names and texts of the files.
        pub(super) const PARTS: &[(&str, &str)] = &[$($((
            concat!($name, ".shape.json"),
            include_str!(concat!("../../../../../assets/", $robot, "/", $name, ".shape.json")),
        ),)*)*];
    };
}

shapes![
    "baxter":
    "finger",
    "gripper_base",
    "head",
    "lower_elbow",
    "lower_forearm",
    "lower_shoulder",
    "pedestal",
    "screen",
    "torso",
    "upper_elbow",
    "upper_forearm",
    "upper_shoulder",
    "wrist";
    "panda": "panda_finger";
];
