//! Policies of others, from ONNX files.

use std::path::{Path, PathBuf};

use bevy::math::Vec3;
use tabletop_camera::Camera;
use tabletop_core::Picture;
use tabletop_storage::{Symlinks, read_regular_file};
use tract_onnx::prelude::{
    Framework as _, InferenceModelExt as _, IntoRunnable as _, Tensor, TractResult,
    TypedRunnableModel, onnx, tvec,
};

use crate::{
    error::PolicyError,
    label::Yaw,
    picture_policy::PicturePolicy,
    policy::{Decision, ObjectPlace},
};

/// A network of somebody else's that decides by a picture.
///
/// Its input is 1 x 3 x rows x columns numbers: red, green and blue of the head camera's picture, 0 to 1, from the upper left pixel on. Its output is
/// nine numbers: x, y, z, in units of the table's frame, and yaw, in rad, of the object to be taken; the same of where it is to be put; and how likely it is
/// that the task is done, which it is from 0.5 on.
#[derive(Debug)]
pub struct OnnxPolicy {
    path: PathBuf,
    model: std::sync::Arc<TypedRunnableModel>,
    /// Columns and rows of its pictures.
    size: [u32; 2],
}

/// Numbers of the output.
const NUMBERS: usize = 9;
/// Likelihood from which the task is done.
const DONE: f32 = 0.5;
/// The most bytes of a file.
const MOST_BYTES: u64 = 1 << 30;
/// The most columns and rows of a picture.
const MOST_PIXELS: usize = 4096;

impl OnnxPolicy {
    /// Reads an ONNX file.
    ///
    /// # Errors
    /// It cannot be read, or its network has other inputs and outputs.
    pub fn read(path: &Path) -> Result<Self, PolicyError> {
        let bytes = read_regular_file(path, MOST_BYTES, Symlinks::Followed);
        let bytes = bytes.map_err(PolicyError::io(path))?;
        let (model, shape) = runnable(&bytes)
            .map_err(|error| format!("{error:#}"))
            .map_err(PolicyError::damaged(path))?;
        let size = match shape[..] {
            [1, 3, rows, columns] => [columns, rows].map(|side| {
                u32::try_from(side)
                    .ok()
                    .filter(|_| (1..=MOST_PIXELS).contains(&side))
            }),
            _ => [None; 2],
        };
        let [Some(columns), Some(rows)] = size else {
            return Err(PolicyError::damaged(path)(format!(
                "its input has {shape:?} numbers, expected 1 x 3 x rows x columns of at most {MOST_PIXELS}"
            )));
        };
        let policy = Self {
            path: path.to_owned(),
            model,
            size: [columns, rows],
        };
        policy.numbers(tensor_of(
            &[0; 3].repeat((columns * rows) as usize),
            policy.size,
        ))?;
        Ok(policy)
    }

    /// The output for an input.
    fn numbers(&self, input: TractResult<Tensor>) -> Result<[f32; NUMBERS], PolicyError> {
        let outputs = input.and_then(|input| self.model.run(tvec![input.into()]));
        let found = outputs.and_then(|outputs| {
            let mut numbers = Vec::new();
            for output in outputs {
                let output = output.cast_to::<f32>()?;
                numbers.extend(output.to_plain_array_view::<f32>()?.iter().copied());
            }
            Ok(numbers)
        });
        let found = found.map_err(|error| format!("{error:#}"));
        let found = found.map_err(PolicyError::damaged(&self.path))?;
        let numbers = <[f32; NUMBERS]>::try_from(found)
            .map_err(|found| format!("its output has {} numbers, expected {NUMBERS}", found.len()));
        numbers.map_err(PolicyError::damaged(&self.path))
    }
}

impl PicturePolicy for OnnxPolicy {
    fn picture_size(&self) -> Option<[u32; 2]> {
        Some(self.size)
    }

    fn decide(&self, picture: &Picture, _camera: &Camera) -> Result<Decision, PolicyError> {
        let numbers = self.numbers(tensor_of(&picture.rgb, self.size))?;
        if let Some(number) = numbers.iter().position(|number| !number.is_finite()) {
            let fault = format!("number {} of its output is not finite", number + 1);
            return Err(PolicyError::damaged(&self.path)(fault));
        }
        let [pick @ .., _, _, _, _, done] = numbers;
        let [_, _, _, _, place @ .., _] = numbers;
        Ok(match done >= DONE {
            true => Decision::Done,
            false => Decision::Move {
                pick: place_of(pick),
                place: place_of(place),
            },
        })
    }
}

fn place_of([x, y, z, yaw]: [f32; 4]) -> ObjectPlace {
    ObjectPlace {
        location: Vec3::new(x, y, z),
        yaw: Some(Yaw {
            angle: yaw,
            fold: 1,
        }),
    }
}

/// The network of a file, and the shape of its input.
fn runnable(bytes: &[u8]) -> TractResult<(std::sync::Arc<TypedRunnableModel>, Vec<usize>)> {
    let model = onnx().model_for_read(&mut &bytes[..])?.into_optimized()?;
    let shape = model
        .input_fact(0)?
        .shape
        .as_concrete()
        .map(<[usize]>::to_vec);
    Ok((model.into_runnable()?, shape.unwrap_or_default()))
}

fn tensor_of(rgb: &[u8], [columns, rows]: [u32; 2]) -> TractResult<Tensor> {
    let planes = (0..3).flat_map(|color| rgb.iter().skip(color).step_by(3));
    let numbers: Vec<f32> = planes.map(|byte| f32::from(*byte) / 255.0).collect();
    Tensor::from_shape(&[1, 3, rows as usize, columns as usize], &numbers)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tabletop_core::{HeadCamera, Table};
    use tabletop_storage::TemporaryFolder;

    use super::*;

    /// A field of a message of Protocol Buffers whose value is bytes.
    fn field(number: u8, bytes: &[u8]) -> Vec<u8> {
        let mut field = vec![number << 3 | 2];
        let mut length = bytes.len();
        while length >= 0x80 {
            field.push((length & 0x7f) as u8 | 0x80);
            length >>= 7;
        }
        field.push(length as u8);
        field.extend(bytes);
        field
    }

    fn number(number: u8, value: u8) -> Vec<u8> {
        vec![number << 3, value]
    }

    fn node(operator: &str, inputs: &[&str], output: &str) -> Vec<u8> {
        let inputs = inputs.iter().map(|input| field(1, input.as_bytes()));
        let others = [field(2, output.as_bytes()), field(4, operator.as_bytes())];
        field(1, &inputs.chain(others).collect::<Vec<_>>().concat())
    }

    fn weights(name: &str, shape: &[u8], numbers: &[f32]) -> Vec<u8> {
        let shape = shape.iter().map(|side| number(1, *side));
        let raw: Vec<u8> = numbers.iter().flat_map(|it| it.to_le_bytes()).collect();
        let others = [number(2, 1), field(8, name.as_bytes()), field(9, &raw)];
        field(5, &shape.chain(others).collect::<Vec<_>>().concat())
    }

    fn value(of: u8, name: &str, shape: &[u8]) -> Vec<u8> {
        let sides = shape.iter().map(|side| field(1, &number(1, *side)));
        let shape = field(2, &sides.collect::<Vec<_>>().concat());
        let tensor = field(1, &[number(1, 1), shape].concat());
        field(of, &[field(1, name.as_bytes()), field(2, &tensor)].concat())
    }

    /// A network whose answer is `answer`, but takes at an x of ten times the mean of red.
    fn network(shape: &[u8], answer: &[f32]) -> Vec<u8> {
        let outputs = answer.len() as u8;
        let mut by_red = vec![0.0; 3 * answer.len()];
        by_red[0] = 10.0;
        let graph = [
            node("GlobalAveragePool", &["picture"], "means"),
            node("Flatten", &["means"], "flat"),
            node("MatMul", &["flat", "by_red"], "moved"),
            node("Add", &["moved", "answer"], "move"),
            field(2, b"policy"),
            weights("by_red", &[3, outputs], &by_red),
            weights("answer", &[outputs], answer),
            value(11, "picture", shape),
            value(12, "move", &[1, outputs]),
        ];
        let operators = field(8, &number(2, 13));
        [number(1, 8), operators, field(7, &graph.concat())].concat()
    }

    fn policy(shape: &[u8], answer: &[f32]) -> Result<OnnxPolicy, PolicyError> {
        let folder = TemporaryFolder::new("onnx").unwrap();
        let file = folder.path().join("policy.onnx");
        fs::write(&file, network(shape, answer)).unwrap();
        OnnxPolicy::read(&file)
    }

    fn decide(policy: &OnnxPolicy) -> Result<Decision, PolicyError> {
        let mut picture = Picture::default();
        picture.resize(40, 30);
        for pixel in picture.rgb.as_chunks_mut::<3>().0 {
            *pixel = [51, 0, 255];
        }
        let camera = Camera::of_head(&HeadCamera::default(), &Table::default());
        policy.decide(&picture, &camera)
    }

    #[test]
    fn a_network_of_others_decides() {
        let answer = [1.0, 2.0, 0.5, 0.1, -4.0, -5.0, 1.5, 0.7, 0.4];
        let policy = policy(&[1, 3, 30, 40], &answer).unwrap();
        assert_eq!(policy.picture_size(), Some([40, 30]));
        let Decision::Move { pick, place } = decide(&policy).unwrap() else {
            panic!("it is done");
        };
        assert!(
            pick.location.distance(Vec3::new(3.0, 2.0, 0.5)) < 1e-5,
            "{pick:?}"
        );
        assert_eq!(place.location, Vec3::new(-4.0, -5.0, 1.5));
        assert_eq!(
            place.yaw,
            Some(Yaw {
                angle: 0.7,
                fold: 1
            })
        );
        let done = self::policy(
            &[1, 3, 30, 40],
            &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.9],
        );
        assert_eq!(decide(&done.unwrap()).unwrap(), Decision::Done);
    }

    #[test]
    fn a_network_that_is_no_policy_is_refused() {
        let fault = |shape: &[u8], answer: &[f32]| {
            let fault = policy(shape, answer).unwrap_err().to_string();
            fault.split_once(".onnx: ").unwrap().1.to_owned()
        };
        assert_eq!(
            fault(&[1, 3, 30, 40], &[0.0; 8]),
            "its output has 8 numbers, expected 9"
        );
        assert_eq!(
            fault(&[2, 3, 30, 40], &[0.0; 9]),
            "its input has [2, 3, 30, 40] numbers, expected 1 x 3 x rows x columns of at most 4096"
        );
        let policy = policy(&[1, 3, 30, 40], &[f32::NAN; 9]).unwrap();
        let fault = decide(&policy).unwrap_err().to_string();
        assert!(
            fault.ends_with("number 1 of its output is not finite"),
            "{fault}"
        );
    }
}
