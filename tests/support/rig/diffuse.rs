//! Diffuse particles as the host has them, and as the twin takes them.

use ash::vk;
use glam::Vec3;
use whitewater::foam::Submerged;
use whitewater::headless::Diffuse;
use whitewater::{Count, DiffuseParticles};

use super::{Rig, stream};
use crate::reference::diffuse::{Attenuation, Kind, Particle};
use crate::support::host::{Data, HOST_WRITE};

/// Their buffers, packed.
pub struct DiffuseCloud {
    positions: Data,
    /// Kinds, radii, ages, ids.
    words: [Option<Data>; 4],
    count: u32,
}

impl Rig<'_> {
    /// Buffers of diffuse particles.
    pub fn diffuse(&self, all: &Diffuse<'_>) -> DiffuseCloud {
        let data = |bytes: &[u8]| self.stub.data(bytes, vk::BufferUsageFlags::STORAGE_BUFFER);
        let words = [
            all.kinds.map(bytemuck::cast_slice),
            all.radii.map(bytemuck::cast_slice),
            all.ages.map(bytemuck::cast_slice),
            all.ids.map(bytemuck::cast_slice),
        ];
        DiffuseCloud {
            positions: data(bytemuck::cast_slice(all.positions)),
            words: words.map(|words| words.map(data)),
            count: all.positions.len() as u32,
        }
    }
}

impl DiffuseCloud {
    pub fn particles(&self) -> DiffuseParticles {
        let [kinds, radii, ages, ids] =
            self.words.each_ref().map(|data| data.as_ref().map(|data| stream(data, 0, 4)));
        let positions = stream(&self.positions, 0, 12);
        DiffuseParticles::new(positions, Count::Cpu(self.count)).with(|it| {
            it.kinds = kinds;
            it.radii = radii;
            it.ages = ages;
            it.ids = ids;
            it.before = HOST_WRITE;
            it.after = HOST_WRITE;
        })
    }
}

/// The same for the twin.
pub fn twins(all: &Diffuse<'_>) -> Vec<Particle> {
    let particle = |(i, position): (usize, &[f32; 3])| Particle {
        position: Vec3::from(*position).as_dvec3(),
        kind: Kind::of(all.kinds.map_or(0, |kinds| kinds[i])),
        radius: all.radii.map(|radii| f64::from(radii[i])),
        age: all.ages.map_or(0.0, |ages| f64::from(ages[i])),
        id: all.ids.map_or(i as u32, |ids| ids[i]),
    };
    all.positions.iter().enumerate().map(particle).collect()
}

/// What becomes of particles behind the surface.
pub fn attenuation(submerged: Submerged) -> Attenuation {
    match submerged {
        Submerged::Water => Attenuation::Water,
        Submerged::Falloff { most, n, m } => {
            Attenuation::Falloff { max: most.into(), n: n.into(), m: m.into() }
        }
    }
}
