//! Bounds on scenes.

use tabletop_core::{
    ChainSpec, JointMotion, JointedSpec, LidBoxSpec, SceneItem, SceneSpec, Table,
    limits::{DISPLACEMENTS, MASSES, PADDINGS, PROPORTIONS, SPANS},
};

use crate::files::bounds::{
    object::check_object,
    values::{Checked, LINKS, at, check_parts, check_place, place, spans, within},
};

pub(super) fn check_scene_spec(scene: &SceneSpec) -> Checked {
    let SceneSpec { table, items } = scene;
    check_table(table)?;
    let mut parts = 0;
    for item in items {
        match item {
            SceneItem::Object(object) => {
                check_place(object.pose)
                    .and_then(|()| check_object(object, &mut parts))
                    .map_err(at(&object.id))?;
            }
            SceneItem::Chain(chain) => {
                check_chain(chain).map_err(at(&chain.id))?;
                parts += chain.links() as usize;
            }
            SceneItem::LidBox(lid_box) => {
                check_lid_box(lid_box).map_err(at(&lid_box.id))?;
                parts += 2;
            }
            SceneItem::Jointed(jointed) => check_jointed(jointed, &mut parts)?,
        }
        check_parts(parts)?;
    }
    Ok(())
}

fn check_jointed(jointed: &JointedSpec, parts: &mut usize) -> Checked {
    let JointedSpec {
        pose,
        objects,
        motion,
        limits: [min, max],
        init,
        collides: _,
        damping,
    } = jointed;
    check_place(*pose).map_err(at("joint"))?;
    for displacement in [*min, *max, *init] {
        within("displacement", displacement, &DISPLACEMENTS)?;
    }
    within("damping", *damping, &PROPORTIONS)?;
    if *motion == JointMotion::Press && jointed.push_button().is_none() {
        return Err("a cap is no push button".into());
    }
    for object in objects {
        check_place(object.pose)
            .and_then(|()| check_object(object, parts))
            .map_err(at(&object.id))?;
    }
    Ok(())
}

pub(crate) fn check_table(table: &Table) -> Checked {
    within("table", table.xspan, &SPANS)?;
    within("table", table.yspan, &SPANS)
}

fn check_chain(chain: &ChainSpec) -> Checked {
    place("start", chain.start)?;
    place("end", chain.end)?;
    spans("link_span", chain.link_span)?;
    within("link_padding", chain.link_padding, &PADDINGS)?;
    within("link_mass", chain.link_mass, &MASSES)?;
    match LINKS.contains(&chain.links()) {
        true => Ok(()),
        false => Err(format!(
            "a chain has {} to {} links, not {}",
            LINKS.start(),
            LINKS.end(),
            chain.links()
        )),
    }
}

fn check_lid_box(lid_box: &LidBoxSpec) -> Checked {
    check_place(lid_box.pose)?;
    spans("span", lid_box.span)?;
    spans("handle_span", lid_box.handle_span)?;
    within("thickness", lid_box.thickness, &SPANS)?;
    within("handle_thickness", lid_box.handle_thickness, &SPANS)?;
    within("box_mass", lid_box.box_mass, &MASSES)?;
    within("lid_mass", lid_box.lid_mass, &MASSES)
}
