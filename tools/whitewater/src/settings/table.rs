//! Macros for TOML tables of parts of the settings.

/// Defines a TOML table for a part (a struct) of the settings. The table's keys are fields of the part, and all are
/// optional: `put` writes the given values to a part, and `of` makes a table with the values of all fields of a part.
/// Each field of the part is a key or listed as an exception; the test `no_field_is_forgotten` compares `FIELDS` with
/// the fields of the part.
///
/// Arguments: `keys` lists fields of the part, each with the type that it has in the file. `optional` lists fields
/// that are an `Option` themselves. `not` lists fields that are not keys. `beside` lists keys that are not fields;
/// `of` leaves them unset.
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

            /// Applies the table to a part.
            pub fn put(&self, part: &mut $part) {
                $(if let Some(value) = self.$key.clone() {
                    part.$key = value.into();
                })*
                $(part.$optional = self.$optional.or(part.$optional);)*
            }

            /// The complete table of a part.
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
