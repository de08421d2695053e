//! Advice about errors that many scripts meet.

use crate::{
    error::ScriptError,
    octave::script_folder::{SHARED, holds_function, is_function_file},
};

/// Fields that a message says to be missing, and when they are there.
const FIELDS: [(&str, &str); 7] = [
    (
        "rgbVision",
        "sensor.rgbVision exists only when there is a new picture: test for it first; --picture-every 1 gives one in every call",
    ),
    (
        "trackerLoc",
        "sensor.trackerLoc exists only if the code of a script in the scripts' folder contains this word",
    ),
    (
        "seen",
        "sensor.seen exists from the first picture on, if the code of a script in the scripts' folder contains this word",
    ),
    ("objects", SENT_TOGETHER),
    ("contacts", SENT_TOGETHER),
    ("held", SENT_TOGETHER),
    (
        "jointTorques",
        "sensor.jointTorques exists only with --dynamic",
    ),
];

const SENT_TOGETHER: &str = "sensor.objects, contacts and held exist only if the code of a script in the scripts' folder \
    contains one of these words, and not with --no-objects";

/// Fields that are there in every call of the callback.
const ALWAYS: [&str; 6] = [
    "timeElapsed",
    "jointAngles",
    "endEffPos",
    "gripperOpening",
    "demoCue",
    "headAngle",
];

/// Advice about an error, if there is any.
pub(crate) fn hint(error: &ScriptError, in_init: bool) -> Option<&'static str> {
    let message = error.message.as_str();
    let is_about_behavior = message.contains("agentBehavior");
    let lowercase = message.to_lowercase();
    if is_about_behavior
        && ["script", "too many outputs"]
            .iter()
            .any(|it| lowercase.contains(it))
    {
        return Some(
            "agentBehavior.m must begin with \"function [init, callback] = agentBehavior()\"",
        );
    }
    if is_call_in_agent_behavior(error) {
        return Some(
            "agentBehavior calls the script; to name it, write an @ before it, as in init = @myInit",
        );
    }
    if message.contains("function for @") && message.ends_with(".m") {
        return Some("a handle is named without .m, as in init = @myInit");
    }
    if SHARED.iter().any(|name| is_undefined(name, message)) {
        let location = error.location();
        return Some(
            match location.is_some_and(|location| !is_function_file(&location.file)) {
                true => "it was cleared here; it comes back in the next call",
                false => "a function must say \"global sensor motor aux\"",
            },
        );
    }
    if is_of_own_script(error) {
        return Some(
            "Octave defines the functions in a script only after the lines above them have run; give each a file of its own",
        );
    }
    if message.contains("break must appear") {
        return Some("Octave knows no \"break\" outside a loop; write \"return\"");
    }
    missing_field(message, in_init)
}

/// True if agentBehavior has called a script or function instead of naming it.
fn is_call_in_agent_behavior(error: &ScriptError) -> bool {
    let message = error.message.to_lowercase();
    let in_agent_behavior = error
        .stack
        .iter()
        .take(2)
        .any(|location| location.file.file_stem() == Some("agentBehavior".as_ref()));
    let calls = ["script", "too many output", "value on the right hand side"];
    in_agent_behavior && calls.iter().any(|call| message.contains(call))
}

/// True if a script has called a function that stands further down in it.
fn is_of_own_script(error: &ScriptError) -> bool {
    let name = error
        .message
        .strip_prefix('\'')
        .and_then(|rest| rest.split_once("' undefined"));
    let Some((name, _)) = name else {
        return false;
    };
    error.location().is_some_and(|location| {
        !is_function_file(&location.file) && holds_function(&location.file, name)
    })
}

/// True if there is no such variable, as Octave or MATLAB say it.
fn is_undefined(name: &str, message: &str) -> bool {
    let quoted = format!("'{name}'");
    message.starts_with(&format!("{quoted} undefined"))
        || message.contains(&format!("function or variable {quoted}"))
}

/// Advice about a field that is missing.
fn missing_field(message: &str, in_init: bool) -> Option<&'static str> {
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
    let missing = FIELDS.iter().find(|(field, _)| lacks(field));
    if in_init && (missing.is_some() || ALWAYS.iter().any(|field| lacks(field))) {
        return Some("sensor is empty in the init script; the callback gets it");
    }
    missing.map(|(_, hint)| *hint)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_known_mistakes_get_a_hint() {
        let hint = |message, in_init| hint(&ScriptError::new("", message, ""), in_init);
        let octave = "structure has no member 'rgbVision'";
        assert!(hint(octave, false).unwrap().contains("--picture-every 1"));
        assert!(hint(octave, true).unwrap().contains("init"));
        let matlab = "Reference to non-existent field 'objects'.";
        assert!(hint(matlab, false).unwrap().contains("--no-objects"));
        let matlab = "Unrecognized field name \"trackerLoc\".";
        assert!(hint(matlab, false).unwrap().contains("contains this word"));
        assert_eq!(hint("structure has no member 'mine'", false), None);
        assert_eq!(hint("'rgbVision' undefined", false), None);
        let single = "agentBehavior: function called with too many outputs";
        assert!(hint(single, true).unwrap().contains("[init, callback]"));
        let script = "invalid call to script /x/agentBehavior.m";
        assert!(hint(script, true).unwrap().contains("function"));
        let file = "invalid function handle, unable to find function for @myInit.m";
        assert!(hint(file, true).unwrap().contains("without .m"));
        let matlab = "Unrecognized function or variable 'aux'.";
        assert!(hint(matlab, true).unwrap().contains("global"));
        assert_eq!(hint("'auxiliary' undefined", true), None);
    }

    #[test]
    fn functions_of_a_script_are_to_have_files() {
        let script = std::env::temp_dir().join(format!("tabletop-hint-{}.m", std::process::id()));
        std::fs::write(
            &script,
            "x = twice(2);\nfunction y = twice(x)\ny = 2 * x;\nend\n",
        )
        .unwrap();
        let hint = |message| {
            let stack = format!("1 {}\n", script.display());
            hint(&ScriptError::new("", message, &stack), false)
        };
        assert!(
            hint("'twice' undefined")
                .unwrap()
                .contains("a file of its own")
        );
        assert_eq!(hint("'thrice' undefined"), None);
        std::fs::remove_file(script).unwrap();
    }
}
