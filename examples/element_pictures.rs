//! Pictures of the elements of task files for the documentation, drawn as the head camera draws them:
//! `cargo run --release --example element_pictures`.
#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use std::{error::Error, fs, fs::File, io::BufWriter, path::Path};

use bevy::prelude::*;
use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{Bounds, JointMotion, Picture, SceneItem, SceneSpec, Table};
use tabletop_scene::{IdAllocator, assemble};

const TASK: &str = "tablesetup/elements.xml";
const FOLDER: &str = "docs/elements";

/// Direction of the camera from the middle of its subject, in radii of the subject.
const FROM: Vec3 = Vec3::new(-1.0, -3.2, 2.2);

/// Columns and rows of the pictures.
const SIZE: [u32; 2] = [240, 180];

fn main() -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(FOLDER)?;
    let task = tabletop_xml::read_task(Path::new(TASK))?;
    let (mut rasterizer, mut picture) = (Rasterizer::default(), Picture::default());
    for item in task.scene.items {
        let path = format!("{FOLDER}/{}.png", name(&item));
        let (scene, bounds) = alone(task.scene.table, item);
        let middle = bounds.low.midpoint(bounds.high);
        let radius = bounds.low.distance(bounds.high) / 2.0;
        let place = Transform::from_translation(middle + FROM * radius).looking_at(middle, Vec3::Z);
        let camera = Camera {
            pose: (&place).into(),
            vertical_fov: 32_f32.to_radians(),
            square_fov: false,
            width: SIZE[0],
            height: SIZE[1],
            antialiasing: true,
        };
        rasterizer.draw(&scene, &camera, &mut picture);
        write_png(&picture, Path::new(&path))?;
        println!("{path}");
    }
    Ok(())
}

fn name(item: &SceneItem) -> &'static str {
    match item {
        SceneItem::Object(object) => object.shape.name(),
        SceneItem::Chain(_) => "chain",
        SceneItem::LidBox(_) => "lidbox",
        SceneItem::Jointed(jointed) => match jointed.motion {
            JointMotion::Slide => "sliderJoint",
            JointMotion::Turn => "hingeJoint",
            JointMotion::Shear => "scissors",
        },
    }
}

/// An item on the table, and the cuboid around it.
fn alone(table: Table, item: SceneItem) -> (Scene, Bounds) {
    let bounds = Bounds::of_item(&item);
    let items = vec![item];
    let assembly = assemble(&SceneSpec { table, items }, &mut IdAllocator::default());
    let mut solids = vec![DrawnSolid::of_table(&table, 1)];
    for object in &assembly.objects {
        let drawn = object.shape.drawn();
        solids.extend(
            drawn
                .iter()
                .map(|solid| DrawnSolid::of(object.pose, solid, 2)),
        );
    }
    let scene = Scene {
        solids,
        ..default()
    };
    (scene, bounds)
}

fn write_png(picture: &Picture, path: &Path) -> Result<(), Box<dyn Error>> {
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&picture.rgb)?;
    Ok(())
}
