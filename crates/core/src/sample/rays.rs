//! Lists of rays on their way to samples, in packets of eight.

use crate::math::lanes::{F, U, V3};
use crate::trace::Rays8;

/// Eight rays and what their light is for.
#[derive(Clone, Copy, Default)]
pub struct Packet {
    /// The rays; directions are unit vectors.
    pub rays: Rays8,
    /// Factor on what the rays find.
    pub weight: V3,
    /// Width of the footprint per unit of distance.
    pub spread: F,
    /// Random bits, and how the rays came about: see [`super::scatter`].
    pub seed: U,
    /// Indices of the samples the rays belong to.
    pub samples: [u32; 8],
}

/// A list of rays. Lanes past its end hold other rays, which nobody asks for.
#[derive(Default)]
pub struct RayList {
    /// The packets, all full but perhaps the last.
    pub packets: Vec<Packet>,
    /// Number of rays.
    pub count: usize,
}

impl RayList {
    /// Removes all rays.
    pub fn clear(&mut self) {
        self.packets.clear();
        self.count = 0;
    }

    /// Appends one lane of `from` as a ray for `sample`.
    #[inline(never)]
    pub fn push(&mut self, from: &Packet, lane: usize, sample: u32) {
        let at = self.count & 7;
        if at == 0 {
            self.packets.push(*from);
        }
        if let Some(Packet { rays, weight, spread, seed, samples }) = self.packets.last_mut() {
            rays.origin.set_lane(at, from.rays.origin.lane(lane));
            rays.direction.set_lane(at, from.rays.direction.lane(lane));
            weight.set_lane(at, from.weight.lane(lane));
            spread.as_mut_array()[at] = from.spread.as_array()[lane & 7];
            seed.as_mut_array()[at] = from.seed.as_array()[lane & 7];
            samples[at] = sample;
        }
        self.count += 1;
    }

    /// Samples that the rays of packet `k` belong to, without the lanes past the list's end.
    pub fn owners(&self, k: usize) -> &[u32] {
        &self.packets[k].samples[..(self.count - k * 8).min(8)]
    }
}
