//! Pictures of a recording, read from their files as they are needed.

use std::{
    collections::{BTreeMap, VecDeque},
    fs::File,
    io::BufReader,
    path::{Path, PathBuf},
};

use bevy_egui::egui::{ColorImage, Context, TextureHandle, TextureOptions};
use tabletop_core::{Timeline, TimelinePicture};

/// So many pictures are kept.
const MOST: usize = 64;

/// Number of pictures that are read in a frame, so that it does not take long.
const MOST_A_FRAME: usize = 4;

/// The pictures of the present recording that were needed last.
#[derive(Default)]
pub(super) struct Pictures {
    folder: PathBuf,
    textures: BTreeMap<(PathBuf, usize), Option<TextureHandle>>,
    /// In the order in which they were read.
    order: VecDeque<(PathBuf, usize)>,
    read_now: usize,
}

impl Pictures {
    /// To be called before pictures are asked for.
    pub fn begin_frame(&mut self, timeline: &Timeline) {
        self.read_now = 0;
        if self.folder != timeline.folder {
            self.folder.clone_from(&timeline.folder);
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
            if self.order.len() > MOST
                && let Some(oldest) = self.order.pop_front()
            {
                self.textures.remove(&oldest);
            }
        }
        self.textures.get(&key)?.as_ref()
    }
}

/// A picture of 8 bits a channel, as recordings have them.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "pictures of recordings are of these types"
)]
fn read(path: &Path) -> Option<ColorImage> {
    let file = BufReader::new(File::open(path).ok()?);
    let mut reader = png::Decoder::new(file).read_info().ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut pixels).ok()?;
    let size = [info.width as usize, info.height as usize];
    let pixels = &pixels[..info.buffer_size()];
    let is_known = info.bit_depth == png::BitDepth::Eight;
    match info.color_type {
        png::ColorType::Rgba if is_known => Some(ColorImage::from_rgba_unmultiplied(size, pixels)),
        png::ColorType::Rgb if is_known => Some(ColorImage::from_rgb(size, pixels)),
        _ => None,
    }
}
