use std::sync::Arc;

use mocap_core::{BoneRule, BoneSet, BoneSource, CoreError, MarkerKnowledge, Take};
use solve_ik::Body;

use crate::{Borders, Edges, Start};

/// What a user may say about any method; a method reads what concerns it.
#[derive(Debug, Clone)]
pub struct Options {
    /// Where bone lengths come from.
    pub bones: Bones,
    /// Marker sets that tell where the body faces; the first that names a back and a front counts.
    pub known: Vec<MarkerKnowledge>,
    /// Coordinates to learn in; `None`: the method's own choice.
    pub coordinates: Option<Coordinates>,
    /// Hidden dimensions of a dynamical system, at least 1; `None`: 32, or fewer for short takes.
    pub hidden: Option<usize>,
    /// Weight of the bone lengths, from 0; `None`: 1e6. Its unit is that of [`bolero_sc`]'s `lambda`.
    pub lambda: Option<f64>,
    /// Iterations at most, at least 1; `None`: the method's own number.
    pub iterations: Option<usize>,
    /// Whether `dynammo`, `bolero-sc` and `bolero-hc` have every setting of [Li10] §4, to compare with
    /// published figures: a random start, 16 hidden dimensions, 100 iterations, isotropic
    /// covariances, fills that count as observed, and no joining at the borders.
    pub published: bool,
    /// Where a dynamical system starts to learn; `None`: the method's own choice.
    pub start: Option<Start>,
    /// Seed of a random start.
    pub seed: u64,
    /// What becomes of gaps at the start or end of the take, for methods that interpolate.
    pub edges: Edges,
    /// Gaps that are expected to be filled with a larger error stay open, for `auto`; positive, the root mean
    /// square over a gap in metres. `None`: a metre.
    pub max_error_m: Option<f64>,
    /// Other takes of the same person with the same markers to learn from, for `auto`.
    pub session: Vec<Arc<Take>>,
    /// What becomes of the step at the borders of a gap; `None`: the method's own choice, which is to
    /// join for `lds` and `bolero-sc`.
    pub borders: Option<Borders>,
    /// Bodies that a kinematic fill may find; the one that knows most markers of a take counts.
    pub bodies: Vec<Body>,
}

impl Default for Options {
    /// Everything from the data, with the built-in marker sets and bodies.
    fn default() -> Self {
        let known = MarkerKnowledge::built_in();
        Self {
            bones: Bones::Auto(known.clone()),
            known,
            coordinates: None,
            hidden: None,
            lambda: None,
            iterations: None,
            published: false,
            start: None,
            seed: 0,
            edges: Edges::default(),
            max_error_m: None,
            session: Vec::new(),
            borders: None,
            bodies: Body::built_in(),
        }
    }
}

/// Where bone lengths come from.
#[derive(Debug, Clone, PartialEq)]
pub enum Bones {
    /// The visible samples: the pairs of a known marker set, else pairs that keep their distance.
    Auto(Vec<MarkerKnowledge>),
    /// No bones.
    None,
    /// These.
    Given(BoneSet),
}

impl Bones {
    /// The bones of a take.
    ///
    /// # Errors
    /// [`CoreError`] for given bones that the take has no markers for.
    pub fn resolve(&self, take: &Take) -> Result<BoneSet, CoreError> {
        self.source().find(take)
    }

    pub(crate) fn source(&self) -> BoneSource {
        match self {
            Self::Auto(known) => BoneSource::Estimated(BoneRule::Known(known.clone())),
            Self::None => BoneSource::Given(BoneSet::default()),
            Self::Given(bones) => BoneSource::Given(bones.clone()),
        }
    }
}

/// Coordinates in which the motion is learnt.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coordinates {
    /// As recorded.
    World,
    /// Relative to the body's place and heading.
    Body,
}
