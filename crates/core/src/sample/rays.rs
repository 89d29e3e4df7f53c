//! Lists of rays on their way to samples, in packets of eight.

use crate::math::lanes::{F, U, V3, splat, splat_u};
use crate::trace::Rays8;

/// Eight rays and what their light is for.
#[derive(Clone, Copy)]
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

/// A list of rays. Lanes past its end repeat another ray.
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

    /// Appends a ray: one lane of a packet.
    #[inline(never)]
    pub fn push(&mut self, lane: usize, from: &Packet, sample: u32) {
        let (origin, direction, weight) =
            (from.rays.origin.lane(lane), from.rays.direction.lane(lane), from.weight.lane(lane));
        let (spread, seed) = (from.spread.as_array()[lane], from.seed.as_array()[lane]);
        let at = self.count & 7;
        if at == 0 {
            self.packets.push(Packet {
                rays: Rays8 { origin: V3::splat(origin), direction: V3::splat(direction) },
                weight: V3::splat(weight),
                spread: splat(spread),
                seed: splat_u(seed),
                samples: [sample; 8],
            });
        } else if let Some(packet) = self.packets.last_mut() {
            packet.rays.origin.set_lane(at, origin);
            packet.rays.direction.set_lane(at, direction);
            packet.weight.set_lane(at, weight);
            packet.spread.as_mut_array()[at] = spread;
            packet.seed.as_mut_array()[at] = seed;
            packet.samples[at] = sample;
        }
        self.count += 1;
    }

    /// Samples that the rays of packet `k` belong to, without the lanes past the list's end.
    pub fn owners(&self, k: usize) -> &[u32] {
        &self.packets[k].samples[..(self.count - k * 8).min(8)]
    }
}
