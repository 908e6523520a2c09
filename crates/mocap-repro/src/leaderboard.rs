use std::{fmt, path::Path, str::FromStr};

use rand::RngExt as _;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use crate::{
    Entry, Finished, Hide, Motions, Reference, Report, ReproError, Row, Table, Trial,
    bolero::{FOLDER, LIST, LIST_CLASS},
    compare,
    figure::{Bars, Figure},
    read_trials, reference,
    report::{STATS_NOTE, stats_table},
    summarise,
};

/// A rule by which gaps are cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Protocol {
    /// The 90 trials with one marker over 10–50 % of a motion.
    Bolero90,
    /// 1, 3, 5 and 10 markers at once for 0.1, 0.5, 1 and 2 s.
    Multi,
    /// All markers of an arm or a leg for 0.5, 1 and 2 s.
    Limb,
    /// All markers for 10, 30 and 60 frames.
    Blackout,
}

impl Protocol {
    /// All protocols.
    pub const ALL: [Self; 4] = [Self::Bolero90, Self::Multi, Self::Limb, Self::Blackout];
}

impl fmt::Display for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bolero90 => "bolero-90",
            Self::Multi => "multi",
            Self::Limb => "limb",
            Self::Blackout => "blackout",
        })
    }
}

impl FromStr for Protocol {
    type Err = ReproError;

    fn from_str(text: &str) -> Result<Self, ReproError> {
        let named = Self::ALL.into_iter().find(|protocol| protocol.to_string() == text);
        named.ok_or_else(|| ReproError::Protocol { text: text.to_owned() })
    }
}

const LIMBS: [(&str, &[&str]); 4] = [
    ("left arm", &["LUPA", "LELB", "LFRM", "LWRA", "LWRB"]),
    ("right arm", &["RUPA", "RELB", "RFRM", "RWRA", "RWRB"]),
    ("left leg", &["LTHI", "LKNE", "LSHN", "LANK", "LHEE", "LTOE"]),
    ("right leg", &["RTHI", "RKNE", "RSHN", "RANK", "RHEE", "RTOE"]),
];
const MARKERS_AT_ONCE: [usize; 4] = [1, 3, 5, 10];
const MULTI_S: [f64; 4] = [0.1, 0.5, 1.0, 2.0];
const LIMB_S: [f64; 3] = [0.5, 1.0, 2.0];
const BLACKOUT_FRAMES: [usize; 3] = [10, 30, 60];
/// Frames that stay visible on either side of a gap.
const SEEN_FRAMES: usize = 10;

/// The trials of a protocol on the given motions. A gap that no motion is long enough for leaves its
/// class out; the rest depends on nothing but the motions' names, lengths and markers.
///
/// # Errors
/// As [`read_trials`], for [`Protocol::Bolero90`], which reads its list from `data`.
pub fn leaderboard_trials(
    protocol: Protocol,
    data: &Path,
    motions: &Motions,
) -> Result<Vec<Trial>, ReproError> {
    if protocol == Protocol::Bolero90 {
        let list = data.join(FOLDER).join(LIST);
        return read_trials(&list, "bolero-90", LIST_CLASS);
    }
    let mut trials = Vec::new();
    // Class by class, so that the tables read in order of difficulty.
    match protocol {
        Protocol::Multi => {
            for count in MARKERS_AT_ONCE {
                for seconds in MULTI_S {
                    let noun = if count == 1 { "marker" } else { "markers" };
                    let class = format!("{count} {noun}, {seconds} s");
                    trials.extend(cut(
                        protocol,
                        &class,
                        motions,
                        Length::Seconds(seconds),
                        |draw| draw.some(count),
                    ));
                }
            }
        }
        Protocol::Limb => {
            for seconds in LIMB_S {
                for (limb, markers) in LIMBS {
                    let class = format!("{limb}, {seconds} s");
                    trials.extend(cut(
                        protocol,
                        &class,
                        motions,
                        Length::Seconds(seconds),
                        |draw| draw.these(markers),
                    ));
                }
            }
        }
        Protocol::Blackout => {
            for frames in BLACKOUT_FRAMES {
                let class = format!("all markers, {frames} frames");
                trials.extend(cut(protocol, &class, motions, Length::Frames(frames), |_| {
                    vec!["*".to_owned()]
                }));
            }
        }
        Protocol::Bolero90 => {}
    }
    Ok(trials)
}

#[derive(Clone, Copy)]
enum Length {
    Seconds(f64),
    Frames(usize),
}

impl Length {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few seconds
    fn frames(self, rate_hz: f64) -> usize {
        match self {
            Self::Frames(frames) => frames,
            Self::Seconds(seconds) => (seconds * rate_hz).round() as usize,
        }
    }
}

/// Chooses markers of one motion.
struct Draw<'a> {
    rng: ChaCha8Rng,
    names: &'a [String],
}

impl Draw<'_> {
    /// So many different markers, or none if the motion has too few.
    fn some(&mut self, count: usize) -> Vec<String> {
        let mut left: Vec<&String> = self.names.iter().collect();
        // A neighbour has to stay.
        if left.len() <= count {
            return Vec::new();
        }
        (0..count).map(|_| left.swap_remove(self.rng.random_range(0..left.len())).clone()).collect()
    }

    /// Those of the named markers that the motion has.
    fn these(&mut self, wanted: &[&str]) -> Vec<String> {
        let bare = |name: &str| name.rsplit(':').next().unwrap_or(name).to_owned();
        self.names.iter().filter(|name| wanted.contains(&bare(name).as_str())).cloned().collect()
    }
}

/// One trial a motion.
fn cut(
    protocol: Protocol,
    class: &str,
    motions: &Motions,
    length: Length,
    choose: impl Fn(&mut Draw<'_>) -> Vec<String>,
) -> Vec<Trial> {
    let trial = |(name, motion): (&String, &std::sync::Arc<crate::Motion>)| {
        let take = motion.take();
        let frames = length.frames(take.rate_hz());
        let last_start = take.frames().checked_sub(frames + SEEN_FRAMES)?;
        if frames == 0 || last_start < SEEN_FRAMES {
            return None;
        }
        let seed = seed(&[&protocol.to_string(), class, name]);
        let rng = ChaCha8Rng::seed_from_u64(seed);
        let mut draw = Draw { rng, names: take.markers().names() };
        let markers = choose(&mut draw);
        let start = draw.rng.random_range(SEEN_FRAMES..=last_start);
        let hide = |marker: String| Hide { marker, start, end: start + frames };
        let hidden: Vec<Hide> = markers.into_iter().map(hide).collect();
        (!hidden.is_empty()).then(|| Trial {
            set: protocol.to_string(),
            class: class.to_owned(),
            name: format!("{name}, {class}"),
            motion: name.clone(),
            hidden,
            seed: 1,
            iterations: None,
        })
    };
    motions.iter().filter_map(trial).collect()
}

/// A seed for each place in the protocols, so that adding one changes no other: the FNV-1a hash.
fn seed(words: &[&str]) -> u64 {
    let bytes = words.iter().flat_map(|word| word.bytes().chain([0]));
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// The leader board from finished cells.
#[must_use]
pub fn leaderboard_report(cells: &[Finished<'_>]) -> Report {
    let rows = summarise(cells);
    let compared = compare(&rows, &Reference::built_in());
    let mut tables = vec![overview(&rows)];
    if !compared.is_empty() {
        tables.push(reference::table(&compared));
    }
    let all: Vec<&Row> = rows.iter().collect();
    tables.push(stats_table("leaderboard", "Every figure", STATS_NOTE, &all));
    let figures = sets(&rows).into_iter().map(|set| bars(&rows, set)).collect();
    Report {
        title: "Leader board of the gap-filling methods".to_owned(),
        intro: vec![
            "Every method sees the visible samples and nothing else, and chooses its own coordinates."
                .to_owned(),
        ],
        tables,
        figures,
        rows,
        duels: Vec::new(),
        compared,
    }
}

fn distinct<'a>(rows: &'a [Row], of: impl Fn(&'a Row) -> &'a str) -> Vec<&'a str> {
    let mut names = Vec::new();
    for row in rows {
        if !names.contains(&of(row)) {
            names.push(of(row));
        }
    }
    names
}

fn sets(rows: &[Row]) -> Vec<&str> {
    distinct(rows, |row| &row.set)
}

fn mean_mm(rows: &[Row], set: &str, class: &str, method: &str) -> Option<f64> {
    let is_it = |row: &&Row| row.set == set && row.class == class && row.method == method;
    rows.iter().find(is_it)?.stats.mm_mean
}

/// Methods by protocol and gap: mean error.
fn overview(rows: &[Row]) -> Table {
    let methods = distinct(rows, |row| &row.method);
    let mut columns = vec!["protocol", "gap"];
    columns.extend(&methods);
    let note = "Mean 3-D error in mm, mean over trials. An en dash: nothing was filled; the full table \
                says how many samples each method left open. A motion too short for a gap has no part \
                in its row: see n.";
    let mut table = Table::new("overview", "Mean error by protocol and gap", note, &columns);
    for set in sets(rows) {
        let own: Vec<Row> = rows.iter().filter(|row| row.set == set).cloned().collect();
        for class in distinct(&own, |row| &row.class) {
            let mut row = vec![Entry::text(set), Entry::text(class)];
            let mean = |method: &&str| Entry::Fixed(mean_mm(rows, set, class, method), 1);
            row.extend(methods.iter().map(mean));
            table.rows.push(row);
        }
    }
    table
}

fn bars(rows: &[Row], set: &str) -> Figure {
    let own: Vec<Row> = rows.iter().filter(|row| row.set == set).cloned().collect();
    let classes = distinct(&own, |row| &row.class);
    let series = distinct(&own, |row| &row.method).into_iter().map(|method| {
        let means = classes.iter().map(|class| mean_mm(rows, set, class, method)).collect();
        (method.to_owned(), means)
    });
    Figure::Bars(Bars {
        id: format!("leaderboard-{set}"),
        title: format!("Mean 3-D error, protocol {set}"),
        y_label: "mean 3-D error [mm]".to_owned(),
        series: series.collect(),
        groups: classes.into_iter().map(str::to_owned).collect(),
    })
}
