//! Bond points of a scene.

use tabletop_core::{BondEnd, BondPoint};

use crate::write::{
    Writer,
    text::{as_attribute, as_id, as_literal},
};

impl Writer {
    pub(super) fn attributes_of_bond_point(&mut self, point: &BondPoint) {
        self.attribute("type", &as_attribute(&as_literal(&point.fit)));
        let ids = match &point.end {
            BondEnd::Guest(guest) => {
                let tightness = guest.tightness.to_string();
                self.attribute("initBondTightness", &tightness);
                vec![("initBondHostId", &guest.host)]
            }
            BondEnd::Host(host) => vec![
                ("downstream", &host.downstream),
                ("downstreamOverride", &host.downstream_override),
                ("downstreamLock", &host.downstream_lock),
            ],
        };
        for (name, id) in ids {
            if !id.is_empty() {
                self.attribute(name, &as_id(id));
            }
        }
    }

    pub(super) fn steps_of(&mut self, point: &BondPoint) {
        let BondEnd::Host(host) = &point.end else {
            return;
        };
        for step in &host.steps {
            self.open("tightness");
            self.pose(step.pose);
            if let Some(state) = step.state {
                self.attribute("downstreamState", &state.to_string());
            }
            if step.locks {
                self.attribute("downstreamLock", "true");
            }
            self.close();
        }
    }
}
