//! The quality ladder: every knob that trades accuracy for time, as six named presets.

/// Everything that trades accuracy for time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Side of the coarsest sampling block, px.
    pub block: u32,
}

impl Quality {
    /// The presets from fastest to most exact.
    pub const PRESETS: [(&str, Quality); 6] = [
        ("draft", Quality { block: 32 }),
        ("low", Quality { block: 32 }),
        ("medium", Quality { block: 16 }),
        ("high", Quality { block: 8 }),
        ("ultra", Quality { block: 4 }),
        ("reference", Quality { block: 1 }),
    ];

    /// Index of the preset that `--frame` and the tests use unless told otherwise.
    pub const DEFAULT: usize = 3;
}
