//! Meaning of an attribute.

/// Meaning of an attribute, or of three attributes that form a vector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Meaning {
    /// Centres of the particles.
    Position,
    /// Velocities.
    Velocity,
    /// Mass densities.
    Density,
    /// Numbers that stay with a particle from frame to frame.
    Id,
    /// Remaining lifetime of whitewater particles; with two attributes, the whole lifetime less the age.
    Lifetime,
    /// Kind of a particle, as a number; for whitewater 0 foam, 1 spray, 2 bubble.
    Kind,
    /// Time or step number, which gives the frame's time or tells the frames of a file apart.
    Time,
    /// Marks particles that are left out: copies of particles in another piece of the file, and hidden ones (ghost
    /// types and levels of VTK).
    Ghost,
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
            Self::Time => "time",
            Self::Ghost => "ghost",
        })
    }
}
