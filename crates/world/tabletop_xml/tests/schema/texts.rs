//! Texts of task files, with the verdict of parser and schema on them.

use std::{fs, path::PathBuf};

use tabletop_xml::NAMESPACE;

pub fn tablesetup() -> PathBuf {
    "../../../tablesetup".into()
}

/// The files in `tablesetup/`, in the order of their names.
pub fn shipped_files() -> Vec<PathBuf> {
    let mut files: Vec<_> = fs::read_dir(tablesetup())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "xml"))
        .collect();
    files.sort();
    assert!(files.len() >= 13, "only {files:?}");
    files
}

fn file(content: &str) -> String {
    format!("<tabletop xmlns=\"{NAMESPACE}\">{content}</tabletop>")
}

/// Texts without a fault.
pub fn accepted() -> Vec<String> {
    let mut texts = [
        "<block location=\" ( -1.5 , .5 , +2e0 ) \" color=\" #00A57F \" mass=\" 1. \"/>",
        "<sphere id=\"\" location=\"(0,0,1)\" color=\"LightGray\" radius=\"0.001\" pointable=\"1\"/>",
        "<cylinder location=\"(0,0,1)\" sides=\"3\" yspan=\"1000\"/>",
        "<box location=\"(0,0,1)\"><description name=\"a\" value=\"&lt;é\"/></box>",
        "<composite location=\"(0,0,1)\" mass=\"0\"><description name=\"a\" value=\"\"/>\
         <composite location=\"(0,0,1)\"><box location=\"(0,0,1)\"/></composite></composite>",
        "<chain start=\"(0,0,1)\" end=\"(5,0,1)\" linkCount=\"+5\" linkPadding=\"0\"/>",
        "<lidbox location=\"(0,0,1)\" lidMass=\"0\" handleThickness=\"0.1\"/>",
        "<!-- nothing --><?nothing at all?>",
        "<def name=\"my cube\"><var name=\"side\" value=\"1\"/><var name=\"half\" value=\"$side/2$\" derived=\"1\"/>\
         <block location=\"(0,0,$half$)\" xspan=\"$side$\" color=\"$color$\" id=\"b$side$\" mass=\"$2*side$\" pointable=\"$p$\">\
         <description name=\"$n$\" value=\"$half$\"/></block></def>\
         <instance def=\"my cube\"><var name=\"color\" value=\"red\"/><var name=\"p\" value=\"false\"/>\
         <var name=\"n\" value=\"half\"/></instance>",
        "<def name=\"parts\"><sphere location=\"(0,0,0)\"/></def><def name=\"note\"><description name=\"a\" value=\"b\"/></def>\
         <composite location=\"(0,0,1)\"><description name=\"c\" value=\"d\"/><instance def=\"note\"/><instance def=\"parts\"/>\
         <composite location=\"(0,0,0)\"><instance def=\"parts\"/></composite></composite>\
         <sphere location=\"(0,0,1)\"><instance def=\"note\"/></sphere>",
        "<sliderJoint id=\"j\" location=\"(0,0,1)\" rotation=\"(0,0,9)\" min=\"-1\" max=\"2\" init=\"5\" collision=\"true\" damping=\"1\" \
         softness=\".5\" restitution=\"0\"><block id=\"a\" location=\"(0,0,0)\"/><box location=\"(0,0,1)\" mass=\"2\"/></sliderJoint>\
         <hingeJoint location=\"(0,0,1)\" min=\"-180\" max=\"180\" init=\"5\"><sphere location=\"(0,0,0)\"/><sphere location=\"(0,0,1)\"/></hingeJoint>",
        "<def name=\"nothing\"/><block location=\"($1+2*3$,0,1)\"/>",
        "<frustum id=\"f\" location=\"(0,0,1)\" rotation=\"(9,0,0)\" radiusTop=\".1\" radiusBottom=\"2\" zspan=\"3\" sides=\"6\" color=\"red\" \
         mass=\"2\" friction=\"0\" restitution=\"1\" linearVelocity=\"(1,-2,0)\" pointable=\"true\"/>\
         <ring location=\"(0,0,1)\" radiusOuter=\"2\" radiusInner=\"1.9\" zspan=\".1\" sides=\"8\"><description name=\"a\" value=\"b\"/></ring>\
         <composite location=\"(0,0,1)\" friction=\".2\"><ring location=\"(0,0,1)\"/><frustum location=\"(0,0,1)\"/></composite>",
        "<scissors id=\"s\" location=\"(0,0,1)\" min=\"-5\" max=\"60\" init=\"9\" length=\"2\" mass=\"1\" color=\"red\"/>\
         <scissors location=\"(0,0,1)\"><block location=\"(0,0,0)\"/><ring location=\"(0,0,1)\"/></scissors>",
        "<pushButton id=\"b\" location=\"(0,0,1)\" rotation=\"(0,90,0)\" mass=\"0\" radius=\".2\" zspan=\".5\" travel=\".2\" force=\"2.5\" \
         color=\"green\" mode=\"held\" state=\"2\" init=\".1\"><description name=\"a\" value=\"b\"/><downstream id=\"b\"/></pushButton>\
         <pushButton location=\"(0,0,1)\"/>",
    ]
    .map(file)
    .to_vec();
    texts.push(format!(
        "<!DOCTYPE tabletop><t:tabletop xmlns:t=\"{NAMESPACE}\" xspan=\"1\" yspan=\"2\">\
         <t:block location=\"(0,0,1)\"/></t:tabletop>"
    ));
    texts
}

/// Texts with a fault that a schema can find.
pub fn rejected() -> Vec<String> {
    [
        "<block/>",
        "<block location=\"0,0,1\"/>",
        "<block location=\"(0,0)\"/>",
        "<block location=\"(0,0,NaN)\"/>",
        "<block location=\"(0,0,1)\" xspan=\"0\"/>",
        "<block location=\"(0,0,1)\" xspan=\"1e999\"/>",
        "<block location=\"(0,0,1)\" xspan=\"NaN\"/>",
        "<block location=\"(0,0,1)\" xspan=\"1001\"/>",
        "<block location=\"(0,0,1)\" mass=\"-1\"/>",
        "<block location=\"(0,0,1)\" mass=\"INF\"/>",
        "<block location=\"(0,0,1)\" color=\"reed\"/>",
        "<block location=\"(0,0,1)\" color=\"#fff\"/>",
        "<block location=\"(0,0,1)\" id=\"a b\"/>",
        "<block location=\"(0,0,1)\" id=\"a-b\"/>",
        "<block location=\"(0,0,1)\" colour=\"red\"/>",
        "<block location=\"(0,0,1)\" radius=\"1\"/>",
        "<block location=\"(0,0,1)\" pointable=\"yes\"/>",
        "<block location=\"(0,0,1)\">text</block>",
        "<block location=\"(0,0,1)\"><block location=\"(0,0,1)\"/></block>",
        "<block location=\"(0,0,1)\"><description value=\"a\"/></block>",
        "<block location=\"(0,0,1)\"><description name=\"\" value=\"a\"/></block>",
        "<cylinder location=\"(0,0,1)\" sides=\"2\"/>",
        "<composite location=\"(0,0,1)\"/>",
        "<composite location=\"(0,0,1)\"><block location=\"(0,0,1)\" mass=\"1\"/></composite>",
        "<composite location=\"(0,0,1)\"><chain start=\"(0,0,1)\" end=\"(1,0,1)\"/></composite>",
        "<chain start=\"(0,0,1)\"/>",
        "<chain start=\"(0,0,1)\" end=\"(5,0,1)\" linkCount=\"1.5\"/>",
        "<chain start=\"(0,0,1)\" end=\"(5,0,1)\" linkCount=\"-1\"/>",
        "<chain start=\"(0,0,1)\" end=\"(5,0,1)\" linkPadding=\"-1\"/>",
        "<lidbox location=\"(0,0,1)\" handleXspan=\"0\"/>",
        "<ring location=\"(0,0,1)\" sides=\"2\"/>",
        "<frustum location=\"(0,0,1)\" radiusTop=\"0\"/>",
        "<custom location=\"(0,0,1)\"/>",
        "<block location=\"(0,0,1)\" friction=\"-1\"/>",
        "<block location=\"(0,0,1)\" restitution=\"1.5\"/>",
        "<composite location=\"(0,0,1)\"><ring location=\"(0,0,1)\" friction=\"1\"/></composite>",
        "<toggleButton location=\"(0,0,1)\"/>",
        "<sliderJoint><block location=\"(0,0,0)\"/><block location=\"(0,0,1)\"/></sliderJoint>",
        "<sliderJoint location=\"(0,0,0)\"/>",
        "<sliderJoint location=\"(0,0,0)\" damping=\"2\"><block location=\"(0,0,0)\"/><block location=\"(0,0,1)\"/></sliderJoint>",
        "<hingeJoint location=\"(0,0,0)\" max=\"181\"><block location=\"(0,0,0)\"/><block location=\"(0,0,1)\"/></hingeJoint>",
        "<include/>",
        "<def/>",
        "<def name=\"\"/>",
        "<instance/>",
        "<def name=\"a\"/><instance def=\"a\" x=\"1\"/>",
        "<def name=\"a\"/><instance def=\"a\"><var name=\"b\"/></instance>",
        "<def name=\"a\"/><instance def=\"a\"><var value=\"b\"/></instance>",
        "<def name=\"a\"/><instance def=\"a\"><sphere location=\"(0,0,1)\"/></instance>",
        "<def name=\"a\"/><instance def=\"a\"><var name=\"b\" value=\"1\" derived=\"yes\"/></instance>",
        "<var name=\"a\" value=\"b\"/>",
        "<composite location=\"(0,0,1)\"><def name=\"a\"/></composite>",
        "<cube location=\"(0,0,1)\"/>",
        "<tabletop/>",
        "text",
        "<block location=\"(0,0,1)\" location=\"(0,0,1)\"/>",
        "<block location=\"(0,0,1)\"",
        "<block location=\"(0,0,1)\" id=\"&x;\"/>",
        "<block location=\"(0,0,1)\" id=\"a\"mass=\"1\"/>",
        "</tabletop><tabletop>",
        "<!-- -- -->",
        "\u{1}",
    ]
    .map(file)
    .to_vec()
}
