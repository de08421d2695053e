//! Figures of the robot in the world.

use std::collections::BTreeSet;

use bevy::{
    math::{DAffine3, DMat3, DVec3},
    prelude::*,
};
use tabletop_core::{Face, Figure, FingerLook, GripperLayout, Robot};
use tabletop_geometry::UNITS_PER_METER;
use tabletop_kinematics::{Geometry, Link, LinkId, LinkShape};

use crate::{
    articulation::link_entities::LinkEntities,
    articulation::tree::{Articulation, Carrier},
    description::Description,
    look::error::LookError,
    look::figure::{figure_of, merged, screen_with, stand_in},
    look::meshes::is_ours,
};

/// The figures of the robot's bodies, made when it is shown for the first time.
#[derive(Resource, Default)]
pub(crate) struct LinkFigures {
    bodies: Vec<Option<Figure>>,
    /// The present look: nothing, or this face on the robot with this first body.
    shown: Option<(Face, Entity)>,
}

/// Gives the bodies their figures while the robot is shown, and its screen the face.
pub(crate) fn show_figures(
    robot: Res<Robot>,
    description: Res<Description>,
    articulation: Res<Articulation>,
    parts: Res<LinkEntities>,
    mut figures: ResMut<LinkFigures>,
    mut commands: Commands,
) {
    let first = parts.0.first().copied().filter(|_| robot.is_shown);
    let show = first.map(|first| (robot.face, first));
    if figures.shown == show {
        return;
    }
    if show.is_some() && figures.bodies.is_empty() {
        figures.bodies = description.figures_of(&articulation).to_vec();
    }
    for (number, &part) in parts.0.iter().enumerate() {
        let body = &articulation.bodies[number];
        let is_screen = matches!(body.carrier, Carrier::Link(_))
            && articulation.layout.screen.as_ref() == Some(&body.id);
        let mut part = commands.entity(part);
        let Some((face, first)) = show else {
            part.remove::<Figure>();
            continue;
        };
        let is_new = figures.shown.is_none_or(|(_, before)| before != first);
        let figure = if is_screen {
            let make = || screen(&description, &body.id, face);
            description.figures.screen(face, make)
        } else if is_new {
            figures.bodies[number].clone()
        } else {
            None
        };
        if let Some(figure) = figure {
            part.insert(figure);
        }
    }
    figures.shown = show;
}

impl Description {
    /// The figures of its bodies, by their numbers in an articulation of it; of the screen, without a face. `None` for bodies that nothing shows.
    pub fn figures_of(&self, articulation: &Articulation) -> &[Option<Figure>] {
        self.figures.bodies(|| figures_of(self, articulation))
    }
}

/// The figures of the bodies. A mesh that cannot be read is reported once, however many visuals use it.
fn figures_of(description: &Description, articulation: &Articulation) -> Vec<Option<Figure>> {
    let mut reported = BTreeSet::new();
    let bodies = articulation.bodies.iter();
    bodies
        .map(|body| match body.carrier {
            Carrier::Link(link) => {
                let link = description.model.link(link);
                figure_of_link(description, link).unwrap_or_else(|error| {
                    if reported.insert(error.to_string()) {
                        warn!(
                            "link {} is shown by its collision shape: {error}",
                            link.name
                        );
                    }
                    stand_in(&link.collisions)
                })
            }
            Carrier::Gripper(limb, side) => {
                let gripper = &articulation.layout.limb(limb).gripper;
                let own = articulation.finger_links(limb, side);
                let figure = match own.is_empty() {
                    true => finger(gripper, description),
                    false => own_finger(&own, description),
                };
                figure.unwrap_or_else(|error| {
                    if reported.insert(error.to_string()) {
                        warn!("fingers are shown by their collision shapes: {error}");
                    }
                    stand_in(&[finger_solid(gripper)])
                })
            }
        })
        .collect()
}

/// The figure of a link; `None` if it has no visuals.
fn figure_of_link(description: &Description, link: &Link) -> Result<Option<Figure>, LookError> {
    let visuals = link.visuals.iter();
    let visuals: Result<Vec<_>, _> = visuals.map(|visual| seen(visual, description)).collect();
    visuals.map(merged)
}

fn screen(description: &Description, link: &str, face: Face) -> Option<Figure> {
    let link = description.model.find_link(link).ok()?;
    let link = description.model.link(link);
    match &link.visuals[..] {
        [visual] if is_ours(visual) => screen_with(face, visual, description.source.as_ref()).ok(),
        _ => figure_of_link(description, link).unwrap_or_else(|_| stand_in(&link.collisions)),
    }
}

fn seen(visual: &LinkShape, description: &Description) -> Result<Figure, LookError> {
    figure_of(visual, description.source.as_ref())
}

/// The figure of a finger that the description has: its links, each with its frame in the finger's, in m.
fn own_finger(
    links: &[(LinkId, DAffine3)],
    description: &Description,
) -> Result<Option<Figure>, LookError> {
    let visuals = links.iter().flat_map(|&(link, frame)| {
        let visuals = description.model.link(link).visuals.iter();
        visuals.map(move |visual| LinkShape {
            origin: frame * visual.origin,
            ..visual.clone()
        })
    });
    let figures: Result<Vec<_>, _> = visuals.map(|visual| seen(&visual, description)).collect();
    figures.map(merged)
}

/// The figure of a finger of the simulator.
fn finger(gripper: &GripperLayout, description: &Description) -> Result<Option<Figure>, LookError> {
    let Some(FingerLook { file, axes }) = &gripper.look else {
        return Ok(stand_in(&[finger_solid(gripper)]));
    };
    let visual = LinkShape {
        origin: DAffine3::from_mat3(DMat3::from_cols_array_2d(axes)),
        geometry: Geometry::Mesh {
            file: file.clone(),
            scale: DVec3::ONE,
        },
        color: None,
    };
    seen(&visual, description).map(Some)
}

/// The collision shape of a finger.
fn finger_solid(gripper: &GripperLayout) -> LinkShape {
    LinkShape {
        origin: DAffine3::IDENTITY,
        geometry: Geometry::Box {
            size: gripper.finger.as_dvec3() / UNITS_PER_METER,
        },
        color: None,
    }
}
