//! Eyes: pictures in, poses of known objects out, one picture after the other.

use bevy::math::Vec3;
use tabletop_camera::{Camera, DrawnFigure, DrawnSolid, PictureLayers, Scene};
use tabletop_core::{Light, Picture, Table};
use tabletop_geometry::Pose;

use crate::{
    adaptation::{Adaptation, adapted},
    arrangement::ObjectArrangement,
    clutter::{Clutter, clutter},
    identity::keep_identities,
    known::KnownObject,
    refine::{Refinement, deviations},
    residual::{OUTLIER, Residual},
    symmetry::YawSymmetry,
    transfer::ToneTransfer,
};

/// Eyes that know some objects, and remember where they were in the last picture.
#[derive(Clone, Debug)]
pub struct Eyes {
    objects: Vec<KnownObject>,
    camera: Camera,
    table: Table,
    poses: Vec<Option<Pose>>,
    transfer: ToneTransfer,
    /// True if light and transfer are not known.
    is_adapting: bool,
    /// Number of pictures to which they may still adapt in vain.
    adaptations: usize,
    /// The loss of a pixel, on average, that this adaptation leaves.
    rest: f32,
    /// Number of pixels that nothing explained in the last picture, if objects were explained badly.
    given_up: Option<usize>,
    /// The memory of the last picture's layers.
    layers: Option<PictureLayers>,
}

/// What is in a picture besides the table and the objects, and known: it is drawn, and not estimated.
#[derive(Clone, Debug, Default)]
pub struct KnownScenery {
    /// Surfaces, such as those of a robot's links at its joints.
    pub figures: Vec<DrawnFigure>,
    /// Solids.
    pub solids: Vec<DrawnSolid>,
}

/// What eyes make of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Percept {
    /// The objects, in the order in which the eyes know them.
    pub objects: Vec<ObjectPercept>,
    /// What is in the picture and is not known, largest first.
    pub clutter: Vec<Clutter>,
    /// The light: that of the camera, unless it is not known.
    pub light: Light,
    /// The transfer from what is drawn to what is seen: exact, unless it is not known.
    pub transfer: ToneTransfer,
    /// Standard deviation of the noise in a part of a pixel, in grey levels.
    pub noise: f32,
}

/// An object in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectPercept {
    /// Its pose in the table's frame, in units; that of the last picture if it is hidden, and `None` if it was never seen.
    pub pose: Option<Pose>,
    /// The uncertainty of its pose.
    pub deviation: PoseDeviation,
    /// How much of it is seen.
    pub visibility: Visibility,
    /// False if another pose would explain the picture as well, none explains it well, or a good part of it is beside the picture.
    pub is_sure: bool,
    /// True if the picture is as it would be with the object at this pose, even if it shows nothing of it.
    pub is_explained: bool,
}

/// The standard deviations of a pose, from the curvature of the residual.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseDeviation {
    /// Of the location, in units. That of Z is 0 for an object that stands on something.
    pub location: Vec3,
    /// Of the yaw, in rad; 0 if every yaw looks the same.
    pub yaw: f32,
}

/// How much of an object is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// All, or nearly.
    Seen,
    /// A part.
    PartlyHidden,
    /// Nothing, or nearly.
    Hidden,
}

/// The part of an object's pixels that are visible at least if it counts as seen, and if it does not count as hidden.
const SEEN: f32 = 0.95;
const HIDDEN: f32 = 0.03;
/// The least part that is visible of an object whose pose is sure.
const SURE_VISIBLE: f32 = 0.12;
/// Step of the derivatives for uncertainties, in units: half a pixel.
const STEP: f32 = 0.05;
/// Number of times that light and transfer are estimated with the objects in their places for one picture, and number of pictures that may still not be explained well.
const ADAPTATIONS: usize = 3;
const VAIN_ADAPTATIONS: usize = 4;
/// The largest loss of a pixel, on average, that an adaptation may leave.
const MOST_REST: f32 = 250.0;
/// Variance of a part of a pixel that is there without noise: colours are whole numbers, and edges are smoothed by four samples.
const ROUNDING: f32 = 1.0;

impl Eyes {
    /// Eyes for these objects on this table.
    pub fn new(objects: Vec<KnownObject>, camera: Camera, table: Table) -> Self {
        Self {
            poses: vec![None; objects.len()],
            objects,
            camera,
            table,
            transfer: ToneTransfer::EXACT,
            is_adapting: false,
            adaptations: VAIN_ADAPTATIONS,
            rest: 0.0,
            given_up: None,
            layers: None,
        }
    }

    /// The same eyes, which do not know the light, nor how exactly pictures show what is there, and adapt to the pictures.
    #[must_use]
    pub const fn adapting(mut self) -> Self {
        self.is_adapting = true;
        self
    }

    /// Adapts to the light and the transfer to which others have adapted.
    pub const fn adapt_like(&mut self, other: &Self) {
        self.adapt(&other.adaptation());
        self.rest = other.rest;
    }

    /// Forgets where objects were.
    pub fn forget(&mut self) {
        self.poses.fill(None);
    }

    /// Lets objects be where they are known to have been just before the next picture. What is fixed is still there.
    pub fn remember(&mut self, poses: impl IntoIterator<Item = Option<Pose>>) {
        for (own, pose) in self.poses.iter_mut().zip(poses) {
            *own = pose;
        }
    }

    /// Where the objects were last seen.
    pub fn remembered(&self) -> impl Iterator<Item = Option<Pose>> {
        self.poses.iter().copied()
    }

    /// Exchanges what was last seen of objects that look the same, so that each is as near as possible to one of these places.
    pub fn name_by_place(&mut self, places: &[Option<Pose>], percept: &mut Percept) {
        keep_identities(&self.objects, places, &mut percept.objects, |seen| {
            seen.pose
        });
        for (own, seen) in self.poses.iter_mut().zip(&percept.objects) {
            *own = seen.pose;
        }
    }

    /// Looks at the next picture. A picture whose size is not the camera's shows nothing.
    pub fn look(&mut self, picture: &Picture, scenery: &KnownScenery) -> Percept {
        let is_of_camera = picture.width == self.camera.width
            && picture.height == self.camera.height
            && picture.rgb.len() == 3 * picture.depth.len()
            && picture.depth.len() == picture.width as usize * picture.height as usize;
        if !is_of_camera {
            return self.blind();
        }
        let ground = self.ground(scenery);
        let known = self.objects.iter().zip(&self.poses);
        let before: Vec<_> = known
            .map(|(object, pose)| pose.map(|pose| object.placement(pose)))
            .collect();
        let is_first = before.iter().all(Option::is_none);
        if is_first {
            self.adapt_to_ground(picture, &ground);
        }
        let mut found: Option<Vec<_>> = None;
        for round in 0.. {
            let compared = self.transfer.compared(picture);
            let layers = self.begun(&ground);
            let residual = Residual::new(&compared, layers, self.camera, self.transfer);
            let mut arrangement = ObjectArrangement::empty(&self.objects, residual);
            arrangement.rest = self.rest;
            arrangement.given_up = self.given_up;
            match &found {
                Some(found) => arrangement.begin_again(found),
                None => arrangement.begin(&before),
            }
            let misfit = arrangement.usual_misfit();
            let is_misrendered = self.is_adapting && misfit > arrangement.good();
            if is_misrendered && round < ADAPTATIONS && self.adaptations > 0 {
                let mut scene = ground.clone();
                scene.solids.extend(arrangement.solids());
                let adaptation = adapted(picture, &scene, &self.camera);
                if adaptation.differs_from(&self.adaptation()) {
                    found = is_first.then(|| arrangement.placements.clone());
                    self.layers = Some(arrangement.residual.into_layers());
                    self.adapt(&adaptation);
                    continue;
                }
            }
            let is_explained = arrangement.reconsider();
            self.given_up = (!is_explained).then(|| arrangement.unexplained_pixels());
            let percept = self.percept(&mut arrangement);
            for (i, seen) in percept.objects.iter().enumerate() {
                // What is fixed stays where it was surely seen, as long as that explains the picture.
                let is_kept = !self.objects[i].is_fixed()
                    || seen.is_sure
                    || before[i].is_some() && !arrangement.is_bad(i);
                self.poses[i] = seen.pose.filter(|_| is_kept);
            }
            self.layers = Some(arrangement.residual.into_layers());
            if is_misrendered {
                self.rest = misfit.min(MOST_REST);
                self.adaptations = self.adaptations.saturating_sub(1);
            }
            return percept;
        }
        self.blind()
    }

    /// What is in the picture besides the objects.
    fn ground(&self, scenery: &KnownScenery) -> Scene {
        let mut solids = vec![DrawnSolid::of_table(&self.table, 1)];
        solids.extend(scenery.solids.iter().cloned());
        Scene {
            solids,
            figures: scenery.figures.clone(),
            markers: Vec::new(),
        }
    }

    /// The layers of a picture, begun with its ground.
    fn begun(&mut self, ground: &Scene) -> PictureLayers {
        match self.layers.take() {
            Some(mut layers) => {
                layers.begin(ground, &self.camera);
                layers
            }
            None => PictureLayers::of(ground, &self.camera),
        }
    }

    const fn adaptation(&self) -> Adaptation {
        Adaptation {
            light: self.camera.light,
            transfer: self.transfer,
        }
    }

    const fn adapt(&mut self, adaptation: &Adaptation) {
        self.camera.light = adaptation.light;
        self.transfer = adaptation.transfer;
    }

    /// Adapts to the light of the ground, if it does not look as expected.
    fn adapt_to_ground(&mut self, picture: &Picture, ground: &Scene) {
        if !self.is_adapting {
            return;
        }
        let layers = self.begun(ground);
        let residual = Residual::new(picture, layers, self.camera, self.transfer);
        let arrangement = ObjectArrangement::empty(&[], residual);
        let is_explained = arrangement.is_mostly_explained();
        self.layers = Some(arrangement.residual.into_layers());
        if !is_explained {
            let Adaptation { light, transfer } = adapted(picture, ground, &self.camera);
            // How far edges are spread is not told by the table alone: objects hide a part of it.
            let transfer = ToneTransfer {
                blur: 0.0,
                color_blur: 0.0,
                ..transfer
            };
            self.adapt(&Adaptation { light, transfer });
        }
    }

    /// What is seen in a picture, arranged like this.
    fn percept(&self, arrangement: &mut ObjectArrangement<'_, '_>) -> Percept {
        let percepts = (0..self.objects.len()).map(|i| {
            let seen = percept(arrangement, i);
            let pose = seen.pose.or(self.poses[i]);
            ObjectPercept { pose, ..seen }
        });
        let mut objects: Vec<_> = percepts.collect();
        share_doubt(arrangement, &mut objects);
        if !arrangement.is_outline_explained() {
            for object in &mut objects {
                object.is_sure = false;
                object.is_explained = false;
            }
        }
        keep_identities(&self.objects, &self.poses, &mut objects, |seen| seen.pose);
        let least = arrangement.unexplained();
        let clutter = clutter(arrangement.residual.size(), |i| {
            arrangement.square(i) > least
        });
        Percept {
            objects,
            clutter,
            light: self.camera.light,
            transfer: self.transfer,
            noise: arrangement.noise.sqrt(),
        }
    }

    fn blind(&self) -> Percept {
        let hidden = |pose: &Option<Pose>| ObjectPercept {
            pose: *pose,
            ..ObjectPercept::HIDDEN
        };
        Percept {
            objects: self.poses.iter().map(hidden).collect(),
            clutter: Vec::new(),
            light: self.camera.light,
            transfer: self.transfer,
            noise: 0.0,
        }
    }
}

impl ObjectPercept {
    const HIDDEN: Self = Self {
        pose: None,
        deviation: PoseDeviation {
            location: Vec3::INFINITY,
            yaw: f32::INFINITY,
        },
        visibility: Visibility::Hidden,
        is_sure: false,
        is_explained: false,
    };
}

/// Doubts each object that may have been taken for one of its colour that is doubted itself.
fn share_doubt(arrangement: &mut ObjectArrangement<'_, '_>, objects: &mut [ObjectPercept]) {
    let mut doubted: Vec<_> = (0..objects.len())
        .filter(|&i| !objects[i].is_sure)
        .collect();
    while let Some(doubt) = doubted.pop() {
        let is_bad = arrangement.is_bad(doubt);
        for (i, object) in objects.iter_mut().enumerate() {
            let may_be_confused =
                arrangement.share_color(doubt, i) && (is_bad || arrangement.overlap(doubt, i));
            if object.is_sure && may_be_confused {
                object.is_sure = false;
                doubted.push(i);
            }
        }
    }
}

fn percept(arrangement: &mut ObjectArrangement, object: usize) -> ObjectPercept {
    let Some((placement, window)) =
        arrangement.placements[object].zip(arrangement.window(object).cloned())
    else {
        return ObjectPercept::HIDDEN;
    };
    let known = &arrangement.objects[object];
    let is_bad = arrangement.is_bad(object);
    // Alone, to count its pixels.
    arrangement.residual.keep(&[], &window);
    let mut refinement = Refinement {
        residual: &mut arrangement.residual,
        object: known,
        is_free: false,
    };
    let alone = refinement.try_at(&placement, OUTLIER).pixels;
    let fit = arrangement.fit(object);
    let visible = fit.pixels as f32 / alone.max(1) as f32;
    let mut refinement = Refinement {
        residual: &mut arrangement.residual,
        object: known,
        is_free: false,
    };
    let equations = refinement.equations(&placement, STEP, true, OUTLIER);
    // What is explained badly is known badly.
    let unexplained = fit.misfit / (3 * fit.pixels.max(1)) as f32;
    let variance = arrangement.noise.max(ROUNDING).max(unexplained);
    let ray = arrangement.ray_to(placement.location);
    let is_cut_off = known.is_cut_off(known.pose(&placement), &arrangement.residual.camera);
    let stance = known.stance(&placement);
    let [x, y, z, yaw] = deviations(&equations, variance, ray, stance.radius);
    ObjectPercept {
        pose: Some(known.pose(&placement)),
        deviation: PoseDeviation {
            location: Vec3::new(x, y, z),
            yaw: match stance.symmetry {
                YawSymmetry::Any => 0.0,
                YawSymmetry::Turns(_) => yaw,
            },
        },
        visibility: match visible {
            visible if visible >= SEEN => Visibility::Seen,
            visible if visible > HIDDEN => Visibility::PartlyHidden,
            _ => Visibility::Hidden,
        },
        is_sure: !is_bad && visible > SURE_VISIBLE && !is_cut_off,
        is_explained: !is_bad,
    }
}
