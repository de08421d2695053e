//! Every rule of the language of task files, as `tabletop check` applies it.

use std::{fmt::Write as _, fs};

use crate::support::{place, stderr, stdout, tabletop};

/// A rule, the text of a file in it after the first line, and the faults that it must have, each from `line:column: ` on.
type Rule = (&'static str, &'static str, &'static [&'static str]);

/// Files and folders.
const FILES: &[Rule] = &[
    ("an empty table", "", &[]),
    (
        "the later program's namespace is needed",
        "<block xmlns='' location='(0,0,1)'/>",
        &["2:1: block: "],
    ),
    (
        "a prefix",
        "<t:block xmlns:t='http://synapse.cs.umd.edu/tabletop-xml' location='(0,0,1)'/>",
        &[],
    ),
    (
        "includes lead nowhere else",
        "<include file='../a.xml'/>",
        &["2:10: include, file: "],
    ),
    (
        "includes are files",
        "<include file='missing.xml'/>",
        &["2:10: include, file: "],
    ),
    (
        "includes stand in the root",
        "<composite location='(0,0,1)'><include file='a.xml'/><block location='(0,0,0)'/></composite>",
        &["2:31: include: "],
    ),
    (
        "meshes are files",
        "<custom file='missing.stl' location='(0,0,1)'/>",
        &["2:9: custom, file: "],
    ),
    (
        "meshes lead nowhere else",
        "<custom file='/etc/passwd' location='(0,0,1)'/>",
        &["2:9: custom, file: "],
    ),
];

/// Values of attributes.
const VALUES: &[Rule] = &[
    (
        "vectors",
        "<block location='( 1 , -.5,+2.e0 )' rotation=' (0,0,1E-3)'/>",
        &[],
    ),
    (
        "vectors of two",
        "<block location='(1,2)'/>",
        &["2:8: block, location: "],
    ),
    (
        "vectors without parentheses",
        "<block location='1,2,3'/>",
        &["2:8: block, location: "],
    ),
    (
        "named colours",
        "<block location='(0,0,1)' color='LightGray'/>",
        &[],
    ),
    (
        "colours by numbers",
        "<block location='(0,0,1)' color=' #fF8800 '/>",
        &[],
    ),
    (
        "colours that are none",
        "<block location='(0,0,1)' color='#ff880'/>",
        &["2:27: block, color: "],
    ),
    (
        "spans are not too small",
        "<block location='(0,0,1)' xspan='0.001' yspan='0.0009'/>",
        &["2:41: block, yspan: "],
    ),
    (
        "spans are not negative",
        "<block location='(0,0,1)' xspan='-1'/>",
        &["2:27: block, xspan: "],
    ),
    (
        "masses are not negative",
        "<block location='(0,0,1)' mass='-1'/>",
        &["2:27: block, mass: "],
    ),
    (
        "nothing weighs nothing",
        "<block location='(0,0,1)' mass='0'/>",
        &[],
    ),
    (
        "counts are whole",
        "<chain start='(3,0,3)' end='(0,0,3)' linkCount='2.5'/>",
        &["2:38: chain, linkCount: "],
    ),
    (
        "counts are not negative",
        "<chain start='(3,0,3)' end='(0,0,3)' linkCount='-1'/>",
        &["2:38: chain, linkCount: "],
    ),
    (
        "the next state is a state",
        "<customControl location='(0,0,1)'><state><block location='(0,0,0)' nextStateWhenTriggered='-1'/></state></customControl>",
        &[],
    ),
    (
        "the next state is not less than -1",
        "<customControl location='(0,0,1)'><state><block location='(0,0,0)' nextStateWhenTriggered='-2'/></state></customControl>",
        &["2:68: block, nextStateWhenTriggered: "],
    ),
    (
        "proportions",
        "<sliderJoint location='(0,0,1)' damping='1.1'><block location='(0,0,0)'/><block location='(2,0,0)'/></sliderJoint>",
        &["2:33: sliderJoint, damping: "],
    ),
    (
        "ids have letters, digits and underscores",
        "<block id='a-b' location='(0,0,1)'/>",
        &["2:8: block, id: "],
    ),
    ("ids may be empty", "<block id='' location='(0,0,1)'/>", &[]),
    (
        "truth values are words or digits",
        "<toggleSwitch location='(0,0,1)' leftPressed='1'/><toggleSwitch location='(2,0,1)' leftPressed='false'/>",
        &[],
    ),
    (
        "other words are no truth values",
        "<toggleSwitch location='(0,0,1)' leftPressed='yes'/>",
        &["2:34: toggleSwitch, leftPressed: "],
    ),
];

/// Where elements may stand.
const PLACES: &[Rule] = &[
    (
        "single objects in the root and in composites",
        "<composite location='(0,0,1)'><block location='(0,0,0)'/><cylinder location='(0,0,0)'/><frustum location='(0,0,0)'/><ring location='(0,0,0)'/><sphere location='(0,0,0)'/><box location='(0,0,0)'/><composite location='(0,0,0)'><block location='(0,0,0)'/></composite><toggleSwitch location='(0,0,0)'/><indicatorLights location='(0,0,0)'><state/></indicatorLights><customControl location='(0,0,0)'><state/></customControl><guestBondPoint type='a'/><hostBondPoint type='a'><tightness/></hostBondPoint></composite>",
        &[],
    ),
    (
        "bond points stand in composites",
        "<guestBondPoint type='a'/>",
        &["2:1: guestBondPoint: "],
    ),
    (
        "chains stand in the root",
        "<composite location='(0,0,1)'><block location='(0,0,0)'/><chain start='(0,0,1)' end='(3,0,1)'/></composite>",
        &["2:58: chain: "],
    ),
    (
        "joints hold two",
        "<sliderJoint location='(0,0,1)'><block location='(0,0,0)'/></sliderJoint>",
        &["2:1: sliderJoint: "],
    ),
    (
        "joints hold no more than two",
        "<sliderJoint location='(0,0,1)'><block location='(0,0,0)'/><block location='(2,0,0)'/><block location='(4,0,0)'/></sliderJoint>",
        &["2:1: sliderJoint: "],
    ),
    (
        "states hold no controls",
        "<customControl location='(0,0,1)'><state><toggleSwitch location='(0,0,0)'/></state></customControl>",
        &["2:42: toggleSwitch: "],
    ),
    (
        "composites hold something",
        "<composite location='(0,0,1)'/>",
        &["2:1: composite: "],
    ),
    (
        "masses are those of whole objects",
        "<composite location='(0,0,1)'><block location='(0,0,0)' mass='1'/></composite>",
        &["2:57: block, mass: "],
    ),
    (
        "descriptions are those of whole objects",
        "<composite location='(0,0,1)'><block location='(0,0,0)'><description name='a' value='b'/></block></composite>",
        &["2:57: description: "],
    ),
    (
        "descriptions come anywhere",
        "<composite location='(0,0,1)'><block location='(0,0,0)'/><description name='a' value='b'/></composite>",
        &[],
    ),
    (
        "next states are those of states",
        "<block location='(0,0,1)' nextStateWhenTriggered='1'/>",
        &["2:27: block, nextStateWhenTriggered: "],
    ),
    (
        "templates stand in the root",
        "<composite location='(0,0,1)'><block location='(0,0,0)'/><def name='d'/></composite>",
        &["2:58: def: "],
    ),
    (
        "variables stand in templates",
        "<var name='a' value='1'/>",
        &["2:1: var: "],
    ),
];

/// Attributes and elements.
const ELEMENTS: &[Rule] = &[
    (
        "locations are needed",
        "<block/>",
        &["2:1: block, location: "],
    ),
    (
        "unknown attributes",
        "<block location='(0,0,1)' size='1'/>",
        &["2:27: block, size: "],
    ),
    (
        "ids may be there twice",
        "<block id='a' location='(0,0,1)'/><block id='a' location='(2,0,1)'/>",
        &[],
    ),
    (
        "sides",
        "<cylinder location='(0,0,1)' sides='2'/>",
        &["2:30: cylinder, sides: "],
    ),
    (
        "walls leave a hollow",
        "<box location='(0,0,1)' thickness='0.5'/>",
        &["2:25: box, thickness: "],
    ),
    (
        "rings are hollow",
        "<ring location='(0,0,1)' radiusInner='1'/>",
        &["2:26: ring, radiusInner: "],
    ),
    (
        "STL files are needed",
        "<custom location='(0,0,1)'/>",
        &["2:1: custom, file: "],
    ),
    (
        "descriptions have names and values",
        "<block location='(0,0,1)'><description name='' value='a'/><description name='a'/></block>",
        &["2:40: description, name: ", "2:59: description, value: "],
    ),
    (
        "shapes may be described",
        "<block location='(0,0,1)'><description name='shape' value='brick'/></block>",
        &[],
    ),
    (
        "chains reach",
        "<chain start='(-3,0,3)' end='(3,0,3)' linkCount='5'/>",
        &["2:39: chain, linkCount: "],
    ),
    (
        "chains sag",
        "<chain start='(-3,0,3)' end='(3,0,3)' linkCount='6'/>",
        &[],
    ),
    (
        "lid boxes of 2014",
        "<lidbox location='(0,0,2.5)' zspan='5' handleColor='red' handleXspan='1'/>",
        &[],
    ),
    (
        "lid boxes between",
        "<lidbox location='(0,0,2.5)' zspan='5' lidMass='0.1' handleThickness='0.1'/>",
        &[],
    ),
    (
        "least and greatest displacements",
        "<sliderJoint location='(0,0,1)' min='1' max='0'><block location='(0,0,0)'/><block location='(2,0,0)'/></sliderJoint>",
        &["2:33: sliderJoint, min: "],
    ),
    (
        "first displacements are between them",
        "<sliderJoint location='(0,0,1)' init='7'><block location='(0,0,0)'/><block location='(2,0,0)'/></sliderJoint>",
        &[],
    ),
    (
        "what is downstream may be missing",
        "<toggleSwitch location='(0,0,1)'><downstream id='nothing'/></toggleSwitch>",
        &[],
    ),
    (
        "what is downstream has an id",
        "<toggleSwitch location='(0,0,1)'><downstream/></toggleSwitch>",
        &["2:34: downstream, id: "],
    ),
    (
        "lights have states",
        "<indicatorLights location='(0,0,1)'/>",
        &["2:1: indicatorLights: "],
    ),
    (
        "lights have numbers",
        "<indicatorLights location='(0,0,1)'><state><light id='2'/></state></indicatorLights>",
        &["2:51: light, id: "],
    ),
    (
        "first states are states",
        "<indicatorLights location='(0,0,1)' initState='1'><state/></indicatorLights>",
        &["2:37: indicatorLights, initState: "],
    ),
    (
        "first states of switches are bounded",
        "<toggleSwitch location='(0,0,1)' initState='9'/>",
        &[],
    ),
    (
        "bond points have types",
        "<composite location='(0,0,1)'><block location='(0,0,0)'/><guestBondPoint/></composite>",
        &["2:58: guestBondPoint, type: "],
    ),
    (
        "types are not empty",
        "<composite location='(0,0,1)'><block location='(0,0,0)'/><guestBondPoint type=' '/></composite>",
        &["2:74: guestBondPoint, type: "],
    ),
    (
        "hosts have steps",
        "<composite location='(0,0,1)'><block location='(0,0,0)'/><hostBondPoint type='a'/></composite>",
        &["2:58: hostBondPoint: "],
    ),
    (
        "what is faulty inside has no other faults",
        "<indicatorLights location='(0,0,1)' numLights='3' lightRadius='1'><state><light id='two'/></state></indicatorLights>",
        &["2:81: light, id: "],
    ),
    (
        "names of dev builds",
        "<customShape file='a.stl' location='(0,0,1)'/>",
        &["2:1: customShape: "],
    ),
];

/// Files made of files, and templates.
const TEMPLATES: &[Rule] = &[
    (
        "arithmetic without templates",
        "<block location='($1+2*3$,0,1)'/>",
        &[],
    ),
    (
        "defaults that use other variables",
        "<def name='d'><var name='half' value='$h/2$'/><var name='h' value='3'/><block location='(0,0,$half$)' zspan='$h$'/></def><instance def='d'/>",
        &[],
    ),
    (
        "a literal sign before dollars",
        "<def name='d'><var name='a' value='3'/><block location='(-$a/3$,+$a$,1)'/></def><instance def='d'/>",
        &[],
    ),
    (
        "misspelt variables",
        "<def name='d'><var name='rotation' value='(0,0,0)'/><block location='(0,0,1)' rotation='$rotation$'/></def><instance def='d'><var name='rocation' value='(0,0,9)'/></instance>",
        &[],
    ),
    (
        "variables that are not there",
        "<block location='(0,0,$h$)'/>",
        &["2:8: block, location: "],
    ),
    (
        "division by zero",
        "<block location='(0,0,$1/0$)'/>",
        &["2:8: block, location: "],
    ),
    (
        "words",
        "<def name='d'><var name='c' value='red'/><block location='(0,0,1)' color='$c$'/></def><instance def='d'/>",
        &[],
    ),
    (
        "text after an expression",
        "<block location='(0,0,$2 x$)'/>",
        &[],
    ),
    (
        "numbers before variables",
        "<def name='d'><var name='2' value='x'/><block location='(0,0,$2$)'/></def><instance def='d'/>",
        &[],
    ),
    (
        "derived arguments",
        "<def name='d'><var name='a' value='1'/><var name='b' value='1'/><block location='(0,0,$b$)'/></def><instance def='d'><var name='b' value='$a*2$' derived='true'/></instance>",
        &[],
    ),
    (
        "arguments see what is around",
        "<def name='in'><var name='x' value='0'/><block location='($x$,0,1)'/></def><def name='out'><var name='y' value='3'/><instance def='in'><var name='x' value='$y+1$'/></instance></def><instance def='out'/>",
        &[],
    ),
    (
        "instances in composites",
        "<def name='d'><block location='(0,0,0)'/></def><composite location='(0,0,1)'><instance def='d'/></composite>",
        &[],
    ),
    (
        "instances of nothing",
        "<instance def='d'/>",
        &["2:11: instance, def: "],
    ),
    (
        "instances in themselves",
        "<def name='d'><instance def='d'/></def><instance def='d'/>",
        &["2:25: instance, def: "],
    ),
    (
        "instances in each other",
        "<def name='d'><instance def='e'/></def><def name='e'><instance def='d'/></def><instance def='d'/>",
        &["2:64: instance, def: "],
    ),
    (
        "two of a name",
        "<def name='d'><block location='(0,0,1)'/></def><def name='d'><block location='(2,0,1)'/></def><instance def='d'/>",
        &["2:53: def, name: "],
    ),
    (
        "faults are theirs and the instance's",
        "<def name='d'><block location='(0,0,1)' color='reed'/></def>\n<instance def='d'/>",
        &["2:41: block, color: `reed` is not a colour"],
    ),
    (
        "variables come anywhere",
        "<def name='d'><block location='(0,0,1)'/><var name='a' value='1'/></def><instance def='d'/>",
        &[],
    ),
];

/// All rules, by chapters.
const RULES: [(&str, &[Rule]); 5] = [
    ("files", FILES),
    ("values", VALUES),
    ("places", PLACES),
    ("elements", ELEMENTS),
    ("templates", TEMPLATES),
];

#[test]
fn every_rule_is_checked() {
    let folder = place("language");
    fs::create_dir(&folder).unwrap();
    let mut arguments = vec!["check".to_owned()];
    let (mut accepted, mut rejected) = (String::new(), Vec::new());
    for (chapter, rules) in RULES {
        for (number, (_, content, faults)) in rules.iter().enumerate() {
            let path = folder.join(format!("{chapter}-{number}.xml"));
            let path = path.to_str().unwrap().to_owned();
            let namespace = "http://synapse.cs.umd.edu/tabletop-xml";
            let text = format!("<tabletop xmlns='{namespace}'>\n{content}\n</tabletop>\n");
            fs::write(&path, text).unwrap();
            match faults {
                [] => writeln!(accepted, "{path}: ok").unwrap(),
                faults => rejected.extend(faults.iter().map(|fault| format!("{path}:{fault}"))),
            }
            arguments.push(path);
        }
    }
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    let output = tabletop(&arguments);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(stdout(&output), accepted);
    let told = stderr(&output);
    assert_eq!(told.lines().count(), rejected.len(), "{told}");
    for (told, expected) in told.lines().zip(&rejected) {
        assert!(told.starts_with(expected), "{told} instead of {expected}");
    }
}

#[test]
fn a_fault_in_an_instance_names_the_instance() {
    let path = place("in-an-instance.xml");
    let text = "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml'>\n\
                <def name='d'><block location='(0,0,1)' color='reed'/></def>\n\
                <def name='e'><instance def='d'/></def>\n<instance def='e'/>\n</tabletop>\n";
    fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap();
    let told = stderr(&tabletop(&["check", path]));
    assert!(
        told.starts_with(&format!("{path}:2:41: block, color: ")),
        "{told}"
    );
    let instances = format!("(in the instance at {path}:3:15, in that at {path}:4:1)\n");
    assert!(told.ends_with(&instances), "{told}");
}
