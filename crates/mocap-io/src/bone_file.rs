use mocap_core::{Bone, BoneSet, CoreError, MarkerSet};
use thiserror::Error;

const COLUMNS: [&str; 3] = ["marker_a", "marker_b", "length_mm"];

/// Why a list of bones cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BoneFileError {
    /// Not a CSV table.
    #[error("not a table of comma-separated values")]
    Csv(#[from] csv::Error),
    /// A column is missing.
    #[error("no column `{column}`; a bone file has the columns marker_a, marker_b and length_mm")]
    Column {
        /// The missing column.
        column: &'static str,
    },
    /// A length that is no number.
    #[error("line {line}: `{text}` is no length in millimetres")]
    Length {
        /// One-based line.
        line: u64,
        /// The field.
        text: String,
    },
    /// A bone that cannot be.
    #[error("line {line}")]
    Bone {
        /// One-based line.
        line: u64,
        /// The rule it breaks.
        #[source]
        source: CoreError,
    },
    /// The bones do not form a set.
    #[error(transparent)]
    Set(#[from] CoreError),
}

/// Reads bones from CSV with the columns `marker_a`, `marker_b` and `length_mm`, in any order and among others.
///
/// # Units
/// Millimetres in the file, metres in the set.
///
/// # Errors
/// [`BoneFileError`] with the line and the rule.
///
/// ```
/// use mocap_core::MarkerSet;
/// let markers = MarkerSet::new(["LKNE", "LSHN"])?;
/// let csv = "marker_a,marker_b,length_mm\nLKNE,LSHN,181.5\n";
/// let bones = mocap_io::read_bones(csv.as_bytes(), &markers)?;
/// assert!((bones.bones()[0].length_m() - 0.1815).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_bones(bytes: &[u8], markers: &MarkerSet) -> Result<BoneSet, BoneFileError> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let headers = reader.headers()?.clone();
    let find = |column: &'static str| {
        headers.iter().position(|h| h == column).ok_or(BoneFileError::Column { column })
    };
    let [a, b, length] = [find(COLUMNS[0])?, find(COLUMNS[1])?, find(COLUMNS[2])?];
    let mut bones = Vec::new();
    for record in reader.records() {
        let record = record?;
        let line = record.position().map_or(0, csv::Position::line);
        let at = |source| BoneFileError::Bone { line, source };
        let field = |column: usize| record.get(column).unwrap_or_default();
        let millimetres: f64 = field(length)
            .parse()
            .map_err(|_| BoneFileError::Length { line, text: field(length).to_owned() })?;
        let ends = markers.find(field(a)).and_then(|a| Ok((a, markers.find(field(b))?)));
        let (a, b) = ends.map_err(at)?;
        bones.push(Bone::new(a, b, millimetres / 1000.0).map_err(at)?);
    }
    Ok(BoneSet::new(bones)?)
}

/// Bones as CSV that [`read_bones`] reads.
#[must_use]
pub fn write_bones(bones: &BoneSet, markers: &MarkerSet) -> String {
    let lines = bones.bones().iter().map(|bone| {
        let (a, b) = bone.markers();
        let millimetres = bone.length_m() * 1000.0;
        format!("{},{},{millimetres:.3}\n", quoted(markers.name(a)), quoted(markers.name(b)))
    });
    std::iter::once(format!("{}\n", COLUMNS.join(","))).chain(lines).collect()
}

/// A CSV field, in quotes where it needs them.
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
