use std::sync::Arc;

use mocap_core::{BoneRule, BoneSet, MarkerKnowledge, MarkerSet, Mask, Motion, Pose, Take};
use ndarray::{Array3, ArrayView3};

use crate::{
    SynthError, SynthParams,
    body::{Body, JOINTS},
    curve::Wobble,
    dice::{Dice, Stream},
    layout::{self, Worn},
    motion::{Choreography, choreography},
    rig::{self, Placed},
    skin::{Memory, Tissue},
};

/// A body, its markers and its motion, ready to be recorded.
pub struct Synth {
    params: SynthParams,
    body: Body,
    worn: Vec<Worn>,
    choreography: Box<dyn Choreography>,
    breath: Wobble,
}

/// A recording whose truth is known.
#[derive(Debug, Clone)]
pub struct SyntheticTake {
    take: Take,
    skin: Take,
    motion: Motion,
    joints: Array3<f64>,
    bones: BoneSet,
}

/// Time before the first frame in which the soft tissue swings in, in seconds.
const SETTLE_S: f64 = 0.5;

impl Synth {
    /// Draws body, marker placement and motion.
    ///
    /// # Errors
    /// [`SynthError::Frames`] and [`SynthError::OutOfRange`], which name the field and its range.
    ///
    /// ```
    /// use mocap_synth::{Synth, SynthError, SynthParams};
    /// let refused = Synth::new(SynthParams { stature_m: 175.0, ..SynthParams::default() });
    /// assert!(matches!(refused, Err(SynthError::OutOfRange { name: "stature_m", .. })));
    /// ```
    pub fn new(params: SynthParams) -> Result<Self, SynthError> {
        params.check()?;
        let body = Body::sample(params.stature_m, &mut Dice::new(params.seed, Stream::Body))?;
        let worn = layout::wear(&body, &mut Dice::new(params.seed, Stream::Markers));
        let seconds = params.frames as f64 / params.rate_hz;
        let mut dice = Dice::new(params.seed, Stream::Motion);
        let breath = Wobble::new(&mut dice, 1.0, 0.2, 0.35);
        let choreography = choreography(params.motion, &body, seconds, &mut dice);
        Ok(Self { params, body, worn, choreography, breath })
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &SynthParams {
        &self.params
    }

    /// Records the motion: the same bits each time.
    ///
    /// # Errors
    /// [`SynthError::Core`] if the core types refuse the result, which no allowed parameter causes.
    pub fn take(&self) -> Result<SyntheticTake, SynthError> {
        let SynthParams { frames, rate_hz, noise_m, soft_tissue, seed, .. } = self.params;
        let mut noise = Dice::new(seed, Stream::Noise);
        let tissue = Tissue::new(rate_hz);
        let mut memories = self.settle(&tissue);
        let mut poses = Vec::with_capacity(frames);
        let mut joints = Array3::zeros((frames, JOINTS, 3));
        let mut skin = Array3::zeros((frames, self.worn.len(), 3));
        let mut measured = Array3::zeros((frames, self.worn.len(), 3));
        for t in 0..frames {
            let (pose, placed, breath) = self.moment(t as f64 / rate_hz);
            for (j, joint) in placed.iter().enumerate() {
                (0..3).for_each(|a| joints[(t, j, a)] = joint.origin[a]);
            }
            for (m, (worn, memory)) in self.worn.iter().zip(&mut memories).enumerate() {
                let place = worn.place(&placed, breath);
                let shift = tissue.shake(memory, place, soft_tissue * worn.slack);
                for a in 0..3 {
                    let on_skin = place[a] + shift[a];
                    skin[(t, m, a)] = on_skin;
                    measured[(t, m, a)] = on_skin + noise_m * noise.normal();
                }
            }
            poses.push(pose);
        }
        self.finish(poses, joints, skin, measured)
    }

    /// Pose, joint frames and breath at a time in seconds.
    fn moment(&self, time: f64) -> (Pose, [Placed; JOINTS], f64) {
        let pose = rig::pose(&self.body, &self.choreography.posture(&self.body, time));
        let placed = rig::frames(&self.body, &pose);
        (pose, placed, self.breath.at(time))
    }

    /// Lets the soft tissue swing in on the motion just before the first frame.
    fn settle(&self, tissue: &Tissue) -> Vec<Memory> {
        let rate_hz = self.params.rate_hz;
        // The rate is at most 2000 Hz: a thousand frames.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let lead = (SETTLE_S * rate_hz).ceil() as usize;
        let places = |frames_before: usize| {
            let (_, placed, breath) = self.moment(-(frames_before as f64) / rate_hz);
            self.worn.iter().map(move |worn| worn.place(&placed, breath))
        };
        let mut memories: Vec<Memory> = places(lead).map(Memory::at_rest).collect();
        for before in (1..lead).rev() {
            for (place, memory) in places(before).zip(&mut memories) {
                tissue.shake(memory, place, 1.0);
            }
        }
        memories
    }

    fn finish(
        &self,
        poses: Vec<Pose>,
        joints: Array3<f64>,
        skin: Array3<f64>,
        measured: Array3<f64>,
    ) -> Result<SyntheticTake, SynthError> {
        let SynthParams { frames, rate_hz, .. } = self.params;
        let markers = Arc::new(MarkerSet::new(layout::labels())?);
        let all = || Mask::all(frames, markers.len());
        let skin = Take::new(Arc::clone(&markers), rate_hz, skin, all())?;
        let take = Take::new(Arc::clone(&markers), rate_hz, measured, all())?;
        let motion = Motion::new(Arc::clone(&self.body.skeleton), rate_hz, poses)?;
        let pairs = MarkerKnowledge::cmu_41().bone_pairs(&markers);
        let bones = BoneSet::estimate(&skin, &BoneRule::Pairs(pairs))?;
        Ok(SyntheticTake { take, skin, motion, joints, bones })
    }
}

impl SyntheticTake {
    /// What the cameras measured: complete, with noise.
    #[must_use]
    pub fn take(&self) -> &Take {
        &self.take
    }

    /// Where the markers really were, soft tissue included and noise left out.
    #[must_use]
    pub fn truth(&self) -> &Take {
        &self.skin
    }

    /// The skeleton and its true poses.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// True positions of the joints, `(T, J, 3)` in metres, in the order of the skeleton.
    #[must_use]
    pub fn joints(&self) -> ArrayView3<'_, f64> {
        self.joints.view()
    }

    /// The named bones of the marker set with their mean true lengths; empty for a single frame.
    #[must_use]
    pub fn bones(&self) -> &BoneSet {
        &self.bones
    }

    /// The measured take alone.
    #[must_use]
    pub fn into_take(self) -> Take {
        self.take
    }
}
