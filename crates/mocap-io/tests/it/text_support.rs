//! Takes and small files for the tests of the text formats.

use mocap_core::{MarkerSet, Mask, Take};
use mocap_io::{
    FileInfo, ReadOptions,
    text::{
        EncodeOptions, Parsed, TextError,
        amc::Amc,
        asf::Asf,
        bvh::Bvh,
        table::{encode_csv, encode_tsv, read_csv, read_tsv},
        trc,
    },
};
use ndarray::Array3;

pub type Read = fn(Vec<u8>, &ReadOptions) -> Result<Parsed, TextError>;
pub type Encode = fn(&Take, &EncodeOptions) -> Vec<u8>;

/// Every table format: name, reader, writer.
pub const TABLES: [(&str, Read, Encode); 3] =
    [("trc", trc::read, trc::encode), ("csv", read_csv, encode_csv), ("tsv", read_tsv, encode_tsv)];

pub const TRC: &str = "PathFileType\t4\t(X/Y/Z)\ta.trc\n\
    DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
    100.00\t100.00\t3\t2\tmm\t100.00\t1\t3\n\
    Frame#\tTime\tC7\t\t\tT10\t\t\n\
    \t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\
    \n\
    5\t0.04\t10.5\t-20\t30\t1\t2\t3\n\
    6\t0.05\t11.5\t-21\t31\t\t\t\n\
    7\t0.06\tNaN\tnan\tNAN\t1.1E+00\t2.2e0\t3.3\n";

pub const CMU: &str = "jane:C7-x, jane:C7-y, jane:C7-z, jane:T10-x, jane:T10-y, jane:T10-z\n\
    10.5, -20, 30, 1, 2, 3\n\
    11.5, -21, 31, , , \n\
    12.5, -22, 32, 1.25, 2.25, 3.25\n";

pub const QUALISYS: &str = "NO_OF_FRAMES\t3\r\nNO_OF_CAMERAS\t7\r\nNO_OF_MARKERS\t2\r\n\
    FREQUENCY\t100\r\nNO_OF_ANALOG\t0\r\nANALOG_FREQUENCY\t0\r\nDESCRIPTION\t--\r\n\
    TIME_STAMP\t2021-08-26, 15:19:24.317\t1483034.68525310\r\nDATA_INCLUDED\t3D\r\n\
    MARKER_NAMES\thand_top\thand left\r\nTRAJECTORY_TYPES\tMeasured\tMixed\r\n\
    Frame\tTime\thand_top X\thand_top Y\thand_top Z\thand left X\thand left Y\thand left Z\r\n\
    1\t0.00000\t110.406\t135.075\t460.584\t62.382\t161.390\t450.921\r\n\
    2\t0.01000\t110.763\t135.349\t460.458\t0.000\t0.000\t0.000\r\n\
    3\t0.02000\t111.2\t135.9\t460.1\t62.9\t161.9\t450.5\r\n";

pub const MOTIVE: &str = "Format Version,1.23,Take Name,Take A,Capture Frame Rate,240.000000,\
    Export Frame Rate,120.000000,Total Frames in Take,3,Total Exported Frames,3,\
    Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global\n\
    \n\
    ,Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,Marker,Marker,Marker,Marker,Marker,Marker\n\
    ,Name,Hat,Hat,Hat,Hat:Marker 1,Hat:Marker 1,Hat:Marker 1,LFHD,LFHD,LFHD,\"Knee, left\",\"Knee, left\",\"Knee, left\"\n\
    ,ID,1,1,1,2,2,2,3,3,3,4,4,4\n\
    ,,Position,Position,Position,Position,Position,Position,Position,Position,Position,Position,Position,Position\n\
    Frame,Time (Seconds),X,Y,Z,X,Y,Z,X,Y,Z,X,Y,Z\n\
    0,0.000000,9,9,9,8,8,8,1.5,2.5,3.5,0.1,0.2,0.3\n\
    1,0.008333,9,9,9,8,8,8,,,,0.2,0.3,0.4\n\
    2,0.016667,9,9,9,8,8,8,1.7,2.7,3.7,0.3,0.4,0.5\n";

pub const BVH: &str = "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 0 0\n\
    \tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
    \tJOINT Knee {\n\t\tOFFSET 0 -10 0\n\t\tCHANNELS 1 Xrotation\n\
    \t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 -8 0\n\t\t}\n\t}\n\
    \tJOINT Spine\n\t{\n\t\tOFFSET 0 5 0\n\t\tCHANNELS 3 Yrotation Zrotation Xrotation\n\
    \t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 6 0\n\t\t}\n\t}\n}\n\
    MOTION\nFrames: 3\nFrame Time: .0083333\n\
    1 2 3 10 20 30 45 5 6 7\n1.5 2 3 11 21 31 46 5 6 7\n2 2 3 12 22 32 47 5 6 7.5\n";

pub const ASF: &str = "# comment\n:version 1.10\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n\
    :documentation\n   begin with anything\n:root\n   order TX TY TZ RX RY RZ\n   axis XYZ\n\
    \x20  position 0 0 0\n   orientation 0 0 0\n:bonedata\n\
    \x20 begin\n     id 1\n     name hip\n     direction 0 -1 0\n     length 2\n     axis 0 0 0  XYZ\n  end\n\
    \x20 begin\n     id 2\n     name femur\n     direction 0 -1 0\n     length 7\n     axis 0 0 20  XYZ\n\
    \x20   dof rx ry rz\n    limits (-160.0 20.0)\n           (-70.0 70.0)\n           (-60.0 70.0)\n  end\n\
    \x20 begin\n     id 3\n     name tibia\n     direction 0 -1 0\n     length 8\n     axis 0 0 20  XYZ\n    dof rx\n  end\n\
    :hierarchy\n  begin\n    root hip\n    hip femur\n    femur tibia\n  end\n";

pub const AMC: &str = "#!OML:ASF anything\n:FULLY-SPECIFIED\n:DEGREES\n\
    1\nroot 1 2 3 4 5 6\nfemur 10 20 30\ntibia 40\n\
    2\nroot 1.5 2 3 4 5 6\nfemur 11 21 31\ntibia 41\n\
    3\nroot 2 2 3 4 5 6\nfemur 12 22 32\ntibia 42.5\n";

/// What a parser makes of bytes, in the shape that all formats share.
pub type Outcome = Result<(usize, FileInfo), TextError>;

/// Name, small file, parser to (frames, info).
pub type Dialect = (&'static str, &'static str, fn(Vec<u8>, &ReadOptions) -> Outcome);

/// Every dialect.
pub fn dialects() -> Vec<Dialect> {
    fn table(parsed: Parsed) -> (usize, FileInfo) {
        (parsed.take.frames(), parsed.info)
    }
    vec![
        ("trc", TRC, |b, o| trc::read(b, o).map(table)),
        ("cmu", CMU, |b, o| read_csv(b, o).map(table)),
        ("qualisys", QUALISYS, |b, o| read_tsv(b, o).map(table)),
        ("motive", MOTIVE, |b, o| read_csv(b, o).map(table)),
        ("bvh", BVH, |b, o| {
            let bvh = Bvh::parse(b, o)?;
            bvh.motion()?;
            Ok((bvh.frames(), bvh.info().clone()))
        }),
        ("asf", ASF, |b, o| {
            Asf::parse(b, o).map(|asf| (asf.skeleton().joints().len(), asf.info().clone()))
        }),
        ("amc", AMC, |b, o| {
            let amc = Amc::parse(b, &asf(), o)?;
            Ok((amc.motion().poses().len(), amc.info().clone()))
        }),
    ]
}

pub fn asf() -> Asf {
    Asf::parse(ASF.into(), &ReadOptions::default()).unwrap()
}

/// A take with gaps, a subject prefix, awkward names and a sample at the origin.
pub fn take(frames: usize, rate_hz: f64) -> Take {
    let names = ["jane:C7", "T10", "knee, \"left\"", "a-x"];
    let at = |i: usize| ((i * 37 % 101) as f64 - 50.0) * 0.031_415_926_535;
    let mut xyz =
        Array3::from_shape_fn((frames, names.len(), 3), |(t, m, a)| at(t * 12 + m * 3 + a));
    for axis in 0..3 {
        xyz[(0, 1, axis)] = 0.0;
    }
    let seen = Mask::from_fn(frames, names.len(), |t, m| m == 1 || (t + m) % 4 != 3);
    Take::new(MarkerSet::new(names).unwrap(), rate_hz, xyz, seen).unwrap()
}

/// The largest difference of a coordinate in metres; the same cells have to be observed.
pub fn difference(a: &Take, b: &Take) -> f64 {
    assert_eq!(a.observed(), b.observed());
    let pairs =
        a.positions().iter().copied().zip(b.positions().iter().copied()).collect::<Vec<_>>();
    pairs.into_iter().filter(|(x, _)| x.is_finite()).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}
