//! Pass `map`.
