use std::{
    collections::BTreeSet,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::{
    Coordinates, Knowledge, Motions, Outcome, ReproError, Store, Trial, Variant, cell::Job,
};

/// What is run: every variant on every trial, in all coordinates and with all kinds of knowledge.
#[derive(Debug, Clone)]
pub struct Matrix {
    /// The gaps.
    pub trials: Vec<Trial>,
    /// The recordings that the trials name.
    pub motions: Motions,
    /// The methods.
    pub variants: Vec<Variant>,
    /// The coordinates.
    pub coordinates: Vec<Coordinates>,
    /// What the methods are told.
    pub knowledge: Vec<Knowledge>,
    /// Iterations at most, for trials without a number of their own; `None`: the method's.
    pub iterations: Option<usize>,
}

/// A cell that is done.
#[derive(Debug, Clone, PartialEq)]
pub struct Finished<'a> {
    /// The gap.
    pub trial: &'a Trial,
    /// The method.
    pub variant: &'a Variant,
    /// The coordinates.
    pub coordinates: Coordinates,
    /// What the method was told.
    pub knowledge: Knowledge,
    /// What came out.
    pub outcome: Outcome,
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Work done, in frames times iterations.
    pub done: usize,
    /// Work altogether; cells that were there before the run are in neither.
    pub total: usize,
}

impl Matrix {
    /// Refuses a matrix with a trial that does not fit its motion, or a method that refuses its options,
    /// before any work.
    ///
    /// # Errors
    /// [`ReproError::Empty`], [`ReproError::Motion`], [`ReproError::Method`], [`ReproError::Misfit`],
    /// [`ReproError::NothingHidden`].
    pub fn check(&self) -> Result<(), ReproError> {
        let (trials, methods) = (self.trials.len(), self.variants.len());
        let jobs = self.jobs()?;
        if jobs.is_empty() {
            return Err(ReproError::Empty { trials, methods });
        }
        jobs.iter().try_for_each(Job::check)?;
        self.trials.iter().try_for_each(|trial| {
            let motion = self.motion(trial)?;
            trial.cut(motion.take()).map(drop)
        })
    }

    fn motion(&self, trial: &Trial) -> Result<&crate::Motion, ReproError> {
        let motion = self.motions.get(&trial.motion);
        motion.map(AsRef::as_ref).ok_or_else(|| ReproError::Motion {
            motion: trial.motion.clone(),
            folder: std::path::PathBuf::new(),
        })
    }

    /// Every cell, trial by trial.
    fn jobs(&self) -> Result<Vec<Job<'_>>, ReproError> {
        let mut jobs = Vec::new();
        for trial in &self.trials {
            let motion = self.motion(trial)?;
            for variant in &self.variants {
                for &coordinates in &self.coordinates {
                    for &knowledge in &self.knowledge {
                        let iterations = self.iterations;
                        jobs.push(Job {
                            trial,
                            motion,
                            variant,
                            coordinates,
                            knowledge,
                            iterations,
                        });
                    }
                }
            }
        }
        Ok(jobs)
    }
}

/// Runs what is not yet in the store, on as many threads as asked for, and returns all cells in the
/// order of the matrices. What several of them ask for is computed once.
///
/// Each cell runs on one thread: its time is that of one core, and neither it nor any other result
/// depends on the number of threads.
///
/// # Errors
/// As [`Matrix::check`], which comes first; [`ReproError::Io`] if a cell cannot be stored, and
/// [`ReproError::Threads`].
pub fn run<'a>(
    matrices: &'a [Matrix],
    store: &mut Store,
    threads: usize,
    observer: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Finished<'a>>, ReproError> {
    matrices.iter().try_for_each(Matrix::check)?;
    let mut jobs = Vec::new();
    for matrix in matrices {
        jobs.extend(matrix.jobs()?);
    }
    let keys: Vec<String> = jobs.iter().map(Job::key).collect();
    let mut seen = BTreeSet::new();
    let mut open: Vec<(&Job<'a>, &String)> = jobs
        .iter()
        .zip(&keys)
        .filter(|(_, key)| store.get(key).is_none() && seen.insert(key.as_str()))
        .collect();
    // Long ones first, so that no thread is left with one at the end.
    open.sort_by_key(|(job, _)| std::cmp::Reverse(work(job)));
    Queue::new(&open, store, observer).run(threads)?;
    let finished = jobs.iter().zip(&keys).filter_map(|(job, key)| {
        let Job { trial, variant, coordinates, knowledge, .. } = *job;
        let outcome = store.get(key)?.clone();
        Some(Finished { trial, variant, coordinates, knowledge, outcome })
    });
    Ok(finished.collect())
}

/// Frames, times iterations for what iterates.
fn work(job: &Job<'_>) -> usize {
    let rounds = if job.variant.reads("iterations") { job.limit().unwrap_or(100) } else { 1 };
    job.motion.take().frames() * rounds
}

/// The open cells, taken one by one by several threads.
struct Queue<'a, 'b> {
    open: &'a [(&'a Job<'b>, &'a String)],
    next: AtomicUsize,
    done: AtomicUsize,
    total: usize,
    store: Mutex<&'a mut Store>,
    observer: &'a (dyn Fn(Progress) + Sync),
}

impl<'a, 'b> Queue<'a, 'b> {
    fn new(
        open: &'a [(&'a Job<'b>, &'a String)],
        store: &'a mut Store,
        observer: &'a (dyn Fn(Progress) + Sync),
    ) -> Self {
        let total = open.iter().map(|(job, _)| work(job)).sum();
        let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
        Self { open, next, done, total, store: Mutex::new(store), observer }
    }

    /// Each thread has a pool of one of its own, in which methods that would use more find one.
    fn run(&self, threads: usize) -> Result<(), ReproError> {
        let threads = threads.clamp(1, self.open.len().max(1));
        let pools: Vec<ThreadPool> = (0..threads)
            .map(|_| ThreadPoolBuilder::new().num_threads(1).build())
            .collect::<Result<_, _>>()?;
        let ends: Vec<Result<(), ReproError>> = thread::scope(|scope| {
            let work = |pool| scope.spawn(move || self.work(pool));
            let workers: Vec<_> = pools.iter().map(work).collect();
            // A panic of a method is a broken invariant; it goes on as what it is.
            let join = |worker: thread::ScopedJoinHandle<'_, _>| {
                worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            workers.into_iter().map(join).collect()
        });
        ends.into_iter().collect()
    }

    fn work(&self, pool: &ThreadPool) -> Result<(), ReproError> {
        while let Some((job, key)) = self.open.get(self.next.fetch_add(1, Ordering::Relaxed)) {
            let outcome = pool.install(|| job.compute())?;
            let what = format!(
                "{} | {} | {} | {} | {}",
                job.trial.set,
                job.trial.name,
                job.variant.label(),
                job.coordinates,
                job.knowledge
            );
            let mut store = self.store.lock().unwrap_or_else(PoisonError::into_inner);
            store.add((*key).clone(), what, outcome)?;
            drop(store);
            let done = self.done.fetch_add(work(job), Ordering::Relaxed) + work(job);
            (self.observer)(Progress { done, total: self.total });
        }
        Ok(())
    }
}
