//! `tabletop video`: recordings as videos, animations and contact sheets.

use std::fs;

use crate::support::{place, record_shipped, stderr, tabletop};

#[test]
fn a_recording_becomes_a_video_an_animation_and_a_contact_sheet() {
    let demo = record_shipped("stack_two_blocks", "video_demo");
    let folder = place("video_made");
    fs::create_dir_all(&folder).unwrap();
    let make = |name: &str, options: &[&str]| {
        let out = folder.join(name);
        let out = out.to_str().unwrap();
        let output = tabletop(&[&["video", &demo, out, "--size", "96x72"], options].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        fs::read(out).unwrap()
    };
    let video = make("a.mp4", &["--fps", "10", "--captions"]);
    assert_eq!(&video[4..8], b"ftyp");
    assert_eq!(video, make("again.mp4", &["--fps", "10", "--captions"]));
    assert_ne!(video, make("plain.mp4", &["--fps", "10"]));

    let animation = make("a.gif", &["--camera", "side=12,0,6,0,0,1", "--speed", "4"]);
    assert_eq!(&animation[..6], b"GIF89a");

    let sheet = make("a.png", &["--columns", "2"]);
    let reader = png::Decoder::new(std::io::Cursor::new(sheet))
        .read_info()
        .unwrap();
    let info = reader.info();
    assert!((192..240).contains(&info.width), "{}", info.width);
    let denser = make("b.png", &["--every", "0.5", "--columns", "2"]);
    let denser = png::Decoder::new(std::io::Cursor::new(denser))
        .read_info()
        .unwrap();
    assert!(denser.info().height > info.height);
}

#[test]
fn impossible_videos_are_refused_before_anything_is_made() {
    let demo = record_shipped("stack_two_blocks", "video_refused_demo");
    for (out, options, words) in [
        (
            "a.avi",
            &[][..],
            "expected a name that ends in .mp4, .gif or .png",
        ),
        ("a.mp4", &["--size", "8x8"], "cannot have pictures of 8x8"),
        (
            "a.mp4",
            &["--camera", "third_hand"],
            "no camera third_hand; expected head, left_hand_camera",
        ),
        ("a.mp4", &["--camera", "a=1,2"], "expected x,y,z"),
        ("missing/a.mp4", &[], "missing"),
    ] {
        let place = place("video_refused");
        fs::create_dir_all(&place).unwrap();
        let out = place.join(out);
        let output = tabletop(&[&["video", &demo, out.to_str().unwrap()], options].concat());
        let reported = stderr(&output);
        assert_ne!(output.status.code(), Some(0), "{out:?}");
        assert!(reported.contains(words), "{reported}");
        assert_eq!(fs::read_dir(&place).unwrap().count(), 0, "{out:?}");
    }
}
