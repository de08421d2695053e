//! Cameras and pictures.

use std::{fs::File, io::BufReader, path::Path};

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods as _, ToPyArray as _};
use pyo3::prelude::*;
use tabletop::{
    camera::{CameraSpec, SeenThing, Shot},
    cli::read_camera,
    core::Picture,
};

use crate::error::refuse;

/// The camera of a text, with pictures of this many columns and rows.
pub fn camera(text: &str, (width, height): (u32, u32)) -> PyResult<CameraSpec> {
    let pixels = u64::from(width) * u64::from(height);
    let side = 1..=Picture::MOST_SIDE;
    if !side.contains(&width) || !side.contains(&height) || pixels > Picture::MOST_PIXELS {
        return Err(refuse(format!(
            "{width} x {height} is no size of a picture, expected sides of 1 to {} and at most {} pixels",
            Picture::MOST_SIDE,
            Picture::MOST_PIXELS
        )));
    }
    Ok(CameraSpec {
        size: Some([width, height]),
        ..read_camera(text).map_err(refuse)?
    })
}

/// The colours of a picture: rows x columns x 3.
pub fn rgb<'py>(py: Python<'py>, picture: &Picture) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let shape = [picture.height as usize, picture.width as usize, 3];
    picture.rgb.to_pyarray(py).reshape(shape)
}

/// The depths of a picture: rows x columns.
pub fn depth<'py>(py: Python<'py>, picture: &Picture) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let shape = [picture.height as usize, picture.width as usize];
    picture.depth.to_pyarray(py).reshape(shape)
}

/// The numbers of things in a picture, rows x columns, and the names of these things, the first of which has number 1.
pub fn things<'py>(
    py: Python<'py>,
    shot: &Shot,
) -> PyResult<(Bound<'py, PyArray2<u32>>, Vec<String>)> {
    let picture = &shot.picture;
    let shape = [picture.height as usize, picture.width as usize];
    let numbers: Bound<'py, PyArray1<u32>> = picture.objects.to_pyarray(py);
    let names = shot.things.iter().map(|thing| match thing {
        SeenThing::Table => "table".to_owned(),
        SeenThing::Object(id) => id.clone(),
        SeenThing::Figure => "robot".to_owned(),
    });
    Ok((numbers.reshape(shape)?, names.collect()))
}

/// The colours of a PNG file of a recording: rows x columns x 3.
pub fn read_png<'py>(py: Python<'py>, file: &Path) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let fault = |what: &dyn std::fmt::Display| refuse(format!("{}: {what}", file.display()));
    let opened = File::open(file).map_err(|error| fault(&error))?;
    let mut decoder = png::Decoder::new(BufReader::new(opened));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info().map_err(|error| fault(&error))?;
    let size = reader
        .output_buffer_size()
        .ok_or_else(|| fault(&"it is too large"))?;
    let mut pixels = vec![0; size];
    let info = reader
        .next_frame(&mut pixels)
        .map_err(|error| fault(&error))?;
    pixels.truncate(info.buffer_size());
    let shape = [info.height as usize, info.width as usize];
    let channels = pixels.len() / (shape[0] * shape[1]).max(1);
    let rgb: Vec<u8> = match channels {
        3 => pixels,
        4 => pixels
            .chunks(4)
            .flat_map(|rgba| rgba[..3].to_vec())
            .collect(),
        _ => return Err(fault(&"it is no picture in colours")),
    };
    rgb.to_pyarray(py).reshape([shape[0], shape[1], 3])
}
