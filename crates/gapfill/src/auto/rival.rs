//! A method that is tried beside regressions on the neighbours.

use mocap_core::GapFiller;

use super::growth;

/// In gaps of this length knowledge of bodies is worth as much as any other method; in longer ones more.
const AT_HOME_S: f64 = 0.5;

/// But not more than so many methods.
const MOST_CREDIT: f64 = 10.0;

/// A method that fills whole takes.
pub(super) struct Rival {
    pub name: &'static str,
    pub filler: Box<dyn GapFiller>,
    /// It learns a model of the whole take, in about a second.
    pub costly: bool,
    /// Its errors grow with the length of a gap to this power.
    pub growth: f64,
    /// It knows how bodies move, as long as it sees a part of them.
    pub body: bool,
}

impl Rival {
    /// A method that learns little.
    pub fn quick(name: &'static str, growth: f64, filler: impl GapFiller + 'static) -> Self {
        Self { name, filler: Box::new(filler), costly: false, growth, body: false }
    }

    /// A method that learns a model of the take.
    pub fn model(name: &'static str, filler: Box<dyn GapFiller>) -> Self {
        Self { name, filler, costly: true, growth: growth::OF_MODELS, body: false }
    }

    /// What speaks for it in a gap before it is tried: a few pseudo-gaps of two seconds say less of a method than
    /// that it knows how bodies move.
    pub fn credit(&self, seconds: f64) -> f64 {
        if self.body { (seconds / AT_HOME_S).powf(1.5).min(MOST_CREDIT) } else { 1.0 }
    }
}
