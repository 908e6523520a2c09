use std::fmt::Write;

use mocap_core::Motion;

use crate::text::{asf, euler};

/// Writes a motion as AMC, for the skeleton that [`asf::encode`] writes: six decimals of a degree and
/// nine of the unit.
#[must_use]
pub fn encode(motion: &Motion) -> Vec<u8> {
    let bones = asf::bones(motion.skeleton());
    let mut out = String::from(":FULLY-SPECIFIED\n:DEGREES\n");
    for (frame, pose) in motion.poses().iter().enumerate() {
        let _ = writeln!(out, "{}", frame + 1);
        for (index, bone) in bones.iter().enumerate() {
            let Some(joint) = bone.joint else { continue };
            out.push_str(&bone.name);
            if index == 0 {
                for c in pose.root_m {
                    let _ = write!(out, " {:.9}", c * asf::units_per_metre());
                }
            }
            let [z, y, x] = euler::zyx(pose.rotations[joint]);
            for angle in [x, y, z] {
                let _ = write!(out, " {:.6}", angle.to_degrees());
            }
            out.push('\n');
        }
    }
    out.into_bytes()
}
