//! Temporal stability of foam: on drifting water, and in a simulation if `WHITEWATER_DATA` names the folder of public
//! caches.

use std::path::PathBuf;

use whitewater::io::picture::{EMPTY, Layers};

use super::skipped::skipped;
use super::support::{Folder, SPACING};

const WIDTH: usize = 320;
const HEIGHT: usize = 180;

fn display(v: f32) -> f32 {
    let v = v.clamp(0.0, 1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

/// Bilinear sample between pixel centres.
fn bilinear(data: &[f32], x: f32, y: f32) -> f32 {
    let at = |x: f32, y: f32| {
        let x = x.clamp(0.0, WIDTH as f32 - 1.0) as usize;
        let y = y.clamp(0.0, HEIGHT as f32 - 1.0) as usize;
        data[y * WIDTH + x]
    };
    let (i, j) = (x.floor(), y.floor());
    let (u, v) = (x - i, y - j);
    let row = |y: f32| at(i, y) * (1.0 - u) + at(i + 1.0, y) * u;
    row(j) * (1.0 - v) + row(j + 1.0) * v
}

/// Mean changes of foam since the previous frame, in thickness and in the displayed picture: after the previous frame
/// was moved by the motion vectors, and without moving it.
fn changes(now: &Layers, before: &Layers) -> ([f32; 4], usize) {
    let channel = |of: &Layers, name: &str| of.channel(name).unwrap().to_vec();
    let [x_by, y_by] = ["motion.X", "motion.Y"].map(|name| channel(now, name));
    let foam = [now, before].map(|of| channel(of, "surface_foam.Z"));
    let thickness = [now, before].map(|of| channel(of, "surface_foam.thickness"));
    let colors = ["R", "G", "B"].map(|name| {
        [now, before].map(|of| channel(of, name).into_iter().map(display).collect::<Vec<_>>())
    });
    let (mut sums, mut count) = ([0.0; 4], 0);
    for i in 0..WIDTH * HEIGHT {
        let (x, y) = ((i % WIDTH) as f32, (i / WIDTH) as f32);
        let from = (x - x_by[i], y - y_by[i]);
        let there = from.1.round().clamp(0.0, HEIGHT as f32 - 1.0) as usize * WIDTH
            + from.0.round().clamp(0.0, WIDTH as f32 - 1.0) as usize;
        if foam[0][i] >= EMPTY || foam[1][there] >= EMPTY || foam[1][i] >= EMPTY {
            continue;
        }
        count += 1;
        for (n, (x, y)) in [from, (x, y)].into_iter().enumerate() {
            sums[2 * n] += (thickness[0][i] - bilinear(&thickness[1], x, y)).abs();
            let off = colors.iter().map(|[now, before]| (now[i] - bilinear(before, x, y)).abs());
            sums[2 * n + 1] += off.fold(0.0, f32::max);
        }
    }
    (sums.map(|sum| sum / count.max(1) as f32), count)
}

/// Motion explains most of the change of foam, and no frame stands out.
#[test]
fn foam_of_a_simulation_does_not_flicker() {
    let Some(data) = std::env::var_os("WHITEWATER_DATA").map(PathBuf::from) else {
        skipped("WHITEWATER_DATA is not set");
        return;
    };
    if std::env::var_os("WHITEWATER_SLOW").is_none_or(|slow| slow != "1") {
        skipped(
            "twelve frames of foam with those before them take long: WHITEWATER_SLOW=1 has them",
        );
        return;
    }
    let cache = data.join("double_dam_pillar");
    let files = format!("{}/ParticleData_Fluid_*.bgeo", cache.display());
    let folder = Folder::new();
    let spray =
        "[spray]\nall_spray_density = 0.6\nfull_water_density = 0.7\nno_spray_density = 0.85\n";
    // Droplets at an instant have no motion blur, and are no foam.
    let streaks = "[spray]\nexposure = 0.0167\n";
    folder.text(
        "speed.toml",
        &format!("{RELIEF}{WHITE}by = 'speed'\n{spray}exposure = 0.0167\n{STRAIGHT}"),
    );
    // A uniform set, because its static details behind the holes of foam are not foam either.
    let view = "--eye 2.871,2.567,5.094 --target 0.193,1.177,0.058 --set studio";
    let told = does_not_flicker(&folder, &format!("{files} --settings speed.toml {view}"), 0.85);
    // With the default foam, whose threads are thinner, motion leaves no more of the change either.
    folder.text("straight.toml", &format!("{STRAIGHT}{streaks}"));
    let usual = format!("{files} --settings straight.toml --set studio --overwrite");
    for (usual, told) in does_not_flicker(&folder, &usual, 0.9).iter().zip(&told) {
        assert!(usual < told, "{usual} of the picture, {told}");
    }
}

/// Keeps the background behind the foam still. With two refractions, or with ellipsoids that turn, it would move by
/// other laws than the foam does.
const STRAIGHT: &str = "[water]\nexit = 'straight'\nkernels = 'spheres'\n";

/// Just enough relief to detect a change, and threads that are wide enough: the test is about the motion of foam, not
/// its look.
const RELIEF: &str = "[surface_foam]\nnormal_strength = 0.35\n";
const WHITE: &str = "back_color = [0.78, 0.78, 0.78]\nfront_extinction = 10.0\nlace_size = 2.5\n";

/// A slab of water, all foam, that drifts past at four metres a second: its foam drifts with it.
#[test]
fn foam_of_water_that_drifts_does_not_flicker() {
    const VELOCITY: [f32; 3] = [4.0, 0.0, -1.0];
    let folder = Folder::new();
    for frame in 48..=57_i16 {
        let seconds = f32::from(frame - 54) / 50.0;
        let [vx, vy, vz] = VELOCITY;
        let mut rows = String::from("x,y,z,vx,vy,vz,id\n");
        for i in 0..24 * 24 * 4_i16 {
            let [x, y, z] = [i % 24, i / 576, i / 24 % 24].map(|c| SPACING * f32::from(c));
            let (x, z) = (x - 1.15 + seconds * vx, z - 1.15 + seconds * vz);
            rows += &format!("{x},{y},{z},{vx},{vy},{vz},{i}\n");
        }
        folder.text(&format!("drifts_{frame}.csv"), &rows);
    }
    folder.text("look.toml", RELIEF);
    let view = "--eye 0,2.4,2 --target 0,0.2,0 --radius 0.05 --surface-foam 1 --scene ground";
    does_not_flicker(&folder, &format!("drifts_*.csv {view} --settings look.toml"), 0.85);
}

/// Draws frames 52 to 57 at 50 frames per second. Fails if the change between motion-compensated frames, relative to
/// the uncompensated change, is `most` or more. Returns the remaining change of each frame.
fn does_not_flicker(folder: &Folder, what: &str, most: f32) -> Vec<f32> {
    folder
        .run(&format!(
            "render {what} -o a_%d.exr --size {WIDTH}x{HEIGHT} --fps 50 --frames 52-57 \
             --layers motion,surface_foam,surface_foam.thickness"
        ))
        .ok();
    let frames: Vec<_> = (52..=57).map(|n| folder.picture(&format!("a_{n}.exr"))).collect();
    let all: Vec<_> = frames.windows(2).map(|pair| changes(&pair[1], &pair[0])).collect();
    for (n, (found, count)) in all.iter().enumerate() {
        let [thickness, color, thickness_there, color_there] = found;
        println!(
            "frame {}: {count} pixels; thickness {thickness:.4} m, without vectors {thickness_there:.4}; \
             picture {color:.4}, without vectors {color_there:.4}",
            53 + n
        );
    }
    for (n, (found, count)) in all.iter().enumerate() {
        assert!(*count > 2000, "frame {}: {count} pixels of foam", 53 + n);
        let [thickness, color, thickness_there, color_there] = *found;
        // Measured: 0.57 to 0.7 of the picture's change remains. For the thickness it is 0.81 to 1.03, because its
        // sprites are as small as its texels here, and because foam also forms and decays.
        let moved = thickness < 1.15 * thickness_there && color < most * color_there;
        assert!(moved, "frame {}: {found:?}", 53 + n);
        // Median of the neighbouring frames, without the frame itself.
        let near = n.saturating_sub(2)..(n + 3).min(all.len());
        for i in 0..2 {
            let mut beside: Vec<_> =
                near.clone().filter(|m| *m != n).map(|m| all[m].0[i]).collect();
            beside.sort_by(f32::total_cmp);
            let median = beside[beside.len() / 2];
            assert!(found[i] <= 3.0 * median, "frame {} stands out: {found:?}, {median}", 53 + n);
        }
    }
    all.iter().map(|(found, _)| found[1]).collect()
}
