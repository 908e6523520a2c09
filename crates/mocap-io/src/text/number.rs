use super::TextError;
use super::lines::shorten;
use crate::LengthUnit;

/// What a field of a coordinate says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Value {
    /// A finite number.
    Number(f64),
    /// Nothing.
    Blank,
    /// A word for "no number", or an infinity.
    NotANumber,
}

/// Words besides Rust's own `nan` and `inf` that files write for a missing number.
const NO_NUMBER: [&str; 8] =
    ["null", "n/a", "na", "#n/a", "1.#qnan", "1.#ind", "1.#inf", "nan(ind)"];

/// Reads a field; `None` if it is neither a number nor a way to say that there is none.
pub(super) fn parse(field: &[u8]) -> Option<Value> {
    let mut text = field.trim_ascii();
    if let [b'"', inner @ .., b'"'] = text {
        text = inner.trim_ascii();
    }
    if text.is_empty() {
        return Some(Value::Blank);
    }
    let text = std::str::from_utf8(text).ok()?;
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Some(Value::Number(number)),
        Ok(_) => Some(Value::NotANumber),
        Err(_) => {
            let word = text.trim_start_matches(['-', '+']).to_lowercase();
            NO_NUMBER.contains(&word.as_str()).then_some(Value::NotANumber)
        }
    }
}

/// Reads a field that has to be a finite number.
pub(super) fn finite(text: &[u8], line: usize, field: usize) -> Result<f64, TextError> {
    if let Some(Value::Number(number)) = parse(text) {
        return Ok(number);
    }
    Err(TextError::Field { line, field, text: shorten(text), rule: "is not a finite number" })
}

/// Reads a field that has to be a whole number.
pub(super) fn whole(text: &[u8], line: usize, field: usize) -> Result<i64, TextError> {
    // Some programs write frame numbers with a fraction of zero: `12.000`.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let rule = "is not a whole number";
    let error = || TextError::Field { line, field, text: shorten(text), rule };
    match parse(text) {
        #[expect(clippy::cast_possible_truncation, reason = "whole and below 2^53")]
        Some(Value::Number(n)) if n.fract() == 0.0 && n.abs() < EXACT => Ok(n as i64),
        _ => Err(error()),
    }
}

/// Reads a field that has to be a number of things.
pub(super) fn count(text: &[u8], line: usize, field: usize) -> Result<usize, TextError> {
    let rule = "is not a number of things";
    usize::try_from(whole(text, line, field)?).map_err(|_| TextError::Field {
        line,
        field,
        text: shorten(text),
        rule,
    })
}

/// Decimals that resolve 10⁻⁶ mm or better.
fn decimals(unit: LengthUnit) -> usize {
    match unit {
        LengthUnit::Millimetre => 6,
        LengthUnit::Centimetre => 7,
        LengthUnit::Decimetre | LengthUnit::Inch => 8,
        LengthUnit::Metre | LengthUnit::Foot => 9,
    }
}

/// A position in metres as text in a unit; `None` if a coordinate is too large for it.
///
/// The origin is written as the smallest number that is not zero, because many readers take three
/// zeros for a missing sample.
pub(super) fn position(metres: [f64; 3], unit: LengthUnit) -> Option<[String; 3]> {
    let digits = decimals(unit);
    let values = metres.map(|m| m * unit.per_metre());
    if values.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let mut texts = values.map(|v| format!("{v:.digits$}"));
    let is_zero = |text: &String| text.bytes().all(|b| matches!(b, b'0' | b'.' | b'-'));
    if texts.iter().all(is_zero) {
        texts[0] = format!("{:.digits$}", 0.1_f64.powi(i32::try_from(digits).unwrap_or(6)));
    }
    Some(texts)
}

/// The roundest number within a relative tolerance: rates come as cut-off decimals.
pub(super) fn roundest(value: f64, tolerance: f64) -> f64 {
    (0..=9)
        .filter_map(|digits| format!("{value:.digits$}").parse::<f64>().ok())
        .find(|round| (round - value).abs() <= tolerance.max(1e-9) * value.abs())
        .unwrap_or(value)
}

/// Half a unit in the last decimal of a number's text.
pub(super) fn half_digit(text: &str) -> f64 {
    let mantissa = text.trim().split(['e', 'E']).next().unwrap_or_default();
    let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len()).min(300);
    0.5 * 0.1_f64.powi(i32::try_from(decimals).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_of_nothing() {
        for text in ["NaN", "nan", "-nan", "NAN", " Nan ", "1.#QNAN", "-1.#IND", "inf", "NULL"] {
            assert_eq!(parse(text.as_bytes()), Some(Value::NotANumber), "{text}");
        }
        for text in ["", "  ", "\"\"", "\" \""] {
            assert_eq!(parse(text.as_bytes()), Some(Value::Blank), "{text}");
        }
        for text in ["1,5", "abc", "1 2", "--1", "\u{fffd}"] {
            assert_eq!(parse(text.as_bytes()), None, "{text}");
        }
        assert_eq!(parse(b" -1.5E+00 "), Some(Value::Number(-1.5)));
        assert_eq!(parse(b"\"2\""), Some(Value::Number(2.0)));
    }

    #[test]
    fn rates_are_rounded_within_their_digits_only() {
        let step = "0.0083333";
        let value: f64 = step.parse().unwrap();
        let tolerance = half_digit(step) / value;
        assert_eq!(roundest(1.0 / value, tolerance).to_bits(), 120.0_f64.to_bits());
        assert_eq!(roundest(59.94, 1e-9).to_bits(), 59.94_f64.to_bits());
        assert_eq!(roundest(119.880_12, 1e-9).to_bits(), 119.880_12_f64.to_bits());
    }

    #[test]
    fn the_origin_never_becomes_three_zeros() {
        let [x, y, z] = position([0.0, -0.0, 1e-12], LengthUnit::Millimetre).unwrap();
        assert_eq!((x.as_str(), y.as_str(), z.as_str()), ("0.000001", "-0.000000", "0.000000"));
        let metres = position([0.0; 3], LengthUnit::Metre).unwrap();
        assert_eq!(metres[0], "0.000000001");
        assert_eq!(position([f64::MAX, 0.0, 0.0], LengthUnit::Millimetre), None);
    }
}
