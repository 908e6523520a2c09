//! Draws example figures and a page: `cargo run -p mocap-report --example gallery -- DIR`.

use std::{f64::consts::TAU, path::Path};

use mocap_core::{
    Bone, BoneSet, CoreError, Estimates, FillReport, Filled, MarkerSet, Mask, Take, Termination,
};
use mocap_report::{FillSummary, PlotInput, TakeSummary, html_page, plot_take};
use ndarray::Array3;

const RATE_HZ: f64 = 120.0;
const FRAMES: usize = 240;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some(directory) = std::env::args().nth(1) else {
        return Err("usage: gallery DIR".into());
    };
    let directory = Path::new(&directory);
    std::fs::create_dir_all(directory)?;
    let truth = swinging_leg()?;
    let input = truth.hide(&hidden())?;
    let filled = fill_linearly(&input)?;
    let bones = BoneSet::new([Bone::new(0, 1, THIGH_M)?, Bone::new(1, 2, SHANK_M)?])?;

    let fill = PlotInput {
        truth: Some(&truth),
        ..PlotInput::fill("Swinging leg, gaps filled linearly", &filled, &bones)
    };
    let inspect = PlotInput::take("Swinging leg as measured", &input, &bones);
    let gapless = PlotInput::take("Swinging leg without gaps", &truth, &bones);
    for (name, figure) in [("fill", &fill), ("inspect", &inspect), ("gapless", &gapless)] {
        for extension in ["svg", "png"] {
            let path = directory.join(name).with_extension(extension);
            std::fs::write(&path, plot_take(figure, &path)?)?;
        }
    }
    let svg = mocap_report::render_svg(&fill)?;
    let (take, summary) = (TakeSummary::new(&input, 1), FillSummary::new(&filled, 1, 0.004));
    let page = html_page("Swinging leg", &take, Some(&summary), Some(&svg));
    std::fs::write(directory.join("index.html"), page)?;
    Ok(())
}

const THIGH_M: f64 = 0.41;
const SHANK_M: f64 = 0.39;

/// Hip, knee and ankle of a leg that swings as it walks along x.
fn swinging_leg() -> Result<Take, CoreError> {
    let place = |t: usize, joint: usize| {
        let phase = TAU * t as f64 / RATE_HZ;
        let hip = [0.011 * t as f64, 0.1, 0.92 + 0.02 * (2.0 * phase).sin()];
        let thigh = 0.5 * phase.sin();
        let shank = thigh - 0.35 * (1.0 - (phase + 0.8).cos());
        let below = |p: [f64; 3], length: f64, angle: f64| {
            [p[0] + length * angle.sin(), p[1], p[2] - length * angle.cos()]
        };
        let knee = below(hip, THIGH_M, thigh);
        [hip, knee, below(knee, SHANK_M, shank)][joint]
    };
    let xyz = Array3::from_shape_fn((FRAMES, 4, 3), |(t, m, axis)| match m {
        3 => place(t, 0)[axis] + 0.1,
        joint => place(t, joint)[axis],
    });
    Take::from_positions(MarkerSet::new(["RHIP", "RKNE", "RANK", "RASI"])?, RATE_HZ, xyz)
}

fn hidden() -> Mask {
    Mask::from_fn(FRAMES, 4, |t, m| match m {
        1 => (40..95).contains(&t) || (150..160).contains(&t),
        2 => (60..110).contains(&t) || t == 200 || t >= 225,
        3 => (20..26).contains(&t),
        _ => false,
    })
}

/// Straight lines across gaps that have both ends; the others stay open.
fn fill_linearly(input: &Take) -> Result<Filled, CoreError> {
    let mut positions = input.positions().to_owned();
    for gap in input.gaps() {
        let ends = (gap.frames.start.checked_sub(1), gap.frames.end);
        let (Some(before), after) = ends else { continue };
        if after >= FRAMES {
            continue;
        }
        for (t, axis) in gap.frames.flat_map(|t| (0..3).map(move |axis| (t, axis))) {
            let share = (t - before) as f64 / (after - before) as f64;
            let value = |frame| input.positions()[(frame, gap.marker, axis)];
            positions[(t, gap.marker, axis)] =
                value(before) + share * (value(after) - value(before));
        }
    }
    let report = FillReport::new("linear", Termination::ClosedForm);
    Filled::merge(input, Estimates { positions, sigma_m: None }, report)
}
