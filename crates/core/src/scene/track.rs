//! Tracks: a value over time as sorted keys, each with the way to the next one.
//!
//! Same semantics as GNU Rocket's tracks: before the first key its value holds, after the last
//! key too, and the key at the left decides how its interval is crossed.

/// How the interval that begins at a key is crossed, for x from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ease {
    /// Hold the key's value.
    Step,
    /// x
    Linear,
    /// x² (3 - 2x)
    Smooth,
    /// x²
    Ramp,
}

/// A value at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// When, in the track's own unit (the show uses beats); ascending from key to key.
    pub time: f32,
    /// What.
    pub value: f32,
    /// How to go on.
    pub ease: Ease,
}

/// The value of the track `keys` at `time`; 0 for an empty track.
pub fn track(keys: &[Key], time: f32) -> f32 {
    let after = keys.iter().position(|k| k.time > time).unwrap_or(keys.len());
    let Some(key) = keys.get(after.saturating_sub(1)) else { return 0.0 };
    let Some(next) = keys.get(after) else { return key.value };
    if after == 0 {
        return key.value;
    }
    let x = (time - key.time) / (next.time - key.time);
    let x = match key.ease {
        Ease::Step => 0.0,
        Ease::Linear => x,
        Ease::Smooth => x * x * (3.0 - 2.0 * x),
        Ease::Ramp => x * x,
    };
    key.value + (next.value - key.value) * x
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYS: [Key; 5] = [
        Key { time: 1.0, value: 2.0, ease: Ease::Step },
        Key { time: 2.0, value: 4.0, ease: Ease::Linear },
        Key { time: 4.0, value: 8.0, ease: Ease::Smooth },
        Key { time: 5.0, value: 0.0, ease: Ease::Ramp },
        Key { time: 6.0, value: 1.0, ease: Ease::Linear },
    ];

    #[test]
    fn holds_before_and_after() {
        assert_eq!(track(&KEYS, -3.0), 2.0);
        assert_eq!(track(&KEYS, 60.0), 1.0);
        assert_eq!(track(&[], 1.0), 0.0);
    }

    #[test]
    fn each_ease_has_its_middle() {
        assert_eq!(track(&KEYS, 1.5), 2.0);
        assert_eq!(track(&KEYS, 3.0), 6.0);
        assert_eq!(track(&KEYS, 4.5), 4.0);
        assert_eq!(track(&KEYS, 4.25), 8.0 - 8.0 * 0.15625);
        assert_eq!(track(&KEYS, 5.5), 0.25);
    }

    #[test]
    fn passes_through_every_key() {
        for k in KEYS {
            assert_eq!(track(&KEYS, k.time), k.value);
        }
    }
}
