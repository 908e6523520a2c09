use mocap_core::CoreError;
use thiserror::Error;

/// Why a body cannot be described, or a take cannot be solved with it.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum IkError {
    /// A line of a body file that cannot be read.
    #[error("{file}:{line}: `{text}`: {rule}")]
    BodyLine {
        /// Name of the file.
        file: String,
        /// One-based line.
        line: usize,
        /// The line.
        text: String,
        /// What would be right.
        rule: &'static str,
    },
    /// A body without joints or markers.
    #[error("{file} describes no {what}; a body needs a joint and a marker at least")]
    EmptyBody {
        /// Name of the file.
        file: String,
        /// What is missing.
        what: &'static str,
    },
    /// A joint of the marker map that a skeleton lacks.
    #[error(
        "marker `{marker}` sits on joint `{joint}`, which the skeleton does not have; name its joints as \
         the map does, or write a body file for it"
    )]
    NoSuchJoint {
        /// The marker.
        marker: String,
        /// The joint.
        joint: String,
    },
    /// A joint of a skeleton whose place is no number.
    #[error("joint `{joint}` has no finite place; give its offset from its parent in metres")]
    NoPlace {
        /// The joint.
        joint: String,
    },
    /// A second joint of a marker that does not hang on the first.
    #[error(
        "marker `{marker}` sits on `{near}` and `{far}`, but `{far}` is no child of `{near}`; a marker \
         rides on one bone, or on two that meet in a joint"
    )]
    NotNeighbours {
        /// The marker.
        marker: String,
        /// The first joint.
        near: String,
        /// The second joint.
        far: String,
    },
    /// Labels of which the map knows none, or too few on the root.
    #[error(
        "the marker map of `{body}` finds {found} markers of the take on the joint `{root}`, and three are \
         needed to tell where the body is: {wanted}; the take has {labels}; label them, add their names as `alias` lines to a \
         body file, or name another body with --skeleton"
    )]
    RootMarkers {
        /// The body.
        body: String,
        /// Its root joint.
        root: String,
        /// Markers found.
        found: usize,
        /// Markers of the root that the body knows.
        wanted: String,
        /// The first labels of the take.
        labels: String,
    },
    /// Labels that the map does not know, where every marker has to be on the body.
    #[error(
        "the marker map of `{body}` does not know {labels}; say where they sit in `marker` lines of a body file, or which \
         markers they are in `alias` lines; without --strict they are left out"
    )]
    Unmapped {
        /// The body.
        body: String,
        /// The labels.
        labels: String,
    },
    /// No frame shows three markers of the root together.
    #[error(
        "no frame shows three markers of the joint `{root}` together, so that the body cannot be found; \
         fill their gaps first, for example by `mocap fill --method bolero-sc`"
    )]
    RootNeverSeen {
        /// The root joint.
        root: String,
    },
    /// Two labels of a take that mean one marker of the map.
    #[error(
        "`{first}` and `{second}` of the take are both marker `{marker}` of the map; the take holds two \
         subjects or a label twice: solve one subject at a time"
    )]
    TwoLabels {
        /// Marker of the map.
        marker: String,
        /// The one label.
        first: String,
        /// The other label.
        second: String,
    },
    /// No body to solve for.
    #[error("no body is given; name one, such as the built-in `cmu-41`")]
    NoBody,
    /// A motion that is not of the take.
    #[error(
        "the motion has {poses} frames and the take {frames}; a body is learnt from a take and the motion \
         of the same frames"
    )]
    Frames {
        /// Frames of the take.
        frames: usize,
        /// Frames of the motion.
        poses: usize,
    },
    /// A motion that is not where the markers are.
    #[error(
        "the markers lie {rms_m:.2} m (rms) from the joints that carry them, which is no body's size; take and \
         motion must be of the same performance, in the same units and axes"
    )]
    Apart {
        /// Root mean square distance of a marker from its joint, in metres.
        rms_m: f64,
    },
    /// Frames of a T-pose in which the wearer moves.
    #[error(
        "marker `{marker}` moves by {moves_m:.2} m in these frames; name frames in which the wearer stands still"
    )]
    NotStill {
        /// The marker that moves most.
        marker: String,
        /// Root mean square distance from its mean, in metres.
        moves_m: f64,
    },
    /// Frames that are no T-pose.
    #[error(
        "marker `{marker}` lies {off_m:.2} m from where a T-pose would have it; name frames in which the wearer stands with \
         legs straight and arms straight out to the sides, or fit the body on frames that differ with --calibrate-on"
    )]
    NotTPose {
        /// The marker that is farthest from there.
        marker: String,
        /// Its distance in metres.
        off_m: f64,
    },
    /// A take without frames.
    #[error("the take has no frame; there is nothing to solve")]
    NoFrames,
    /// A parameter out of its range.
    #[error("parameter `{field}` is {value}; it must be {rule}")]
    Parameter {
        /// Name of the parameter.
        field: &'static str,
        /// The value as given.
        value: f64,
        /// The allowed range.
        rule: &'static str,
    },
    /// A value that the core types refuse.
    #[error(transparent)]
    Core(#[from] CoreError),
}
