use ndarray::{ArrayView3, ArrayView4};

use crate::{MM_PER_M, MetricError, quantile};

/// Joints over time: where they are and how they are turned, in the world.
///
/// T frames of J joints. Entries that are not finite mark a joint that is not known in that frame.
#[derive(Debug, Clone, Copy)]
pub struct JointPoses<'a> {
    positions: ArrayView3<'a, f64>,
    rotations: ArrayView4<'a, f64>,
}

impl<'a> JointPoses<'a> {
    /// Takes positions `(T, J, 3)` in metres and rotation matrices `(T, J, 3, 3)`, row by row, that take
    /// a joint's own axes to those of the world.
    ///
    /// # Errors
    /// [`MetricError::JointShape`] if the two are not of as many frames and joints;
    /// [`MetricError::Rotation`] for a finite matrix that is no rotation.
    pub fn new(
        positions: ArrayView3<'a, f64>,
        rotations: ArrayView4<'a, f64>,
    ) -> Result<Self, MetricError> {
        let (frames, joints, three) = positions.dim();
        if three != 3 {
            return Err(shape("joint positions", &[frames, joints, 3], positions.shape()));
        }
        if rotations.dim() != (frames, joints, 3, 3) {
            return Err(shape("joint rotations", &[frames, joints, 3, 3], rotations.shape()));
        }
        let poses = Self { positions, rotations };
        for (t, j) in (0..frames).flat_map(|t| (0..joints).map(move |j| (t, j))) {
            let matrix = poses.rotation(t, j);
            if matrix.as_flattened().iter().all(|x| x.is_finite()) {
                let deviation = deviation_from_rotation(&matrix);
                if deviation > ROTATION_TOLERANCE {
                    return Err(MetricError::Rotation { frame: t, joint: j, deviation });
                }
            }
        }
        Ok(poses)
    }

    /// T.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.positions.dim().0
    }

    /// J.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.positions.dim().1
    }

    fn position(&self, t: usize, j: usize) -> [f64; 3] {
        std::array::from_fn(|axis| self.positions[(t, j, axis)])
    }

    fn rotation(&self, t: usize, j: usize) -> Matrix {
        std::array::from_fn(|r| std::array::from_fn(|c| self.rotations[(t, j, r, c)]))
    }

    /// Place and orientation of a joint as seen from another, or in the world.
    fn seen_from(&self, t: usize, j: usize, from: Option<usize>) -> ([f64; 3], Matrix) {
        let (position, rotation) = (self.position(t, j), self.rotation(t, j));
        let Some(from) = from else { return (position, rotation) };
        let (origin, axes) = (self.position(t, from), self.rotation(t, from));
        let offset = std::array::from_fn(|a| position[a] - origin[a]);
        (transposed_times_vector(&axes, offset), transposed_times(&axes, &rotation))
    }
}

/// The frame in which joints are compared. In any but the world's, each of the two motions is seen from
/// its own joint, so that an error further up the chain does not count again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointFrame {
    /// The world's: global errors.
    World,
    /// Of each joint's parent, and the world's for the root: local errors.
    Parent,
    /// Of one joint: of the wrist for the joints of a hand.
    Joint(usize),
}

/// The joints that count.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum JointChoice {
    /// Every joint.
    All,
    /// Every joint that is some joint's parent: markers say little of how an end is turned.
    WithoutLeaves,
    /// These.
    These(Vec<usize>),
}

/// Errors of joints: position errors (JPE) in mm and orientation errors (JOE) in degrees, unweighted over
/// frames and joints.
#[derive(Debug, Clone, PartialEq)]
pub struct JointErrors {
    /// Joints of all frames that both motions know.
    pub samples: usize,
    /// Joints of all frames that one of the motions does not know; they are in no error.
    pub unknown: usize,
    /// Mean distance in mm; NaN without samples, as all below.
    pub jpe_mean_mm: f64,
    /// Median distance in mm.
    pub jpe_median_mm: f64,
    /// 95 % quantile of the distances in mm.
    pub jpe_p95_mm: f64,
    /// Mean angle in degrees, from 0 to 180.
    pub joe_mean_deg: f64,
    /// Median angle in degrees.
    pub joe_median_deg: f64,
    /// 95 % quantile of the angles in degrees.
    pub joe_p95_deg: f64,
    /// Joint by joint, in the order of the choice.
    pub per_joint: Vec<JointError>,
}

/// Mean errors of one joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointError {
    /// The joint.
    pub joint: usize,
    /// Frames in which both motions know it.
    pub frames: usize,
    /// Mean distance in mm; NaN without frames.
    pub jpe_mean_mm: f64,
    /// Mean angle in degrees; NaN without frames.
    pub joe_mean_deg: f64,
}

/// Position and orientation errors of the chosen joints.
///
/// `parents` `(J,)` holds the parent of each joint, `None` for a root. The orientation error is the
/// angle of the rotation between the two, `arccos((tr(R̂ᵀR) − 1) / 2)`, computed so that it is exact for
/// small angles too.
///
/// # Units
/// Positions in metres; results in mm and degrees.
///
/// # Errors
/// [`MetricError::JointShape`] if motions and parents do not fit each other, [`MetricError::Joint`] for
/// a joint or parent that is not there, [`MetricError::NoJoint`] for a choice of none.
pub fn joint_errors(
    truth: &JointPoses<'_>,
    found: &JointPoses<'_>,
    parents: &[Option<usize>],
    frame: JointFrame,
    choice: &JointChoice,
) -> Result<JointErrors, MetricError> {
    let (frames, joints) = (truth.frames(), truth.joints());
    if (found.frames(), found.joints()) != (frames, joints) {
        let sizes = [found.frames(), found.joints()];
        return Err(shape("the solved motion", &[frames, joints], &sizes));
    }
    if parents.len() != joints {
        return Err(shape("the list of parents", &[joints], &[parents.len()]));
    }
    let chosen = chosen(parents, choice);
    let reference = if let JointFrame::Joint(joint) = frame { Some(joint) } else { None };
    let named = chosen.iter().copied().chain(parents.iter().flatten().copied()).chain(reference);
    if let Some(joint) = named.into_iter().find(|&joint| joint >= joints) {
        return Err(MetricError::Joint { joint, joints });
    }
    if chosen.is_empty() {
        return Err(MetricError::NoJoint);
    }
    let from = |j: usize| match frame {
        JointFrame::World => None,
        JointFrame::Parent => parents[j],
        JointFrame::Joint(joint) => Some(joint),
    };
    let (mut distances_mm, mut angles_deg) = (Vec::new(), Vec::new());
    let mut per_joint = Vec::with_capacity(chosen.len());
    for &joint in &chosen {
        let before = distances_mm.len();
        for t in 0..frames {
            let (p, r) = truth.seen_from(t, joint, from(joint));
            let (q, s) = found.seen_from(t, joint, from(joint));
            let (distance_m, angle) = (mocap_core::geometry::distance(p, q), angle_between(&r, &s));
            if distance_m.is_finite() && angle.is_finite() {
                distances_mm.push(MM_PER_M * distance_m);
                angles_deg.push(angle.to_degrees());
            }
        }
        let frames = distances_mm.len() - before;
        let [jpe_mean_mm, joe_mean_deg] = [&distances_mm, &angles_deg].map(|e| mean(&e[before..]));
        per_joint.push(JointError { joint, frames, jpe_mean_mm, joe_mean_deg });
    }
    let samples = distances_mm.len();
    distances_mm.sort_by(f64::total_cmp);
    angles_deg.sort_by(f64::total_cmp);
    let at = |values: &[f64], p| quantile(values, p).unwrap_or(f64::NAN);
    Ok(JointErrors {
        samples,
        unknown: frames * chosen.len() - samples,
        jpe_mean_mm: mean(&distances_mm),
        jpe_median_mm: at(&distances_mm, 0.5),
        jpe_p95_mm: at(&distances_mm, 0.95),
        joe_mean_deg: mean(&angles_deg),
        joe_median_deg: at(&angles_deg, 0.5),
        joe_p95_deg: at(&angles_deg, 0.95),
        per_joint,
    })
}

fn chosen(parents: &[Option<usize>], choice: &JointChoice) -> Vec<usize> {
    match choice {
        JointChoice::All => (0..parents.len()).collect(),
        JointChoice::WithoutLeaves => {
            (0..parents.len()).filter(|&j| parents.contains(&Some(j))).collect()
        }
        JointChoice::These(joints) => joints.clone(),
    }
}

type Matrix = [[f64; 3]; 3];

/// Matrices read from files carry six digits; what is off by more is no rotation.
const ROTATION_TOLERANCE: f64 = 1e-4;

/// Largest entry of `RᵀR − I`, or infinite for a mirror.
fn deviation_from_rotation(r: &Matrix) -> f64 {
    let square = transposed_times(r, r);
    let off = |a: usize, b: usize| (square[a][b] - f64::from(u8::from(a == b))).abs();
    let largest = (0..3)
        .flat_map(|a| (0..3).map(move |b| (a, b)))
        .map(|(a, b)| off(a, b))
        .fold(0.0, f64::max);
    let normal = mocap_core::geometry::cross(r[0], r[1]);
    if mocap_core::geometry::dot(normal, r[2]) > 0.0 { largest } else { f64::INFINITY }
}

/// Angle of the rotation between two, in radians.
fn angle_between(r: &Matrix, s: &Matrix) -> f64 {
    let d = transposed_times(r, s);
    let axis = [d[2][1] - d[1][2], d[0][2] - d[2][0], d[1][0] - d[0][1]];
    // Twice the sine beside twice the cosine.
    mocap_core::geometry::norm(axis).atan2(d[0][0] + d[1][1] + d[2][2] - 1.0)
}

fn transposed_times(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|r| std::array::from_fn(|c| (0..3).map(|k| a[k][r] * b[k][c]).sum()))
}

fn transposed_times_vector(a: &Matrix, v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|r| (0..3).map(|k| a[k][r] * v[k]).sum())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn shape(what: &'static str, expected: &[usize], found: &[usize]) -> MetricError {
    MetricError::JointShape { what, expected: expected.to_vec(), found: found.to_vec() }
}
