//! Beginnings of tasks: where everything is at first, and what is left to be done later.

use tabletop_camera::Camera;
use tabletop_controller::Sight;
use tabletop_core::{CameraCarrier, HeadCamera, Light, ObjectSpec, Random, SceneSpec, Table};
use tabletop_episodes::{
    StillScene,
    imitation::scattered,
    multiplication::{CameraDisplacement, Fingerprint},
};
use tabletop_planner::RobotBody;
use tabletop_program::{
    ConcreteStep, Impossible, NextStep, ProgramRun, SentenceError, TableScene, TaskProgram,
};
use tabletop_scene::{IdAllocator, assemble};

use super::{BENCHMARK_VERSION, Perturbation, tasks::JudgedTask};

/// How often everything is put at random places until the robot can do the task.
pub(super) const DRAWS: usize = 50;

/// The beginning of an episode of a task.
#[derive(Clone, Debug)]
pub struct TaskBeginning {
    /// The task.
    pub task: JudgedTask,
    /// The number of the episode, from 0.
    pub episode: u64,
    /// In what it differs from the task's own.
    pub perturbation: Option<Perturbation>,
    /// Where everything is.
    pub scene: SceneSpec,
    /// The task in the words in which a policy is told it.
    pub words: String,
    /// The light in all pictures.
    pub light: Light,
    /// How far cameras are from their usual places.
    pub displacement: Option<CameraDisplacement>,
    /// The seed that has decided it, and decides the search for paths.
    pub seed: u64,
    /// The same for beginnings that are the same to the bit, and for those that differ in perturbations alone.
    pub fingerprint: String,
    /// The steps of the task.
    pub(super) steps: Vec<ConcreteStep>,
    pub(super) program: TaskProgram,
    pub(super) table: TableScene,
}

/// Why an episode has no beginning.
#[derive(Debug, thiserror::Error)]
pub enum BeginningError {
    /// The task's sentences are none.
    #[error("{0}: {1}")]
    Sentence(&'static str, SentenceError),
    /// The robot reaches too little of the table.
    #[error(
        "{0}, episode {1}: there is no room for everything where the robot reaches it and sees it"
    )]
    NoRoom(&'static str, u64),
    /// The robot reaches or sees too little in spite of the perturbation.
    #[error("{0}, episode {1}: it cannot be perturbed by {2} so that the robot can do it")]
    Unperturbed(&'static str, u64, Perturbation),
}

impl JudgedTask {
    /// The beginning of an episode for a robot whose head camera is so mounted. The task, the number and the robot alone decide it.
    ///
    /// # Errors
    /// There is no room within reach and in view.
    pub fn begin(
        &self,
        episode: u64,
        body: &RobotBody,
        carrier: CameraCarrier,
    ) -> Result<TaskBeginning, BeginningError> {
        let program = self.program();
        let program = program.map_err(|error| BeginningError::Sentence(self.name, error))?;
        let row = self.scene();
        let camera = head_camera(carrier, None, &row.table);
        let name = [BENCHMARK_VERSION, self.name, &episode.to_string()].join(" ");
        let mut random = Random::new(Fingerprint::EMPTY.and(name.as_bytes()).number());
        let mut draws = (0..DRAWS).filter_map(|_| {
            let seed = random.bits();
            let scene = scattered(&row, &[], Some(body), seed)?;
            let table = table_of(&scene);
            let steps = possible_steps(&program, &table, body, camera)?;
            Some(TaskBeginning {
                task: *self,
                episode,
                perturbation: None,
                fingerprint: fingerprint(&table.objects).to_string(),
                scene,
                words: self.words(),
                light: Light::default(),
                displacement: None,
                seed,
                steps,
                program: program.clone(),
                table,
            })
        });
        let first = draws.next();
        first.ok_or(BeginningError::NoRoom(self.name, episode))
    }
}

/// The table of a scene, with the objects on it.
pub(super) fn table_of(scene: &SceneSpec) -> TableScene {
    let assembly = assemble(scene, &mut IdAllocator::default());
    TableScene {
        table: scene.table,
        objects: assembly.objects,
        joints: assembly.joints,
    }
}

/// The head camera before a table.
pub(super) fn head_camera(
    carrier: CameraCarrier,
    displacement: Option<CameraDisplacement>,
    table: &Table,
) -> Camera {
    let head = HeadCamera {
        carrier,
        ..HeadCamera::default()
    };
    let mount = displacement.map(|displacement| displacement.of(head.pose(table)));
    Camera::of_head(&HeadCamera { mount, ..head }, table)
}

/// The steps of a program, if there are any, the robot reaches where they take and put things, and its head sees that.
pub(super) fn possible_steps(
    program: &TaskProgram,
    table: &TableScene,
    body: &RobotBody,
    camera: Camera,
) -> Option<Vec<ConcreteStep>> {
    let (steps, _, failure) = ProgramRun::rehearsed(program, table);
    if steps.is_empty() || failure.is_some() {
        return None;
    }
    let mut now = table.clone();
    for step in &steps {
        let (task, binding) = step.task(&now);
        let still = StillScene::new(camera, &now.table, now.objects.clone());
        let goals = task.steps.iter();
        let goals = goals.filter_map(|step| still.goal(step, &binding));
        let places = still.pose(&step.object).into_iter().chain(goals);
        let places: Vec<_> = places.map(|pose| pose.location).collect();
        if !still.keeps_in_view(&task, &binding) || !body.reaches(&places, 0.0) {
            return None;
        }
        now = now.after(step);
    }
    Some(steps)
}

/// A step in words without its place on the table, which is another one in each episode.
fn without_place(sentence: &str) -> String {
    match sentence.split_once(" at (") {
        Some((step, _)) => format!("{step}."),
        None => sentence.to_owned(),
    }
}

/// The fingerprint of the objects on a table: their names and poses, to the bit.
fn fingerprint(objects: &[ObjectSpec]) -> Fingerprint {
    objects.iter().fold(Fingerprint::EMPTY, |so_far, object| {
        let numbers = object.pose.location.to_array().into_iter();
        let numbers = numbers.chain(object.pose.rotation.to_array());
        let so_far = so_far.and(object.id.as_bytes());
        numbers.fold(so_far, |so_far, number| so_far.and(&number.to_le_bytes()))
    })
}

impl TaskBeginning {
    /// Number of steps of the task.
    pub const fn step_count(&self) -> usize {
        self.steps.len()
    }

    /// The objects on the table.
    pub fn objects(&self) -> &[ObjectSpec] {
        &self.table.objects
    }

    /// True if the task is done on the table as it is seen, and nothing is held.
    pub fn is_done(&self, now: &Sight) -> bool {
        let holds = now.limbs.iter().any(|limb| !limb.holds.is_empty());
        !holds
            && self.gone(now).is_none()
            && self.begun().next_on(&self.table(now)) == NextStep::Done
    }

    /// What is left to be done on the table as it is seen, step by step, in words.
    pub fn left(&self, now: &Sight) -> Vec<String> {
        if let Some(gone) = self.gone(now) {
            return vec![format!("{gone} is no longer on the table.")];
        }
        let mut table = self.table(now);
        let mut run = self.begun();
        let mut left = Vec::new();
        loop {
            match run.next_on(&table) {
                NextStep::Done => return left,
                NextStep::Impossible(Impossible { sentence, .. }) => {
                    left.push(sentence);
                    return left;
                }
                NextStep::Step(step) => {
                    left.push(without_place(&step.sentence(&self.table)));
                    table = table.after(&step);
                }
            }
        }
    }

    fn begun(&self) -> ProgramRun {
        ProgramRun::begin(&self.program, &self.table)
    }

    /// An object of the beginning that is no longer there.
    fn gone(&self, now: &Sight) -> Option<&str> {
        let mut objects = self.table.objects.iter();
        let gone = objects.find(|object| !now.objects.contains_key(&object.id));
        gone.map(|object| object.id.as_str())
    }

    /// The objects where they are seen.
    fn table(&self, now: &Sight) -> TableScene {
        let mut table = self.table.clone();
        for object in &mut table.objects {
            if let Some(seen) = now.objects.get(&object.id) {
                object.pose = seen.pose;
            }
        }
        table
    }
}
