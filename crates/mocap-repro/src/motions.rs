use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
};

use mocap_core::{CoreError, MarkerKnowledge, Take};
use mocap_io::{MarkerFile, ReadOptions};
use ndarray::s;
use sha2::{Digest, Sha256};

use crate::ReproError;

/// A recording to cut gaps into.
#[derive(Debug, Clone)]
pub struct Motion {
    take: Take,
    digest: String,
    /// Other motions of the same subject with their digests.
    session: Vec<(String, Arc<Take>)>,
}

/// Recordings by name.
pub type Motions = BTreeMap<String, Arc<Motion>>;

/// Sampling rate of the CMU recordings, whose tables state none.
const CMU_RATE_HZ: f64 = 120.0;
/// Recordings on which parameters may be chosen: other takes than the nine on which methods are
/// compared, of several rooms and marker sets.
const ASIDE: [&str; 7] = [
    "cmu/paired/02_01.c3d",
    "cmu/paired/05_13.c3d",
    "cmu/paired/135_02.c3d",
    "hdm05/paired/HDM_dg_06-03_03_120.c3d",
    "captures/keenon+nimblephysics__nick_freeform_001.c3d",
    "captures/keenon+nimblephysics__squat.c3d",
    "hands/dfki_hand_embodiment_recording.tsv",
];
/// Longest part of such a recording that is used.
const ASIDE_S: f64 = 12.0;
const ENDINGS: [&str; 3] = ["c3d", "csv.gz", "csv"];

impl Motion {
    /// A recording as it is.
    #[must_use]
    pub fn new(take: Take) -> Self {
        let mut hasher = Sha256::new();
        hasher.update(take.rate_hz().to_le_bytes());
        for name in take.markers().names() {
            hasher.update(name.as_bytes());
            hasher.update([0]);
        }
        // Missing cells are one and the same NaN, so the digest is that of what was observed.
        for c in take.positions() {
            hasher.update(if c.is_nan() { f64::NAN } else { *c }.to_le_bytes());
        }
        Self { digest: hex(&hasher.finalize()[..8]), take, session: Vec::new() }
    }

    /// Reads the named recording from a folder; a table without a sampling rate counts as 120 Hz.
    ///
    /// # Errors
    /// [`ReproError::Motion`] if there is no such file, [`ReproError::Read`] if it is none.
    pub fn read(folder: &Path, name: &str) -> Result<Self, ReproError> {
        let paths = ENDINGS.map(|ending| folder.join(format!("{name}.{ending}")));
        let path: PathBuf = paths.into_iter().find(|path| path.is_file()).ok_or_else(|| {
            ReproError::Motion { motion: name.to_owned(), folder: folder.to_owned() }
        })?;
        let options = ReadOptions { rate_hz: Some(CMU_RATE_HZ), ..ReadOptions::default() };
        Ok(Self::new(MarkerFile::read(&path, &options)?.take().clone()))
    }

    /// Reads the recordings of the protocol `pseudo-gaps` from the folder of all data: those of its list that
    /// are there. Of each, the labelled markers that are seen most of the time are kept, and its
    /// middle 12 s.
    ///
    /// # Errors
    /// [`ReproError::Motion`] if none is there, [`ReproError::Read`] for one that cannot be read.
    pub fn read_aside(data: &Path) -> Result<Motions, ReproError> {
        let mut motions = Motions::new();
        for file in ASIDE {
            let path = data.join(file);
            if path.is_file() {
                let options = ReadOptions { rate_hz: Some(CMU_RATE_HZ), ..ReadOptions::default() };
                let file_name = path.file_stem().unwrap_or_default().to_string_lossy();
                let name = file_name.rsplit("__").next().unwrap_or_default().to_owned();
                let take = tidied(MarkerFile::read(&path, &options)?.take())?;
                motions.insert(name, Arc::new(Self::new(take)));
            }
        }
        if motions.is_empty() {
            let motion = ASIDE.join(", ");
            return Err(ReproError::Motion { motion, folder: data.to_owned() });
        }
        Ok(motions)
    }

    /// Reads each of the named recordings; those whose names begin alike, up to the first `_`, are of one session.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_all<'a>(
        folder: &Path,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Result<Motions, ReproError> {
        let mut read = BTreeMap::new();
        for name in names {
            if !read.contains_key(name) {
                read.insert(name.to_owned(), Self::read(folder, name)?);
            }
        }
        let shared: Vec<(String, String, Arc<Take>)> = read
            .iter()
            .map(|(name, motion)| (name.clone(), motion.digest.clone(), motion.take.clone().into()))
            .collect();
        let subject = |name: &str| name.split('_').next().unwrap_or_default().to_owned();
        let in_session = |(name, motion): (String, Self)| {
            let others =
                shared.iter().filter(|(of, ..)| *of != name && subject(of) == subject(&name));
            let session =
                others.map(|(_, digest, take)| (digest.clone(), Arc::clone(take))).collect();
            (name, Arc::new(Self { session, ..motion }))
        };
        Ok(read.into_iter().map(in_session).collect())
    }

    /// Other recordings of the same subject.
    pub(crate) fn session(&self) -> Vec<Arc<Take>> {
        self.session.iter().map(|(_, take)| Arc::clone(take)).collect()
    }

    /// What tells their recordings from others.
    pub(crate) fn session_digests(&self) -> Vec<&str> {
        self.session.iter().map(|(digest, _)| digest.as_str()).collect()
    }

    /// The recording.
    #[must_use]
    pub fn take(&self) -> &Take {
        &self.take
    }

    /// What tells two recordings apart.
    pub(crate) fn digest(&self) -> &str {
        &self.digest
    }
}

/// The labelled markers that are seen in nine tenths of the middle of a take, and that middle.
///
/// Files of captures hold reconstructed points without a name and points of models beside the markers;
/// where the markers of the CMU set are among them, the others are left out.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some thousand frames
fn tidied(take: &Take) -> Result<Take, CoreError> {
    let length = take.frames().min((ASIDE_S * take.rate_hz()).round() as usize);
    let start = (take.frames() - length) / 2;
    let seen = |m: usize| (start..start + length).filter(|&t| take.is_observed(t, m)).count();
    let known = MarkerKnowledge::cmu_41();
    let is_known = |m: usize| known.markers().iter().any(|name| name == take.markers().split(m).1);
    let is_cmu = (0..take.marker_count()).filter(|&m| is_known(m)).count() >= CMU_AT_LEAST;
    let keep: Vec<usize> = (0..take.marker_count())
        .filter(|&m| {
            10 * seen(m) >= 9 * length && if is_cmu { is_known(m) } else { named(take, m) }
        })
        .collect();
    let take = take.select(&keep)?;
    let middle = take.positions().slice(s![start..start + length, .., ..]).to_owned();
    Take::from_positions(Arc::clone(take.markers()), take.rate_hz(), middle)
}

/// Markers of the CMU set by which a recording is known to wear it.
const CMU_AT_LEAST: usize = 30;

fn named(take: &Take, marker: usize) -> bool {
    !take.markers().name(marker).starts_with(['*', '_'])
}

pub(crate) fn hex(bytes: &[u8]) -> String {
    let hex = |byte: &u8| {
        [byte >> 4, byte & 15].map(|half| char::from(b"0123456789abcdef"[usize::from(half)]))
    };
    bytes.iter().flat_map(hex).collect()
}
