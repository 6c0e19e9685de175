//! What a caller asks of a file beside what has a meaning.

use std::sync::Arc;

use super::columns::{Attribute, AttributeType};
use super::names;

/// Attributes by their names. A copy costs nothing.
#[derive(Debug, Clone, Default)]
pub(super) struct Asked {
    /// Plain names.
    extras: Arc<[String]>,
}

impl Asked {
    /// Beside what has a meaning, attributes of these names.
    pub(super) fn new(extras: &[&str]) -> Self {
        Self { extras: extras.iter().map(|name| names::plain(name)).collect() }
    }

    /// Whether an attribute of this plain name is asked for.
    pub(super) fn has(&self, plain: &str) -> bool {
        self.extras.iter().any(|name| name == plain)
    }

    /// Whether an attribute of this name may be used, so that a reader need not unpack the others.
    pub(super) fn wants(&self, name: &str) -> bool {
        let name = names::plain(name);
        names::known(&name) || self.has(&name)
    }

    /// Lists an attribute, and says whether its numbers are wanted.
    pub(super) fn list(
        &self,
        attributes: &mut Vec<Attribute>,
        name: &str,
        components: usize,
        ty: AttributeType,
    ) -> bool {
        attributes.push(Attribute { name: name.into(), components, ty });
        self.wants(name)
    }
}
