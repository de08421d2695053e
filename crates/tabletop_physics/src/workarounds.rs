//! What works round faults of the engine: of Rapier, of its geometry Parry, and of the plugin that joins it to Bevy. All else in this crate
//! would be needed with a faultless engine, too.
//!
//! Each stands in a file of its own, with the fault and what is done. The last column is what lets it go. bevy_rapier3d 0.37 brings
//! rapier3d 0.36; what is said of it was read in its source.
//!
//! | fault | here | upstream | goes with |
//! |---|---|---|---|
//! | Rapier: what was no number is disabled for good | [`quarantine`] | none known | no version known: 0.37 reports it and still disables |
//! | Rapier: what something presses on the table goes into it | [`relief`] | none known | a solver in which what is fixed outweighs what is moved |
//! | Rapier: a sleeping body is woken after contacts are looked for | [`waking`] | none known | waking before the narrow phase |
//! | Rapier: a body that begins to fall has no contacts for a step | [`release`] | none known | contacts of bodies that have not moved |
//! | Rapier: a quaternion's sign makes a kinematic body spin | [`short_turn`] | none known | 0.37 has it still |
//! | Rapier: fixed shapes are remembered that have gone | [`memory`] | rapier#985, rapier#1003 | bevy_rapier3d 0.37 |
//! | Rapier: groups of joints depend on steps that a snapshot lacks | [`memory`] | like rapier#966 | grouping from the state alone |
//! | Rapier: an impulse counts the one a step begins with | [`impulses`] | none known | bevy_rapier3d 0.37 |
//! | Rapier: points that the solver left out keep old impulses | [`impulses`] | none known | no version known |
//! | Parry: nearest points are missed, or too deep | [`contact`] | parry#315, parry#378 | a repaired search; the tests there say |
//! | Parry: a face touches with its first four corners; cylinders roll on | [`polytope`] | a TODO in Parry; rapier#372 | four corners of the widest area |
//! | plugin: changes are carried over in the order of Bevy's tables | [`order`], and `bodies` takes in one by one | bevy_rapier#79, bevy_rapier#233 | the latter, merged |
//! | plugin: thirty components of every body are asked for changes | [`outside`] | none known | no version known |
//! | plugin: trees of transforms are propagated without being marked | [`transforms`] | none known | 0.37 has it still |
//! | plugin: a mark that was taken away in a pause is forgotten | [`enabling`] | bevy_rapier#343 | an observer in its place |

pub(crate) mod contact;
pub(crate) mod enabling;
pub(crate) mod impulses;
pub(crate) mod memory;
pub(crate) mod order;
pub(crate) mod outside;
pub(crate) mod polytope;
pub(crate) mod quarantine;
pub(crate) mod release;
pub(crate) mod relief;
pub(crate) mod short_turn;
pub(crate) mod transforms;
pub(crate) mod waking;
