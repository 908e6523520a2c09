use std::{
    fs,
    path::{Path, PathBuf},
};

use mocap_core::Motion;

use crate::{
    FileInfo, Format, LengthUnit, ParseError, ReadError, ReadOptions, WriteError,
    marker_file::read_bytes,
    recording::ASSUMED_RATE_HZ,
    text::{
        amc::{self, Amc},
        asf::{self, Asf},
        bvh::{self, Bvh},
    },
};

/// A skeleton file: BVH, AMC with its ASF, or an ASF alone, which is a skeleton without frames.
#[derive(Debug, Clone)]
pub struct MotionFile {
    motion: Motion,
    info: FileInfo,
    bytes: Vec<u8>,
}

impl MotionFile {
    /// Reads a file; the format goes by the extension, and `.gz` is unpacked.
    ///
    /// An AMC file needs the ASF file of its skeleton: `asf`, or else the one in the same folder whose
    /// name the AMC file's name starts with.
    ///
    /// # Errors
    /// [`ReadError`], with the path.
    pub fn read(path: &Path, asf: Option<&Path>, options: &ReadOptions) -> Result<Self, ReadError> {
        let format =
            Format::of(path).ok_or_else(|| ReadError::Extension { path: path.to_owned() })?;
        let content = |source: ParseError| ReadError::Content { path: path.to_owned(), source };
        if format != Format::Amc {
            return Self::parse(read_bytes(path)?, format, options).map_err(content);
        }
        let asf = match asf {
            Some(asf) => asf.to_owned(),
            None => skeleton_beside(path)
                .ok_or_else(|| ReadError::NoSkeleton { path: path.to_owned() })?,
        };
        let skeleton = Asf::parse(read_bytes(&asf)?, options)
            .map_err(|e| ReadError::Content { path: asf, source: e.into() })?;
        let amc =
            Amc::parse(read_bytes(path)?, &skeleton, options).map_err(|e| content(e.into()))?;
        Ok(Self {
            motion: amc.motion().clone(),
            info: amc.info().clone(),
            bytes: amc.bytes().to_vec(),
        })
    }

    /// Reads the bytes of a BVH or ASF file.
    ///
    /// # Errors
    /// [`ParseError`], with the position; [`ParseError::NoMotion`] for a format of markers and for
    /// AMC, which cannot be read without its skeleton.
    pub fn parse(
        bytes: Vec<u8>,
        format: Format,
        options: &ReadOptions,
    ) -> Result<Self, ParseError> {
        match format {
            Format::Bvh => {
                let file = Bvh::parse(bytes, options)?;
                let (motion, info) = (file.motion()?, file.info().clone());
                Ok(Self { motion, info, bytes: file.bytes().to_vec() })
            }
            Format::Asf => {
                let file = Asf::parse(bytes, options)?;
                let rate_hz = options.rate_hz.unwrap_or(ASSUMED_RATE_HZ);
                let motion = Motion::new(file.skeleton().clone(), rate_hz, Vec::new())?;
                Ok(Self { motion, info: file.info().clone(), bytes: file.bytes().to_vec() })
            }
            _ => Err(ParseError::NoMotion { format }),
        }
    }

    /// The skeleton and its poses, in metres.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// What the file says of itself.
    #[must_use]
    pub fn info(&self) -> &FileInfo {
        &self.info
    }

    /// The bytes as read (unpacked, if they were packed).
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

/// A new skeleton file of a motion.
///
/// An AMC file means something only beside the ASF file of the same motion. Both are written in the units of
/// CMU's database, whatever `unit` says; BVH is written in `unit`.
///
/// # Errors
/// [`WriteError::Conversion`] for formats of markers, and for AMC without a frame, which nothing could read.
///
/// ```
/// use mocap_core::{Joint, Motion, Pose, Skeleton};
/// use mocap_io::{Format, LengthUnit, encode_motion};
/// let skeleton = Skeleton::new(vec![Joint { name: "hips".into(), parent: None, offset_m: [0.0; 3] }])?;
/// let pose = Pose::rest(&skeleton);
/// let motion = Motion::new(skeleton, 120.0, vec![pose])?;
/// let bytes = encode_motion(&motion, Format::Amc, LengthUnit::Inch)?;
/// assert!(String::from_utf8(bytes)?.contains("\n1\nroot 0.000000000 0.000000000 0.000000000 "));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn encode_motion(
    motion: &Motion,
    format: Format,
    unit: LengthUnit,
) -> Result<Vec<u8>, WriteError> {
    match format {
        Format::Bvh => Ok(bvh::encode(motion, unit)),
        Format::Asf => Ok(asf::encode(motion.skeleton())),
        to @ Format::Amc if motion.poses().is_empty() => {
            let rule = "the input has no frame; write its skeleton as .asf";
            Err(WriteError::Conversion { to, rule })
        }
        Format::Amc => Ok(amc::encode(motion)),
        to => Err(WriteError::Conversion { to, rule: "joint motion holds no markers" }),
    }
}

/// The ASF file in the folder of an AMC file whose name is the longest start of the AMC file's name.
fn skeleton_beside(amc: &Path) -> Option<PathBuf> {
    let stem = |path: &Path| path.file_stem()?.to_str().map(str::to_owned);
    let name = stem(amc)?;
    let folder = amc.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let files = fs::read_dir(folder).ok()?.filter_map(|entry| Some(entry.ok()?.path()));
    files
        .filter(|path| Format::of(path) == Some(Format::Asf))
        .filter(|path| stem(path).is_some_and(|stem| name.starts_with(&stem)))
        .max_by_key(|path| path.as_os_str().len())
}
