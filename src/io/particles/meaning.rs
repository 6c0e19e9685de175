//! What an attribute is taken as.

/// What became of an attribute, or of three of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Meaning {
    /// Centres of the particles.
    Position,
    /// How fast they move.
    Velocity,
    /// Mass densities.
    Density,
    /// Numbers that follow a particle over the frames.
    Id,
    /// Time left to live, of whitewater particles.
    Lifetime,
    /// What a particle is, as a number: of a whitewater particle 0 foam, 1 spray, 2 bubble.
    Kind,
}

impl std::fmt::Display for Meaning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Density => "density",
            Self::Id => "id",
            Self::Lifetime => "lifetime",
            Self::Kind => "kind",
        })
    }
}
