//! The AMC file and the C3D file of one trial, in one frame of reference.

use mocap_core::geometry::distance;
use mocap_io::{
    ReadOptions,
    c3d::{C3d, C3dOptions},
    text::{amc::Amc, asf::Asf},
};

use crate::text_real::{bytes, data};

/// Every n-th frame is compared.
const STEP: usize = 20;

#[test]
fn acclaim_joints_lie_at_the_joint_centres_of_the_c3d_file() {
    let Some(folder) = data("cmu/paired") else { return };
    let options = ReadOptions::default();
    let asf = Asf::parse(bytes(&folder.join("05.asf")), &options).unwrap();
    let amc = Amc::parse(bytes(&folder.join("05_13.amc")), &asf, &options).unwrap();
    let c3d = C3d::parse(bytes(&folder.join("05_13.c3d")), &C3dOptions::default()).unwrap();
    assert_eq!(c3d.frames(), amc.motion().poses().len());
    assert_eq!(c3d.units().as_deref(), Some("mm"));
    let points = c3d.decode_points();
    let poses = amc.motion().poses().iter().enumerate().step_by(STEP);
    let places: Vec<(usize, Vec<[f64; 3]>)> =
        poses.map(|(t, pose)| (t, asf.skeleton().positions(pose).unwrap())).collect();
    let mut matched = 0;
    for (joint, description) in asf.skeleton().joints().iter().enumerate() {
        let median = |point: usize| {
            let mut off: Vec<f64> = places
                .iter()
                .map(|(t, at)| {
                    let [x, y, z] = at[joint].map(|c| c * 1e3);
                    let seen = points.position(*t, point);
                    seen.map_or(f64::INFINITY, |p| distance([z, x, y], p))
                })
                .collect();
            off.sort_by(f64::total_cmp);
            off[off.len() / 2]
        };
        let (off, point) = (0..c3d.points().len())
            .map(|point| (median(point), point))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap();
        println!("{}: {off:.3} mm from {}", description.name, c3d.points()[point].label);
        // The file holds whole tenths of a millimetre.
        matched += usize::from(off < 0.2);
    }
    println!("{matched} joints");
    assert_eq!(matched, 34, "all but the two feet's toes and their ends");
}
