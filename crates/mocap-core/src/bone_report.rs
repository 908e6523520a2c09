use std::collections::BTreeMap;

use crate::{BoneSet, Filled};

/// Which frames of a fill keep their bones.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BoneReport {
    /// Frames in which a bone ends at a filled marker.
    pub constrained: usize,
    /// Those in which a bone is off by [`BoneReport::TOLERANCE_M`] or more, in order.
    pub infeasible: Vec<InfeasibleFrame>,
}

/// A frame in which not all bones have their length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InfeasibleFrame {
    /// Frame, counted from 0.
    pub frame: usize,
    /// Largest difference between the distance of two markers and the length of their bone, in
    /// metres.
    pub residual_m: f64,
}

impl BoneReport {
    /// A bone counts as kept when it is off by less than this, in metres.
    pub const TOLERANCE_M: f64 = 1e-6;

    /// Measures the bones at the filled markers of a fill.
    #[must_use]
    pub fn measure(filled: &Filled, bones: &BoneSet) -> Self {
        let mut worst: BTreeMap<usize, f64> = BTreeMap::new();
        for (frame, marker) in filled.filled_cells().iter() {
            for bone in bones.touching(marker) {
                let (a, b) = bone.markers();
                if let Some(distance) = filled.take().distance(frame, a, b) {
                    let residual = (distance - bone.length_m()).abs();
                    let entry = worst.entry(frame).or_default();
                    *entry = entry.max(residual);
                }
            }
        }
        let broken = worst.iter().filter(|(_, residual)| **residual >= Self::TOLERANCE_M);
        let infeasible =
            broken.map(|(&frame, &residual_m)| InfeasibleFrame { frame, residual_m }).collect();
        Self { constrained: worst.len(), infeasible }
    }
}
