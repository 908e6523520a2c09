//! Tests of the synthetic takes.
// Unwrapping is how a test fails; exact comparison is how determinism is tested.
#![allow(clippy::unwrap_used, clippy::float_cmp, clippy::large_types_passed_by_value)]

mod hands;
mod layouts;
mod params;
mod people;
mod realism;
mod repeat;
mod retarget;
mod truth;

use mocap_synth::{Activity, Synth, SynthParams, SyntheticTake};

fn record(params: SynthParams) -> SyntheticTake {
    Synth::new(params).unwrap().take().unwrap()
}

/// Ten seconds at 120 Hz.
fn params(motion: Activity, seed: u64) -> SynthParams {
    SynthParams { motion, seed, frames: 1200, ..SynthParams::default() }
}
