use mocap_core::Rotation;

/// Rotation about the x, y or z axis.
pub(super) fn turn(axis: usize, radians: f64) -> Rotation {
    let mut direction = [0.0; 3];
    direction[axis] = 1.0;
    Rotation::about(direction, radians)
}

/// Applies turns one after the other about fixed axes, the first of the list first.
pub(super) fn first_to_last(turns: impl IntoIterator<Item = (usize, f64)>) -> Rotation {
    turns.into_iter().fold(Rotation::IDENTITY, |done, (axis, angle)| turn(axis, angle).after(done))
}

/// Angles `[z, y, x]` in radians with `R = Rz · Ry · Rx`.
pub(super) fn zyx(rotation: Rotation) -> [f64; 3] {
    // Within this of ±90°, z and x turn about one line, and x is set to zero.
    const POLE: f64 = 1e-9;
    let m = rotation.matrix();
    let cos_y = m[0][0].hypot(m[1][0]);
    let y = (-m[2][0]).atan2(cos_y);
    if cos_y < POLE {
        return [(-m[0][1]).atan2(m[1][1]), y, 0.0];
    }
    [m[1][0].atan2(m[0][0]), y, m[2][1].atan2(m[2][2])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zyx_angles_give_the_rotation_back_also_at_the_pole() {
        let quarter = std::f64::consts::FRAC_PI_2;
        for angles in [[0.3, -1.1, 2.9], [0.4, quarter, 0.0], [-2.0, -quarter, 0.7], [0.0; 3]] {
            let [z, y, x] = angles;
            let before = first_to_last([(0, x), (1, y), (2, z)]);
            let [z, y, x] = zyx(before);
            let after = first_to_last([(0, x), (1, y), (2, z)]);
            for (row, expected) in after.matrix().into_iter().zip(before.matrix()) {
                for (a, b) in row.into_iter().zip(expected) {
                    // Where x is dropped at the pole, its matrix elements are of the pole's width.
                    assert!((a - b).abs() < 1e-8, "{angles:?}");
                }
            }
        }
    }
}
