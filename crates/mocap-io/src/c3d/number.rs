//! The three number formats of C3D files.

/// The processor whose number formats a file uses.
///
/// Implements [C3D] "Processor type".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Processor {
    /// Little-endian integers and IEEE floats (Intel).
    Intel,
    /// Little-endian integers and VAX F floats (DEC).
    Dec,
    /// Big-endian integers and IEEE floats (SGI, MIPS).
    Sgi,
}

const VAX_EXPONENT_BIAS: u32 = 2 << 23;

impl Processor {
    /// The processor named by a byte of the parameter section, or `None` for an unknown one.
    #[must_use]
    pub fn from_byte(byte: u8) -> Option<Self> {
        match byte {
            84 => Some(Self::Intel),
            85 => Some(Self::Dec),
            86 => Some(Self::Sgi),
            _ => None,
        }
    }

    /// The byte that names this processor.
    #[must_use]
    pub fn byte(self) -> u8 {
        match self {
            Self::Intel => 84,
            Self::Dec => 85,
            Self::Sgi => 86,
        }
    }

    pub(crate) fn u16(self, bytes: [u8; 2]) -> u16 {
        match self {
            Self::Intel | Self::Dec => u16::from_le_bytes(bytes),
            Self::Sgi => u16::from_be_bytes(bytes),
        }
    }

    pub(crate) fn f32(self, bytes: [u8; 4]) -> f32 {
        match self {
            Self::Intel => f32::from_le_bytes(bytes),
            Self::Dec => vax_f32(bytes),
            Self::Sgi => f32::from_be_bytes(bytes),
        }
    }

    pub(crate) fn u16_bytes(self, value: u16) -> [u8; 2] {
        match self {
            Self::Intel | Self::Dec => value.to_le_bytes(),
            Self::Sgi => value.to_be_bytes(),
        }
    }

    pub(crate) fn i16_bytes(self, value: i16) -> [u8; 2] {
        self.u16_bytes(value.cast_unsigned())
    }

    /// The bytes of a finite value not beyond [`Processor::largest_real`].
    pub(crate) fn f32_bytes(self, value: f32) -> [u8; 4] {
        match self {
            Self::Intel => value.to_le_bytes(),
            Self::Dec => vax_f32_bytes(value),
            Self::Sgi => value.to_be_bytes(),
        }
    }

    /// The largest magnitude that real storage holds.
    pub(crate) fn largest_real(self) -> f64 {
        match self {
            Self::Intel | Self::Sgi => f64::from(f32::MAX),
            Self::Dec => f64::from(f32::MAX) / 2.0,
        }
    }

    /// The word at `at`, or 0 past the end.
    pub(crate) fn u16_at(self, bytes: &[u8], at: usize) -> u16 {
        bytes.get(at..).and_then(<[u8]>::first_chunk).map_or(0, |word| self.u16(*word))
    }

    /// The float at `at`, or 0 past the end.
    pub(crate) fn f32_at(self, bytes: &[u8], at: usize) -> f32 {
        bytes.get(at..).and_then(<[u8]>::first_chunk).map_or(0.0, |word| self.f32(*word))
    }
}

/// A VAX F float: halves swapped, exponent biased by two more than IEEE's, no infinities.
///
/// The reserved operand (sign set, exponent zero) decodes to NaN.
#[inline]
pub(crate) fn vax_f32(bytes: [u8; 4]) -> f32 {
    let bits = u32::from_le_bytes(bytes).rotate_left(16);
    let exponent = (bits >> 23) & 0xff;
    let negative = bits >> 31 != 0;
    let normal = f32::from_bits(bits.wrapping_sub(VAX_EXPONENT_BIAS));
    let tiny = f32::from_bits(bits) * 0.25;
    if exponent > 2 {
        normal
    } else if exponent > 0 {
        tiny
    } else if negative {
        f32::NAN
    } else {
        0.0
    }
}

fn vax_f32_bytes(value: f32) -> [u8; 4] {
    let bits = value.to_bits();
    let exponent = (bits >> 23) & 0xff;
    let vax = if exponent > 0 {
        bits.wrapping_add(VAX_EXPONENT_BIAS)
    } else {
        let raised = (value * 4.0).to_bits();
        // A value below VAX F's smallest is zero there: a clear exponent with a mantissa would not be.
        if (value * 4.0).is_normal() { raised } else { 0 }
    };
    vax.rotate_left(16).to_le_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vax_floats_decode_to_their_known_values() {
        // 1.0 is 0x4080 then 0x0000 on a VAX, little-endian halves.
        assert_eq!(vax_f32([0x80, 0x40, 0, 0]).to_bits(), 1.0_f32.to_bits());
        assert_eq!(vax_f32([0x80, 0xc0, 0, 0]).to_bits(), (-1.0_f32).to_bits());
        assert_eq!(vax_f32([0, 0, 0, 0]).to_bits(), 0);
        assert!(vax_f32([0, 0x80, 0, 0]).is_nan());
    }

    #[test]
    fn vax_floats_round_trip_over_their_whole_range() {
        for exponent in 1..=253_u32 {
            for bits in [
                exponent << 23,
                (exponent << 23) | 0x007f_ffff,
                0x8000_0000 | (exponent << 23) | 0x0012_3456,
            ] {
                assert_eq!(vax_f32(vax_f32_bytes(f32::from_bits(bits))).to_bits(), bits);
            }
        }
    }
}
