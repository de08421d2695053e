//! Variables: their values, and the scopes of elements.

use crate::{faults, ids, only_object, read, span};

/// Values of three variables of an instance, as extents of its block.
fn held(defaults: &str, arguments: &str) -> [f32; 3] {
    span(&format!(
        "<def name='d'>{defaults}<block location='(0,0,1)' xspan='$a$' yspan='$b$' zspan='$c$'/></def>\
         <instance def='d'>{arguments}</instance>"
    ))
}

#[test]
fn defaults_can_use_other_variables_in_any_order() {
    let of_arguments =
        "<var name='b' value='$a/2$'/><var name='c' value='$b+1$'/><var name='a' value='4'/>";
    assert_eq!(held(of_arguments, ""), [4.0, 2.0, 3.0]);
    assert_eq!(
        held(of_arguments, "<var name='a' value='8'/>"),
        [8.0, 4.0, 5.0]
    );
    assert_eq!(
        held(of_arguments, "<var name='b' value='7'/>"),
        [4.0, 7.0, 8.0]
    );
    let marked = "<var name='a' value='4'/><var name='b' value='$a/2$' derived='true'/>\
                  <var name='c' value='1' derived='1'/>";
    assert_eq!(held(marked, ""), [4.0, 2.0, 1.0]);
}

#[test]
fn arguments_are_about_the_variables_around_the_instance() {
    let content = "<def name='inner'><var name='a' value='1'/><var name='b' value='1'/>\
                   <block location='(0,0,1)' xspan='$a$' yspan='$b$' zspan='$c$'/></def>\
                   <def name='outer'><var name='a' value='5'/><var name='c' value='9'/>\
                   <instance def='inner'><var name='a' value='2'/><var name='b' value='$a+1$'/></instance></def>\
                   <instance def='outer'/>";
    assert_eq!(span(content), [2.0, 6.0, 9.0]);
}

#[test]
fn derived_arguments_are_about_the_instances_own_variables() {
    let defaults = "<var name='a' value='1'/><var name='b' value='1'/><var name='c' value='3'/>";
    let arguments = "<var name='a' value='2'/><var name='b' value='$a*c$' derived='true'/>";
    assert_eq!(held(defaults, arguments), [2.0, 6.0, 3.0]);
}

#[test]
fn a_variable_that_names_itself_means_the_one_around() {
    let content = "<def name='inner'><var name='a' value='$a+1$'/>\
                   <block location='(0,0,1)' xspan='$a$' yspan='$b$'/></def>\
                   <def name='outer'><var name='a' value='5'/><instance def='inner'>\
                   <var name='b' value='$b/2$' derived='true'/></instance></def>\
                   <instance def='outer'><var name='b' value='8'/></instance>";
    assert_eq!(span(content), [6.0, 4.0, 1.0]);
}

#[test]
fn defaults_hide_the_variables_around() {
    let content = "<def name='inner'><var name='id' value='inner'/><sphere id='$id$' location='(0,0,1)'/></def>\
                   <def name='outer'><var name='id' value='outer'/><instance def='inner'/></def>\
                   <instance def='outer'/>";
    assert_eq!(ids(content), ["inner"]);
}

#[test]
fn variables_that_need_each_other_are_a_fault() {
    let content = "<def name='d'><var name='a' value='$b$'/><var name='b' value='$a$'/>\
                   <sphere location='(0,0,1)' radius='$a$'/><sphere id='sound' location='(0,0,1)'/></def>\
                   <instance def='d'/>";
    assert_eq!(
        faults(content),
        ["f:2:29: var, value: its value needs itself (in the instance at f:2:155)"]
    );
    assert_eq!(read(content).scene.items.len(), 1);
}

#[test]
fn misspelt_variables_are_harmless() {
    assert_eq!(
        held(
            "<var name='a' value='1'/><var name='b' value='1'/><var name='c' value='1'/>",
            "<var name='rocation' value='(0,0,90)'/>"
        ),
        [1.0; 3]
    );
}

#[test]
fn unknown_variables_are_faults_of_the_elements_that_name_them() {
    assert_eq!(
        faults("<block location='(0,0,$heigth/2$)'/>\n<sphere location='(0,0,1)'/>"),
        ["f:2:8: block, location: `heigth` in `$heigth/2$` is no variable"]
    );
    let unused = "<def name='d'><var name='a' value='$nothing$'/></def><instance def='d'/>";
    assert_eq!(faults(unused), [""; 0]);
    let argument = "<def name='d'/><instance def='d'><var name='a' value='$nothing$'/></instance>";
    assert_eq!(
        faults(argument),
        ["f:2:48: var, value: `nothing` in `$nothing$` is no variable"]
    );
}

#[test]
fn text_outside_dollars_is_literal() {
    let content = "<def name='d'><var name='a' value='3'/>\
                   <block location='(-$a/3$,+$a$,$-a$)' xspan='$a$' yspan='$a$$a$' zspan='.$a$'/></def>\
                   <instance def='d'/>";
    let block = only_object(content);
    assert_eq!(block.pose.location.to_array(), [-1.0, 3.0, -3.0]);
    assert_eq!(span(content), [3.0, 33.0, 0.3]);
    let escaped = only_object(
        "<block location='(0,0,1)'><description name='price' value='$$5 to $$$2*3$'/></block>",
    );
    assert_eq!(escaped.descriptions, [("price".into(), "$5 to $6".into())]);
    let lone =
        only_object("<block location='(0,0,1)'><description name='price' value='5$'/></block>");
    assert_eq!(lone.descriptions, [("price".into(), "5$".into())]);
}

#[test]
fn words_that_read_as_numbers_are_numbers() {
    let content = "<def name='d'><sphere id='s$n$' location='(0,0,1)'><description name='n' value='$x$'/></sphere></def>\
                   <instance def='d'><var name='n' value='007'/><var name='x' value='2.50'/></instance>";
    let sphere = only_object(content);
    assert_eq!(sphere.id, "s7");
    assert_eq!(sphere.descriptions[0].1, "2.5");
}

#[test]
fn text_after_an_expression_is_ignored() {
    assert_eq!(span("<block location='(0,0,1)' xspan='$2 x$'/>")[0], 2.0);
}

#[test]
fn each_variable_is_written_once() {
    let content = "<def name='d'><var name='a' value='1'/>\n<var name='a' value='2'/>\
                   <block location='(0,0,1)' xspan='$a$'/></def>\n<instance def='d'/>";
    assert_eq!(faults(content), ["f:3:6: var, name: it is there twice"]);
    let task = read(content);
    assert_eq!(task.scene.items.len(), 1);
    for (variable, fault) in [
        ("<var value='1'/>", "f:2:34: var, name: it is missing"),
        ("<var name='a'/>", "f:2:34: var, value: it is missing"),
        (
            "<var name=' ' value='1'/>",
            "f:2:39: var, name: ` ` is empty",
        ),
        (
            "<var name='a' value='1' derived='yes'/>",
            "f:2:58: var, derived: `yes` is not a truth value",
        ),
    ] {
        let content = format!("<def name='d'/><instance def='d'>{variable}</instance>");
        assert_eq!(faults(&content), [fault]);
    }
}

#[test]
fn the_name_of_a_definition_can_be_a_variable() {
    let content = "<def name='round'><sphere id='ball' location='(0,0,1)'/></def>\
                   <def name='one_of'><instance def='$kind$'/></def>\
                   <instance def='one_of'><var name='kind' value='round'/></instance>";
    assert_eq!(ids(content), ["ball"]);
}
