//! Our tree over triangles beside those of others: the same mesh, the same rays.
//!
//! Before anything is timed the hits are compared. Primary rays look at a bumpy knot in tiles of 4x2, about
//! half of them hit; diffuse and shadow rays begin at those hits, off the surface.

use crate::rays::{self, Kind, Rays};
use crate::turns::medians;
use crate::{embree, knot, ours, peers};
use glam::Vec3A;

/// A tracer that has built its tree.
pub trait Tracer {
    /// Distance of each ray's nearest hit, infinite for none; or, if any will do, -1 for a hit.
    fn trace(&self, rays: &Rays, out: &mut [f32]);
}

/// What builds a tracer's tree.
pub type Build = Box<dyn Fn(&[[Vec3A; 3]]) -> Box<dyn Tracer>>;

/// A tracer to be.
pub struct Peer {
    pub name: String,
    pub group: Group,
    pub build: Build,
}

/// What ours is held against: the best of each group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// In Rust.
    Rust,
    #[cfg_attr(not(feature = "tinybvh"), allow(dead_code, reason = "without that feature"))]
    /// In C++, by a crate that compiles it.
    Tinybvh,
    /// A library that is here, asked ray by ray.
    EmbreeSingle,
    /// Asked in packets.
    EmbreeEights,
}

/// The groups with what their rows of ratios say.
const GROUPS: [(Group, &str); 4] = [
    (Group::Rust, "over the best in Rust"),
    (Group::Tinybvh, "over tinybvh"),
    (Group::EmbreeSingle, "over Embree, single"),
    (Group::EmbreeEights, "over Embree, eights"),
];

impl Peer {
    fn new(name: &str, group: Group, build: fn(&[[Vec3A; 3]]) -> Box<dyn Tracer>) -> Self {
        Self { name: name.into(), group, build: Box::new(build) }
    }
}

/// Passes of tracing and of building.
const PASSES: usize = 9;
const BUILDS: usize = 5;

/// Ours, then those of other Rust crates.
fn crates() -> Vec<Peer> {
    let crates = [
        Peer::new("Lúč", Group::Rust, ours::build),
        Peer::new("obvhs, eight wide", Group::Rust, peers::obvhs_wide),
        Peer::new("obvhs, binary", Group::Rust, peers::obvhs_binary),
        Peer::new("parry3d", Group::Rust, peers::parry),
        Peer::new("bvh", Group::Rust, peers::bvh),
        #[cfg(feature = "tinybvh")]
        Peer::new("tinybvh, eight wide", Group::Tinybvh, crate::tinybvh::build),
    ];
    crates.into()
}

/// The share of rays of which two tracers tell another hit; an error unless it is very small, as about edges
/// they may differ.
fn compare(name: &str, kind: Kind, ours: &[f32], theirs: &[f32]) -> Result<f64, String> {
    let same = |(a, b): (&f32, &f32)| a == b || (a - b).abs() <= 2e-4 * a.abs().max(1.0);
    let differ = ours.iter().zip(theirs).filter(|&pair| !same(pair)).count();
    let share = differ as f64 / ours.len() as f64;
    match share < 1e-3 {
        true => Ok(share),
        false => Err(format!("{name} finds other hits for {differ} of {} {kind:?} rays", ours.len())),
    }
}

/// What is known of one tracer: time of building, ms, millions of rays a second by kind, and the greatest share
/// of other hits.
#[derive(Clone, Default)]
struct Row {
    build: f64,
    speed: [f64; 3],
    differ: f64,
}

/// Measures all tracers on one mesh.
fn measure(peers: &[Peer], triangles: &[[Vec3A; 3]], side: usize) -> Result<Vec<Row>, String> {
    let mut rows = vec![Row::default(); peers.len()];
    let mut works: Vec<Box<dyn FnMut()>> = Vec::new();
    for peer in peers {
        works.push(Box::new(|| drop((peer.build)(triangles))));
    }
    for (row, time) in rows.iter_mut().zip(medians(BUILDS, &mut works)) {
        row.build = time;
    }
    drop(works);
    let tracers: Vec<Box<dyn Tracer>> = peers.iter().map(|peer| (peer.build)(triangles)).collect();
    let primary = rays::primary(side);
    let mut hits = vec![0.0; primary.len()];
    tracers[0].trace(&primary, &mut hits);
    let lists = [rays::diffuse(&primary, &hits), rays::shadow(&primary, &hits)];
    for (k, list) in std::iter::once(primary).chain(lists).enumerate() {
        let (mut truth, mut out) = (vec![0.0; list.len()], vec![0.0; list.len()]);
        tracers[0].trace(&list, &mut truth);
        for ((tracer, peer), row) in tracers.iter().zip(peers).zip(&mut rows) {
            tracer.trace(&list, &mut out);
            row.differ = row.differ.max(compare(&peer.name, list.kind, &truth, &out)?);
        }
        let mut works: Vec<Box<dyn FnMut()>> = Vec::new();
        for tracer in &tracers {
            let (mut out, list) = (out.clone(), &list);
            works.push(Box::new(move || tracer.trace(list, &mut out)));
        }
        for (row, time) in rows.iter_mut().zip(medians(PASSES, &mut works)) {
            row.speed[k] = list.len() as f64 / time / 1e3;
        }
    }
    Ok(rows)
}

/// Prints ours over the best of each group that is here.
fn ratios(peers: &[Peer], rows: &[Row]) {
    for (group, title) in GROUPS {
        let others = || peers.iter().zip(rows).skip(1).filter(|(peer, _)| peer.group == group);
        if others().next().is_none() {
            continue;
        }
        let build = rows[0].build / others().fold(f64::INFINITY, |best, (_, row)| best.min(row.build));
        let best = |k: usize| others().fold(0.0, |best: f64, (_, row)| best.max(row.speed[k]));
        let [a, b, c] = [0, 1, 2].map(|k| rows[0].speed[k] / best(k));
        println!("| | **{title}** | {build:.2} | {a:.2} | {b:.2} | {c:.2} |");
    }
}

/// A number with commas between its thousands.
fn grouped(n: usize) -> String {
    if n < 1000 { n.to_string() } else { format!("{},{:03}", grouped(n / 1000), n % 1000) }
}

/// Prints the table.
pub fn run(quick: bool) -> Result<(), String> {
    let (counts, side) = if quick { (&[10_000][..], 128) } else { (&[10_000, 100_000, 1_000_000][..], 512) };
    let embree = embree::peers()?;
    let missing = embree.is_empty();
    let peers: Vec<Peer> = crates().into_iter().chain(embree).collect();
    let mut differ = 0.0_f64;
    println!("| triangles | tracer | build, ms | primary | diffuse | shadow |");
    println!("|---:|---|---:|---:|---:|---:|");
    for &count in counts {
        let (triangles, _) = knot::knot(count);
        let triangles: Vec<[Vec3A; 3]> =
            triangles.iter().map(|t| t.map(|p| Vec3A::from_array(p.to_array()))).collect();
        let rows = measure(&peers, &triangles, side)?;
        let mut size = grouped(triangles.len());
        for (peer, row) in peers.iter().zip(&rows) {
            let (name, [a, b, c]) = (&peer.name, row.speed);
            let (build, digits) = (row.build, usize::from(row.build < 100.0));
            println!("| {size} | {name} | {build:.digits$} | {a:.1} | {b:.1} | {c:.1} |");
            size.clear();
            differ = differ.max(row.differ);
        }
        ratios(&peers, &rows);
    }
    let others = match differ {
        0.0 => "no ray".into(),
        _ => format!("at most one ray in {}", grouped((1.0 / differ) as usize)),
    };
    println!("\nMillions of rays a second; of each kind {others} hits otherwise than ours.");
    if missing {
        println!("\n{}", embree::MISSING);
    }
    Ok(())
}
