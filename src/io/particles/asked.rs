//! What a caller requests from a file besides the attributes with a meaning.

use std::sync::Arc;

use super::columns::{Attribute, AttributeType};
use super::names;
use super::steps::Step;

/// Names of attributes, and one of several frames. Cheap to clone.
#[derive(Debug, Clone, Default)]
pub(super) struct Asked {
    /// Plain names, see `names::plain`.
    extras: Arc<[String]>,
    step: Option<Step>,
}

impl Asked {
    /// Requests attributes by these names, besides those with a meaning.
    pub(super) fn new(extras: &[&str]) -> Self {
        Self { extras: extras.iter().map(|name| names::plain(name)).collect(), step: None }
    }

    /// Also requests one of the file's frames.
    pub(super) fn of_step(self, step: Option<Step>) -> Self {
        Self { step, ..self }
    }

    /// The requested frame; `None` if none was named.
    pub(super) fn step(&self) -> Option<Step> {
        self.step
    }

    /// Whether an attribute with this plain name is requested.
    pub(super) fn has(&self, plain: &str) -> bool {
        self.extras.iter().any(|name| name == plain)
    }

    /// Whether an attribute with this name may be used, because its name is known or was asked for. A reader need not
    /// unpack the others.
    pub(super) fn wants(&self, name: &str) -> bool {
        let name = names::plain(name);
        names::known(&name) || self.has(&name)
    }

    /// Lists an attribute and returns whether its values are wanted.
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
