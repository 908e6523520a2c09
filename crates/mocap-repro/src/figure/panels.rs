use mocap_report::{
    ReportError,
    draw::{Backend, Canvas},
};

use super::{Chart, Key, MARGIN, Still, WIDTH};

/// Charts and stills side by side, row by row.
#[derive(Debug)]
pub(crate) struct Panels {
    pub columns: usize,
    /// Height of a row in page units.
    pub row_height: f64,
    pub cells: Vec<Panel>,
    pub legend: Vec<Key>,
}

#[derive(Debug)]
pub(crate) enum Panel {
    Chart(Box<Chart>),
    Still(Still),
}

/// Where a panel lies on the page.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

/// Room for the heading of a panel.
pub(super) const HEADING: f64 = 22.0;

impl Panels {
    pub(super) fn height(&self) -> f64 {
        self.row_height * self.cells.len().div_ceil(self.columns.max(1)) as f64
    }

    pub(super) fn draw<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        top: f64,
    ) -> Result<(), ReportError> {
        let columns = self.columns.max(1);
        let width = (WIDTH - 2.0 * MARGIN) / columns as f64;
        for (i, panel) in self.cells.iter().enumerate() {
            let place = Place {
                left: MARGIN + (i % columns) as f64 * width,
                top: top + (i / columns) as f64 * self.row_height,
                width,
                height: self.row_height,
            };
            match panel {
                Panel::Chart(chart) => chart.draw(canvas, place)?,
                Panel::Still(still) => still.draw(canvas, place)?,
            }
        }
        Ok(())
    }
}
