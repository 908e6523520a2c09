//! How many frames a file declares, in six places of two widths.

use super::error::C3dError;
use super::header::Header;
use super::layout::distinct;
use super::parameters::Parameters;

/// The largest count that the 16-bit places can hold.
const NARROW: usize = 65_535;

/// The counts declared, the most trustworthy first.
///
/// A 16-bit count that is the saturated or wrapped image of a wider one is no candidate of its own, so that a cut
/// file of more than 65,535 frames cannot pass for a whole shorter one.
pub(crate) fn candidates(header: &Header, parameters: &Parameters) -> Result<Vec<usize>, C3dError> {
    let declared = parameters.count("POINT", "FRAMES");
    let wide = [parameters.count("POINT", "LONG_FRAMES"), declared, actual_span(parameters)];
    let wide = wide.into_iter().flatten().filter(|&count| count > NARROW).max();
    let by_header = header
        .frame_count()
        .filter(|&count| has_frames(header) && !is_cut_short(count, header, declared));
    let narrow = [by_header, declared, parameters.count("POINT", "LONG_FRAMES")];
    let unexplained = narrow.map(|count| {
        count.filter(|&count| !wide.is_some_and(|wide| explains(wide, count, header)))
    });
    let mut counts = distinct(std::iter::once(wide).chain(unexplained));
    if counts.is_empty() {
        counts.extend(actual_span(parameters).or(header.frame_count()));
    }
    if counts.is_empty() {
        return Err(C3dError::FrameCountInvalid {
            first: header.first_frame,
            last: header.last_frame,
        });
    }
    Ok(counts)
}

/// Frame numbers 0 to 0 are how writers say that there is no frame at all; one frame is numbered 1 to 1.
fn has_frames(header: &Header) -> bool {
    header.first_frame > 0 || header.last_frame > 0
}

/// A last frame number that 16 bits could not hold makes the header's count too small.
fn is_cut_short(count: usize, header: &Header, declared: Option<usize>) -> bool {
    usize::from(header.last_frame) == NARROW && declared.is_some_and(|declared| declared > count)
}

fn explains(wide: usize, narrow: usize, header: &Header) -> bool {
    let last = usize::from(header.first_frame) + wide - 1;
    let wrapped = last % (NARROW + 1) == usize::from(header.last_frame);
    narrow == wide
        || narrow >= NARROW
        || narrow == wide % (NARROW + 1)
        || narrow == wide % NARROW
        || (header.frame_count() == Some(narrow)
            && (wrapped || usize::from(header.last_frame) == NARROW))
}

/// Whether the narrow places are full and no wide one says more.
pub(crate) fn is_saturated(header: &Header, parameters: &Parameters) -> bool {
    let wide = [parameters.count("POINT", "LONG_FRAMES"), actual_span(parameters)];
    usize::from(header.last_frame) == NARROW
        && parameters.count("POINT", "FRAMES").is_none_or(|count| count >= NARROW)
        && wide.into_iter().flatten().all(|count| count <= NARROW)
}

/// Frames by `TRIAL:ACTUAL_START_FIELD` and `TRIAL:ACTUAL_END_FIELD`.
fn actual_span(parameters: &Parameters) -> Option<usize> {
    let start = field(parameters, "ACTUAL_START_FIELD")?;
    let end = field(parameters, "ACTUAL_END_FIELD")?;
    (end + 1).checked_sub(start)
}

/// A `TRIAL` field: two 16-bit words, the low one first, or one number.
fn field(parameters: &Parameters, name: &str) -> Option<usize> {
    match parameters.get("TRIAL", name)?.counts().as_slice() {
        [low, high, ..] if *low <= NARROW && *high <= NARROW => Some(low + high * (NARROW + 1)),
        [value, ..] => Some(*value).filter(|&value| u32::try_from(value).is_ok()),
        [] => None,
    }
}

/// Number of the first frame: the `TRIAL` field where the header's 16 bits agree with it or are full, else the header.
pub(crate) fn first_frame(header: &Header, parameters: &Parameters) -> u32 {
    let narrow = u32::from(header.first_frame);
    let wide = field(parameters, "ACTUAL_START_FIELD").and_then(|start| u32::try_from(start).ok());
    wide.filter(|wide| wide & 0xffff == narrow || narrow == 0xffff).unwrap_or(narrow)
}
