use thiserror::Error;

use crate::{CoreError, Motion, Skeleton, Take, Termination};

/// Turns a labelled take into the motion of a skeleton.
pub trait MotionSolver: Send + Sync {
    /// Short name of the method, as users type it.
    fn name(&self) -> &str;

    /// Solves every frame of a take.
    ///
    /// # Errors
    /// [`SolveError`] where the method cannot run on this take at all.
    fn solve(&self, take: &Take, skeleton: &Skeleton) -> Result<Solved, SolveError>;
}

/// A solved motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Solved {
    /// Joint rotations and root translation, one pose a frame.
    pub motion: Motion,
    /// Root mean square distance between measured and predicted markers in metres, one a frame; NaN
    /// where a frame shows no marker.
    pub residual_m: Vec<f64>,
    /// Why the method ended.
    pub termination: Termination,
}

/// Why a method cannot solve a take at all.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SolveError {
    /// A marker that the method needs and the take lacks.
    #[error("the take has no marker `{name}`, which the skeleton's marker map needs")]
    MissingMarker {
        /// Name of the marker.
        name: String,
    },
    /// A value that the core types refuse.
    #[error(transparent)]
    Core(#[from] CoreError),
    /// An error of the method's own.
    #[error("{method} failed")]
    Method {
        /// Name of the method.
        method: &'static str,
        /// What went wrong.
        #[source]
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}
