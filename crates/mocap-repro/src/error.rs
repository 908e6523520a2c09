use std::path::PathBuf;

use mocap_core::CoreError;
use thiserror::Error;

/// Why a matrix cannot be set up, run or reported.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReproError {
    /// A method that the registry refuses.
    #[error("`{text}` is no method to run")]
    Method {
        /// As given.
        text: String,
        /// What the registry says.
        #[source]
        source: gapfill::BuildError,
    },
    /// An option of a method that is not understood.
    #[error(
        "`{option}` in `{text}` is no option of this method; it takes {known}, written `METHOD+option=value`"
    )]
    Variant {
        /// The method as given.
        text: String,
        /// The part that is not understood.
        option: String,
        /// What may be written instead.
        known: String,
    },
    /// A motion that there is no file for.
    #[error("no motion `{motion}`: {} holds no file {motion}.c3d, .csv.gz or .csv", .folder.display())]
    Motion {
        /// Name of the motion.
        motion: String,
        /// Where it was looked for.
        folder: PathBuf,
    },
    /// A recording that cannot be read.
    #[error("cannot read a motion")]
    Read(#[from] mocap_io::ReadError),
    /// None of the recordings that synthetic people are compared with.
    #[error("{} holds none of the recordings below `cmu` that synthetic people are compared with", .folder.display())]
    NoTakes {
        /// Where they were looked for.
        folder: PathBuf,
    },
    /// A synthetic take that cannot be made.
    #[error("cannot synthesise a take")]
    Synth(#[from] mocap_synth::SynthError),
    /// A list of trials without a column that it needs.
    #[error("{} has no column `{column}`; it needs {needed} and has {found}", .path.display())]
    Column {
        /// The list.
        path: PathBuf,
        /// The missing column.
        column: &'static str,
        /// All columns that are needed.
        needed: String,
        /// The columns that are there.
        found: String,
    },
    /// A trial that makes no sense.
    #[error("line {line} of {}: {column} `{value}` must be {rule}", .path.display())]
    Trial {
        /// The list.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// The column.
        column: &'static str,
        /// What stands there.
        value: String,
        /// What may stand there.
        rule: String,
    },
    /// A trial that does not fit its motion.
    #[error("trial `{trial}` does not fit motion `{motion}`")]
    Misfit {
        /// Name of the trial.
        trial: String,
        /// Name of the motion.
        motion: String,
        /// Why not.
        #[source]
        source: CoreError,
    },
    /// A trial hides samples that the motion itself lacks, so that nothing can be scored.
    #[error(
        "trial `{trial}` hides nothing that motion `{motion}` shows; choose frames in which its markers were measured"
    )]
    NothingHidden {
        /// Name of the trial.
        trial: String,
        /// Name of the motion.
        motion: String,
    },
    /// A matrix without cells.
    #[error(
        "the matrix is empty: it has {trials} trials and {methods} methods; name at least one of each"
    )]
    Empty {
        /// Trials.
        trials: usize,
        /// Methods.
        methods: usize,
    },
    /// A name that is no protocol.
    #[error(
        "`{text}` is no protocol; the protocols are bolero-90, multi, limb, blackout, realistic and pseudo-gaps"
    )]
    Protocol {
        /// As given.
        text: String,
    },
    /// A file that cannot be read or written.
    #[error("cannot access {}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        #[source]
        source: std::io::Error,
    },
    /// A file that is no table of comma-separated values.
    #[error("{} is no table of comma-separated values", .path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// Where and why.
        #[source]
        source: csv::Error,
    },
    /// A report that cannot be written.
    #[error("cannot write a report")]
    Write(#[from] mocap_io::WriteError),
    /// A figure that cannot be drawn.
    #[error("cannot draw a figure")]
    Figure(#[from] mocap_report::ReportError),
    /// The threads cannot be started.
    #[error("cannot start the threads")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// Gaps that cannot be drawn.
    #[error("cannot draw gaps")]
    Sampler(#[from] augment::AugmentError),
    /// A value that the core types refuse.
    #[error(transparent)]
    Core(#[from] CoreError),
}
