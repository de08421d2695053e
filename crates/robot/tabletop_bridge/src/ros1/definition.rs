//! Message types of ROS 1: their fields, and the checksums by which two nodes know that they mean the same.

use std::{collections::BTreeSet, fmt::Write as _};

use md5::{Digest as _, Md5};

/// The types that this program sends and reads, as their packages define them, without the comments.
const DEFINITIONS: [(&str, &str); 15] = [
    ("std_msgs/Bool", "bool data"),
    ("std_msgs/Float64", "float64 data"),
    ("std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id"),
    (
        "std_msgs/MultiArrayDimension",
        "string label\nuint32 size\nuint32 stride",
    ),
    (
        "std_msgs/MultiArrayLayout",
        "MultiArrayDimension[] dim\nuint32 data_offset",
    ),
    (
        "std_msgs/Float64MultiArray",
        "MultiArrayLayout layout\nfloat64[] data",
    ),
    (
        "sensor_msgs/JointState",
        "Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort",
    ),
    (
        "sensor_msgs/Image",
        "Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data",
    ),
    (
        "baxter_core_msgs/JointCommand",
        "int32 mode\nfloat64[] command\nstring[] names\nint32 POSITION_MODE=1\nint32 VELOCITY_MODE=2\nint32 TORQUE_MODE=3\nint32 RAW_POSITION_MODE=4",
    ),
    (
        "baxter_core_msgs/AssemblyState",
        "bool ready\nbool enabled\nbool stopped\nbool error\n\
         uint8 estop_button\nuint8 ESTOP_BUTTON_UNPRESSED=0\nuint8 ESTOP_BUTTON_PRESSED=1\nuint8 ESTOP_BUTTON_UNKNOWN=2\nuint8 ESTOP_BUTTON_RELEASED=3\n\
         uint8 estop_source\nuint8 ESTOP_SOURCE_NONE=0\nuint8 ESTOP_SOURCE_USER=1\nuint8 ESTOP_SOURCE_UNKNOWN=2\nuint8 ESTOP_SOURCE_FAULT=3\nuint8 ESTOP_SOURCE_BRAIN=4",
    ),
    (
        "baxter_core_msgs/HeadPanCommand",
        "float32 target\nfloat32 speed_ratio\nfloat32 MAX_SPEED_RATIO=1.0\nfloat32 MIN_SPEED_RATIO=0.0\n\
         uint8 enable_pan_request\nuint8 REQUEST_PAN_DISABLE=0\nuint8 REQUEST_PAN_ENABLE=1\nuint8 REQUEST_PAN_VOID=2",
    ),
    (
        "baxter_core_msgs/EndEffectorCommand",
        "uint32 id\nstring command\nstring CMD_NO_OP=no_op\nstring CMD_SET=set\nstring CMD_CONFIGURE=configure\nstring CMD_REBOOT=reboot\n\
         string CMD_RESET=reset\nstring CMD_CALIBRATE=calibrate\nstring CMD_CLEAR_CALIBRATION=clear_calibration\n\
         string CMD_PREPARE_TO_GRIP=prepare_to_grip\nstring CMD_GRIP=grip\nstring CMD_RELEASE=release\nstring CMD_GO=go\nstring CMD_STOP=stop\n\
         string args\nstring sender\nuint32 sequence",
    ),
    (
        "baxter_core_msgs/EndEffectorState",
        "time timestamp\nuint32 id\nuint8 STATE_FALSE=0\nuint8 STATE_TRUE=1\nuint8 STATE_UNKNOWN=2\nuint8 enabled\nuint8 calibrated\nuint8 ready\n\
         uint8 moving\nuint8 gripping\nuint8 missed\nuint8 error\nuint8 reverse\nfloat32 position\nfloat32 POSITION_CLOSED=0.0\n\
         float32 POSITION_OPEN=100.0\nfloat32 force\nfloat32 FORCE_MIN=0.0\nfloat32 FORCE_MAX=100.0\nstring state\nstring command\n\
         string command_sender\nuint32 command_sequence",
    ),
    (
        "baxter_core_msgs/CameraControl",
        "int32 id\nint32 value\nint32 CAMERA_CONTROL_EXPOSURE=100\nint32 CAMERA_CONTROL_GAIN=101\nint32 CAMERA_CONTROL_WHITE_BALANCE_R=102\n\
         int32 CAMERA_CONTROL_WHITE_BALANCE_G=103\nint32 CAMERA_CONTROL_WHITE_BALANCE_B=104\nint32 CAMERA_CONTROL_WINDOW_X=105\n\
         int32 CAMERA_CONTROL_WINDOW_Y=106\nint32 CAMERA_CONTROL_FLIP=107\nint32 CAMERA_CONTROL_MIRROR=108\nint32 CAMERA_CONTROL_RESOLUTION_HALF=109",
    ),
    (
        "baxter_core_msgs/CameraSettings",
        "int32 width\nint32 height\nfloat32 fps\nCameraControl[] controls",
    ),
];

/// The services that this program calls: requests and answers.
const SERVICES: [(&str, &str, &str); 1] = [(
    "baxter_core_msgs/OpenCamera",
    "string name\nCameraSettings settings",
    "int32 err",
)];

/// A line between the definition of a type and those of the types in it.
const SEPARATOR: &str =
    "================================================================================";

/// A message type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct MessageType {
    /// Such as `std_msgs/Bool`.
    pub(super) name: String,
    /// Its fields, in their order on the wire.
    pub(super) fields: Vec<Field>,
    /// Its checksum, in hexadecimal digits.
    pub(super) checksum: String,
    /// Its definition with those of the types in it.
    pub(super) definition: String,
    /// What the checksum is of.
    canonical: String,
}

/// A service's type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ServiceType {
    pub(super) request: MessageType,
    pub(super) answer: MessageType,
    pub(super) checksum: String,
}

/// A field of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: FieldKind,
    pub(super) count: FieldCount,
}

/// How many values a field has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FieldCount {
    One,
    Fixed(usize),
    Any,
}

/// The values of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum FieldKind {
    Bool,
    Int8,
    Int16,
    Int32,
    Int64,
    Uint8,
    Uint16,
    Uint32,
    Uint64,
    Float32,
    Float64,
    Text,
    Time,
    Duration,
    Message(Box<MessageType>),
}

impl FieldKind {
    fn builtin(name: &str) -> Option<Self> {
        Some(match name {
            "bool" => Self::Bool,
            "int8" | "byte" => Self::Int8,
            "int16" => Self::Int16,
            "int32" => Self::Int32,
            "int64" => Self::Int64,
            "uint8" | "char" => Self::Uint8,
            "uint16" => Self::Uint16,
            "uint32" => Self::Uint32,
            "uint64" => Self::Uint64,
            "float32" => Self::Float32,
            "float64" => Self::Float64,
            "string" => Self::Text,
            "time" => Self::Time,
            "duration" => Self::Duration,
            _ => return None,
        })
    }
}

impl MessageType {
    /// The type of a name; none if this program does not know it.
    pub(super) fn find(name: &str) -> Option<Self> {
        let (_, text) = DEFINITIONS.iter().find(|(known, _)| *known == name)?;
        Self::parse(name, text)
    }

    /// The type that a text defines; none if it names one that is not known.
    fn parse(name: &str, text: &str) -> Option<Self> {
        let package = name.split('/').next().unwrap_or_default();
        let (mut constants, mut canonical) = (String::new(), String::new());
        let mut fields = Vec::new();
        let mut inner = BTreeSet::new();
        for line in text.lines() {
            let (kind, rest) = line.trim().split_once(' ')?;
            if rest.contains('=') {
                writeln!(constants, "{kind} {rest}").ok()?;
                continue;
            }
            let (bare, count) = match kind.split_once('[') {
                None => (kind, FieldCount::One),
                Some((bare, "]")) => (bare, FieldCount::Any),
                Some((bare, count)) => {
                    let count = count.strip_suffix(']')?.parse().ok()?;
                    (bare, FieldCount::Fixed(count))
                }
            };
            let kind = match FieldKind::builtin(bare) {
                Some(builtin) => {
                    writeln!(canonical, "{kind} {rest}").ok()?;
                    builtin
                }
                None => {
                    let message = Self::find(&full_name(package, bare))?;
                    writeln!(canonical, "{} {rest}", message.checksum).ok()?;
                    for part in message.definition.split(SEPARATOR).skip(1) {
                        inner.insert(part.to_owned());
                    }
                    let own = message
                        .definition
                        .split(SEPARATOR)
                        .next()
                        .unwrap_or_default();
                    inner.insert(format!("\nMSG: {}\n{}", message.name, own.trim_end()) + "\n");
                    FieldKind::Message(Box::new(message))
                }
            };
            fields.push(Field {
                name: rest.to_owned(),
                kind,
                count,
            });
        }
        let canonical = (constants + &canonical).trim().to_owned();
        let parts = inner.iter().map(|part| format!("{SEPARATOR}{part}"));
        Some(Self {
            name: name.to_owned(),
            fields,
            checksum: hexadecimal(&canonical),
            definition: format!("{text}\n{}", parts.collect::<String>()),
            canonical,
        })
    }
}

impl ServiceType {
    /// The type of a name; none if this program does not know it.
    pub(super) fn find(name: &str) -> Option<Self> {
        let (_, request, answer) = SERVICES.iter().find(|(known, ..)| *known == name)?;
        let request = MessageType::parse(name, request)?;
        let answer = MessageType::parse(name, answer)?;
        let checksum = hexadecimal(&(request.canonical.clone() + &answer.canonical));
        Some(Self {
            request,
            answer,
            checksum,
        })
    }
}

/// A type's name with its package.
fn full_name(package: &str, name: &str) -> String {
    match name {
        "Header" => "std_msgs/Header".to_owned(),
        name if name.contains('/') => name.to_owned(),
        name => format!("{package}/{name}"),
    }
}

fn hexadecimal(text: &str) -> String {
    let digest = Md5::digest(text);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computed by genpy 0.6.16 from the packages' own files.
    const CHECKSUMS: [(&str, &str); 11] = [
        ("std_msgs/Bool", "8b94c1b53db61fb6aed406028ad6332a"),
        ("std_msgs/Float64", "fdb28210bfa9d7c91146260178d9a584"),
        ("std_msgs/Header", "2176decaecbce78abc3b96ef049fabed"),
        (
            "std_msgs/Float64MultiArray",
            "4b7d974086d4060e7db4613a7e6c3ba4",
        ),
        ("sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd"),
        ("sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743"),
        (
            "baxter_core_msgs/JointCommand",
            "19bfec8434dd568ab3c633d187c36f2e",
        ),
        (
            "baxter_core_msgs/AssemblyState",
            "356d9dd237ce73b2667da9235f541933",
        ),
        (
            "baxter_core_msgs/HeadPanCommand",
            "23b8a3f4b7ee9de7099d029e57660a8c",
        ),
        (
            "baxter_core_msgs/EndEffectorCommand",
            "c003234e90416f2ca02ac7837c42cbb7",
        ),
        (
            "baxter_core_msgs/EndEffectorState",
            "ade777f069d738595bc19e246b8ec7a0",
        ),
    ];

    #[test]
    fn checksums_are_those_of_the_packages() {
        for (name, checksum) in CHECKSUMS {
            assert_eq!(
                MessageType::find(name).unwrap().checksum,
                checksum,
                "{name}"
            );
        }
        let open = ServiceType::find("baxter_core_msgs/OpenCamera").unwrap();
        assert_eq!(open.request.checksum, "c4194eee32741c5a98ef8da9666fa6c9");
        assert_eq!(open.checksum, "73eacff63d5f9cca2d986614515a5c8c");
        assert_eq!(MessageType::find("std_msgs/Nothing"), None);
    }

    #[test]
    fn a_definition_has_the_types_in_it() {
        let image = MessageType::find("sensor_msgs/Image").unwrap();
        let (own, inner) = image.definition.split_once(SEPARATOR).unwrap();
        assert!(own.ends_with("uint8[] data\n"));
        assert_eq!(
            inner,
            "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
        );
        let array = MessageType::find("std_msgs/Float64MultiArray").unwrap();
        assert_eq!(array.definition.matches(SEPARATOR).count(), 2);
    }
}
