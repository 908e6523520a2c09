//! Writes a parameter section.

use super::error::C3dError;
use super::header::BLOCK;
use super::number::Processor;

/// A group to write.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NewGroup {
    /// Name, at most 127 bytes.
    pub name: String,
    /// Description, at most 127 bytes.
    pub description: String,
    /// Its parameters.
    pub parameters: Vec<NewParameter>,
}

/// A parameter to write.
#[derive(Debug, Clone, PartialEq)]
pub struct NewParameter {
    /// Name, at most 127 bytes.
    pub name: String,
    /// Description, at most 127 bytes.
    pub description: String,
    /// Its values.
    pub values: NewValues,
}

/// Values of a new parameter. One number is written as a scalar.
#[derive(Debug, Clone, PartialEq)]
pub enum NewValues {
    /// Texts, padded to the longest of them.
    Texts(Vec<String>),
    /// 16-bit integers; pass counts above 32,767 as their two's complement.
    Integers(Vec<i16>),
    /// Floats.
    Reals(Vec<f32>),
    /// Pairs of floats, `(2, N)`.
    RealPairs(Vec<[f32; 2]>),
}

impl NewGroup {
    /// An empty group.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }
}

impl NewParameter {
    /// A parameter without a description.
    #[must_use]
    pub fn new(name: &str, values: NewValues) -> Self {
        Self { name: name.to_owned(), description: String::new(), values }
    }

    pub(crate) fn text(name: &str, text: &str) -> Self {
        Self::new(name, NewValues::Texts(vec![text.to_owned()]))
    }

    pub(crate) fn word(name: &str, word: u16) -> Self {
        Self::new(name, NewValues::Integers(vec![word.cast_signed()]))
    }

    pub(crate) fn real(name: &str, value: f32) -> Self {
        Self::new(name, NewValues::Reals(vec![value]))
    }

    /// `name`, `name2`, `name3`, …, each with at most 255 of the values.
    pub(crate) fn long<T: Clone>(
        name: &str,
        values: &[T],
        wrap: impl Fn(Vec<T>) -> NewValues,
    ) -> Vec<Self> {
        let part = |(index, values): (usize, &[T])| {
            let name = if index == 0 { name.to_owned() } else { format!("{name}{}", index + 1) };
            Self::new(&name, wrap(values.to_vec()))
        };
        values.chunks(255).enumerate().map(part).collect()
    }
}

/// The bytes of the section, padded to whole blocks.
pub(crate) fn section(groups: &[NewGroup], processor: Processor) -> Result<Vec<u8>, C3dError> {
    limit("number of parameter groups", groups.len(), 127)?;
    let mut bytes = vec![1, 0x50, 0, processor.byte()];
    for (id, group) in (1_i8..).zip(groups) {
        head(&mut bytes, &group.name, -id)?;
        body(&mut bytes, processor, &[], &group.description)?;
        for parameter in &group.parameters {
            head(&mut bytes, &parameter.name, id)?;
            body(
                &mut bytes,
                processor,
                &values(&parameter.values, processor)?,
                &parameter.description,
            )?;
        }
    }
    bytes.extend([0, 0]);
    bytes.resize(bytes.len().next_multiple_of(BLOCK), 0);
    let blocks = bytes.len() / BLOCK;
    bytes[2] =
        u8::try_from(blocks).map_err(|_| too_large("number of parameter blocks", blocks, 255))?;
    Ok(bytes)
}

fn too_large(what: &'static str, found: usize, limit: usize) -> C3dError {
    C3dError::BeyondFormat { what, found, limit }
}

pub(crate) fn limit(what: &'static str, found: usize, limit: usize) -> Result<(), C3dError> {
    if found > limit { Err(too_large(what, found, limit)) } else { Ok(()) }
}

fn head(bytes: &mut Vec<u8>, name: &str, id: i8) -> Result<(), C3dError> {
    limit("length of a parameter name", name.len(), 127)?;
    bytes.extend([byte(name.len()), id.cast_unsigned()]);
    bytes.extend_from_slice(name.as_bytes());
    Ok(())
}

/// Pointer to the next entry, values and description.
fn body(
    bytes: &mut Vec<u8>,
    processor: Processor,
    values: &[u8],
    description: &str,
) -> Result<(), C3dError> {
    // Some readers take this length as signed, too.
    limit("length of a description", description.len(), 127)?;
    let offset = 2 + values.len() + 1 + description.len();
    // Readers take the pointer as signed.
    let offset =
        i16::try_from(offset).map_err(|_| too_large("size of a parameter", offset, 32_767))?;
    bytes.extend(processor.i16_bytes(offset));
    bytes.extend_from_slice(values);
    bytes.push(byte(description.len()));
    bytes.extend_from_slice(description.as_bytes());
    Ok(())
}

/// Type, dimensions and values.
fn values(values: &NewValues, processor: Processor) -> Result<Vec<u8>, C3dError> {
    let (kind, count) = match values {
        NewValues::Texts(texts) => (-1_i8, texts.len()),
        NewValues::Integers(words) => (2, words.len()),
        NewValues::Reals(reals) => (4, reals.len()),
        NewValues::RealPairs(pairs) => (4, pairs.len()),
    };
    limit("number of values of a parameter", count, 255)?;
    let mut bytes = vec![kind.cast_unsigned()];
    match values {
        NewValues::Texts(texts) => {
            let width = texts.iter().map(String::len).max().unwrap_or(0);
            limit("length of a text", width, 127)?;
            if count == 1 {
                bytes.extend([1, byte(width)]);
            } else {
                bytes.extend([2, byte(width), byte(count)]);
            }
            for text in texts {
                let end = bytes.len() + width;
                bytes.extend_from_slice(text.as_bytes());
                bytes.resize(end, b' ');
            }
        }
        NewValues::Integers(words) => {
            dims(&mut bytes, count);
            bytes.extend(words.iter().flat_map(|&word| processor.i16_bytes(word)));
        }
        NewValues::Reals(reals) => {
            dims(&mut bytes, count);
            bytes.extend(reals.iter().flat_map(|&real| processor.f32_bytes(real)));
        }
        NewValues::RealPairs(pairs) => {
            bytes.extend([2, 2, byte(count)]);
            bytes.extend(pairs.iter().flatten().flat_map(|&real| processor.f32_bytes(real)));
        }
    }
    Ok(bytes)
}

fn dims(bytes: &mut Vec<u8>, count: usize) {
    if count == 1 {
        bytes.push(0);
    } else {
        bytes.extend([1, byte(count)]);
    }
}

/// A size that a limit has bounded.
#[expect(clippy::cast_possible_truncation, reason = "callers check the limit")]
fn byte(size: usize) -> u8 {
    size as u8
}
