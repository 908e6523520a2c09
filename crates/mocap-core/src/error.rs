use thiserror::Error;

/// A value that the types of this crate refuse.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CoreError {
    /// A marker without a name.
    #[error("marker {index} has an empty name; give every marker a name")]
    EmptyMarkerName {
        /// Position of the marker in the list.
        index: usize,
    },
    /// Two markers share one name.
    #[error("marker name `{name}` stands at {first} and {second}; names must be unique")]
    DuplicateMarkerName {
        /// The shared name.
        name: String,
        /// Position of its first use.
        first: usize,
        /// Position of its second use.
        second: usize,
    },
    /// A name that is in no marker set at hand.
    #[error("no marker is called `{name}`{}", suggestion(.similar))]
    UnknownMarker {
        /// The name that was asked for.
        name: String,
        /// Names of the set that look alike.
        similar: Vec<String>,
    },
    /// An array whose shape does not fit.
    #[error("{what} has shape {found:?}, but {expected:?} is needed")]
    Shape {
        /// Which array.
        what: &'static str,
        /// The shape that fits.
        expected: Vec<usize>,
        /// The shape that came.
        found: Vec<usize>,
    },
    /// A sampling rate that is no rate.
    #[error("a sampling rate of {rate_hz} Hz is not positive and finite")]
    Rate {
        /// The rate as given.
        rate_hz: f64,
    },
    /// An observed sample with NaN or infinity in it.
    #[error(
        "marker `{marker}` is marked as observed in frame {frame}, but a coordinate is not finite; \
         leave the cell out of the observed mask"
    )]
    NotFinite {
        /// Zero-based frame.
        frame: usize,
        /// Name of the marker.
        marker: String,
    },
    /// A cell outside the take.
    #[error(
        "cell (frame {frame}, marker {marker}) lies outside of {frames} frames × {markers} markers"
    )]
    OutOfRange {
        /// Zero-based frame.
        frame: usize,
        /// Marker index.
        marker: usize,
        /// Frames of the take.
        frames: usize,
        /// Markers of the take.
        markers: usize,
    },
    /// A bone from a marker to itself.
    #[error("a bone joins marker {marker} to itself; a bone needs two markers")]
    SelfBone {
        /// The marker.
        marker: usize,
    },
    /// The same pair of markers twice.
    #[error("the bone between markers {a} and {b} is listed twice; keep one")]
    DuplicateBone {
        /// Lower marker index.
        a: usize,
        /// Higher marker index.
        b: usize,
    },
    /// A bone length that is no length.
    #[error(
        "the bone between markers {a} and {b} has length {length_m} m; it must be positive and finite"
    )]
    BoneLength {
        /// Lower marker index.
        a: usize,
        /// Higher marker index.
        b: usize,
        /// The length as given, in metres.
        length_m: f64,
    },
    /// A body frame cannot be found.
    #[error(
        "no frame of the take shows the reference markers of a body frame (a back and a front marker \
         together); use world coordinates"
    )]
    NoBodyFrame,
    /// Reference markers that leave an axis of a part-local frame undefined.
    #[error(
        "a part-local frame needs markers low and high on the part, and a pair of markers along another axis"
    )]
    NoPartMarkers,
    /// A part-local frame cannot be found.
    #[error(
        "no frame of the take shows all reference markers of the part at once; fill their gaps first, or choose \
         reference markers that are seen together"
    )]
    NoPartFrame,
    /// A joint list that is not a tree with parents first and one root.
    #[error(
        "joint {joint} (`{name}`) has parent {parent:?}; the root comes first and parents precede children"
    )]
    JointOrder {
        /// Index of the joint.
        joint: usize,
        /// Its name.
        name: String,
        /// The parent it names.
        parent: Option<usize>,
    },
    /// A pose with another number of rotations than the skeleton has joints.
    #[error("a pose has {found} rotations, but the skeleton has {expected} joints")]
    PoseLength {
        /// Joints of the skeleton.
        expected: usize,
        /// Rotations of the pose.
        found: usize,
    },
    /// A line of a marker-set file that cannot be read.
    #[error("{file}:{line}: `{text}` is not a marker-set line; {rule}")]
    MarkerSetLine {
        /// Name of the file.
        file: String,
        /// One-based line.
        line: usize,
        /// The line.
        text: String,
        /// What would be right.
        rule: &'static str,
    },
}

fn suggestion(similar: &[String]) -> String {
    if similar.is_empty() {
        String::from("; list the names with `mocap inspect`")
    } else {
        format!("; did you mean {}?", similar.join(", "))
    }
}
