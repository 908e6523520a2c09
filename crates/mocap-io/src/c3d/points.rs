//! Which points of a file are markers.

use std::collections::{HashMap, HashSet};

use super::parameters::Parameters;
use super::report::ReadNote;

/// What a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PointKind {
    /// A labelled marker.
    Marker,
    /// A trajectory without a name of its own: no label, or one like `*12`.
    Unlabelled,
    /// Written by a biomechanical model, never measured: not to be filled.
    ModelOutput(ModelOutput),
}

/// What a modelled point holds in place of a measured position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ModelOutput {
    /// Joint angles.
    Angle,
    /// Forces.
    Force,
    /// Moments.
    Moment,
    /// Powers.
    Power,
    /// Scalars.
    Scalar,
    /// A position computed from markers, like a joint centre or the centre of mass.
    ModelledMarker,
    /// Origin or axis end of a segment's frame.
    SegmentAxis,
    /// Any other group of `POINT:TYPE_GROUPS`.
    Other,
}

/// Name and kind of one point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PointInfo {
    /// Name that no other point of the file has: the label where it is unique, else the label with `_2`, `_3`, …;
    /// `*<index>` for a point without a label.
    pub name: String,
    /// Label as the file has it, without padding; empty where there is none.
    pub label: String,
    /// What it is.
    pub kind: PointKind,
}

impl PointInfo {
    /// Whether this is a measured trajectory, labelled or not.
    #[must_use]
    pub fn is_measured(&self) -> bool {
        !matches!(self.kind, PointKind::ModelOutput(_))
    }
}

/// Labels, unique names and kinds of all points.
pub(crate) fn read(
    count: usize,
    parameters: &Parameters,
    notes: &mut Vec<ReadNote>,
) -> Vec<PointInfo> {
    let mut labels = parameters.long_texts("POINT", "LABELS");
    labels.resize(count, String::new());
    let missing = labels.iter().filter(|label| label.is_empty()).count();
    if missing > 0 {
        notes.push(ReadNote::MissingLabels { count: missing });
    }
    let names = unique_names(&labels);
    let duplicates = names
        .iter()
        .zip(&labels)
        .filter(|(name, label)| !label.is_empty() && name != label)
        .count();
    if duplicates > 0 {
        notes.push(ReadNote::DuplicateLabels { count: duplicates });
    }
    let listed = listed_outputs(parameters);
    let axes = segment_stems(&labels);
    let mut inferred = 0;
    let points = labels.into_iter().zip(names).map(|(label, name)| {
        let kind = if let Some(&output) = listed.get(&label) {
            output.map_or(PointKind::Marker, PointKind::ModelOutput)
        } else if let Some(output) = inferred_output(&label, &axes) {
            inferred += 1;
            PointKind::ModelOutput(output)
        } else if is_unlabelled(&label) {
            PointKind::Unlabelled
        } else {
            PointKind::Marker
        };
        PointInfo { name, label, kind }
    });
    let points = points.collect();
    if inferred > 0 {
        notes.push(ReadNote::InferredModelOutputs { count: inferred });
    }
    points
}

fn unique_names(labels: &[String]) -> Vec<String> {
    let mut taken: HashSet<String> =
        labels.iter().filter(|label| !label.is_empty()).cloned().collect();
    let mut used: HashMap<&str, usize> = HashMap::new();
    labels
        .iter()
        .enumerate()
        .map(|(index, label)| {
            let uses = used.entry(label.as_str()).or_insert(0);
            *uses += 1;
            if *uses == 1 && !label.is_empty() {
                return label.clone();
            }
            let mut name =
                if label.is_empty() { format!("*{index}") } else { format!("{label}_{uses}") };
            while !taken.insert(name.clone()) {
                *uses += 1;
                name = if label.is_empty() {
                    format!("*{index}_{uses}")
                } else {
                    format!("{label}_{uses}")
                };
            }
            name
        })
        .collect()
}

/// Labels that `POINT:ANGLES`, … and the parameters named by `POINT:TYPE_GROUPS` list; `None` marks lists of markers.
fn listed_outputs(parameters: &Parameters) -> HashMap<String, Option<ModelOutput>> {
    let mut lists: Vec<(String, Option<ModelOutput>)> =
        ["ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "MODELED_MARKERS"]
            .iter()
            .map(|name| ((*name).to_owned(), output_of_list(name)))
            .collect();
    if let Some(types) = parameters.get("POINT", "TYPE_GROUPS") {
        let named = types.texts().into_iter().step_by(2).filter(|name| !name.is_empty());
        lists.extend(named.map(|name| (name.clone(), output_of_list(&name))));
    }
    let mut listed = HashMap::new();
    for (list, output) in lists {
        for label in
            parameters.long_texts("POINT", &list).into_iter().filter(|label| !label.is_empty())
        {
            listed.entry(label).or_insert(output);
        }
    }
    listed
}

fn output_of_list(name: &str) -> Option<ModelOutput> {
    let upper = name.to_ascii_uppercase();
    let output = match upper.as_str() {
        "ANGLES" => ModelOutput::Angle,
        "FORCES" => ModelOutput::Force,
        "MOMENTS" => ModelOutput::Moment,
        "POWERS" => ModelOutput::Power,
        "SCALARS" => ModelOutput::Scalar,
        _ if upper.contains("MARKER") && (upper.contains("MODEL") || upper.contains("VIRTUAL")) => {
            ModelOutput::ModelledMarker
        }
        _ if upper.contains("MARKER") || upper.starts_with("LABELS") => return None,
        _ => ModelOutput::Other,
    };
    Some(output)
}

/// Stems of labels that come with all four ends of a segment's axes: `LFEO, LFEA, LFEL, LFEP`.
fn segment_stems(labels: &[String]) -> HashSet<String> {
    let all: HashSet<&str> = labels.iter().map(String::as_str).collect();
    let stems =
        all.iter().filter_map(|label| label.strip_suffix('O').filter(|stem| !stem.is_empty()));
    stems
        .filter(|stem| {
            ["A", "L", "P"].iter().all(|end| all.contains(format!("{stem}{end}").as_str()))
        })
        .map(str::to_owned)
        .collect()
}

/// Model outputs by the names that the common gait models give, for files whose lists leave them out.
fn inferred_output(label: &str, axes: &HashSet<String>) -> Option<ModelOutput> {
    let bare = label.rsplit_once(':').map_or(label, |(_, bare)| bare);
    let is_axis = label.ends_with(['O', 'A', 'L', 'P'])
        && label.get(..label.len() - 1).is_some_and(|s| axes.contains(s));
    let named =
        |ends: &[&str]| ends.iter().any(|end| bare.len() > end.len() && bare.ends_with(end));
    if is_axis {
        Some(ModelOutput::SegmentAxis)
    } else if bare.starts_with("CentreOfMass") || is_joint_centre(bare) {
        Some(ModelOutput::ModelledMarker)
    } else if named(&["Angles"]) || bare.ends_with("AbsAnkleAngle") {
        Some(ModelOutput::Angle)
    } else if named(&["Force", "NormalisedGRF"]) {
        Some(ModelOutput::Force)
    } else if named(&["Moment"]) {
        Some(ModelOutput::Moment)
    } else if named(&["Power"]) {
        Some(ModelOutput::Power)
    } else {
        None
    }
}

/// `LHJC`, `RKJC`, …: computed by every model that names them so.
fn is_joint_centre(bare: &str) -> bool {
    bare.len() == 4 && bare.starts_with(['L', 'R']) && bare.ends_with("JC")
}

fn is_unlabelled(label: &str) -> bool {
    let bare = label.rsplit_once(':').map_or(label, |(_, bare)| bare).to_ascii_lowercase();
    bare.is_empty()
        || bare.starts_with('*')
        || ["uname*", "unlabeled", "unlabelled"].iter().any(|start| bare.starts_with(start))
}
