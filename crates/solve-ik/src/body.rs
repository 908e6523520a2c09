use std::{collections::HashMap, sync::Arc};

use mocap_core::{
    Joint, MarkerSet, Skeleton,
    geometry::{add, cross, dot, norm, scale, sub},
};

use crate::IkError;

mod built_in;
mod parse;
mod print;
mod worn;

/// A skeleton, how its joints turn, and where its markers sit.
///
/// It is a text file with one fact a line; those in `data` ship with the crate ([`Body::built_in`]).
///
/// ```text
/// name   My body
/// joint  hips                          # the root
/// joint  knee hips 0 -0.42 0           # name, parent, place in the rest pose relative to it, in metres
/// rigid  knee                          # never turns
/// spread knee 70 6 1 0 0               # standard deviation in degrees about an axis, across it, the axis
/// limit  knee -5 165                   # degrees about that axis
/// t-pose knee 0 0 -20                  # its turn in a T-pose: a rotation vector in degrees
/// marker LKNE hips 0.05 -0.42 0 share knee 0.3 spread 0.03
/// alias  LKNE L_Knee                   # `L_Knee` of a take counts as `LKNE`
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    pub(crate) name: String,
    pub(crate) skeleton: Arc<Skeleton>,
    /// One a joint.
    pub(crate) habits: Vec<Habit>,
    pub(crate) sites: Vec<Site>,
    /// Other names of markers, in upper case.
    pub(crate) aliases: HashMap<String, String>,
    /// How far joints may really lie from their place, in metres; 0 where the skeleton is known.
    pub(crate) bone_spread: f64,
}

/// How a joint turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Habit {
    pub(crate) rigid: bool,
    /// A frame whose first axis is the joint's own.
    pub(crate) axes: [[f64; 3]; 3],
    /// Standard deviations about those axes in radians. The root's mean nothing: it may face anywhere.
    pub(crate) spread: [f64; 3],
    /// Least and largest turn about the first axis in radians.
    pub(crate) limits: [f64; 2],
    /// Rotation vector of its turn in a T-pose, in radians.
    pub(crate) t_pose: [f64; 3],
}

impl Habit {
    const FREE: Self = Self {
        rigid: false,
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        spread: [1.0; 3],
        limits: [f64::NEG_INFINITY, f64::INFINITY],
        t_pose: [0.0; 3],
    };

    /// Spread about an axis, and across it.
    fn about(axis: [f64; 3], along: f64, across: f64) -> Option<Self> {
        let length = norm(axis);
        if !(length.is_finite() && length > 1e-6) {
            return None;
        }
        let x = scale(1.0 / length, axis);
        // Any direction well away from the axis spans the plane across it.
        let away = if x[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let y = sub(away, scale(dot(away, x), x));
        let y = scale(1.0 / norm(y), y);
        Some(Self { axes: [x, y, cross(x, y)], spread: [along, across, across], ..Self::FREE })
    }
}

/// Where a marker sits.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Site {
    pub(crate) marker: String,
    pub(crate) near: usize,
    /// A child of the first joint, and its share.
    pub(crate) far: Option<(usize, f64)>,
    /// In metres from the first joint, in the rest pose.
    pub(crate) place: [f64; 3],
    /// Standard deviation of a coordinate of the place in metres.
    pub(crate) spread: f64,
}

impl Body {
    /// Reads a body from its text form; `file` is the name that errors show.
    ///
    /// # Errors
    /// [`IkError::BodyLine`] with the line and the rule it breaks, [`IkError::EmptyBody`],
    /// [`IkError::NotNeighbours`], and [`IkError::Core`] for a tree that is none.
    pub fn parse(text: &str, file: &str) -> Result<Self, IkError> {
        parse::parse(text, file)
    }

    /// The same markers and habits on another skeleton whose joints have the same names and rest pose,
    /// such as that of an ASF file: its bone lengths are taken as known.
    ///
    /// # Errors
    /// [`IkError::NoSuchJoint`] for a marker whose joint the skeleton lacks.
    ///
    /// ```
    /// use solve_ik::Body;
    /// let body = Body::cmu_41();
    /// let again = body.clone().on(body.skeleton().clone())?;
    /// assert_eq!(again.skeleton(), body.skeleton());
    /// # Ok::<(), solve_ik::IkError>(())
    /// ```
    pub fn on(self, skeleton: impl Into<Arc<Skeleton>>) -> Result<Self, IkError> {
        let skeleton = skeleton.into();
        let old = &self.skeleton;
        let joint = |joint: usize| skeleton.find(&old.joints()[joint].name);
        let mut sites = Vec::with_capacity(self.sites.len());
        for site in self.sites {
            let known = |at: usize| {
                joint(at).ok_or_else(|| IkError::NoSuchJoint {
                    marker: site.marker.clone(),
                    joint: old.joints()[at].name.clone(),
                })
            };
            let near = known(site.near)?;
            let far = match site.far {
                Some((far, share)) => Some((known(far)?, share)),
                None => None,
            };
            sites.push(Site { near, far, ..site });
        }
        // Joints that the map does not know carry no marker; they stay as they rest.
        let habits = skeleton.joints().iter().map(|joint| {
            old.find(&joint.name).map_or(Habit { rigid: true, ..Habit::FREE }, |i| self.habits[i])
        });
        let habits = habits.collect();
        let body = Self { skeleton, habits, sites, bone_spread: 0.0, ..self };
        body.check()?;
        Ok(body)
    }

    /// Name of the body.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its skeleton.
    #[must_use]
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// Names of its markers.
    pub fn markers(&self) -> impl Iterator<Item = &str> {
        self.sites.iter().map(|site| site.marker.as_str())
    }

    /// Joint that carries each marker, and the marker's place relative to it in the rest pose, in metres.
    pub fn places(&self) -> impl Iterator<Item = (&str, usize, [f64; 3])> {
        self.sites.iter().map(|site| (site.marker.as_str(), site.near, site.place))
    }

    /// Places are finite, and second joints hang on first ones.
    pub(crate) fn check(&self) -> Result<(), IkError> {
        let lost = |joint: &&Joint| joint.offset_m.iter().any(|c| !c.is_finite());
        if let Some(joint) = self.skeleton.joints().iter().find(lost) {
            return Err(IkError::NoPlace { joint: joint.name.clone() });
        }
        for site in &self.sites {
            let Some((far, _)) = site.far else { continue };
            if self.skeleton.joints()[far].parent != Some(site.near) {
                let name = |joint: usize| self.skeleton.joints()[joint].name.clone();
                let (marker, near, far) = (site.marker.clone(), name(site.near), name(far));
                return Err(IkError::NotNeighbours { marker, near, far });
            }
        }
        Ok(())
    }

    /// Column of the take for each marker of the body, by own names and then by aliases, whatever the
    /// subject's prefix and the case of letters.
    pub(crate) fn columns(&self, markers: &MarkerSet) -> Result<Vec<Option<usize>>, IkError> {
        let mut found: HashMap<String, usize> = HashMap::new();
        let own: HashMap<String, &str> =
            self.sites.iter().map(|s| (s.marker.to_uppercase(), s.marker.as_str())).collect();
        for by_alias in [false, true] {
            for column in 0..markers.len() {
                let label = markers.split(column).1.to_uppercase();
                let name = if by_alias {
                    self.aliases.get(&label).map(String::as_str)
                } else {
                    own.get(&label).copied()
                };
                let Some(name) = name else { continue };
                match found.get(name) {
                    // An alias never displaces the marker it stands for.
                    Some(&first)
                        if !by_alias
                            || self
                                .aliases
                                .contains_key(&markers.split(first).1.to_uppercase()) =>
                    {
                        let (marker, first) = (name.to_owned(), markers.name(first).to_owned());
                        let second = markers.name(column).to_owned();
                        return Err(IkError::TwoLabels { marker, first, second });
                    }
                    Some(_) => {}
                    None => {
                        found.insert(name.to_owned(), column);
                    }
                }
            }
        }
        Ok(self.sites.iter().map(|site| found.get(&site.marker).copied()).collect())
    }

    /// The body grown to another size.
    pub(crate) fn scaled(&self, by: f64) -> Result<Self, IkError> {
        let mut joints = self.skeleton.joints().to_vec();
        for joint in &mut joints {
            joint.offset_m = scale(by, joint.offset_m);
        }
        let mut body = Self { skeleton: Arc::new(Skeleton::new(joints)?), ..self.clone() };
        body.scale_places(by);
        Ok(body)
    }

    pub(crate) fn scale_places(&mut self, by: f64) {
        for site in &mut self.sites {
            site.place = scale(by, site.place);
        }
    }

    /// Places of the markers in the rest pose, in metres.
    pub(crate) fn rest_places(&self) -> Vec<[f64; 3]> {
        let mut origins: Vec<[f64; 3]> = Vec::with_capacity(self.habits.len());
        for joint in self.skeleton.joints() {
            let base = joint.parent.map_or([0.0; 3], |p| origins[p]);
            origins.push(add(base, joint.offset_m));
        }
        self.sites.iter().map(|site| add(origins[site.near], site.place)).collect()
    }
}
