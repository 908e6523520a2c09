use std::fmt::{self, Display};

use super::{Body, Habit};

impl Display for Body {
    /// The text form, which [`Body::parse`] reads: how a calibrated body is kept for the next take.
    ///
    /// Places have six decimals. A body on a known skeleton is written like any other, so that its bones may be
    /// calibrated again.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let joints = self.skeleton.joints();
        let name = |joint: usize| joints[joint].name.as_str();
        writeln!(f, "name {}", self.name)?;
        for joint in joints {
            match joint.parent {
                None => writeln!(f, "joint {}", joint.name)?,
                Some(parent) => {
                    writeln!(f, "joint {} {} {}", joint.name, name(parent), three(joint.offset_m))?;
                }
            }
        }
        for (index, habit) in self.habits.iter().enumerate() {
            print_habit(f, name(index), habit)?;
        }
        for site in &self.sites {
            write!(f, "marker {} {} {}", site.marker, name(site.near), three(site.place))?;
            if let Some((far, share)) = site.far {
                write!(f, " share {} {share}", name(far))?;
            }
            writeln!(f, " spread {}", site.spread)?;
        }
        let mut aliases: Vec<(&String, &String)> = self.aliases.iter().collect();
        aliases.sort();
        aliases.iter().try_for_each(|(other, marker)| writeln!(f, "alias {marker} {other}"))
    }
}

fn print_habit(f: &mut fmt::Formatter<'_>, joint: &str, habit: &Habit) -> fmt::Result {
    if habit.rigid {
        return writeln!(f, "rigid {joint}");
    }
    let [along, across, _] = habit.spread.map(f64::to_degrees);
    let axis = habit.axes[0];
    writeln!(f, "spread {joint} {along:.6} {across:.6} {}", three(axis))?;
    let [low, high] = habit.limits.map(f64::to_degrees);
    if low.is_finite() && high.is_finite() {
        writeln!(f, "limit {joint} {low:.6} {high:.6}")?;
    }
    if habit.t_pose.iter().any(|angle| angle.abs() > 0.0) {
        writeln!(f, "t-pose {joint} {}", three(habit.t_pose.map(f64::to_degrees)))?;
    }
    Ok(())
}

fn three(p: [f64; 3]) -> String {
    p.map(|c| format!("{c:.6}")).join(" ")
}
