use whitewater::water::{Amplitude, Convolution, Fresnel, Medium};
use whitewater::water::{SpraySettings, SurfaceNoiseSettings};
use whitewater::{OcclusionReach, PotentialRange, ShadowMixing, Submerged, WhitewaterSettings};

use super::*;

fn applied(text: &str) -> Settings {
    let mut settings = Settings::default();
    SettingsFile::parse(text).unwrap().apply(&mut settings);
    settings
}

/// All settings as text.
fn written(settings: &Settings) -> String {
    SettingsFile::default().all(settings, Found::default()).text().unwrap()
}

#[test]
fn values_arrive() {
    let settings = applied(
        "[water]\nspacing = 0.1\nmedium = 'source'\nfresnel = {f0 = 0.05}\n[light]\nambient = [1, 2.0, 3.0]",
    );
    assert_eq!(settings.water.spacing, 0.1);
    assert_eq!(settings.water.medium, Medium::source(0.1));
    assert_eq!(settings.water.fresnel, Fresnel::Schlick { f0: 0.05 });
    assert_eq!(settings.light.ambient, [1.0, 2.0, 3.0]);
    assert_eq!(settings.light.color, Settings::default().light.color);
}

#[test]
fn media_are_read_by_name_and_by_numbers() {
    let of = |text: &str| applied(&format!("[water]\nmedium = {text}")).water.medium;
    assert_eq!(of("'glacier'"), Medium::GLACIER);
    assert_eq!(of("'milk:0.01'"), Medium::MILK.thinned(0.01));
    let turbid =
        Medium::Turbid { absorption: [1.0; 3], scattering: [2.0; 3], emission: [0.0, 0.5, 0.0] };
    assert_eq!(of("{absorption=[1,1,1], reduced_scattering=[2,2,2], emission=[0,0.5,0]}"), turbid);
    let mut settings = Settings::default();
    settings.water.medium = turbid;
    settings.water.fresnel = Fresnel::Schlick { f0: 0.25 };
    assert_eq!(applied(&written(&settings)), settings);
    // Values of the tables override those of the named liquid.
    let beer = applied("[water]\nmedium = 'beer'\n[surface_foam]\nfront_color = [0.1, 0.2, 0.3]");
    assert_eq!(beer.surface_foam.front_color, [0.1, 0.2, 0.3]);
    assert_ne!(beer.surface_foam.back_color, Settings::default().surface_foam.back_color);
}

#[test]
fn shadows_are_filtered_as_asked() {
    let of = |text: &str| SettingsFile::parse(text).unwrap().shadows();
    assert_eq!(of("[shadow]\nwidth = 5.0"), Shadows::Map);
    let convolution = Convolution { terms: 8, ..Convolution::default() };
    let text = "[shadow]\nfilter = 'convolution'\nterms = 8";
    assert_eq!(of(text), Shadows::Convolution(convolution));
}

#[test]
fn water_foams_as_asked() {
    let of = |text: &str| {
        let file = SettingsFile::parse(text).unwrap();
        let mut settings = Settings::default();
        file.apply(&mut settings);
        file.surface_foam.formation(&settings.water)
    };
    let text = "[water]\nspacing = 0.02\nrest_density = 998.0\n[surface_foam]\n";
    let standard = WeberSettings::reduced(0.02, 1.0).with(|it| it.rest_density = 998.0);
    assert_eq!(of(text), standard);
    // Section 3.2 of the thesis: ρ v² l / σ, with a particle's width l and a surface tension of 0.0728 N/m.
    let full = of(&format!("{text}weber = 'full'\nthreshold = 30.0"));
    assert!((full.scale / (0.02 / 0.0728) - 1.0).abs() < 1.0e-6, "{full:?}");
    assert_eq!(full.threshold, 30.0);
    let said = of(&format!("{text}lifetime = 2.5\nair = [1.0, 0.0, -3.0]\nseed = 7"));
    assert_eq!(
        said,
        standard.with(|it| {
            it.foam_lifetime = 2.5;
            it.air = [1.0, 0.0, -3.0];
            it.seed = 7;
        })
    );
}

#[test]
fn settings_go_out_and_come_back() {
    let mut settings = Settings::default();
    settings.water.medium = Medium::source(0.02);
    settings.water.shininess = 1.0e-7;
    settings.water.amplitude = Amplitude::Source;
    settings.surface_foam.min_thickness = 0.25;
    settings.surface_foam.front_color = [0.1, 0.2, 0.3];
    settings.spray = SpraySettings::SOURCE.with(|it| it.size = 1.5);
    settings.whitewater = WhitewaterSettings::of_spacing(0.1).with(|it| {
        it.submerged = Submerged::Falloff { depth: 0.3, n: 2.0, m: 4.0 };
        it.reach = OcclusionReach::Metres(5.0);
        it.mixing = ShadowMixing::Source;
        (it.min_samples, it.max_samples) = (8, 64);
    });
    settings.bubbles.film = 450.0;
    settings.shore.period = Some(7.0);
    settings.shore.shoreline.floor = Some(-0.2);
    settings.shore.shoreline.layers[2] = settings.shore.shoreline.layers[0];
    settings.shore.contact.particle_depth = Some(0.3);
    settings.shadow.width = 7.5;
    settings.noise = SurfaceNoiseSettings::SOURCE.with(|it| it.cells = 0.7);
    settings.light.irradiance = [1.0, 2.0, 3.0];
    assert_eq!(applied(&written(&settings)), settings);
}

/// The keys of a table, as listed in the reader's error about an unknown key.
fn known(table: &str) -> Vec<String> {
    let message = SettingsFile::parse(&format!("{table}\nno_such_key = 0")).unwrap_err();
    let (_, keys) = message.split_once("expected").unwrap();
    keys.split('`').skip(1).step_by(2).map(String::from).collect()
}

/// A file with every key, whose numbers and booleans differ from the defaults.
fn everything() -> SettingsFile {
    let text = "
        [water]
        medium = {absorption = [1.0, 2.0, 3.0], scattering = [4.0, 5.0, 6.0]}
        [surface_foam]
        threshold = 30.0
        [whitewater]
        radii = [0.1, 0.2, 0.3]
        copies = 3
        splat = 'raster'
        [bubbles]
        crossfade = [3.0, 5.0]
        [shore]
        period = 7.0
        web = 'web.png'
        strip = 'strip.obj'
        by = 'screen'
        map = 256
        [shoreline]
        floor = -0.2
        [contact]
        mask_picture = 'mask.png'
        particle_depth = 0.3";
    let file = SettingsFile::parse(text).unwrap();
    let mut settings = Settings::default();
    file.apply(&mut settings);
    let limits = PotentialRange { min: 1.0, max: 2.0 };
    let generate = (GeneratorSettings::new(0.1, [limits; 3], 3.0), 1000);
    file.all(&settings, Found { generate: Some(&generate), ..Found::default() })
}

#[test]
fn every_key_is_written() {
    let all: toml::Table = everything().text().unwrap().parse().unwrap();
    let tables = known("");
    assert!(tables.len() >= 12, "{tables:?}");
    for name in tables {
        let table = all.get(&name).and_then(toml::Value::as_table);
        // Keys outside of tables are presets; what they choose is written as keys of the tables.
        let Some(table) = table else { continue };
        let keys = known(&format!("[{name}]"));
        assert!(!keys.is_empty());
        for key in keys {
            assert!(table.contains_key(&key), "[{name}] {key} is not written");
        }
    }
}

/// Variants of a tree of values, each with one number or boolean changed.
fn changed(value: &toml::Value) -> Vec<toml::Value> {
    use toml::Value::{Array, Boolean, Float, Integer, Table};
    match value {
        // Multiples of 1/16 are exact in single precision and in text.
        Float(x) => vec![Float(f64::from(*x as f32 * 0.5 + 0.125))],
        Integer(n) => vec![Integer(n + 1)],
        Boolean(b) => vec![Boolean(!b)],
        Array(values) => {
            let each = values.iter().enumerate();
            each.flat_map(|(i, part)| {
                changed(part).into_iter().map(move |part| {
                    let mut values = values.clone();
                    values[i] = part;
                    Array(values)
                })
            })
            .collect()
        }
        Table(table) => table
            .iter()
            .flat_map(|(key, part)| {
                changed(part).into_iter().map(move |part| {
                    let mut table = table.clone();
                    table.insert(key.clone(), part);
                    Table(table)
                })
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// Each value of the complete file is changed in turn. Then the file is read, applied to the defaults and written
/// again: in the result this value has changed, and no other one.
#[test]
fn every_value_arrives_and_is_written() {
    let all: toml::Table = everything().text().unwrap().parse().unwrap();
    let mut compared = 0;
    for variant in changed(&toml::Value::Table(all)) {
        let text = toml::to_string(&variant).unwrap();
        let file = SettingsFile::parse(&text).unwrap();
        let mut settings = Settings::default();
        file.apply(&mut settings);
        let mut generate =
            (GeneratorSettings::new(0.1, [PotentialRange { min: 0.0, max: 1.0 }; 3], 0.0), 1);
        file.generate.apply(&mut generate.0);
        generate.1 = file.generate.max_particles.unwrap();
        let formation = file.surface_foam.formation(&settings.water);
        let found = Found { foam: Some(&formation), generate: Some(&generate), matte: false };
        let back: toml::Table = file.all(&settings, found).text().unwrap().parse().unwrap();
        let back = toml::Value::Table(back);
        assert!(same(&back, &variant), "{}\nis not\n{text}", toml::to_string(&back).unwrap());
        compared += 1;
    }
    assert!(compared > 200, "{compared}");
}

/// Compares numbers in single precision.
fn same(a: &toml::Value, b: &toml::Value) -> bool {
    use toml::Value::{Array, Float, Table};
    match (a, b) {
        (Float(a), Float(b)) => *a as f32 == *b as f32,
        (Array(a), Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (Table(a), Table(b)) => {
            a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| same(a, b)))
        }
        (a, b) => a == b,
    }
}

#[test]
fn mistakes_are_named() {
    for (text, part) in [
        ("[water]\nspacin = 1.0", "`spacing`"),
        ("[watr]", "`water`"),
        ("[water]\n\nspacing = 'a'", "line 3"),
        ("[water]\nmedium = 'mud'", "clear, pool, lake, ocean"),
        ("[water]\nmedium = 'beer:x'", "'beer:0.05'"),
        ("[water]\nmedium = {absorption=[1.0,1.0,1.0], scatter=[0.0,0.0,0.0]}", "scattering"),
        ("[water]\namplitude = 'loud'", "`volume` or `source`"),
        ("[surface_foam]\nweber = 'half'", "`reduced` or `full`"),
        ("[shadow]\nfilter = 'soft'", "`pcf` or `convolution`"),
        (
            "[shoreline]\nlayers = [{weight=1,scale=1},{weight=1,scale=1},{weight=1,scale=1},{weight=1,scale=1},{weight=1,scale=1}]",
            "at most 4",
        ),
        ("[water", "line 1"),
    ] {
        let message = SettingsFile::parse(text).unwrap_err();
        assert!(message.contains(part) && !message.contains('\n'), "{message}");
    }
}

/// Each old name of a key is refused, and each new name that the message gives is a known key.
#[test]
fn old_names_are_refused_with_the_new_ones() {
    for (text, says) in [
        ("[foam]\nextinction = 1.0", "use [surface_foam]"),
        ("[diffuse]\nradius = 1.0", "use [whitewater]"),
        ("[whitewater]\nhalf = 1.0", "use half_intensity_thickness"),
        ("[bubbles]\nhand_over = [1.0, 2.0]", "use crossfade"),
        ("spray = {densities = [0.1, 0.2, 0.3]}", "all_spray_density, full_water_density"),
    ] {
        let message = SettingsFile::parse(text).unwrap_err();
        assert!(message.contains("was renamed") && message.contains(says), "{message}");
    }
    let tables = known("");
    for (table, key, new) in renamed::RENAMED {
        let text =
            if key.is_empty() { format!("[{table}]") } else { format!("[{table}]\n{key} = 0") };
        assert!(SettingsFile::parse(&text).unwrap_err().contains(new), "{text}");
        let (here, old) = match key.is_empty() {
            true => (tables.clone(), table),
            false => (known(&format!("[{table}]")), key),
        };
        assert!(!here.iter().any(|known| known == old), "[{table}] {key} is still known");
        let names = new.split([',', ' ', '[', ']']).filter(|name| !["", "and"].contains(name));
        for name in names {
            assert!(here.iter().any(|known| known == name), "{new}");
        }
    }
}

/// Field names of a struct, from its derived `Debug`.
fn fields(of: &impl std::fmt::Debug) -> Vec<String> {
    let text = format!("{of:#?}");
    let own = text.lines().filter_map(|line| line.strip_prefix("    "));
    let named = own.filter(|line| line.starts_with(|c: char| c.is_ascii_alphabetic()));
    named.filter_map(|line| Some(line.split_once(':')?.0.to_owned())).collect()
}

/// If a struct of the library gets a new field, this test fails until the field is a key or listed as an exception.
#[test]
fn no_field_is_forgotten() {
    fn same(of: &impl std::fmt::Debug, known: &[&str]) {
        let (mut found, mut known) = (fields(of), known.to_vec());
        found.sort();
        known.sort_unstable();
        assert_eq!(found, known, "{of:?}");
    }
    let all = Settings::default();
    same(&all.water, water::WaterTable::FIELDS);
    same(&all.water.ellipsoids, water::EllipsoidTable::FIELDS);
    same(&all.water.wavelets, water::WaveletTable::FIELDS);
    same(&all.surface_foam, water::SurfaceFoamTable::FIELDS);
    same(&all.spray, water::SprayTable::FIELDS);
    same(&all.whitewater, whitewater_table::WhitewaterTable::FIELDS);
    same(&all.bubbles, bubbles::BubbleTable::FIELDS);
    same(&all.shore, shore::ShoreTable::FIELDS);
    same(&all.shore.shoreline, shore::ShorelineTable::FIELDS);
    same(&all.shore.contact, shore::ContactTable::FIELDS);
    same(&all.shadow, water::ShadowTable::FIELDS);
    same(&all.noise, water::NoiseTable::FIELDS);
    same(&all.light, water::LightTable::FIELDS);
    let limits = PotentialRange { min: 0.0, max: 1.0 };
    let generated = whitewater::GeneratorSettings::new(1.0, [limits; 3], 1.0);
    same(&generated, generate::GenerateTable::FIELDS);
    // Structs that have no table macro.
    let parts =
        "up water surface_foam spray whitewater bubbles shore shadow noise light debug_view";
    let words = |names: &'static str| names.split(' ').collect::<Vec<_>>();
    same(&all, &words(parts));
    let foams = "scale threshold foam_lifetime air rest_density seed";
    same(&WeberSettings::weber(1.0, 1.0), &words(foams));
    let bubbles =
        "max_blobs variants bubbles seed impostor map_size steps layers sort film crossfade";
    same(&whitewater::bubbles::BubbleConfig::new(1), &words(bubbles));
    same(&whitewater::shore::ShoreConfig::default(), &words("edge texture_size seed"));
}
