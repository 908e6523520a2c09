//! Events of a recording.

use super::header::Header;
use super::parameters::Parameters;

/// Something that happened during the recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// What, like `Foot Strike`.
    pub label: String,
    /// Of which side or kind, like `Left`; empty where the file does not say.
    pub context: String,
    /// Time from the start of the trial, in seconds.
    pub time_s: f64,
}

/// Events of the `EVENT` group, whose times are minutes and seconds; else those of the header.
///
/// Implements [C3D] "The EVENT group".
pub(crate) fn read(header: &Header, parameters: &Parameters) -> Vec<Event> {
    let labels = parameters.long_texts("EVENT", "LABELS");
    let contexts = parameters.long_texts("EVENT", "CONTEXTS");
    let times = parameters.long_numbers("EVENT", "TIMES");
    let used = parameters.count("EVENT", "USED").unwrap_or_default();
    let of = |texts: &[String], index: usize| texts.get(index).cloned().unwrap_or_default();
    if used == 0 {
        let events = header.events.iter();
        return events
            .map(|event| Event {
                label: event.label.clone(),
                context: String::new(),
                time_s: f64::from(event.time_s),
            })
            .collect();
    }
    let times = times.as_chunks::<2>().0.iter().take(used).enumerate();
    times
        .map(|(index, &[minutes, seconds])| Event {
            label: of(&labels, index),
            context: of(&contexts, index),
            time_s: minutes * 60.0 + seconds,
        })
        .collect()
}
