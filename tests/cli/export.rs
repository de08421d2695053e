//! `tabletop export`: recordings as datasets.

use std::fs;

use crate::support::{place, record_shipped, stderr, stdout, tabletop};

#[test]
fn every_format_takes_pictures_that_were_not_recorded() {
    let demo = record_shipped("stack_two_blocks", "export_demo");
    let options = [
        "--fps",
        "10",
        "--size",
        "48x36",
        "--cameras",
        "head,above=0,-1,10",
        "--depth",
        "--ids",
    ];
    for format in ["lerobot", "robomimic", "rlds", "mcap", "mat"] {
        let out = place(&format!("export_{format}"));
        let arguments = ["export", &demo, "--to", format, out.to_str().unwrap()];
        let output = tabletop(&[&arguments, &options[..]].concat());
        assert_eq!(
            output.status.code(),
            Some(0),
            "{format}: {}",
            stderr(&output)
        );
        assert!(
            stdout(&output).starts_with("1 episode, "),
            "{format}: {}",
            stdout(&output)
        );
    }
}

#[test]
fn a_lerobot_dataset_can_have_videos() {
    let demo = record_shipped("stack_two_blocks", "export_video_demo");
    let out = place("export_video");
    let path = out.to_str().unwrap();
    for _ in 0..2 {
        let output = tabletop(&[
            "export", &demo, "--to", "lerobot", path, "--video", "--size", "64x48",
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let videos = out.join("videos/observation.images.head/chunk-000");
    assert_eq!(fs::read_dir(videos).unwrap().count(), 2);
    let info = fs::read_to_string(out.join("meta/info.json")).unwrap();
    assert!(info.contains("\"dtype\": \"video\"") && info.contains("videos/{video_key}/chunk-"));

    let output = tabletop(&["export", &demo, "--to", "lerobot", path, "--size", "64x48"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("observation.images.head"),
        "{}",
        stderr(&output)
    );
    let output = tabletop(&["export", &demo, "--to", "mcap", path, "--video"]);
    assert!(
        stderr(&output).contains("no other format has videos"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn rates_that_do_not_divide_sixty_are_refused() {
    for rate in ["0", "7", "25", "120", "four"] {
        let output = tabletop(&["export", "demo", "--to", "mat", "out", "--fps", rate]);
        assert_eq!(output.status.code(), Some(2), "{rate}");
        assert!(
            stderr(&output).contains("10, 12, 15, 20, 30 or 60"),
            "{}",
            stderr(&output)
        );
    }
}
