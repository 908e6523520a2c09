use mocap_core::{
    Motion, Pose,
    geometry::{dot, norm, sub},
};

use crate::ReproError;

/// Names of the angles, short enough for an axis.
pub(super) const ANGLES: [&str; 11] = [
    "hip flexion",
    "hip abduction",
    "knee",
    "ankle",
    "shoulder raise",
    "elbow",
    "wrist",
    "trunk bend",
    "trunk turn",
    "head nod",
    "head turn",
];

/// Angles of a body over time in degrees, one list for each of `ANGLES`.
#[derive(Debug, Clone, Default)]
pub(super) struct Angles {
    pub degrees: [Vec<f64>; ANGLES.len()],
}

impl Angles {
    /// Adds the angles of a motion of `mocap-synth`'s skeleton.
    pub(super) fn add(&mut self, motion: &Motion) -> Result<(), ReproError> {
        for pose in motion.poses() {
            self.add_pose(motion, pose)?;
        }
        Ok(())
    }

    fn add_pose(&mut self, motion: &Motion, pose: &Pose) -> Result<(), ReproError> {
        let skeleton = motion.skeleton();
        let frames = skeleton.frames(pose)?;
        // The skeleton is the crate's own: all its joints are there.
        let index = |name: &str| skeleton.find(name).unwrap_or_default();
        let seen = |from: &str, of: [f64; 3]| frames.rotations[index(from)].inverse().apply(of);
        let mut push = |n: usize, radians: f64| self.degrees[n].push(radians.to_degrees());
        for (side, left) in [("left", 1.0), ("right", -1.0)] {
            let place = |part: &str| frames.origins_m[index(&format!("{side}_{part}"))];
            let bone = |from: &str, to: &str| sub(place(to), place(from));
            let [x, y, z] = seen("pelvis", bone("hip", "knee"));
            push(0, x.atan2(-z));
            push(1, (left * y).atan2(x.hypot(z)));
            push(2, between(bone("hip", "knee"), bone("knee", "ankle")));
            push(3, between(bone("knee", "ankle"), bone("ankle", "toe")));
            push(4, between(seen("upper_spine", bone("shoulder", "elbow")), [0.0, 0.0, -1.0]));
            push(5, between(bone("shoulder", "elbow"), bone("elbow", "wrist")));
            push(6, pose.rotations[index(&format!("{side}_wrist"))].angle());
        }
        let turn = |from: &str, to: &str| {
            let relative =
                frames.rotations[index(from)].inverse().after(frames.rotations[index(to)]);
            let ahead = relative.apply([1.0, 0.0, 0.0]);
            let up = relative.apply([0.0, 0.0, 1.0]);
            // How far it bends ahead, and how far it turns to the left.
            [up[0].atan2(up[2]), ahead[1].atan2(ahead[0])]
        };
        let ([bend, twist], [nod, look]) =
            (turn("pelvis", "upper_spine"), turn("upper_spine", "head"));
        for (n, angle) in [(7, bend), (8, twist), (9, nod), (10, look)] {
            push(n, angle);
        }
        Ok(())
    }

    pub(super) fn sort(&mut self) {
        self.degrees.iter_mut().for_each(|values| values.sort_by(f64::total_cmp));
    }
}

/// The angle between two directions.
fn between(p: [f64; 3], q: [f64; 3]) -> f64 {
    (dot(p, q) / (norm(p) * norm(q))).clamp(-1.0, 1.0).acos()
}
