//! Files that are wrong in every way: each gives faults, never a panic or a hang, and the table is always there.

use std::{
    path::Path,
    time::{Duration, Instant},
};

use bevy::math::{Quat, Vec3};
use proptest::prelude::*;
use tabletop_core::{
    ChainSpec, LidBoxSpec, NAMED_COLORS, ObjectSpec, Part, Pose, Rgb, SceneItem, SceneSpec, Shape,
    Table,
};
use tabletop_xml::{MAX_FAULTS, MAX_FILE_BYTES, NAMESPACE, ParsedTask, parse, write};

const SAMPLE: &str = r##"<?xml version="1.0" encoding="UTF-8"?>
<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml"
  xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
  xsi:schemaLocation="http://synapse.cs.umd.edu/tabletop-xml tabletop.xsd " xspan="20" yspan="12">
  <!-- é -->
  <block id="a" location="(-2,0,1)" rotation="(0,0,45)" color="green" xspan="2"/>
  <sphere location="(0,0,2)" radius=".5" mass="1e-1"><description name="n" value="&lt;x&gt;"/></sphere>
  <composite location="(0,0,1)" mass="10"><composite id="head" location="(-0.2,0,0)">
    <cylinder color="#00A57F" radius="0.75" yspan="0.8" location="(0,0.9,0)"/></composite></composite>
  <box location="(0,5,1.5)" zspan="3" thickness="0.2"/>
  <chain color="magenta" start="(6,-2,4)" end="(-6,-2,4)" linkCount="12"/>
  <lidbox xspan="6" yspan="5" zspan="5" thickness="0.6" location="(0,0,2.5)" mass="10" handleXspan="1"/>
</tabletop>
"##;

fn read(text: impl AsRef<[u8]>) -> ParsedTask {
    parse(Path::new("f.xml"), text.as_ref())
}

fn lines(text: impl AsRef<[u8]>) -> Vec<String> {
    read(text).faults.iter().map(ToString::to_string).collect()
}

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
            "f.xml:6:1: pyramid: it is not known, expected one of block, cylinder, sphere, box, composite, chain, lidbox",
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
fn a_file_cut_anywhere_keeps_what_is_complete() {
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

/// What holds for every text: its scene can be written and read again, and its faults are in the file.
fn check(text: &[u8]) {
    let task = read(text);
    let Table { xspan, yspan } = task.scene.table;
    assert!((0.001..=1000.0).contains(&xspan) && (0.001..=1000.0).contains(&yspan));
    let written = write(&task.scene);
    let again = read(&written);
    assert_eq!(again.faults, [], "{written}");
    assert_same(again.scene, &task.scene);
    let line_count = String::from_utf8_lossy(text).split(['\n', '\r']).count();
    for fault in &task.faults {
        assert!(
            (1..=line_count).contains(&fault.line) && fault.column >= 1,
            "{fault}"
        );
        assert!(!fault.to_string().contains('\n'), "{fault}");
    }
    assert!(
        task.faults
            .is_sorted_by_key(|fault| (fault.line, fault.column))
    );
}

/// Asserts that two scenes are the same but for the last digits of rotations.
fn assert_same(mut left: SceneSpec, right: &SceneSpec) {
    fn take_over(left: &mut Pose, right: &Pose) {
        let cosine = left.rotation.dot(right.rotation).abs();
        assert!(cosine > 1.0 - 1e-6, "{left:?} and {right:?}");
        left.rotation = right.rotation;
    }
    fn take_over_parts(left: &mut Shape, right: &Shape) {
        if let (Shape::Composite { parts: left }, Shape::Composite { parts: right }) = (left, right)
        {
            for (left, right) in left.iter_mut().zip(right) {
                take_over(&mut left.pose, &right.pose);
                take_over_parts(&mut left.shape, &right.shape);
            }
        }
    }
    for (left, right) in left.items.iter_mut().zip(&right.items) {
        match (left, right) {
            (SceneItem::Object(left), SceneItem::Object(right)) => {
                take_over(&mut left.pose, &right.pose);
                take_over_parts(&mut left.shape, &right.shape);
            }
            (SceneItem::LidBox(left), SceneItem::LidBox(right)) => {
                take_over(&mut left.pose, &right.pose);
            }
            _ => {}
        }
    }
    assert_eq!(left, *right);
}

/// A change of a text at a place, given as a fraction of its length.
#[derive(Clone, Debug)]
enum Mutation {
    Replace(u8),
    Remove(usize),
    Repeat(usize),
    Insert(&'static str),
}

fn mutations() -> impl Strategy<Value = Vec<(f64, Mutation)>> {
    const TOKENS: [&str; 22] = [
        "NaN",
        "1e999",
        "-1",
        "0",
        "&",
        "&x;",
        "&#0;",
        "&#xD800;",
        "<",
        ">",
        "'",
        "\"",
        "\0",
        "(",
        ",",
        "é",
        "\u{ffff}",
        "<block location='(0,0,1)'/>",
        "<ring/>",
        " mass='1' ",
        "<!--",
        "]]>",
    ];
    let mutation = prop_oneof![
        any::<u8>().prop_map(Mutation::Replace),
        (1..60_usize).prop_map(Mutation::Remove),
        (1..200_usize).prop_map(Mutation::Repeat),
        prop::sample::select(&TOKENS[..]).prop_map(Mutation::Insert),
    ];
    prop::collection::vec((0.0..1.0, mutation), 1..6)
}

fn mutate(text: &mut Vec<u8>, place: f64, mutation: &Mutation) {
    let place = (place * text.len() as f64) as usize;
    let end = |length: usize| (place + length).min(text.len());
    match *mutation {
        Mutation::Replace(byte) => {
            text.splice(place..end(1), [byte]);
        }
        Mutation::Remove(length) => {
            text.drain(place..end(length));
        }
        Mutation::Repeat(length) => {
            let copy = text[place..end(length)].to_vec();
            text.splice(place..place, copy);
        }
        Mutation::Insert(token) => {
            text.splice(place..place, token.bytes());
        }
    }
}

fn vectors(most: f32) -> impl Strategy<Value = Vec3> {
    let part = move || prop_oneof![-most..most, Just(0.0), Just(most), Just(-0.1)];
    (part(), part(), part()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn spans() -> impl Strategy<Value = Vec3> {
    let span = || prop_oneof![0.1..10.0_f32, Just(1000.0)];
    (span(), span(), span()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn poses() -> impl Strategy<Value = Pose> {
    let right_angles = prop::array::uniform3(-4..5_i32)
        .prop_map(|turns| Vec3::from_array(turns.map(|turn| turn as f32 * 90.0)));
    let degrees = prop_oneof![vectors(360.0), right_angles];
    (vectors(10_000.0), degrees)
        .prop_map(|(location, degrees)| Pose::from_degrees(location, degrees))
}

fn colors() -> impl Strategy<Value = Rgb> {
    let hex = any::<[u8; 3]>().prop_map(|bytes| {
        let [red, green, blue] = bytes.map(|byte| f32::from(byte) / 255.0);
        Rgb::new(red, green, blue)
    });
    prop_oneof![
        hex,
        prop::sample::select(&NAMED_COLORS[..]).prop_map(|(_, color)| color)
    ]
}

fn masses() -> impl Strategy<Value = f32> {
    prop_oneof![Just(0.0), 0.0..1e6_f32, 1e-30..1e-3_f32]
}

fn descriptions() -> impl Strategy<Value = Vec<(String, String)>> {
    let value = "[ -~\t\n\r\u{e9}\u{2028}\u{fffd}\u{1f600}]{0,12}";
    prop::collection::vec(("[_a-zA-Z0-9]{1,6}", value), 0..3)
}

/// The outer spans of a container, and a thickness of walls that leaves a hollow.
fn containers() -> impl Strategy<Value = (Vec3, f32)> {
    (spans(), 0.02..0.98_f32).prop_map(|(span, part)| {
        let most = (span.x / 2.0).min(span.y / 2.0).min(span.z);
        (span, part * most)
    })
}

fn shapes() -> impl Strategy<Value = Shape> {
    let length = || 0.001..1000.0_f32;
    let simple = prop_oneof![
        (spans(), colors()).prop_map(|(span, color)| Shape::Block { span, color }),
        (length(), length(), colors()).prop_map(|(radius, yspan, color)| Shape::Cylinder {
            radius,
            yspan,
            color
        }),
        (length(), colors()).prop_map(|(radius, color)| Shape::Sphere { radius, color }),
        (containers(), colors()).prop_map(|((span, thickness), color)| Shape::Box {
            span,
            thickness,
            color
        }),
    ];
    simple.prop_recursive(4, 12, 3, |inner| {
        let part = ("[_a-zA-Z0-9]{0,3}", poses(), inner).prop_map(|(id, pose, shape)| Part {
            id,
            pose,
            shape,
        });
        prop::collection::vec(part, 1..4).prop_map(|parts| Shape::Composite { parts })
    })
}

fn objects() -> impl Strategy<Value = ObjectSpec> {
    (
        "[_a-zA-Z0-9]{0,5}",
        poses(),
        masses(),
        shapes(),
        descriptions(),
    )
        .prop_map(|(id, pose, mass, shape, descriptions)| ObjectSpec {
            id,
            pose,
            mass,
            shape,
            descriptions,
        })
}

fn chains() -> impl Strategy<Value = ChainSpec> {
    let ends = (vectors(100.0), vectors(100.0))
        .prop_filter("two places", |(start, end)| start.distance(*end) > 0.001);
    let link = (
        1.0..10.0_f32,
        prop::option::of(0..10_u32),
        0.0..2.0_f32,
        masses(),
    );
    ("[_a-zA-Z0-9]{0,5}", ends, link, colors()).prop_map(
        |(id, (start, end), (yspan, spare_links, link_padding, link_mass), color)| {
            let chain = ChainSpec {
                id,
                start,
                end,
                link_span: Vec3::new(0.1, yspan, 0.2),
                link_count: 0,
                link_padding,
                link_mass,
                color,
            };
            let link_count = spare_links.map_or(0, |spare| chain.least_links().max(1) + spare);
            ChainSpec {
                link_count,
                ..chain
            }
        },
    )
}

fn lidboxes() -> impl Strategy<Value = LidBoxSpec> {
    let boxes = (containers(), colors(), masses());
    let lids = (containers(), colors(), masses());
    ("[_a-zA-Z0-9]{0,5}", poses(), boxes, lids, descriptions()).prop_map(
        |(
            id,
            pose,
            ((span, thickness), color, box_mass),
            (handle, handle_color, lid_mass),
            descriptions,
        )| LidBoxSpec {
            id,
            pose,
            span,
            thickness,
            box_mass,
            lid_mass,
            color,
            handle_span: handle.0,
            handle_thickness: handle.1,
            handle_color,
            descriptions,
        },
    )
}

fn scenes() -> impl Strategy<Value = SceneSpec> {
    let table =
        (0.001..1000.0_f32, 0.001..1000.0_f32).prop_map(|(xspan, yspan)| Table { xspan, yspan });
    let item = prop_oneof![
        4 => objects().prop_map(SceneItem::Object),
        1 => chains().prop_map(SceneItem::Chain),
        1 => lidboxes().prop_map(SceneItem::LidBox),
    ];
    (table, prop::collection::vec(item, 0..5)).prop_map(|(table, items)| SceneSpec { table, items })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_read(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        check(&bytes);
    }

    #[test]
    fn any_marks_of_xml_are_read(text in "[<>/!?&;='\"\\[\\]() \\-a:xmlns#0-9,.\\n]{0,80}") {
        check(text.as_bytes());
        check(format!("<tabletop xmlns='{NAMESPACE}'>{text}</tabletop>").as_bytes());
    }

    #[test]
    fn damaged_files_are_read(mutations in mutations()) {
        let mut text = SAMPLE.as_bytes().to_vec();
        for (place, mutation) in &mutations {
            mutate(&mut text, *place, mutation);
        }
        check(&text);
    }

    #[test]
    fn what_is_written_reads_back(scene in scenes()) {
        let written = write(&scene);
        let task = read(&written);
        prop_assert_eq!(task.faults, [], "{}", written);
        assert_same(task.scene, &scene);
    }
}

#[test]
fn a_difference_of_rotations_is_found() {
    let object = |rotation| SceneSpec {
        items: vec![SceneItem::Object(ObjectSpec {
            id: String::new(),
            pose: Pose::new(Vec3::ZERO, rotation),
            mass: 1.0,
            shape: Shape::Sphere {
                radius: 1.0,
                color: Rgb::GRAY,
            },
            descriptions: vec![],
        })],
        ..Default::default()
    };
    let turned = Quat::from_rotation_x(0.01);
    assert_same(object(turned), &object(-turned));
    let compared =
        std::panic::catch_unwind(|| assert_same(object(turned), &object(Quat::IDENTITY)));
    assert!(compared.is_err());
}
