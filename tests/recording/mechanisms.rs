//! Things to operate and to fasten, and random commands to them.

use bevy::prelude::*;
use tabletop::prelude::*;

use crate::random::Random;

/// A panel with a switch, lights and holes, a dial that grows, a screw in the panel and a nut beside it, a button, and shears around a
/// wire.
const MECHANISMS: &str = r#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">
  <composite id="panel" location="(0,0,0)">
    <block location="(0,0,0)" xspan="3" yspan="2" zspan="0.3"/>
    <toggleSwitch id="power" location="(-1,0,0.15)" numStates="3"><downstream id="lamp"/></toggleSwitch>
    <indicatorLights id="lamp" location="(0,0.5,0.15)" pointable="true">
      <downstream id="dial"/>
      <state/>
      <state><light id="0"/></state>
      <state><light id="0" color="green"/><light id="1"/></state>
    </indicatorLights>
    <hostBondPoint id="hole" location="(1,0,0.15)" type="screw" downstream="dial" downstreamOverride="lamp" downstreamLock="hole2">
      <tightness location="(0,0,0.4)"/>
      <tightness location="(0,0,0.2)" rotation="(0,0,90)" downstreamState="1" downstreamLock="true"/>
    </hostBondPoint>
    <hostBondPoint id="hole2" location="(0,-0.5,0.15)" type="screw"><tightness location="(0,0,0.3)"/></hostBondPoint>
  </composite>
  <composite id="screw" location="(0,0,3)">
    <cylinder location="(0,0,0.5)" rotation="(90,0,0)" radius="0.2"/>
    <guestBondPoint id="tip" type="screw" initBondHostId="hole" initBondTightness="1"/>
  </composite>
  <composite id="nut" location="(1,1.5,0)">
    <block location="(0,0,0)" xspan="0.5" yspan="0.5" zspan="0.5"/>
    <guestBondPoint id="thread" type="screw"/>
  </composite>
  <customControl id="dial" location="(-2.5,0,0.5)">
    <state><block location="(0,0,0)" xspan="0.5" yspan="0.5" zspan="0.5" nextStateWhenTriggered="1"/></state>
    <state><sphere location="(0,0,0)" radius="0.5" nextStateWhenTriggered="2"/></state>
    <state/>
  </customControl>
  <pushButton id="knob" location="(2.5,-1,0)" mode="held" state="2"><downstream id="lamp"/></pushButton>
  <chain id="wire" start="(0.3,-3,3)" end="(0.3,-3,0)" linkMass="0.05"/>
  <scissors location="(0,-4,0.5)" rotation="(0,90,0)" max="60">
    <block id="anvil" location="(0,0.75,-0.2)" xspan="1" yspan="1.7" zspan="0.4" mass="0"/>
    <block id="blade" location="(0,0.75,0.1)" xspan="0.3" yspan="1.7" zspan="0.2" mass="0.2"/>
  </scissors>
</tabletop>"#;

/// The mechanisms, with the panel at a location.
pub fn items(at: Vec3) -> Vec<SceneItem> {
    let task = tabletop::xml::parse("mechanisms.xml".as_ref(), MECHANISMS.as_bytes());
    assert_eq!(task.faults, []);
    let mut items = task.scene.items;
    for item in &mut items {
        match item {
            SceneItem::Object(object) => object.pose.location += at,
            SceneItem::Chain(chain) => {
                chain.start += at;
                chain.end += at;
            }
            SceneItem::Jointed(jointed) => jointed.pose.location += at,
            SceneItem::LidBox(lidbox) => lidbox.pose.location += at,
        }
    }
    items
}

pub fn command(random: &mut Random) -> MechanismCommand {
    let hand = random.of(&Hand::ALL);
    let guest = random.of(&["screw", "tip", "nut", "nut", "panel"]).into();
    match random.below(10) {
        0..=2 => MechanismCommand::Trigger {
            hand,
            control: random
                .of(&["power", "power", "dial", "lamp", "knob", "knob"])
                .into(),
            part: random.of(&[None, None, Some(0), Some(1)]),
        },
        3 => MechanismCommand::PointTo {
            hand,
            target: random.of(&["lamp", "screw", "nothing"]).into(),
        },
        4..=5 => MechanismCommand::Fasten { hand, guest },
        6..=7 => MechanismCommand::Loosen { hand, guest },
        _ => MechanismCommand::Cut {
            hand,
            blade: random.of(&["blade", "blade", "anvil", "nut"]).into(),
        },
    }
}
