//! The host's frame in every configuration, with every optional feature that the device offers: each gives the same
//! picture without validation messages, and a configuration that needs more gives an error.

#[allow(dead_code)] // its `main`
#[path = "../src/main.rs"]
mod host;
#[path = "../../../tests/support/skipped.rs"]
mod skipped;

use host::{Picture, draw, take_messages};
use whitewater::water::{Exit, Gate, Smoothing, Splat};
use whitewater::{Config, Error};

/// A single test, because the layer's messages are global to the process.
#[test]
fn all_forms_draw_the_same() {
    let validate = match draw(true, |_| ()) {
        Ok(_) => true,
        Err(error) => {
            let required = std::env::var("WHITEWATER_REQUIRE_VALIDATION").is_ok_and(|v| v == "1");
            let absent = error.to_string().contains("ERROR_LAYER_NOT_PRESENT");
            assert!(absent && !required, "{error}");
            skipped::skipped("validation: VK_LAYER_KHRONOS_validation is not installed");
            false
        }
    };
    let picture = |name: &str, exit: Exit, adjust: &dyn Fn(&mut Config)| -> Picture {
        let adjusted = |config: &mut Config| {
            config.exit = exit;
            adjust(config);
        };
        let (pixels, _) = draw(validate, adjusted).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(take_messages(), Vec::<String>::new(), "{name}");
        pixels
    };

    let exits = [Exit::TwoInterfaces, Exit::Straight];
    let expected = exits.map(|exit| picture("the defaults", exit, &|_| ()));
    for splat in [Splat::Compute, Splat::Raster] {
        for smoothing in [Smoothing::Tiles, Smoothing::Fused, Smoothing::Query(Gate::VertexCull)] {
            let name = format!("{splat:?}, {smoothing:?}");
            for (exit, expected) in exits.into_iter().zip(&expected) {
                let drawn = picture(&name, exit, &|config| {
                    config.depth_splat = Some(splat);
                    config.thickness_splat = Some(splat);
                    config.smoothing = Some(smoothing);
                });
                let (mean, most) = difference(expected, &drawn);
                println!("{name}, {exit:?}: mean difference {mean:.6}, largest {most:.4}");
                // A ray that refracts twice may hit or miss, so rounding can change a pixel or two.
                let near = most < 0.02 || exit == Exit::TwoInterfaces;
                assert!(mean < 1e-4 && near, "{name}, {exit:?}: mean {mean}, largest {most}");
            }
        }
    }

    for (gate, lacks) in
        [(Gate::DrawCount, "drawIndirectCount"), (Gate::Predicate, "VK_EXT_conditional_rendering")]
    {
        let adjust = |config: &mut Config| config.smoothing = Some(Smoothing::Query(gate));
        // The host enables all features that the device offers; on a device without the needed one the configuration is
        // refused.
        match draw(validate, adjust) {
            Ok((pixels, _)) => {
                let (mean, _) = difference(&expected[0], &pixels);
                assert!(mean < 1e-4, "{gate:?}: mean {mean}");
            }
            Err(error) => match error.downcast_ref() {
                Some(Error::Missing { what, .. }) => assert!(what.contains(lacks), "{what}"),
                _ => panic!("{gate:?}: {error}"),
            },
        }
    }
    assert_eq!(take_messages(), Vec::<String>::new());
}

/// Mean and largest difference of the colours, after the tone map x / (1 + x).
fn difference(a: &Picture, b: &Picture) -> (f32, f32) {
    let mapped = |half: u16| {
        let linear = f32::from_bits(u32::from(half & 0x7fff) << 13) * 2f32.powi(112);
        linear / (1.0 + linear)
    };
    let (mut sum, mut most, mut count) = (0.0, 0.0f32, 0.0);
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        let difference = (mapped(*a) - mapped(*b)).abs();
        sum += f64::from(difference);
        most = most.max(difference);
        count += 1.0;
    }
    ((sum / count) as f32, most)
}
