use std::{collections::HashMap, sync::Arc};

use mocap_core::{Joint, Skeleton};

use super::{Body, Habit, Site};
use crate::IkError;

/// Spread of a marker's place without a word, in metres.
const MARKER_SPREAD_M: f64 = 0.03;
/// Spread of a joint's place, in metres.
const BONE_SPREAD_M: f64 = 0.02;

type Broken = &'static str;

pub(super) fn parse(text: &str, file: &str) -> Result<Body, IkError> {
    let mut reader = Reader::default();
    for (number, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or_default().trim();
        if !content.is_empty() {
            reader.take(content).map_err(|rule| IkError::BodyLine {
                file: file.to_owned(),
                line: number + 1,
                text: line.to_owned(),
                rule,
            })?;
        }
    }
    reader.finish(file)
}

#[derive(Default)]
struct Reader {
    name: Option<String>,
    joints: Vec<Joint>,
    habits: Vec<Habit>,
    sites: Vec<Site>,
    aliases: HashMap<String, String>,
}

impl Reader {
    fn take(&mut self, line: &str) -> Result<(), Broken> {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["name", ..] => self.name = Some(line["name".len()..].trim().to_owned()),
            ["joint", name] => self.joint(name, None, [0.0; 3])?,
            ["joint", name, parent, place @ ..] => {
                let parent = self.find(parent)?;
                self.joint(name, Some(parent), three(place)?)?;
            }
            ["rigid", name] => {
                let joint = self.find(name)?;
                self.habits[joint].rigid = true;
            }
            ["spread", name, all] => {
                let spread = [angle(all)?; 3];
                let joint = self.find(name)?;
                self.habits[joint].spread = spread;
            }
            ["spread", name, along, across, axis @ ..] => {
                let joint = self.find(name)?;
                let habit = Habit::about(three(axis)?, angle(along)?, angle(across)?);
                let habit = habit.ok_or("an axis has a direction")?;
                let Habit { rigid, limits, t_pose, .. } = self.habits[joint];
                self.habits[joint] = Habit { rigid, limits, t_pose, ..habit };
            }
            ["t-pose", name, turn @ ..] => {
                let joint = self.find(name)?;
                self.habits[joint].t_pose = three(turn)?.map(f64::to_radians);
            }
            ["limit", name, low, high] => {
                let joint = self.find(name)?;
                let limits = [number(low)?.to_radians(), number(high)?.to_radians()];
                if limits[0] >= limits[1] {
                    return Err("the first limit is below the second");
                }
                self.habits[joint].limits = limits;
            }
            ["marker", name, joint, x, y, z, words @ ..] => {
                self.marker(name, joint, &[x, y, z], words)?;
            }
            ["alias", name, others @ ..] if !others.is_empty() => {
                if !self.sites.iter().any(|site| site.marker == *name) {
                    return Err("a marker needs a `marker` line before it is used");
                }
                let pairs = others.iter().map(|o| (o.to_uppercase(), (*name).to_owned()));
                self.aliases.extend(pairs);
            }
            _ => {
                return Err(
                    "a line is `name TEXT`, `joint NAME`, `joint NAME PARENT X Y Z`, `rigid JOINT`, \
                            `spread JOINT DEGREES`, `spread JOINT ALONG ACROSS X Y Z`, `limit JOINT LOW HIGH`, \
                            `t-pose JOINT X Y Z`, \
                            `marker NAME JOINT X Y Z [share JOINT SHARE] [spread METRES]` or `alias NAME OTHER…`",
                );
            }
        }
        Ok(())
    }

    fn joint(
        &mut self,
        name: &str,
        parent: Option<usize>,
        offset_m: [f64; 3],
    ) -> Result<(), Broken> {
        if self.find(name).is_ok() {
            return Err("a joint of this name stands above; names are unique");
        }
        if parent.is_none() && !self.joints.is_empty() {
            return Err("one joint is the root; every other one names its parent");
        }
        self.joints.push(Joint { name: name.to_owned(), parent, offset_m });
        self.habits.push(Habit::FREE);
        Ok(())
    }

    fn marker(
        &mut self,
        name: &str,
        joint: &str,
        place: &[&str],
        words: &[&str],
    ) -> Result<(), Broken> {
        if self.sites.iter().any(|site| site.marker.eq_ignore_ascii_case(name)) {
            return Err("a marker of this name stands above; names are unique");
        }
        let mut site = Site {
            marker: name.to_owned(),
            near: self.find(joint)?,
            far: None,
            place: three(place)?,
            spread: MARKER_SPREAD_M,
        };
        let mut words = words;
        while let [word, rest @ ..] = words {
            words = match (*word, rest) {
                ("share", [joint, share, rest @ ..]) => {
                    let share = number(share)?;
                    if !(share > 0.0 && share < 1.0) {
                        return Err("a share is between 0 and 1");
                    }
                    site.far = Some((self.find(joint)?, share));
                    rest
                }
                ("spread", [metres, rest @ ..]) => {
                    site.spread = number(metres)?;
                    if site.spread <= 0.0 {
                        return Err("a spread is above 0");
                    }
                    rest
                }
                _ => {
                    return Err(
                        "after the place of a marker come `share JOINT SHARE` and `spread METRES`",
                    );
                }
            };
        }
        self.sites.push(site);
        Ok(())
    }

    fn find(&self, name: &str) -> Result<usize, Broken> {
        let found = self.joints.iter().position(|joint| joint.name == name);
        found.ok_or("a joint needs a `joint` line before it is used; parents come first")
    }

    fn finish(self, file: &str) -> Result<Body, IkError> {
        let empty = |what| IkError::EmptyBody { file: file.to_owned(), what };
        if self.joints.is_empty() {
            return Err(empty("joint"));
        }
        if self.sites.is_empty() {
            return Err(empty("marker"));
        }
        let body = Body {
            name: self.name.unwrap_or_else(|| file.to_owned()),
            skeleton: Arc::new(Skeleton::new(self.joints)?),
            habits: self.habits,
            sites: self.sites,
            aliases: self.aliases,
            bone_spread: BONE_SPREAD_M,
        };
        body.check()?;
        Ok(body)
    }
}

fn number(word: &str) -> Result<f64, Broken> {
    word.parse::<f64>().ok().filter(|n| n.is_finite()).ok_or("a number is finite: 0.12")
}

fn angle(word: &str) -> Result<f64, Broken> {
    let degrees = number(word)?;
    if degrees > 0.0 { Ok(degrees.to_radians()) } else { Err("a spread is above 0") }
}

fn three(words: &[&str]) -> Result<[f64; 3], Broken> {
    let [x, y, z] = words else { return Err("three numbers are needed here: x, y and z") };
    Ok([number(x)?, number(y)?, number(z)?])
}
