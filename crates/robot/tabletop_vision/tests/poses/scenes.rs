//! Random scenes of the tasks that robots imitate, at their beginnings and at their ends, and pictures of them.

use std::{f32::consts::TAU, path::Path};

use bevy::math::{Quat, Vec2, Vec3, Vec3Swizzles as _};
use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{HeadCamera, LIGHT, Light, ObjectSpec, Picture, Random, Shape, Table};
use tabletop_geometry::{NAMED_COLORS, Pose, Rgb};
use tabletop_scene::{IdAllocator, assemble};
use tabletop_vision::{Eyes, KnownObject, YawSymmetry};

/// A task, of whose scenes pictures are taken.
#[derive(Clone, Copy, Debug)]
pub struct TaskScene {
    pub name: &'static str,
    text: &'static str,
    /// What is put on or around what in the end, in turn: objects by id, and the offset in the frame of the other.
    stacks: &'static [(&'static str, &'static str, [f32; 3])],
    /// Objects that begin on or around others.
    begins: &'static [(&'static str, &'static str, [f32; 3])],
}

pub const TASKS: [TaskScene; 5] = [
    TaskScene {
        name: "stack_three",
        text: include_str!("../../../../../tablesetup/blocks.xml"),
        stacks: &[
            ("Green", "Blue", [0.05, -0.03, 1.0]),
            ("Red", "Green", [-0.06, 0.02, 1.0]),
        ],
        begins: &[],
    },
    TaskScene {
        name: "letter_u",
        text: include_str!("../../../../../tablesetup/letter-bars.xml"),
        stacks: &[
            ("Left", "Bottom", [-1.2, 2.1, 0.0]),
            ("Right", "Bottom", [1.2, 2.1, 0.0]),
        ],
        begins: &[],
    },
    TaskScene {
        name: "wall",
        text: include_str!("../../../../../tablesetup/wall-blocks.xml"),
        stacks: &[
            ("Orange", "Red", [1.2, 0.0, 0.0]),
            ("Yellow", "Red", [0.6, 0.0, 1.0]),
            ("Green", "Red", [2.4, 0.0, 0.0]),
            ("Blue", "Orange", [0.6, 0.0, 1.0]),
        ],
        begins: &[],
    },
    TaskScene {
        name: "hanoi",
        text: include_str!("../../../../../tablesetup/hanoi.xml"),
        stacks: &[
            ("Big", "PegC", [0.02, 0.01, 0.3]),
            ("Middle", "Big", [0.01, -0.03, 0.4]),
            ("Small", "Middle", [-0.02, 0.01, 0.4]),
        ],
        begins: &[
            ("Big", "PegA", [0.01, -0.02, 0.3]),
            ("Middle", "Big", [-0.01, 0.02, 0.4]),
            ("Small", "Middle", [0.0, 0.02, 0.4]),
        ],
    },
    TaskScene {
        name: "hanoi_rings",
        text: include_str!("../../../../../tablesetup/hanoi-rings.xml"),
        stacks: &[
            ("Big", "PegC", [0.02, 0.01, 0.3]),
            ("Middle", "Big", [0.01, -0.03, 0.4]),
            ("Small", "Middle", [-0.02, 0.01, 0.4]),
        ],
        begins: &[
            ("Big", "PegA", [0.01, -0.02, 0.3]),
            ("Middle", "Big", [-0.01, 0.02, 0.4]),
            ("Small", "Middle", [0.0, 0.02, 0.4]),
        ],
    },
];

/// What makes a picture hard.
#[derive(Clone, Copy, Debug, Default)]
pub struct Difficulty {
    pub is_end: bool,
    /// Standard deviation of the noise, in grey levels.
    pub noise: f32,
    /// Largest number of unknown objects.
    pub distractors: u32,
    /// All objects have the colour of the first.
    pub same_color: bool,
    /// As the variation of the same name of demonstrations.
    pub light: f32,
}

/// A scene with its picture.
#[derive(Clone, Debug)]
pub struct Sample {
    pub known: Vec<KnownObject>,
    /// Objects of one number look the same.
    pub looks: Vec<usize>,
    pub symmetries: Vec<YawSymmetry>,
    pub poses: Vec<Pose>,
    pub table: Table,
    pub camera: Camera,
    pub picture: Picture,
    /// The part of each object's pixels that others leave visible.
    pub visible: Vec<f32>,
    shapes: Vec<Shape>,
    is_light_unknown: bool,
}

impl TaskScene {
    pub fn sample(&self, difficulty: &Difficulty, seed: u64) -> Sample {
        let mut random = Random::new(seed.wrapping_mul(0x9e37) + 17);
        let parsed = tabletop_xml::parse(Path::new(self.name), self.text.as_bytes());
        assert!(parsed.faults.is_empty());
        let table = parsed.scene.table;
        let mut objects = assemble(&parsed.scene, &mut IdAllocator::default()).objects;
        if difficulty.same_color {
            let color = objects[0].shape.drawn()[0].color;
            for object in &mut objects {
                for own in object.shape.colors_mut() {
                    *own = color;
                }
            }
        }
        self.scatter(&mut objects, difficulty, &mut random);
        let count = objects.len();
        self.distract(&mut objects, difficulty, &mut random);
        let mut camera = Camera::of_head(&HeadCamera::default(), &table);
        if difficulty.light > 0.0 {
            camera.light = any_light(difficulty.light, &mut random);
        }
        let mut scene = Scene {
            solids: vec![DrawnSolid::of_table(&table, 1)],
            ..Scene::default()
        };
        for (object, number) in objects.iter().zip(2..) {
            let solids = object.shape.drawn();
            scene.solids.extend(
                solids
                    .iter()
                    .map(|solid| DrawnSolid::of(object.pose, solid, number)),
            );
        }
        let mut picture = Picture::default();
        Rasterizer::alone().draw(&scene, &camera, &mut picture);
        let shown = |picture: &Picture, number: u32| {
            let pixels = picture.objects.iter().filter(|own| **own == number);
            pixels.count() as f32
        };
        let visible = (2..count as u32 + 2).map(|number| {
            let mut alone = scene.clone();
            alone.solids.retain(|solid| solid.object == number);
            let mut whole = Picture::default();
            Rasterizer::alone().draw(&alone, &camera, &mut whole);
            shown(&picture, number) / shown(&whole, number).max(1.0)
        });
        let visible = visible.collect();
        if difficulty.noise > 0.0 {
            for part in &mut picture.rgb {
                *part = (f32::from(*part) + difficulty.noise * normal(&mut random))
                    .round()
                    .clamp(0.0, 255.0) as u8;
            }
        }
        objects.truncate(count);
        let known: Vec<_> = objects
            .iter()
            .map(|object| {
                let known = KnownObject::of(&object.shape);
                if object.mass == 0.0 {
                    known.fixed()
                } else {
                    known
                }
            })
            .collect();
        camera.light = LIGHT;
        Sample {
            is_light_unknown: difficulty.light > 0.0,
            looks: known
                .iter()
                .map(|one| {
                    known
                        .iter()
                        .position(|other| one.turn_to(other).is_some())
                        .unwrap()
                })
                .collect(),
            symmetries: known.iter().map(KnownObject::symmetry).collect(),
            poses: objects.iter().map(|object| object.pose).collect(),
            known,
            table,
            camera,
            picture,
            visible,
            shapes: objects.iter().map(|object| object.shape.clone()).collect(),
        }
    }

    /// Puts everything at random places of the table that do not overlap, and what stands on something there.
    fn scatter(&self, objects: &mut [ObjectSpec], difficulty: &Difficulty, random: &mut Random) {
        let attached = if difficulty.is_end {
            self.stacks
        } else {
            self.begins
        };
        let radius = |object: &ObjectSpec| {
            let bounds = object.shape.bounds(Pose::IDENTITY);
            bounds.low.xy().abs().max(bounds.high.xy().abs()).length()
        };
        // Room for a wall or a letter beside what it is built at.
        let room = |id: &str| {
            attached
                .iter()
                .filter(|(_, to, _)| *to == id)
                .map(|(_, _, offset)| Vec2::new(offset[0], offset[1]).length() + 0.8)
                .fold(0.0, f32::max)
        };
        'again: loop {
            let mut taken: Vec<(Vec2, f32)> = Vec::new();
            for object in objects.iter_mut() {
                if attached.iter().any(|(id, _, _)| *id == object.id) {
                    continue;
                }
                let reach = radius(object).max(room(&object.id));
                let mut is_placed = false;
                for _ in 0..50 {
                    let at = Vec2::new(random.between((-5.5, 5.5)), random.between((-4.8, 0.0)));
                    if taken
                        .iter()
                        .all(|(other, room)| other.distance(at) > room + reach)
                    {
                        taken.push((at, reach));
                        object.pose.location = at.extend(object.pose.location.z);
                        object.pose.rotation = Quat::from_rotation_z(random.between((0.0, TAU)));
                        is_placed = true;
                        break;
                    }
                }
                if !is_placed {
                    continue 'again;
                }
            }
            self.attach(objects, attached, random);
            // About where the arms reach.
            let is_seen = |object: &ObjectSpec| {
                let bounds = object.shape.bounds(object.pose);
                bounds.low.y > -5.4
                    && bounds.high.y < 0.5
                    && bounds.low.x.abs().max(bounds.high.x.abs()) < 7.0
            };
            if objects.iter().all(is_seen) {
                return;
            }
        }
    }

    fn attach(
        &self,
        objects: &mut [ObjectSpec],
        attached: &[(&str, &str, [f32; 3])],
        random: &mut Random,
    ) {
        for (id, to, offset) in attached {
            let base = objects.iter().find(|object| object.id == *to).unwrap().pose;
            let turn = Quat::from_rotation_z(random.between((-0.1, 0.1)));
            let object = objects.iter_mut().find(|object| object.id == *id).unwrap();
            object.pose = base
                * Pose::new(
                    Vec3::from(*offset),
                    if offset[2] > 0.0 {
                        turn
                    } else {
                        Quat::IDENTITY
                    },
                );
        }
    }

    fn distract(
        &self,
        objects: &mut Vec<ObjectSpec>,
        difficulty: &Difficulty,
        random: &mut Random,
    ) {
        let count = if difficulty.distractors > 0 {
            random.bits() % (u64::from(difficulty.distractors) + 1)
        } else {
            0
        };
        for number in 0..count {
            let color = any_color(random);
            let [x, y, z] = [(); 3].map(|()| random.between((0.6, 1.6)));
            let (shape, rotation) = match random.bits() % 2 {
                0 => (
                    Shape::Block {
                        span: Vec3::new(x, y, z),
                        color,
                    },
                    Quat::from_rotation_z(random.between((0.0, TAU))),
                ),
                _ => (
                    Shape::Cylinder {
                        radius: x / 2.0,
                        yspan: z,
                        color,
                    },
                    Quat::from_rotation_x(TAU / 4.0),
                ),
            };
            for _ in 0..200 {
                let at = Vec2::new(random.between((-6.0, 6.0)), random.between((-5.0, 2.0)));
                let is_free = objects.iter().all(|other| {
                    let bounds = other.shape.bounds(other.pose);
                    let gap = (bounds.low.xy() - at)
                        .max(at - bounds.high.xy())
                        .max(Vec2::ZERO);
                    gap.length() > x.max(y) * 0.75
                });
                if is_free {
                    objects.push(ObjectSpec::new(
                        format!("Distractor{number}"),
                        Pose::new(at.extend(z / 2.0), rotation),
                        1.0,
                        shape,
                    ));
                    break;
                }
            }
        }
    }
}

/// As demonstrations are varied.
fn any_color(random: &mut Random) -> Rgb {
    let (_, named) = NAMED_COLORS[(random.bits() % NAMED_COLORS.len() as u64) as usize];
    let shade = random.between((-0.12, 0.12));
    let part = |part: f32| (part + shade).clamp(0.0, 1.0);
    Rgb::new(part(named.red), part(named.green), part(named.blue))
}

fn any_light(light: f32, random: &mut Random) -> Light {
    let mut any = |most: f32| random.between((-most, most));
    let brightness = 1.0 + any(light);
    let from = Vec3::new(any(light), any(light), 0.0);
    let warmth = any(light * 0.5);
    let at_most_all = |shares: Vec3| shares.min(Vec3::ONE);
    Light {
        along: at_most_all(LIGHT.along * (Vec3::ONE + from)),
        against: at_most_all(LIGHT.against * (Vec3::ONE - from)),
        color: LIGHT.color * brightness * Vec3::new(1.0 + warmth, 1.0, 1.0 - warmth),
    }
}

fn normal(random: &mut Random) -> f32 {
    (0..12).map(|_| random.between((0.0, 1.0))).sum::<f32>() - 6.0
}

/// The error of an object's pose: in units, in degrees.
#[derive(Clone, Copy, Debug)]
pub struct PoseError {
    pub length: f32,
    pub degrees: f32,
    pub is_sure: bool,
    /// The part of the object that is visible.
    pub visible: f32,
}

impl Sample {
    /// Eyes for the known objects, which have seen nothing yet.
    pub fn eyes(&self) -> Eyes {
        let eyes = Eyes::new(self.known.clone(), self.camera, self.table);
        match self.is_light_unknown {
            true => eyes.adapting(),
            false => eyes,
        }
    }

    /// A picture of the known objects elsewhere.
    pub fn with_poses(&self, poses: &[Pose]) -> Picture {
        self.with_poses_and(poses, &[])
    }

    /// A picture of the known objects elsewhere, and of more.
    pub fn with_poses_and(&self, poses: &[Pose], more: &[DrawnSolid]) -> Picture {
        let mut scene = Scene {
            solids: vec![DrawnSolid::of_table(&self.table, 1)],
            ..Scene::default()
        };
        for ((shape, pose), number) in self.shapes.iter().zip(poses).zip(2..) {
            let solids = shape.drawn();
            scene.solids.extend(
                solids
                    .iter()
                    .map(|solid| DrawnSolid::of(*pose, solid, number)),
            );
        }
        scene.solids.extend_from_slice(more);
        let mut picture = Picture::default();
        Rasterizer::alone().draw(&scene, &self.camera, &mut picture);
        picture
    }

    /// The errors of estimated poses; of objects that look the same, each is compared with the nearest one.
    pub fn errors(&self, seen: &tabletop_vision::Percept) -> Vec<PoseError> {
        let mut is_free = vec![true; self.poses.len()];
        let mut errors = Vec::new();
        for (i, own) in seen.objects.iter().enumerate() {
            let Some(pose) = own.pose else {
                errors.push(PoseError {
                    length: f32::INFINITY,
                    degrees: 180.0,
                    is_sure: own.is_sure,
                    visible: self.visible[i],
                });
                continue;
            };
            let alike =
                (0..self.poses.len()).filter(|&j| self.looks[j] == self.looks[i] && is_free[j]);
            let j = alike
                .min_by(|&a, &b| {
                    self.poses[a]
                        .location
                        .distance(pose.location)
                        .total_cmp(&self.poses[b].location.distance(pose.location))
                })
                .unwrap();
            is_free[j] = false;
            let turn = pose.rotation * self.poses[j].rotation.inverse();
            let yaw = 2.0 * turn.z.atan2(turn.w);
            let yaw = yaw + self.known[j].turn_to(&self.known[i]).unwrap();
            let yaw = match self.symmetries[i] {
                YawSymmetry::Any => 0.0,
                YawSymmetry::Turns(turns) => {
                    let period = TAU / turns as f32;
                    yaw - (yaw / period).round() * period
                }
            };
            errors.push(PoseError {
                length: pose.location.distance(self.poses[j].location),
                degrees: yaw.to_degrees().abs(),
                is_sure: own.is_sure,
                visible: self.visible[j],
            });
        }
        errors
    }
}
