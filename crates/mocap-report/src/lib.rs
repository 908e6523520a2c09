#![doc = include_str!("../README.md")]

pub mod draw;
mod error;
mod figure;
mod html;
mod summary;
mod table;

pub use error::ReportError;

/// The font of the figures: a subset of `DejaVu` Sans with Latin, Greek and Cyrillic letters.
static FONT: &[u8] = include_bytes!("../fonts/DejaVuSans-subset.ttf");

pub use figure::{
    FigureFormat, MAX_FIGURE_MARKERS, MAX_SPOTS, MotionPlot, PlotInput, Spot, animate_motion,
    plot_motion, plot_spots, plot_take, render_png, render_svg,
};
pub use html::{html_page, web_page};
pub use summary::{
    BrokenBones, FillSummary, GapFill, GapSummary, MarkerSummary, Share, TakeSummary,
};
pub use table::{Entry, Table, escape};
