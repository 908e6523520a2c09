use crate::{CoreError, MarkerKnowledge, Take};

/// Two markers a fixed distance apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bone {
    a: usize,
    b: usize,
    length_m: f64,
}

impl Bone {
    /// A bone between two markers, in either order, with its length in metres.
    ///
    /// # Errors
    /// [`CoreError::SelfBone`] and [`CoreError::BoneLength`].
    pub fn new(a: usize, b: usize, length_m: f64) -> Result<Self, CoreError> {
        let (a, b) = (a.min(b), a.max(b));
        if a == b {
            return Err(CoreError::SelfBone { marker: a });
        }
        if !(length_m.is_finite() && length_m > 0.0) {
            return Err(CoreError::BoneLength { a, b, length_m });
        }
        Ok(Self { a, b, length_m })
    }

    /// Both markers, lower index first.
    #[must_use]
    pub fn markers(&self) -> (usize, usize) {
        (self.a, self.b)
    }

    /// Length in metres.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// The other end, if `marker` is one of the two.
    #[must_use]
    pub fn other(&self, marker: usize) -> Option<usize> {
        match marker {
            m if m == self.a => Some(self.b),
            m if m == self.b => Some(self.a),
            _ => None,
        }
    }
}

/// A set of bones without doubles: the set B of [Li10] Definition 1.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BoneSet {
    bones: Vec<Bone>,
}

/// How [`BoneSet::estimate`] finds the pairs.
#[derive(Debug, Clone, PartialEq)]
pub enum BoneRule {
    /// These pairs of marker indices.
    Pairs(Vec<(usize, usize)>),
    /// Pairs whose distance hardly changes.
    Rigid(RigidPairs),
    /// The pairs of that of these marker sets of which the take wears the largest share, at least half of it; if there is
    /// none, the pairs whose distance hardly changes.
    Known(Vec<MarkerKnowledge>),
}

/// Where a method that keeps bone lengths has its bones from.
#[derive(Debug, Clone, PartialEq)]
pub enum BoneSource {
    /// By this rule; lengths from the visible samples.
    Estimated(BoneRule),
    /// These, with these lengths.
    Given(BoneSet),
}

impl Default for BoneSource {
    /// The named pairs of a marker set that ships with the crate where a take wears one, else the pairs whose
    /// distance hardly changes.
    fn default() -> Self {
        Self::Estimated(BoneRule::Known(MarkerKnowledge::built_in()))
    }
}

impl BoneSource {
    /// The bones of a take.
    ///
    /// # Errors
    ///
    /// [`CoreError`] for bones or rules that name markers the take does not have.
    pub fn find(&self, take: &Take) -> Result<BoneSet, CoreError> {
        let bones = match self {
            Self::Given(bones) => bones.clone(),
            Self::Estimated(rule) => BoneSet::estimate(take, rule)?,
        };
        bones.check(take)?;
        Ok(bones)
    }
}

/// Share of a marker set that a take has to wear for the set's bones to be believed.
const WORN: f64 = 0.5;

/// When two markers count as fixed to one bone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidPairs {
    /// Largest standard deviation of the distance, in metres. Above 0; default 0.01, the median
    /// deviation of the named bones of a captured body.
    pub max_deviation_m: f64,
    /// Largest mean distance, in metres. Above 0; default 0.6, longer than any single segment
    /// between neighbouring markers of an adult.
    pub max_length_m: f64,
    /// Bones kept per marker, stiffest first. At least 1; default 3.
    pub per_marker: usize,
}

impl Default for RigidPairs {
    fn default() -> Self {
        Self { max_deviation_m: 0.01, max_length_m: 0.6, per_marker: 3 }
    }
}

/// Frames in which both ends must be seen before a bone is believed.
const MIN_FRAMES: usize = 2;

impl BoneSet {
    /// Collects bones.
    ///
    /// # Errors
    /// [`CoreError::DuplicateBone`] for a pair that comes twice, in either order.
    pub fn new(bones: impl IntoIterator<Item = Bone>) -> Result<Self, CoreError> {
        let bones: Vec<Bone> = bones.into_iter().collect();
        let mut pairs: Vec<(usize, usize)> = bones.iter().map(Bone::markers).collect();
        pairs.sort_unstable();
        match pairs.windows(2).find(|w| w[0] == w[1]) {
            Some(twice) => Err(CoreError::DuplicateBone { a: twice[0].0, b: twice[0].1 }),
            None => Ok(Self { bones }),
        }
    }

    /// Estimates bones from the visible samples of a take, and from nothing else.
    ///
    /// A bone's length is the mean distance over the frames that show both markers. Pairs seen
    /// together in fewer than two frames, or with mean distance zero, give no bone.
    ///
    /// Deviates from [Li10] Definition 1 as its authors computed it: they averaged over the complete
    /// motion, hidden frames included.
    ///
    /// # Errors
    /// [`CoreError::SelfBone`], [`CoreError::DuplicateBone`] and [`CoreError::OutOfRange`] for pairs
    /// that are no pairs of the take.
    pub fn estimate(take: &Take, rule: &BoneRule) -> Result<Self, CoreError> {
        match rule {
            BoneRule::Pairs(pairs) => Self::from_pairs(take, pairs),
            BoneRule::Rigid(rule) => Self::rigid(take, *rule),
            BoneRule::Known(sets) => {
                let markers = take.markers();
                let best = MarkerKnowledge::best(sets, markers);
                match best.filter(|set| set.coverage(markers) >= WORN) {
                    Some(set) => Self::from_pairs(take, &set.bone_pairs(markers)),
                    None => Self::rigid(take, RigidPairs::default()),
                }
            }
        }
    }

    fn from_pairs(take: &Take, pairs: &[(usize, usize)]) -> Result<Self, CoreError> {
        let mut bones = Vec::with_capacity(pairs.len());
        for &(a, b) in pairs {
            if a == b {
                return Err(CoreError::SelfBone { marker: a });
            }
            check_marker(take, a.max(b))?;
            if let Some(span) = Span::of(take, a, b) {
                bones.push(Bone::new(a, b, span.mean_m)?);
            }
        }
        Self::new(bones)
    }

    fn rigid(take: &Take, rule: RigidPairs) -> Result<Self, CoreError> {
        let markers = take.marker_count();
        let mut found: Vec<(f64, Bone)> = Vec::new();
        for a in 0..markers {
            for b in a + 1..markers {
                let Some(span) = Span::of(take, a, b) else { continue };
                if span.deviation_m <= rule.max_deviation_m && span.mean_m <= rule.max_length_m {
                    found.push((span.deviation_m, Bone::new(a, b, span.mean_m)?));
                }
            }
        }
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        let mut kept = vec![0; markers];
        let bones = found.into_iter().map(|(_, bone)| bone).filter(|bone| {
            let wanted = kept[bone.a] < rule.per_marker || kept[bone.b] < rule.per_marker;
            if wanted {
                kept[bone.a] += 1;
                kept[bone.b] += 1;
            }
            wanted
        });
        Self::new(bones)
    }

    /// The bones, in their given order.
    #[must_use]
    pub fn bones(&self) -> &[Bone] {
        &self.bones
    }

    /// Number of bones.
    #[must_use]
    pub fn len(&self) -> usize {
        self.bones.len()
    }

    /// Whether there is no bone.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bones.is_empty()
    }

    /// The bones that end at a marker.
    pub fn touching(&self, marker: usize) -> impl Iterator<Item = &Bone> {
        self.bones.iter().filter(move |bone| bone.other(marker).is_some())
    }

    /// Refuses bones whose markers a take does not have.
    ///
    /// # Errors
    /// [`CoreError::OutOfRange`].
    pub fn check(&self, take: &Take) -> Result<(), CoreError> {
        self.bones.iter().try_for_each(|bone| check_marker(take, bone.b))
    }
}

fn check_marker(take: &Take, marker: usize) -> Result<(), CoreError> {
    let (frames, markers) = (take.frames(), take.marker_count());
    if marker < markers {
        return Ok(());
    }
    Err(CoreError::OutOfRange { frame: 0, marker, frames, markers })
}

/// Mean and standard deviation of a distance over the frames that show both ends.
struct Span {
    mean_m: f64,
    deviation_m: f64,
}

impl Span {
    fn of(take: &Take, a: usize, b: usize) -> Option<Self> {
        let (mut n, mut mean, mut squares) = (0_usize, 0.0, 0.0);
        for d in (0..take.frames()).filter_map(|t| take.distance(t, a, b)) {
            n += 1;
            let step = d - mean;
            mean += step / n as f64;
            squares += step * (d - mean);
        }
        (n >= MIN_FRAMES && mean > 0.0)
            .then(|| Self { mean_m: mean, deviation_m: (squares / n as f64).sqrt() })
    }
}
