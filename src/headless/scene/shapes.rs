//! Boxes, cylinders, spheres and planes. Texture coordinates are in world units.

use std::f32::consts::{PI, TAU};

use glam::{Mat4, Quat, Vec3};

use super::{Material, Mesh};

/// Outward normals of a box's faces in the order +x −x +y −y +z −z.
pub const FACES: [Vec3; 6] = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];

/// A rotation from a file, x y z w.
pub fn quaternion(rotation: [f32; 4]) -> Quat {
    let rotation = Quat::from_array(rotation);
    if rotation.length_squared() > 1e-12 { rotation.normalize() } else { Quat::IDENTITY }
}

impl Mesh {
    /// A box about a centre, turned by a rotation.
    pub fn cuboid(
        centre: [f32; 3],
        half: [f32; 3],
        rotation: [f32; 4],
        material: Material,
    ) -> Self {
        Self::cuboid_faces(centre, half, rotation, material, |_| true)
    }

    /// Some faces of a box, chosen by their index in [`FACES`].
    pub(super) fn cuboid_faces(
        centre: [f32; 3],
        half: [f32; 3],
        rotation: [f32; 4],
        material: Material,
        wanted: impl Fn(usize) -> bool,
    ) -> Self {
        let transform = Mat4::from_rotation_translation(quaternion(rotation), centre.into());
        let mut mesh = Self { name: "box".into(), material, transform, ..Self::default() };
        let half = Vec3::from(half);
        for (index, &normal) in FACES.iter().enumerate() {
            if !wanted(index) {
                continue;
            }
            // Two tangents with u × v = normal: triangles wind counter-clockwise from outside.
            let u = if normal.x != 0.0 { Vec3::Y } else { Vec3::X };
            let v = normal.cross(u);
            let first = mesh.positions.len() as u32;
            for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let at = (normal + u * a + v * b) * half;
                mesh.positions.push(at.to_array());
                mesh.normals.push(normal.to_array());
                mesh.uvs.push([at.dot(u), at.dot(v)]);
            }
            mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
        }
        mesh
    }

    /// An upright cylinder with caps; `centre` is at half its height.
    pub fn cylinder(centre: [f32; 3], radius: f32, height: f32, material: Material) -> Self {
        const SIDES: u32 = 64;
        let transform = Mat4::from_translation(centre.into());
        let mut mesh = Self { name: "cylinder".into(), material, transform, ..Self::default() };
        let half = 0.5 * height;
        let around = |i: u32| {
            let (sin, cos) = (TAU * i as f32 / SIDES as f32).sin_cos();
            Vec3::new(cos, 0.0, -sin)
        };
        for i in 0..=SIDES {
            let out = around(i);
            for y in [-half, half] {
                mesh.positions.push((out * radius + Vec3::Y * y).to_array());
                mesh.normals.push(out.to_array());
                mesh.uvs.push([TAU * radius * i as f32 / SIDES as f32, y]);
            }
            if i < SIDES {
                mesh.indices.extend([0, 2, 3, 0, 3, 1].map(|k| 2 * i + k));
            }
        }
        for up in [1.0, -1.0] {
            let first = mesh.positions.len() as u32;
            let mut push = |at: Vec3| {
                mesh.positions.push(at.to_array());
                mesh.normals.push([0.0, up, 0.0]);
                mesh.uvs.push([at.x, at.z]);
            };
            push(Vec3::Y * half * up);
            for i in 0..SIDES {
                push(around(i) * radius + Vec3::Y * half * up);
            }
            for i in 0..SIDES {
                let (a, b) = (first + 1 + i, first + 1 + (i + 1) % SIDES);
                mesh.indices.extend(if up > 0.0 { [first, a, b] } else { [first, b, a] });
            }
        }
        mesh
    }

    /// An upright cylinder with a hole of radius `bore` along its axis; `centre` is at half its height. Its top is cut
    /// along the plane y = height / 2 + `slope` x, where x and y are relative to `centre`.
    pub fn tube(
        centre: [f32; 3],
        [radius, bore]: [f32; 2],
        height: f32,
        slope: f32,
        material: Material,
    ) -> Self {
        const SIDES: u32 = 64;
        let transform = Mat4::from_translation(centre.into());
        let mut mesh = Self { name: "tube".into(), material, transform, ..Self::default() };
        let half = 0.5 * height;
        let cut = Vec3::new(-slope, 1.0, 0.0).normalize();
        // A rim with a given radius, at the top or the bottom.
        let rim = |out: Vec3, radius: f32, top: bool| {
            let at = out * radius;
            at + Vec3::Y * if top { half + slope * at.x } else { -half }
        };
        // Strips between two rims: outside, bore, top, bottom. Each strip runs counter-clockwise as seen from
        // above; the order of its two rims makes its triangles face out of the solid.
        let strips = [
            (radius, false, radius, true),
            (bore, true, bore, false),
            (radius, true, bore, true),
            (bore, false, radius, false),
        ];
        for (strip, (from, from_top, to, to_top)) in strips.into_iter().enumerate() {
            let first = mesh.positions.len() as u32;
            for i in 0..=SIDES {
                let (sin, cos) = (TAU * i as f32 / SIDES as f32).sin_cos();
                let out = Vec3::new(cos, 0.0, -sin);
                let normal = [out, -out, cut, Vec3::NEG_Y][strip];
                for at in [rim(out, from, from_top), rim(out, to, to_top)] {
                    mesh.positions.push(at.to_array());
                    mesh.normals.push(normal.to_array());
                    let around = TAU * radius * i as f32 / SIDES as f32;
                    mesh.uvs.push(if strip < 2 { [around, at.y] } else { [at.x, at.z] });
                }
                if i < SIDES {
                    mesh.indices.extend([0, 2, 3, 0, 3, 1].map(|k| first + 2 * i + k));
                }
            }
        }
        mesh
    }

    /// A sphere.
    pub fn sphere(centre: [f32; 3], radius: f32, material: Material) -> Self {
        const RINGS: u32 = 32;
        const SIDES: u32 = 64;
        let transform = Mat4::from_translation(centre.into());
        let mut mesh = Self { name: "sphere".into(), material, transform, ..Self::default() };
        for ring in 0..=RINGS {
            let (sin, cos) = (PI * ring as f32 / RINGS as f32).sin_cos();
            for i in 0..=SIDES {
                let (s, c) = (TAU * i as f32 / SIDES as f32).sin_cos();
                let out = Vec3::new(sin * c, cos, -sin * s);
                mesh.positions.push((out * radius).to_array());
                mesh.normals.push(out.to_array());
                mesh.uvs.push([
                    TAU * radius * i as f32 / SIDES as f32,
                    PI * radius * ring as f32 / RINGS as f32,
                ]);
                if ring < RINGS && i < SIDES {
                    let (a, b) = (ring * (SIDES + 1) + i, (ring + 1) * (SIDES + 1) + i);
                    mesh.indices.extend([a, b, b + 1, a, b + 1, a + 1]);
                }
            }
        }
        mesh
    }

    /// A level rectangle that faces up.
    pub fn plane(centre: [f32; 3], half: [f32; 2], material: Material) -> Self {
        let size = [half[0], 1.0, half[1]];
        let mut mesh =
            Self::cuboid_faces([0.0; 3], size, [0.0, 0.0, 0.0, 1.0], material, |face| face == 2);
        for position in &mut mesh.positions {
            position[1] = 0.0;
        }
        mesh.name = "plane".into();
        mesh.transform = Mat4::from_translation(centre.into());
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Winding and normals of every shape agree, and no triangle is out of range.
    #[test]
    fn shapes_face_outward() {
        let m = Material::default;
        for mesh in [
            Mesh::cuboid([1.0, 2.0, 3.0], [1.0, 0.5, 2.0], [0.0, 0.0, 0.3, 0.954], m()),
            Mesh::cylinder([0.0; 3], 0.4, 2.0, m()),
            Mesh::tube([0.0; 3], [0.4, 0.3], 2.0, 0.7, m()),
            Mesh::sphere([0.0; 3], 0.4, m()),
            Mesh::plane([0.0, 1.0, 0.0], [2.0, 3.0], m()),
        ] {
            assert_eq!(mesh.positions.len(), mesh.normals.len());
            assert_eq!(mesh.positions.len(), mesh.uvs.len());
            let (mut volume, mut up) = (0.0, true);
            for t in mesh.indices.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|k| Vec3::from(mesh.positions[t[k] as usize]));
                let face = (b - a).cross(c - a);
                let normal = Vec3::from(mesh.normals[t[0] as usize]);
                // The triangles at a sphere's poles have no area.
                assert!(face.length() < 1e-6 || face.dot(normal) > 0.0, "{}", mesh.name);
                volume += a.dot(b.cross(c)) / 6.0;
                up &= normal.y > 0.99;
            }
            // A closed mesh that faces inward has a negative volume.
            assert!(
                if mesh.name == "plane" { up } else { volume > 0.0 },
                "{}: {volume}",
                mesh.name
            );
        }
    }
}
