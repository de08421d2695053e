//! Pictures of the robot from four sides, drawn as the head camera draws: `cargo run --release --example robot_pictures`.
//!
//! Nothing is simulated: the robot's description gives the poses of its links, and `tabletop_robot` their looks.
#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use std::{error::Error, fs::File, io::BufWriter, path::Path, sync::Arc};

use bevy::prelude::*;
use tabletop_camera::{Camera, DrawnFigure, DrawnSolid, Facets, Rasterizer, Scene};
use tabletop_core::{Face, JointRole, LIGHT, Picture, RobotLayout, Table};
use tabletop_geometry::{Pose, Rgb, Solid};
use tabletop_kinematics::{RobotModel, baxter};
use tabletop_robot::look::{figure_of, merged, screen_with};

/// Units in a metre.
const UNITS: f64 = 10.0;

/// The files of the pictures, and their directions of view from [`MIDDLE`], in units.
const VIEWS: [(&str, Vec3); 4] = [
    ("docs/robot-front.png", Vec3::new(3.0, 30.0, 9.0)),
    ("docs/robot-left.png", Vec3::new(-28.0, 9.0, 8.0)),
    ("docs/robot-back.png", Vec3::new(-9.0, -28.0, 9.0)),
    ("docs/robot-right.png", Vec3::new(26.0, 8.0, 15.0)),
];

/// The middle of the pictures.
const MIDDLE: Vec3 = Vec3::new(0.0, -7.0, 2.0);

/// Columns and rows of the pictures.
const SIZE: u32 = 640;

fn main() -> Result<(), Box<dyn Error>> {
    let floor = backdrop(Vec3::NEG_Z * 7.8, Vec3::new(200.0, 200.0, 1.0));
    let mut scene = Scene {
        solids: vec![
            DrawnSolid::of_table(&Table::default(), 1),
            floor.clone(),
            floor,
        ],
        figures: robot(&baxter()?)?,
        ..default()
    };
    let (mut rasterizer, mut picture) = (Rasterizer::default(), Picture::default());
    for (path, from) in VIEWS {
        let place = Transform::from_translation(MIDDLE + from).looking_at(MIDDLE, Vec3::Z);
        let away = from.with_z(0.0).normalize();
        scene.solids[2] = DrawnSolid {
            pose: Pose::new(MIDDLE - away * 40.0, Quat::from_rotation_arc(Vec3::Y, away)),
            ..backdrop(Vec3::ZERO, Vec3::new(200.0, 1.0, 200.0))
        };
        let camera = Camera {
            pose: (&place).into(),
            vertical_fov: 38_f32.to_radians(),
            square_fov: false,
            width: SIZE,
            height: SIZE,
            antialiasing: true,
            light: LIGHT,
        };
        rasterizer.draw(&scene, &camera, &mut picture);
        write_png(&picture, Path::new(path))?;
        println!("{path}");
    }
    Ok(())
}

/// The links of the robot where they are when the program starts.
fn robot(model: &RobotModel) -> Result<Vec<DrawnFigure>, Box<dyn Error>> {
    let mut configuration = model.zero();
    let layout = RobotLayout::baxter();
    for joint in &layout.joints {
        match joint.role {
            JointRole::Limb { .. } | JointRole::Neck => {
                configuration[model.find_joint(&joint.urdf_name)?] = joint.home;
            }
            JointRole::Gripper(limb) => {
                for finger in &layout.limb(limb).gripper.finger_joints {
                    configuration[model.find_joint(finger)?] = joint.home / 2.0 / UNITS;
                }
            }
        }
    }
    let frames = model.frames(&configuration);
    let base = RobotLayout::baxter().base.pose(&Table::default());
    let mut figures = Vec::new();
    for link in model.links() {
        let visuals = link.visuals.iter();
        let parts: Result<Vec<_>, _> = visuals
            .map(|visual| match &*link.name {
                "screen" => screen_with(Face::Happy, visual, None),
                _ => figure_of(visual, None),
            })
            .collect();
        let frame = &frames[model.find_link(&link.name)?];
        let (_, rotation, location) = frame.to_scale_rotation_translation();
        let place = Pose::new((location * UNITS).as_vec3(), rotation.as_quat());
        figures.extend(merged(parts?).map(|figure| DrawnFigure {
            pose: base * place,
            facets: Arc::new(Facets::from(&*figure.fine)),
            object: 2,
        }));
    }
    Ok(figures)
}

fn backdrop(location: Vec3, span: Vec3) -> DrawnSolid {
    DrawnSolid {
        pose: Pose::at(location),
        solid: Solid::Cuboid(span),
        color: Rgb::new(0.62, 0.66, 0.70),
        object: 3,
    }
}

fn write_png(picture: &Picture, path: &Path) -> Result<(), Box<dyn Error>> {
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&picture.rgb)?;
    Ok(())
}
