#![allow(clippy::unwrap_used)] // a test may

use super::*;

const COUNT: u32 = 20_000;

#[test]
fn the_same_ids_are_the_same_particles() {
    for sea in Sea::ALL {
        let all = sea.foam(0..COUNT, COUNT);
        assert_eq!(all, sea.foam(0..COUNT, COUNT), "{}", sea.name());
        // Any parts, in any order, give the particles of the whole sea.
        for part in [13_000..COUNT, 0..1, 1..6_999, 6_999..13_000] {
            let some = sea.foam(part.clone(), 3 * COUNT);
            let range = part.start as usize..part.end as usize;
            assert_eq!(some.positions[..], all.positions[range.clone()], "{}", sea.name());
            assert_eq!(some.kinds[..], all.kinds[range.clone()]);
            assert_eq!(some.ages[..], all.ages[range.clone()]);
            assert_eq!(some.ids[..], all.ids[range]);
        }
        // Ids past the end have no particle.
        assert_eq!(sea.foam(COUNT - 2..COUNT + 5, COUNT).ids, [COUNT - 2, COUNT - 1]);
        assert_eq!(sea.foam(COUNT..COUNT + 5, COUNT), Foam::default());
    }
}

#[test]
fn particles_are_what_is_said_of_them() {
    for sea in Sea::ALL {
        let foam = sea.foam(0..COUNT, COUNT);
        let [low, high] = sea.bounds().map(Vec3::from);
        for p in &foam.positions {
            let p = Vec3::from(*p);
            assert!(p.is_finite() && p.cmpge(low).all() && p.cmple(high).all(), "{sea:?}: {p}");
        }
        assert!(foam.ages.iter().all(|age| (0.0..=1.0).contains(age)), "{sea:?}");
        let shares = sea.shares();
        assert!((shares.iter().sum::<f32>() - 1.0).abs() < 1e-6, "{sea:?}");
        for (kind, share) in shares.into_iter().enumerate() {
            let found = foam.kinds.iter().filter(|k| **k as usize == kind).count() as f32;
            // Five standard deviations for this number of draws.
            let count = COUNT as f32;
            let off = 5.0 * (count * share * (1.0 - share)).sqrt();
            assert!((found - count * share).abs() < off, "{sea:?}: {found} of kind {kind}");
        }
    }
}

/// Foam is neither uniform nor in a few places: it clumps.
#[test]
fn foam_lies_in_clumps() {
    for sea in Sea::ALL {
        let foam = sea.foam(0..COUNT, COUNT);
        let mut cells = std::collections::HashMap::<[i32; 2], u32>::new();
        let surface = foam.positions.iter().zip(&foam.kinds).filter(|(_, kind)| **kind == FOAM);
        let mut count = 0;
        for (p, _) in surface {
            *cells.entry([p[0], p[2]].map(|x| (x / 2.0).floor() as i32)).or_default() += 1;
            count += 1;
        }
        // If particles were uniform over the occupied cells, the variance of a cell's count would equal its mean.
        let mean = f64::from(count) / cells.len() as f64;
        let square = cells.values().map(|n| (f64::from(*n) - mean).powi(2)).sum::<f64>();
        let ratio = square / cells.len() as f64 / mean;
        assert!(ratio > 3.0, "{sea:?}: {ratio}");
        assert!(cells.len() > 200, "{sea:?}: {} cells", cells.len());
    }
}

#[test]
fn cover_is_the_same_at_every_count() {
    for sea in Sea::ALL {
        let area = |count: u32| f64::from(count) * f64::from(sea.radius(count)).powi(2);
        for count in [1, 1000, 29_000_000, u32::MAX] {
            // Three roundings of a float.
            assert!((area(count) / area(1_000_000) - 1.0).abs() < 1e-6, "{sea:?}, {count}");
        }
        assert!(sea.radius(0).is_finite());
    }
}

#[test]
fn scenes_are_whole_and_far_enough_away() {
    for sea in Sea::ALL {
        let scene = sea.scene();
        for mesh in &scene.meshes {
            let count = mesh.positions.len();
            assert_eq!(mesh.normals.len(), count, "{}", mesh.name);
            assert!(mesh.indices.iter().all(|i| (*i as usize) < count), "{}", mesh.name);
            let whole = mesh.positions.iter().chain(&mesh.normals).flatten();
            assert!(whole.into_iter().all(|v| v.is_finite()), "{sea:?}: {}", mesh.name);
        }
        // The sea is the first mesh; its normals point up.
        assert!(scene.meshes[0].normals.iter().filter(|n| n[1] > 0.0).count() > 50_000);
        // The target is as far away as in the paper's picture.
        let plan = sea.plan();
        let away = plan.eye.distance(plan.target);
        assert!((20.0..=200.0).contains(&away), "{sea:?}: {away} m");
        let camera = sea.camera(4.0 / 3.0);
        let clip = camera.projection_matrix() * camera.view_matrix();
        let foam = sea.foam(0..COUNT, COUNT);
        let seen = foam.positions.iter().filter(|p| {
            let q = clip * Vec3::from(**p).extend(1.0);
            q.w > 0.5 && q.x.abs() < q.w && q.y.abs() < q.w
        });
        let share = seen.count() as f32 / COUNT as f32;
        assert!(share > 0.5, "{sea:?}: {share} of the particles in the picture");
        assert_eq!(Sea::from_name(sea.name()), Some(sea));
        let near = sea.camera_from(5.0, 4.0 / 3.0);
        let target = near.view_matrix().transform_point3(plan.target);
        assert!(target.distance(Vec3::new(0.0, 0.0, -5.0)) < 1e-4, "{sea:?}: {target}");
    }
    assert_eq!(Sea::from_name("pool"), None);
}
