//! Bubble foam as the host stores it, and the results of a frame with it.

use ash::vk;
use whitewater::headless::Bubble;
use whitewater::{Blobs, Count, Stream};

use super::{Rig, Shot, stream};
use crate::reference::Image;
use crate::support::host::{Data, HOST_WRITE};

/// Additional results of a frame with bubble foam.
#[derive(Clone)]
pub struct Soaped {
    /// Depth of the frontmost bubble foam.
    pub depth: Image<f32>,
    /// Premultiplied colour, and opacity.
    pub color: Image<[f32; 4]>,
    /// Reflectance of films: cosines in columns, thicknesses in rows.
    pub film: Image<[f32; 4]>,
    /// Layers of blobs of each pixel, and the largest opacity.
    pub layers: Vec<Vec<u32>>,
    /// Statistics of the blobs: [`whitewater::Diagnostics::blobs`].
    pub range: [u32; 5],
}

/// Uploaded blobs, and their number.
pub struct Foamed(Data, u32);

impl Rig<'_> {
    /// Uploads a shot's blobs.
    pub fn blobs(&self, shot: &Shot) -> Foamed {
        let mut bytes = bytemuck::cast_slice(&shot.blobs).to_vec();
        bytes.resize(bytes.len().max(size_of::<Bubble>()), 0);
        let data = self.stub.data(&bytes, vk::BufferUsageFlags::STORAGE_BUFFER);
        Foamed(data, shot.blobs.len() as u32)
    }

    /// A frame's layers of blobs.
    pub fn soap_layers(
        &self,
        (buffer, words): (vk::Buffer, u32),
        frame: vk::Extent2D,
    ) -> Vec<Vec<u32>> {
        let all = self.words_of(buffer, words * frame.width * frame.height);
        all.chunks_exact(words as usize).map(<[u32]>::to_vec).collect()
    }

    /// First words of a buffer that has the usage TRANSFER_SRC.
    pub fn words_of(&self, buffer: vk::Buffer, count: u32) -> Vec<u32> {
        let size = 4 * u64::from(count);
        let back = self.stub.sized(size, vk::BufferUsageFlags::TRANSFER_DST);
        self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, buffer, &back));
        bytemuck::cast_slice(&back.bytes()[..size as usize]).to_vec()
    }
}

impl Foamed {
    pub fn streams(&self) -> Blobs {
        let stride = size_of::<Bubble>() as u32;
        let at = |offset| -> Stream { stream(&self.0, offset, stride) };
        Blobs::new(at(0), Count::Cpu(self.1)).with(|it| {
            it.rotations = Some(at(16));
            it.ids = Some(at(32));
            it.before = HOST_WRITE;
            it.after = HOST_WRITE;
        })
    }
}
