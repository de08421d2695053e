//! What is to be done about errors that many scripts meet.

/// What a message says that a struct lacks, and when it is there.
const FIELDS: [(&str, &str); 6] = [
    (
        "rgbVision",
        "sensor.rgbVision is there only when there is a new picture: test with isfield; --picture-every 1 gives one in every call",
    ),
    (
        "trackerLoc",
        "sensor.trackerLoc is there only if this word stands in a file of the scripts' folder; a comment will do",
    ),
    ("objects", TOLD_TOGETHER),
    ("contacts", TOLD_TOGETHER),
    ("held", TOLD_TOGETHER),
    (
        "jointTorques",
        "sensor.jointTorques is there only with --dynamic",
    ),
];

const TOLD_TOGETHER: &str = "sensor.objects, contacts and held are there only if one of these words stands in a file of the scripts' \
    folder, and not with --no-objects";

/// What is there in every call of the callback.
const ALWAYS: [&str; 6] = [
    "timeElapsed",
    "jointAngles",
    "endEffPos",
    "gripperOpening",
    "demoCue",
    "headAngle",
];

/// What to do about an error, if that is known.
pub(crate) fn hint(message: &str, in_init: bool) -> Option<&'static str> {
    if message.contains("agentBehavior") && message.to_lowercase().contains("script") {
        return Some(
            "agentBehavior.m must begin with \"function [init, callback] = agentBehavior()\"",
        );
    }
    let missing = ["member", "field", "attribute"]
        .iter()
        .any(|word| message.contains(word));
    if !missing {
        return None;
    }
    let lacks = |field: &str| {
        let quoted = |mark| message.contains(&format!("{mark}{field}{mark}"));
        quoted('\'') || quoted('"')
    };
    let told = FIELDS.iter().find(|(field, _)| lacks(field));
    if in_init && (told.is_some() || ALWAYS.iter().any(|field| lacks(field))) {
        return Some("sensor is empty in the init script; the callback gets it");
    }
    told.map(|(_, hint)| *hint)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_lacking_is_explained() {
        let octave = "structure has no member 'rgbVision'";
        assert!(hint(octave, false).unwrap().contains("--picture-every 1"));
        assert!(hint(octave, true).unwrap().contains("init"));
        let matlab = "Reference to non-existent field 'objects'.";
        assert!(hint(matlab, false).unwrap().contains("--no-objects"));
        let matlab = "Unrecognized field name \"trackerLoc\".";
        assert!(hint(matlab, false).unwrap().contains("comment"));
        assert_eq!(hint("structure has no member 'mine'", false), None);
        assert_eq!(hint("'rgbVision' undefined", false), None);
        let script = "invalid call to script /x/agentBehavior.m";
        assert!(hint(script, true).unwrap().contains("function"));
    }
}
