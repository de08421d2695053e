//! `tabletop docs`.

use std::fs;

use crate::support::{command, place, stderr, stdout, tabletop};

#[test]
fn the_documentation_is_written_to_a_file_again_and_again() {
    let page = place("documentation.html");
    for _ in 0..2 {
        let output = tabletop(&["docs", page.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let text = fs::read_to_string(&page).unwrap();
        assert!(text.contains("<article id=\"tutorial\">"));
        assert!(text.ends_with("</html>\n"));
    }
}

#[test]
fn a_file_of_something_else_stays() {
    let page = place("no_documentation.html");
    fs::write(&page, "<p>mine</p>").unwrap();
    let output = tabletop(&["docs", page.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(
        said.contains("something else than the documentation"),
        "{said}"
    );
    assert_eq!(fs::read_to_string(&page).unwrap(), "<p>mine</p>");
}

#[test]
fn without_a_browser_its_place_is_told() {
    let kept = place("documentation_kept");
    fs::create_dir_all(&kept).unwrap();
    let mut program = command(&["docs"]);
    program.env("XDG_CACHE_HOME", &kept).env("PATH", &kept);
    let output = program.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let page = kept.join("tabletop/docs.html");
    let told = format!("{}: open it in a browser\n", page.display());
    assert_eq!(stdout(&output), told);
    assert!(fs::metadata(&page).unwrap().len() > 1_000_000);
}
