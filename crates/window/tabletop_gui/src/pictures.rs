//! Pictures of recordings, read from their files as they are needed.

use std::{
    collections::{BTreeMap, VecDeque},
    path::{Path, PathBuf},
};

use bevy_egui::egui::{ColorImage, Context, TextureHandle, TextureOptions};
use tabletop_core::{Picture, TimelinePicture};
use tabletop_storage::{Symlinks, read_regular_file};

/// So many pictures are kept.
const MOST: usize = 64;

/// So many of their pixels are kept, of 4 bytes each; more only if it is one picture.
const MOST_PIXELS: usize = 1 << 26;

/// Number of pictures that are read in a frame, so that it does not take long.
const MOST_A_FRAME: usize = 4;

/// The pictures of a folder that were needed last.
#[derive(Default)]
pub(crate) struct Pictures {
    folder: PathBuf,
    textures: BTreeMap<(PathBuf, usize), Option<TextureHandle>>,
    /// In the order in which they were read.
    order: VecDeque<(PathBuf, usize)>,
    read_now: usize,
}

impl Pictures {
    /// To be called before pictures are asked for.
    pub fn begin_frame(&mut self, folder: &Path) {
        self.read_now = 0;
        if self.folder != folder {
            folder.clone_into(&mut self.folder);
            self.textures.clear();
            self.order.clear();
        }
    }

    /// A picture, if its file can be read. A later frame has it, if this one has read enough.
    pub fn texture(
        &mut self,
        context: &Context,
        picture: &TimelinePicture,
    ) -> Option<&TextureHandle> {
        let key = (picture.path.clone(), picture.serial);
        if !self.textures.contains_key(&key) {
            if self.read_now == MOST_A_FRAME {
                context.request_repaint();
                return None;
            }
            self.read_now += 1;
            let name = picture.path.display().to_string();
            let texture = read(&picture.path)
                .map(|image| context.load_texture(name, image, TextureOptions::LINEAR));
            self.textures.insert(key.clone(), texture);
            self.order.push_back(key.clone());
            self.forget_the_oldest();
        }
        self.textures.get(&key)?.as_ref()
    }

    fn forget_the_oldest(&mut self) {
        let pixels = |texture: &TextureHandle| texture.size().into_iter().product::<usize>();
        let mut kept: usize = self.textures.values().flatten().map(pixels).sum();
        while self.order.len() > MOST || (kept > MOST_PIXELS && self.order.len() > 1) {
            let oldest = self.order.pop_front();
            let texture = oldest.and_then(|oldest| self.textures.remove(&oldest));
            kept -= texture.flatten().map_or(0, |texture| pixels(&texture));
        }
    }
}

/// The picture in a file of a recording.
fn read(path: &Path) -> Option<ColorImage> {
    let file = read_regular_file(path, Picture::MOST_FILE_BYTES, Symlinks::Refused);
    let picture = Picture::from_png(&file.ok()?).ok()?;
    let size = [picture.width as usize, picture.height as usize];
    Some(ColorImage::from_rgb(size, &picture.rgb))
}

#[cfg(test)]
mod tests {
    use std::{fs, process};

    use bevy_egui::egui::Color32;

    use super::*;

    /// A picture of this size in a file of its own; without pixels it only begins with them.
    fn written(name: &str, size: (u32, u32), pixels: &[u8]) -> PathBuf {
        let path = std::env::temp_dir().join(format!("tabletop_{name}_{}.png", process::id()));
        let file = fs::File::create(&path).unwrap();
        let mut encoder = png::Encoder::new(file, size.0, size.1);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().unwrap();
        match pixels {
            [] => writer.write_chunk(png::chunk::IDAT, &[]).unwrap(),
            _ => writer.write_image_data(pixels).unwrap(),
        }
        path
    }

    #[test]
    fn pictures_larger_than_those_of_cameras_are_not_read() {
        let small = written("small", (2, 1), &[0; 6]);
        let large = written("large", (1 << 30, 1 << 30), &[]);
        let read = [&small, &large].map(|path| read(path).map(|image| image.size));
        assert_eq!(read, [Some([2, 1]), None]);
        for path in [small, large] {
            fs::remove_file(path).unwrap();
        }
    }

    #[cfg(unix)]
    #[test]
    fn pictures_are_not_read_through_links() {
        let picture = written("linked", (2, 1), &[0; 6]);
        let link = picture.with_extension("link");
        std::os::unix::fs::symlink(&picture, &link).unwrap();
        let read = [&picture, &link].map(|path| read(path).is_some());
        assert_eq!(read, [true, false]);
        for path in [picture, link] {
            fs::remove_file(path).unwrap();
        }
    }

    #[test]
    fn the_pixels_that_are_kept_are_limited() {
        let context = Context::default();
        let mut pictures = Pictures::default();
        for serial in 0..6 {
            let side = 1 << 12;
            let image = ColorImage::filled([side, side], Color32::BLACK);
            let texture = context.load_texture("large", image, TextureOptions::LINEAR);
            let key = (PathBuf::from("large"), serial);
            pictures.textures.insert(key.clone(), Some(texture));
            pictures.order.push_back(key);
            pictures.forget_the_oldest();
        }
        let kept: Vec<_> = pictures.order.iter().map(|(_, serial)| *serial).collect();
        assert_eq!(kept, [2, 3, 4, 5]);
        assert_eq!(pictures.textures.len(), 4);
    }
}
