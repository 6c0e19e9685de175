//! Bubble foam after changes of a renderer's size and configuration.

use whitewater::bubbles::{BubbleConfig, BubbleSort, Film, Impostor};

use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::Lens;
use crate::support::{compare, slow};

use super::impostor::heap;

fn shot(width: u32, height: u32) -> Shot {
    let mut shot = Shot::new(extent(width, height), Lens::Standard, 0.1, &[]);
    shot.blobs = heap(&shot, 30);
    shot
}

fn same(name: &str, rig: &mut Rig<'_>, fresh: &mut Rig<'_>, shot: &Shot) {
    let (found, expected) = (rig.draw(shot), fresh.draw(shot));
    assert_ne!(expected.output.data, shot.color, "{name}: something is drawn");
    compare::same_color(name, &found.output, &expected.output);
    let [found, expected] = [found, expected].map(|drawn| drawn.soap.expect("bubble foam"));
    assert_eq!(found.layers, expected.layers, "{name}");
    assert_eq!(found.film.data, expected.film.data, "{name}");
}

#[test]
fn a_resize_gives_what_a_new_renderer_gives() {
    let gpu = Gpu::shared();
    let bubbles = BubbleConfig::new(64).with(|it| {
        it.variants = 2;
        it.bubbles = 32;
        it.map_size = 64;
    });
    for sort in [BubbleSort::Tiles, BubbleSort::Peel] {
        let of =
            |size| config(size).with(|it| it.bubbles = Some(bubbles.with(|it| it.sort = sort)));
        let mut rig = Rig::lit(&gpu, &of(extent(96, 64)), 1);
        for (width, height) in [(33, 17), (120, 90)] {
            let shot = shot(width, height);
            rig.resize(shot.size);
            let mut fresh = Rig::lit(&gpu, &of(shot.size), 1);
            same(&format!("bubbles-{width}-{sort:?}"), &mut rig, &mut fresh, &shot);
        }
    }
}

/// Templates and tables are made again only if they change, and the host is told so.
#[test]
fn a_reconfiguration_gives_what_a_new_renderer_gives() {
    let gpu = Gpu::shared();
    let shot = shot(64, 48);
    let base = BubbleConfig::new(64).with(|it| {
        it.variants = 2;
        it.bubbles = 32;
        it.map_size = 64;
    });
    let distance = Impostor::Distance;
    let film = |index| Film { index, ..Film::default() };
    let of = |bubbles| config(shot.size).with(|it| it.bubbles = bubbles);
    let goes = [
        ("layers", false, base.with(|it| it.layers = 5)),
        ("sort", false, base.with(|it| it.sort = BubbleSort::Peel)),
        ("count", false, base.with(|it| it.max_blobs = 1000)),
        ("steps", false, base.with(|it| it.steps = 4)),
        ("film", true, base.with(|it| it.film = film(1.8))),
        (
            "seed",
            true,
            base.with(|it| {
                it.seed = 5;
                it.film = film(1.8);
            }),
        ),
        (
            "templates",
            true,
            base.with(|it| {
                it.variants = 3;
                it.seed = 5;
                it.film = film(1.8);
            }),
        ),
        ("map", true, base.with(|it| it.map_size = 32)),
        (
            "impostor",
            true,
            base.with(|it| {
                it.impostor = distance;
                it.map_size = 32;
                it.steps = 20;
            }),
        ),
        ("none", false, base),
        ("again", true, base),
    ];
    let mut rig = Rig::lit(&gpu, &of(Some(base)), 1);
    // Each case needs two renderers, so the normal test takes only some.
    let few = ["layers", "film", "none", "again"];
    for (name, anew, bubbles) in goes {
        if !slow() && !few.contains(&name) {
            continue;
        }
        let config = of((name != "none").then_some(bubbles));
        assert_eq!(rig.renderer().reconfigure(&config).expect("reconfigure"), anew, "{name}");
        rig.config = config;
        if anew {
            rig.set_up();
            rig.light();
        }
        if config.bubbles.is_some() {
            let mut fresh = Rig::lit(&gpu, &config, 1);
            same(&format!("bubbles-{name}"), &mut rig, &mut fresh, &shot);
        }
    }
}
