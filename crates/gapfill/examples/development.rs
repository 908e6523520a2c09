//! Compares methods on takes that no published list of trials uses, for those who develop them.
//!
//! ```sh
//! MOCAP_DATA=… cargo run --release -p gapfill --example development -- tuning auto,ridge
//! ```
//!
//! The first word names the takes: `tuning` for choosing, `checking` for what was chosen, `ninety` for the list of
//! [Li10]. The second names methods, `+session` behind one gives it the other takes of the trial's session; the third,
//! if given, keeps the classes that contain it, and the fourth the takes whose path does.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a tool for developers")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "frame numbers")]

use std::{collections::BTreeMap, rc::Rc, sync::Arc, time::Instant};

use augment::Limb;
use gapfill::{Options, build};
use mocap_core::{GapFiller, Holdout, Mask, Take, geometry::distance};
use mocap_io::{MarkerFile, ReadOptions};
use mocap_testkit::{motion, ninety_trials, recording};
use ndarray::s;

/// File, frames, and whether it is for choosing.
const TAKES: &[(&str, std::ops::Range<usize>, bool)] = &[
    ("cmu/paired/135_02.c3d", 0..500, true),
    ("cmu/paired/135_02.c3d", 500..1300, true),
    ("cmu/paired/135_02.c3d", 1300..2500, true),
    ("cmu/paired/135_02.c3d", 2500..3200, true),
    ("cmu/paired/135_02.c3d", 3200..4400, true),
    ("cmu/paired/135_02.c3d", 4400..5202, true),
    ("cmu/paired/05_13.c3d", 0..1095, true),
    ("captures/keenon+nimblephysics__nick_freeform_001.c3d", 0..1101, true),
    ("captures/keenon+nimblephysics__squat.c3d", 0..1300, true),
    ("cmu/paired/02_01.c3d", 0..343, false),
    ("hdm05/paired/HDM_dg_06-03_03_120.c3d", 0..202, false),
    ("captures/OlafHaag+joint-localization__fullbody_44Markers_clean_120fps.c3d", 0..600, false),
    ("captures/OlafHaag+joint-localization__fullbody_44Markers_clean_120fps.c3d", 600..1800, false),
    (
        "captures/OlafHaag+joint-localization__fullbody_44Markers_clean_120fps.c3d",
        1800..3000,
        false,
    ),
    (
        "captures/OlafHaag+joint-localization__fullbody_44Markers_clean_120fps.c3d",
        3000..3972,
        false,
    ),
    ("captures/cadop+pyCGM__Movement_trial.c3d", 0..323, false),
];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let which = arguments.first().map_or("tuning", String::as_str);
    let methods = arguments.get(1).map_or("auto", String::as_str);
    let only = arguments.get(2).map_or("", String::as_str);
    let trials = if which == "ninety" {
        ninety()
    } else {
        development(which == "tuning", arguments.get(3).map_or("", String::as_str))
    };
    for method in methods.split(',') {
        let id = method.trim_end_matches("+session");
        let mut scores: BTreeMap<&str, Vec<Score>> = BTreeMap::new();
        for Trial { class, holdout, session } in trials.iter().filter(|t| t.class.contains(only)) {
            let session = if id == method { Vec::new() } else { session.to_vec() };
            let filler = build(id, &Options { session, ..Options::default() }).unwrap();
            let score = Score::of(filler.as_ref(), holdout);
            if std::env::var_os("EACH").is_some() {
                println!("{class} {:?} {:.2}", holdout.visible().gaps()[0], mean(&score.errors_mm));
            }
            scores.entry(class).or_default().push(score);
        }
        let mut all = Vec::new();
        for (class, scores) in scores {
            print(method, class, &scores);
            all.extend(scores);
        }
        print(method, "all", &all);
    }
}

/// One or more gaps in one take.
struct Trial {
    class: String,
    holdout: Holdout,
    /// Other takes of the same person with the same markers.
    session: Rc<[Arc<Take>]>,
}

/// The trials of [Li10]; sessions are the other motions of the subject.
fn ninety() -> Vec<Trial> {
    let list = recording("cmu/bolero-nine/trials90.csv").unwrap();
    let list = std::fs::read_to_string(list).unwrap();
    let names: Vec<&str> = list.lines().skip(1).filter_map(|line| line.split(',').nth(1)).collect();
    let subject = |name: &str| name.split('_').next().unwrap_or_default().to_owned();
    let takes: BTreeMap<&str, Arc<Take>> =
        names.iter().map(|&name| (name, Arc::new(motion(name).unwrap()))).collect();
    let trial = |(&name, holdout): (&&str, Holdout)| {
        let others = takes.iter().filter(|(of, _)| **of != name && subject(of) == subject(name));
        let session = others.map(|(_, take)| Arc::clone(take)).collect();
        Trial { class: "ninety".to_owned(), holdout, session }
    };
    names.iter().zip(ninety_trials().unwrap()).map(trial).collect()
}

/// The errors of one trial.
struct Score {
    errors_mm: Vec<f64>,
    /// Errors as multiples of sigma.
    in_sigmas: Vec<f64>,
    open: usize,
    square_m2: f64,
    seconds: f64,
}

impl Score {
    fn of(filler: &dyn GapFiller, holdout: &Holdout) -> Self {
        let start = Instant::now();
        let filled = filler.fill(holdout.visible());
        let seconds = start.elapsed().as_secs_f64();
        let mut score =
            Self { errors_mm: Vec::new(), in_sigmas: Vec::new(), open: 0, square_m2: 0.0, seconds };
        // A method may refuse a take whose markers it does not know.
        let Ok(filled) = filled else {
            score.open = holdout.hidden().count();
            return score;
        };
        for (t, m) in holdout.hidden().iter() {
            let Some(found) = filled.take().position(t, m) else {
                score.open += 1;
                continue;
            };
            let error = distance(found, holdout.truth().position(t, m).unwrap());
            score.errors_mm.push(1e3 * error);
            score.square_m2 += error * error / 3.0;
            score.in_sigmas.extend(filled.sigma_m(t, m).map(|sigma| error / sigma));
        }
        score
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn print(method: &str, class: &str, scores: &[Score]) {
    let mut means: Vec<f64> =
        scores.iter().filter(|s| !s.errors_mm.is_empty()).map(|s| mean(&s.errors_mm)).collect();
    means.sort_by(f64::total_cmp);
    let n = means.len();
    if n == 0 {
        println!("{method:10} {class:20} nothing filled");
        return;
    }
    let median = 0.5 * (means[(n - 1) / 2] + means[n / 2]);
    let mut sigmas: Vec<f64> = scores.iter().flat_map(|s| s.in_sigmas.iter().copied()).collect();
    sigmas.sort_by(f64::total_cmp);
    let quantile = |share: f64| sigmas.get((share * sigmas.len() as f64) as usize).copied();
    let radii = (quantile(0.683).unwrap_or(f64::NAN), quantile(0.954).unwrap_or(f64::NAN));
    let within =
        |k: f64| sigmas.iter().filter(|&&s| s <= k).count() as f64 / sigmas.len().max(1) as f64;
    let square: f64 = mean(
        &scores
            .iter()
            .filter(|s| !s.errors_mm.is_empty())
            .map(|s| s.square_m2 / s.errors_mm.len() as f64)
            .collect::<Vec<_>>(),
    );
    let logs = mean(&means.iter().map(|m| m.ln()).collect::<Vec<_>>()).exp();
    let open: usize = scores.iter().map(|s| s.open).sum();
    let seconds = mean(&scores.iter().map(|s| s.seconds).collect::<Vec<_>>());
    println!(
        "{method:10} {class:20} n {n:3} mean {:7.3} median {median:7.3} geo {logs:7.3} mm, mse {square:.2e}, \
         1 sigma {:.3}, 2 sigma {:.3}, 68 % {:.2}, 95 % {:.2}, open {open}, {seconds:.4} s",
        mean(&means),
        within(1.0),
        within(2.0),
        radii.0,
        radii.1
    );
}

/// Trials on the takes for choosing or for checking.
///
/// The session of a cut is made of the other cuts of the same recording.
fn development(choosing: bool, only: &str) -> Vec<Trial> {
    let chosen = TAKES.iter().enumerate();
    let chosen = chosen.filter(|(_, (path, _, tuning))| *tuning == choosing && path.contains(only));
    let cuts: Vec<(usize, &str, Arc<Take>)> = chosen
        .map(|(k, (path, frames, _))| {
            let file =
                MarkerFile::read(&recording(path).unwrap(), &ReadOptions::default()).unwrap();
            (k, *path, Arc::new(markers_of_a_body(&cut(file.take(), frames.clone()))))
        })
        .collect();
    let mut all = Vec::new();
    for (k, path, take) in &cuts {
        let others = cuts.iter().filter(|(other, of, _)| other != k && of == path);
        let session: Rc<[Arc<Take>]> = others.map(|(_, _, take)| Arc::clone(take)).collect();
        let mut trials: Vec<(String, Holdout)> = Vec::new();
        let mut dice = Dice(1000 + *k as u64);
        for _ in 0..6 {
            let share = 0.1 + 0.4 * dice.unit();
            trials.extend(dice.hide(
                take,
                "1 × 10–50 %",
                1,
                (share * take.frames() as f64) as usize,
            ));
        }
        for (markers, seconds, repeats) in
            [(1, 0.1, 4), (1, 0.5, 3), (1, 2.0, 2), (5, 0.5, 1), (5, 2.0, 1), (10, 0.5, 1)]
        {
            for _ in 0..repeats {
                let length = (seconds * take.rate_hz()) as usize;
                trials.extend(dice.hide(
                    take,
                    &format!("{markers} × {seconds} s"),
                    markers,
                    length,
                ));
            }
        }
        for limb in Limb::ALL {
            let markers = limb.markers(take.markers());
            for seconds in [0.5, 2.0] {
                let length = (seconds * take.rate_hz()) as usize;
                trials.extend(dice.hide_these(
                    take,
                    &format!("limb {seconds} s"),
                    &markers,
                    length,
                ));
            }
        }
        let everything: Vec<usize> = (0..take.marker_count()).collect();
        for frames in [10, 30, 60] {
            for _ in 0..2 {
                trials.extend(dice.hide_these(
                    take,
                    &format!("black-out {frames}"),
                    &everything,
                    frames,
                ));
            }
        }
        let trial = |(class, holdout)| Trial { class, holdout, session: Rc::clone(&session) };
        all.extend(trials.into_iter().map(trial));
    }
    all
}

fn cut(take: &Take, frames: std::ops::Range<usize>) -> Take {
    let end = frames.end.min(take.frames());
    let positions = take.positions().slice(s![frames.start..end, .., ..]).to_owned();
    Take::from_positions(std::sync::Arc::clone(take.markers()), take.rate_hz(), positions).unwrap()
}

/// The markers of a CMU or motion-library body, without unlabelled and computed points, of those that are seen
/// always.
fn markers_of_a_body(take: &Take) -> Take {
    let bare = |m: usize| take.markers().split(m).1.to_owned();
    let seen = |m: usize| take.observed().marker(m).iter().all(|&seen| seen);
    let is_marker = |name: &str| {
        !name.starts_with('*')
            && (!name.ends_with(['0', 'O', 'A', 'L', 'P'])
                || name == "C7"
                || name == "T10"
                || name == "ARIEL"
                || name == "LHEL"
                || name == "RHEL"
                || name.starts_with('M'))
    };
    let keep: Vec<usize> =
        (0..take.marker_count()).filter(|&m| seen(m) && is_marker(&bare(m))).take(54).collect();
    take.select(&keep).unwrap()
}

/// `SplitMix64`.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn hide(
        &mut self,
        take: &Take,
        class: &str,
        count: usize,
        length: usize,
    ) -> Option<(String, Holdout)> {
        let mut left: Vec<usize> = (0..take.marker_count()).collect();
        let markers: Vec<usize> =
            (0..count).map(|_| left.swap_remove(self.below(left.len()))).collect();
        self.hide_these(take, class, &markers, length)
    }

    fn hide_these(
        &mut self,
        take: &Take,
        class: &str,
        markers: &[usize],
        length: usize,
    ) -> Option<(String, Holdout)> {
        let room = take.frames().checked_sub(length + 20).filter(|_| !markers.is_empty())?;
        let start = 10 + self.below(room.max(1));
        let hidden = Mask::from_fn(take.frames(), take.marker_count(), |t, m| {
            (start..start + length).contains(&t) && markers.contains(&m)
        });
        let holdout = Holdout::new(take.clone(), &hidden).unwrap();
        (holdout.hidden().count() > 0).then(|| (class.to_owned(), holdout))
    }
}
