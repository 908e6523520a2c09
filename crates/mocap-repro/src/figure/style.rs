use mocap_report::{
    ReportError,
    draw::{Backend, Canvas, Point, colour::RGBColor},
};

/// Colour and shape of a method, the same in every figure of a report.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Style {
    pub colour: RGBColor,
    pub shape: Shape,
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape {
    Circle,
    Square,
    Diamond,
    Triangle,
}

/// Colours that people with any colour vision tell apart, after Okabe and Ito; their yellow is lost on
/// white and left out.
pub(crate) mod colours {
    use super::RGBColor;

    pub(crate) const BLUE: RGBColor = RGBColor(0, 114, 178);
    pub(crate) const ORANGE: RGBColor = RGBColor(230, 159, 0);
    pub(crate) const GREEN: RGBColor = RGBColor(0, 158, 115);
    pub(crate) const PURPLE: RGBColor = RGBColor(204, 121, 167);
    pub(crate) const SKY: RGBColor = RGBColor(86, 180, 233);
    pub(crate) const VERMILION: RGBColor = RGBColor(213, 94, 0);
    pub(crate) const BLACK: RGBColor = RGBColor(34, 34, 34);
    pub(crate) const GREY: RGBColor = RGBColor(150, 150, 150);
}

const COLOURS: [RGBColor; 8] = [
    colours::GREY,
    colours::SKY,
    colours::ORANGE,
    colours::GREEN,
    colours::BLUE,
    colours::VERMILION,
    colours::PURPLE,
    colours::BLACK,
];
const SHAPES: [Shape; 4] = [Shape::Circle, Shape::Square, Shape::Diamond, Shape::Triangle];
const WHITE: RGBColor = RGBColor(255, 255, 255);

impl Style {
    /// The style of the method with this place in the list of methods; 32 differ.
    pub(crate) fn of(place: usize) -> Self {
        let round = place / COLOURS.len();
        Self {
            colour: COLOURS[place % COLOURS.len()],
            shape: SHAPES[(place + round) % SHAPES.len()],
        }
    }

    /// The shape with a white rim, so that shapes on top of each other can be told apart.
    pub(crate) fn draw<DB: Backend>(
        self,
        canvas: &mut Canvas<'_, DB>,
        at: Point,
        radius: f64,
    ) -> Result<(), ReportError> {
        self.shape.draw(canvas, at, radius + 1.25, WHITE)?;
        self.shape.draw(canvas, at, radius, self.colour)
    }

    /// Takes the inside out of a shape that was drawn.
    pub(crate) fn hollow<DB: Backend>(
        self,
        canvas: &mut Canvas<'_, DB>,
        at: Point,
        radius: f64,
    ) -> Result<(), ReportError> {
        self.shape.draw(canvas, at, 0.5 * radius, WHITE)
    }
}

impl Shape {
    pub(crate) fn draw<DB: Backend>(
        self,
        canvas: &mut Canvas<'_, DB>,
        (x, y): Point,
        radius: f64,
        colour: RGBColor,
    ) -> Result<(), ReportError> {
        match self {
            Self::Circle => canvas.dot((x, y), radius, colour),
            Self::Square => {
                let half = 0.88 * radius;
                canvas.bar((x - half, y - half), (x + half, y + half), colour)
            }
            Self::Diamond => {
                let half = 1.3 * radius;
                let corners = [(x - half, y), (x, y - half), (x + half, y), (x, y + half)];
                canvas.polygon(&corners, colour)
            }
            Self::Triangle => {
                let (half, up, down) = (1.15 * radius, 1.2 * radius, 0.85 * radius);
                canvas.polygon(&[(x - half, y + down), (x, y - up), (x + half, y + down)], colour)
            }
        }
    }
}
