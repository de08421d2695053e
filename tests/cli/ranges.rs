//! Numbers of options that are out of their ranges.

use crate::support::{stderr, tabletop};

#[test]
fn a_number_out_of_its_range_is_refused_before_anything_is_done() {
    for (words, range) in [
        (
            "imitate demo --trials 18446744073709551615",
            "a whole number from 1 to 100000",
        ),
        (
            "imitate demo --seed -1",
            "a whole number from 0 to 18446744073709551615",
        ),
        (
            "multiply demo --out many --distractors 1000",
            "a whole number from 0 to 50",
        ),
        (
            "multiply demo --out many --jobs 40000",
            "a whole number from 1 to 256",
        ),
        (
            "multiply demo --out many --jobs -1",
            "a whole number from 1 to 256",
        ),
        (
            "multiply demo --out many --count 1000000000000",
            "a whole number from 1 to 1000000",
        ),
        (
            "multiply demo --out many --camera inf",
            "a number from 0 to 10 units",
        ),
        ("require demo --step 0", "a whole number from 1 to 1000000"),
        ("soak --hours -1", "a number from 0 to 10000 hours"),
        (
            "replay demo --out other --fov 180",
            "a number from 1 to 179 degrees",
        ),
        (
            "replay demo --out other --render 0x480",
            "a width and a height from 1 to 8192, such as 640x480",
        ),
        (
            "replay demo --out other --camera 1e38,0,0",
            "three numbers from -1000 to 1000, such as 0,-8,12.5",
        ),
    ] {
        let arguments: Vec<_> = words.split(' ').collect();
        let output = tabletop(&arguments);
        assert_eq!(output.status.code(), Some(2), "{words}");
        let said = stderr(&output);
        let refusal = said.lines().next().unwrap();
        assert!(
            refusal.ends_with(&format!(": expected {range}")),
            "{words}: {said}"
        );
    }
}
