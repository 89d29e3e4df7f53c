//! Shares of a capture: every N-th chunk of consecutive frames.

use std::ops::Range;

/// Share `index`, from 1 on, of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which share.
    pub index: u64,
    /// Of how many.
    pub count: u64,
}

impl Shard {
    /// Reads `I/N`.
    pub fn read(text: &str) -> Result<Shard, String> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Shard { index, count }),
            _ => Err(format!("a shard is I/N with I from 1 to N, such as 2/8, not '{text}'")),
        }
    }

    /// Its chunks of `length` frames, numbered over all shards.
    pub fn chunks(self, frames: &Range<u64>, length: u64) -> impl Iterator<Item = (u64, Range<u64>)> + use<> {
        let Range { start, end } = *frames;
        let count = (end - start).div_ceil(length);
        let own = (self.index - 1..count).step_by(self.count as usize);
        own.map(move |k| (k, start + k * length..(start + (k + 1) * length).min(end)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_read_and_faults_named() {
        assert_eq!(Shard::read("2/8"), Ok(Shard { index: 2, count: 8 }));
        for bad in ["", "2", "0/8", "9/8", "/", "1/0", "a/b", "-1/2", "1/2/3"] {
            assert!(Shard::read(bad).unwrap_err().contains("such as 2/8"), "{bad}");
        }
    }

    #[test]
    fn every_frame_is_in_one_chunk_of_one_shard() {
        for (frames, length, count) in [(5..100, 7, 3), (0..60, 60, 4), (3..4, 1, 1), (0..100, 1000, 2)] {
            let mut seen: Vec<(u64, Range<u64>)> =
                (1..=count).flat_map(|index| Shard { index, count }.chunks(&frames, length)).collect();
            seen.sort_by_key(|chunk| chunk.0);
            assert!(seen.iter().enumerate().all(|(i, chunk)| chunk.0 == i as u64), "{seen:?}");
            let joined: Vec<u64> = seen.into_iter().flat_map(|chunk| chunk.1).collect();
            assert_eq!(joined, frames.collect::<Vec<_>>());
        }
    }
}
