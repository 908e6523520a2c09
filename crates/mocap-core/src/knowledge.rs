use std::collections::{BTreeMap, HashMap};

use crate::{CoreError, MarkerSet, marker_set::split_name};

const CMU_41: &str = include_str!("../data/cmu-41.markers");
const FRONT_WAIST_53: &str = include_str!("../data/front_waist-53.markers");
const PRODUCTION_57: &str = include_str!("../data/production-57.markers");

/// What is known of a named marker set: its markers, their other names, bones and roles.
///
/// The knowledge is a text file with one fact a line, so that anyone can add a set:
///
/// ```text
/// name   My set
/// marker C7                 # one line a marker
/// optional T8               # worn by some only
/// alias  LFWT LASI          # `LASI` of a file counts as `LFWT`
/// bone   LELB LUPA          # two markers a fixed distance apart
/// role   back C7 T10        # markers of a named part
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MarkerKnowledge {
    name: String,
    markers: Vec<String>,
    optional: Vec<String>,
    aliases: HashMap<String, String>,
    bones: Vec<(String, String)>,
    roles: BTreeMap<String, Vec<String>>,
}

impl MarkerKnowledge {
    /// The 41 markers of the CMU motion capture database, with the bone pairs of [Li10].
    ///
    /// # Panics
    /// Never: the file is part of the crate and read by its tests.
    #[must_use]
    pub fn cmu_41() -> Self {
        built_in(CMU_41, "cmu-41.markers")
    }

    /// The 53 markers of [Pan23] with one in the middle of the front waist, and up to ten on each hand.
    ///
    /// # Panics
    /// Never: the file is part of the crate and read by its tests.
    #[must_use]
    pub fn front_waist_53() -> Self {
        built_in(FRONT_WAIST_53, "front_waist-53.markers")
    }

    /// The 57 markers of [Pan23] as worn in production, and up to ten on each hand.
    ///
    /// # Panics
    /// Never: the file is part of the crate and read by its tests.
    #[must_use]
    pub fn production_57() -> Self {
        built_in(PRODUCTION_57, "production-57.markers")
    }

    /// Every set that ships with the crate, the one of the CMU database first.
    #[must_use]
    pub fn built_in() -> Vec<Self> {
        vec![Self::cmu_41(), Self::front_waist_53(), Self::production_57()]
    }

    /// The set of which a take has the largest share; of equals the first, `None` where it has nothing of any.
    #[must_use]
    pub fn best<'a>(sets: &'a [Self], markers: &MarkerSet) -> Option<&'a Self> {
        let shares = sets.iter().map(|set| (set.coverage(markers), set));
        let worn = shares.filter(|(share, _)| *share > 0.0);
        // The first of equals, where `max_by` would give the last.
        worn.reduce(|best, next| if next.0 > best.0 { next } else { best }).map(|(_, set)| set)
    }

    /// The set that ships with the crate and fits a take best; that of the CMU database where none does.
    ///
    /// ```
    /// use mocap_core::{MarkerKnowledge, MarkerSet};
    ///
    /// let waist = ["kim:LFWT", "kim:MFWT", "kim:RFWT", "kim:LBWT", "kim:MBWT", "kim:RBWT"];
    /// let markers = MarkerSet::new(waist)?;
    /// assert_eq!(MarkerKnowledge::for_markers(&markers).name(), "front_waist-53");
    /// # Ok::<(), mocap_core::CoreError>(())
    /// ```
    #[must_use]
    pub fn for_markers(markers: &MarkerSet) -> Self {
        let sets = Self::built_in();
        Self::best(&sets, markers).cloned().unwrap_or_else(Self::cmu_41)
    }

    /// Reads the knowledge from its text form; `file` is the name that errors show.
    ///
    /// # Errors
    /// [`CoreError::MarkerSetLine`] with the line and the rule it breaks.
    pub fn parse(text: &str, file: &str) -> Result<Self, CoreError> {
        let mut known = Self {
            name: file.to_owned(),
            markers: Vec::new(),
            optional: Vec::new(),
            aliases: HashMap::new(),
            bones: Vec::new(),
            roles: BTreeMap::new(),
        };
        for (number, line) in text.lines().enumerate() {
            let content = line.split('#').next().unwrap_or_default().trim();
            if !content.is_empty() {
                known.take_line(content).map_err(|rule| CoreError::MarkerSetLine {
                    file: file.to_owned(),
                    line: number + 1,
                    text: line.to_owned(),
                    rule,
                })?;
            }
        }
        Ok(known)
    }

    fn take_line(&mut self, line: &str) -> Result<(), &'static str> {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["name", ..] => line["name".len()..].trim().clone_into(&mut self.name),
            ["marker", name] => self.markers.push((*name).to_owned()),
            ["optional", name] => self.optional.push((*name).to_owned()),
            ["alias", name, others @ ..] if !others.is_empty() => {
                self.check_known(name)?;
                let pairs = others.iter().map(|o| ((*o).to_owned(), (*name).to_owned()));
                self.aliases.extend(pairs);
            }
            ["bone", a, b] if a != b => {
                self.check_known(a)?;
                self.check_known(b)?;
                self.bones.push(((*a).to_owned(), (*b).to_owned()));
            }
            ["role", role, markers @ ..] if !markers.is_empty() => {
                markers.iter().try_for_each(|m| self.check_known(m))?;
                let members = markers.iter().map(|m| (*m).to_owned());
                self.roles.entry((*role).to_owned()).or_default().extend(members);
            }
            _ => {
                return Err("a line is `name TEXT`, `marker NAME`, `optional NAME`, \
                            `alias NAME OTHER…`, `bone A B` or `role ROLE NAME…`");
            }
        }
        Ok(())
    }

    fn check_known(&self, marker: &str) -> Result<(), &'static str> {
        if self.all_markers().any(|m| m == marker) {
            return Ok(());
        }
        Err("markers need a `marker` line before they are used")
    }

    fn all_markers(&self) -> impl Iterator<Item = &String> {
        self.markers.iter().chain(&self.optional)
    }

    /// Name of the set.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The set's own marker names, optional ones left out.
    #[must_use]
    pub fn markers(&self) -> &[String] {
        &self.markers
    }

    /// Share of the set's markers that a take has, between 0 and 1, for the subject that has most.
    #[must_use]
    pub fn coverage(&self, markers: &MarkerSet) -> f64 {
        let worn = |s: &HashMap<&str, usize>| {
            self.markers.iter().filter(|m| s.contains_key(m.as_str())).count()
        };
        let most = self.subjects(markers).iter().map(worn).max().unwrap_or(0);
        most as f64 / self.markers.len().max(1) as f64
    }

    /// The known bones that a take has both ends of, as marker indices, subject by subject.
    #[must_use]
    pub fn bone_pairs(&self, markers: &MarkerSet) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for subject in self.subjects(markers) {
            let ends = self
                .bones
                .iter()
                .filter_map(|(a, b)| Some((*subject.get(a.as_str())?, *subject.get(b.as_str())?)));
            pairs.extend(ends);
        }
        pairs
    }

    /// The markers of a role that a take has, for the subject that has most of the set.
    #[must_use]
    pub fn role(&self, role: &str, markers: &MarkerSet) -> Vec<usize> {
        let mut subjects = self.subjects(markers);
        subjects.sort_by_key(|s| std::cmp::Reverse(s.len()));
        let (Some(subject), Some(members)) = (subjects.first(), self.roles.get(role)) else {
            return Vec::new();
        };
        members.iter().filter_map(|m| subject.get(m.as_str()).copied()).collect()
    }

    /// Per subject prefix: the set's own name of each marker found, and its index in the take.
    fn subjects<'a>(&'a self, markers: &MarkerSet) -> Vec<HashMap<&'a str, usize>> {
        let own: HashMap<String, &str> =
            self.all_markers().map(|m| (m.to_uppercase(), m.as_str())).collect();
        let aliases: HashMap<String, &str> =
            self.aliases.iter().map(|(other, m)| (other.to_uppercase(), m.as_str())).collect();
        let mut subjects: BTreeMap<String, HashMap<&str, usize>> = BTreeMap::new();
        // Own names go first, so that an alias never displaces the marker it stands for.
        for names in [&own, &aliases] {
            for (index, label) in markers.names().iter().enumerate() {
                let (prefix, bare) = split_name(label);
                if let Some(name) = names.get(&bare.to_uppercase()) {
                    let subject = subjects.entry(prefix.to_owned()).or_default();
                    subject.entry(name).or_insert(index);
                }
            }
        }
        subjects.into_values().collect()
    }
}

fn built_in(text: &str, file: &str) -> MarkerKnowledge {
    MarkerKnowledge::parse(text, file).expect("the built-in file is well-formed")
}
