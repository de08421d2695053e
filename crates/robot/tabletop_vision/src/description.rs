//! Descriptions: what objects look like that nothing is known of, from the pictures that show them where they are first.

use std::f32::consts::{FRAC_PI_2, TAU};

use bevy::math::{Vec2, Vec3};
use tabletop_camera::{Camera, DrawnSolid, PictureLayers, PictureWindow, Scene};
use tabletop_core::{Picture, Shape, Table};
use tabletop_geometry::{Pose, Rgb, turn_about};

use crate::{
    normal::LeastSquares,
    pixels::rows,
    residual::{OUTLIER, Residual, TRIED, TriedFit, square_of},
    segment::{Blob, blobs},
    transfer::ToneTransfer,
};

/// An object that was described.
#[derive(Clone, Debug, PartialEq)]
pub struct DescribedObject {
    /// A block, a cylinder that stands upright, or a sphere.
    pub shape: Shape,
    /// Its pose on the table.
    pub pose: Pose,
}

/// Squared difference of a pixel from the table's picture above which it shows an object.
const DIFFERENT: f32 = 1500.0;
/// Largest angle, in rad, between colours, as rays from black, of one object, whose sides are lit differently.
const ALIKE: f32 = 0.16;
/// Least number of pixels of an object.
const LEAST_PIXELS: usize = 25;
/// The most objects that are described.
const MOST: usize = 24;
/// The most numbers of a model.
const PARAMETERS: usize = 6;
/// Steps of the derivatives of least squares, in units or about as far, the most solutions with each, and their damping.
const SQUARES_STEPS: [f32; 6] = [0.15, 0.1, 0.06, 0.1, 0.06, 0.03];
const MOST_SQUARES: usize = 25;
const DAMPING: f64 = 1e-4;
/// The first and the last of the smaller steps thereafter.
const STEPS: [f32; 2] = [0.01, 0.000_5];
/// Number of starts that are refined.
const REFINED: usize = 16;
/// The least size of an object, in units.
const THINNEST: f32 = 0.1;

/// Least part of an object's pixels that it keeps if it has not moved, and least growth of their number from which it is described anew.
const SAME_PLACE: f32 = 0.9;
const MORE: f32 = 1.1;

/// Objects on a table, none of which is known: each is taken for a block, a cylinder that stands upright, or a sphere, of one colour, on the table itself.
///
/// The first picture says which objects there are. What hides parts of each other is described by what is seen of it, and better as soon as a later picture
/// shows more of it, while it stands where it is first.
#[derive(Clone, Debug)]
pub struct Descriptions {
    camera: Camera,
    table: Table,
    described: Vec<Described>,
}

/// An object as described, and its pixels in the picture that has shown most of it.
#[derive(Clone, Debug)]
struct Described {
    object: DescribedObject,
    silhouette: Blob,
}

impl Descriptions {
    /// The objects of the first picture. None if the camera takes others.
    pub fn of(picture: &Picture, camera: &Camera, table: &Table) -> Self {
        let mut descriptions = Self {
            camera: *camera,
            table: *table,
            described: Vec::new(),
        };
        let Some((mut residual, mut silhouettes)) = descriptions.look(picture) else {
            return descriptions;
        };
        // What is nearer to the camera hides what is behind it.
        let lowest = |blob: &Blob| blob.pixels.last().copied();
        silhouettes.sort_by_key(|blob| std::cmp::Reverse(lowest(blob)));
        for silhouette in silhouettes.into_iter().take(MOST) {
            let nearer = descriptions.objects();
            let found = described_by(&silhouette, &mut residual, solids_of(nearer));
            let found = found.map(|object| Described { object, silhouette });
            descriptions.described.extend(found);
        }
        descriptions
    }

    /// Describes those objects anew of which a later picture shows more.
    pub fn see(&mut self, picture: &Picture) {
        let Some((mut residual, silhouettes)) = self.look(picture) else {
            return;
        };
        for described in &mut self.described {
            let mut grown = silhouettes.iter().filter(|it| described.shows_more(it));
            let found = grown.next().and_then(|silhouette| {
                let object = described_by(silhouette, &mut residual, Vec::new())?;
                let is_like =
                    color_of(&object).dot(color_of(&described.object)) > libm::cosf(ALIKE);
                is_like.then(|| Described {
                    object,
                    silhouette: silhouette.clone(),
                })
            });
            if let Some(found) = found {
                *described = found;
            }
        }
    }

    /// The objects as they are described now.
    pub fn objects(&self) -> impl Iterator<Item = &DescribedObject> {
        self.described.iter().map(|described| &described.object)
    }

    /// What a picture has besides the table.
    fn look<'p>(&self, picture: &'p Picture) -> Option<(Residual<'p>, Vec<Blob>)> {
        let is_of_camera = picture.width == self.camera.width
            && picture.height == self.camera.height
            && picture.rgb.len() == 3 * picture.depth.len();
        if !is_of_camera {
            return None;
        }
        let ground = Scene {
            solids: vec![DrawnSolid::of_table(&self.table, 1)],
            ..Scene::default()
        };
        let layers = PictureLayers::of(&ground, &self.camera);
        let mut residual = Residual::new(picture, layers, self.camera, ToneTransfer::EXACT);
        let whole = residual.whole();
        residual.keep(&[], &whole);
        let silhouettes = silhouettes(picture, residual.squares());
        Some((residual, silhouettes))
    }
}

impl Described {
    /// True if these pixels, of another picture, are those of the object and more.
    fn shows_more(&self, silhouette: &Blob) -> bool {
        let (own, other) = (&self.silhouette.pixels, &silhouette.pixels);
        let kept = own
            .iter()
            .filter(|pixel| other.binary_search(pixel).is_ok());
        other.len() as f32 > MORE * own.len() as f32
            && kept.count() as f32 >= SAME_PLACE * own.len() as f32
    }
}

/// The ray of an object's colour, from black.
fn color_of(object: &DescribedObject) -> Vec3 {
    let solids = object.shape.drawn();
    let color = solids.first().map_or(Rgb::GRAY, |solid| solid.color);
    Vec3::new(color.red, color.green, color.blue).normalize_or(Vec3::ONE)
}

/// The object with this silhouette, behind these solids.
fn described_by(
    silhouette: &Blob,
    residual: &mut Residual,
    nearer: Vec<DrawnSolid>,
) -> Option<DescribedObject> {
    let width = residual.seen().width as usize;
    let mut search = ShapeSearch {
        residual,
        kept: nearer,
        inner: inner(silhouette, width),
        silhouette,
    };
    search.best()
}

fn solids_of<'d>(objects: impl Iterator<Item = &'d DescribedObject>) -> Vec<DrawnSolid> {
    let solids = (2..).zip(objects).map(|(number, object)| {
        let solids = object.shape.drawn().into_iter();
        solids.map(move |solid| DrawnSolid::of(object.pose, &solid, number))
    });
    solids.flatten().collect()
}

/// The connected pixels of one colour that are not the table.
fn silhouettes(picture: &Picture, squares: &[f32]) -> Vec<Blob> {
    let ray = |pixel: usize| {
        let rgb = &picture.rgb[3 * pixel..3 * pixel + 3];
        Vec3::new(f32::from(rgb[0]), f32::from(rgb[1]), f32::from(rgb[2])).normalize_or(Vec3::ONE)
    };
    let mut open: Vec<usize> = (0..squares.len())
        .filter(|&pixel| squares[pixel] > DIFFERENT)
        .collect();
    let (width, height) = (picture.width as usize, picture.height as usize);
    let mut found = Vec::new();
    while open.len() >= LEAST_PIXELS && found.len() < MOST {
        // The colour that most pixels are about.
        let about = |from: Vec3| move |pixel: &usize| ray(*pixel).dot(from) > libm::cosf(ALIKE);
        let step = open.len().div_ceil(64);
        let candidates = open.iter().step_by(step).map(|&pixel| ray(pixel));
        let count = |from: Vec3| open.iter().filter(|pixel| about(from)(pixel)).count();
        let counted = candidates.map(|from| (count(from), from));
        let Some((_, from)) =
            counted.reduce(|best, next| if next.0 > best.0 { next } else { best })
        else {
            break;
        };
        let mut is_own = vec![false; squares.len()];
        for pixel in open.iter().filter(|pixel| about(from)(pixel)) {
            is_own[*pixel] = true;
        }
        open.retain(|pixel| !is_own[*pixel]);
        let parts = blobs(width, height, |pixel| is_own[pixel]);
        found.extend(
            parts
                .into_iter()
                .filter(|it| it.pixels.len() >= LEAST_PIXELS),
        );
    }
    found
}

/// The kind of an object, with its place on the table and its sizes in units.
#[derive(Clone, Copy, Debug)]
enum Model {
    Block { at: Vec2, yaw: f32, span: Vec3 },
    Cylinder { at: Vec2, radius: f32, height: f32 },
    Sphere { at: Vec2, radius: f32 },
}

impl Model {
    /// The numbers that are sought: each is a length, or an angle that moves the object's edges about as far.
    fn parameters(self) -> usize {
        match self {
            Self::Block { .. } => 6,
            Self::Cylinder { .. } => 4,
            Self::Sphere { .. } => 3,
        }
    }

    fn changed(self, parameter: usize, by: f32) -> Self {
        let mut model = self;
        match &mut model {
            Self::Block { at, yaw, span } => match parameter {
                0 => at.x += by,
                1 => at.y += by,
                2 => *yaw += by / span.truncate().length().max(THINNEST) * 2.0,
                size => span[size - 3] = (span[size - 3] + by).max(THINNEST),
            },
            Self::Cylinder { at, radius, height } => match parameter {
                0 => at.x += by,
                1 => at.y += by,
                2 => *radius = (*radius + by / 2.0).max(THINNEST / 2.0),
                _ => *height = (*height + by).max(THINNEST),
            },
            Self::Sphere { at, radius } => match parameter {
                0 => at.x += by,
                1 => at.y += by,
                _ => *radius = (*radius + by / 2.0).max(THINNEST / 2.0),
            },
        }
        model
    }

    fn object(self, color: Rgb) -> DescribedObject {
        let upright = turn_about(Vec3::X, FRAC_PI_2);
        let (shape, pose) = match self {
            Self::Block { at, yaw, span } => (
                Shape::Block { span, color },
                Pose::new(at.extend(span.z / 2.0), turn_about(Vec3::Z, yaw)),
            ),
            Self::Cylinder { at, radius, height } => (
                Shape::Cylinder {
                    radius,
                    yspan: height,
                    color,
                },
                Pose::new(at.extend(height / 2.0), upright),
            ),
            Self::Sphere { at, radius } => {
                (Shape::Sphere { radius, color }, Pose::at(at.extend(radius)))
            }
        };
        DescribedObject { shape, pose }
    }
}

/// The search for a description of a silhouette.
struct ShapeSearch<'d, 'p> {
    residual: &'d mut Residual<'p>,
    kept: Vec<DrawnSolid>,
    silhouette: &'d Blob,
    /// Its pixels that have no other ones beside them: none of them shows an edge.
    inner: Vec<usize>,
}

/// The pixels of a blob all of whose neighbours belong to it; all if there are none.
fn inner(blob: &Blob, width: usize) -> Vec<usize> {
    let holds = |pixel: usize| blob.pixels.binary_search(&pixel).is_ok();
    let is_inner = |pixel: &usize| {
        let beside = [
            pixel.wrapping_sub(1),
            pixel + 1,
            pixel.wrapping_sub(width),
            pixel + width,
        ];
        beside.into_iter().all(holds)
    };
    let inner: Vec<_> = blob.pixels.iter().copied().filter(is_inner).collect();
    match inner.is_empty() {
        true => blob.pixels.clone(),
        false => inner,
    }
}

impl ShapeSearch<'_, '_> {
    /// The description that explains the silhouette best.
    fn best(&mut self) -> Option<DescribedObject> {
        let window = self.window();
        let kept = std::mem::take(&mut self.kept);
        self.residual.keep(&kept, &window);
        let starts = self.starts().into_iter().map(|model| {
            let color = self.color(model);
            (model, self.fit(model, color).gain)
        });
        let mut tried: Vec<_> = starts.collect();
        tried.sort_by(|one, other| one.1.total_cmp(&other.1));
        let mut best: Option<(Model, Rgb, f32)> = None;
        // Of each kind, since a kind shows only when its sizes are right.
        for kind in [3, 4, 6] {
            let own = tried.iter().filter(|(model, _)| model.parameters() == kind);
            let own: Vec<_> = own.take(REFINED).copied().collect();
            for (model, _) in own {
                let (model, color, fit) = self.refined(model);
                if best.as_ref().is_none_or(|best| fit.gain < best.2) {
                    best = Some((model, color, fit.gain));
                }
            }
        }
        let (model, color, gain) = best?;
        (gain < 0.0).then(|| model.object(color))
    }

    /// The window of the silhouette, and some pixels around it.
    fn window(&self) -> PictureWindow {
        let width = self.residual.seen().width;
        let pixels = self.silhouette.pixels.iter().map(|&pixel| pixel as u32);
        let columns = || pixels.clone().map(|pixel| pixel % width);
        let rows = || pixels.clone().map(|pixel| pixel / width);
        let range =
            |low: Option<u32>, high: Option<u32>| low.unwrap_or(0)..high.map_or(0, |it| it + 1);
        let own = PictureWindow {
            columns: range(columns().min(), columns().max()),
            rows: range(rows().min(), rows().max()),
        };
        own.widened(8, self.residual.size())
    }

    fn starts(&self) -> Vec<Model> {
        let width = self.residual.seen().width as usize;
        let pixels = self.silhouette.pixels.iter();
        let places = pixels.map(|pixel| Vec2::new((pixel % width) as f32, (pixel / width) as f32));
        let middle = places.sum::<Vec2>() / self.silhouette.pixels.len() as f32;
        let on_plane = |pixel: Vec2, height: f32| {
            let (eye, ray) = (self.residual.eye(), self.residual.camera.ray_through(pixel));
            let down = if ray.z < -1e-3 { -ray.z } else { 1e-3 };
            (eye + ray * ((eye.z - height) / down).clamp(0.0, 1e3)).truncate()
        };
        let unit = on_plane(middle, 0.5).distance(on_plane(middle + Vec2::X, 0.5));
        let size = ((self.silhouette.pixels.len() as f32).sqrt() * unit * 0.8).max(THINNEST);
        let at = |height: f32| on_plane(middle, height / 2.0);
        let mut starts = Vec::new();
        for height in [0.4 * size, 0.8 * size, 1.4 * size] {
            for [long, short] in [[1.0, 1.0], [1.7, 0.7]] {
                for eighth in 0..8_u8 {
                    starts.push(Model::Block {
                        at: at(height),
                        yaw: f32::from(eighth) * TAU / 16.0,
                        span: Vec3::new(long * size, short * size, height),
                    });
                }
            }
            starts.push(Model::Cylinder {
                at: at(height),
                radius: size / 2.0,
                height,
            });
        }
        starts.push(Model::Sphere {
            at: at(size),
            radius: size / 2.0,
        });
        starts
    }

    fn solids(model: Model, color: Rgb) -> Vec<DrawnSolid> {
        let DescribedObject { shape, pose } = model.object(color);
        let solids = shape.drawn().into_iter();
        solids
            .map(|solid| DrawnSolid::of(pose, &solid, TRIED))
            .collect()
    }

    fn fit(&mut self, model: Model, color: Rgb) -> TriedFit {
        self.residual
            .try_solids(&Self::solids(model, color), OUTLIER)
    }

    /// The colour with which the object is as bright as its pixels.
    fn color(&mut self, model: Model) -> Rgb {
        let solids = Self::solids(model, Rgb::new(0.5, 0.5, 0.5));
        let window = self.window();
        let seen = self.residual.seen();
        let drawn = self.residual.draw(&solids, &window);
        let (mut both, mut own) = ([0.0_f32; 3], [0.0_f32; 3]);
        let inner = self.inner.iter().copied();
        for pixel in inner.filter(|&pixel| drawn.objects[pixel] == TRIED) {
            for part in 0..3 {
                let drawn = f32::from(drawn.rgb[3 * pixel + part]);
                both[part] += f32::from(seen.rgb[3 * pixel + part]) * drawn;
                own[part] += drawn * drawn;
            }
        }
        let part = |part: usize| (0.5 * both[part] / own[part].max(1.0)).clamp(0.0, 1.0);
        Rgb::new(part(0), part(1), part(2))
    }

    /// The best model near one: by least squares, and then by smaller and smaller steps.
    fn refined(&mut self, mut model: Model) -> (Model, Rgb, TriedFit) {
        let mut color = self.color(model);
        let mut best = self.fit(model, color);
        for step in SQUARES_STEPS {
            for _ in 0..MOST_SQUARES {
                let by = self.equations(model, color, step).step(DAMPING);
                let mut tried = |part: f64| {
                    let mut next = model;
                    for (parameter, by) in by.iter().enumerate().take(model.parameters()) {
                        let by = (by * part) as f32;
                        next = next.changed(parameter, by.clamp(-4.0 * step, 4.0 * step));
                    }
                    let color = self.color(next);
                    (next, color, self.fit(next, color))
                };
                // Outliers weigh little, so steps are rather too short.
                let parts = [6.0, 2.5, 1.0, 0.4, 0.15].map(&mut tried);
                let next = parts.into_iter().filter(|next| next.2.gain < best.gain);
                let next = next.min_by(|one, other| one.2.gain.total_cmp(&other.2.gain));
                let Some(next) = next else {
                    break;
                };
                (model, color, best) = next;
            }
        }
        let mut step = STEPS[0];
        while step > STEPS[1] {
            let mut is_better = false;
            for parameter in 0..model.parameters() {
                for by in [step, -step] {
                    let next = model.changed(parameter, by);
                    let fit = self.fit(next, color);
                    if fit.gain < best.gain {
                        (model, best, is_better) = (next, fit, true);
                        break;
                    }
                }
            }
            if !is_better {
                step *= 0.5;
            }
        }
        (model, color, best)
    }

    /// The normal equations of a model's parameters, with derivatives over a step to both sides.
    fn equations(&mut self, model: Model, color: Rgb, step: f32) -> LeastSquares<PARAMETERS> {
        let window = self.window();
        let width = self.residual.seen().width;
        let mut drawn = |model: Model| -> Vec<u8> {
            let drawn = self.residual.draw(&Self::solids(model, color), &window);
            let parts = rows(&window, width)
                .flat_map(|row| drawn.rgb[3 * row.start..3 * row.end].iter().copied());
            parts.collect()
        };
        let here = drawn(model);
        let mut derivatives = vec![[0.0_f32; PARAMETERS]; here.len()];
        for parameter in 0..model.parameters() {
            let sides = [step, -step].map(|by| drawn(model.changed(parameter, by)));
            let parts = sides[0].iter().zip(&sides[1]);
            for (own, (more, less)) in derivatives.iter_mut().zip(parts) {
                own[parameter] = (f32::from(*more) - f32::from(*less)) / (2.0 * step);
            }
        }
        let seen = self.residual.seen();
        let seen = rows(&window, width)
            .flat_map(|row| seen.rgb[3 * row.start..3 * row.end].chunks_exact(3));
        let mut equations = LeastSquares::default();
        let pixels = here.chunks_exact(3).zip(derivatives.chunks_exact(3));
        for (seen, (here, derivatives)) in seen.zip(pixels) {
            let weight = OUTLIER / (square_of(seen, here) + OUTLIER);
            for (part, derivatives) in derivatives.iter().enumerate() {
                let difference = f32::from(seen[part]) - f32::from(here[part]);
                equations.add(derivatives, difference, weight * weight);
            }
        }
        equations
    }
}
