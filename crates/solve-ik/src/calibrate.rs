//! Bone lengths and marker places of one body, from frames that differ.
//!
//! All of it is one least-squares problem: the shared unknowns s (a place a joint, a place a marker) and the poses p of some
//! frames. Given s, frames do not know of each other, so their normal equations are eliminated frame by frame,
//!
//! ```text
//! (Hss − Σ Hpsᵀ Hpp⁻¹ Hps) Δs = −gs + Σ Hpsᵀ Hpp⁻¹ gp
//! ```
//!
//! which moves bones, markers and poses together. Alternating between them crawls, because a joint that lies
//! wrong is made up for by turned poses.

use std::sync::Arc;

use mocap_core::{
    Skeleton,
    geometry::{add, sub},
};

use crate::{
    IkError, IkParams,
    body::Body,
    frame::{Seen, Ties},
    tree::{State, Tree},
};

mod layout;
mod system;

use layout::Layout;
use system::System;

/// How far from a pose that they are told to take people stand, as a standard deviation in radians.
const POSE_RAD: f64 = 0.07;
/// Steps at most, and the share of the cost below which a step is the last.
const STEPS: usize = 25;
const ENOUGH: f64 = 1e-5;

/// A frame to calibrate on.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    pub(crate) seen: Vec<Seen>,
    pub(crate) state: State,
    /// How its joints are turned, where that is known.
    pub(crate) pose: Option<State>,
}

/// Weights of the turns of a pose that is known, and of one that is not.
struct Firmness {
    known: Vec<f64>,
    free: Vec<f64>,
}

impl Firmness {
    fn of(tree: &Tree) -> Self {
        let mut known = vec![POSE_RAD.powi(-2); tree.len()];
        // Where the body faces is no part of a pose.
        known[0] = 0.0;
        Self { known, free: vec![0.0; tree.len()] }
    }

    fn ties<'a>(&'a self, sample: &'a Sample) -> Ties<'a> {
        match &sample.pose {
            Some(pose) => Ties { target: pose, shift: 0.0, turns: &self.known },
            None => Ties { target: &sample.state, shift: 0.0, turns: &self.free },
        }
    }
}

/// How a calibration ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Calibrated {
    pub(crate) cost: f64,
    pub(crate) steps: usize,
}

/// Adjusts the joints and markers of a tree, and the poses of the samples, to fit together; `template` is
/// where they are expected.
pub(crate) fn calibrate(
    tree: &mut Tree,
    samples: &mut [Sample],
    template: &Tree,
    body: &Body,
    params: &IkParams,
) -> Calibrated {
    let layout = Layout::new(tree, template, body, samples.len());
    let mut cost = layout.cost(tree, samples, params);
    let mut damping = 1e-3;
    for step in 0..STEPS {
        let system = System::solved(&layout, tree, samples, params, damping);
        let next = system.map(|system| {
            let (tree, samples) = system.advance(&layout, tree, samples);
            let cost = layout.cost(&tree, &samples, params);
            (tree, samples, cost)
        });
        match next {
            Some((new_tree, new_samples, next)) if next < cost => {
                let gain = (cost - next) / cost;
                *tree = new_tree;
                samples.clone_from_slice(&new_samples);
                cost = next;
                damping = (damping * 0.1_f64).max(1e-9);
                if gain < ENOUGH {
                    return Calibrated { cost, steps: step + 1 };
                }
            }
            _ if damping > 1e3 => return Calibrated { cost, steps: step + 1 },
            _ => damping *= 10.0,
        }
    }
    Calibrated { cost, steps: STEPS }
}

/// The body with the joints and markers of a calibrated tree, which started as `before`.
pub(crate) fn dressed(body: &Body, before: &Tree, after: &Tree) -> Result<Body, IkError> {
    let mut joints = body.skeleton.joints().to_vec();
    for j in 0..before.len() {
        let moved = sub(after.offsets[j], before.offsets[j]);
        let joint = &mut joints[before.joints[j]];
        joint.offset_m = add(joint.offset_m, moved);
    }
    let mut sites = body.sites.clone();
    for (old, new) in before.anchors.iter().zip(&after.anchors) {
        let site = &mut sites[old.site];
        site.place = add(site.place, sub(new.place, old.place));
    }
    Ok(Body { skeleton: Arc::new(Skeleton::new(joints)?), sites, ..body.clone() })
}
