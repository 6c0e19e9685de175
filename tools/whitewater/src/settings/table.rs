//! What makes a table of TOML keys of a part of the settings.

/// A table whose keys are fields of a part of the settings, each of which may be left out: `put` lays what it says over
/// such a part, `of` says all of one. Each field is a key or named among those that are none: the test
/// `no_field_is_forgotten` compares `FIELDS` with those of the part.
///
/// `keys`: fields, and as what they are written. `optional`: fields that are `Option`s themselves. `not`: fields that
/// are no keys. `beside`: keys that are no fields, which `of` leaves out.
macro_rules! table {
    (
        $(#[$about:meta])* $table:ident of $part:ident
        keys { $($(#[$key_about:meta])* $key:ident: $kind:ty),* $(,)? }
        optional { $($optional:ident: $inner:ty),* $(,)? }
        not { $($not:ident),* $(,)? }
        beside { $($(#[$beside_about:meta])* $beside:ident: $other:ty),* $(,)? }
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, Default, serde::Deserialize, serde::Serialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct $table {
            $($(#[$key_about])* pub $key: Option<$kind>,)*
            $(pub $optional: Option<$inner>,)*
            $($(#[$beside_about])* pub $beside: Option<$other>,)*
        }

        impl $table {
            /// Every field of a part.
            #[cfg(test)]
            pub const FIELDS: &[&str] =
                &[$(stringify!($key),)* $(stringify!($optional),)* $(stringify!($not),)*];

            /// Puts what the table says over a part.
            pub fn put(&self, part: &mut $part) {
                $(if let Some(value) = self.$key.clone() {
                    part.$key = value.into();
                })*
                $(part.$optional = self.$optional.or(part.$optional);)*
            }

            /// The table that says all of a part.
            pub fn of(part: &$part) -> Self {
                let $part { $($key,)* $($optional,)* $($not: _,)* .. } = *part;
                Self {
                    $($key: Some($key.into()),)*
                    $($optional,)*
                    $($beside: None,)*
                }
            }
        }
    };
}

/// Words for the variants of an enum of the settings, in snake case.
macro_rules! words {
    ($(#[$about:meta])* $words:ident of $setting:ident { $($word:ident),* $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
        #[serde(rename_all = "snake_case")]
        pub enum $words { $($word),* }

        impl From<$words> for $setting {
            fn from(word: $words) -> Self {
                match word { $($words::$word => Self::$word),* }
            }
        }

        impl From<$setting> for $words {
            fn from(setting: $setting) -> Self {
                match setting { $($setting::$word => Self::$word),* }
            }
        }
    };
}

pub(super) use {table, words};
