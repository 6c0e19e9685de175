//! Whitewater particles as the host stores them, and as the twin uses them.

use ash::vk;
use glam::Vec3;
use whitewater::Submerged;
use whitewater::headless::Whitewater;
use whitewater::{Count, WhitewaterParticles};

use super::{Rig, stream};
use crate::reference::whitewater::{Attenuation, Kind, Particle};
use crate::support::host::{Data, HOST_WRITE};

/// Buffers of the particles, tightly packed.
pub struct WhitewaterCloud {
    positions: Data,
    /// Kinds, radii, ages, ids.
    words: [Option<Data>; 4],
    count: u32,
}

impl Rig<'_> {
    /// Buffers of whitewater particles.
    pub fn whitewater(&self, all: &Whitewater<'_>) -> WhitewaterCloud {
        let data = |bytes: &[u8]| self.stub.data(bytes, vk::BufferUsageFlags::STORAGE_BUFFER);
        let words = [
            all.kinds.map(bytemuck::cast_slice),
            all.radii.map(bytemuck::cast_slice),
            all.ages.map(bytemuck::cast_slice),
            all.ids.map(bytemuck::cast_slice),
        ];
        WhitewaterCloud {
            positions: data(bytemuck::cast_slice(all.positions)),
            words: words.map(|words| words.map(data)),
            count: all.positions.len() as u32,
        }
    }
}

impl WhitewaterCloud {
    pub fn particles(&self) -> WhitewaterParticles {
        let [kinds, radii, ages, ids] =
            self.words.each_ref().map(|data| data.as_ref().map(|data| stream(data, 0, 4)));
        let positions = stream(&self.positions, 0, 12);
        WhitewaterParticles::new(positions, Count::Cpu(self.count)).with(|it| {
            it.kinds = kinds;
            it.radii = radii;
            it.ages = ages;
            it.ids = ids;
            it.before = HOST_WRITE;
            it.after = HOST_WRITE;
        })
    }
}

/// The whitewater particles in the twin's representation.
pub fn twins(all: &Whitewater<'_>) -> Vec<Particle> {
    let particle = |(i, position): (usize, &[f32; 3])| Particle {
        position: Vec3::from(*position).as_dvec3(),
        kind: Kind::of(all.kinds.map_or(0, |kinds| kinds[i])),
        radius: all.radii.map(|radii| f64::from(radii[i])),
        age: all.ages.map_or(0.0, |ages| f64::from(ages[i])),
        id: all.ids.map_or(i as u32, |ids| ids[i]),
    };
    all.positions.iter().enumerate().map(particle).collect()
}

/// Attenuation of particles behind the surface.
pub fn attenuation(submerged: Submerged) -> Attenuation {
    match submerged {
        Submerged::Water => Attenuation::Water,
        Submerged::Falloff { depth, n, m } => {
            Attenuation::Falloff { max: depth.into(), n: n.into(), m: m.into() }
        }
    }
}
