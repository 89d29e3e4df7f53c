//! Values of the lab's options.

/// A size such as 1280x720.
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str, most: u32| text.parse().ok().filter(|n| (1..=most).contains(n));
    let sides = text.split_once('x').and_then(|(w, h)| Some((side(w, 7680)?, side(h, 4320)?)));
    sides.ok_or_else(|| {
        format!("a size is a width and height from 1x1 to 7680x4320, such as 1280x720, not '{text}'")
    })
}

/// A preset by its name.
pub fn preset(text: &str) -> Result<luc_core::quality::Quality, String> {
    let names = || luc_core::quality::Quality::PRESETS.map(|p| p.0).join(", ");
    luc_core::quality::Quality::named(text)
        .ok_or_else(|| format!("a quality is one of {}, not '{text}'", names()))
}

/// A whole number from 1 on.
pub fn count(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|n| *n >= 1).ok_or_else(|| format!("a whole number from 1 on, not '{text}'"))
}

/// The index of a part of the show by its name.
pub fn part(text: &str) -> Result<usize, String> {
    let names = || luc::show::PARTS.iter().map(|p| p.name).collect::<Vec<_>>().join(", ");
    let found = luc::show::PARTS.iter().position(|p| p.name == text);
    found.ok_or_else(|| format!("a part is one of {}, not '{text}'", names()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_and_faults_named() {
        assert_eq!(size("480x270"), Ok((480, 270)));
        for bad in ["", "480", "0x9", "9x0", "7681x1", "1x4321", "ax3", "3x3x3", "-1x3"] {
            assert!(size(bad).unwrap_err().contains("such as 1280x720"), "{bad}");
        }
    }

    #[test]
    fn presets_are_named() {
        assert!(preset("high").is_ok());
        assert!(preset("best").unwrap_err().contains("draft, low, medium"));
    }
}
