//! The shapes of Baxter's links, as part of the program.

macro_rules! shapes {
    ($($name:literal),* $(,)?) => {
        /// Names and texts of the files.
        pub(super) const PARTS: &[(&str, &str)] = &[$((
            concat!($name, ".shape.json"),
            include_str!(concat!("../../../../assets/baxter/", $name, ".shape.json")),
        )),*];
    };
}

shapes![
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
    "wrist",
];
