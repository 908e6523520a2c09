//! Motion generators: pure functions from time to posture, drawn once per take.

mod corners;
mod footwork;
mod gait;
mod jump;
mod kick;
mod manner;
mod reach;
mod script;
mod steps;
mod style;
mod throw;
mod track;
mod turn;

use crate::{Activity, body::Body, dice::Dice, rig::Posture};

/// A motion that can be asked for any moment of the take.
pub(crate) trait Choreography: Send + Sync {
    /// The posture at a time.
    ///
    /// # Units
    /// Seconds from the first frame; a little before it, too.
    fn posture(&self, body: &Body, time: f64) -> Posture;
}

/// Time before the first frame that every motion is defined for, in seconds.
pub(crate) const LEAD_S: f64 = 1.0;

pub(crate) fn choreography(
    activity: Activity,
    body: &Body,
    seconds: f64,
    dice: &mut Dice,
) -> Box<dyn Choreography> {
    // A body with a skin is a person.
    let people = |style: &style::Style| if body.surface { style.of_people() } else { *style };
    match activity {
        Activity::Walk => Box::new(gait::Gait::new(people(&style::WALK), body, seconds, dice)),
        Activity::Run => Box::new(gait::Gait::new(people(&style::RUN), body, seconds, dice)),
        Activity::Jump => {
            let way = if body.surface { jump::Way::of_person(dice) } else { jump::TEMPLATE };
            Box::new(jump::Jump::new(&way, body, seconds, dice))
        }
        Activity::Corner => {
            Box::new(gait::Gait::with_corners(people(&style::WALK), body, seconds, dice))
        }
        Activity::Leap => {
            let way = jump::Way::far(dice);
            Box::new(jump::Jump::new(&way, body, seconds, dice))
        }
        Activity::Throw => Box::new(throw::Throw::new(body, seconds, dice)),
        Activity::Turn => Box::new(turn::Turn::new(body, seconds, dice)),
        Activity::Reach => Box::new(reach::Reach::new(body, seconds, dice)),
        Activity::Kick => Box::new(kick::Kick::new(body, seconds, dice)),
    }
}
