//! What only studies of the method ask for: parts of it taken away, and time told by phase.
//!
//! Without the feature `study` the structs are empty and every answer is a constant, so the intro's
//! compiler drops the questions. The clock comes from outside: this crate has none.

/// What a frame's time goes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum Phase {
    /// Deciding where to trace; lists and culling.
    Sampling,
    /// A step of smoke, and making it ready for rays.
    SmokeStep,
    /// Rays through smoke.
    SmokeRender,
    /// Finding hits and shadows.
    Tracing,
    /// Surfaces and light at the samples.
    Shading,
    /// Pixels between samples, with known surfaces.
    Filling,
    /// Bloom.
    Bloom,
    /// Display curve, grade and grain to 0RGB.
    Finishing,
}

impl Phase {
    /// All phases in order, with their names.
    pub const ALL: [(Phase, &str); 8] = [
        (Phase::Sampling, "sampling"),
        (Phase::SmokeStep, "smoke step"),
        (Phase::SmokeRender, "smoke render"),
        (Phase::Tracing, "tracing"),
        (Phase::Shading, "shading"),
        (Phase::Filling, "filling"),
        (Phase::Bloom, "bloom"),
        (Phase::Finishing, "output"),
    ];
}

/// A function that tells the time, ns.
#[derive(Clone, Copy, Debug)]
pub struct Clock(pub fn() -> u64);

impl PartialEq for Clock {
    /// Telling the time changes no picture.
    fn eq(&self, _: &Clock) -> bool {
        true
    }
}

/// Time by phase on one thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stopwatch {
    #[cfg(feature = "study")]
    clock: Option<Clock>,
    #[cfg(feature = "study")]
    running: Option<(Phase, u64)>,
    #[cfg(feature = "study")]
    spent: [u64; Phase::ALL.len()],
}

impl PartialEq for Stopwatch {
    /// Times differ from run to run and mean nothing for what was done.
    fn eq(&self, _: &Stopwatch) -> bool {
        true
    }
}

impl Eq for Stopwatch {}

impl Stopwatch {
    /// A stopwatch that runs in `phase` if the study has a clock.
    #[inline(always)]
    pub fn start(study: &Study, phase: Phase) -> Self {
        let mut watch = Self::default();
        #[cfg(feature = "study")]
        {
            watch.clock = study.clock;
        }
        let _ = study;
        watch.enter(phase);
        watch
    }

    /// Ends the phase it runs in and begins another.
    #[inline(always)]
    pub fn enter(&mut self, phase: Phase) {
        #[cfg(feature = "study")]
        if let Some(Clock(clock)) = self.clock {
            let now = clock();
            if let Some((phase, since)) = self.running {
                self.spent[phase as usize] += now - since;
            }
            self.running = Some((phase, now));
        }
        let _ = phase;
    }

    /// Ends the phase it runs in.
    #[inline(always)]
    pub fn stop(&mut self) {
        #[cfg(feature = "study")]
        if let Some((phase, _)) = self.running {
            self.enter(phase);
            self.running = None;
        }
    }

    /// Time spent in a phase, in the clock's unit; 0 without the feature.
    pub fn spent(&self, phase: Phase) -> u64 {
        #[cfg(feature = "study")]
        return self.spent[phase as usize];
        #[cfg(not(feature = "study"))]
        {
            let _ = phase;
            0
        }
    }

    /// Adds the times of another.
    pub fn merge(&mut self, other: &Stopwatch) {
        #[cfg(feature = "study")]
        for (a, b) in self.spent.iter_mut().zip(other.spent) {
            *a += b;
        }
        let _ = other;
    }
}

/// How a frame departs from the show's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Study {
    /// Whether cells have a sample in their centre; without it equal signatures at the corners suffice.
    #[cfg(feature = "study")]
    pub centre: bool,
    /// Share of a field's value that a marching ray advances by: over 1 it may pass through bodies.
    #[cfg(feature = "study")]
    pub pace: f32,
    /// Octaves of the bloom, 2 to 4.
    #[cfg(feature = "study")]
    pub octaves: usize,
    /// Tells the time, if it is wanted.
    #[cfg(feature = "study")]
    pub clock: Option<Clock>,
}

impl Study {
    /// The show's method.
    pub const NONE: Study = Study {
        #[cfg(feature = "study")]
        centre: true,
        #[cfg(feature = "study")]
        pace: 1.0,
        #[cfg(feature = "study")]
        octaves: 4,
        #[cfg(feature = "study")]
        clock: None,
    };

    /// Whether cells have a sample in their centre.
    #[inline(always)]
    pub fn centre(&self) -> bool {
        #[cfg(feature = "study")]
        return self.centre;
        #[cfg(not(feature = "study"))]
        true
    }

    /// Factor on the steps of marching rays, unless it is 1.
    #[inline(always)]
    pub fn pace(&self) -> Option<f32> {
        #[cfg(feature = "study")]
        return (self.pace != 1.0).then_some(self.pace);
        #[cfg(not(feature = "study"))]
        None
    }

    /// Octaves of the bloom, of `all`.
    #[inline(always)]
    pub fn octaves(&self, all: usize) -> usize {
        #[cfg(feature = "study")]
        return self.octaves.clamp(2, all);
        #[cfg(not(feature = "study"))]
        all
    }
}
