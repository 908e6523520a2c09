//! A body made ready for the inner loop: only joints that turn, parents first.

use mocap_core::{
    Pose, Rotation, Skeleton,
    geometry::{add, scale, sub, times},
};

use crate::body::{Body, Habit};

type Matrix = [[f64; 3]; 3];

/// The joints that turn, and the markers of a take on them.
#[derive(Debug, Clone)]
pub(crate) struct Tree {
    /// Parent of each joint; the root, which comes first, is its own.
    pub(crate) parents: Vec<usize>,
    /// Place of each joint in its parent's frame, in metres.
    pub(crate) offsets: Vec<[f64; 3]>,
    pub(crate) habits: Vec<Habit>,
    /// Joint of the skeleton.
    pub(crate) joints: Vec<usize>,
    pub(crate) anchors: Vec<Anchor>,
}

/// A marker on the tree.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Anchor {
    /// Column of the take.
    pub(crate) column: usize,
    /// Index of the marker in the body.
    pub(crate) site: usize,
    pub(crate) near: usize,
    /// A child of the first joint, and its share.
    pub(crate) far: Option<(usize, f64)>,
    /// In the frame of the first joint, in metres.
    pub(crate) place: [f64; 3],
    /// Weight over that of the other markers: how steady the marker sits.
    pub(crate) grip: f64,
}

impl Anchor {
    /// Whether the marker tells where the root is, whatever the other joints do.
    pub(crate) fn is_on_root(&self) -> bool {
        self.near == 0 && self.far.is_none_or(|(_, share)| share <= 0.5)
    }
}

/// Root translation and joint rotations of one frame.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(crate) root_m: [f64; 3],
    pub(crate) turns: Vec<Rotation>,
}

/// A joint in the world.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placed {
    pub(crate) origin: [f64; 3],
    pub(crate) axes: Matrix,
}

impl Placed {
    pub(crate) const NOWHERE: Self =
        Self { origin: [0.0; 3], axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

    #[inline]
    pub(crate) fn point(&self, local: [f64; 3]) -> [f64; 3] {
        add(self.origin, times(&self.axes, local))
    }
}

impl Tree {
    /// The tree of a body, with the markers that stand in these columns of a take.
    pub(crate) fn new(body: &Body, columns: &[Option<usize>]) -> Self {
        let joints = body.skeleton.joints();
        // Index in the tree of the joint that carries each joint, and the place relative to it.
        let mut carried: Vec<(usize, [f64; 3])> = Vec::with_capacity(joints.len());
        let mut tree = Self {
            parents: Vec::new(),
            offsets: Vec::new(),
            habits: Vec::new(),
            joints: Vec::new(),
            anchors: Vec::new(),
        };
        let mut is_used = vec![false; joints.len()];
        for (site, column) in body.sites.iter().zip(columns) {
            if column.is_some() {
                let tip = site.far.map_or(site.near, |(far, _)| far);
                body.skeleton.ancestry(tip).for_each(|j| is_used[j] = true);
            }
        }
        for (index, joint) in joints.iter().enumerate() {
            let (parent, offset) = match joint.parent {
                None => (0, joint.offset_m),
                Some(p) => (carried[p].0, add(carried[p].1, joint.offset_m)),
            };
            // Joints with nothing on them, such as toes without markers, rest.
            if index > 0 && (body.habits[index].rigid || !is_used[index]) {
                carried.push((parent, offset));
                continue;
            }
            carried.push((tree.parents.len(), [0.0; 3]));
            tree.parents.push(parent);
            tree.offsets.push(offset);
            tree.habits.push(body.habits[index]);
            tree.joints.push(index);
        }
        for (index, (site, column)) in body.sites.iter().zip(columns).enumerate() {
            let Some(column) = *column else { continue };
            let (near, base) = carried[site.near];
            let far = site.far.map(|(far, share)| (carried[far].0, share));
            let far = far.filter(|&(far, _)| far != near);
            tree.anchors.push(Anchor {
                column,
                site: index,
                near,
                far,
                place: add(base, site.place),
                grip: 1.0,
            });
        }
        tree
    }

    pub(crate) fn len(&self) -> usize {
        self.parents.len()
    }

    /// The joints in the world.
    #[inline]
    pub(crate) fn place(&self, state: &State, placed: &mut [Placed]) {
        for (j, turn) in state.turns.iter().enumerate() {
            let local = turn.matrix();
            placed[j] = if j == 0 {
                Placed { origin: add(state.root_m, self.offsets[0]), axes: local }
            } else {
                let parent = &placed[self.parents[j]];
                Placed {
                    origin: parent.point(self.offsets[j]),
                    axes: mocap_core::geometry::product(&parent.axes, &local),
                }
            };
        }
    }

    /// Where a marker should be, in the world.
    #[inline]
    pub(crate) fn marker(&self, anchor: &Anchor, placed: &[Placed]) -> [f64; 3] {
        let held = placed[anchor.near].point(anchor.place);
        let Some((far, share)) = anchor.far else { return held };
        let pulled = placed[far].point(sub(anchor.place, self.offsets[far]));
        add(held, scale(share, sub(pulled, held)))
    }

    /// The joints that move a marker, from the one nearest to it up to the root.
    pub(crate) fn movers(&self, anchor: &Anchor) -> impl Iterator<Item = usize> + '_ {
        let above = |&joint: &usize| (joint > 0).then(|| self.parents[joint]);
        std::iter::successors(Some(anchor.far.map_or(anchor.near, |(far, _)| far)), above)
    }

    /// The pose of the whole skeleton.
    pub(crate) fn pose(&self, state: &State, skeleton: &Skeleton) -> Pose {
        let mut pose = Pose::rest(skeleton);
        pose.root_m = state.root_m;
        for (&joint, &turn) in self.joints.iter().zip(&state.turns) {
            pose.rotations[joint] = turn;
        }
        pose
    }

    /// The rest pose with the root at a place.
    pub(crate) fn rest(&self) -> State {
        State { root_m: [0.0; 3], turns: vec![Rotation::IDENTITY; self.len()] }
    }
}
