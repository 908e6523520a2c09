//! Walks the chain of groups and parameters.

use std::ops::Range;

use super::error::C3dError;
use super::header::{BLOCK, Header, text};
use super::number::Processor;
use super::parameters::{Entry, Group, ParameterKind, Parameters};
use super::report::ReadNote;

/// No real file comes near; it bounds the memory that entries of five bytes each could take.
const MAX_ENTRIES: usize = 10_000;

struct Walk<'a> {
    bytes: &'a [u8],
    processor: Processor,
    start: usize,
    end: usize,
    /// First byte after the furthest entry read.
    used: usize,
    groups: Vec<Group>,
    entries: Vec<Entry>,
}

/// What every entry starts with.
struct Head {
    at: usize,
    id: u8,
    name: Range<usize>,
    locked: bool,
    /// First byte after the pointer to the next entry.
    body: usize,
    /// Where that pointer leads.
    next: usize,
}

enum Step {
    Next(usize),
    End(usize),
}

/// Reads the parameter section of a file whose first block and processor are known.
///
/// The section ends at a name of length 0, after an entry whose pointer is 0, or where both the declared blocks and the
/// header's data start are reached: real files get each of these wrong, but not all of them.
pub(crate) fn read(
    bytes: &[u8],
    header: &Header,
    processor: Processor,
    salvage: bool,
    notes: &mut Vec<ReadNote>,
) -> Result<Parameters, C3dError> {
    let start = (usize::from(header.parameter_block) - 1) * BLOCK;
    let declared = usize::from(bytes.get(start + 2).copied().unwrap_or_default()) * BLOCK;
    let end = (start + declared).max(usize::from(header.data_block).saturating_sub(1) * BLOCK);
    let mut walk =
        Walk { bytes, processor, start, end, used: start, groups: Vec::new(), entries: Vec::new() };
    let used_end = walk.run(salvage, notes)?.max(walk.used);
    if used_end > start + declared {
        notes.push(ReadNote::ParametersBeyondDeclared { declared, used: used_end - start });
    }
    let section = bytes.get(start..used_end).unwrap_or_default().to_vec();
    Ok(Parameters {
        processor,
        section,
        section_start: start,
        groups: walk.groups,
        entries: walk.entries,
    })
}

impl Walk<'_> {
    fn run(&mut self, salvage: bool, notes: &mut Vec<ReadNote>) -> Result<usize, C3dError> {
        let mut at = self.start + 4;
        loop {
            match self.step(at) {
                Ok(Step::Next(next)) => at = next,
                Ok(Step::End(end)) => return Ok(end),
                Err(_) if salvage => {
                    notes.push(ReadNote::ParametersStopped { byte: at });
                    return Ok(at.min(self.bytes.len()));
                }
                Err(error) => return Err(error),
            }
            if self.entries.len() + self.groups.len() > MAX_ENTRIES {
                return Err(C3dError::TooManyParameters { limit: MAX_ENTRIES, byte: at });
            }
        }
    }

    fn step(&mut self, at: usize) -> Result<Step, C3dError> {
        if at >= self.end {
            return Ok(Step::End(self.end.min(self.bytes.len())));
        }
        let name_length = self.take(at, at, 1)?[0].cast_signed();
        if name_length == 0 {
            return Ok(Step::End(at + 1));
        }
        let id = self.take(at, at + 1, 1)?[0].cast_signed();
        let name = at + 2..at + 2 + usize::from(name_length.unsigned_abs());
        let pointer = name.end;
        let offset = usize::from(self.processor.u16_at(self.take(at, pointer, 2)?, 0));
        let locked = name_length < 0;
        let head = Head {
            at,
            id: id.unsigned_abs(),
            name,
            locked,
            body: pointer + 2,
            next: pointer + offset,
        };
        let content_end = if id <= 0 { self.group(head)? } else { self.parameter(head)? };
        self.used = self.used.max(content_end);
        match offset {
            0 => Ok(Step::End(content_end)),
            // A pointer into itself would not move on.
            1 => Err(C3dError::ParameterOverrun { byte: at, needed: pointer + 1, end: self.end }),
            _ => Ok(Step::Next(pointer + offset)),
        }
    }

    fn group(&mut self, head: Head) -> Result<usize, C3dError> {
        let Head { at, id, name, locked, body, next } = head;
        let name = text(self.take(at, name.start, name.len())?);
        let (description, end) = self.description(at, body, next)?;
        let description = text(self.bytes.get(description).unwrap_or_default());
        self.groups.push(Group { id, name, description, locked });
        Ok(end)
    }

    fn parameter(&mut self, head: Head) -> Result<usize, C3dError> {
        let Head { at, id: group, name, locked, body, next } = head;
        let shape = self.take(at, body, 2)?;
        let (kind, dimensions) = (shape[0].cast_signed(), usize::from(shape[1]));
        let dims = body + 2..body + 2 + dimensions;
        let elements = self
            .take(at, dims.start, dimensions)?
            .iter()
            .try_fold(1_usize, |product, &dim| product.checked_mul(usize::from(dim)));
        let size = elements.and_then(|count| count.checked_mul(usize::from(kind.unsigned_abs())));
        let data_end = size.and_then(|size| dims.end.checked_add(size)).unwrap_or(usize::MAX);
        let data = dims.end..data_end;
        self.take(at, data.start, data.len())?;
        let (description, end) = self.description(at, data.end, next)?;
        let relative = |range: Range<usize>| range.start - self.start..range.end - self.start;
        let entry = Entry {
            group,
            name: relative(name),
            kind: ParameterKind::from_byte(kind),
            dims: relative(dims),
            data: relative(data),
            description: relative(description),
            locked,
        };
        self.entries.push(entry);
        Ok(end)
    }

    /// The description whose length stands at `at`, and the first byte after it.
    ///
    /// Some writers leave the length out: what stands before the next entry is then the description.
    fn description(
        &self,
        entry: usize,
        at: usize,
        next: usize,
    ) -> Result<(Range<usize>, usize), C3dError> {
        let stop = next.min(self.end).min(self.bytes.len());
        if stop >= at {
            let room = self.take(entry, at, stop - at)?;
            let length = room.first().map(|&length| usize::from(length));
            if length.is_none_or(|length| length >= room.len()) {
                return Ok((at..stop, stop));
            }
        }
        let length = usize::from(self.take(entry, at, 1)?[0]);
        self.take(entry, at + 1, length)?;
        Ok((at + 1..at + 1 + length, at + 1 + length))
    }

    fn take(&self, entry: usize, from: usize, length: usize) -> Result<&[u8], C3dError> {
        let needed = from.saturating_add(length);
        let len = self.bytes.len();
        if needed > self.end {
            return Err(C3dError::ParameterOverrun { byte: entry, needed, end: self.end });
        }
        self.bytes.get(from..needed).ok_or(C3dError::ParametersTruncated {
            byte: entry,
            needed,
            len,
        })
    }
}
