//! Parsers for the values of flags.

use whitewater::water::Rule;

use super::{Foaming, Radius, Turntable};

/// Refuses a renamed flag and names the new one.
pub(super) fn was_foam(_: &str) -> Result<Foaming, String> {
    Err("--foam was renamed: use --surface-foam".into())
}

pub(super) fn foaming(text: &str) -> Result<Foaming, String> {
    match text {
        "auto" => Ok(Foaming::Auto),
        "none" => Ok(Foaming::None),
        _ => positive(text)
            .map(Foaming::From)
            .map_err(|_| "expected auto, none or a number above 0".into()),
    }
}

pub(super) fn turntable(text: &str) -> Result<Turntable, String> {
    let bad = || "expected frames, 2 or more, or seconds, such as 96 or 4s".to_string();
    match (text, text.strip_suffix('s')) {
        ("auto", _) => Ok(Turntable::Auto),
        (_, Some(seconds)) => positive(seconds).map(Turntable::Seconds).map_err(|_| bad()),
        (frames, None) => match frames.parse() {
            Ok(frames @ 2..=100_000) => Ok(Turntable::Frames(frames)),
            _ => Err(bad()),
        },
    }
}

/// A length, or a name that cannot be a misspelled one.
pub(super) fn radius(text: &str) -> Result<Radius, String> {
    let name = text.trim();
    let is_name = name.starts_with(|c: char| c.is_alphabetic() || "_@:".contains(c));
    match positive(text) {
        Ok(radius) => Ok(Radius::Metres(radius)),
        Err(_) if is_name && name.parse::<f32>().is_err() => Ok(Radius::Of(name.into())),
        Err(_) => Err("expected a number above 0, or the name of an attribute".into()),
    }
}

pub(super) fn finite(text: &str) -> Result<f32, String> {
    match text.trim().parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("expected a number".into()),
    }
}

pub(super) fn exposure(text: &str) -> Result<f32, String> {
    match text {
        "auto" => Ok(0.0),
        stops => finite(stops).map_err(|_| "expected auto, or stops".into()),
    }
}

/// Seconds, as a number or a fraction such as 1/50.
pub(super) fn seconds(text: &str) -> Result<f32, String> {
    let found = match text.split_once('/') {
        Some((over, under)) => finite(over).and_then(|over| Ok(over / finite(under)?)),
        None => finite(text),
    };
    let good = found.ok().filter(|v| (0.0..=10.0).contains(v));
    good.ok_or_else(|| "expected seconds from 0 to 10, as 1/50".into())
}

pub(super) fn no_less_than_0(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| *v >= 0.0).ok_or_else(|| "expected 0 or more".into())
}

pub(super) fn positive(text: &str) -> Result<f32, String> {
    finite(text).ok().filter(|v| *v > 0.0).ok_or_else(|| "expected a number above 0".into())
}

pub(super) fn degrees(text: &str) -> Result<f32, String> {
    finite(text)
        .ok()
        .filter(|v| (0.1..=170.0).contains(v))
        .ok_or_else(|| "expected degrees from 0.1 to 170".into())
}

pub(super) fn vector(text: &str) -> Result<[f32; 3], String> {
    let parts: Vec<f32> = text.split(',').map(finite).collect::<Result<_, _>>()?;
    parts.try_into().map_err(|_| "expected three numbers X,Y,Z".into())
}

pub(super) fn size(text: &str) -> Result<(u32, u32), String> {
    let bad = || "expected WIDTHxHEIGHT in pixels, such as 1280x720".to_string();
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(bad)?;
    let number = |t: &str| t.trim().parse::<u32>().ok().filter(|n| *n > 0).ok_or_else(bad);
    Ok((number(width)?, number(height)?))
}

pub(super) fn times_as_large(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|n| [1, 2, 4].contains(n)).ok_or_else(|| "expected 1, 2 or 4".into())
}

pub(super) fn rule(text: &str) -> Result<Rule, String> {
    match text {
        "source" => Ok(Rule::Source),
        "constant-width" => Ok(Rule::ConstantWidth),
        _ => text
            .strip_prefix("fixed:")
            .and_then(|n| n.parse().ok())
            .map(Rule::Fixed)
            .ok_or_else(|| "expected source, constant-width, or fixed:N with a number".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser as _;

    use crate::args::Cli;

    #[test]
    fn old_flags_are_refused_with_the_new_names() {
        for (line, says) in [
            ("whitewater render a.ply -o a.png --foam auto", "use --surface-foam"),
            ("whitewater render a.ply -o a.png --foam=none", "use --surface-foam"),
            ("whitewater demo -o a.png --foam 80", "use --surface-foam"),
            ("whitewater bench --sea wave --diffuse 20k", "use --whitewater"),
        ] {
            let message = Cli::try_parse_from(line.split(' ')).unwrap_err().to_string();
            assert!(message.contains("was renamed") && message.contains(says), "{message}");
        }
        let line = "whitewater render a.ply -o a.png --surface-foam auto";
        assert!(Cli::try_parse_from(line.split(' ')).is_ok());
    }

    #[test]
    fn values_are_parsed() {
        assert_eq!(size("3x2"), Ok((3, 2)));
        assert!(size("0x2").is_err() && size("12").is_err());
        assert_eq!(times_as_large("4"), Ok(4));
        assert!(times_as_large("0").is_err() && times_as_large("3").is_err());
        assert_eq!(foaming("80"), Ok(Foaming::From(80.0)));
        assert_eq!((exposure("auto"), exposure("-1.5")), (Ok(0.0), Ok(-1.5)));
        assert!(exposure("bright").is_err());
        assert!(foaming("-1").is_err() && foaming("much").is_err());
        assert_eq!(vector("1,-2, 3e1"), Ok([1.0, -2.0, 30.0]));
        assert!(vector("1,2").is_err() && vector("1,2,nan").is_err());
        assert_eq!(turntable("auto"), Ok(Turntable::Auto));
        assert_eq!(turntable("24"), Ok(Turntable::Frames(24)));
        assert_eq!(turntable("2.5s"), Ok(Turntable::Seconds(2.5)));
        for bad in ["1", "0s", "-3", "s", "4 seconds", "1000000"] {
            assert!(turntable(bad).is_err(), "{bad}");
        }
        assert_eq!(rule("fixed:40"), Ok(Rule::Fixed(40)));
        assert!(rule("fixed:").is_err());
    }
}
