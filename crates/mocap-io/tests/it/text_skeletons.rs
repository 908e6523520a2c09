//! Skeletons and their motion: BVH, ASF and AMC.

use std::f64::consts::FRAC_PI_2;

use mocap_core::{Joint, Motion, Pose, Rotation, Skeleton};
use mocap_io::{
    LengthUnit, ReadOptions,
    text::{
        TextError,
        amc::{self, Amc},
        asf::{self, Asf, Dof},
        bvh::{self, Bvh, Channel},
    },
};
use proptest::prelude::*;

use crate::text_support::{AMC, ASF, BVH, asf};

type Matrix = [[f64; 3]; 3];

/// Rotation matrix about an axis in degrees, written out by hand.
fn about(axis: char, degrees: f64) -> Matrix {
    let (s, c) = degrees.to_radians().sin_cos();
    match axis {
        'x' => [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]],
        'y' => [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]],
        _ => [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
    }
}

fn product(matrices: &[Matrix]) -> Matrix {
    let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    matrices.iter().fold(one, |a, b| {
        std::array::from_fn(|r| std::array::from_fn(|c| (0..3).map(|k| a[r][k] * b[k][c]).sum()))
    })
}

fn assert_same(found: Rotation, expected: Matrix) {
    for (row, wanted) in found.matrix().into_iter().zip(expected) {
        for (a, b) in row.into_iter().zip(wanted) {
            // A handful of roundings of numbers below 1.
            assert!((a - b).abs() < 1e-14, "{:?} is not {expected:?}", found.matrix());
        }
    }
}

#[test]
fn bvh_applies_channels_in_the_order_of_each_joint() {
    let bvh = Bvh::parse(BVH.into(), &ReadOptions::default()).unwrap();
    let motion = bvh.motion().unwrap();
    let skeleton = motion.skeleton();
    let names: Vec<&str> = skeleton.joints().iter().map(|j| j.name.as_str()).collect();
    assert_eq!(names, ["Hips", "Knee", "Knee_end", "Spine", "Spine_end"]);
    assert_eq!(motion.rate_hz(), 120.0, ".0083333 s are 120 Hz");
    assert_eq!(bvh.frames(), 3);
    assert_eq!(bvh.channels()[1], [Channel::Rotation(0)]);
    assert_eq!(bvh.channels()[2], []);
    let pose = &motion.poses()[1];
    assert_eq!(pose.root_m, [0.015, 0.02, 0.03]);
    assert_same(
        pose.rotations[0],
        product(&[about('z', 11.0), about('x', 21.0), about('y', 31.0)]),
    );
    assert_same(pose.rotations[1], about('x', 46.0));
    assert_same(pose.rotations[3], product(&[about('y', 5.0), about('z', 6.0), about('x', 7.0)]));
    assert_eq!(skeleton.joints()[1].offset_m, [0.0, -0.1, 0.0]);
    assert!(bvh.info().notes.iter().any(|note| note.contains("centimetres are assumed")));
}

#[test]
fn bvh_keeps_its_bytes_and_takes_a_given_unit() {
    let options = ReadOptions { unit: Some(LengthUnit::Metre), ..ReadOptions::default() };
    let bvh = Bvh::parse(BVH.replace('\n', "\r\n").into(), &options).unwrap();
    assert_eq!(bvh.bytes(), BVH.replace('\n', "\r\n").as_bytes());
    assert_eq!(bvh.motion().unwrap().poses()[0].root_m, [1.0, 2.0, 3.0]);
    assert_eq!(bvh.motion_in(0.5).unwrap().poses()[0].root_m, [0.5, 1.0, 1.5]);
}

#[test]
fn bvh_refusals_name_the_place() {
    let parse = |text: String| Bvh::parse(text.into(), &ReadOptions::default());
    let two = BVH.replace("MOTION", "ROOT Other\n{\nOFFSET 0 0 0\n}\nMOTION");
    assert!(parse(two).unwrap_err().to_string().contains("one `ROOT`"));
    let error = parse(BVH.replace("CHANNELS 1 Xrotation", "CHANNELS 2 Xrotation")).unwrap_err();
    assert_eq!(error, TextError::Count { line: 8, what: "channels", declared: 2, found: 1 });
    let error = parse(BVH.replace("10 20 30", "10 twenty 30")).unwrap_err();
    assert!(matches!(error, TextError::Field { line: 27, field: 5, .. }), "{error}");
    assert!(parse(BVH.replace("\t\tOFFSET 0 -10 0\n", "")).is_err(), "an offset is needed");
    assert!(parse(BVH.replace(".0083333", "0")).is_err());
}

fn motion_strategy() -> impl Strategy<Value = Motion> {
    let rotation = (prop::array::uniform3(-1.0..1.0_f64), -3.0..3.0_f64)
        .prop_map(|(axis, angle)| Rotation::about(axis, angle));
    let poles = (0..4_usize).prop_map(|i| {
        let y = if i < 2 { FRAC_PI_2 } else { -FRAC_PI_2 };
        Rotation::about([0.0, 1.0, 0.0], y).after(Rotation::about([1.0, 0.0, 0.0], i as f64))
    });
    let pose = (
        prop::array::uniform3(-5.0..5.0_f64),
        prop::collection::vec(prop_oneof![rotation, poles], 4),
    );
    prop::collection::vec(pose, 0..5).prop_map(|poses| {
        let joint = |name: &str, parent, offset_m| Joint { name: name.into(), parent, offset_m };
        // The child of the root that comes last in the list is not the last of its branch.
        let skeleton = Skeleton::new(vec![
            joint("root", None, [0.1, 0.9, 0.0]),
            joint("left", Some(0), [0.3, 0.0, 0.1]),
            joint("right", Some(0), [-0.3, 0.0, 0.1]),
            joint("left hand", Some(1), [0.4, -0.2, 0.0]),
            joint("left hand_end", Some(3), [0.1, 0.0, 0.0]),
        ]);
        let poses = poses.into_iter().map(|(root_m, mut rotations)| {
            rotations.push(Rotation::IDENTITY);
            Pose { root_m, rotations }
        });
        Motion::new(skeleton.unwrap(), 120.0, poses.collect()).unwrap()
    })
}

/// Largest distance of a joint from the same joint of another motion, by name, in metres.
fn apart(a: &Motion, b: &Motion, name: impl Fn(&str) -> String) -> f64 {
    let pairs: Vec<(usize, usize)> = a
        .skeleton()
        .joints()
        .iter()
        .enumerate()
        .map(|(i, joint)| (i, b.skeleton().find(&name(&joint.name)).unwrap()))
        .collect();
    let mut worst = 0.0_f64;
    assert_eq!(a.poses().len(), b.poses().len());
    for (p, q) in a.poses().iter().zip(b.poses()) {
        let (here, there) =
            (a.skeleton().positions(p).unwrap(), b.skeleton().positions(q).unwrap());
        for &(i, j) in &pairs {
            worst = worst.max(mocap_core::geometry::distance(here[i], there[j]));
        }
    }
    worst
}

fn through_acclaim(motion: &Motion) -> Motion {
    let options = ReadOptions::default();
    let skeleton = Asf::parse(asf::encode(motion.skeleton()), &options).unwrap();
    Amc::parse(amc::encode(motion), &skeleton, &options).unwrap().motion().clone()
}

#[test]
fn acclaim_names_survive_what_the_format_means_by_words() {
    let joint =
        |name: &str, parent, x| Joint { name: name.into(), parent, offset_m: [x, 0.0, 0.0] };
    let skeleton = Skeleton::new(vec![
        joint("Hips", None, 0.0),
        joint("root", Some(0), 0.0),
        joint("3rd rib", Some(0), 0.2),
        joint("#1", Some(0), 0.3),
        joint("Hips_end", Some(0), 0.4),
    ]);
    let skeleton = skeleton.unwrap();
    let rest = Pose::rest(&skeleton);
    let read = through_acclaim(&Motion::new(skeleton, 120.0, vec![rest]).unwrap());
    let place = |name: &str| {
        let at = read.skeleton().positions(&read.poses()[0]).unwrap();
        at[read.skeleton().find(name).unwrap()][0]
    };
    for (name, x) in
        [("root", 0.0), ("root_2", 0.0), ("_3rd_rib", 0.2), ("_#1", 0.3), ("Hips_end", 0.4)]
    {
        assert!((place(name) - x).abs() < 1e-9, "{name}");
    }
}

proptest! {
    #[test]
    fn a_written_acclaim_pair_moves_the_same(motion in motion_strategy()) {
        prop_assume!(!motion.poses().is_empty());
        let read = through_acclaim(&motion);
        // As for BVH below.
        prop_assert!(apart(&motion, &read, |name| name.replace(' ', "_")) < 1e-7);
        // What the first writing added is enough for ever.
        let again = through_acclaim(&read);
        prop_assert!(apart(&read, &again, str::to_owned) < 1e-7);
        prop_assert_eq!(read.skeleton().joints().len(), again.skeleton().joints().len());
    }
}

proptest! {
    #[test]
    fn a_written_bvh_moves_the_same(motion in motion_strategy()) {
        for unit in [LengthUnit::Centimetre, LengthUnit::Metre] {
            let options = ReadOptions { unit: Some(unit), ..ReadOptions::default() };
            let read = Bvh::parse(bvh::encode(&motion, unit), &options).unwrap().motion().unwrap();
            prop_assert_eq!(read.rate_hz(), 120.0);
            prop_assert_eq!(read.poses().len(), motion.poses().len());
            for (before, after) in motion.poses().iter().zip(read.poses()) {
                let wanted = motion.skeleton().positions(before).unwrap();
                let found = read.skeleton().positions(after).unwrap();
                for (joint, place) in motion.skeleton().joints().iter().zip(wanted) {
                    let name = joint.name.replace(' ', "_");
                    let place_found = found[read.skeleton().find(&name).unwrap()];
                    let off = mocap_core::geometry::distance(place, place_found);
                    // Half of the sixth decimal of a degree in three angles of three joints, at 1 m.
                    prop_assert!(off < 1e-7, "{}: {off:e} m", joint.name);
                }
            }
        }
    }
}

#[test]
fn asf_places_each_bone_at_the_end_of_its_parent() {
    let asf = asf();
    let metres = 0.0254 / 0.45;
    let joints: Vec<(&str, Option<usize>, f64)> = asf
        .skeleton()
        .joints()
        .iter()
        .map(|j| (j.name.as_str(), j.parent, j.offset_m[1] / metres))
        .collect();
    let expected = [
        ("root", None, 0.0),
        ("hip", Some(0), 0.0),
        ("femur", Some(1), -2.0),
        ("tibia", Some(2), -7.0),
        ("tibia_end", Some(3), -8.0),
    ];
    for (found, wanted) in joints.iter().zip(expected) {
        assert_eq!((found.0, found.1), (wanted.0, wanted.1));
        // Two roundings of a number below ten.
        assert!((found.2 - wanted.2).abs() < 1e-14, "{found:?}");
    }
    let dofs: Vec<usize> = asf.bones().map(|(_, dofs)| dofs.len()).collect();
    assert_eq!(dofs, [6, 0, 3, 1]);
    assert_eq!(asf.bones().nth(3).unwrap().1, [Dof::Rotation(0)]);
    assert_eq!(asf.bytes(), ASF.as_bytes());
    let metric = ReadOptions { unit: Some(LengthUnit::Metre), ..ReadOptions::default() };
    let scaled = Asf::parse(ASF.replace("0.45", "1.0").into(), &metric).unwrap();
    assert_eq!(scaled.skeleton().joints()[2].offset_m, [0.0, -2.0, 0.0]);
}

#[test]
fn amc_turns_bones_about_their_own_axes() {
    let amc = Amc::parse(AMC.into(), &asf(), &ReadOptions::default()).unwrap();
    let motion = amc.motion();
    assert_eq!((motion.poses().len(), motion.rate_hz()), (3, 120.0));
    assert!(!amc.info().rate_declared);
    let pose = &motion.poses()[1];
    // One rounding of a number below 1.
    assert!((pose.root_m[0] - 1.5 * 0.0254 / 0.45).abs() < 1e-16);
    assert_same(pose.rotations[0], product(&[about('z', 6.0), about('y', 5.0), about('x', 4.0)]));
    let (c, back) = (about('z', 20.0), about('z', -20.0));
    let femur = [c, about('z', 31.0), about('y', 21.0), about('x', 11.0), back];
    assert_same(pose.rotations[2], product(&femur));
    assert_same(pose.rotations[3], product(&[c, about('x', 41.0), back]));
    let radians = AMC.replace(":DEGREES", ":RADIANS");
    let amc = Amc::parse(radians.into(), &asf(), &ReadOptions::default()).unwrap();
    let femur = [c, about('x', 41_f64.to_degrees()), back];
    assert_same(amc.motion().poses()[1].rotations[3], product(&femur));
}

#[test]
fn amc_may_leave_bones_at_rest_in_every_frame() {
    let stiff: String =
        AMC.split_inclusive('\n').filter(|line| !line.starts_with("tibia")).collect();
    let rate = ReadOptions { rate_hz: Some(60.0), ..ReadOptions::default() };
    let amc = Amc::parse(stiff.into(), &asf(), &rate).unwrap();
    assert_eq!(amc.motion().poses()[0].rotations[3], Rotation::IDENTITY);
    assert_eq!(amc.info().notes, ["bones that the file does not move: tibia"]);
    assert_eq!(amc.motion().rate_hz(), 60.0);
}

#[test]
fn asf_refusals_name_the_place() {
    let parse = |text: String| Asf::parse(text.into(), &ReadOptions::default());
    let ring = ASF.replace("root hip\n", "root tibia\n    tibia hip\n");
    assert!(matches!(parse(ring).unwrap_err(), TextError::Bone { rule: "has two parents", .. }));
    let loose = ASF.replace("    femur tibia\n", "");
    let error = parse(loose).unwrap_err();
    assert!(matches!(&error, TextError::Bone { bone, .. } if bone == "tibia"), "{error}");
    assert!(parse(ASF.replace("length 0.45", "length 0")).is_err());
    assert!(parse(ASF.replace("dof rx ry rz", "dof rx rw rz")).is_err());
    assert!(parse(ASF.replace("name tibia", "name femur")).is_err());
    assert!(parse(ASF.replace("0 0 20  XYZ", "0 0 20  XQZ")).is_err());
}
