//! Gaps as captures have them.

use anyhow::{Context, Result};
use augment::{GapSampler, GapSamplerParams, Preset, Unlisted};
use mocap_core::{Mask, Take};
use mocap_synth::{Hands, Layout, SynthParams};

/// The samples to hide: body and fingers each by the statistics of their own layout. Names that these do not know, as
/// some of the CMU set, go missing as often as the others do on average.
pub(super) fn draw(take: &Take, params: &SynthParams, share: f64) -> Result<Mask> {
    let body = match params.layout {
        Layout::Production57 => Preset::Production,
        _ => Preset::FrontWaist,
    };
    let fingers = match params.hands {
        Hands::None => None,
        Hands::Five => Some(Preset::FiveFinger),
        _ => Some(Preset::TenFinger),
    };
    let on_body = params.layout.markers().count();
    let mut hidden = Mask::none(take.frames(), take.marker_count());
    let parts = [(Some(body), 0..on_body), (fingers, on_body..take.marker_count())];
    for (preset, markers) in parts {
        let Some(preset) = preset else { continue };
        let model = preset.model()?.at_rate(take.rate_hz())?;
        let settings = GapSamplerParams {
            occlusion: share,
            unlisted: Unlisted::Mean,
            seed: params.seed,
            ..GapSamplerParams::default()
        };
        let part = take.select(&markers.clone().collect::<Vec<_>>())?;
        let sampler = GapSampler::new(model, settings)
            .with_context(|| format!("cannot hide a share of {share}"))?;
        for (t, m) in sampler.sample(&part)?.holdout.hidden().iter() {
            hidden.insert(t, markers.start + m)?;
        }
    }
    Ok(hidden)
}
