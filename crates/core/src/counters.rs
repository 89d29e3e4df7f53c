//! Counts of what a frame did: the proof that only what is called for is computed.
//!
//! Without the feature `counters` the struct is empty and every call vanishes.

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
#[allow(missing_docs)]
pub enum Counter {
    PrimaryRays,
    ReflectedRays,
    RefractedRays,
    ShadowRays,
    ShapeTests,
    LightEvaluations,
    KnownSurfaces,
    Traced,
    Interpolated,
    Filled,
    EdgeSamples,
    FogSegments,
}

/// Number of counters.
pub const COUNTERS: usize = 12;

/// Names of the counters, in order.
pub const NAMES: [&str; COUNTERS] = [
    "primary rays",
    "reflected rays",
    "refracted rays",
    "shadow rays",
    "shape tests",
    "light evaluations",
    "known surfaces",
    "pixels traced",
    "pixels interpolated",
    "pixels filled",
    "edge samples",
    "fog segments",
];

/// A set of counts; sums are exact, so they do not depend on threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    #[cfg(feature = "counters")]
    counts: [u64; COUNTERS],
}

impl Counters {
    /// Adds `n` to a count.
    #[inline(always)]
    pub fn add(&mut self, counter: Counter, n: u32) {
        #[cfg(feature = "counters")]
        {
            self.counts[counter as usize] += n as u64;
        }
        let _ = (counter, n);
    }

    /// A count; 0 without the feature.
    pub fn get(&self, counter: Counter) -> u64 {
        #[cfg(feature = "counters")]
        return self.counts[counter as usize];
        #[cfg(not(feature = "counters"))]
        {
            let _ = counter;
            0
        }
    }

    /// Adds all counts of `other`.
    pub fn merge(&mut self, other: &Counters) {
        #[cfg(feature = "counters")]
        for (a, b) in self.counts.iter_mut().zip(other.counts) {
            *a += b;
        }
        let _ = other;
    }
}
