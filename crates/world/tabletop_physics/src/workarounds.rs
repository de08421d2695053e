//! Workarounds for faults of Rapier, of its geometry Parry, and of the plugin that joins it to Bevy. The rest of this crate would be needed with
//! a faultless engine, too.
//!
//! Each stands in a file of its own. bevy_rapier3d 0.37 brings rapier3d 0.36; claims about it were read in its source.
//!
//! | fault | workaround | upstream | can go |
//! |---|---|---|---|
//! | Rapier: a body with a pose that is no number is disabled for good | [`quarantine`]: it comes back a step later | none known | not with 0.37, which reports such bodies and keeps them disabled |
//! | Rapier: a body between a hand and the table may end in the table | [`relief`]: it is moved back to the surface | none known | when fixed bodies outweigh moved ones in the solver |
//! | Rapier: a body that slides over a seam runs into the covered side of the next object | [`seams`]: such contacts are left out | rapier#90 is alike | when contacts of a body are looked at together |
//! | Rapier: a sleeping body is woken after contacts are looked for | [`waking`]: it is woken before the step | none known | when bodies are woken before the narrow phase |
//! | Rapier: a body at rest has no contacts in its first step of motion | [`release`]: it sinks by next to nothing first | none known | when contacts of unmoved bodies are found |
//! | Rapier: a quaternion of the other sign makes a kinematic body spin | [`short_turn`]: its next pose has the nearer sign | none known | not with 0.37 |
//! | Rapier: fixed shapes are remembered that are gone | [`memory`]: the solver of fast bodies begins anew | rapier#985, rapier#1003 | with 0.37 |
//! | Rapier: groups of joints depend on steps before a snapshot | [`memory`]: the pipeline begins anew | none known (rapier#966 is alike) | when groups depend on the state alone |
//! | Rapier: a pair's impulses count the one that the step begins with | [`impulses`]: a share of the sum | none known | with 0.37 |
//! | Rapier: points that the solver has left out keep old impulses | [`impulses`]: only solved points count | none known | when they are cleared |
//! | Rapier: friction that Coulomb's law limits points aside of the slip | [`slip`]: the surface gets a velocity | none known | when it projects along the slip |
//! | Parry: nearest points are missed, or far too deep | [`contact`]: other directions are tried | parry#315, parry#378 | when the tests there pass without it |
//! | Parry: a face touches with its first four corners, and a cylinder rolls on for ever | [`polytope`]: four corners around the face, prisms; [`rolling`]: lines of cylinders on their side | a TODO in Parry; rapier#372 | when the four corners enclose the most area |
//! | plugin: changes are carried over in the order of Bevy's tables | [`order`]: sorted; `bodies` takes new ones in one by one | bevy_rapier#79, bevy_rapier#233 | with bevy_rapier#233 |
//! | plugin: every step asks for changes of thirty components of every body | [`outside`]: one question for all of it | none known | not with 0.37 |
//! | plugin: trees of transforms are propagated without being marked | [`transforms`]: marked, and only if one has moved | none known | not with 0.37 |
//! | plugin: the end of a disabling is missed in a pause | [`enabling`]: Rapier is told at once | bevy_rapier#343 | when removals are observed |

pub(crate) mod burden;
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
pub(crate) mod rolling;
pub(crate) mod seams;
pub(crate) mod short_turn;
pub(crate) mod slip;
pub(crate) mod transforms;
pub(crate) mod waking;
