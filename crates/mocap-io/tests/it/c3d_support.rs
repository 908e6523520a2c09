//! Recordings and random numbers for the C3D tests.

use std::path::PathBuf;

use mocap_io::c3d::{C3d, C3dError, C3dOptions, NewAnalog, NewC3d, NewStorage, Processor};

pub const PROCESSORS: [Processor; 3] = [Processor::Intel, Processor::Dec, Processor::Sgi];
pub const STORAGES: [NewStorage; 2] = [NewStorage::Real, NewStorage::Integer { scale: 0.05 }];

pub fn read(bytes: Vec<u8>) -> Result<C3d, C3dError> {
    C3d::parse(bytes, &C3dOptions::default())
}

pub fn salvage(bytes: Vec<u8>) -> Result<C3d, C3dError> {
    C3d::parse(bytes, &C3dOptions { salvage: true, ..C3dOptions::default() })
}

/// A recording with some samples missing and two analog channels of two samples per frame.
pub fn recording(
    processor: Processor,
    storage: NewStorage,
    points: usize,
    frames: usize,
) -> NewC3d {
    let mut new = NewC3d::new((0..points).map(|point| format!("P{point}")).collect(), 100.0);
    new.processor = processor;
    new.storage = storage;
    new.first_frame = 7;
    let at = |index: usize| (index as f64 * 0.7).sin() * 1500.0 + 0.123;
    new.xyz =
        (0..points * frames).map(|index| [at(index), at(index + 3), at(index + 11)]).collect();
    new.missing = (0..points * frames).map(|index| index % 7 == 2).collect();
    new.words = (0..points * frames).map(|index| i16::try_from(index % 300).unwrap()).collect();
    new.analog = Some(NewAnalog {
        labels: vec!["Fx".into(), "EMG1".into()],
        units: vec!["N".into(), "V".into()],
        samples_per_frame: 2,
        scale: 0.5,
        values: (0..frames * 4).map(|index| (index % 500) as f32 * 0.5).collect(),
    });
    new
}

/// A small generator with a fixed seed (`SplitMix64`), so that a failing copy can be made again.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.next() % bound as u64).unwrap()
    }
}

/// The folder of real recordings, if it holds the C3D collection; else `None`, with a line that says so.
pub fn data_folder() -> Option<PathBuf> {
    Some(mocap_testkit::recording("c3d-zoo")?.parent()?.to_owned())
}
