use gapfill::{Borders, Edges, METHODS, Options, Start};
use serde::Serialize;

use crate::ReproError;

/// A method of the registry with options of its own: `bolero-sc`, or `bolero-sc+lambda=100`.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    id: &'static str,
    reads: &'static [&'static str],
    label: String,
    settings: Settings,
}

/// What a variant sets; all else is the method's own choice.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub(crate) struct Settings {
    lambda: Option<f64>,
    hidden: Option<usize>,
    keep_borders: Option<bool>,
    random_start: Option<bool>,
    published: bool,
    pub(crate) session: bool,
}

const KEYS: [&str; 6] = ["lambda", "hidden", "borders", "start", "published", "session"];

impl Variant {
    /// Every method of the registry, as it comes.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let variant = |method: &gapfill::Method| Self {
            id: method.id,
            reads: method.options,
            label: method.id.to_owned(),
            settings: Settings::default(),
        };
        METHODS.iter().map(variant).collect()
    }

    /// Reads `METHOD` or `METHOD+option=value+…`; the options are `lambda` (from 0), `hidden` (from 1),
    /// `borders` (`join` or `keep`), `start` (`random` or `subspace`), and without a value `published` (all
    /// settings of the paper) and `session` (learns from the other motions of the subject), where the method reads
    /// them.
    ///
    /// # Errors
    /// [`ReproError::Method`] for a method that is not in the registry and for values out of range,
    /// [`ReproError::Variant`] for an option that the method does not read.
    pub fn parse(text: &str) -> Result<Self, ReproError> {
        let refused = |source| ReproError::Method { text: text.to_owned(), source };
        let mut parts = text.split('+');
        let id = parts.next().unwrap_or_default();
        let Some(mut variant) = Self::all().into_iter().find(|variant| variant.id == id) else {
            // The registry words the refusal, with the methods that there are.
            return match gapfill::build(id, &Options::default()) {
                Err(source) => Err(refused(source)),
                Ok(_) => Err(unknown_option(text, id, &[])),
            };
        };
        for part in parts {
            variant.set(part).ok_or_else(|| unknown_option(text, part, variant.reads))?;
        }
        text.clone_into(&mut variant.label);
        gapfill::build(variant.id, &variant.options()).map_err(refused)?;
        Ok(variant)
    }

    /// Reads a list with commas between; empty means every method of the registry.
    ///
    /// # Errors
    /// As [`parse`](Self::parse).
    pub fn parse_list(texts: &[String]) -> Result<Vec<Self>, ReproError> {
        if texts.is_empty() {
            return Ok(Self::all());
        }
        texts.iter().map(|text| Self::parse(text.trim())).collect()
    }

    fn set(&mut self, part: &str) -> Option<()> {
        let (key, value) = part.split_once('=').unwrap_or((part, ""));
        if !(self.reads.contains(&key) && KEYS.contains(&key)) {
            return None;
        }
        let settings = &mut self.settings;
        match key {
            "lambda" => settings.lambda = Some(value.parse().ok()?),
            "hidden" => settings.hidden = Some(value.parse().ok()?),
            "published" if value.is_empty() => settings.published = true,
            "session" if value.is_empty() => settings.session = true,
            "published" | "session" => return None,
            "borders" => settings.keep_borders = Some(borders(value)? == Borders::Keep),
            _ => settings.random_start = Some(start(value)? == Start::Random),
        }
        Some(())
    }

    /// What tables call it.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
    }

    pub(crate) fn id(&self) -> &'static str {
        self.id
    }

    pub(crate) fn settings(&self) -> Settings {
        self.settings
    }

    /// Whether the method reads an option of this name.
    pub(crate) fn reads(&self, option: &str) -> bool {
        self.reads.contains(&option)
    }

    /// Options for the method. Gaps at the ends of a take are held, as the published code did, so
    /// that every hidden sample is scored.
    pub(crate) fn options(&self) -> Options {
        let Settings { lambda, hidden, keep_borders, random_start, published, .. } = self.settings;
        let borders = keep_borders.map(|keep| if keep { Borders::Keep } else { Borders::Join });
        let start = random_start.map(|random| if random { Start::Random } else { Start::Subspace });
        let edges = Edges::Hold;
        Options { lambda, hidden, borders, start, published, edges, ..Options::default() }
    }
}

fn borders(text: &str) -> Option<Borders> {
    match text {
        "join" => Some(Borders::Join),
        "keep" => Some(Borders::Keep),
        _ => None,
    }
}

fn start(text: &str) -> Option<Start> {
    match text {
        "random" => Some(Start::Random),
        "subspace" => Some(Start::Subspace),
        _ => None,
    }
}

fn unknown_option(text: &str, option: &str, reads: &[&str]) -> ReproError {
    let known: Vec<&str> = KEYS.into_iter().filter(|key| reads.contains(key)).collect();
    let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
    ReproError::Variant { text: text.to_owned(), option: option.to_owned(), known }
}
