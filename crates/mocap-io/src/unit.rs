/// A unit of length, as files declare it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metre.
    Metre,
    /// Decimetre.
    Decimetre,
    /// Centimetre.
    Centimetre,
    /// Millimetre.
    Millimetre,
    /// Inch, 25.4 mm.
    Inch,
    /// Foot, 304.8 mm.
    Foot,
}

impl LengthUnit {
    /// Reads the spellings that files use: `mm`, `m`, `meters`, `mete`, `Centimeters`, …
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0').to_lowercase();
        Some(match text.as_str() {
            "m" | "mete" | "meter" | "meters" | "metre" | "metres" => Self::Metre,
            "dm" | "decimeters" | "decimetres" => Self::Decimetre,
            "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => Self::Centimetre,
            "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => Self::Millimetre,
            "in" | "inch" | "inches" => Self::Inch,
            "ft" | "foot" | "feet" => Self::Foot,
            _ => return None,
        })
    }

    /// Metres in one unit.
    #[must_use]
    pub fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Decimetre => 0.1,
            Self::Centimetre => 0.01,
            Self::Millimetre => 0.001,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
        }
    }

    /// Units in one metre; exact for the decimal units, where dividing by [`metres`](Self::metres) is not.
    #[must_use]
    pub fn per_metre(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Decimetre => 10.0,
            Self::Centimetre => 100.0,
            Self::Millimetre => 1000.0,
            Self::Inch => 1.0 / 0.0254,
            Self::Foot => 1.0 / 0.3048,
        }
    }

    /// The usual abbreviation.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Decimetre => "dm",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }
}
