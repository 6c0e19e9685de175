//! Blobs that split when they separate from the heap.

use std::collections::{HashMap, HashSet};

use whitewater::Error;
use whitewater::bubbles::{BlobSimulation, BlobSimulationConfig, BlobSimulationSettings};
use whitewater::headless::Bubble;

use super::heap::{FLOOR, Running, cloud, turn_at_random};
use crate::reference::bubbles::heap::Blob;
use crate::support::device::Gpu;
use crate::support::scenes::Random;
use crate::support::tolerance::U;

const DT: f32 = 1.0 / 60.0;
fn free() -> BlobSimulationSettings {
    BlobSimulationSettings::default().with(|it| it.gravity = [0.0; 3])
}

fn one(radius: f32) -> Bubble {
    Bubble { ball: [0.0, 1.0, 0.0, radius], turn: [0.0, 0.0, 0.0, 1.0], id: 7 }
}

fn there(blobs: &[Blob]) -> Vec<Blob> {
    blobs.iter().copied().filter(|b| b.radius > 0.0).collect()
}

fn volume(blobs: &[Blob]) -> f64 {
    blobs.iter().map(|b| b.radius.powi(3)).sum()
}

/// Volume of the blobs that touch this one, relative to its own volume.
fn beside(blobs: &[Blob], own: &Blob, settings: &BlobSimulationSettings) -> f64 {
    let touches = |other: &&Blob| {
        let reach = f64::from(settings.reach) * (own.radius + other.radius);
        let far = own.place.distance(other.place);
        far > 0.0 && far < reach
    };
    volume(&blobs.iter().filter(touches).copied().collect::<Vec<_>>()) / own.radius.powi(3)
}

/// A lone blob becomes a connected clump, whose volume is the same at every time and changes
/// without jumps.
#[test]
fn a_lone_blob_becomes_a_clump() {
    let gpu = Gpu::shared();
    let radius = 0.1;
    let mut running = Running::halving(&gpu, &[one(radius)], 4);
    let whole = f64::from(radius).powi(3);
    let mut last: Vec<Blob> = running.blobs();
    assert_eq!((last.len(), there(&last).len()), (16, 1), "places, blobs");
    let mut counts = vec![1];
    for step in 0..300 {
        running.step(DT, &free(), &[]).expect("a step");
        let now = running.blobs();
        // A cube root by powers of two errs by 2^-20, and halves are rounded at most four times.
        let volume = volume(&now);
        assert!((volume / whole - 1.0).abs() < 1.0e-5, "{volume} of {whole} at {step}");
        for (now, last) in now.iter().zip(&last) {
            // A new half grows to 0.79 of the radius in half a second. The other half shrinks at
            // most three quarters as fast, because volume goes with 3 p².
            let change = (now.radius - last.radius).abs();
            let fastest = f64::from(DT / free().split_duration) * f64::from(radius);
            assert!(change <= fastest, "{} to {} at {step}", last.radius, now.radius);
        }
        let count = there(&now).len();
        if counts.last() != Some(&count) {
            counts.push(count);
        }
        last = now;
    }
    let clump = there(&last);
    println!("{counts:?} blobs: {:?}", clump.iter().map(|b| b.radius).collect::<Vec<_>>());
    assert!((4..=16).contains(&clump.len()), "{} blobs", clump.len());
    let middle = clump.iter().map(|b| b.place * b.radius.powi(3)).sum::<glam::DVec3>() / whole;
    for blob in &clump {
        assert!(
            blob.place.distance(middle) < 3.0 * f64::from(radius),
            "it has flown off: {blob:?}"
        );
        let level = (f64::from(radius) / blob.radius).log2() * 3.0;
        assert!((level - level.round()).abs() < 1.0e-4, "a radius of no half: {}", blob.radius);
        let company = beside(&clump, blob, &free());
        assert!(company >= 2.5 || level > 3.5, "one could still split: {blob:?}");
    }
}

/// A step of no time begins no split, because a half without radius would never grow.
#[test]
fn no_time_splits_nothing() {
    let gpu = Gpu::shared();
    let mut running = Running::halving(&gpu, &[one(0.1)], 1);
    let patient = free().with(|it| it.split_delay = 10.0);
    let hasty = free().with(|it| it.split_delay = 0.0);
    running.step(DT, &patient, &[]).expect("a step");
    // It has been alone for a step, long enough for these settings.
    running.step(0.0, &hasty, &[]).expect("a step");
    let whole = volume(&running.blobs());
    for _ in 0..60 {
        running.step(DT, &hasty, &[]).expect("a step");
    }
    let blobs = running.blobs();
    assert_eq!(there(&blobs).len(), 2, "{blobs:?}");
    let volume = volume(&blobs);
    assert!((volume / whole - 1.0).abs() < 1.0e-5, "{volume} of {whole}");
}

/// In a heap, exactly those blobs split for which the rule holds. A half is turned and moves as the
/// whole, and has an id of its own.
#[test]
fn what_has_enough_beside_it_stays_whole() {
    let gpu = Gpu::shared();
    let settings = BlobSimulationSettings::default().with(|it| {
        it.split_delay = 0.0;
        it.split_duration = 0.05;
    });
    let mut random = Random(3);
    let mut blobs = cloud(300, [0.9, 0.8, 0.9], [0.07, 0.11], 9);
    // Some blobs are thrown out of the heap.
    for blob in &mut blobs[..20] {
        blob.ball[0] += random.between(1.2, 6.0);
    }
    turn_at_random(&mut blobs, 5);
    let max_splits = 3;
    let mut running = Running::halving(&gpu, &blobs, max_splits);
    let step = settings.with(|it| it.substeps = 1);
    let (mut split, mut whole) = (0, 0);
    // Step of each blob's last split. A blob that is still splitting does not split again.
    let mut parting: HashMap<usize, u32> = HashMap::new();
    let mut halved = vec![0_u32; blobs.len() << max_splits];
    for i in 0..240 {
        let before = running.blobs();
        running.step(1.0 / 240.0, &step, &[FLOOR]).expect("a step");
        let after = running.blobs();
        let live = there(&before);
        for k in 0..before.len() {
            if before[k].radius == 0.0 || halved[k] >= max_splits {
                continue;
            }
            let parts = parting.get(&k).is_some_and(|since| i - since < 12);
            let ends = parting.get(&k).is_some_and(|since| i - since == 12);
            let child = k + (blobs.len() << halved[k]);
            let splits = before[child].radius == 0.0 && after[child].radius > 0.0;
            assert!(!(splits && parts), "{k} splits as it parts");
            let company = beside(&live, &before[k], &settings);
            // Near the limits of touching or of the volume, rounding decides.
            let near = live.iter().any(|other| {
                let reach = f64::from(settings.reach) * (before[k].radius + other.radius);
                let far = before[k].place.distance(other.place);
                far > 0.0 && (far / reach - 1.0).abs() < 1.0e-5
            });
            if !near && (company - 2.5).abs() > 1.0e-4 && !parts && !ends {
                assert_eq!(splits, company < 2.5, "{k} at {i} with {company}");
                split += u32::from(splits);
                whole += u32::from(!splits);
            }
            if splits {
                let (one, other) = (&after[k], &after[child]);
                // The second half may be turned as the whole was before the step or after it.
                let apart = [before[k].turn, one.turn].map(|q| (q - other.turn).length());
                assert!(apart[0].min(apart[1]) < 4.0 * U, "{one:?}, {other:?}");
                assert_eq!((one.speed, one.spin), (other.speed, other.spin), "{k} at {i}");
                halved[k] += 1;
                halved[child] = halved[k];
                parting.insert(k, i);
                parting.insert(child, i);
            }
        }
        assert!(after.iter().all(|b| b.place.is_finite() && b.speed.length() < 30.0), "{i}");
    }
    let last = there(&running.blobs());
    let ids: HashSet<u32> = last.iter().map(|blob| blob.id).collect();
    assert_eq!(ids.len(), last.len(), "two blobs have one id");
    println!("{split} splits, {whole} stays");
    assert!(split > 60 && whole > 10_000, "{split} splits, {whole} stays");
}

#[test]
fn the_order_of_blobs_is_no_matter_to_their_halves() {
    let gpu = Gpu::shared();
    let blobs = cloud(60, [3.0, 1.0, 3.0], [0.05, 0.1], 6);
    let order = Random(2).order(blobs.len());
    let turned: Vec<Bubble> = order.iter().map(|i| blobs[*i]).collect();
    let end = |blobs: &[Bubble]| {
        let mut running = Running::halving(&gpu, blobs, 2);
        for _ in 0..60 {
            running.step(DT, &BlobSimulationSettings::default(), &[FLOOR]).expect("a step");
        }
        running.blobs()
    };
    let [one, other] = [end(&blobs), end(&turned)];
    assert!(there(&one).len() > 100, "{} blobs", there(&one).len());
    for half in 0..4 {
        for (i, from) in order.iter().enumerate() {
            let first = half * blobs.len();
            assert_eq!(one[first + from], other[first + i], "blob {from}, half {half}");
        }
    }
}

#[test]
fn bad_halvings_are_errors() {
    let gpu = Gpu::shared();
    for config in [
        BlobSimulationConfig::new(4).with(|it| it.max_splits = 7),
        BlobSimulationConfig::new(1 << 18).with(|it| it.max_splits = 3),
    ] {
        let result = BlobSimulation::new(&gpu.context(1), &config, None);
        let field = result.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(field.contains("BlobSimulationConfig.max_splits"), "{field}");
    }
    type Spoil = fn(&mut BlobSimulationSettings);
    let spoils: [(&str, Spoil); 3] = [
        ("BlobSimulationSettings.split_support", |s| s.split_support = -1.0),
        ("BlobSimulationSettings.split_delay", |s| s.split_delay = f32::NAN),
        ("BlobSimulationSettings.split_duration", |s| s.split_duration = 0.0),
    ];
    let mut running = Running::halving(&gpu, &[one(0.1)], 1);
    for (field, spoil) in spoils {
        let mut settings = BlobSimulationSettings::default();
        spoil(&mut settings);
        let result = running.step(DT, &settings, &[]);
        assert!(
            matches!(result, Err(Error::BadInput { field: found, .. }) if found == field),
            "{field}"
        );
    }
}
