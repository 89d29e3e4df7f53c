//! Counts of what a frame did: the proof that only what is called for is computed.
//!
//! Without the feature `counters` the struct is empty and every call vanishes.

use crate::study::{Phase, Stopwatch, Study};

/// Declares the counters once: names for code, and words for people.
macro_rules! counters {
    ($($name:ident $words:literal,)*) => {
        /// What is counted.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(usize)]
        #[allow(missing_docs, reason = "the words in ALL say it")]
        pub enum Counter { $($name,)* }

        impl Counter {
            /// All counters in order, with what they count in words.
            pub const ALL: [(Counter, &str); [$($words,)*].len()] = [$((Counter::$name, $words),)*];

            /// Whether rays are counted, each once: those of rough mirrors are among the reflected ones.
            pub fn is_ray(self) -> bool {
                use Counter::*;
                matches!(self, PrimaryRays | ReflectedRays | RefractedRays | ScatterRays | ShadowRays | SmokeShadowRays)
            }
        }
    };
}

counters! {
    PrimaryRays "primary rays",
    ReflectedRays "reflected rays",
    RefractedRays "refracted rays",
    RoughRays "rays drawn by rough mirrors",
    ScatterRays "rays of diffuse bounces",
    ShadowRays "shadow rays",
    SoftShadowRays "rays of soft shadows",
    SphereTests "tests of spheres",
    PlaneTests "tests of planes",
    CylinderTests "tests of cylinders",
    EndlessTests "tests of cylinders without ends",
    ConeTests "tests of cones",
    TriangleTests "tests of triangles",
    VoxelTests "tests of voxel grids",
    VoxelSteps "cells and bricks walked",
    FieldTests "tests of fields",
    FieldSteps "steps to fields",
    FieldOcclusion "ambient occlusion by fields",
    FieldShadows "steps in soft shadows by fields",
    NodeVisits "nodes of trees",
    FacetTests "tests of facets",
    SmoothFacets "facets with interpolated normals",
    ImageLookups "look-ups in images",
    EmitterTests "tests of emitters",
    DiscTests "tests of discs",
    Glows "glows in the sky",
    ColouredShadows "shadow rays against glass",
    LightEvaluations "light evaluations",
    Phong "Phong highlights",
    CookTorrance "Cook-Torrance highlights",
    Ggx "GGX highlights",
    PlainLights "aims at plain lights",
    SpotLights "aims at spots",
    RectangleLights "aims at shining rectangles",
    FillLights "aims at fill lights",
    PointLights "evaluations of small lights",
    TextureLookups "texture lookups",
    Cells "cells of textures",
    Stripes "stripes of textures",
    Brick "bricks of textures",
    Scratches "scratches of textures",
    Bumps "bumps of normals",
    FogSegments "fog segments",
    SmokeCells "cells of smoke simulated",
    SmokeSwirled "cells of smoke swirled",
    SmokeShown "cells of smoke shown",
    SmokeMarched "places in smoke marched through",
    SmokeShadowRays "shadow rays from smoke",
    Beams "rays against beams",
    KnownSurfaces "known surfaces",
    Traced "pixels traced",
    Interpolated "pixels interpolated",
    Filled "pixels filled",
    EdgeSamples "edge samples",
    BloomPasses "bloom passes",
    Contrast "passes of contrast",
    Tint "passes of tint",
    Bloom "passes of narrow bloom",
    WideBloom "passes of wide bloom",
    Sharpness "passes of sharpness",
    Levels "passes of colour mapping",
    Fringes "passes of chromatic aberration",
    Edges "passes of edge detection",
    CellBorders "passes of the borders of cells",
    Lighten "passes of lightening",
    Tube "passes of the tube",
    Grain "passes of grain",
    OverlayPixels "overlay pixels",
    Measured "pixels measured",
}

/// A set of counts; sums are exact, so they do not depend on threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(not(feature = "counters"), derive(Default))]
pub struct Counters {
    #[cfg(feature = "counters")]
    counts: [u64; Counter::ALL.len()],
    #[cfg(feature = "split")]
    rays: u64,
    /// Where the time went, if a study wants to know.
    pub watch: Stopwatch,
}

// Nothing is counted, and nothing is carried along.
#[cfg(not(any(feature = "counters", feature = "split", feature = "study")))]
const _: () = assert!(size_of::<Counters>() == 0);

// Arrays over 32 have no default of their own.
#[cfg(feature = "counters")]
impl Default for Counters {
    fn default() -> Self {
        Self {
            counts: [0; Counter::ALL.len()],
            #[cfg(feature = "split")]
            rays: 0,
            watch: Stopwatch::default(),
        }
    }
}

impl Counters {
    /// Counts of nothing yet, at work in `phase`.
    #[inline(always)]
    pub fn start(study: &Study, phase: Phase) -> Self {
        Self { watch: Stopwatch::start(study, phase), ..Self::default() }
    }

    /// Adds `n` to a count.
    #[inline(always)]
    pub fn add(&mut self, counter: Counter, n: usize) {
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

    /// Adds `n` rays of any kind, besides what is counted for their kind.
    #[inline(always)]
    pub fn add_rays(&mut self, n: usize) {
        #[cfg(feature = "split")]
        {
            self.rays += n as u64;
        }
        let _ = n;
    }

    /// Rays of all kinds, with or without the feature `counters`; 0 without the feature `split`, which asks
    /// for them.
    pub fn rays(&self) -> u64 {
        #[cfg(feature = "split")]
        return self.rays;
        #[cfg(not(feature = "split"))]
        0
    }

    /// Adds all counts of `other`.
    pub fn merge(&mut self, other: &Counters) {
        #[cfg(feature = "counters")]
        for (a, b) in self.counts.iter_mut().zip(other.counts) {
            *a += b;
        }
        #[cfg(feature = "split")]
        {
            self.rays += other.rays;
        }
        self.watch.merge(&other.watch);
    }
}
