use crate::math::degrees;

/// What tells walking from running. Lengths in metres of the template, angles in radians, phases as
/// shares of a cycle (two steps) from a foot's first contact.
#[derive(Clone, Copy)]
pub(crate) struct Style {
    pub(super) cycles_hz: f64,
    pub(super) stride: f64,
    pub(super) radius: f64,
    /// Share of the cycle in which a foot is on the ground.
    pub(super) stance: f64,
    /// Of the ankle before the pelvis at contact.
    pub(super) lead: f64,
    /// From the track's middle to a footprint.
    pub(super) width: f64,
    pub(super) toe_out: f64,
    /// Of the swinging foot, on top of what its pitch lifts.
    pub(super) lift: f64,
    /// Pitch of the foot over the cycle, heel up positive.
    pub(super) pitch: &'static [(f64, [f64; 1])],
    /// Mean height of the pelvis below standing, as a share of the leg.
    pub(super) crouch: f64,
    pub(super) bounce: f64,
    /// Phase of the lowest point.
    pub(super) lowest: f64,
    pub(super) sway: f64,
    pub(super) pelvis_turn: f64,
    pub(super) pelvis_drop: f64,
    pub(super) pelvis_pitch: f64,
    pub(super) lean: f64,
    pub(super) arm_swing: f64,
    pub(super) arm_mean: f64,
    pub(super) elbow: f64,
    pub(super) elbow_swing: f64,
    pub(super) trunk_turn: f64,
}

pub(crate) const WALK: Style = Style {
    cycles_hz: 0.93,
    stride: 1.38,
    radius: 2.6,
    stance: 0.62,
    lead: 0.31,
    width: 0.065,
    toe_out: degrees(7.0),
    lift: 0.085,
    pitch: &[
        (0.0, [degrees(-20.0)]),
        (0.10, [0.0]),
        (0.34, [0.0]),
        (0.50, [degrees(24.0)]),
        (0.64, [degrees(68.0)]),
        (0.75, [degrees(42.0)]),
        (0.86, [degrees(-2.0)]),
        (0.95, [degrees(-20.0)]),
    ],
    crouch: 0.030,
    bounce: 0.018,
    lowest: 0.05,
    sway: 0.022,
    pelvis_turn: degrees(5.0),
    pelvis_drop: degrees(4.0),
    pelvis_pitch: degrees(5.0),
    lean: degrees(-2.0),
    arm_swing: degrees(22.0),
    arm_mean: degrees(2.0),
    elbow: degrees(24.0),
    elbow_swing: degrees(12.0),
    trunk_turn: degrees(9.0),
};

pub(crate) const RUN: Style = Style {
    cycles_hz: 1.36,
    stride: 2.25,
    radius: 7.0,
    stance: 0.34,
    lead: 0.30,
    width: 0.03,
    toe_out: degrees(6.0),
    lift: 0.20,
    pitch: &[
        (0.0, [degrees(-8.0)]),
        (0.06, [0.0]),
        (0.15, [0.0]),
        (0.34, [degrees(60.0)]),
        (0.45, [degrees(88.0)]),
        (0.70, [degrees(28.0)]),
        (0.90, [degrees(-6.0)]),
    ],
    crouch: 0.055,
    bounce: 0.036,
    lowest: 0.15,
    sway: 0.012,
    pelvis_turn: degrees(8.0),
    pelvis_drop: degrees(5.0),
    pelvis_pitch: degrees(10.0),
    lean: degrees(4.0),
    arm_swing: degrees(32.0),
    arm_mean: degrees(-10.0),
    elbow: degrees(88.0),
    elbow_swing: degrees(16.0),
    trunk_turn: degrees(16.0),
};

impl Style {
    /// The same gait as people of the CMU database go: brisker, with a longer swing in which the knee
    /// bends more.
    pub(crate) fn of_people(&self) -> Self {
        Self {
            cycles_hz: 1.02 * self.cycles_hz,
            stride: 1.05 * self.stride,
            stance: 0.955 * self.stance,
            lift: 1.5 * self.lift,
            crouch: 0.9 * self.crouch,
            ..*self
        }
    }
}
