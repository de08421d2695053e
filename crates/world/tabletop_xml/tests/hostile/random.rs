//! Files with random faults, and scenes that are written and read again.

use std::path::Path;

use bevy::math::{Quat, Vec3};
use proptest::prelude::*;
use tabletop_core::{ObjectSpec, SceneItem, SceneSpec, Shape, Table};
use tabletop_geometry::{Pose, Rgb};
use tabletop_xml::{NAMESPACE, expand, write};

use crate::{SAMPLE, read, scenes::scenes};

/// Asserts the invariants of every text: its scene can be written and read again, and its faults are in the file.
fn check(text: &[u8]) {
    let task = read(text);
    let Table { xspan, yspan } = task.scene.table;
    assert!((0.001..=1000.0).contains(&xspan) && (0.001..=1000.0).contains(&yspan));
    let written = write(&task.scene);
    let again = read(&written);
    assert_eq!(again.faults, [], "{written}");
    assert_same(again.scene, &task.scene);
    let expanded = expand(Path::new("f.xml"), text);
    let again = read(&expanded.text);
    assert_eq!(again.scene, task.scene, "{}", expanded.text);
    assert_eq!(expanded.faults, task.faults);
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
            (SceneItem::Jointed(left), SceneItem::Jointed(right)) => {
                take_over(&mut left.pose, &right.pose);
                for (left, right) in left.objects.iter_mut().zip(&right.objects) {
                    take_over(&mut left.pose, &right.pose);
                    take_over_parts(&mut left.shape, &right.shape);
                }
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

const TEMPLATE_TOKENS: [&str; 24] = [
    "<def name='a'>",
    "<def name='b'>",
    "</def>",
    "<instance def='a'>",
    "<instance def='b'/>",
    "<instance def='$x$'/>",
    "</instance>",
    "<var name='x' value='$y$'/>",
    "<var name='y' value='$x+1$'/>",
    "<var name='x' value='2'/>",
    "<var name='y' value='a' derived='true'/>",
    "<var name='y' value='$x$$x$'/>",
    "<include file='a.xml'/>",
    "<block location='($x$,$y$,1)'/>",
    "<block location='(0,0,1)' id='$y$'/>",
    "<block location='(0,0,1)' xspan='$x/2*(y-1)$'/>",
    "<sphere location='(0,0,1)' radius='$1/0$'/>",
    "<sphere location='(0,0,1)'><description name='n' value='$$ $ $x$'/></sphere>",
    "<composite location='(0,0,1)'>",
    "</composite>",
    "<sphere location='(0,0,1)'/>",
    "$x$",
    "<x>",
    "&",
];

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
    fn any_templates_are_read(tokens in prop::collection::vec(prop::sample::select(&TEMPLATE_TOKENS[..]), 0..30)) {
        let text = format!("<tabletop xmlns='{NAMESPACE}'>{}</tabletop>", tokens.concat());
        check(text.as_bytes());
        check(tokens.concat().as_bytes());
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
    fn written_text_reads_back(scene in scenes()) {
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
            dynamics: Default::default(),
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
