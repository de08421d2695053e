//! Definitions and instances.

use tabletop_core::Shape;

use crate::{faults, ids, objects, only_object, read, scene, span};

const CUBE: &str = "<def name='cube'><var name='side' value='1'/><var name='id' value='cube'/>\
    <var name='color' value='red'/><var name='location' value='(0,0,1)'/>\
    <block id='$id$' location='$location$' color='$color$' xspan='$side$' yspan='$side$' zspan='$side$'/></def>";

#[test]
fn an_instance_is_a_copy_with_its_arguments_and_else_defaults() {
    let cube = only_object(&format!("{CUBE}<instance def='cube'/>"));
    assert_eq!(cube.id, "cube");
    let cube = only_object(&format!(
        "{CUBE}<instance def='cube'><var name='side' value='2.5'/><var name='color' value='#0000ff'/>\
         <var name='location' value='(1,2,3)'/></instance>"
    ));
    assert_eq!(cube.pose.location.to_array(), [1.0, 2.0, 3.0]);
    let Shape::Block { span, color } = cube.shape else {
        panic!("{cube:?}")
    };
    assert_eq!(span.to_array(), [2.5; 3]);
    assert_eq!(color, "blue".parse().unwrap());
}

#[test]
fn objects_and_instances_stand_in_the_order_of_the_file() {
    let content = format!(
        "<sphere id='a' location='(0,0,1)'/><instance def='cube'><var name='id' value='b'/></instance>\
         <sphere id='c' location='(0,0,1)'/>{CUBE}\
         <instance def='cube'><var name='id' value='d'/></instance>"
    );
    assert_eq!(ids(&content), ["a", "b", "c", "d"]);
}

#[test]
fn instances_nest_and_their_ids_compose() {
    let content = format!(
        "{CUBE}<def name='pair'><var name='id' value='pair'/>\
         <instance def='cube'><var name='id' value='$id$_left'/></instance>\
         <instance def='cube'><var name='id' value='$id$_right'/></instance></def>\
         <instance def='pair'/><instance def='pair'><var name='id' value='other'/></instance>"
    );
    assert_eq!(
        ids(&content),
        ["pair_left", "pair_right", "other_left", "other_right"]
    );
}

#[test]
fn an_instance_stands_where_its_content_may_stand() {
    let composite = only_object(
        "<def name='parts'><var name='x' value='1'/><block id='near' location='($x$,0,0)'/>\
         <sphere id='far' location='($2*x$,0,0)'/></def>\
         <def name='note'><description name='use' value='$use$'/></def>\
         <composite location='(0,0,1)'><instance def='note'><var name='use' value='toy'/></instance>\
         <instance def='parts'/><instance def='parts'><var name='x' value='-3'/></instance></composite>",
    );
    assert_eq!(composite.descriptions, [("use".into(), "toy".into())]);
    let places: Vec<_> = composite
        .shape
        .simple_parts()
        .iter()
        .map(|part| part.pose.location.x)
        .collect();
    assert_eq!(places, [1.0, 2.0, -3.0, -6.0]);
    assert_eq!(
        faults(
            "<def name='ball'><sphere location='(0,0,1)'/></def><chain start='(0,0,1)' end='(1,0,1)'>\
                <instance def='ball'/></chain>"
        ),
        ["f:2:18: sphere: it cannot stand in <chain> (in the instance at f:2:89)"]
    );
}

#[test]
fn a_definition_can_hold_nothing() {
    assert!(
        scene("<def name='nothing'/><instance def='nothing'/>")
            .items
            .is_empty()
    );
}

#[test]
fn an_instance_of_nothing_is_left_out() {
    let task = read(&format!(
        "{CUBE}\n<instance def='cub'/>\n<instance def='sphere'/>\n<instance/>\n<instance def=''/>\n\
         <sphere location='(0,0,1)'/>"
    ));
    let lines: Vec<_> = task.faults.iter().map(ToString::to_string).collect();
    assert_eq!(
        lines,
        [
            "f:3:11: instance, def: `cub` is not defined, expected cube",
            "f:4:11: instance, def: `sphere` is not defined, expected the name of a <def>",
            "f:5:1: instance, def: it is missing, expected def=\"name\"",
            "f:6:11: instance, def: `` is empty, expected a name",
        ]
    );
    assert_eq!(task.scene.items.len(), 1);
}

#[test]
fn a_definition_in_itself_is_left_out() {
    assert_eq!(
        faults(
            "<def name='a'><sphere location='(0,0,1)'/><instance def='a'/></def><instance def='a'/>"
        ),
        ["f:2:53: instance, def: `a` is put into itself (in the instance at f:2:68)"]
    );
    let content = "<def name='a'><instance def='b'/><sphere id='a' location='(0,0,1)'/></def>\
                   <def name='b'><instance def='c'/></def>\
                   <def name='c'><sphere id='c' location='(0,0,1)'/><instance def='a'/></def>\
                   <instance def='a'/>";
    assert_eq!(faults(content).len(), 1);
    let scene = read(content).scene;
    let ids: Vec<_> = objects(&scene)
        .iter()
        .map(|object| object.id.as_str())
        .collect();
    assert_eq!(ids, ["c", "a"]);
}

#[test]
fn of_two_definitions_the_later_one_counts() {
    let content = "<def name='a'><sphere id='early' location='(0,0,1)'/></def>\n\
                   <def name='a'><sphere id='late' location='(0,0,1)'/></def><instance def='a'/>";
    assert_eq!(faults(content), ["f:3:6: def, name: `a` is defined again"]);
    assert_eq!(objects(&read(content).scene)[0].id, "late");
}

#[test]
fn templates_have_their_place() {
    for (content, fault) in [
        (
            "<composite location='(0,0,1)'><def name='a'/><sphere location='(0,0,0)'/></composite>",
            "f:2:31: def: it cannot stand in <composite>",
        ),
        (
            "<composite location='(0,0,1)'><include file='a'/><sphere location='(0,0,0)'/></composite>",
            "f:2:31: include: it cannot stand in <composite>",
        ),
        (
            "<var name='a' value='1'/>",
            "f:2:1: var: it cannot stand in <tabletop>",
        ),
        (
            "<def name='a'/><instance def='a'><sphere location='(0,0,1)'/></instance>",
            "f:2:34: sphere: it cannot stand in <instance>",
        ),
        (
            "<def name='a'><var name='b' value='1'><var name='c' value='1'/></var></def>",
            "f:2:39: var: it cannot stand in <var>",
        ),
        ("<def/>", "f:2:1: def, name: it is missing"),
        ("<def name='a' id='b'/>", "f:2:15: def, id: it is not known"),
        (
            "<def name='a'/><instance def='a' side='2'/>",
            "f:2:34: instance, side: it is not known",
        ),
        ("<instanc def='a'/>", "f:2:1: instanc: it is not known"),
    ] {
        assert_eq!(faults(content), [fault], "{content}");
    }
    assert!(
        read("<instanc def='a'/>").faults[0].expected == "<instance>"
            && read("<Def name='a'/>").faults[0].expected == "<def>"
    );
}

#[test]
fn a_fault_of_a_definition_is_reported_where_it_is_and_where_it_was_put_in() {
    let content = "<def name='cube'>\n<block location='(0,0,1)' xspan='$side$' colour='red'/>\n</def>\n\
                   <instance def='cube'><var name='side' value='2'/></instance>\n\
                   <def name='two'><instance def='cube'><var name='side' value='$side$'/></instance>\
                   <instance def='cube'><var name='side' value='-1'/></instance></def>\n\
                   <instance def='two'><var name='side' value='1'/></instance>";
    assert_eq!(
        faults(content),
        [
            "f:3:27: block, xspan: `-1` is out of range (in the instance at f:6:82, in that at f:7:1)",
            "f:3:42: block, colour: it is not known (in the instance at f:5:1, and in 2 more)",
        ]
    );
}

#[test]
fn a_definition_that_nobody_uses_is_not_looked_into() {
    assert!(
        scene("<def name='a'><cube/><block location='$nothing$'/></def>")
            .items
            .is_empty()
    );
}

#[test]
fn expressions_need_no_definition() {
    let content = "<block location='($1+2*3$,0,1)' xspan='$1/2$' yspan='$(1+2)*3$'/>";
    assert_eq!(span(content), [0.5, 9.0, 1.0]);
    let task = tabletop_xml::parse(
        "f".as_ref(),
        format!(
            "<tabletop xmlns='{}' xspan='$2*8$'/>",
            tabletop_xml::NAMESPACE
        )
        .as_bytes(),
    );
    assert_eq!((task.scene.table.xspan, task.faults.len()), (16.0, 0));
}
