//! Names of the language's elements, by the places where they may stand.

pub(crate) const SHAPES: [&str; 8] = [
    "block",
    "cylinder",
    "frustum",
    "ring",
    "sphere",
    "box",
    "custom",
    "composite",
];

pub(crate) const CONTROLS: [&str; 3] = ["toggleSwitch", "indicatorLights", "customControl"];

pub(crate) const BOND_POINTS: [&str; 2] = ["guestBondPoint", "hostBondPoint"];

/// Elements of objects.
pub(crate) const OBJECTS: [&str; 11] = [
    "block",
    "cylinder",
    "frustum",
    "ring",
    "sphere",
    "box",
    "custom",
    "composite",
    "toggleSwitch",
    "indicatorLights",
    "customControl",
];

pub(crate) const ITEMS: [&str; 17] = [
    "block",
    "cylinder",
    "frustum",
    "ring",
    "sphere",
    "box",
    "custom",
    "composite",
    "toggleSwitch",
    "indicatorLights",
    "customControl",
    "chain",
    "lidbox",
    "sliderJoint",
    "hingeJoint",
    "scissors",
    "pushButton",
];

/// Elements that stand in others.
pub(crate) const INNER: [&str; 9] = [
    "remove",
    "recolor",
    "spawn",
    "guestBondPoint",
    "hostBondPoint",
    "tightness",
    "downstream",
    "state",
    "light",
];

/// Elements that are expanded before the others are read.
pub(crate) const TEMPLATES: [&str; 3] = ["include", "def", "instance"];

pub(crate) const DESCRIPTION: &str = "description";

pub(crate) const TIGHTNESS: &str = "tightness";

pub(crate) const DOWNSTREAM: &str = "downstream";

pub(crate) const STATE: &str = "state";

pub(crate) const LIGHT: &str = "light";
