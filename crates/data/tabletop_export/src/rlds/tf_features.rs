//! `features.json`: the features of an episode and its steps.

use serde_json::{Map, Value, json};
use tabletop_training::{FrameVectors, TrainingEpisode};

const MODULE: &str = "tensorflow_datasets.core.features";

/// The features of an episode.
pub(super) fn features_of(episode: &TrainingEpisode) -> Value {
    let mut observation = Map::new();
    observation.insert("state".into(), vector(&episode.whole_state()));
    for camera in &episode.cameras {
        let size = camera.images.first();
        let size = size.map_or([0, 0], |image| [image.height, image.width]);
        let name = &camera.name;
        observation.insert(format!("{name}_image"), image(size, 3, "uint8"));
        if !camera.depths.is_empty() {
            let depth = tensor(
                &[size[0], size[1], 1],
                "float32",
                "in m, 0 where nothing is",
            );
            observation.insert(format!("{name}_depth"), depth);
        }
        if !camera.ids.is_empty() {
            observation.insert(format!("{name}_ids"), image(size, 1, "uint16"));
        }
    }
    let mut step = Map::new();
    step.insert("observation".into(), dict(observation));
    step.insert("action".into(), vector(&episode.action));
    for name in ["is_first", "is_last", "is_terminal"] {
        step.insert(name.into(), scalar("bool"));
    }
    for name in ["reward", "discount"] {
        step.insert(name.into(), scalar("float32"));
    }
    for name in ["language_instruction", "language_subtask"] {
        step.insert(name.into(), text());
    }
    let steps = json!({
        "pythonClassName": format!("{MODULE}.dataset_feature.Dataset"),
        "sequence": { "feature": dict(step), "length": "-1" },
    });
    let metadata = [
        ("file_path".to_owned(), text()),
        ("fps".to_owned(), scalar("float32")),
    ];
    let episode = [
        ("steps".to_owned(), steps),
        (
            "episode_metadata".to_owned(),
            dict(metadata.into_iter().collect()),
        ),
    ];
    dict(episode.into_iter().collect())
}

fn dict(features: Map<String, Value>) -> Value {
    json!({
        "pythonClassName": format!("{MODULE}.features_dict.FeaturesDict"),
        "featuresDict": { "features": features },
    })
}

fn vector(signal: &FrameVectors) -> Value {
    tensor(
        &[signal.names.len() as u32],
        "float32",
        &signal.names.join(", "),
    )
}

fn tensor(shape: &[u32], dtype: &str, description: &str) -> Value {
    json!({
        "pythonClassName": format!("{MODULE}.tensor_feature.Tensor"),
        "tensor": { "shape": dimensions(shape), "dtype": dtype, "encoding": "none" },
        "description": description,
    })
}

fn scalar(dtype: &str) -> Value {
    json!({
        "pythonClassName": format!("{MODULE}.scalar.Scalar"),
        "tensor": { "shape": {}, "dtype": dtype, "encoding": "none" },
    })
}

fn text() -> Value {
    json!({ "pythonClassName": format!("{MODULE}.text_feature.Text"), "text": {} })
}

fn image([height, width]: [u32; 2], channels: u32, dtype: &str) -> Value {
    json!({
        "pythonClassName": format!("{MODULE}.image_feature.Image"),
        "image": {
            "shape": dimensions(&[height, width, channels]),
            "dtype": dtype,
            "encodingFormat": "png",
        },
    })
}

fn dimensions(shape: &[u32]) -> Value {
    let shape: Vec<_> = shape.iter().map(u32::to_string).collect();
    json!({ "dimensions": shape })
}
