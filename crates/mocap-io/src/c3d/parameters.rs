//! Groups and parameters: everything a C3D file says about its data.

use std::ops::Range;

use super::header::text;
use super::number::Processor;

/// Parts of a long list: 255 values each, for all points that 16 bits can count.
const MAX_PARTS: usize = 257;

/// How the values of a parameter are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ParameterKind {
    /// Characters (type -1).
    Text,
    /// Signed bytes (type 1).
    Byte,
    /// 16-bit integers (type 2), signed or unsigned by use.
    Integer,
    /// 32-bit floats (type 4) of the file's processor.
    Real,
    /// A type the standard does not know; the bytes are kept.
    Unknown(i8),
}

impl ParameterKind {
    pub(crate) fn from_byte(byte: i8) -> Self {
        match byte {
            -1 => Self::Text,
            1 => Self::Byte,
            2 => Self::Integer,
            4 => Self::Real,
            other => Self::Unknown(other),
        }
    }
}

/// A group of parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Group {
    /// Number by which parameters refer to it.
    pub id: u8,
    /// Name as the file has it.
    pub name: String,
    /// Description.
    pub description: String,
    /// Whether the file asks not to change it.
    pub locked: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    pub group: u8,
    pub name: Range<usize>,
    pub kind: ParameterKind,
    pub dims: Range<usize>,
    pub data: Range<usize>,
    pub description: Range<usize>,
    pub locked: bool,
}

/// All groups and parameters of a file.
///
/// Names are looked up without regard to case. Where several groups share a name, the first parameter found in any of
/// them counts.
///
/// Implements [C3D] "Parameter section".
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    pub(crate) processor: Processor,
    /// The bytes of the section; the ranges of entries count from its start.
    pub(crate) section: Vec<u8>,
    pub(crate) section_start: usize,
    pub(crate) groups: Vec<Group>,
    pub(crate) entries: Vec<Entry>,
}

/// One parameter, borrowed from its [`Parameters`].
#[derive(Debug, Clone, Copy)]
pub struct Parameter<'a> {
    owner: &'a Parameters,
    entry: &'a Entry,
}

impl Parameters {
    /// The groups in file order.
    #[must_use]
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// All parameters in file order.
    pub fn iter(&self) -> impl Iterator<Item = Parameter<'_>> {
        self.entries.iter().map(|entry| Parameter { owner: self, entry })
    }

    /// The first parameter of that name in a group of that name.
    #[must_use]
    pub fn get(&self, group: &str, name: &str) -> Option<Parameter<'_>> {
        let in_group =
            |id: u8| self.groups.iter().any(|g| g.id == id && g.name.eq_ignore_ascii_case(group));
        self.iter()
            .find(|p| p.raw_name().eq_ignore_ascii_case(name.as_bytes()) && in_group(p.entry.group))
    }

    /// First number of a parameter, 16-bit integers taken as signed.
    #[must_use]
    pub fn number(&self, group: &str, name: &str) -> Option<f64> {
        self.get(group, name)?.numbers().first().copied()
    }

    /// First number of a parameter as a count: 16-bit integers are unsigned, floats are rounded.
    #[must_use]
    pub fn count(&self, group: &str, name: &str) -> Option<usize> {
        self.get(group, name)?.counts().first().copied()
    }

    /// The texts of `NAME`, `NAME2`, `NAME3`, … in one list: how files hold more than 255 of them.
    #[must_use]
    pub fn long_texts(&self, group: &str, name: &str) -> Vec<String> {
        self.parts(group, name).iter().flat_map(Parameter::texts).collect()
    }

    /// The numbers of `NAME`, `NAME2`, `NAME3`, … in one list.
    #[must_use]
    pub fn long_numbers(&self, group: &str, name: &str) -> Vec<f64> {
        self.parts(group, name).iter().flat_map(Parameter::numbers).collect()
    }

    fn parts(&self, group: &str, name: &str) -> Vec<Parameter<'_>> {
        let further = (2..=MAX_PARTS).map_while(|part| self.get(group, &format!("{name}{part}")));
        self.get(group, name).into_iter().chain(further).collect()
    }
}

impl<'a> Parameter<'a> {
    fn raw_name(&self) -> &'a [u8] {
        self.slice(&self.entry.name)
    }

    fn slice(&self, range: &Range<usize>) -> &'a [u8] {
        self.owner.section.get(range.clone()).unwrap_or_default()
    }

    /// Name as the file has it.
    #[must_use]
    pub fn name(&self) -> String {
        text(self.raw_name())
    }

    /// The group it belongs to; `None` where the file never names that group.
    #[must_use]
    pub fn group(&self) -> Option<&'a Group> {
        self.owner.groups.iter().find(|group| group.id == self.entry.group)
    }

    /// How its values are stored.
    #[must_use]
    pub fn kind(&self) -> ParameterKind {
        self.entry.kind
    }

    /// Its dimensions, the fastest first; empty for a single value.
    #[must_use]
    pub fn dims(&self) -> &'a [u8] {
        self.slice(&self.entry.dims)
    }

    /// Description.
    #[must_use]
    pub fn description(&self) -> String {
        text(self.slice(&self.entry.description))
    }

    /// Whether the file asks not to change it.
    #[must_use]
    pub fn is_locked(&self) -> bool {
        self.entry.locked
    }

    /// The bytes of its values, as positions in the file.
    #[must_use]
    pub fn byte_range(&self) -> Range<usize> {
        self.owner.section_start + self.entry.data.start
            ..self.owner.section_start + self.entry.data.end
    }

    /// The bytes of its values.
    #[must_use]
    pub fn bytes(&self) -> &'a [u8] {
        self.slice(&self.entry.data)
    }

    /// Its texts, without padding; empty where it holds no characters.
    #[must_use]
    pub fn texts(&self) -> Vec<String> {
        if self.entry.kind != ParameterKind::Text {
            return Vec::new();
        }
        let width = self.dims().first().map_or(1, |&width| usize::from(width));
        if width == 0 {
            return Vec::new();
        }
        self.bytes().chunks_exact(width).map(text).collect()
    }

    /// Its first text where that is not empty.
    #[must_use]
    pub fn text(&self) -> Option<String> {
        self.texts().into_iter().next().filter(|text| !text.is_empty())
    }

    /// Its numbers, integers taken as signed; empty where it holds characters.
    #[must_use]
    pub fn numbers(&self) -> Vec<f64> {
        let processor = self.owner.processor;
        match self.entry.kind {
            ParameterKind::Byte => {
                self.bytes().iter().map(|&byte| f64::from(byte.cast_signed())).collect()
            }
            ParameterKind::Integer => {
                self.words().map(|word| f64::from(word.cast_signed())).collect()
            }
            ParameterKind::Real => self
                .bytes()
                .as_chunks()
                .0
                .iter()
                .map(|&word| f64::from(processor.f32(word)))
                .collect(),
            ParameterKind::Text | ParameterKind::Unknown(_) => Vec::new(),
        }
    }

    /// Its numbers as counts: integers are unsigned, floats are rounded and clamped at 0.
    #[must_use]
    pub fn counts(&self) -> Vec<usize> {
        match self.entry.kind {
            ParameterKind::Byte => self.bytes().iter().map(|&byte| usize::from(byte)).collect(),
            ParameterKind::Integer => self.words().map(usize::from).collect(),
            _ => self.numbers().into_iter().map(rounded).collect(),
        }
    }

    fn words(&self) -> impl Iterator<Item = u16> + 'a {
        let processor = self.owner.processor;
        self.bytes().as_chunks().0.iter().map(move |&word| processor.u16(word))
    }
}

/// The nearest count, within 32 bits so that products of counts stay in range.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate, NaN gives 0"
)]
pub(crate) fn rounded(value: f64) -> usize {
    value.round() as u32 as usize
}
