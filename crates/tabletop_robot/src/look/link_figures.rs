//! What is seen of the robot in the world.

use std::collections::BTreeSet;

use bevy::{math::DAffine3, prelude::*};
use tabletop_core::{Face, Figure, Robot};
use tabletop_kinematics::{Geometry, Link, LinkShape};

use crate::{
    articulation::link_entities::LinkEntities,
    articulation::tree::{Articulation, Carrier, WRIST_TURNED},
    description::Description,
    look::error::LookError,
    look::figure::{figure_of, merged, screen_with, stand_in},
};

/// The link whose face changes.
const SCREEN: &str = "screen";

/// The looks of the robot's bodies, made when it is shown for the first time.
#[derive(Resource, Default)]
pub(crate) struct LinkFigures {
    bodies: Vec<Option<Figure>>,
    /// What is seen now: nothing, or this face on the robot whose first body is this one.
    shown: Option<(Face, Entity)>,
}

/// Gives the bodies what they look like while the robot is shown, and its screen the face.
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
        figures.bodies = figures_of(&description, &articulation);
    }
    for (number, &part) in parts.0.iter().enumerate() {
        let is_screen = matches!(articulation.bodies[number].carrier, Carrier::Link(link)
            if description.model.link(link).name == SCREEN);
        let mut part = commands.entity(part);
        let Some((face, first)) = show else {
            part.remove::<Figure>();
            continue;
        };
        let is_new = figures.shown.is_none_or(|(_, before)| before != first);
        let figure = if is_screen {
            screen(&description, face)
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

/// What the bodies look like. A mesh that cannot be read is told once, whatever shows it.
fn figures_of(description: &Description, articulation: &Articulation) -> Vec<Option<Figure>> {
    let mut told = BTreeSet::new();
    let bodies = articulation.bodies.iter();
    bodies
        .map(|body| match body.carrier {
            Carrier::Link(link) => {
                let link = description.model.link(link);
                figure_of_link(description, link).unwrap_or_else(|error| {
                    if told.insert(error.to_string()) {
                        warn!(
                            "link {} is shown by what it is touched by: {error}",
                            link.name
                        );
                    }
                    stand_in(&link.collisions)
                })
            }
            Carrier::Gripper(..) => seen(&finger(), description).ok(),
        })
        .collect()
}

/// What a link looks like; nothing if nothing of it is seen.
fn figure_of_link(description: &Description, link: &Link) -> Result<Option<Figure>, LookError> {
    let visuals = link.visuals.iter();
    let visuals: Result<Vec<_>, _> = visuals.map(|visual| seen(visual, description)).collect();
    visuals.map(merged)
}

fn screen(description: &Description, face: Face) -> Option<Figure> {
    let link = description.model.find_link(SCREEN).ok()?;
    let link = description.model.link(link);
    match &link.visuals[..] {
        [visual] if is_ours(visual) => screen_with(face, visual, description.path()).ok(),
        _ => figure_of_link(description, link).unwrap_or_else(|_| stand_in(&link.collisions)),
    }
}

fn seen(visual: &LinkShape, description: &Description) -> Result<Figure, LookError> {
    figure_of(visual, description.path())
}

/// Whether a visual is one of the program's own shapes.
fn is_ours(visual: &LinkShape) -> bool {
    matches!(&visual.geometry, Geometry::Mesh { file, .. } if file.starts_with("package://tabletop/"))
}

/// The visual of a finger. Its shape has the axes of a wrist.
fn finger() -> LinkShape {
    LinkShape {
        origin: DAffine3::from_mat3(WRIST_TURNED),
        geometry: Geometry::Mesh {
            file: "package://tabletop/finger.shape.json".into(),
            scale: bevy::math::DVec3::ONE,
        },
        color: None,
    }
}
