//! Contents of a frame: camera, particles, scene and settings.

use ash::vk;
use whitewater::headless::Bubble;
use whitewater::water::Pane;
use whitewater::{
    Camera, Frame, HostImage, LightVolume, Particles, Previous, Settings, Shadow, Shore, Slot,
};

use super::extent;
use crate::reference::{Image, Sphere, View};
use crate::support::scenes;
use crate::support::tolerance::{Splats, Sum};

/// Colour of the margin around a view. A filter that reads it, even with weight 0, gets NaN.
pub const AROUND: [f32; 4] = [f32::NAN, f32::INFINITY, 25.0, 0.5];

pub fn is_around(texel: &[f32; 4]) -> bool {
    texel[0].is_nan() && texel[1..] == AROUND[1..]
}

/// Contents of a frame.
#[derive(Clone)]
pub struct Shot {
    /// Extent of the view.
    pub size: vk::Extent2D,
    /// Margin around the view in all images of the host: columns left and right, rows above and
    /// below.
    pub margin: [u32; 4],
    pub camera: Camera,
    /// Shadow map of the sun.
    pub shadow: Option<Shadow>,
    /// Sphere that contains all casters and receivers.
    pub light_volume: Option<LightVolume>,
    /// State of the previous frame.
    pub previous: Option<Previous>,
    /// Panes of glass that the water stands against.
    pub panes: Vec<Pane>,
    pub settings: Settings,
    pub positions: Vec<[f32; 3]>,
    pub densities: Option<Vec<f32>>,
    /// Blobs, drawn if the renderer draws bubble foam.
    pub blobs: Vec<Bubble>,
    /// Shoreline and contact foam; its images outlive the draw.
    pub shore: Option<Shore>,
    /// Colour of the scene, with the output's extent.
    pub color: Vec<[f32; 4]>,
    /// Device depth of the scene, with its extent.
    pub depth: Vec<f32>,
    pub depth_extent: vk::Extent2D,
    pub depth_format: vk::Format,
}

impl Shot {
    /// Particles (eye space x, y, depth) of one radius in front of a distant, coloured scene.
    pub fn new(size: vk::Extent2D, lens: scenes::Lens, radius: f32, points: &[[f32; 3]]) -> Self {
        let camera = scenes::camera(lens, size);
        let mut shot = Self {
            size,
            margin: [0; 4],
            positions: scenes::world(&camera, points),
            camera,
            shadow: None,
            light_volume: None,
            previous: None,
            panes: Vec::new(),
            settings: scenes::settings(radius),
            densities: None,
            blobs: Vec::new(),
            shore: None,
            color: Vec::new(),
            depth: Vec::new(),
            depth_extent: size,
            depth_format: vk::Format::D32_SFLOAT,
        };
        shot.color = gradient(size);
        shot.scene_depth(|_, _| None);
        shot
    }

    /// Max depth difference within one surface, rounded as in the renderer.
    pub fn falloff(&self) -> f32 {
        self.settings.water.depth_falloff * self.settings.water.radius()
    }

    /// A frame of the shot over its own scene, with slot 0.
    pub fn frame(&self, output: HostImage, depth: HostImage, particles: Particles) -> Frame<'_> {
        Frame::new(Slot(0), output, depth, particles, self.camera, &self.settings).with(|it| {
            it.shore = self.shore;
            (it.shadow, it.light_volume) = (self.shadow, self.light_volume);
            it.previous = self.previous;
            it.panes = &self.panes;
        })
    }

    /// Extent of an image with the margin, and rectangle of the view in it.
    pub fn with_margin(&self, view: vk::Extent2D) -> (vk::Extent2D, vk::Rect2D) {
        let [left, right, above, below] = self.margin;
        let whole = extent(left + view.width + right, above + view.height + below);
        let offset = vk::Offset2D { x: left as i32, y: above as i32 };
        (whole, vk::Rect2D { offset, extent: view })
    }

    /// The texels of an image with the margin, which is filled with `around`.
    pub fn pad<T: Copy>(&self, view: vk::Extent2D, texels: &[T], around: T) -> Vec<T> {
        let (whole, rect) = self.with_margin(view);
        let mut padded = vec![around; (whole.width * whole.height) as usize];
        for (y, row) in texels.chunks_exact(view.width as usize).enumerate() {
            let at = (y + rect.offset.y as usize) * whole.width as usize + rect.offset.x as usize;
            padded[at..at + row.len()].copy_from_slice(row);
        }
        padded
    }

    /// The camera for the twins.
    pub fn view(&self, size: vk::Extent2D) -> View {
        scenes::twin(&self.camera, size)
    }

    /// Transform from world space to the twins' eye space.
    pub fn camera_view(&self) -> glam::DMat4 {
        self.view(self.depth_extent).view
    }

    /// Fills the scene's depth image from an eye depth per texel; `None` means that there is no
    /// scene.
    pub fn scene_depth(&mut self, eye: impl Fn(u32, u32) -> Option<f64>) {
        let view = self.view(self.depth_extent);
        let far = view.far().map_or_else(
            || view.device_depth(f64::INFINITY),
            |_| {
                let farther = view.eye_depth(1.0) > view.eye_depth(0.0);
                f64::from(farther)
            },
        );
        let size = self.depth_extent;
        self.depth = (0..size.height)
            .flat_map(|y| (0..size.width).map(move |x| (x, y)))
            .map(|(x, y)| {
                let device = eye(x, y).map_or(far, |d| view.device_depth(d));
                device.clamp(0.0, 1.0) as f32
            })
            .collect();
    }

    /// Eye depth of the scene as stored in the depth image, for the twins, one value per texel.
    pub fn scene_eye(&self) -> Image<f64> {
        let view = self.view(self.depth_extent);
        let eye = |z: &f32| {
            let d = view.eye_depth(f64::from(*z));
            if d > 0.0 { d } else { f64::INFINITY }
        };
        Image {
            width: self.depth_extent.width as usize,
            height: self.depth_extent.height as usize,
            data: self.depth.iter().map(eye).collect(),
        }
    }
}

impl Shot {
    /// Eye depth of the scene at pixels of the output halved `level` times, by the nearest texel.
    pub fn scene_at(&self, size: vk::Extent2D, level: u32) -> Image<f64> {
        let eye = self.scene_eye();
        let block = 1_usize << level;
        let (width, height) = (size.width as usize, size.height as usize);
        let texel = |i: usize, full: usize, texels: usize| {
            let at = (i as f64 + 0.5) * block as f64 * texels as f64 / full as f64;
            (at.floor() as usize).min(texels - 1)
        };
        Image::from_fn(width.div_ceil(block), height.div_ceil(block), |x, y| {
            eye.at(texel(x, width, eye.width), texel(y, height, eye.height))
        })
    }

    /// Input of the thickness sums of spheres, for an image halved `level` times.
    pub fn splats<'a>(&self, spheres: &'a [Sphere], level: u32, sum: Sum) -> Splats<'a> {
        let water = &self.settings.water;
        Splats {
            spheres,
            full: self.view(self.size),
            level,
            scene: self.scene_at(self.size, level),
            volume: f64::from(water.spacing).powi(3),
            radius: f64::from(water.radius()),
            sum,
        }
    }
}

/// A scene colour that varies smoothly from pixel to pixel.
pub fn gradient(size: vk::Extent2D) -> Vec<[f32; 4]> {
    (0..size.height)
        .flat_map(|y| (0..size.width).map(move |x| (x as f32, y as f32)))
        .map(|(x, y)| [0.125 + x / 256.0, 0.25 + y / 256.0, 0.5 + (x - y) / 512.0, 0.75])
        .collect()
}
