//! What is tolerated of a robot, of this program and of what is between them. Each number has its unit, and the test that fails without it.

use std::time::Duration;

const fn ms(number: u64) -> Duration {
    Duration::from_millis(number)
}

/// The oldest state on which a robot is driven. Joints' states come 100 times a second. (`old_states_stop_it`)
pub const OLDEST_STATE: Duration = ms(100);

/// What is older, a state or a target, makes the joints slower, until they rest when it is too old. (`what_gets_old_slows_the_joints`)
pub(crate) const NEW: Duration = ms(50);

/// The longest time from state to state with which a robot can be driven: two may be missed. (`states_at_10_hz_are_refused`)
pub(crate) const LONGEST_PERIOD: Duration = ms(40);

/// The oldest health, gripper or picture that is believed: they come ten times a second, or four. (`a_silent_health_stops_it`,
/// `a_silent_gripper_that_is_moved_stops_it`)
pub const OLDEST_REPORT: Duration = ms(1000);

/// The oldest target that is still followed. Programs set one 60 times a second. (`each_thing_that_is_the_matter_stops_the_robot`)
pub const OLDEST_TARGET: Duration = ms(100);

/// The time in which the joints come to rest when something is wrong. (`a_stop_is_an_even_ramp_then_a_hold_then_silence`)
pub const RAMP: Duration = ms(100);

/// How long the robot is told to stay where it is, before commands end. (the same)
pub const HOLD: Duration = ms(300);

/// How far a joint may be from where it should be, in rad. (`a_joint_that_is_pushed_away_stops_it`)
pub const MOST_DEVIATION: f64 = 0.3;

/// How far a joint may be from where it should be for it to be held where it was measured, in rad: what is farther is not believed, and rests by no speed.
/// (`what_is_far_from_where_it_should_be_is_held_by_no_speed`)
pub(crate) const MOST_HELD: f64 = 0.1;

/// How fast the expectation of a joint driven by velocities forgets, in s: speeds are followed to some percent, and where they lead to is not known for
/// long. (`speeds_that_are_followed_to_some_percent_are_no_fault`)
pub(crate) const FORGETTING: f64 = 1.0;

/// The least way, in rad, that a joint was ordered to turn which must show, and the time, in s, within which it must. States may be noisy by 2 mrad.
/// (`a_stuck_joint_is_found_out_at_any_speed`, `speeds_that_are_followed_to_some_percent_are_no_fault`)
pub(crate) const LEAST_WAY: f64 = 0.01;
pub(crate) const LONGEST_ANSWER: f64 = 0.3;

/// The least share of that way that it must have turned, and the most. (`a_stuck_joint_is_found_out_at_any_speed`,
/// `speeds_that_are_followed_to_some_percent_are_no_fault`, `a_joint_that_turns_by_itself_stops_it`)
pub(crate) const LEAST_SHARE: f64 = 0.3;
pub(crate) const MOST_SHARE: f64 = 3.0;

/// How long nobody may listen to a limb's commands. (`a_robot_that_no_longer_listens_stops`)
pub(crate) const LONGEST_DEAFNESS: Duration = ms(100);

/// A change of a joint's angle is a jump if it is larger than this many times what the joint's greatest speed allows, plus so many rad; and states that
/// come in a burst count as this far apart. (`a_fast_joint_does_not_jump_and_a_second_publisher_does`)
pub(crate) const JUMP_FACTOR: f64 = 2.0;
pub(crate) const JUMP_SLACK: f64 = 0.1;
pub(crate) const JUMP_SPAN: Duration = ms(20);

/// The spans of which the quickest message is kept, and their number: 10 s. (`a_slow_or_drifting_clock_makes_no_message_old`)
pub(crate) const CLOCK_SPAN: Duration = ms(100);
pub(crate) const CLOCK_SPANS: usize = 100;

/// The least time for which a clock must be known before its rate is. (`a_backlog_at_the_start_is_soon_forgotten`)
pub(crate) const SHORTEST_CLOCK: Duration = ms(1000);

/// How long an arm takes to answer a command. (`a_prediction_is_no_shorter_than_the_way_to_rest`)
pub(crate) const RESPONSE: Duration = ms(50);

/// The longest move whose whole way is looked at before it begins. (`the_whole_way_of_a_move_is_looked_at`)
pub(crate) const LONGEST_MOVE: Duration = ms(30_000);

/// The time after which something is sent again that need not have arrived: a topic has no receiver until the two have found each other.
/// (`grippers_and_head_are_sent_only_what_is_new`)
pub(crate) const REPETITION: Duration = ms(500);
