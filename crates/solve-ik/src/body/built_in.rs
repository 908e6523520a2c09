use std::cmp::Reverse;

use mocap_core::MarkerSet;

use super::Body;

const CMU_41: &str = include_str!("../../data/cmu-41.body");
const FRONT_WAIST_53: &str = include_str!("../../data/front_waist-53.body");
const PRODUCTION_57: &str = include_str!("../../data/production-57.body");

impl Body {
    /// The body for the 41 markers of the CMU database, with the joints of its ASF files.
    ///
    /// # Panics
    /// Never: the file is part of the crate and read by its tests.
    #[must_use]
    pub fn cmu_41() -> Self {
        read(CMU_41, "cmu-41.body")
    }

    /// The body for the 53 markers of [Pan23] with one in the middle of the front waist, and ten more on each hand.
    ///
    /// # Panics
    /// Never: the file is part of the crate and read by its tests.
    #[must_use]
    pub fn front_waist_53() -> Self {
        read(FRONT_WAIST_53, "front_waist-53.body")
    }

    /// The body for the 57 markers of [Pan23] as worn in production, and ten more on each hand.
    ///
    /// # Panics
    /// Never: the file is part of the crate and read by its tests.
    #[must_use]
    pub fn production_57() -> Self {
        read(PRODUCTION_57, "production-57.body")
    }

    /// Every body that ships with the crate.
    ///
    /// ```
    /// use mocap_core::MarkerSet;
    /// use solve_ik::Body;
    ///
    /// let markers = MarkerSet::new(["kim:LFWT", "kim:MFWT", "kim:RFWT", "kim:LBWT", "kim:RBWT"])?;
    /// let bodies = Body::for_markers(Body::built_in(), &markers);
    /// assert_eq!(bodies[0].name(), "front_waist-53");
    /// # Ok::<(), mocap_core::CoreError>(())
    /// ```
    #[must_use]
    pub fn built_in() -> Vec<Self> {
        vec![Self::cmu_41(), Self::front_waist_53(), Self::production_57()]
    }

    /// The bodies, those that know most of these markers first.
    #[must_use]
    pub fn for_markers(mut bodies: Vec<Self>, markers: &MarkerSet) -> Vec<Self> {
        bodies.sort_by_cached_key(|body| Reverse(body.known(markers)));
        bodies
    }

    /// How many of these markers the body's map knows.
    fn known(&self, markers: &MarkerSet) -> usize {
        let own = |label: &str| self.sites.iter().any(|s| s.marker.eq_ignore_ascii_case(label));
        let is_known = |column: usize| {
            let label = markers.split(column).1;
            own(label) || self.aliases.contains_key(&label.to_uppercase())
        };
        (0..markers.len()).filter(|&column| is_known(column)).count()
    }
}

fn read(text: &str, file: &str) -> Body {
    Body::parse(text, file).expect("the built-in file is well-formed")
}
