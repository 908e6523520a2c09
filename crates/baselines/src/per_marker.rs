use mocap_core::{
    Estimates, FillError, FillReport, Filled, Gap, GapContext, Refusal, Refused, Take, Termination,
};

/// What becomes of a gap that reaches the start or the end of the take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Edges {
    /// It stays open, with [`Refusal::OneSided`].
    #[default]
    Refuse,
    /// It is filled with the nearest observed position.
    Hold,
}

/// The observed samples of one marker, in frame order.
pub(crate) struct Samples {
    pub frames: Vec<usize>,
    pub values: Vec<[f64; 3]>,
}

impl Samples {
    fn of(take: &Take, marker: usize) -> Self {
        let seen = (0..take.frames()).filter_map(|t| Some((t, take.position(t, marker)?)));
        let (frames, values) = seen.unzip();
        Self { frames, values }
    }
}

/// Fills marker by marker: `curve` gets a marker's samples and gives a function from frame to position.
pub(crate) fn fill<C: Fn(usize) -> [f64; 3]>(
    take: &Take,
    method: &str,
    edges: Edges,
    curve: impl Fn(Samples) -> C,
) -> Result<Filled, FillError> {
    let gaps = take.gaps();
    if gaps.is_empty() {
        return Ok(Filled::unchanged(take, FillReport::new(method, Termination::NothingToFill))?);
    }
    if take.observed().count() == 0 {
        return Err(FillError::NothingObserved);
    }
    let mut report = FillReport::new(method, Termination::ClosedForm);
    let mut positions = take.positions().to_owned();
    for of_marker in gaps.chunk_by(|g, h| g.marker == h.marker) {
        let marker = of_marker[0].marker;
        let samples = Samples::of(take, marker);
        let ends = samples.values.first().copied().zip(samples.values.last().copied());
        let inside = ends.map(|ends| (ends, curve(samples)));
        for gap in of_marker {
            let place = match (gap.context(take.frames()), &inside) {
                (GapContext::Whole, _) | (_, None) => Err(Refusal::NeverSeen),
                (GapContext::Interior, Some((_, inside))) => Ok(Place::Curve(inside)),
                (_, _) if edges == Edges::Refuse => Err(Refusal::OneSided),
                (GapContext::Leading, Some(((first, _), _))) => Ok(Place::Still(*first)),
                (GapContext::Trailing, Some(((_, last), _))) => Ok(Place::Still(*last)),
            };
            match place {
                Err(reason) => report.refusals.push(Refused { gap: gap.clone(), reason }),
                Ok(place) => write(&mut positions, gap, &place),
            }
        }
    }
    Ok(Filled::merge(take, Estimates { positions, sigma_m: None }, report)?)
}

/// Where the samples of a gap come from.
enum Place<'a, C> {
    Curve(&'a C),
    Still([f64; 3]),
}

fn write<C: Fn(usize) -> [f64; 3]>(
    positions: &mut ndarray::Array3<f64>,
    gap: &Gap,
    place: &Place<'_, C>,
) {
    for t in gap.frames.clone() {
        let p = match place {
            Place::Curve(curve) => curve(t),
            Place::Still(p) => *p,
        };
        for (axis, c) in p.into_iter().enumerate() {
            positions[(t, gap.marker, axis)] = c;
        }
    }
}
