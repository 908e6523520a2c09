//! The evaluation of [Li10]: what is run for it.

use std::{path::Path, sync::Arc};

use augment::{GapSampler, GapSamplerParams, Occluder, PerFrameParams, Preset, Unlisted};

use crate::{
    Coordinates, Hide, Knowledge, Matrix, Motion, Motions, ReproError, Trial, Variant,
    fixture_trials, protocol::hides, read_trials, trial::hide,
};

mod findings;
mod paper_figures;
mod report;
mod sweep_figures;
mod sweeps;
mod table_one;
mod trial_figures;

pub use report::bolero_report;

/// Folder of the nine motions of [Li10] within the data.
pub(crate) const FOLDER: &str = "cmu/bolero-nine";
pub(crate) const LIST: &str = "trials90.csv";
pub(crate) const LIST_CLASS: &str = "10\u{2013}50 % of the motion";
const RANDOM_CLASS: &str = "1\u{2013}100 % of the motion";
/// Names of the sets of trials.
mod set {
    pub(super) const CASES: &str = "cases";
    pub(super) const LISTED: &str = "trials90";
    pub(super) const PART: &str = "trials35";
    pub(super) const RANDOM: &str = "random90";
    pub(super) const MASKS: &str = "masks";
    pub(super) const LAMBDA: &str = "lambda";
    pub(super) const SEEDS: &str = "seeds";
    pub(super) const CAPS: &str = "iterations";
}
/// The part of the 90 trials that the reference figures are of: the first five of each of these motions.
const PART_CLASS: &str = "35 of the 90, as in the reference";
const PART_MOTIONS: [&str; 7] =
    ["127_07", "141_16", "141_04", "132_32", "80_10", "132_43", "143_22"];
const PART_TRIALS: usize = 5;
/// Trials of each motion by the random rule.
const RANDOM_TRIALS: usize = 10;

/// What the evaluation is run on.
#[derive(Debug, Clone)]
pub struct Evaluation {
    motions: Motions,
    cases: Vec<Trial>,
    listed: Vec<Trial>,
    part: Vec<Trial>,
    random: Vec<Trial>,
    masks: Vec<Trial>,
    /// The cases that stand in the figures of the paper, by name.
    walking: String,
    running: String,
    blackout: String,
    /// Frame of the stills, from 1, for walking and running.
    stills: [usize; 2],
    sweeps: sweeps::Sweeps,
}

impl Evaluation {
    /// The case studies of [Li10], a black-out, the 90 trials of one marker over 10–50 % of a motion, and
    /// 90 by the rule of the authors' script, over 1–100 %.
    ///
    /// # Errors
    /// As [`read_trials`] and [`Motion::read`].
    pub fn of_paper(data: &Path) -> Result<Self, ReproError> {
        let listed = read_trials(&data.join(FOLDER).join(LIST), set::LISTED, LIST_CLASS)?;
        let arm = ["RELB", "RFRM", "RWRA", "RWRB", "RFIN"];
        let cases = [
            case("127_07", "RKNE+RSHN", &["RKNE", "RSHN"], 25..=90, None),
            case("132_43", "RELB+RFRM", &["RELB", "RFRM"], 100..=500, None),
            case("80_10", "right arm", &arm, 100..=300, None),
            case("132_43", "black-out", &["*"], 300..=324, None),
        ];
        let motions = Motion::read_all(&data.join(FOLDER), names(&listed, &cases))?;
        Ok(Self {
            part: PART_MOTIONS.iter().flat_map(|motion| first(&listed, motion)).collect(),
            random: random_trials(&motions, RANDOM_TRIALS)?,
            masks: masks(&motions, "132_43", ["RELB", "LKNE", "C7"])?,
            running: cases[0].name.clone(),
            walking: cases[1].name.clone(),
            blackout: cases[3].name.clone(),
            stills: [241, 70],
            sweeps: sweeps::Sweeps::full(),
            cases: cases.into(),
            listed,
            motions,
        })
    }

    /// The same on the project's own recordings in `folder`, made small.
    ///
    /// # Errors
    /// As [`Motion::read`].
    pub fn of_fixtures(folder: &Path) -> Result<Self, ReproError> {
        let listed = fixture_trials();
        let cases = [
            case("run", "RKNE+RSHN", &["RKNE", "RSHN"], 90..=149, None),
            case("throw", "RELB+RFRM", &["RELB", "RFRM"], 30..=79, None),
            case("jump", "black-out", &["*"], 55..=66, None),
        ];
        let motions = Motion::read_all(folder, names(&listed, &cases))?;
        Ok(Self {
            part: Vec::new(),
            random: random_trials(&motions, 1)?,
            masks: masks(&motions, "jump", ["RELB", "LKNE", "C7"])?,
            running: cases[0].name.clone(),
            walking: cases[1].name.clone(),
            blackout: cases[2].name.clone(),
            stills: [55, 120],
            sweeps: sweeps::Sweeps::quick(),
            cases: cases.into(),
            listed,
            motions,
        })
    }

    /// All that is to be computed. The case studies, the list and the odd masks are run in each of the
    /// coordinates; the random rule and the sweeps in body coordinates with the knowledge of an oracle,
    /// as in the paper.
    #[must_use]
    pub fn matrices(
        &self,
        variants: &[Variant],
        coordinates: &[Coordinates],
        iterations: Option<usize>,
    ) -> Vec<Matrix> {
        let base = Matrix {
            motions: self.motions.clone(),
            trials: Vec::new(),
            variants: variants.to_vec(),
            coordinates: coordinates.to_vec(),
            knowledge: vec![Knowledge::Oracle, Knowledge::Visible],
            iterations,
        };
        let main = [&self.cases, &self.listed, &self.part].into_iter().flatten().cloned().collect();
        let as_paper = |trials: &[Trial]| Matrix {
            trials: trials.to_vec(),
            coordinates: vec![Coordinates::Body],
            knowledge: vec![Knowledge::Oracle],
            ..base.clone()
        };
        let mut matrices = vec![
            Matrix { trials: main, ..base.clone() },
            as_paper(&self.random),
            Matrix {
                trials: self.cases.clone(),
                coordinates: vec![Coordinates::World],
                knowledge: vec![Knowledge::Oracle],
                ..base.clone()
            },
            Matrix {
                trials: self.masks.clone(),
                knowledge: vec![Knowledge::Visible],
                ..base.clone()
            },
        ];
        let (running, walking, blackout) =
            (self.case(&self.running), self.case(&self.walking), self.case(&self.blackout));
        let sweeps = self.sweeps.matrices(variants, [running, walking, blackout], as_paper);
        matrices.extend(sweeps);
        matrices
    }

    fn case(&self, name: &str) -> Option<&Trial> {
        self.cases.iter().find(|trial| trial.name == name)
    }

    fn motion(&self, trial: &Trial) -> Option<&Arc<Motion>> {
        self.motions.get(&trial.motion)
    }
}

fn names<'a>(listed: &'a [Trial], cases: &'a [Trial]) -> impl Iterator<Item = &'a str> {
    listed.iter().chain(cases).map(|trial| trial.motion.as_str())
}

/// Hides the same frames of several markers, counted from 1.
fn case(
    motion: &str,
    what: &str,
    markers: &[&str],
    frames: std::ops::RangeInclusive<usize>,
    iterations: Option<usize>,
) -> Trial {
    let (first, last) = frames.into_inner();
    let name = format!("{motion} {what} {first}\u{2013}{last}");
    Trial {
        set: set::CASES.to_owned(),
        class: name.clone(),
        name,
        motion: motion.to_owned(),
        hidden: hide(markers, first, last),
        seed: 1,
        iterations,
    }
}

/// These ask for the very computations of the list, which are done once.
fn first(listed: &[Trial], motion: &str) -> Vec<Trial> {
    let of_motion = listed.iter().filter(|trial| trial.motion == motion).take(PART_TRIALS);
    let part = |trial: &Trial| Trial {
        set: set::PART.to_owned(),
        class: PART_CLASS.to_owned(),
        ..trial.clone()
    };
    of_motion.map(part).collect()
}

/// Trials by the rule of the authors' script: the length uniform over 1 to all frames, the start uniform
/// over all that fit, the marker uniform over all. Its draws are our own, theirs are not published.
fn random_trials(motions: &Motions, each: usize) -> Result<Vec<Trial>, ReproError> {
    let mut by_length: Vec<(&String, &Arc<Motion>)> = motions.iter().collect();
    by_length.sort_by_key(|(_, motion)| motion.take().frames());
    let mut trials = Vec::new();
    for (motion, take) in by_length.into_iter().map(|(name, motion)| (name, motion.take())) {
        for number in 1..=each {
            let seed = trials.len() as u64 + 1;
            let holdout = augment::random_segment(take, 1, 1..=take.frames(), seed)?;
            let gaps = metrics::gap_length_classes(holdout.hidden(), take.rate_hz(), &[]);
            trials.push(Trial {
                set: set::RANDOM.to_owned(),
                class: RANDOM_CLASS.to_owned(),
                name: format!("{motion} ({number})"),
                motion: motion.clone(),
                hidden: hides(take, &gaps.unwrap_or_default().concat()),
                seed,
                iterations: None,
            });
        }
    }
    Ok(trials)
}

/// Shares of the take that the odd masks hide.
const SCATTER: f64 = 0.2;

/// Masks that are no tidy gaps: single samples, both ends of the take, and many gaps that overlap.
fn masks(motions: &Motions, name: &str, markers: [&str; 3]) -> Result<Vec<Trial>, ReproError> {
    let Some(take) = motions.get(name).map(|motion| motion.take()) else { return Ok(Vec::new()) };
    let trial = |what: &str, hidden: Vec<Hide>| Trial {
        set: set::MASKS.to_owned(),
        class: what.to_owned(),
        name: format!("{name}, {what}"),
        motion: name.to_owned(),
        hidden,
        seed: 1,
        iterations: None,
    };
    let runs = |holdout: &mocap_core::Holdout| {
        let gaps = metrics::gap_length_classes(holdout.hidden(), take.rate_hz(), &[]);
        hides(take, &gaps.unwrap_or_default().concat())
    };
    let scattered = augment::hide_per_frame(take, &PerFrameParams { deviation: SCATTER, seed: 1 })?;
    let edge = take.frames() / 10;
    let mut ends = hide(&markers, 1, edge);
    ends.extend(hide(&markers, take.frames() - edge + 1, take.frames()));
    let params = GapSamplerParams {
        occlusion: SCATTER,
        unlisted: Unlisted::Mean,
        occluder: Some(Occluder::default()),
        seed: 1,
        ..GapSamplerParams::default()
    };
    let model = Preset::FrontWaist.model()?.at_rate(take.rate_hz())?;
    let overlapping = GapSampler::new(model, params)?.sample(take)?.holdout;
    Ok(vec![
        trial("single samples", runs(&scattered)),
        trial("both ends", ends),
        trial("overlapping gaps", runs(&overlapping)),
    ])
}
