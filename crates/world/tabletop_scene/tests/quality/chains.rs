//! Chains.

use crate::world::*;

#[test]
fn the_chain_of_the_report_sags_and_rests() {
    let mut world = TestWorld::new([report_chain(12)]);
    world.seconds(5.0);
    let middle = world.pose("chain-link5").location.z;
    assert!((middle - 2.947).abs() < 0.15, "middle at {middle}");
    let first = world.pose("chain-link0").location;
    assert!(
        (first.x - 5.425).abs() < 0.05 && (first.z - 3.841).abs() < 0.05,
        "{first}"
    );
    let (far, turn) = world.motion_in(2.0);
    assert!(far < 0.01 && turn < 0.5, "moved {far}, turned {turn}°");
}

#[test]
fn a_longer_chain_rests_on_the_table() {
    let mut world = TestWorld::new([report_chain(16)]);
    world.seconds(5.0);
    let middle = world.pose("chain-link7").location.z;
    assert!((middle - 0.05).abs() < 0.02, "middle at {middle}");
    for (id, pose) in world.poses() {
        assert!(
            pose.location.is_finite() && pose.location.z > 0.0,
            "{id}: {pose:?}"
        );
    }
}

#[test]
fn a_chain_without_one_link_falls_in_two_halves() {
    let mut world = TestWorld::new([report_chain(12)]);
    world.seconds(5.0);
    world.remove("chain-link6");
    world.seconds(3.0);
    for link in [5, 7] {
        let z = world.pose(&format!("chain-link{link}")).location.z;
        assert!(z < 0.2, "link {link} hangs at {z}");
    }
    for link in [0, 11] {
        let z = world.pose(&format!("chain-link{link}")).location.z;
        assert!(z > 3.0, "link {link} came off: {z}");
    }
}
