//! Messages on the wire of ROS 1: little-endian numbers, lengths of four bytes before texts and lists.

use base64::{Engine as _, engine::general_purpose::STANDARD as BASE64};
use serde_json::{Map, Value as Json, json};

use super::definition::{Field, FieldCount, FieldKind, MessageType};

/// The bytes of a message. Fields that are left out are zero.
pub(super) fn encode(message: &MessageType, json: &Json) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    encode_message(message, json, &mut bytes)?;
    Ok(bytes)
}

/// The message of some bytes, all of which must belong to it.
pub(super) fn decode(message: &MessageType, mut bytes: &[u8]) -> Result<Json, String> {
    let json = decode_message(message, &mut bytes)?;
    match bytes.len() {
        0 => Ok(json),
        left => Err(format!("{left} bytes are left over")),
    }
}

fn encode_message(message: &MessageType, json: &Json, bytes: &mut Vec<u8>) -> Result<(), String> {
    let name = &message.name;
    let object = match json {
        Json::Null => &Map::new(),
        Json::Object(object) => object,
        Json::Bool(_) | Json::Number(_) | Json::String(_) | Json::Array(_) => {
            return Err(format!("{json} is no {name}"));
        }
    };
    let is_known = |key: &String| message.fields.iter().any(|field| field.name == *key);
    if let Some(key) = object.keys().find(|key| !is_known(key)) {
        return Err(format!("{name} has no field {key}"));
    }
    for field in &message.fields {
        let value = object.get(&field.name).unwrap_or(&Json::Null);
        encode_field(field, value, bytes)
            .map_err(|value| format!("{}: {value} does not fit", field.name))?;
    }
    Ok(())
}

fn encode_field(field: &Field, value: &Json, bytes: &mut Vec<u8>) -> Result<(), String> {
    if field.count == FieldCount::One {
        return encode_value(&field.kind, value, bytes);
    }
    let unfit = || value.to_string();
    let values = match value {
        Json::Array(values) => values.as_slice(),
        Json::String(text) if field.kind == FieldKind::Uint8 => {
            let data = BASE64.decode(text).map_err(|_| unfit())?;
            encode_count(field.count, data.len(), bytes).ok_or_else(unfit)?;
            bytes.extend(data);
            return Ok(());
        }
        Json::Null => &[],
        Json::Bool(_) | Json::Number(_) | Json::String(_) | Json::Object(_) => return Err(unfit()),
    };
    encode_count(field.count, values.len(), bytes).ok_or_else(unfit)?;
    values
        .iter()
        .try_for_each(|value| encode_value(&field.kind, value, bytes))
}

/// A list's length; none if it cannot have so many values.
fn encode_count(count: FieldCount, given: usize, bytes: &mut Vec<u8>) -> Option<()> {
    match count {
        FieldCount::One => (given == 1).then_some(()),
        FieldCount::Fixed(count) => (given == count).then_some(()),
        FieldCount::Any => {
            bytes.extend(u32::try_from(given).ok()?.to_le_bytes());
            Some(())
        }
    }
}

fn encode_value(kind: &FieldKind, value: &Json, bytes: &mut Vec<u8>) -> Result<(), String> {
    encode_known(kind, value, bytes).unwrap_or_else(|| Err(value.to_string()))
}

/// None if the value does not fit; an error from within it.
fn encode_known(kind: &FieldKind, value: &Json, bytes: &mut Vec<u8>) -> Option<Result<(), String>> {
    let zero = json!(0);
    let number = if value.is_null() { &zero } else { value };
    macro_rules! whole {
        ($kind:ty, $number:expr) => {
            bytes.extend(<$kind>::try_from($number).ok()?.to_le_bytes())
        };
    }
    match kind {
        FieldKind::Bool => bytes.push(u8::from(!value.is_null() && value.as_bool()?)),
        FieldKind::Int8 => whole!(i8, number.as_i64()?),
        FieldKind::Int16 => whole!(i16, number.as_i64()?),
        FieldKind::Int32 => whole!(i32, number.as_i64()?),
        FieldKind::Int64 => whole!(i64, number.as_i64()?),
        FieldKind::Uint8 => whole!(u8, number.as_u64()?),
        FieldKind::Uint16 => whole!(u16, number.as_u64()?),
        FieldKind::Uint32 => whole!(u32, number.as_u64()?),
        FieldKind::Uint64 => whole!(u64, number.as_u64()?),
        FieldKind::Float32 => bytes.extend((number.as_f64()? as f32).to_le_bytes()),
        FieldKind::Float64 => bytes.extend(number.as_f64()?.to_le_bytes()),
        FieldKind::Text => {
            let text = if value.is_null() { "" } else { value.as_str()? };
            bytes.extend(u32::try_from(text.len()).ok()?.to_le_bytes());
            bytes.extend(text.as_bytes());
        }
        FieldKind::Time => {
            for part in ["secs", "nsecs"] {
                whole!(u32, value.get(part).unwrap_or(&zero).as_u64()?);
            }
        }
        FieldKind::Duration => {
            for part in ["secs", "nsecs"] {
                whole!(i32, value.get(part).unwrap_or(&zero).as_i64()?);
            }
        }
        FieldKind::Message(message) => return Some(encode_message(message, value, bytes)),
    }
    Some(Ok(()))
}

fn decode_message(message: &MessageType, bytes: &mut &[u8]) -> Result<Json, String> {
    let mut object = Map::new();
    for field in &message.fields {
        let value = decode_field(field, bytes)?;
        let value =
            value.ok_or_else(|| format!("{} of {} ends too early", field.name, message.name))?;
        object.insert(field.name.clone(), value);
    }
    Ok(Json::Object(object))
}

/// None if there are too few bytes.
fn decode_field(field: &Field, bytes: &mut &[u8]) -> Result<Option<Json>, String> {
    let count = match field.count {
        FieldCount::One => return decode_value(&field.kind, bytes),
        FieldCount::Fixed(count) => count,
        FieldCount::Any => match take(bytes).map(u32::from_le_bytes) {
            Some(count) => count as usize,
            None => return Ok(None),
        },
    };
    if field.kind == FieldKind::Uint8 {
        let data = bytes.split_off(..count);
        return Ok(data.map(|data| json!(BASE64.encode(data))));
    }
    // A value has a byte at least, so a count beyond what is left is a lie.
    if count > bytes.len() {
        return Ok(None);
    }
    let mut values = Vec::new();
    for _ in 0..count {
        match decode_value(&field.kind, bytes)? {
            Some(value) => values.push(value),
            None => return Ok(None),
        }
    }
    Ok(Some(Json::Array(values)))
}

fn decode_value(kind: &FieldKind, bytes: &mut &[u8]) -> Result<Option<Json>, String> {
    if let FieldKind::Message(message) = kind {
        return decode_message(message, bytes).map(Some);
    }
    Ok(decode_builtin(kind, bytes))
}

fn decode_builtin(kind: &FieldKind, bytes: &mut &[u8]) -> Option<Json> {
    Some(match kind {
        FieldKind::Bool => json!(take::<1>(bytes)? != [0]),
        FieldKind::Int8 => json!(i8::from_le_bytes(take(bytes)?)),
        FieldKind::Int16 => json!(i16::from_le_bytes(take(bytes)?)),
        FieldKind::Int32 => json!(i32::from_le_bytes(take(bytes)?)),
        FieldKind::Int64 => json!(i64::from_le_bytes(take(bytes)?)),
        FieldKind::Uint8 => json!(u8::from_le_bytes(take(bytes)?)),
        FieldKind::Uint16 => json!(u16::from_le_bytes(take(bytes)?)),
        FieldKind::Uint32 => json!(u32::from_le_bytes(take(bytes)?)),
        FieldKind::Uint64 => json!(u64::from_le_bytes(take(bytes)?)),
        // What is not finite becomes null.
        FieldKind::Float32 => json!(f32::from_le_bytes(take(bytes)?)),
        FieldKind::Float64 => json!(f64::from_le_bytes(take(bytes)?)),
        FieldKind::Text => {
            let length = u32::from_le_bytes(take(bytes)?) as usize;
            let text = bytes.split_off(..length)?;
            json!(String::from_utf8_lossy(text))
        }
        FieldKind::Time => {
            let (secs, nsecs) = (
                u32::from_le_bytes(take(bytes)?),
                u32::from_le_bytes(take(bytes)?),
            );
            json!({"secs": secs, "nsecs": nsecs})
        }
        FieldKind::Duration => {
            let (secs, nsecs) = (
                i32::from_le_bytes(take(bytes)?),
                i32::from_le_bytes(take(bytes)?),
            );
            json!({"secs": secs, "nsecs": nsecs})
        }
        FieldKind::Message(_) => return None,
    })
}

fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*first)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn find(name: &str) -> MessageType {
        MessageType::find(name).unwrap()
    }

    #[test]
    fn a_joint_command_has_the_bytes_of_its_layout() {
        let command = json!({"mode": 2, "command": [0.5], "names": ["left_s0"]});
        let bytes = encode(&find("baxter_core_msgs/JointCommand"), &command).unwrap();
        let mut expected = vec![2, 0, 0, 0, 1, 0, 0, 0];
        expected.extend(0.5f64.to_le_bytes());
        expected.extend([1, 0, 0, 0, 7, 0, 0, 0]);
        expected.extend(b"left_s0");
        assert_eq!(bytes, expected);
    }

    #[test]
    fn what_is_left_out_is_zero_and_what_does_not_fit_is_named() {
        let head = find("baxter_core_msgs/HeadPanCommand");
        assert_eq!(encode(&head, &json!({})).unwrap(), [0; 9]);
        let refusal = |json: Json| encode(&head, &json).unwrap_err();
        assert_eq!(
            refusal(json!({"enable_pan_request": 256})),
            "enable_pan_request: 256 does not fit"
        );
        assert_eq!(
            refusal(json!({"aim": 1})),
            "baxter_core_msgs/HeadPanCommand has no field aim"
        );
    }

    #[test]
    fn numbers_that_are_not_finite_are_null() {
        let bytes = f64::NAN.to_le_bytes();
        assert_eq!(
            decode(&find("std_msgs/Float64"), &bytes).unwrap(),
            json!({"data": null})
        );
    }

    #[test]
    fn lengths_that_lie_are_refused() {
        let image = find("sensor_msgs/JointState");
        let mut bytes = vec![0; 16];
        bytes.extend(u32::MAX.to_le_bytes());
        assert_eq!(
            decode(&image, &bytes).unwrap_err(),
            "name of sensor_msgs/JointState ends too early"
        );
        assert_eq!(
            decode(&find("std_msgs/Bool"), &[1, 2]).unwrap_err(),
            "1 bytes are left over"
        );
    }

    fn joint_states() -> impl Strategy<Value = Json> {
        let numbers = || prop::collection::vec(-1e6..1e6f64, 0..20);
        let names = prop::collection::vec(".{0,10}", 0..20);
        (any::<u32>(), any::<u32>(), names, numbers(), numbers()).prop_map(|(seq, secs, name, position, velocity)| {
            let header = json!({"seq": seq, "stamp": {"secs": secs, "nsecs": 5}, "frame_id": "base"});
            json!({"header": header, "name": name, "position": position, "velocity": velocity, "effort": []})
        })
    }

    proptest! {
        #[test]
        fn messages_read_back_as_they_were_written(message in joint_states()) {
            let state = find("sensor_msgs/JointState");
            prop_assert_eq!(decode(&state, &encode(&state, &message).unwrap()).unwrap(), message);
        }

        #[test]
        fn any_bytes_are_a_message_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            for name in ["sensor_msgs/JointState", "sensor_msgs/Image", "baxter_core_msgs/EndEffectorState", "std_msgs/Float64MultiArray"] {
                drop(decode(&find(name), &bytes));
            }
        }
    }
}
