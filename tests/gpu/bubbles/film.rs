//! Compares the film's table with a sum of all reflections inside a film, and this sum with known
//! properties of films.

use whitewater::bubbles::{BubbleConfig, Film, FilmFresnel, Spectrum};

use crate::reference::bubbles::film::{self as twin, Face};
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::Lens;
use crate::support::tolerance::U;

const INDEX: f64 = 1.4;

#[test]
fn a_film_that_is_nothing_reflects_nothing() {
    for face in [Face::Exact, Face::Schlick, Face::Source] {
        for cosine in [0.05, 0.5, 1.0] {
            assert!(twin::reflectance(cosine, INDEX, 0.0, 550.0, face).abs() < 1e-15);
        }
    }
}

#[test]
fn light_of_four_times_the_films_path_is_reflected_most() {
    let at = |d| twin::reflectance(1.0, INDEX, d, 550.0, Face::Exact);
    let quarter = 550.0 / (4.0 * INDEX);
    // 4 R / (1 + R)^2, with R the reflectance of one face.
    let face: f64 = ((INDEX - 1.0) / (INDEX + 1.0)).powi(2);
    assert!((at(quarter) - 4.0 * face / (1.0 + face).powi(2)).abs() < 1e-12);
    let most = (0..2000).map(|i| 0.1 * f64::from(i)).max_by(|a, b| at(*a).total_cmp(&at(*b)));
    assert!((most.unwrap() - quarter).abs() < 0.1, "{most:?} nm, {quarter} expected");
    assert!(at(2.0 * quarter) < 1e-15 && (at(3.0 * quarter) - at(quarter)).abs() < 1e-12);
}

#[test]
fn no_more_comes_back_than_there_was() {
    for i in 0..=100 {
        for d in 0..400 {
            let share = |face| {
                twin::reflectance(f64::from(i) / 100.0, INDEX, 5.0 * f64::from(d), 550.0, face)
            };
            for face in [Face::Exact, Face::Schlick, Face::Source] {
                assert!((0.0..=1.0 + 1e-12).contains(&share(face)), "{face:?} {i} {d}");
            }
        }
    }
}

/// Error of one value of the table. The terms of its sums are at most 1 and have about thirty
/// roundings. Their phase is up to 2 · 1.4 · 2000 / 380 = 14.7 turns and has four roundings, of
/// 14.7 · 2π u = 93 u each. Their weights are exponentials with an error of 3 + 2x ulp, where x is at
/// most 40 if the weight matters. The value is stored in half precision.
pub fn bound(value: f64, sizes: f64) -> f64 {
    let terms = 81.0 * U + U * (30.0 + 4.0 * 93.0) + U * (6.0 + 4.0 * 40.0);
    2.0 * sizes * terms + (value.abs() / 1024.0).max(1.0 / f64::from(1 << 24))
}

#[test]
fn tables_are_the_twins() {
    let gpu = Gpu::shared();
    let faces = [
        (FilmFresnel::Exact, Face::Exact),
        (FilmFresnel::Schlick, Face::Schlick),
        (FilmFresnel::Source, Face::Source),
    ];
    for ((fresnel, face), spectrum) in
        faces.into_iter().zip([Spectrum::Whole, Spectrum::Three, Spectrum::Three])
    {
        let film = Film { index: INDEX as f32, fresnel, spectrum };
        let bubbles = BubbleConfig::new(1).with(|it| {
            it.variants = 1;
            it.bubbles = 8;
            it.film = film;
        });
        let config = config(extent(16, 8)).with(|it| it.bubbles = Some(bubbles));
        let mut rig = Rig::lit(&gpu, &config, 1);
        let shot = Shot::new(extent(16, 8), Lens::Standard, 0.1, &[]);
        let table = rig.draw(&shot).soap.expect("bubble foam").film;
        let (width, height) = (table.width, table.height);
        let mut worst = 0.0_f64;
        for (i, found) in table.data.iter().enumerate() {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            let cosine = x / (width - 1) as f64;
            let thickness = 2000.0 * y / (height - 1) as f64;
            let (expected, sizes) = match spectrum {
                Spectrum::Whole => twin::spectral(cosine, INDEX, thickness, face),
                Spectrum::Three => (
                    twin::LINES.map(|w| twin::reflectance(cosine, INDEX, thickness, w, face)),
                    [1.0; 3],
                ),
            };
            for c in 0..3 {
                let expected = expected[c].clamp(0.0, 1.0);
                let off = (f64::from(found[c]) - expected).abs();
                let bound = bound(expected, sizes[c]);
                worst = worst.max(off / bound);
                assert!(
                    off <= bound,
                    "{fresnel:?} {spectrum:?}: {found:?} at cosine {cosine}, {thickness} nm: {expected} of {c} within {bound}"
                );
            }
        }
        println!("{fresnel:?} {spectrum:?}: worst {worst:.2} of the bound");
    }
}
