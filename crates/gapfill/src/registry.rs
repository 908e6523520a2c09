use std::sync::Arc;

use baselines::{
    CubicSpline, Linear, Msvd, MsvdParams, PatternFill, Pca, PcaParams, Pchip, QuinticSpline,
    RigidBodyFill,
};
use bolero_hc::{BoleroHc, BoleroHcParams};
use bolero_sc::{BoleroSc, BoleroScParams};
use edm_mds::Edm;
use lds_kalman::filler::{self, LdsFiller, LdsFillerParams};
use locality_ridge::LocalRidge;
use mocap_core::{FillError, GapFiller, MarkerKnowledge, MarkerSet};
use solve_ik::{IkFiller, IkParams};
use thiserror::Error;

use crate::{Auto, AutoParams, Borders, Coordinates, Joined, Options, auto::Models};

/// The method to take where the user names none.
pub const DEFAULT: &str = "auto";

/// A method of the registry.
#[derive(Debug, Clone, Copy)]
pub struct Method {
    /// What users type.
    pub id: &'static str,
    /// One line for a person who has to choose.
    pub summary: &'static str,
    /// Names of the [`Options`] that it reads.
    pub options: &'static [&'static str],
    build: fn(&Options) -> Result<Box<dyn GapFiller>, FillError>,
}

/// Every method, simplest first.
pub const METHODS: &[Method] = &[
    Method {
        id: "linear",
        summary: "straight lines across gaps; for a few frames",
        options: &["edges"],
        build: |options| Ok(Box::new(Linear { edges: options.edges })),
    },
    Method {
        id: "spline",
        summary: "a smooth curve through each marker by itself; for gaps up to 0.2 s, and when all markers are gone",
        options: &["edges"],
        build: |options| Ok(Box::new(CubicSpline { edges: options.edges })),
    },
    Method {
        id: "pchip",
        summary: "a curve through each marker by itself that never overshoots; for gaps up to 0.2 s",
        options: &["edges"],
        build: |options| Ok(Box::new(Pchip { edges: options.edges })),
    },
    Method {
        id: "vicon-spline",
        summary: "a quintic spline from the samples right beside a gap, under the rules of Vicon Nexus; refuses short seeds",
        options: &[],
        build: |_| Ok(Box::new(QuinticSpline)),
    },
    Method {
        id: "vicon-pattern",
        summary: "copies the path of one donor marker, as Vicon Nexus does; refuses a donor with a gap",
        options: &[],
        build: |_| Ok(Box::new(PatternFill)),
    },
    Method {
        id: "vicon-rigid",
        summary: "moves with three donor markers as one rigid body, as Vicon Nexus does; refuses donors with a gap",
        options: &[],
        build: |_| Ok(Box::new(RigidBodyFill)),
    },
    Method {
        id: "msvd",
        summary: "a matrix of low rank completed again and again; for comparison",
        options: &["iterations"],
        build: low_rank,
    },
    Method {
        id: "pca",
        summary: "principal components shared with the markers nearby, of Gloersen and Federolf; strong in long gaps",
        options: &["borders"],
        build: components,
    },
    Method {
        id: "edm",
        summary: "distances to six stable neighbours, interpolated across the gap; the locality method before its network",
        options: &[],
        build: |_| Ok(Box::new(Edm::default())),
    },
    Method {
        id: "ridge",
        summary: "regression on stable neighbours in a frame that moves with them; the most accurate while neighbours are seen; tells how sure it is",
        options: &[],
        build: |_| Ok(Box::new(LocalRidge::default())),
    },
    Method {
        id: "auto",
        summary: "the best mixture for each gap, found by trying every method on gaps with known truth; says how sure it is",
        options: &["edges", "max-error", "session", "bodies"],
        build: auto,
    },
    Method {
        id: "dynammo",
        summary: "a linear dynamical system as Li et al. published it in 2009; for comparison",
        options: &["frame", "hidden", "iterations", "published", "start", "seed", "borders"],
        build: |options| {
            let own = LdsFillerParams::dynammo();
            let params = if options.published { LdsFillerParams::published() } else { own };
            dynamical_system(params, Borders::Keep, options)
        },
    },
    Method {
        id: "lds",
        summary: "a linear dynamical system by exact EM; tells how sure it is; needs no bones",
        options: &["frame", "hidden", "iterations", "start", "seed", "borders"],
        build: |options| dynamical_system(LdsFillerParams::default(), Borders::Join, options),
    },
    Method {
        id: "bolero-sc",
        summary: "a linear dynamical system that keeps bone lengths; for long gaps of several markers",
        options: &[
            "bones",
            "lambda",
            "frame",
            "hidden",
            "iterations",
            "published",
            "start",
            "seed",
            "borders",
        ],
        build: soft_bones,
    },
    Method {
        id: "bolero-hc",
        summary: "the same with exact bone lengths; lists the frames in which they cannot be kept",
        options: &[
            "bones",
            "frame",
            "hidden",
            "iterations",
            "published",
            "start",
            "seed",
            "borders",
        ],
        build: hard_bones,
    },
    Method {
        id: "ik",
        summary: "a skeleton solved for the whole body; for whole limbs that are gone; knows the CMU, Plug-in Gait, front_waist-53 and production-57 markers",
        options: &["bodies"],
        build: kinematic,
    },
];

/// Why a method cannot be built.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// No method has this id.
    #[error("no method is called `{id}`; `mocap methods` lists them: {}", ids())]
    Unknown {
        /// The id as given.
        id: String,
    },
    /// An option out of its range.
    #[error("cannot set up `{id}`")]
    Options {
        /// The method.
        id: &'static str,
        /// The option, its value and its range.
        #[source]
        source: FillError,
    },
}

fn ids() -> String {
    METHODS.iter().map(|method| method.id).collect::<Vec<_>>().join(", ")
}

/// Builds the method with this id.
///
/// # Errors
/// [`BuildError::Unknown`], and [`BuildError::Options`] for a value out of range.
pub fn build(id: &str, options: &Options) -> Result<Box<dyn GapFiller>, BuildError> {
    let method = METHODS.iter().find(|method| method.id == id);
    let method = method.ok_or_else(|| BuildError::Unknown { id: id.to_owned() })?;
    (method.build)(options).map_err(|source| BuildError::Options { id: method.id, source })
}

fn low_rank(options: &Options) -> Result<Box<dyn GapFiller>, FillError> {
    let defaults = MsvdParams::default();
    let iterations = options.iterations.unwrap_or(defaults.iterations);
    Ok(Box::new(Msvd::new(MsvdParams { iterations, ..defaults })?))
}

fn components(options: &Options) -> Result<Box<dyn GapFiller>, FillError> {
    let ramp = options.borders != Some(Borders::Keep);
    Ok(Box::new(Pca::new(PcaParams { ramp, ..PcaParams::default() })?))
}

fn auto(options: &Options) -> Result<Box<dyn GapFiller>, FillError> {
    let joined = Options { borders: None, ..options.clone() };
    let lds = dynamical_system(LdsFillerParams::default(), Borders::Join, &joined)?;
    let params = AutoParams {
        max_error_m: options.max_error_m,
        edges: options.edges,
        session: options.session.clone(),
    };
    let models = Models { lds, bolero: soft_bones(&joined)?, ik: kinematic(options)? };
    Ok(Box::new(Auto::with_models(params, models)?))
}

fn kinematic(options: &Options) -> Result<Box<dyn GapFiller>, FillError> {
    let filler = IkFiller::new(options.bodies.clone(), IkParams::default());
    let failed = |source| FillError::Method { method: "ik", source: Box::new(source) };
    Ok(Box::new(filler.map_err(failed)?))
}

fn dynamical_system(
    defaults: LdsFillerParams,
    borders: Borders,
    options: &Options,
) -> Result<Box<dyn GapFiller>, FillError> {
    Ok(bordered(LdsFiller::new(model(defaults, options))?, options.borders.unwrap_or(borders)))
}

fn bordered(filler: impl GapFiller + 'static, borders: Borders) -> Box<dyn GapFiller> {
    match borders {
        Borders::Join => Box::new(Joined::new(filler)),
        Borders::Keep => Box::new(filler),
    }
}

fn soft_bones(options: &Options) -> Result<Box<dyn GapFiller>, FillError> {
    let (defaults, borders) = if options.published {
        (BoleroScParams::published(), Borders::Keep)
    } else {
        (BoleroScParams::default(), Borders::Join)
    };
    let filler = BoleroSc::new(BoleroScParams {
        model: model(defaults.model, options),
        lambda: options.lambda.unwrap_or(defaults.lambda),
        bones: options.bones.source(),
        ..defaults
    })?;
    Ok(bordered(filler, options.borders.unwrap_or(borders)))
}

fn hard_bones(options: &Options) -> Result<Box<dyn GapFiller>, FillError> {
    let own = BoleroHcParams::default();
    let defaults = if options.published { BoleroHcParams::published() } else { own };
    let model = model(defaults.model, options);
    let bones = options.bones.source();
    let filler = BoleroHc::new(BoleroHcParams { model, bones, ..defaults })?;
    // Joining a fill at its borders would stretch the bones.
    Ok(bordered(filler, options.borders.unwrap_or(Borders::Keep)))
}

fn model(defaults: LdsFillerParams, options: &Options) -> LdsFillerParams {
    let coordinates = match options.coordinates {
        None => defaults.coordinates,
        Some(Coordinates::World) => filler::Coordinates::World,
        Some(Coordinates::Body) => filler::Coordinates::Body(Arc::new(facing(&options.known))),
    };
    LdsFillerParams {
        hidden: options.hidden.map_or(defaults.hidden, filler::Hidden::Exactly),
        iterations: options.iterations.unwrap_or(defaults.iterations),
        start: options.start.unwrap_or(defaults.start),
        seed: options.seed,
        coordinates,
        ..defaults
    }
}

/// The first marker set that tells where a body faces.
fn facing(known: &[MarkerKnowledge]) -> MarkerKnowledge {
    let tells = |set: &&MarkerKnowledge| {
        let own = MarkerSet::new(set.markers().iter().map(String::as_str));
        own.is_ok_and(|own| ["back", "front"].iter().all(|role| !set.role(role, &own).is_empty()))
    };
    known.iter().find(tells).cloned().unwrap_or_else(MarkerKnowledge::cmu_41)
}
