//! The search box: what was typed, what it means, what else could be meant.

use super::log::printable;
use crate::sky::catalogue::{Catalogue, Object, SearchError};
use crate::sky::ephemeris::Body;

/// No name is longer.
const LONGEST: usize = 40;

/// So many names are offered.
const OFFERED: usize = 10;

/// The search box.
#[derive(Debug, Clone, Default)]
pub struct Search {
    /// What was typed.
    pub text: String,
    /// Names that begin so, or, if nothing is called so, names that are near.
    pub offered: Vec<String>,
    /// The offered name under the bar; none is what was typed itself.
    pub bar: Option<usize>,
    /// What the name under the bar, or what was typed, means.
    pub meant: Option<Object>,
    /// Whether what was typed is no name, so that the offered ones are guesses.
    pub missed: bool,
    /// Sun, Moon and planets, where they stood when the box was opened.
    bodies: Vec<Object>,
}

impl Search {
    /// An empty box that knows these bodies of the solar system beside the catalogue.
    #[must_use]
    pub fn among(bodies: Vec<Object>) -> Search {
        Search { bodies, ..Search::default() }
    }

    /// The body of the solar system of this name.
    fn body(&self, name: &str) -> Option<Object> {
        let body = Body::from_name(name)?;
        self.bodies.iter().find(|object| object.name == body.name()).cloned()
    }

    /// A character was typed.
    pub fn typed(&mut self, c: char) {
        if !c.is_control() && self.text.chars().count() < LONGEST {
            self.text.push(c);
            self.look();
        }
    }

    /// The last character is taken back.
    pub fn rubbed_out(&mut self) {
        self.text.pop();
        self.look();
    }

    /// The name under the bar, or the first offered, is taken over into the box.
    pub fn completed(&mut self) {
        if let Some(name) = self.offered.get(self.bar.unwrap_or(0)) {
            self.text.clone_from(name);
            self.look();
        }
    }

    /// The bar moves down (positive) or up; above the first name it is in the box.
    pub fn bar_moved(&mut self, by: i32) {
        let place = self.bar.map_or(-1, |bar| bar as i32) + by;
        self.bar = usize::try_from(place).ok().map(|bar| bar.min(self.offered.len().saturating_sub(1)));
        if self.offered.is_empty() {
            self.bar = None;
        }
        let name = self.bar.and_then(|bar| self.offered.get(bar)).unwrap_or(&self.text);
        self.meant = self.body(name).or_else(|| Catalogue::embedded().search(name).ok());
    }

    fn look(&mut self) {
        self.bar = None;
        self.missed = false;
        self.meant = None;
        self.offered.clear();
        if self.text.trim().is_empty() {
            return;
        }
        let catalogue = Catalogue::embedded();
        self.offered = catalogue.complete(&self.text, OFFERED);
        let typed = self.text.trim().to_lowercase();
        let begin = self.bodies.iter().filter(|body| body.name.to_lowercase().starts_with(&typed));
        let names: Vec<String> = begin.map(|body| body.name.clone()).collect();
        self.offered.splice(0..0, names);
        self.offered.truncate(OFFERED);
        self.meant = self.body(&self.text);
        if self.meant.is_some() {
            return;
        }
        match catalogue.search(&self.text) {
            Ok(object) => self.meant = Some(object),
            Err(SearchError::NotFound { near, .. }) if self.offered.is_empty() => {
                self.offered = near.into_iter().take(OFFERED).collect();
                self.missed = true;
            }
            Err(_) => {}
        }
        for name in &mut self.offered {
            *name = printable(name);
        }
    }
}
