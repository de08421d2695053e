//! Files with faults that come to mind.

use std::time::{Duration, Instant};

use tabletop_core::Table;
use tabletop_geometry::NAMED_COLORS;
use tabletop_xml::{MAX_FAULTS, MAX_FILE_BYTES, NAMESPACE};

use crate::{SAMPLE, lines, read};

#[test]
fn the_sample_has_no_faults() {
    let task = read(SAMPLE);
    assert_eq!(task.faults, []);
    assert_eq!(task.scene.items.len(), 6);
}

#[test]
fn five_faults_give_five_located_messages() {
    let text = format!(
        "<?xml version=\"1.0\"?>\n\
         <tabletop xmlns=\"{NAMESPACE}\" xspan=\"wide\" yspan=\"8\">\n\
           <block id=\"good\" location=\"(0,0,1)\"/>\n\
           <block location=\"(1,0,1)\" color=\"reed\"/>\n\
           <sphere radius=\"1\"/>\n\
           <pyramid location=\"(0,0,1)\"/>\n\
           <box location=\"(3,0,1)\" thicknes=\"0.1\"/>\n\
           <sphere id=\"also_good\" location=\"(2,0,1)\"/>\n\
         </tabletop>"
    );
    let colors = NAMED_COLORS.map(|(name, _)| name).join(", ");
    assert_eq!(
        lines(&text),
        [
            "f.xml:2:58: tabletop, xspan: `wide` is not a number, expected a number from 0.001 to 1000",
            &format!(
                "f.xml:4:27: block, color: `reed` is not a colour, expected #rrggbb or one of {colors}"
            ),
            "f.xml:5:1: sphere, location: it is missing, expected location=\"(x,y,z)\"",
            "f.xml:6:1: pyramid: it is not known, expected one of block, cylinder, frustum, ring, sphere, box, custom, composite, toggleSwitch, indicatorLights, customControl, chain, lidbox, sliderJoint, hingeJoint, scissors, pushButton",
            "f.xml:7:25: box, thicknes: it is not known, expected thickness",
        ]
    );
    let scene = read(&text).scene;
    assert_eq!(
        scene.table,
        Table {
            xspan: 20.0,
            yspan: 8.0
        }
    );
    assert_eq!(scene.items.len(), 2);
}

#[test]
fn a_file_cut_anywhere_keeps_its_complete_elements() {
    let end = SAMPLE.trim_end().len();
    let mut items = 0;
    for length in 0..end {
        let task = read(&SAMPLE.as_bytes()[..length]);
        assert_eq!(task.faults.len(), 1, "{length}: {:?}", task.faults);
        assert!(task.scene.items.len() >= items, "{length}");
        items = task.scene.items.len();
        assert_eq!(task.scene.table, Table::default());
    }
    assert_eq!(items, 6);
}

#[test]
fn deep_nesting_is_a_fault() {
    for (opening, closing) in [
        ("<composite location='(0,0,0)'>", "</composite>"),
        ("<x>", "</x>"),
        ("<x>", ""),
    ] {
        let levels = opening.repeat(10_000) + &closing.repeat(10_000);
        let text = format!("<tabletop xmlns='{NAMESPACE}'>{levels}</tabletop>");
        assert!(!read(text).faults.is_empty());
    }
}

#[test]
fn entity_bombs_are_not_expanded() {
    let mut bomb = String::from("<!DOCTYPE tabletop [<!ENTITY e0 'ha'>");
    for level in 1..100 {
        bomb += &format!(
            "<!ENTITY e{level} '{}'>",
            format!("&e{};", level - 1).repeat(10)
        );
    }
    bomb += &format!(
        "]><tabletop xmlns='{NAMESPACE}'><block location='(0,0,1)' id='&e99;'/></tabletop>"
    );
    let lines = lines(bomb);
    assert_eq!(lines.len(), 2, "{lines:?}");
    assert!(lines[0].contains("entities are declared"));
    assert!(lines[1].contains("block, id: `&e99;` is not a known entity"));
}

#[test]
fn other_encodings_are_faults() {
    let utf16: Vec<u8> = SAMPLE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let with_mark = [&[0xff, 0xfe], utf16.as_slice()].concat();
    for bytes in [utf16, with_mark] {
        assert_eq!(
            lines(bytes),
            ["f.xml:1:1: the file is in UTF-16, expected a file in UTF-8"]
        );
    }
    let latin1: Vec<u8> = SAMPLE
        .chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap())
        .collect();
    assert_eq!(
        lines(latin1),
        ["f.xml:5:8: tabletop: byte 0xe9 is not UTF-8, expected a file in UTF-8"]
    );
    let declared = SAMPLE.replace("UTF-8", "ISO-8859-1");
    assert_eq!(
        lines(&declared),
        ["f.xml:1:1: the encoding is `ISO-8859-1`, expected UTF-8"]
    );
    assert_eq!(lines(declared.replace('é', "e")), [""; 0]);
    assert_eq!(lines("\u{feff}".to_owned() + SAMPLE), [""; 0]);
}

#[test]
fn numbers_that_are_none_are_faults() {
    for number in [
        "NaN",
        "nan",
        "inf",
        "-Infinity",
        "1e999",
        "-1e999",
        "0x1p3",
        "1_0",
        "",
        "1e39",
    ] {
        for attribute in [
            "xspan='?'",
            "mass='?'",
            "rotation='(0,?,0)'",
            "location='(?,0,0)'",
        ] {
            let attribute = attribute.replace('?', number);
            let location = if attribute.starts_with("loc") {
                ""
            } else {
                "location='(0,0,0)'"
            };
            let text =
                format!("<tabletop xmlns='{NAMESPACE}'><block {location} {attribute}/></tabletop>");
            let task = read(&text);
            assert_eq!(task.faults.len(), 1, "{text}");
            assert!(task.scene.items.is_empty(), "{text}");
        }
    }
}

#[test]
fn many_faults_are_reported_up_to_a_limit() {
    let text = format!(
        "<tabletop xmlns='{NAMESPACE}'>{}</tabletop>",
        "<block/>\n".repeat(9_000)
    );
    let task = read(&text);
    assert_eq!(task.faults.len(), MAX_FAULTS + 1);
    assert_eq!(task.faults[MAX_FAULTS].problem, "more faults follow");
}

#[test]
fn huge_files_are_read_in_seconds() {
    let root = format!("<tabletop xmlns='{NAMESPACE}'>");
    let block = format!("{root}<block location='(0,0,1)' ");
    for (begin, repeated) in [
        ("", " "),
        ("", "<"),
        ("", "<a>"),
        ("", "<!--"),
        ("", "&amp;"),
        (&*root, "<block/>"),
        (&*root, "<x>"),
        (&*root, "<x xmlns:a='b'>"),
        (&*root, "text &amp; "),
        (&*root, "<![CDATA[]]>"),
        (&*root, "<?p?>"),
        (&*root, "</x>"),
        (&*block, "a='' "),
        (&*block, "a "),
        (&*block, "xmlns:a='b' "),
        (&*block, "id='' "),
        (&format!("{block} id='"), "&amp;"),
        (&format!("{block} id='"), "&lt;<"),
        (&format!("{block} mass='"), "9"),
        (&format!("{block} rotation='("), "0,"),
        ("<!DOCTYPE a [", "<!ENTITY a 'b'>"),
        ("<!DOCTYPE a ", "["),
    ] {
        let mut text = begin.to_owned();
        text += &repeated.repeat((MAX_FILE_BYTES - begin.len()) / repeated.len());
        if text.contains("='") && !repeated.contains('\'') {
            text.truncate(MAX_FILE_BYTES - 20);
            let end = text
                .trim_end_matches(|c: char| c != ';' && c != '9' && c != ',')
                .len();
            text.truncate(end.max(begin.len()));
            text += "'/></tabletop>";
        }
        let start = Instant::now();
        let task = read(&text);
        let time = start.elapsed();
        assert!(!task.faults.is_empty(), "{repeated}");
        assert!(task.faults.len() <= MAX_FAULTS + 1);
        assert!(
            task.faults
                .iter()
                .all(|fault| fault.to_string().len() < 1000),
            "{repeated}"
        );
        assert!(time < Duration::from_secs(20), "{repeated}: {time:?}");
    }
    assert_eq!(
        lines(vec![b'<'; 20 << 20]),
        ["f.xml:1:1: the file is too large, expected at most 16777216 bytes"]
    );
}
