use std::sync::Arc;

use mocap_core::{BoneRule, BoneSet, MarkerKnowledge, MarkerSet, Mask, Motion, Pose, Take};
use ndarray::{Array3, ArrayView3};
use rayon::prelude::*;

use crate::{
    SynthError, SynthParams,
    body::{Body, Build},
    curve::Wobble,
    dice::{Dice, Stream},
    habit::Habits,
    hand::Fingers,
    layout::{self, Hands, Worn},
    motion::{Choreography, choreography},
    retarget::Retarget,
    rig::{self, Frames},
    tissue::{Memory, Tissue},
};

/// A body, its markers and its motion, ready to be recorded.
pub struct Synth {
    params: SynthParams,
    body: Body,
    worn: Vec<Worn>,
    source: Source,
    /// Of a person.
    habits: Option<Habits>,
    /// Left, right.
    fingers: Option<[Fingers; 2]>,
    breath: Wobble,
}

/// Where the motion of the body comes from.
enum Source {
    Generator(Box<dyn Choreography>),
    Recording(Retarget),
}

/// A recording whose truth is known.
#[derive(Debug, Clone)]
pub struct SyntheticTake {
    take: Take,
    skin: Take,
    motion: Motion,
    joints: Array3<f64>,
    bones: BoneSet,
    attachments: Vec<Attachment>,
    sliding_m: Vec<f64>,
}

/// How a marker hangs on the skeleton while no soft tissue moves: its place is a mix of two points that are fixed
/// to two joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Attachment {
    /// Name of the marker.
    pub label: &'static str,
    /// The joint that carries it, and the one that pulls at the skin with it.
    pub joints: [usize; 2],
    /// The points in the frames of the two joints, in metres.
    pub local_m: [[f64; 3]; 2],
    /// Share of the second point, from 0 to 1.
    pub share: f64,
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
        Self::with(&params, |body, seconds, dice| {
            Ok(Source::Generator(choreography(params.motion, body, seconds, dice)))
        })
    }

    /// Draws body and marker placement, and lets the body do what a recorded skeleton does; `motion` of the
    /// parameters means nothing then. The recording may be of another size, in other axes and at another rate; where it
    /// is shorter than the take, the body stands still.
    ///
    /// Rotations are taken over bone by bone from rest pose to rest pose, the way of the hips is scaled by the length of
    /// the legs, and the whole is lowered until the feet stand on the floor. Skeletons need the names of the CMU
    /// database's ASF or BVH files, of SMPL's topology, or of this crate.
    ///
    /// # Errors
    /// Those of [`new`](Self::new), and [`SynthError::NoSuchPart`], [`SynthError::NoLength`],
    /// [`SynthError::NoFrames`] and [`SynthError::NotFinite`] for recordings that cannot be retargeted.
    pub fn retarget(params: SynthParams, motion: &Motion) -> Result<Self, SynthError> {
        Self::with(&params, |body, _, _| Ok(Source::Recording(Retarget::new(body, motion)?)))
    }

    fn with(
        params: &SynthParams,
        source: impl FnOnce(&Body, f64, &mut Dice) -> Result<Source, SynthError>,
    ) -> Result<Self, SynthError> {
        params.check()?;
        let SynthParams { seed, layout, hands, marker_radius_m, .. } = *params;
        let build = match &params.person {
            None => Build::sample(params.stature_m, &mut Dice::new(seed, Stream::Body)),
            Some(person) => Build::of(person),
        };
        let body = Body::new(build, hands != Hands::None)?;
        let mut dice = Dice::new(seed, Stream::Markers);
        let worn = layout::wear(&body, layout, hands, marker_radius_m, &mut dice);
        let seconds = params.frames as f64 / params.rate_hz;
        let mut dice = Dice::new(seed, Stream::Motion);
        let breath = Wobble::new(&mut dice, 1.0, 0.2, 0.35);
        let source = source(&body, seconds, &mut dice)?;
        let fingers = (hands != Hands::None).then(|| {
            let mut dice = Dice::new(seed, Stream::Hands);
            [0, 1].map(|side| Fingers::new(side, seconds, &mut dice))
        });
        let habits = params.person.map(|_| Habits::new(&mut Dice::new(seed, Stream::Habits)));
        Ok(Self { params: *params, body, worn, source, habits, fingers, breath })
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
        self.take_observed(&mut |_| ())
    }

    /// The same, and tells now and then how many frames are done.
    ///
    /// # Errors
    /// As [`take`](Self::take).
    pub fn take_observed(&self, watch: &mut dyn FnMut(usize)) -> Result<SyntheticTake, SynthError> {
        /// Frames between two words.
        const EVERY: usize = 1024;
        let SynthParams { frames, rate_hz, noise_m, soft_tissue, seed, .. } = self.params;
        let mut noise = Dice::new(seed, Stream::Noise);
        let tissue = Tissue::new(rate_hz);
        let mut moment = Frames::new(&self.body);
        let mut memories = self.settle(&tissue, &mut moment);
        let mut poses = Vec::with_capacity(frames);
        let mut joints = Vec::with_capacity(3 * frames * moment.placed.len());
        let mut skin = Vec::with_capacity(3 * frames * self.worn.len());
        let mut measured = Vec::with_capacity(3 * frames * self.worn.len());
        let mut sliding_m = Vec::with_capacity(frames);
        for t in 0..frames {
            let (pose, breath) = self.moment(t as f64 / rate_hz, &mut moment);
            for joint in &moment.placed {
                joints.extend_from_slice(&joint.origin);
            }
            let mut slid = 0.0;
            for (worn, memory) in self.worn.iter().zip(&mut memories) {
                let place = worn.place(&moment.placed, breath);
                let shift = tissue.shake(memory, place, soft_tissue * worn.slack);
                for a in 0..3 {
                    let on_skin = place[a] + shift[a];
                    skin.push(on_skin);
                    measured.push(on_skin + noise_m * noise.normal());
                    slid += shift[a] * shift[a];
                }
            }
            sliding_m.push((slid / self.worn.len() as f64).sqrt());
            poses.push(pose);
            if t % EVERY == 0 {
                watch(t);
            }
        }
        watch(frames);
        self.finish(poses, joints, [skin, measured], sliding_m)
    }

    /// Pose and breath at a time in seconds, with the joints' frames.
    fn moment(&self, time: f64, frames: &mut Frames) -> (Pose, f64) {
        let mut pose = match &self.source {
            Source::Generator(choreography) => {
                let mut posture = choreography.posture(&self.body, time);
                if let Some(habits) = &self.habits {
                    habits.put_on(&mut posture, time);
                }
                rig::pose(&self.body, &posture)
            }
            Source::Recording(retarget) => retarget.pose(time),
        };
        for fingers in self.fingers.iter().flatten() {
            pose.rotations.extend(fingers.rotations(time));
        }
        frames.set(&self.body, &pose);
        (pose, self.breath.at(time))
    }

    /// Lets the soft tissue swing in on the motion just before the first frame.
    fn settle(&self, tissue: &Tissue, frames: &mut Frames) -> Vec<Memory> {
        let rate_hz = self.params.rate_hz;
        // The rate is at most 2000 Hz: a thousand frames.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let lead = (SETTLE_S * rate_hz).ceil() as usize;
        let mut places = |frames_before: usize| {
            let (_, breath) = self.moment(-(frames_before as f64) / rate_hz, frames);
            self.worn.iter().map(|worn| worn.place(&frames.placed, breath)).collect::<Vec<_>>()
        };
        let mut memories: Vec<Memory> = places(lead).into_iter().map(Memory::at_rest).collect();
        for before in (1..lead).rev() {
            for (place, memory) in places(before).into_iter().zip(&mut memories) {
                tissue.shake(memory, place, 1.0);
            }
        }
        memories
    }

    fn finish(
        &self,
        poses: Vec<Pose>,
        joints: Vec<f64>,
        [skin, measured]: [Vec<f64>; 2],
        sliding_m: Vec<f64>,
    ) -> Result<SyntheticTake, SynthError> {
        let SynthParams { frames, rate_hz, .. } = self.params;
        let markers = Arc::new(MarkerSet::new(self.worn.iter().map(|worn| worn.label))?);
        let all = || Mask::all(frames, markers.len());
        let cube = |width: usize, values: Vec<f64>| {
            // As many values were pushed as the shape holds.
            Array3::from_shape_vec((frames, width, 3), values).unwrap_or_default()
        };
        let skin = Take::new(Arc::clone(&markers), rate_hz, cube(markers.len(), skin), all())?;
        let take = Take::new(Arc::clone(&markers), rate_hz, cube(markers.len(), measured), all())?;
        let joints = cube(self.body.skeleton.joints().len(), joints);
        let motion = Motion::new(Arc::clone(&self.body.skeleton), rate_hz, poses)?;
        let pairs = MarkerKnowledge::for_markers(&markers).bone_pairs(&markers);
        let bones = BoneSet::estimate(&skin, &BoneRule::Pairs(pairs))?;
        let attachments = self.worn.iter().map(Worn::attachment).collect();
        Ok(SyntheticTake { take, skin, motion, joints, bones, attachments, sliding_m })
    }
}

/// Records many takes at once, on the threads of the surrounding pool: the same bits on any number of them.
///
/// # Errors
/// Those of [`Synth::new`] and [`Synth::take`], of the first take that has one.
///
/// ```
/// use mocap_synth::{Person, SynthParams, record_all};
/// let crowd: Vec<SynthParams> = (0..3)
///     .map(|seed| SynthParams { seed, person: Some(Person::draw(seed)), frames: 60, ..SynthParams::default() })
///     .collect();
/// assert_eq!(record_all(&crowd)?.len(), 3);
/// # Ok::<(), mocap_synth::SynthError>(())
/// ```
pub fn record_all(params: &[SynthParams]) -> Result<Vec<SyntheticTake>, SynthError> {
    let takes: Vec<Result<SyntheticTake, SynthError>> =
        params.par_iter().map(|params| Synth::new(*params)?.take()).collect();
    takes.into_iter().collect()
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

    /// The bones that the marker set names, with their mean true lengths; empty for a single frame.
    #[must_use]
    pub fn bones(&self) -> &BoneSet {
        &self.bones
    }

    /// How each marker hangs on the skeleton, in column order.
    #[must_use]
    pub fn attachments(&self) -> &[Attachment] {
        &self.attachments
    }

    /// How far soft tissue moves the markers in each frame: root mean square in metres, `(T,)`.
    #[must_use]
    pub fn sliding_m(&self) -> &[f64] {
        &self.sliding_m
    }

    /// The measured take alone.
    #[must_use]
    pub fn into_take(self) -> Take {
        self.take
    }
}
