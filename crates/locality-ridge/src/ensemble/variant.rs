//! The regressions of the ensemble.

use super::kernel::{Curved, Drift, Kernel, Path, Shape};
use crate::Residual;

/// How border errors are carried: fading within a second, or within a quarter of one. Each gives a
/// candidate.
pub(super) const RESIDUALS: [Residual; 2] =
    [Residual::Exponential { tau_s: 0.83 }, Residual::Exponential { tau_s: 0.25 }];

/// One way of learning a marker from its neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Variant {
    pub name: &'static str,
    /// Which neighbours, in which frame.
    pub view: View,
    pub kernel: Kernel,
}

/// Neighbours in a local frame of theirs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    pub carrier: Carrier,
    /// Neighbours to learn from.
    pub regressors: usize,
    /// A regressor's coordinates count by (spread + 3 mm) to the power of minus this.
    pub relevance: f64,
    pub forces: Forces,
}

/// What moves soft tissue beside the pose: how much each counts, where the pose counts one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Forces {
    /// The acceleration of the local frame's centre.
    pub acceleration: f64,
    /// How the local frame is turned in the world, and with it gravity.
    pub attitude: f64,
}

/// What carries a local frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Carrier {
    /// How many neighbours.
    pub core: usize,
    /// Each counts by (spread + 2 mm) to the power of minus this.
    pub steadiness: f64,
}

const fn view(core: usize, steadiness: f64, regressors: usize, relevance: f64) -> View {
    let forces = Forces { acceleration: 0.0, attitude: 0.0 };
    View { carrier: Carrier { core, steadiness }, regressors, relevance, forces }
}

const fn feeling(view: View, acceleration: f64, attitude: f64) -> View {
    View { forces: Forces { acceleration, attitude }, ..view }
}

const fn curved(variance: f64, length: f64) -> Curved {
    Curved { variance, length, ..Curved::NONE }
}

const fn rough(variance: f64, tau_s: f64) -> Drift {
    Drift { variance, tau_s, path: Path::Rough }
}

const fn smooth(variance: f64, tau_s: f64) -> Drift {
    Drift { variance, tau_s, path: Path::Smooth }
}

const PLAIN: Kernel =
    Kernel { linear: 1e4, curved: curved(300.0, 1.0), drift: rough(10.0, 0.83), noise: 10.0 };

/// Alike in like poses, with bends over short distances.
const NEAR: Kernel =
    Kernel { linear: 350.0, curved: curved(300.0, 0.7), drift: rough(30.0, 2.5), noise: 3.0 };

const KINKED: Kernel = Kernel {
    linear: 1.5e4,
    curved: Curved { shape: Shape::Exponential, ..curved(3e3, 1.0) },
    drift: rough(3.0, 0.83),
    noise: 3.0,
};

/// Variants that share a carrier, and those of them that share a view, stand together, so that frames and features
/// are found once.
///
/// They were chosen on takes of `examples/development.rs` in `gapfill`: from a hundred drawn at random, those
/// whose mixture errs least, left out one by one; then six with forces were added after forty draws, and again left out one by one.
pub(super) const VARIANTS: &[Variant] = &[
    Variant {
        name: "six-linear",
        view: view(6, 1.0, 6, 0.0),
        kernel: Kernel { curved: Curved::NONE, ..PLAIN },
    },
    Variant {
        name: "glide-near",
        view: view(6, 1.0, 6, 1.0),
        kernel: Kernel {
            linear: 1e3,
            curved: curved(1e3, 1.5),
            drift: smooth(1e3, 0.42),
            noise: 0.03,
        },
    },
    Variant { name: "eight-shaken", view: feeling(view(8, 1.0, 8, 0.0), 0.73, 0.0), kernel: PLAIN },
    Variant { name: "broad", view: view(12, 2.0, 20, 1.5), kernel: PLAIN },
    Variant {
        name: "broad-turned",
        view: feeling(view(12, 2.0, 20, 1.5), 0.3, 0.95),
        kernel: PLAIN,
    },
    Variant {
        name: "steady-turned",
        view: feeling(view(12, 2.0, 12, 2.0), 0.28, 0.24),
        kernel: Kernel {
            linear: 1.5e4,
            curved: curved(3e3, 2.5),
            drift: rough(30.0, 0.83),
            noise: 30.0,
        },
    },
    Variant {
        name: "glide",
        view: view(12, 2.0, 12, 2.0),
        kernel: Kernel { linear: 1e3, curved: Curved::NONE, drift: smooth(1e3, 0.42), noise: 0.01 },
    },
    Variant {
        name: "fading-shaken",
        view: feeling(view(3, 1.0, 12, 1.5), 0.45, 0.0),
        kernel: Kernel {
            linear: 4.8e4,
            curved: Curved { fade_s: 5.0, ..curved(1e3, 1.5) },
            drift: rough(10.0, 2.5),
            noise: 3.0,
        },
    },
    Variant { name: "near", view: view(3, 0.0, 6, 1.5), kernel: NEAR },
    Variant { name: "near-turned", view: feeling(view(3, 0.0, 6, 1.5), 0.2, 0.36), kernel: NEAR },
    Variant { name: "kinked", view: view(3, 0.0, 12, 2.0), kernel: KINKED },
    Variant {
        name: "kinked-turned",
        view: feeling(view(3, 0.0, 12, 2.0), 0.39, 0.3),
        kernel: KINKED,
    },
];
