use std::sync::Arc;

use mocap_core::{
    JointFrames, Motion, Take,
    geometry::{add, distance, dot, scale, sub},
};

use super::Body;
use crate::IkError;

/// Markers on a body lie nearer to their joints than this on average, in metres: a thigh is no longer.
const REACH_M: f64 = 0.5;

impl Body {
    /// The body as a solved motion of its wearer shows it: on the motion's skeleton, with each marker at its mean place on the
    /// joint that carries it. Spreads become what the places really vary by, 1 mm at least. Markers that the take
    /// does not show keep their places.
    ///
    /// The motion may come from another program, such as an ASF/AMC file; one take with it makes a template for the others of
    /// the session. It must stand in the take's axes.
    ///
    /// # Errors
    /// [`IkError::NoSuchJoint`] for a marker whose joint the skeleton lacks, [`IkError::Frames`] for a motion of another
    /// length than the take, [`IkError::Apart`] for one that is not where the markers are, [`IkError::TwoLabels`], and
    /// [`IkError::Core`].
    pub fn worn(self, take: &Take, motion: &Motion) -> Result<Self, IkError> {
        let (frames, poses) = (take.frames(), motion.poses().len());
        if frames != poses {
            return Err(IkError::Frames { frames, poses });
        }
        let mut body = self.on(Arc::clone(motion.skeleton()))?;
        let columns = body.columns(take.markers())?;
        let joints = motion.poses().iter().map(|pose| motion.skeleton().frames(pose));
        let joints = joints.collect::<Result<Vec<JointFrames>, _>>()?;
        let (mut total, mut count) = (0.0, 0);
        for (site, column) in body.sites.iter_mut().zip(columns) {
            let Some(column) = column else { continue };
            let local = |(t, frames): (usize, &JointFrames)| {
                let off = sub(take.position(t, column)?, frames.origins_m[site.near]);
                Some(frames.rotations[site.near].inverse().apply(off))
            };
            let places: Vec<[f64; 3]> = joints.iter().enumerate().filter_map(local).collect();
            if places.is_empty() {
                continue;
            }
            total += places.iter().map(|p| dot(*p, *p)).sum::<f64>();
            count += places.len();
            let share = 1.0 / places.len() as f64;
            let mean = scale(share, places.iter().copied().fold([0.0; 3], add));
            let square: f64 = places.iter().map(|p| distance(*p, mean).powi(2)).sum();
            site.place = mean;
            site.spread = (share * square / 3.0).sqrt().max(0.001);
            // The mean is of the first joint alone.
            site.far = None;
        }
        let rms_m = (total / count.max(1) as f64).sqrt();
        if rms_m <= REACH_M { Ok(body) } else { Err(IkError::Apart { rms_m }) }
    }
}
