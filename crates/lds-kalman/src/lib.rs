#![doc = include_str!("../README.md")]

mod backward;
mod covariance;
mod dynamics;
mod em;
mod error;
pub mod filler;
mod forward;
mod inference;
mod kernel;
mod missing;
mod model;
mod observations;
mod panel;
mod smoother;
mod start;
mod statistics;
mod subspace;

pub use covariance::{Covariance, CovarianceStructure};
pub use em::{
    EmParams, EmProgress, Fit, MissingUpdate, Prediction, Termination, UpdateContext, fit_em,
};
pub use error::LdsError;
pub use inference::EStep;
pub use missing::MissingEntries;
pub use model::{LdsModel, LdsParts, Sample};
pub use observations::Observations;
pub use smoother::{Filtered, Smoothed, filter, smooth};
pub use start::Start;
pub use statistics::{NoiseStructure, Statistics, e_step, m_step};
