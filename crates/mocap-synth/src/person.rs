use crate::{
    SynthError,
    dice::{Dice, Stream},
    params::check,
};

/// Sex of a drawn person: it sets the means of all measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sex {
    /// Means of women.
    Female,
    /// Means of men.
    Male,
}

/// A body measure of a [`Person`], as anthropometric surveys name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Measure {
    /// From the floor to the crown.
    Stature,
    /// Height of the seventh cervical vertebra.
    Cervicale,
    /// Height of the greater trochanter, close to that of the hip joint.
    Trochanter,
    /// Height of the knee's joint line.
    Tibial,
    /// Height of the outer ankle.
    Malleolus,
    /// From acromion to radiale.
    UpperArm,
    /// From radiale to stylion.
    Forearm,
    /// From wrist crease to tip of the middle finger.
    HandLength,
    /// Across the knuckles.
    HandBreadth,
    /// From heel to longest toe.
    FootLength,
    /// Across the ball of the foot.
    FootBreadth,
    /// From acromion to acromion.
    Biacromial,
    /// Across the hips, standing.
    HipBreadth,
    /// From belly to buttock.
    HipDepth,
    /// Across the waist.
    WaistBreadth,
    /// From navel to back.
    WaistDepth,
    /// Round the waist.
    WaistCircumference,
    /// Across the chest.
    ChestBreadth,
    /// From breast to back.
    ChestDepth,
    /// Round the neck.
    Neck,
    /// Across the head.
    HeadBreadth,
    /// From brow to back of the head.
    HeadLength,
    /// Round the upper arm, flexed.
    Biceps,
    /// Round the forearm, flexed.
    ForearmCircumference,
    /// Round the thigh.
    Thigh,
    /// Round the calf.
    Calf,
}

/// Number of hidden factors that measures share.
const FACTORS: usize = 4;

/// One row of the population.
struct Row {
    measure: Measure,
    /// Means of men and women in millimetres.
    male: f64,
    female: f64,
    /// Standard deviation within a sex over the mean.
    spread: f64,
    /// Correlations with the hidden factors: stature, long limbs, frame, fatness.
    loads: [f64; FACTORS],
}

const fn row(measure: Measure, male: f64, female: f64, spread: f64, loads: [f64; FACTORS]) -> Row {
    Row { measure, male, female, spread, loads }
}

/// Means and spreads are rounded from [Gordon14]. The correlations are those that four independent factors
/// leave, chosen after the pattern that surveys agree on: heights go with stature (0.75 to 0.95), limbs with each
/// other beyond that, breadths of bone with a frame, girths with fatness and little with stature.
#[rustfmt::skip]
const POPULATION: [Row; 26] = [
    row(Measure::Stature,              1756.0, 1629.0, 0.039, [1.00,  0.00, 0.00, 0.00]),
    row(Measure::Cervicale,            1517.0, 1398.0, 0.042, [0.98,  0.05, 0.00, 0.00]),
    row(Measure::Trochanter,            905.0,  838.0, 0.052, [0.88,  0.38, 0.00, 0.00]),
    row(Measure::Tibial,                471.0,  432.0, 0.056, [0.84,  0.40, 0.00, 0.00]),
    row(Measure::Malleolus,              72.7,   63.2, 0.075, [0.45,  0.10, 0.35, 0.00]),
    row(Measure::UpperArm,              335.0,  311.0, 0.052, [0.78,  0.40, 0.05, 0.00]),
    row(Measure::Forearm,               268.0,  241.0, 0.057, [0.70,  0.55, 0.05, 0.00]),
    row(Measure::HandLength,            193.3,  181.0, 0.051, [0.66,  0.40, 0.25, 0.00]),
    row(Measure::HandBreadth,            88.0,   78.6, 0.048, [0.40,  0.05, 0.65, 0.15]),
    row(Measure::FootLength,            271.0,  246.3, 0.049, [0.70,  0.30, 0.30, 0.00]),
    row(Measure::FootBreadth,           102.0,   92.6, 0.052, [0.42,  0.05, 0.55, 0.15]),
    row(Measure::Biacromial,            416.0,  365.0, 0.047, [0.52,  0.00, 0.55, 0.05]),
    row(Measure::HipBreadth,            344.0,  358.0, 0.064, [0.42,  0.00, 0.30, 0.72]),
    row(Measure::HipDepth,              246.0,  232.0, 0.105, [0.20,  0.00, 0.20, 0.88]),
    row(Measure::WaistBreadth,          327.0,  299.0, 0.105, [0.22,  0.00, 0.15, 0.92]),
    row(Measure::WaistDepth,            236.0,  217.0, 0.140, [0.12,  0.00, 0.10, 0.94]),
    row(Measure::WaistCircumference,    941.0,  860.0, 0.118, [0.20,  0.00, 0.12, 0.95]),
    row(Measure::ChestBreadth,          289.0,  271.0, 0.063, [0.30,  0.00, 0.35, 0.70]),
    row(Measure::ChestDepth,            254.0,  247.0, 0.100, [0.15,  0.00, 0.25, 0.82]),
    row(Measure::Neck,                  398.0,  330.0, 0.068, [0.20,  0.00, 0.35, 0.72]),
    row(Measure::HeadBreadth,           154.4,  147.6, 0.036, [0.15,  0.00, 0.30, 0.15]),
    row(Measure::HeadLength,            199.5,  190.0, 0.036, [0.28,  0.05, 0.30, 0.05]),
    row(Measure::Biceps,                358.0,  306.0, 0.096, [0.12,  0.00, 0.38, 0.74]),
    row(Measure::ForearmCircumference,  310.0,  264.0, 0.070, [0.20,  0.00, 0.48, 0.66]),
    row(Measure::Thigh,                 625.0,  616.0, 0.092, [0.24,  0.00, 0.18, 0.82]),
    row(Measure::Calf,                  392.0,  374.0, 0.077, [0.25,  0.00, 0.30, 0.66]),
];

impl Measure {
    /// Every measure.
    pub fn all() -> impl Iterator<Item = Self> {
        POPULATION.iter().map(|row| row.measure)
    }

    /// Mean of men in metres.
    pub(crate) fn mean_m(self) -> f64 {
        1e-3 * POPULATION[self as usize].male
    }
}

/// Measures of one adult, drawn from a population whose measures vary together.
///
/// ```
/// use mocap_synth::{Measure, Person};
/// let person = Person::draw(7);
/// assert_eq!(person, Person::draw(7));
/// assert!((1.4..2.1).contains(&person.stature_m()));
/// assert!(person.metres(Measure::Tibial) < person.metres(Measure::Trochanter));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Person {
    sex: Sex,
    /// In the order of the population's rows, in metres.
    metres: [f64; POPULATION.len()],
}

impl Person {
    /// Draws a woman or a man with equal chance.
    #[must_use]
    pub fn draw(seed: u64) -> Self {
        let mut dice = Dice::new(seed, Stream::Person);
        let sex = if dice.unit() < 0.5 { Sex::Female } else { Sex::Male };
        let stature = dice.normal().clamp(-CUT, CUT);
        Self::of(sex, stature, &mut dice)
    }

    /// Draws a person of this sex and stature: all other measures as they go with these.
    ///
    /// # Errors
    /// [`SynthError::OutOfRange`] outside of 1.2 to 2.2 m.
    ///
    /// # Units
    /// Metres.
    pub fn draw_as(seed: u64, sex: Sex, stature_m: f64) -> Result<Self, SynthError> {
        check("stature_m", stature_m, 1.2, 2.2, "m")?;
        let mut dice = Dice::new(seed, Stream::Person);
        let row = &POPULATION[Measure::Stature as usize];
        let stature = (1e3 * stature_m / row.mean(sex) - 1.0) / row.spread;
        Ok(Self::of(sex, stature, &mut dice))
    }

    fn of(sex: Sex, stature: f64, dice: &mut Dice) -> Self {
        let mut factors = [0.0; FACTORS];
        factors[0] = stature;
        for factor in &mut factors[1..] {
            *factor = dice.normal().clamp(-CUT, CUT);
        }
        let metres = std::array::from_fn(|i| {
            let row = &POPULATION[i];
            let shared: f64 = row.loads.iter().zip(factors).map(|(load, f)| load * f).sum();
            let own = (1.0 - row.loads.iter().map(|load| load * load).sum::<f64>()).max(0.0);
            let z = shared + own.sqrt() * dice.normal().clamp(-CUT, CUT);
            1e-3 * row.mean(sex) * (1.0 + row.spread * z)
        });
        Self { sex, metres }
    }

    /// Sex.
    #[must_use]
    pub fn sex(&self) -> Sex {
        self.sex
    }

    /// Height in metres.
    #[must_use]
    pub fn stature_m(&self) -> f64 {
        self.metres(Measure::Stature)
    }

    /// A measure in metres.
    #[must_use]
    pub fn metres(&self, measure: Measure) -> f64 {
        self.metres[measure as usize]
    }

    /// A measure over that of the average man.
    pub(crate) fn factors(&self) -> impl Fn(Measure) -> f64 + '_ {
        |measure| self.metres(measure) / measure.mean_m()
    }
}

impl Row {
    fn mean(&self, sex: Sex) -> f64 {
        match sex {
            Sex::Female => self.female,
            Sex::Male => self.male,
        }
    }
}

/// No factor is drawn further out, in standard deviations.
const CUT: f64 = 2.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_the_measures() {
        for (i, row) in POPULATION.iter().enumerate() {
            assert_eq!(row.measure as usize, i);
            assert!(
                row.loads.iter().map(|l| l * l).sum::<f64>() <= 1.0 + 1e-12,
                "{:?}",
                row.measure
            );
        }
    }
}
