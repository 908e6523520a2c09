//! Table 1 of [Li10], with a measured case behind each mark.

use mocap_report::Entry;

use super::set;
use crate::{Coordinates, Finished, Knowledge, Section, Stats, summary::group};

/// What the paper says: bone lengths, black-out.
const PAPER: [(&str, bool, bool); 5] = [
    ("spline", false, true),
    ("msvd", false, false),
    ("dynammo+published", false, true),
    ("bolero-sc+published", true, true),
    ("bolero-hc+published", true, true),
];
/// Deviation up to which bone lengths count as kept: that of the complete motions is of this size.
const KEPT_MM: f64 = 5.0;

/// One row a method. `walking` and `running` are the cases by which bone lengths are judged.
pub(super) fn section(
    cells: &[Finished<'_>],
    [running, walking, blackout]: [&str; 3],
) -> Option<Section> {
    // The first conditions that the run has, told nothing: what a user gets.
    let coordinates = cells.iter().find(|cell| cell.trial.set == set::CASES)?.coordinates;
    let own: Vec<Finished<'_>> =
        cells.iter().filter(|cell| is_judged(cell, coordinates)).cloned().collect();
    let straight = own.iter().find(|cell| {
        cell.variant.label() == "linear"
            && cell.trial.set == set::CASES
            && cell.trial.name == blackout
    });
    let straight_mm = straight.and_then(|cell| cell.outcome.mean_mm);
    let rows = group(&own, |cell| cell.variant.label()).into_iter().map(|(method, cells)| {
        let case = |name: &str| {
            cells.iter().find(|c| c.trial.set == set::CASES && c.trial.name == name).copied()
        };
        let paper = PAPER.iter().find(|row| row.0 == method);
        let mark = |said: Option<bool>| Entry::text(said.map_or("\u{2013}", tick));
        let tidy: Vec<&Finished<'_>> =
            cells.iter().copied().filter(|c| c.trial.set != set::MASKS).collect();
        vec![
            Entry::text(method),
            mark(paper.map(|row| row.1)),
            bones(&[case(running), case(walking)]),
            mark(paper.map(|row| row.2)),
            black_out(case(blackout), straight_mm),
            uncertainty(&tidy),
            any_mask(&cells),
            no_training(&tidy),
        ]
    });
    let note = format!(
        "The paper's marks, and what was measured. Bone lengths: mean deviation of the bones that touch \
         a hidden sample in the cases {running} and {walking}; kept means at most {KEPT_MM} mm, which is what \
         the complete motions show themselves. Black-out: mean error in the case {blackout} if every \
         sample was filled; handled means no worse than straight lines. Uncertainty: share of the trials' \
         samples within 1 and 2 sigma, for methods that state one; honest is 68 and 95 %. Any mask: \
         share of the samples filled in takes with single samples missing, gaps at both ends, gaps \
         that overlap, and a black-out. No training: share of the trials that the method filled with \
         nothing but the gappy take to learn from; no method is given more."
    );
    let columns = [
        "method",
        "paper: bone lengths",
        "bone lengths",
        "paper: black-out",
        "black-out",
        "uncertainty",
        "any mask",
        "no training",
    ];
    Some(Section::new("table-1", "Table 1 of the paper, measured", &note, &columns, rows))
}

fn is_judged(cell: &Finished<'_>, coordinates: Coordinates) -> bool {
    let aside = [set::PART, set::RANDOM, set::LAMBDA, set::SEEDS, set::CAPS];
    cell.coordinates == coordinates
        && cell.knowledge == Knowledge::Visible
        && !aside.contains(&cell.trial.set.as_str())
}

fn tick(yes: bool) -> &'static str {
    if yes { "yes" } else { "no" }
}

fn bones(cases: &[Option<&Finished<'_>>]) -> Entry {
    let deviations: Vec<f64> =
        cases.iter().flatten().filter_map(|cell| cell.outcome.bone_mm).collect();
    let Some(worst) = deviations.iter().copied().reduce(f64::max) else { return Entry::Empty };
    let each: Vec<String> = deviations.iter().map(|mm| format!("{mm:.1}")).collect();
    Entry::text(format!("{}, {} mm", tick(worst <= KEPT_MM), each.join(" and ")))
}

fn black_out(case: Option<&Finished<'_>>, straight_mm: Option<f64>) -> Entry {
    let Some(case) = case else { return Entry::Empty };
    let outcome = &case.outcome;
    match outcome.mean_mm {
        Some(mm) if outcome.unfilled == 0 => {
            // A method run as straight lines is no worse than itself.
            let good = straight_mm.is_none_or(|straight| mm <= straight * (1.0 + 1e-9));
            Entry::text(format!("{}, {mm:.1} mm", tick(good)))
        }
        _ => Entry::text(format!("no, {} of {} left open", outcome.unfilled, outcome.hidden)),
    }
}

fn uncertainty(cells: &[&Finished<'_>]) -> Entry {
    let listed = cells.iter().filter(|cell| cell.trial.set != set::CASES);
    let sure = Stats::of(listed.map(|cell| &cell.outcome)).sureness;
    match (sure.share_within(1.0), sure.share_within(2.0)) {
        (Some(one), Some(two)) => {
            Entry::text(format!("yes, {:.0} and {:.0} %", 100.0 * one, 100.0 * two))
        }
        _ => Entry::text("no"),
    }
}

fn any_mask(cells: &[&Finished<'_>]) -> Entry {
    let odd = |cell: &&&Finished<'_>| {
        let trial = &cell.trial;
        trial.set == set::MASKS || (trial.set == set::CASES && trial.hidden[0].marker == "*")
    };
    let stats = Stats::of(cells.iter().filter(odd).map(|cell| &cell.outcome));
    if stats.hidden == 0 {
        return Entry::Empty;
    }
    let share = 100.0 * (stats.hidden - stats.unfilled) as f64 / stats.hidden as f64;
    // Rounded down, so that only all of them are 100 %.
    let share = (10.0 * share).floor() / 10.0;
    Entry::text(format!("{}, {share:.1} %", tick(stats.unfilled == 0)))
}

fn no_training(cells: &[&Finished<'_>]) -> Entry {
    let filled = cells.iter().filter(|cell| cell.outcome.unfilled < cell.outcome.hidden).count();
    Entry::text(format!("{}, {filled} of {}", tick(filled > 0), cells.len()))
}
