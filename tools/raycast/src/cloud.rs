//! A cloud to draw when there is nothing else: a sea with the foam of a breaking wave, the spray over it and the
//! bubbles under it. Each particle goes by its id alone.

use std::ops::Range;

use glam::{Mat4, Vec3, vec3};
use whitewater::Camera;
use whitewater::headless::scene::{Ground, Material, Scene};

use crate::Foam;

/// Half the edge of the sea, metres.
const HALF: f32 = 12.0;

/// The cloud.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cloud;

/// Numbers from 0 to 1 that follow from an id (SplitMix64, Steele et al. 2014).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    }
}

/// Height of the sea, metres.
fn height(x: f32, z: f32) -> f32 {
    let swell = 0.35 * (0.8 * z + 0.3 * x).sin() + 0.12 * (1.7 * x - 0.9 * z).sin();
    swell + 1.6 * (-0.35 * (z + 2.0 + 0.4 * (0.5 * x).sin()).powi(2)).exp()
}

/// How much foam lies there, 0 to 1: streaks that waves have drawn out, and most on the crest.
fn cover(x: f32, z: f32) -> f32 {
    let streak = (1.3 * x + 0.7 * (0.9 * z).sin()).sin() * (1.1 * z + 0.8 * (0.7 * x).sin()).cos();
    let crest = (-0.5 * (z + 1.4).powi(2)).exp();
    (0.9 * crest + 0.7 * (streak - 0.35).max(0.0)).min(1.0)
}

impl Cloud {
    /// The particles of these ids, of a cloud of `count`; ids from there on have none.
    pub fn foam(self, ids: Range<u32>, count: u32) -> Foam {
        let ids = ids.start..ids.end.min(count);
        let mut foam = Foam { ids: ids.clone().collect(), ..Foam::default() };
        for id in ids {
            let mut random = Random(u64::from(id) << 20);
            let (mut x, mut z) = (0.0, -1.4);
            // By rejection: the last place is taken as it is.
            for _ in 0..64 {
                (x, z) = (HALF * (2.0 * random.unit() - 1.0), HALF * (2.0 * random.unit() - 1.0));
                if random.unit() < cover(x, z) {
                    break;
                }
            }
            let (lot, up) = (random.unit(), random.unit());
            let kind = if lot < 0.7 { 0 } else { 1 + u32::from(lot > 0.85) };
            let offset = match kind {
                0 => 0.03 * up,
                // Fewer and fewer upwards, and only over the crest.
                1 => -0.25 * (1.0 - up).max(1.0e-6).ln() * (0.1 + (-0.6 * (z + 1.4).powi(2)).exp()),
                _ => -0.5 * up * up,
            };
            foam.positions.push([x, height(x, z) + offset, z]);
            foam.kinds.push(kind);
            foam.ages.push(0.95 * random.unit());
        }
        foam
    }

    /// The radius with which so many particles cover as much as any other number of them, metres.
    pub fn radius(self, count: u32) -> f32 {
        12.0 / (count.max(1) as f32).sqrt()
    }

    /// What stands in it: the ground.
    pub fn scene(self) -> Scene {
        let material = Material { base_color: [0.03, 0.09, 0.13], ..Material::default() };
        Scene { ground: Some(Ground { y: -1.0, material }), ..Scene::default() }
    }

    /// From where the picture is taken, for a picture so many times as wide as high.
    pub fn camera(self, aspect: f32) -> Camera {
        // Vulkan's y points down.
        let flip = Mat4::from_scale(vec3(1.0, -1.0, 1.0));
        let lens = Mat4::perspective_infinite_reverse_rh(40_f32.to_radians(), aspect, 0.1);
        Camera {
            view: Mat4::look_at_rh(vec3(2.0, 4.5, 13.0), vec3(0.0, 0.2, -1.0), Vec3::Y),
            projection: flip * lens,
        }
    }
}
