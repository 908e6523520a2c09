//! The gap statistics that come with the authors' code of [Pan23]: counts over captures of a game studio
//! at 120 Hz, which were not published themselves. The log-normal parameters are maximum-likelihood
//! fits to the unbinned counts.

#![expect(clippy::approx_constant, reason = "a percentage that happens to look like 1/π")]

/// One preset's numbers.
pub(crate) struct Table {
    /// Frames in which every marker was watched.
    pub(crate) frames: u64,
    /// Log-normal law of the gap lengths.
    pub(crate) mu: f64,
    /// Log-normal law of the gap lengths.
    pub(crate) sigma: f64,
    /// Number of gaps in each span of [`SPANS`].
    pub(crate) gaps: [u32; SPANS.len()],
    /// Share of frames in which each marker was missing, in percent.
    pub(crate) percent: &'static [(&'static str, f64)],
}

/// Gap lengths in frames, both ends inclusive; the last span is open.
#[rustfmt::skip]
pub(crate) const SPANS: [(usize, Option<usize>); 23] = [
    (1, Some(1)), (2, Some(2)), (3, Some(3)), (4, Some(4)), (5, Some(5)), (6, Some(7)),
    (8, Some(9)), (10, Some(11)), (12, Some(14)), (15, Some(19)), (20, Some(24)),
    (25, Some(29)), (30, Some(39)), (40, Some(49)), (50, Some(59)), (60, Some(79)),
    (80, Some(99)), (100, Some(149)), (150, Some(199)), (200, Some(299)), (300, Some(499)),
    (500, Some(998)), (999, None),
];

#[rustfmt::skip]
pub(crate) const FRONT_WAIST: Table = Table {
    frames: 2_391_746,
    mu: 0.85,
    sigma: 2.721,
    gaps: [
        2645, 1316, 834, 661, 458, 713, 519, 405, 493, 580, 430, 323, 476, 305, 260, 326, 265,
        362, 201, 224, 276, 207, 201,
    ],
    percent: &[
        ("ARIEL", 0.66), ("LFHD", 1.121), ("LBHD", 0.644), ("RFHD", 0.151), ("RBHD", 0.151),
        ("C7", 0.723), ("T10", 2.205), ("CLAV", 0.429), ("STRN", 1.616), ("LFSH", 0.227),
        ("LBSH", 0.203), ("LUPA", 0.517), ("LELB", 0.317), ("LIEL", 0.973), ("LFRM", 0.134),
        ("LIWR", 0.36), ("LOWR", 0.284), ("LIHAND", 0.304), ("LOHAND", 0.402), ("RFSH", 0.485),
        ("RBSH", 0.184), ("RUPA", 0.966), ("RELB", 0.326), ("RIEL", 1.277), ("RFRM", 0.248),
        ("RIWR", 0.535), ("ROWR", 0.712), ("RIHAND", 0.43), ("ROHAND", 0.377), ("LFWT", 0.717),
        ("MFWT", 6.788), ("RFWT", 0.984), ("LBWT", 1.739), ("MBWT", 4.528), ("RBWT", 1.838),
        ("LTHI", 0.18), ("LKNE", 1.351), ("LKNI", 2.117), ("LSHN", 0.346), ("LANK", 0.355),
        ("LHEL", 0.224), ("LMT5", 0.036), ("LMT1", 0.127), ("LTOE", 0.027), ("RTHI", 0.139),
        ("RKNE", 0.423), ("RKNI", 1.925), ("RSHN", 0.263), ("RANK", 0.405), ("RHEL", 0.189),
        ("RMT5", 0.179), ("RMT1", 0.184), ("RTOE", 0.038),
    ],
};

#[rustfmt::skip]
pub(crate) const PRODUCTION: Table = Table {
    frames: 7_429_935,
    mu: 0.547,
    sigma: 2.788,
    gaps: [
        6373, 3008, 1905, 1271, 1032, 1521, 1229, 931, 1115, 1210, 956, 743, 1072, 731, 537,
        769, 465, 616, 389, 464, 419, 528, 427,
    ],
    percent: &[
        ("ARIEL", 0.108), ("LFHD", 0.08), ("LBHD", 0.066), ("RFHD", 0.047), ("RBHD", 0.061),
        ("C7", 0.431), ("T10", 2.173), ("LT10", 1.029), ("RT10", 0.945), ("CLAV", 0.404),
        ("STRN", 0.918), ("LFSH", 0.25), ("LTSH", 0.102), ("LBSH", 0.106), ("LUPA", 0.45),
        ("LELB", 0.251), ("LBEL", 0.519), ("LFRM", 0.07), ("LIWR", 0.266), ("LOWR", 0.52),
        ("LIHAND", 0.461), ("LOHAND", 0.207), ("RFSH", 0.4), ("RTSH", 0.078), ("RBSH", 0.21),
        ("RUPA", 0.405), ("RELB", 0.412), ("RBEL", 0.304), ("RFRM", 0.261), ("RIWR", 0.787),
        ("ROWR", 0.535), ("RIHAND", 1.201), ("ROHAND", 1.664), ("LFWT", 1.365), ("LMWT", 0.951),
        ("LBWT", 1.015), ("RFWT", 0.92), ("RMWT", 0.555), ("RBWT", 1.19), ("LTHI", 0.808),
        ("LKNE", 0.968), ("LKNU", 0.536), ("LSHN", 1.073), ("LANK", 0.772), ("LHEL", 0.286),
        ("LMT5", 0.097), ("LMT1", 0.504), ("LTOE", 0.094), ("RTHI", 0.597), ("RKNE", 0.516),
        ("RKNU", 0.481), ("RSHN", 0.307), ("RANK", 0.414), ("RHEL", 0.318), ("RMT5", 0.346),
        ("RMT1", 0.133), ("RTOE", 0.066),
    ],
};

#[rustfmt::skip]
pub(crate) const TEN_FINGER: Table = Table {
    frames: 882_158,
    mu: -0.561,
    sigma: 2.358,
    gaps: [
        9619, 4146, 2505, 1705, 1338, 1810, 1154, 818, 916, 936, 574, 390, 523, 301, 227, 238,
        205, 244, 149, 196, 178, 104, 33,
    ],
    percent: &[
        ("LTHM3", 1.561), ("LTHM6", 1.421), ("LIDX3", 1.318), ("LIDX6", 1.877),
        ("LMID0", 1.661), ("LMID6", 2.809), ("LRNG3", 2.286), ("LRNG6", 3.917),
        ("LPNK3", 2.773), ("LPNK6", 3.952), ("RTHM3", 1.015), ("RTHM6", 1.404),
        ("RIDX3", 0.227), ("RIDX6", 1.425), ("RMID0", 1.455), ("RMID6", 3.553),
        ("RRNG3", 3.545), ("RRNG6", 5.92), ("RPNK3", 2.853), ("RPNK6", 12.438),
    ],
};

#[rustfmt::skip]
pub(crate) const FIVE_FINGER: Table = Table {
    frames: 8_474_925,
    mu: -0.3,
    sigma: 2.399,
    gaps: [
        63_069, 27_630, 16_494, 11_357, 8405, 12_095, 8098, 6131, 6573, 7584, 4957, 3545, 4699,
        3050, 2156, 2684, 1710, 2469, 1330, 1328, 1034, 717, 443,
    ],
    percent: &[
        ("LTHM6", 2.52), ("LIDX6", 2.267), ("LMID6", 4.249), ("LRNG6", 4.545), ("LPNK6", 5.604),
        ("RTHM6", 4.471), ("RIDX6", 2.945), ("RMID6", 6.882), ("RRNG6", 7.806),
        ("RPNK6", 7.931),
    ],
};

#[rustfmt::skip]
pub(crate) const THREE_FINGER: Table = Table {
    frames: 293_804,
    mu: 0.345,
    sigma: 2.26,
    gaps: [
        629, 259, 154, 124, 78, 127, 98, 77, 83, 116, 62, 39, 61, 44, 40, 51, 22, 24, 13, 13,
        14, 9, 3,
    ],
    percent: &[
        ("RIDX3", 2.301), ("LPNK3", 1.473), ("LIDX3", 2.025), ("RTHM3", 2.466),
        ("LTHM3", 3.244), ("RPNK3", 4.087),
    ],
};
