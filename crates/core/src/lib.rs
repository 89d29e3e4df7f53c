//! The engine of Lúč: rays traced on the CPU, as a pure function from a scene to pixels.
//!
//! **A scene** ([`scene::Scene`]) is plain data: shapes in one list per kind, materials, lights, a
//! camera. **A quality** ([`quality::Quality`]) holds every knob that trades accuracy for time.
//! **A frame** is what [`render::Renderer::frame`] makes of the two: the same bytes on any number of
//! threads, in debug and release.
//!
//! How a frame flows, in the order of the modules: [`scene`] → [`sim`] moves its smoke →
//! [`render`] prepares a stage → [`sample`] decides where to trace → [`trace`] finds what rays hit
//! (triangles of a [`mesh`] by its tree, [`bvh`]), with [`cull`] leaving out what
//! can't matter → [`shade`] lights it → [`post`] makes pixels, [`output`] files. [`math`] has
//! everything that would differ between machines, [`parallel`] spreads work over threads,
//! [`synth`] makes the sound, [`counters`] say what a frame did, [`features`] what an executable can do, and [`kernels`] open
//! each formula to one ray.
//!
//! ```
//! use luc_core::{quality::Quality, render::Renderer, scene::*};
//! use luc_core::math::Vec3;
//!
//! let red = Material { colour: Vec3::new(0.8, 0.1, 0.1), ..Material::default() };
//! let scene = Scene {
//!     spheres: vec![Sphere { centre: Vec3::ZERO, radius: 1.0, material: 0, blend: 0.0 }],
//!     materials: vec![red],
//!     lights: vec![Light { position: Vec3::new(3.0, 4.0, 5.0), colour: Vec3::splat(40.0), kind: LightKind::Point }],
//!     ..Scene::default()
//! };
//! let mut pixels = vec![0; 32 * 18];
//! Renderer::default().frame(&scene, 0, (32, 18), &Quality::named("high").unwrap(), &mut pixels);
//! assert!(pixels[9 * 32 + 16] >> 16 > 100, "the ball in the middle is red");
//! ```
// What is done once a frame, or seldom, is compiled smaller still in the size build.
#![cfg_attr(luc_size, feature(optimize_attribute))]
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod bvh;
pub mod counters;
pub mod cull;
pub mod features;
pub mod kernels;
pub mod math;
pub mod mesh;
pub mod output;
pub mod parallel;
pub mod plan;
pub mod post;
pub mod quality;
pub mod render;
pub mod sample;
pub mod scene;
pub mod shade;
pub mod sim;
pub mod study;
pub mod synth;
pub mod trace;
