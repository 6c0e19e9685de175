//! What a caller asks of a file beside what has a meaning.

use std::sync::Arc;

use super::columns::{Attribute, AttributeType};
use super::names;
use super::steps::Step;

/// Attributes by their names, and a frame of a file of several. A copy costs nothing.
#[derive(Debug, Clone, Default)]
pub(super) struct Asked {
    /// Plain names.
    extras: Arc<[String]>,
    step: Option<Step>,
}

impl Asked {
    /// Beside what has a meaning, attributes of these names.
    pub(super) fn new(extras: &[&str]) -> Self {
        Self { extras: extras.iter().map(|name| names::plain(name)).collect(), step: None }
    }

    /// And a frame of the file's several.
    pub(super) fn of_step(self, step: Option<Step>) -> Self {
        Self { step, ..self }
    }

    /// The frame of several that is read; none where none was named.
    pub(super) fn step(&self) -> Option<Step> {
        self.step
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
