//! Objects of MATLAB classes in files that scripts load. `objects.mat` is laid out as MATLAB lays out `a = 3; shape = Shape3D; b = 4`.

use std::fs;

use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS};

#[test_with(Octave)]
fn objects_that_octave_cannot_read_are_named_once() {
    for trigger in TRIGGERS {
        let folder = Folder::pair(
            "load([aux.path 'objects.mat']); again = load([aux.path 'objects.mat'], 'b'); printf('sum %d\\n', a + again.b);",
            "load([aux.path 'objects.mat'], 'a'); y = a; save([aux.path 'y.mat'], 'y'); load([aux.path 'y.mat']); disp('loaded')",
        );
        fs::copy("tests/engines/objects.mat", folder.0.join("objects.mat")).unwrap();
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let printed = session.printed("sum 7");
        session.step(&common::at_rest()).unwrap();
        let printed = printed + &session.printed("loaded");
        let warning = "objects.mat: Octave cannot read objects of MATLAB classes: shape (Shape3D).";
        assert_eq!(printed.matches(warning).count(), 1, "{printed}");
        assert!(!printed.contains("shadows"), "{printed}");
    }
}
