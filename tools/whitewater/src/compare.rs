//! `whitewater compare`: the difference of two pictures, channel by channel.

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, FlipPool, flip};
use whitewater::io::picture::{self, Layers};

use crate::args::CompareArgs;
use crate::failure::{Failure, Kind, Outcome};
use crate::out;

pub fn run(args: &CompareArgs) -> Outcome<()> {
    let (a, b) = (picture::read(&args.a)?, picture::read(&args.b)?);
    if (a.width, a.height) != (b.width, b.height) {
        return Err(Failure::new(
            Kind::Partly,
            format!(
                "expected two pictures of one size, found {}x{} and {}x{}; draw one again",
                a.width, a.height, b.width, b.height
            ),
        ));
    }
    let worst = if args.flip { compare_flip(&a, &b)? } else { compare_channels(a, b)? };
    // NaN differs from everything.
    if worst <= args.tolerance {
        return Ok(());
    }
    let what = if args.flip { "mean FLIP" } else { "RMSE" };
    Err(Failure::new(
        Kind::Partly,
        format!("the pictures differ: {what} {worst:.6} is above the tolerance {}", args.tolerance),
    ))
}

fn compare_channels(mut a: Layers, mut b: Layers) -> Outcome<f32> {
    if a.encoding != b.encoding {
        // If one picture is a PNG and the other holds linear light, both are compared as a screen displays them.
        for layers in [&mut a, &mut b] {
            let rgb = layers.display(0.0).ok_or_else(no_color)?;
            layers.channels.clear();
            let (width, height) = (layers.width, layers.height);
            for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
                layers.push(name, width, height, rgb.iter().map(|p| p[c]).collect())?;
            }
        }
    }
    say(format_args!("{:<28} {:>12} {:>12}\n", "channel", "RMSE", "largest"))?;
    let mut worst = 0.0_f32;
    for channel in &a.channels {
        let Some(other) = b.channel(&channel.name) else {
            say(format_args!("{:<28} only in the first\n", channel.name))?;
            worst = f32::INFINITY;
            continue;
        };
        let (mut sum, mut largest) = (0.0_f64, 0.0_f32);
        for (x, y) in channel.data.iter().zip(other) {
            // Equal infinities and NaN in both places are no difference.
            let d = if x == y || (x.is_nan() && y.is_nan()) { 0.0 } else { (x - y).abs() };
            sum += f64::from(d) * f64::from(d);
            largest = if d.is_nan() { f32::INFINITY } else { largest.max(d) };
        }
        let rmse = (sum / channel.data.len().max(1) as f64).sqrt() as f32;
        say(format_args!("{:<28} {rmse:>12.6} {largest:>12.6}\n", channel.name))?;
        worst = if rmse.is_nan() { f32::INFINITY } else { worst.max(rmse) };
    }
    for channel in b.channels.iter().filter(|c| a.channel(&c.name).is_none()) {
        say(format_args!("{:<28} only in the second\n", channel.name))?;
        worst = f32::INFINITY;
    }
    Ok(worst)
}

fn compare_flip(a: &Layers, b: &Layers) -> Outcome<f32> {
    let image = |layers: &Layers| -> Outcome<FlipImageRgb8> {
        let rgb = layers.display(0.0).ok_or_else(no_color)?;
        let bytes: Vec<u8> =
            rgb.iter().flatten().map(|v| (v * 255.0).round().clamp(0.0, 255.0) as u8).collect();
        Ok(FlipImageRgb8::with_data(layers.width as u32, layers.height as u32, &bytes))
    };
    let error = flip(image(a)?, image(b)?, DEFAULT_PIXELS_PER_DEGREE);
    let pool = FlipPool::from_image(&error);
    say(format_args!("mean FLIP {:.6}, largest {:.6}\n", pool.mean(), pool.max_value()))?;
    Ok(pool.mean())
}

/// If the reader of standard output is gone, the verdict stays the same.
fn say(text: std::fmt::Arguments<'_>) -> Outcome<()> {
    match out::print(text) {
        Err(failure) if failure.kind == Kind::Closed => Ok(()),
        other => other,
    }
}

fn no_color() -> Failure {
    Failure::input("expected pictures with channels R, G and B, found one without; name others")
}
