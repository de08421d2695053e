//! Policies that somebody serves.

use std::{
    io,
    path::Path,
    sync::{Mutex, MutexGuard, PoisonError},
};

use tabletop_camera::Camera;
use tabletop_controller::Sight;
use tabletop_core::{Picture, RobotLayout};
use tabletop_wire::{
    ActionChunk, ExchangeFile, FormatError, MappedActions, MappedImage, MappingError, NumpyArray,
    PolicyAddress, PolicyClient, PolicyMapping, RecordedExchanges, WireError, WireMap, WireValue,
};
use thiserror::Error;

use crate::{
    error::PolicyError,
    known_table::{KnownTable, ToldTask},
    picture_policy::PicturePolicy,
    place_numbers::{OF_CAMERA, camera_numbers, decision_of},
    policy::Decision,
    robot_view::names_of,
};

/// The greatest number of a decision: units, rad, or turns.
const FARTHEST: f64 = 1000.0;

/// Why a served policy cannot act.
#[derive(Debug, Error)]
pub enum RemoteError {
    /// There is none, or it does not answer.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// The mapping does not fit the server.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The server does not say what it wants to see.
    #[error(
        "{0} does not say what it wants to see; name a mapping with --mapping: {names}, or a file (docs/policies.md)",
        names = PolicyMapping::shipped_names().collect::<Vec<_>>().join(", ")
    )]
    Unmapped(String),
}

/// A policy that somebody serves by openpi's protocol. Whoever asks it while another one waits for its answer gets a connection of his own. After an error it is
/// connected to anew.
#[derive(Debug)]
pub struct RemotePolicy {
    source: AnswerSource,
    mapping: PolicyMapping,
    metadata: WireMap,
    /// The file that exchanges are written into.
    noted: Option<Mutex<ExchangeFile>>,
    /// The last reason why there was no answer.
    lost: Mutex<Option<String>>,
}

/// Where answers come from.
#[derive(Debug)]
enum AnswerSource {
    Server {
        address: PolicyAddress,
        /// Connections that nobody uses.
        idle: Mutex<Vec<PolicyClient>>,
    },
    Recording(RecordedExchanges),
}

impl RemotePolicy {
    /// Connects to the server, with a mapping or, if the server says that this is what it wants, that of our own policies.
    ///
    /// # Errors
    /// There is none, or the mapping does not fit it.
    pub fn connect(
        address: PolicyAddress,
        mapping: Option<PolicyMapping>,
    ) -> Result<Self, RemoteError> {
        let client = PolicyClient::connect(&address)?;
        let metadata = client.metadata().clone();
        let name = address.to_string();
        let idle = Mutex::new(vec![client]);
        let server = AnswerSource::Server { address, idle };
        Self::of(server, metadata, mapping, name)
    }

    /// The policy whose exchanges were recorded in a file, with a mapping or, if its server said that this is what it wants, that of our own policies.
    ///
    /// # Errors
    /// There is no such file, or the mapping does not fit it.
    pub fn recorded(file: &Path, mapping: Option<PolicyMapping>) -> Result<Self, RemoteError> {
        let recorded = RecordedExchanges::read(file)?;
        let metadata = recorded.metadata().clone();
        let name = file.display().to_string();
        Self::of(AnswerSource::Recording(recorded), metadata, mapping, name)
    }

    fn of(
        source: AnswerSource,
        metadata: WireMap,
        mapping: Option<PolicyMapping>,
        name: String,
    ) -> Result<Self, RemoteError> {
        let wanted = metadata.get("observation").and_then(WireValue::map);
        let mapping = match (mapping, wanted) {
            (Some(mapping), _) => mapping,
            (None, Some(wanted)) => own_mapping(wanted)?,
            (None, None) => return Err(RemoteError::Unmapped(name)),
        };
        mapping.check_with(&metadata)?;
        Ok(Self {
            source,
            mapping,
            metadata,
            noted: None,
            lost: Mutex::default(),
        })
    }

    /// Writes all exchanges into a new file.
    ///
    /// # Errors
    /// Something is there, or it cannot be written.
    pub fn note_in(&mut self, file: &Path) -> Result<(), RemoteError> {
        let file = ExchangeFile::create(file, &self.metadata)?;
        self.noted = Some(Mutex::new(file));
        Ok(())
    }

    /// What the server says of itself.
    pub const fn metadata(&self) -> &WireMap {
        &self.metadata
    }

    /// Why the policy last did not answer, if it ever did not: the network or its server are at fault, not what it decided.
    pub fn lost(&self) -> Option<String> {
        unpoisoned(&self.lost).clone()
    }

    /// What it sees, and what its actions do.
    pub const fn mapping(&self) -> &PolicyMapping {
        &self.mapping
    }

    /// Compares its mapping with the robot that it is to act for.
    ///
    /// # Errors
    /// The first thing in the mapping that this robot does not have, and the nearest name that it has.
    pub fn check_for(&self, layout: &RobotLayout) -> Result<(), MappingError> {
        self.mapping.check_for(&names_of(layout))
    }

    /// The actions after an observation: as many as the mapping lets be carried out.
    ///
    /// # Errors
    /// It does not answer, or with nonsense.
    pub fn actions(&self, observation: &WireMap) -> Result<ActionChunk, WireError> {
        let answer = self.ask(observation).inspect_err(|error| {
            if is_lost(error) {
                *unpoisoned(&self.lost) = Some(error.to_string());
            }
        })?;
        let columns = self.mapping.actions.columns();
        let horizon = match self.mapping.actions {
            MappedActions::Columns { horizon, .. } => horizon,
            MappedActions::Places => 1,
        };
        let chunk = ActionChunk::of(&answer, columns, horizon);
        chunk.map_err(|fault| {
            if let AnswerSource::Server { idle, .. } = &self.source {
                unpoisoned(idle).clear();
            }
            self.nonsense(fault)
        })
    }

    /// The answer to an observation. A connection that fails is not used again.
    fn ask(&self, observation: &WireMap) -> Result<WireMap, WireError> {
        let answer = match &self.source {
            AnswerSource::Recording(recorded) => recorded.answer(observation)?,
            AnswerSource::Server { address, idle } => {
                let known = unpoisoned(idle).pop();
                let mut client = match known {
                    Some(client) => client,
                    None => PolicyClient::connect(address)?,
                };
                let answer = client.ask(observation)?;
                unpoisoned(idle).push(client);
                answer
            }
        };
        if let Some(file) = &self.noted {
            unpoisoned(file).note(observation, &answer)?;
        }
        Ok(answer)
    }

    fn nonsense(&self, fault: FormatError) -> WireError {
        match &self.source {
            AnswerSource::Server { address, .. } => WireError::Nonsense {
                address: address.clone(),
                fault,
            },
            AnswerSource::Recording(recorded) => WireError::File {
                path: recorded.path().to_owned(),
                source: io::Error::new(io::ErrorKind::InvalidData, fault),
            },
        }
    }
}

/// True if there was no answer, rather than one that makes no sense.
const fn is_lost(error: &WireError) -> bool {
    match error {
        WireError::Unreachable { .. }
        | WireError::Foreign { .. }
        | WireError::Silent { .. }
        | WireError::Closed { .. }
        | WireError::Refused { .. }
        | WireError::Unrecorded { .. }
        | WireError::File { .. } => true,
        WireError::Nonsense { .. } => false,
    }
}

/// What a mutex guards, whatever became of those who had it before.
fn unpoisoned<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The mapping of our own policies, with a picture of the size that the server wants.
fn own_mapping(wanted: &WireMap) -> Result<PolicyMapping, MappingError> {
    let oracle = PolicyMapping::named("oracle".as_ref())?;
    if oracle.keys().all(|key| wanted.contains_key(key)) {
        return Ok(oracle);
    }
    let mut mapping = PolicyMapping::named("tabletop".as_ref())?;
    for image in &mut mapping.images {
        let shape = wanted.get(&image.key).and_then(WireValue::map);
        let shape = shape.and_then(|array| array.get("shape"));
        if let Some(WireValue::List(sides)) = shape
            && let [WireValue::Integer(rows), WireValue::Integer(columns), _] = sides[..]
        {
            let sides = u32::try_from(columns).ok().zip(u32::try_from(rows).ok());
            image.size = sides.filter(|(columns, rows)| {
                let sides = 1..=MappedImage::LONGEST_SIDE;
                sides.contains(columns) && sides.contains(rows)
            });
        }
    }
    Ok(mapping)
}

impl PicturePolicy for RemotePolicy {
    fn picture_size(&self) -> Option<[u32; 2]> {
        let image = self.mapping.images.first()?;
        let size = image.size?;
        Some(image.fit(size.into()).inner)
    }

    fn decide(&self, picture: &Picture, camera: &Camera) -> Result<Decision, PolicyError> {
        self.decision(&self.observation(picture, camera))
    }

    fn decide_told(
        &self,
        picture: &Picture,
        camera: &Camera,
        told: &ToldTask,
        sight: &Sight,
    ) -> Result<Decision, PolicyError> {
        let mut observation = self.observation(picture, camera);
        if let Some(key) = &self.mapping.prompt {
            observation.insert(key.clone(), told.words.into());
        }
        if let Some(key) = &self.mapping.objects {
            let table = KnownTable::new(told, sight).text();
            observation.insert(key.clone(), table.as_str().into());
        }
        self.decision(&observation)
    }
}

impl RemotePolicy {
    fn observation(&self, picture: &Picture, camera: &Camera) -> WireMap {
        let mut observation = WireMap::new();
        for image in &self.mapping.images {
            let fit = image.fit([picture.width, picture.height]);
            let array = fit.array(&picture.rgb, image.mirrored, image.layout);
            observation.insert(image.key.clone(), array.into());
            if let Some(key) = &image.numbers {
                let numbers = NumpyArray::of_floats(&[OF_CAMERA], &camera_numbers(camera));
                observation.insert(key.clone(), numbers.into());
            }
        }
        observation
    }

    fn decision(&self, observation: &WireMap) -> Result<Decision, PolicyError> {
        let chunk = self.actions(observation)?;
        let numbers = chunk.rows().first().map_or(&[][..], Vec::as_slice);
        match numbers.iter().find(|number| number.abs() > FARTHEST) {
            None => Ok(decision_of(numbers)),
            Some(number) => {
                let fault = format!("{number} is no place on a table, nor a yaw");
                Err(self.nonsense(FormatError::at("actions", fault)).into())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use bevy::math::Vec3;
    use tabletop_core::{HeadCamera, Table};
    use tabletop_wire::PolicyServer;

    use super::*;
    use crate::{label::Yaw, policy::ObjectPlace, served_policy::ServedPolicy};

    /// Takes what is as far to the right as the picture is red, and puts it where the camera is.
    struct Reddest;

    impl PicturePolicy for Reddest {
        fn picture_size(&self) -> Option<[u32; 2]> {
            Some([8, 6])
        }

        fn decide(&self, picture: &Picture, camera: &Camera) -> Result<Decision, PolicyError> {
            let red = picture.rgb.iter().step_by(3).map(|red| f32::from(*red));
            let right = red.sum::<f32>() / 7.0;
            let place = |location, angle, fold| ObjectPlace {
                location,
                yaw: Some(Yaw { angle, fold }),
            };
            Ok(match right > 1000.0 {
                true => Decision::Done,
                false => Decision::Move {
                    pick: place(Vec3::X * right, 0.1, 4),
                    place: place(camera.pose.location, camera.vertical_fov, 1),
                },
            })
        }
    }

    #[test]
    fn a_served_policy_decides_to_the_bit_as_at_home() {
        let server = PolicyServer::bind("127.0.0.1", 0).unwrap();
        let address = format!("ws://{}", server.address().unwrap());
        thread::spawn(move || server.serve(&ServedPolicy(Box::new(Reddest))));
        let remote = RemotePolicy::connect(address.parse().unwrap(), None).unwrap();
        assert_eq!(remote.picture_size(), Some([8, 6]));
        let head = HeadCamera {
            width: 8,
            height: 6,
            ..HeadCamera::default()
        };
        let camera = Camera::of_head(&head, &Table::default());
        let mut picture = Picture::default();
        picture.resize(8, 6);
        for red in [0, 3, 100, 255] {
            picture.rgb.fill(red);
            let decided = remote.decide(&picture, &camera).unwrap();
            assert_eq!(decided, Reddest.decide(&picture, &camera).unwrap());
        }
        assert_eq!(remote.lost(), None);
        // After a refusal, it is connected to anew.
        let refusal = remote.actions(&WireMap::new()).unwrap_err().to_string();
        assert!(refusal.contains("\"image\" is missing"), "{refusal}");
        assert_eq!(remote.lost(), Some(refusal));
        remote.decide(&picture, &camera).unwrap();
        // Whoever asks at the same time does not wait for the other one.
        thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| remote.decide(&picture, &camera).unwrap());
            }
        });
    }
}
