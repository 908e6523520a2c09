//! Standard output that survives a reader who has seen enough.

use std::{fmt, io, io::Write, process};

/// Prints a line to standard output; ends the program quietly once nobody reads it (`mocap … | head`).
macro_rules! say {
    ($($words:tt)*) => { $crate::say::line(format_args!($($words)*)) };
}
pub(crate) use say;

/// The line behind `say!`.
pub(crate) fn line(words: fmt::Arguments<'_>) {
    let written = writeln!(io::stdout().lock(), "{words}");
    if let Err(error) = written {
        let nobody_reads = error.kind() == io::ErrorKind::BrokenPipe;
        process::exit(i32::from(!nobody_reads));
    }
}
