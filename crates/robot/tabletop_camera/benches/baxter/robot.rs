//! Baxter over three blocks, as an environment sees it.

use bevy::math::{Quat, Vec3};
use tabletop_camera::{Camera, DrawnFigure, DrawnSolid, Scene};
use tabletop_core::{HeadCamera, Random, Robot, Table};
use tabletop_geometry::{Pose, Rgb, Solid};
use tabletop_robot::{Articulation, Description, Positions, TreePosition};

/// Largest turn of a joint from a picture to the next, in rad: that of 1/20 s.
const TURN: f32 = 0.015;

/// A robot whose joints move a little from picture to picture, but not its neck.
pub struct MovingBaxter {
    description: Description,
    articulation: Articulation,
    positions: Positions,
    random: Random,
    table: Table,
}

impl MovingBaxter {
    pub fn at_home() -> Self {
        let description = Description::baxter().expect("it ships with the program");
        let articulation = Articulation::new(description.model.clone(), description.layout.clone());
        let robot = Robot::at_home(&description.layout);
        Self {
            description,
            articulation: articulation.expect("it ships with the program"),
            positions: robot.joints.iter().map(|joint| joint.position).collect(),
            random: Random::new(0),
            table: Table {
                xspan: 20.0,
                yspan: 12.0,
            },
        }
    }

    /// The view of its head.
    pub fn camera(&self, side: u32, antialiasing: bool) -> Camera {
        let head = HeadCamera {
            width: side,
            height: side,
            antialiasing,
            ..HeadCamera::default()
        };
        Camera::of_head(&head, &self.table)
    }

    /// Turns its joints.
    pub fn step(&mut self) {
        let neck = self.description.layout.neck;
        for (i, position) in self.positions.iter_mut().enumerate() {
            let turn = self.random.between((-TURN, TURN));
            if neck.is_none_or(|neck| neck.index() != i) {
                *position += f64::from(turn);
            }
        }
    }

    /// What its head sees.
    pub fn scene(&self) -> Scene {
        let block = |number: u32, [x, y]: [f32; 2], degrees: f32, color| DrawnSolid {
            pose: Pose::new(
                Vec3::new(x, y, 0.5),
                Quat::from_rotation_z(degrees.to_radians()),
            ),
            solid: Solid::Cuboid(Vec3::ONE),
            color,
            object: 2 + number,
        };
        let base = self.articulation.layout.base.pose(&self.table);
        let posture = self.articulation.posture(&self.positions, base);
        let figures = self.description.figures_of(&self.articulation);
        let bodies = self.articulation.bodies.iter().zip(posture.bodies());
        let shown = bodies.zip(figures).filter_map(|((body, &pose), figure)| {
            let figure = figure.as_ref()?;
            (body.place != TreePosition::Head).then_some((pose, figure))
        });
        Scene {
            solids: vec![
                DrawnSolid::of_table(&self.table, 1),
                block(0, [-3.0, -3.0], 15.0, Rgb::RED),
                block(1, [0.0, -4.0], -30.0, Rgb::GREEN),
                block(2, [3.0, -2.5], 40.0, Rgb::BLUE),
            ],
            figures: (5..)
                .zip(shown)
                .map(|(object, (pose, figure))| DrawnFigure::of(pose, figure, object))
                .collect(),
            markers: Vec::new(),
        }
    }
}
