//! Compares the shore's twin with closed forms, and its bounds with single precision.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::foam::shoreline;
use super::foam::{Pixel, Shoreline, by_samples, clipped, coordinate, covered, layer, noise};
use super::map::{Heights, Map, Shore, difference};
use super::texture::{Texture, half};
use super::*;

/// Random numbers (Marsaglia's xorshift, times a constant).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// A random number that single precision represents exactly.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        let part = (self.bits() >> 40) as f64 / (1_u64 << 24) as f64;
        f64::from((low + part * (high - low)) as f32)
    }
}

const CLOCK: Clock = Clock { time: 12.75, period: None };

/// Periodic noise: a sum of waves in all directions, mean 0, at most 1.
fn smooth_noise(size: usize, seed: u64) -> Texture<4> {
    let mut r = Random(seed);
    let terms: Vec<_> = (0..24)
        .map(|_| {
            let [x, y] = [0; 2].map(|_| r.between(-6.49, 6.49).round());
            ([x, y], std::array::from_fn::<_, 4, _>(|_| r.between(0.0, TAU)))
        })
        .collect();
    let texel = |i: usize| {
        let [u, v] = [i % size, i / size].map(|t| (t as f64 + 0.5) / size as f64);
        std::array::from_fn(|c| {
            let wave =
                |([x, y], phase): &([f64; 2], [f64; 4])| (TAU * (x * u + y * v) + phase[c]).sin();
            let sum: f64 = terms.iter().filter(|(k, _)| *k != [0.0; 2]).map(wave).sum();
            (sum / 12.0).clamp(-1.0, 1.0) as f32
        })
    };
    Texture::new(size, &(0..size * size).map(texel).collect::<Vec<_>>())
}

/// A periodic cell pattern: 1 on the lines between cells, decreasing with the distance from them.
fn cells(size: usize, count: usize, seed: u64) -> Texture<4> {
    let mut r = Random(seed);
    let points: Vec<_> = (0..count).map(|_| [0; 2].map(|_| r.between(0.0, 1.0))).collect();
    let texel = |i: usize| {
        let at = [i % size, i / size].map(|t| (t as f64 + 0.5) / size as f64);
        let mut far: Vec<_> = points
            .iter()
            .map(|p| {
                let [x, y] = [0, 1].map(|i| (p[i] - at[i] + 0.5).rem_euclid(1.0) - 0.5);
                x.hypot(y)
            })
            .collect();
        far.sort_unstable_by(f64::total_cmp);
        (1.0 - (far[1] - far[0]) * (count as f64).sqrt()).max(0.0) as f32
    };
    Texture::web(size, &(0..size * size).map(texel).collect::<Vec<_>>())
}

/// The default settings.
fn island(clock: Clock) -> Shoreline {
    let ninety = 1.0 / 90.0;
    Shoreline {
        frequency_noise: noise(5.0, ninety),
        speed_noise: noise(0.35, ninety),
        wave_rise: [1.5, -1.0],
        wave_weight: 0.5,
        texture_weight: 0.5,
        web_rise: [f64::from(0.9_f32), f64::from(-0.6_f32)],
        layers: vec![
            layer(clock, 0.62, 1.0 / 13.0, 0.0, [0.12, 0.07]),
            layer(clock, 0.38, 1.0 / 7.9, 37.0, [-0.1, 0.13]),
        ],
        texture_warp: noise(0.8, 1.0 / 17.0),
        web_warp_moved: clock.moved(1.0 / 17.0, [0.35, 0.2]),
        threshold: f64::from(0.42_f32),
        threshold_noise: noise(0.14, ninety),
        rise_noise: noise(0.2, ninety),
        ..Shoreline::waves(15.0, clock.phases(-0.9, 0.35, [2.2, 7.0], 11.0), f64::from(0.2_f32))
    }
}

fn still(phase: f64) -> Phases {
    Phases { waves: exact(phase), local: exact(0.0) }
}

fn pixel(place: [f64; 2], v: f64, width: f64, dv: [f64; 2]) -> Pixel {
    let across = [[width, 0.0], [0.0, width]].map(|way| way.map(exact));
    Pixel { off: [0.0; 2], place: place.map(exact), v: exact(v), across, dv: dv.map(exact) }
}

/// A camera `height` above the plane, turned down and about the up axis by these angles.
fn camera(height: f64, down: f64, about: f64, size: [f64; 2], view: f64) -> Water {
    let forward = DVec3::new(about.cos() * down.cos(), about.sin() * down.cos(), -down.sin());
    let right = forward.cross(DVec3::Z).normalize();
    let above = right.cross(forward);
    // World axes in eye space.
    let row = |axis: DVec3, offset: f64| {
        [axis.dot(right), axis.dot(above), -axis.dot(forward), offset].map(|v| v as f32)
    };
    let step = 2.0 * view / size[1];
    let slope = [step, -step, -step * size[0] / 2.0, view].map(|v| v as f32);
    water(slope, row(DVec3::Z, height), row(DVec3::X, 31.25), row(DVec3::Y, -17.5))
}

#[test]
fn the_bounds_of_operations_hold_and_are_not_idle() {
    let mut r = Random(5);
    let mut worst = [0.0_f64; 14];
    for _ in 0..40_000 {
        let [a, b, c, s] = [0; 4].map(|_| r.between(-2.0, 2.0) as f32);
        let (x, y) = (a * 300.0, b.abs());
        let e = |x: f32| exact(f64::from(x));
        let ab = e(a) * e(b);
        let cases: [(f32, Bounded); 14] = [
            (a * b + c, ab + e(c)),
            (a * b - c * s, dot([e(a), e(c)], [e(b), -e(s)])),
            ((a * b) / (c.abs() + 0.5), ab / (e(c.abs()) + 0.5)),
            ((a * b + c).abs().sqrt(), (ab + e(c)).abs().sqrt()),
            ((a * b).exp(), ab.exp()),
            ((a * b).exp2(), ab.exp2()),
            ((y * 9.0 + 0.1_f32).log2(), (e(y) * 9.0 + f64::from(0.1_f32)).log2()),
            (single::sine(x * b + c, s / 2.0), (e(x) * e(b) + e(c)).sine()),
            (single::smoothstep(0.7, a * b), ab.smoothstep(f64::from(0.7_f32))),
            (a * (1.0 - y * b) + c * (y * b), mix(e(a), e(c), e(y) * e(b))),
            ((a * b).max(c * 0.1), ab.max(f64::from(c * 0.1))),
            (
                single::covered(a * b * 0.01, y * c.abs() * 0.001, [a * 0.1, s * 0.1]),
                covered(
                    ab * f64::from(0.01_f32),
                    e(y) * e(c.abs()) * f64::from(0.001_f32),
                    [e(a) * f64::from(0.1_f32), e(s) * f64::from(0.1_f32)],
                ),
            ),
            (single::ramp(a * b), ramp(ab)),
            (
                single::ease((y * b.abs() / 4.0).min(1.0)),
                ease((e(y) * e(b.abs()) / 4.0).clamp(0.0, 1.0)),
            ),
        ];
        for (worst, (found, expected)) in worst.iter_mut().zip(cases) {
            let off = (f64::from(found) - expected.value).abs();
            assert!(expected.error.is_finite());
            assert!(off.is_finite());
            *worst = worst.max(if off == 0.0 { 0.0 } else { off / expected.error });
        }
    }
    println!("operations: {worst:.2?}");
    // The host's functions are more accurate than Vulkan requires.
    let least = [0.5, 0.5, 0.2, 0.2, 0.1, 0.1, 0.2, 0.9, 0.2, 0.5, 0.9, 0.1, 0.3, 0.1];
    for (i, (worst, least)) in worst.into_iter().zip(least).enumerate() {
        assert!(worst <= 1.0 && worst > least, "{i}: {worst}");
    }
}

#[test]
fn half_precision_is_as_the_crate_half_has_it() {
    let same = |v: f32| {
        let (own, other) = (half(f64::from(v)), half::f16::from_f32(v).to_f64());
        assert!(own == other, "{v:e}: {own:e} {other:e}");
    };
    for bits in 0..0x7c00_u16 {
        let v = half::f16::from_bits(bits).to_f32();
        let next = half::f16::from_bits(bits + 1).to_f32();
        let between = if next.is_finite() { (v + next) / 2.0 } else { 65520.0 };
        for v in [v, between, between.next_down(), between.next_up()] {
            same(v);
            same(-v);
        }
    }
}

#[test]
fn levels_are_means_and_a_sample_at_a_centre_is_a_texel() {
    let texture = smooth_noise(64, 3);
    assert_eq!(texture.last(), 6);
    for level in 0..=6_usize {
        let edge = 64 >> level;
        let texels = texture.level(level);
        for (i, texel) in texels.iter().enumerate() {
            let at = [i % edge, i / edge].map(|t| exact((t as f64 + 0.5) / edge as f64));
            let found = texture.sample(at, level);
            for c in 0..4 {
                assert_eq!(found[c].value, texel[c]);
                if level > 0 {
                    let finer = texture.level(level - 1);
                    let first = 2 * (i / edge) * 2 * edge + 2 * (i % edge);
                    let four = [first, first + 1, first + 2 * edge, first + 2 * edge + 1];
                    let mean = four.map(|i| finer[i][c]).into_iter().sum::<f64>() / 4.0;
                    assert!((texel[c] - mean).abs() <= mean.abs() / 2048.0 + 2.0_f64.powi(-25));
                }
            }
        }
    }
    let place = [exact(0.3), exact(0.6)];
    let [a, b] = [0, 1].map(|level| texture.sample(place, level)[0]);
    // The level of detail for a pixel as wide as 2^detail texels of the first level.
    let of = |detail: f64| texture.at(place, 1.0, exact(detail.exp2() / 64.0))[0];
    for (detail, own) in [(-3.0, a), (0.0, a), (0.49, a), (0.51, b), (1.0, b)] {
        assert_eq!(of(detail).value, own.value, "{detail}");
        assert!(of(detail).error < 2.0 * own.error, "{detail}: of one level");
    }
    let tie = of(0.5);
    assert!(a.value != b.value && [a, b].iter().all(|own| tie.holds(own.value)));
    assert_eq!(of(40.0).value, texture.sample(place, 6)[0].value);
}

#[test]
fn sampling_wraps_at_the_edge() {
    let texture = smooth_noise(32, 9);
    let mut r = Random(2);
    for _ in 0..2000 {
        let [u, v] = [0; 2].map(|_| (r.between(0.0, 1.0) * 65536.0).floor() / 65536.0);
        let detail = r.between(0.0, 5.0).round() as usize;
        let [x, y] = [0; 2].map(|_| r.between(-40.0, 40.0).round());
        let here = texture.sample([exact(u), exact(v)], detail);
        let there = texture.sample([exact(u + x), exact(v + y)], detail);
        for c in 0..4 {
            assert!((here[c].value - there[c].value).abs() < 1e-13);
        }
    }
    // The texture is continuous across its seam.
    let [a, b] = [-1e-9, 1e-9].map(|u| texture.sample([exact(u), exact(0.4)], 0));
    assert!((a[0].value - b[0].value).abs() < 1e-6);
}

#[test]
fn a_filter_of_single_precision_is_within_the_bounds() {
    let texture = cells(64, 20, 4);
    let mut r = Random(8);
    let (mut worst, mut mean) = (0.0_f64, 0.0);
    for _ in 0..20_000 {
        let place = [0; 2].map(|_| r.between(-300.0, 300.0));
        let (scale, width) = (r.between(0.01, 0.5), r.between(0.0, 1.0).powi(4) as f32);
        let width = exact(f64::from(width * 20.0));
        let found = {
            let [x, y] = place.map(|p| p as f32 * scale as f32);
            let detail = single::detail(&texture, width.value as f32, scale as f32);
            single::sample(&texture, [x, y], detail)
        };
        let expected = texture.at(place.map(exact), scale, width);
        for c in 0..2 {
            let off = (f64::from(found[c]) - expected[c].value).abs();
            assert!(off <= expected[c].error, "{off:e} {:?}", expected[c]);
            assert!(off.is_finite());
            worst = worst.max(off / expected[c].error);
            mean += expected[c].error / 40_000.0;
        }
    }
    println!("filter: {worst:.2} of the bound, which is {mean:.1e} in the mean");
    assert!(worst > 0.4 && mean < 0.01);
}

#[test]
fn the_water_s_points_and_pixels_are_as_the_view_has_them() {
    // Straight down from a height of 40, all pixels have the same width.
    let down = camera(40.0, PI / 2.0 - 1e-9, 0.3, [64.0, 48.0], 0.5);
    for at in [[0.5, 0.5], [32.0, 24.0], [63.5, 40.5]] {
        let point = down.at(at);
        assert!((point.depth.value - 40.0).abs() < 1e-5);
        assert!((point.width.value - 40.0 / 48.0).abs() < 1e-6);
    }
    let mut r = Random(4);
    let mut worst = [0.0_f64; 3];
    for _ in 0..2000 {
        let size = [640.0, 480.0];
        let (height, tilt) = (r.between(1.0, 60.0), r.between(0.2, 1.5));
        let water = camera(height, tilt, r.between(0.0, TAU), size, r.between(0.2, 0.8));
        let at = [r.between(0.0, 640.0).floor() + 0.5, r.between(0.0, 480.0).floor() + 0.5];
        let point = water.at(at);
        if point.depth.value <= 0.0 || point.depth.value > 500.0 {
            continue;
        }
        // The point lies on the plane, and its changes per pixel are its derivatives.
        let eye = point.ray.map(|r| r.value * point.depth.value);
        let up: f64 = (0..3).map(|i| water.up[i].value * eye[i]).sum::<f64>() + water.up[3].value;
        assert!(up.abs() < 1e-9 * point.depth.value);
        for i in 0..2 {
            let step = |by: f64| {
                let mut at = at;
                at[i] += by;
                water.at(at).place.map(|p| p.value)
            };
            let (ahead, back) = (step(1e-4), step(-1e-4));
            for k in 0..2 {
                let slope = (ahead[k] - back[k]) / 2e-4;
                let off = (slope - point.change[i][k].value).abs();
                assert!(off < 1e-5 * (1.0 + slope.abs()), "{slope} {off}");
            }
        }
        let (depth, place, width) = single::water(&water, at.map(|v| v as f32));
        let pairs = [(depth, point.depth), (place[0], point.place[0]), (width, point.width)];
        for (worst, (found, expected)) in worst.iter_mut().zip(pairs) {
            let off = (f64::from(found) - expected.value).abs();
            assert!(off.is_finite());
            *worst = worst.max(off / expected.error);
        }
    }
    println!("water: {worst:.2?}");
    assert!(worst.iter().all(|w| *w <= 1.0 && *w > 0.05), "{worst:?}");
}

#[test]
fn contact_foam_is_all_at_the_edge_and_none_at_its_depth() {
    for (x, eased) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (0.25, 0.1)] {
        assert_eq!(ease(exact(x)).value, eased);
    }
    for (t, part) in [(-3.0, 0.0), (-1e-9, 0.0), (0.0, 1.0), (0.25, 0.75), (1.0, 0.0), (5.0, 0.0)] {
        assert_eq!(ramp(exact(t)).value, part);
    }
    // If rounding decides whether an object is before or behind the surface, both results are
    // within the bounds.
    let either = ramp(exact(0.01).wider(0.02));
    assert!(either.holds(0.0) && either.holds(1.0));

    let ray = [0.0, 0.0, -1.0].map(exact);
    let up = [0.0, 0.0, 1.0].map(exact);
    for kind in [Measure::Distance, Measure::View, Measure::Vertical] {
        assert_eq!(measure(kind, [exact(2.0), exact(2.3)], ray, up).value, 2.3 - 2.0);
    }
    let slanted = [0.75, 0.0, -1.0].map(exact);
    let depths = [exact(2.0), exact(4.0)];
    let all = [Measure::Distance, Measure::View, Measure::Vertical]
        .map(|kind| measure(kind, depths, slanted, [0.0, 0.6, 0.8].map(exact)).value);
    assert_eq!(all, [2.5, 2.0, 1.6]);

    let look = Contact::new(CLOCK, Measure::Distance, [0.4, 0.8, 0.5, 1.0], [0.05, 0.03]);
    for (pattern, mask) in [(0.0, 0.2), (1.0, 1.0), (7.0, 1.0), (-1.0, 0.2)] {
        assert!((look.mask_of(exact(pattern)).value - mask).abs() < 1e-6);
    }
    let web = cells(32, 6, 3);
    let point = Point {
        ray,
        depth: exact(1.0),
        place: [exact(3.0), exact(-7.0)],
        change: [[0.1, 0.0], [0.0, 0.1]].map(|way| way.map(exact)),
        width: exact(0.1),
    };
    let found = look.masked(&web, &point, [0.0; 2]);
    let uv = [3.0, -7.0].map(|p| p * 0.5 + 12.75 * 0.5 * if p > 0.0 { 0.05 } else { 0.03 });
    // A pixel is 1.6 texels wide.
    let [pattern, _, east, north] = web.sample(uv.map(exact), 1).map(|c| c.value);
    assert!(found.holds(look.mask_of(exact(pattern)).value) && found.error < 0.01);
    // A pixel is a twentieth of a repetition wide.
    let beside = look.masked(&web, &point, [0.5, -0.5]);
    let moved = look.mask_of(exact(pattern + 0.05 * (0.5 * east - 0.5 * north)));
    assert!(beside.holds(moved.value) && (beside.value - found.value).abs() > 1e-3);
    let found = |t: f64| look.amount(exact(t), exact(1.0)).value;
    assert_eq!([0.0, 0.5, 1.0, 9.0].map(found), [1.0, 0.5, 0.0, 0.0]);
    let t = look.part([exact(2.0), exact(2.2)], ray, up);
    assert!((t.value - 0.5).abs() < 1e-6);
}

#[test]
fn nothing_grows_with_the_time_and_a_period_is_one() {
    let (speed, swing, by, period) = (-0.9_f32, 0.35_f32, [2.2_f32, 7.0], 11.0_f32);
    for time in [0.0, 1.0, 1e3, 1e6, 1e9, -1e7] {
        let clock = Clock { time, period: None };
        let phases = clock.phases(speed, swing, by, period);
        assert!((0.0..TAU).contains(&phases.waves.value));
        assert!(phases.local.value.abs() <= f64::from(period) / TAU);
        let offsets = clock.offset(0.3, [3.0, -2.0]).into_iter();
        assert!(
            offsets.chain(clock.moved(1.0, [5.0, -9.0])).all(|o| (0.0..=1.0).contains(&o.value))
        );
        assert!(phases.waves.error <= TAU * U && phases.local.error <= 2.0 * U);
    }
    // After a period everything repeats, exactly if the times are binary fractions.
    for loops in [4.0, 16.0, 64.0] {
        for time in [0.0, 0.375, 2.25, 3.0] {
            let at = |time: f64| {
                let clock = Clock { time, period: Some(loops) };
                let p = clock.phases(speed, swing, by, period);
                let [a, b] = clock.offset(0.3, [3.0, -2.0]);
                let [c, d] = clock.moved(0.25, [5.0, -9.0]);
                [p.waves, p.local, a, b, c, d].map(|b| b.value)
            };
            let first = at(time);
            for n in [1.0, 5.0, 1000.0] {
                for (a, b) in first.into_iter().zip(at(time + n * loops)) {
                    assert_eq!(a, b);
                }
            }
        }
    }
    // The phase is the integral of the speed: it changes by speed times the time between.
    let [a, b] = [20.0, 20.001].map(|time| {
        let clock = Clock { time, period: None };
        clock.phases(speed, swing, by, period)
    });
    let [swing, by, seconds] = [swing, by[0], by[1]].map(f64::from);
    let rate = (1.0 - swing) * f64::from(speed)
        + swing * by * TAU / seconds * (TAU * 20.0005 / seconds).cos();
    let moved = (b.waves.value - a.waves.value + PI).rem_euclid(TAU) - PI;
    assert!((moved / 0.001 - rate).abs() < 1e-5, "{moved} {rate}");
    let local = (b.local.value - a.local.value) / 0.001;
    assert!((local - (TAU * 20.0005 / f64::from(period)).cos()).abs() < 1e-5);
}

#[test]
fn waves_on_a_straight_shore_are_a_sine() {
    let (noise, web) = (smooth_noise(16, 1), cells(16, 4, 1));
    let look = Shoreline {
        wave_rise: [1.5, -1.0],
        threshold: 0.25,
        ..Shoreline::waves(15.0, still(0.5), 0.25)
    };
    for i in 0..=150 {
        let v = 0.25 + 0.01 * f64::from(i);
        for slope in [0.0, 0.02, 0.3] {
            let found = shoreline(&look, &noise, &web, &pixel([3.0, 4.0], v, 0.1, [slope, slope]));
            let kept = (-225.0 * 2.0 * slope * slope / 24.0_f64).exp();
            let over = kept * (15.0 * v + 0.5).sin() + 1.5 * v - 1.0 - 0.25;
            assert!((found.over.value - over).abs() < 1e-12);
            assert!((found.variance.value - 0.5 * (1.0 - kept * kept)).abs() < 1e-12);
            assert!(found.kept.holds(kept) && found.web.value == 0.0);
        }
    }
    // Beyond the ends of v there are no waves, and the floor limits them.
    for v in [-0.5, 0.0, 2.0, 3.0] {
        let found = shoreline(&look, &noise, &web, &pixel([0.0; 2], v, 0.1, [0.0; 2]));
        assert!(found.over.value < 1.5 * v - 2.0);
    }
    let floored = Shoreline { floor: Some(0.0), ..look.clone() };
    let found = shoreline(&floored, &noise, &web, &pixel([0.0; 2], 0.26, 0.1, [0.0; 2]));
    assert_eq!(found.waves.value, 0.0);

    // The fraction of a sine above a threshold is acos(threshold)/π.
    for threshold in [-0.5, 0.0, 0.5, 0.9] {
        let look = Shoreline { threshold, ..Shoreline::waves(TAU * 8.0, still(0.0), 0.001) };
        let near = |i: i32| {
            let at = pixel([0.0; 2], 0.5 + (f64::from(i) + 0.5) / 10_000.0, 1e-3, [0.0; 2]);
            clipped(shoreline(&look, &noise, &web, &at).over)
        };
        let (mut part, mut unsure) = (0.0, 0.0);
        for found in (0..10_000).map(near) {
            part += if found == Some(true) { 1e-4 } else { 0.0 };
            unsure += if found.is_none() { 1e-4 } else { 0.0 };
        }
        let share = threshold.acos() / PI;
        assert!(
            part <= share + 1.6e-3 && share <= part + unsure + 1.6e-3,
            "{part} {unsure} {share}"
        );
        assert!(unsure < 0.01);
        let far = shoreline(&look, &noise, &web, &pixel([0.0; 2], 1.0, 1.0, [1.0, 0.0]));
        let covers = covered(far.over, far.variance, [exact(0.0); 2]);
        assert!((covers.value - (0.5 - threshold / 6.0_f64.sqrt())).abs() < 1e-9);
        assert!((covers.value - share).abs() < 0.1);
    }
}

#[test]
fn an_even_edge_covers_what_is_beyond_it() {
    // A slope along one axis gives the exact fraction; a diagonal slope is treated as if along one
    // axis.
    for (over, change, expected) in [
        (0.0, [0.1, 0.0], 0.5),
        (0.025, [0.1, 0.0], 0.75),
        (-0.2, [0.1, 0.0], 0.0),
        (0.5, [0.3, 0.4], 1.0),
    ] {
        let found = covered(exact(over), exact(0.0), change.map(exact)).value;
        assert!((found - expected).abs() < 1e-12);
    }
    // Each pixel of a block rounds the fraction up or down to a multiple of a quarter; the block's
    // mean is the fraction, to a sixteenth.
    for (part, mean) in [(0.0, 0.0), (0.3, 0.3125), (0.5, 0.5), (0.8, 0.8125), (1.0, 1.0)] {
        let block = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|at| by_samples(exact(part), at).value);
        assert_eq!(block.iter().sum::<f64>() / 4.0, mean, "{part}: {block:?}");
    }
    let reach = [9.0, 3.0];
    for (s, v) in [(-9.0, 0.0), (-4.5, 0.5), (0.0, 1.0), (1.5, 1.5), (3.0, 2.0)] {
        assert_eq!(coordinate(exact(s), reach).value, v);
    }
}

/// Difference between the foam that a pixel claims and the mean of near foam inside the pixel.
#[derive(Debug)]
struct Covers {
    /// Mean over many pixels.
    bias: f64,
    /// Mean absolute difference, and the max.
    mean: f64,
    most: f64,
    /// Mean absolute difference if only the pixel's centre decides.
    clipped: f64,
}

/// `slope`: change of v per scene unit.
fn far_less_near(
    look: &Shoreline,
    (noise, web): (&Texture<4>, &Texture<4>),
    width: f64,
    slope: f64,
) -> Covers {
    let mut r = Random(77);
    let (pixels, side) = (150, 24);
    let mut all = Covers { bias: 0.0, mean: 0.0, most: 0.0, clipped: 0.0 };
    for _ in 0..pixels {
        let middle = [0; 2].map(|_| r.between(-500.0, 500.0));
        let v = r.between(0.4, 1.6);
        // In pixels from the centre.
        let at = |x: f64, y: f64, width_there: f64, dv: f64| {
            let place = [middle[0] + x * width, middle[1] + y * width];
            let there = pixel(place, v + slope * y * width, width_there, [0.0, dv]);
            shoreline(look, noise, web, &there)
        };
        let near = |x: f64, y: f64| f64::from(at(x, y, 1e-4, 0.0).over.value >= 0.0);
        let here = at(0.0, 0.0, width, slope * width);
        let said = covered(here.over, here.variance, here.change).value;
        let mut inside = 0.0;
        for i in 0..side * side {
            let [x, y] = [i % side, i / side]
                .map(|cell| (f64::from(cell) + r.between(0.0, 1.0)) / f64::from(side) - 0.5);
            inside += near(x, y) / f64::from(side * side);
        }
        let count = f64::from(pixels);
        all.bias += (said - inside) / count;
        all.mean += (said - inside).abs() / count;
        all.most = all.most.max((said - inside).abs());
        all.clipped += (near(0.0, 0.0) - inside).abs() / count;
    }
    all
}

#[test]
fn far_foam_covers_what_near_foam_does() {
    let (noise, web) = (smooth_noise(64, 11), cells(128, 30, 12));
    let own = island(CLOCK);
    let waves = Shoreline { texture_weight: 0.0, wave_weight: 1.0, ..own.clone() };
    let web_alone = Shoreline { texture_weight: 1.0, wave_weight: 0.0, ..own.clone() };
    let only_web = Shoreline { web_rise: [0.25, -0.25], threshold: 0.5, ..web_alone };
    // A shore so wide that v changes little in a pixel, while waves some scene units long and the
    // texture change much.
    let short = |look: &Shoreline| Shoreline { frequency: 150.0, ..look.clone() };
    // Bounds for the bias, the mean and the max. The uniform distribution that `covered` assumes is
    // not exact: a sine is more often near its ends. The bias is a mean of 150 pixels: three
    // standard errors are a quarter of the mean difference. The texture's level of detail is a box
    // up to √2 wider or narrower than a pixel; for a pixel of width 6 it is 1.3 times as wide
    // for one layer.
    for (name, look, width, bounds) in [
        ("waves", short(&waves), 6.0, [0.01, 0.06, 0.2]),
        ("web", only_web.clone(), 6.0, [0.01, 0.065, 0.24]),
        ("web", only_web, 16.0, [0.01, 0.05, 0.13]),
        ("both", short(&own), 2.0, [0.02, 0.06, 0.26]),
        ("both", short(&own), 6.0, [0.01, 0.05, 0.16]),
        ("both", short(&own), 16.0, [0.01, 0.02, 0.07]),
    ] {
        let found = far_less_near(&look, (&noise, &web), width, 1.0 / 90.0);
        println!("{name}, {width} m: {found:.3?}");
        let Covers { bias, mean, most, clipped } = found;
        assert!(bias.abs() < bounds[0] && mean < bounds[1] && most < bounds[2]);
        assert!(clipped > 1.9 * mean);
    }
}

#[test]
fn shoreline_foam_of_single_precision_is_within_the_bounds() {
    let (noise_map, web) = (smooth_noise(64, 21), cells(128, 30, 22));
    let mut r = Random(31);
    let mut worst = [0.0_f64; 5];
    let (mut bound, mut count) = (0.0, 0.0);
    let (mut covers_error, mut edges) = (0.0, 0.0);
    for i in 0..12_000 {
        let clock = Clock { time: r.between(0.0, 1e4), period: (i % 2 == 0).then_some(40.0) };
        let mut look = island(clock);
        if i % 3 == 0 {
            look.warp = noise(1.5, 1.0 / 40.0);
            look.floor = Some(-0.25);
        }
        if i % 5 == 0 {
            look.layers.push(layer(clock, 0.25, 0.4, -110.0, [0.3, 0.0]));
        }
        let width = 2.0_f64.powf(r.between(-8.0, 4.0)) as f32;
        let place = [0; 2].map(|_| r.between(-200.0, 200.0));
        let (v, slope) = (r.between(-0.1, 2.1), f64::from(width) / 9.0);
        let turn = r.between(0.0, TAU);
        let dv = [turn.cos() * slope, turn.sin() * slope].map(|v| f64::from(v as f32));
        // Every second pixel uses values shared by a pair.
        let off = [[0.0; 2], [0.5, -0.5]][i / 2 % 2];
        let own = Pixel { off, ..pixel(place, v, f64::from(width), dv) };
        let expected = shoreline(&look, &noise_map, &web, &own);
        let by = r.between(-1.0, 1.0) as f32;
        let at = single::Pixel {
            off: off.map(|v| v as f32),
            place: place.map(|p| p as f32),
            v: v as f32,
            across: [[width, 0.0], [0.0, width]],
            dv: dv.map(|v| v as f32),
        };
        let (over, variance, change) = single::shoreline(&look, &noise_map, &web, &at, by);
        let covers = single::covered(over, variance, change);
        let covers_bounds = covered(expected.over, expected.variance, expected.change);
        let pairs = [
            (over, expected.over),
            (variance, expected.variance),
            (covers, covers_bounds),
            (change[0], expected.change[0]),
            (change[1], expected.change[1]),
        ];
        for (worst, (found, expected)) in worst.iter_mut().zip(pairs) {
            let off = (f64::from(found) - expected.value).abs();
            assert!(off.is_finite());
            *worst = worst.max(if off == 0.0 { 0.0 } else { off / expected.error });
        }
        let part = covers_bounds.value;
        if (0.1..0.9).contains(&part) {
            covers_error += covers_bounds.error;
            edges += 1.0;
        }
        bound += expected.over.error;
        count += 1.0;
    }
    let (bound, covers_error) = (bound / count, covers_error / edges);
    println!("shoreline: {worst:.2?} of bounds; over's {bound:.1e}, edges' {covers_error:.1e}");
    assert!(worst.iter().all(|w| *w <= 1.0 && *w > 0.3), "{worst:?}");
    assert!(bound < 0.003 && covers_error < 0.01);
}

/// A grid of heights.
fn heights(size: usize, h: impl Fn(DVec2) -> f64) -> Heights {
    let texel = |i: usize| h(DVec2::new((i % size) as f64 + 0.5, (i / size) as f64 + 0.5)) as f32;
    Heights::new(size, size, 0.0, &(0..size * size).map(texel).collect::<Vec<_>>())
}

fn signed(size: usize, s: impl Fn(DVec2) -> f64) -> Vec<f64> {
    (0..size * size)
        .map(|i| s(DVec2::new((i % size) as f64 + 0.5, (i / size) as f64 + 0.5)))
        .collect()
}

fn map_of(heights: &Heights) -> Option<Map> {
    heights.map(&heights.seeds(), 1.0)
}

fn values(map: &Map) -> impl Iterator<Item = f64> {
    map.values.iter().map(|v| v.value)
}

#[test]
fn a_half_plane_s_map_is_linear() {
    let size = 128;
    let mut worst = [0.0_f64; 3];
    for i in 0..40 {
        let turn = DVec2::from_angle(f64::from(i) * 0.317);
        let from = DVec2::new(61.3, 66.9);
        let plane = |p: DVec2| 0.37 * turn.dot(p - from);
        let heights = heights(size, plane);
        let map = map_of(&heights).expect("a shore");
        let expected = signed(size, |p| turn.dot(p - from));
        // Only texels whose nearest point of the line lies in the grid; the map does not know the
        // line outside.
        let inner: Vec<_> = (0..size * size)
            .filter(|i| {
                let p = DVec2::new((i % size) as f64 + 0.5, (i / size) as f64 + 0.5);
                let foot = p - turn * expected[*i];
                foot.min_element() > 1.0 && foot.max_element() < size as f64 - 1.0
            })
            .collect();
        let of = |values: &[f64]| inner.iter().map(|i| values[*i]).collect::<Vec<_>>();
        let expected = of(&expected);
        let found = difference(of(&values(&map).collect::<Vec<_>>()), &expected);
        let by_line = difference(of(&Shore::new(&heights).distances(&heights, 1.0)), &expected);
        worst = [worst[0].max(found.most), worst[1].max(found.mean), worst[2].max(by_line.most)];
    }
    println!(
        "half planes, texels: map {:.4} at most, {:.4} in the mean; line {:.1e}",
        worst[0], worst[1], worst[2]
    );
    assert!(worst[0] < 0.045 && worst[1] < 0.025 && worst[2] < 1e-6);
}

#[test]
fn a_circle_s_map_is_its_distance() {
    let size = 256;
    // Bounds of map to circle, of map to line and of line to circle, which differ because heights
    // are not linear between texel centres.
    for (radius, middle, bounds) in [
        (80.0, DVec2::new(127.3, 129.6), [0.05, 0.045, 0.004]),
        (12.0, DVec2::new(100.2, 90.7), [0.06, 0.07, 0.022]),
        (2.5, DVec2::new(128.4, 127.7), [0.16, 0.21, 0.1]),
    ] {
        let circle = |p: DVec2| radius - p.distance(middle);
        let heights = heights(size, |p| 0.3 * circle(p));
        let map = map_of(&heights).expect("a shore");
        let shore = Shore::new(&heights);
        let exact_line = shore.distances(&heights, 1.0);
        let expected = signed(size, circle);
        let found = difference(values(&map), &expected);
        let to_line = difference(values(&map), &exact_line);
        let by_line = difference(exact_line.iter().copied(), &expected);
        println!(
            "circle of {radius}: to the circle {found:.4?}, to the line {to_line:.4?}, the line's {by_line:.4?}"
        );
        let most = [found.most, to_line.most, by_line.most];
        assert!(most.iter().zip(bounds).all(|(most, bound)| *most < bound), "{most:?}");
    }
}

/// Islands: a sum of waves with decreasing height, the shortest `shortest` texels long, that falls
/// off towards the grid's edge.
fn islands(size: usize, shortest: f64, seed: u64) -> Heights {
    let mut r = Random(seed);
    let growth = (size as f64 / shortest / 1.5).powf(1.0 / 59.0);
    let waves: Vec<_> = (0..60)
        .map(|i| {
            let k = 1.5 * growth.powi(i);
            (DVec2::from_angle(r.between(0.0, TAU)) * k * TAU, r.between(0.0, TAU), 1.0 / k)
        })
        .collect();
    heights(size, |p| {
        let p = p / size as f64 - 0.5;
        let rough: f64 = waves.iter().map(|(k, phase, h)| h * (k.dot(p) + phase).sin()).sum();
        3.0 + rough * 3.0 - 60.0 * p.length_squared()
    })
}

#[test]
fn an_island_s_map_is_the_distance_to_its_line() {
    // Seeds' segments reach half a texel beyond the ends of the line, and beyond the grid's edge.
    for (shortest, bounds) in [(24.0, [0.5, 0.035]), (5.5, [0.55, 0.09])] {
        for seed in [3, 4, 5] {
            let heights = islands(256, shortest, seed);
            let map = map_of(&heights).expect("a shore");
            let shore = Shore::new(&heights);
            let line = shore.distances(&heights, 1.0);
            let all = difference(values(&map), &line);
            assert!(all.most < bounds[0] && all.mean < bounds[1]);
            println!("waves from {shortest}: {} segments, {all:.4?}", shore.segments.len());
            let mut r = Random(seed);
            for _ in 0..300 {
                let p = DVec2::new(r.between(0.0, 256.0), r.between(0.0, 256.0));
                assert_eq!(shore.distance(p), shore.distance_by_all(p));
            }
        }
    }
}

#[test]
fn a_map_in_single_precision_is_within_the_bounds() {
    let heights = islands(96, 6.0, 8);
    let mut r = Random(6);
    let (mut worst, mut bound) = (0.0_f64, 0.0_f64);
    for i in 0..96 * 96 {
        let (x, y) = (i % 96, i / 96);
        let by = r.between(-4.0 * U, 4.0 * U) as f32;
        if let Some(seed) = single::seed(&heights, x, y, by) {
            assert!(heights.may_be(x, y).contains(&seed));
            let (x, y) = [r.between(0.0, 95.0), r.between(0.0, 95.0)].map(|v| v as usize).into();
            let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let expected = heights.apart(at, seed);
            let off = (f64::from(single::apart(&heights, x, y, seed)) - expected.value).abs();
            assert!(off.is_finite());
            worst = worst.max(off / expected.error);
            bound = bound.max(expected.error);
        }
    }
    println!("segments: {worst:.2} of the bounds, at most {bound:.1e} texels");
    assert!(worst <= 1.0 && worst > 0.05 && bound < 0.01);
}

#[test]
fn a_map_is_linear_between_centres_and_ends_at_its_edge() {
    let heights = islands(64, 12.0, 2);
    let map = heights.map(&heights.seeds(), 0.5).expect("a shore");
    let at = |x: f64, y: f64| map.at([exact(x), exact(y)], true);
    let value = |x: usize, y: usize| map.values[y * 64 + x].value;
    assert_eq!(at(10.5, 20.5).value, value(10, 20));
    let quarter = 0.75 * value(10, 20) + 0.25 * value(11, 20);
    assert!((at(10.75, 20.5).value - quarter).abs() < 1e-12);
    assert_eq!(at(0.1, 20.5).value, value(0, 20));
    for (x, inside) in [(0.75, Some(true)), (0.25, Some(false)), (63.75, Some(false))] {
        assert_eq!(map.inside([exact(x), exact(20.0)]), inside);
    }
    assert_eq!(map.inside([exact(63.5).wider(0.01), exact(20.0)]), None);
    let texels = Map::texels([exact(3.0), exact(-2.0)], [-1.0, -4.0], 0.5);
    assert_eq!(texels.map(|t| t.value), [8.0, 4.0]);
    // An uncertain position gives a distance uncertain by the slope, which is at most about 1.
    let off = map.at([exact(30.3).wider(1.5), exact(30.3)], false);
    assert!(off.error > 0.3 && off.error < 1.5);
}

#[test]
fn the_nearest_seed_is_that_of_all() {
    let heights = islands(96, 6.0, 8);
    let seeds = heights.seeds();
    let map = heights.map(&seeds, 0.5).expect("a shore");
    let mut ties = 0;
    for i in 0..96 * 96 {
        let (x, y) = (i % 96, i / 96);
        let (_, all) = heights.nearest(&seeds, x, y).expect("a shore");
        ties += usize::from(all.len() > 1);
        let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let sign = if heights.land(x, y) { 0.5 } else { -0.5 };
        let distances = all.iter().map(|s| sign * heights.apart(at, *s).value);
        assert!(distances.clone().any(|d| d == map.values[i].value));
        assert!(distances.into_iter().all(|d| map.values[i].holds(d)));
        if let Some(seed) = seeds[i] {
            let may = heights.may_be(x, y);
            assert!(may.contains(&seed) && may.len() <= 8);
        }
        assert_eq!(seeds[i].is_some(), !heights.may_be(x, y).is_empty());
    }
    assert!(ties > 0);
    let flat = Heights::new(8, 8, 1.0, &[1.0; 64]);
    assert!(map_of(&flat).is_none(), "no shore");
}
