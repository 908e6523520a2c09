use std::{fs::File, io::Read, path::Path};

use flate2::read::MultiGzDecoder;
use mocap_core::{MarkerSet, Take};
use ndarray::Array3;

use crate::{
    Edit, FileInfo, Format, LengthUnit, MissingMarks, ParseError, ReadError, ReadOptions, Sample,
    WriteError,
    c3d::{
        C3d, C3dOptions, EditValue, ModelOutput, NewC3d, PointInfo, PointKind, Processor,
        SampleEdit, SampleState, Storage,
    },
    format::is_gzip,
    recording::ASSUMED_RATE_HZ,
    text::{self, Document, EncodeOptions},
};

/// A marker file: its take, what it says of itself, and its bytes, so that it can be written back
/// with single samples changed and all else as it was.
///
/// ```
/// use mocap_io::{Format, MarkerFile, ReadOptions};
///
/// let csv = b"LKNE-x,LKNE-y,LKNE-z\n1.0,2.0,3.0\n,,\n".to_vec();
/// let file = MarkerFile::parse(csv.clone(), Format::Csv, &ReadOptions::default())?;
/// assert_eq!(file.take().gaps().len(), 1);
/// assert_eq!(file.patched(&[])?, csv);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct MarkerFile {
    take: Take,
    info: FileInfo,
    source: Source,
}

enum Source {
    C3d { file: Box<C3d>, points: Vec<usize> },
    Text(Box<dyn Document>),
}

impl MarkerFile {
    /// Reads a file; the format goes by the extension, and `.gz` is unpacked.
    ///
    /// # Errors
    /// [`ReadError`], with the path.
    pub fn read(path: &Path, options: &ReadOptions) -> Result<Self, ReadError> {
        let format =
            Format::of(path).ok_or_else(|| ReadError::Extension { path: path.to_owned() })?;
        Self::parse(read_bytes(path)?, format, options)
            .map_err(|source| ReadError::Content { path: path.to_owned(), source })
    }

    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// [`ParseError`], with the position in the bytes.
    pub fn parse(
        bytes: Vec<u8>,
        format: Format,
        options: &ReadOptions,
    ) -> Result<Self, ParseError> {
        let text = |parsed: text::Parsed| Self {
            take: parsed.take,
            info: parsed.info,
            source: Source::Text(parsed.document),
        };
        match format {
            Format::C3d => Self::parse_c3d(bytes, options),
            Format::Trc => Ok(text(text::trc::read(bytes, options)?)),
            Format::Csv => Ok(text(text::table::read_csv(bytes, options)?)),
            Format::Tsv => Ok(text(text::table::read_tsv(bytes, options)?)),
            Format::Bvh | Format::Asf | Format::Amc => Err(ParseError::NoMarkers { format }),
        }
    }

    fn parse_c3d(bytes: Vec<u8>, options: &ReadOptions) -> Result<Self, ParseError> {
        let c3d_options =
            C3dOptions { salvage: options.salvage, zeros_are_data: options.zero_is_position };
        let file = C3d::parse(bytes, &c3d_options)?;
        let points = marker_points(file.points());
        let mut info = c3d_info(&file, options);
        let rate_hz = file.point_rate_hz().or(options.rate_hz).unwrap_or_else(|| {
            info.notes.push(format!(
                "the file states no sampling rate; {ASSUMED_RATE_HZ} Hz assumed, tell it with --rate"
            ));
            ASSUMED_RATE_HZ
        });
        let (positions, missing) = c3d_samples(&file, &points, info.unit);
        info.missing = missing;
        let names = MarkerSet::new(points.iter().map(|&p| file.points()[p].name.as_str()))?;
        let take = Take::from_positions(names, rate_hz, positions)?;
        Ok(Self { take, info, source: Source::C3d { file: Box::new(file), points } })
    }

    /// The markers' trajectories, in metres.
    #[must_use]
    pub fn take(&self) -> &Take {
        &self.take
    }

    /// What the file says of itself.
    #[must_use]
    pub fn info(&self) -> &FileInfo {
        &self.info
    }

    /// The bytes as read (unpacked, if they were packed).
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        match &self.source {
            Source::C3d { file, .. } => file.bytes(),
            Source::Text(document) => document.bytes(),
        }
    }

    /// The file with single samples changed and every other byte as it was.
    ///
    /// # Errors
    /// [`WriteError::C3d`] or [`WriteError::Text`] for a sample that the file cannot hold.
    pub fn patched(&self, edits: &[Edit]) -> Result<Vec<u8>, WriteError> {
        match &self.source {
            Source::Text(document) => Ok(document.patch(edits)?),
            Source::C3d { file, points } => {
                let scale = self.info.unit.per_metre();
                let edits: Vec<SampleEdit> = edits
                    .iter()
                    .map(|edit| SampleEdit {
                        frame: edit.frame,
                        // A marker that the take does not have is no point of the file either.
                        point: points.get(edit.marker).copied().unwrap_or(usize::MAX),
                        value: match edit.sample {
                            Sample::Filled(p) => EditValue::Fill(p.map(|c| c * scale)),
                            Sample::Missing => EditValue::Missing,
                        },
                    })
                    .collect();
                Ok(file.patch(&edits)?)
            }
        }
    }
}

/// A new marker file of the take, in a format of choice.
///
/// # Errors
/// [`WriteError::Conversion`] for a format without markers, [`WriteError::C3d`] for a take that C3D
/// cannot hold.
pub fn encode_markers(
    take: &Take,
    format: Format,
    unit: LengthUnit,
    first_frame: i64,
) -> Result<Vec<u8>, WriteError> {
    let options = EncodeOptions { unit, first_frame };
    match format {
        Format::C3d => encode_c3d(take, unit, first_frame),
        Format::Trc => Ok(text::trc::encode(take, &options)),
        Format::Csv => Ok(text::table::encode_csv(take, &options)),
        Format::Tsv => Ok(text::table::encode_tsv(take, &options)),
        to @ (Format::Bvh | Format::Asf | Format::Amc) => Err(WriteError::Conversion {
            to,
            rule: "markers become joint motion by solving, not by conversion",
        }),
    }
}

fn encode_c3d(take: &Take, unit: LengthUnit, first_frame: i64) -> Result<Vec<u8>, WriteError> {
    let mut new = NewC3d::new(take.markers().names().to_vec(), take.rate_hz());
    unit.symbol().clone_into(&mut new.units);
    new.first_frame = u32::try_from(first_frame.max(1)).unwrap_or(1);
    let scale = unit.per_metre();
    let cells = (0..take.frames()).flat_map(|t| (0..take.marker_count()).map(move |m| (t, m)));
    for (t, m) in cells {
        let position = take.position(t, m);
        new.missing.push(position.is_none());
        new.xyz.push(position.map_or([0.0; 3], |p| p.map(|c| c * scale)));
    }
    Ok(new.encode()?)
}

/// The bytes of a file, unpacked if its name ends in `.gz`.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
    let at = |source| ReadError::Io { path: path.to_owned(), source };
    let mut file = File::open(path).map_err(at)?;
    let mut bytes = Vec::new();
    if is_gzip(path) {
        MultiGzDecoder::new(file).read_to_end(&mut bytes).map_err(at)?;
    } else {
        file.read_to_end(&mut bytes).map_err(at)?;
    }
    Ok(bytes)
}

/// The labelled markers; where nothing has a label, all measured points.
fn marker_points(points: &[PointInfo]) -> Vec<usize> {
    let of = |wanted: &dyn Fn(PointKind) -> bool| -> Vec<usize> {
        (0..points.len()).filter(|&p| wanted(points[p].kind)).collect()
    };
    let labelled = of(&|kind| kind == PointKind::Marker);
    if labelled.is_empty() { of(&|kind| kind == PointKind::Unlabelled) } else { labelled }
}

fn c3d_info(file: &C3d, options: &ReadOptions) -> FileInfo {
    let mut info = FileInfo::new(Format::C3d, storage_in_words(file));
    let declared = file.units();
    let known = declared.as_deref().and_then(LengthUnit::parse);
    info.unit_declared = known.is_some();
    info.unit = known.or(options.unit).unwrap_or(LengthUnit::Millimetre);
    if known.is_none() && options.unit.is_none() {
        let named = declared.map_or_else(|| "no unit".into(), |u| format!("the unit `{u}`"));
        info.notes.push(format!("the file states {named}; mm assumed, tell it with --unit"));
    }
    info.rate_declared = file.point_rate_hz().is_some();
    info.first_frame = i64::from(file.first_frame());
    let markers = marker_points(file.points());
    info.other_points = (0..file.points().len())
        .filter(|p| markers.binary_search(p).is_err())
        .map(|p| (file.points()[p].name.clone(), kind_in_words(file.points()[p].kind).into()))
        .collect();
    info.notes.extend(file.report().notes.iter().map(ToString::to_string));
    info
}

/// Frames decoded at a time: enough to keep the decoder in its stride, few enough to need no second
/// copy of a long file.
const CHUNK: usize = 256;

/// Positions `(T, M, 3)` in metres, NaN where missing, and how the file marks what is missing.
fn c3d_samples(file: &C3d, points: &[usize], unit: LengthUnit) -> (Array3<f64>, MissingMarks) {
    let metres = unit.metres();
    let mut marks = MissingMarks::default();
    let mut positions = Array3::from_elem((file.frames(), points.len(), 3), f64::NAN);
    for start in (0..file.frames()).step_by(CHUNK) {
        let data = file.decode_frames(start..start + CHUNK);
        for t in 0..data.frames {
            for (m, &point) in points.iter().enumerate() {
                let sample = data.index(t, point);
                match data.states[sample] {
                    SampleState::NegativeResidual => marks.negative_residual += 1,
                    SampleState::NotFinite => marks.not_a_number += 1,
                    SampleState::ExactZero => marks.exact_zero += 1,
                    SampleState::Present => {
                        for (axis, c) in data.xyz[sample].into_iter().enumerate() {
                            positions[(start + t, m, axis)] = f64::from(c) * metres;
                        }
                    }
                }
            }
        }
    }
    (positions, marks)
}

fn storage_in_words(file: &C3d) -> String {
    let processor = match file.processor() {
        Processor::Intel => "Intel",
        Processor::Dec => "DEC",
        Processor::Sgi => "SGI",
    };
    match file.storage() {
        Storage::Integer { scale } => format!("{processor}, integers, scale {scale}"),
        Storage::Real { .. } => format!("{processor}, reals"),
    }
}

fn kind_in_words(kind: PointKind) -> &'static str {
    match kind {
        PointKind::Marker => "marker",
        PointKind::Unlabelled => "unlabelled",
        PointKind::ModelOutput(ModelOutput::Angle) => "modelled angle",
        PointKind::ModelOutput(ModelOutput::Force) => "modelled force",
        PointKind::ModelOutput(ModelOutput::Moment) => "modelled moment",
        PointKind::ModelOutput(ModelOutput::Power) => "modelled power",
        PointKind::ModelOutput(ModelOutput::Scalar) => "modelled scalar",
        PointKind::ModelOutput(ModelOutput::ModelledMarker) => "modelled position",
        PointKind::ModelOutput(ModelOutput::SegmentAxis) => "modelled segment axis",
        PointKind::ModelOutput(_) => "model output",
    }
}
