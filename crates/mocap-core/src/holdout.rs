use crate::{CoreError, Mask, Take};

/// A take with some of its cells hidden, and the truth of those cells.
///
/// A filler is handed [`visible`](Self::visible) alone; a metric reads the rest.
#[derive(Debug, Clone)]
pub struct Holdout {
    visible: Take,
    truth: Take,
    hidden: Mask,
}

impl Holdout {
    /// Hides the cells of `hidden` that `truth` has observed.
    ///
    /// # Errors
    /// [`CoreError::Shape`].
    pub fn new(truth: Take, hidden: &Mask) -> Result<Self, CoreError> {
        let visible = truth.hide(hidden)?;
        let hidden = Mask::from_fn(truth.frames(), truth.marker_count(), |t, m| {
            hidden.contains(t, m) && truth.is_observed(t, m)
        });
        Ok(Self { visible, truth, hidden })
    }

    /// What a filler may see.
    #[must_use]
    pub fn visible(&self) -> &Take {
        &self.visible
    }

    /// The complete take.
    #[must_use]
    pub fn truth(&self) -> &Take {
        &self.truth
    }

    /// The cells that were observed and are hidden, `(T, M)`.
    #[must_use]
    pub fn hidden(&self) -> &Mask {
        &self.hidden
    }
}
