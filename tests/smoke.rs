//! Smoke in frames: the same in mirrors and behind clear panes as seen straight, dark on what lies behind it,
//! and however one comes to a frame, that frame.
//!
//! Set `LUC_TELL=1` and run with `--nocapture` to see the figures, not only whether they hold.
mod support;

use luc::show;
use luc_core::counters::Counter;
use luc_core::math::Vec3;
use luc_core::math::scalar::exp;
use luc_core::plan::Plan;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::{
    Air, Background, Camera, Cylinder, Edit, Grade, Light, LightKind, Material, Plane, Rules, Scene, Smoke,
    Sphere, Stop, Triangle, Voxels,
};
use support::picture::{self, Picture, channels, distance, psnr};
use support::{golden, luc, run};

const SIZE: (u32, u32) = (160, 90);

/// Side of a cell of air, and of the voxels.
const CELL: f32 = 0.1;

/// A lump with a hole, to the right of its middle.
fn lump(step: u32, figure: &mut Voxels) {
    figure.reset(RULES.lo, CELL, RULES.size);
    if step <= 20 {
        figure.edit(Edit::Overwrite(Voxels::SMOKE), [5, 2, 4], [13, 6, 12]);
        figure.edit(Edit::Overwrite(Voxels::EMPTY), [7, 0, 7], [10, 6, 10]);
    }
}

static RULES: Rules = Rules {
    lo: Vec3::new(2.2, 0.2, -1.8),
    cell: CELL,
    size: [16, 16, 16],
    air: Air { density: 1.5, lift: 3.0, wind: Vec3::new(0.6, 0.0, 0.2), fade: 0.1, ..Air::DEFAULT }
        .motion(CELL),
    lamps: [Vec3::new(6.0, 3.0, -4.0), Vec3::new(-1.0, 5.0, 4.0)],
    extinction: 5.0,
    phase: [0.6, 0.6, -0.3],
    gain: 0.3,
    ambient: Vec3::new(0.05, 0.04, 0.06),
    glow: Vec3::new(0.05, 0.01, 0.0),
    ..Rules::new(lump)
};

/// All of its box is smoke, and stays it.
fn slab(_: u32, figure: &mut Voxels) {
    figure.reset(SLAB.lo, CELL, SLAB.size);
    figure.edit_all(Edit::Overwrite(Voxels::SMOKE));
}

static SLAB: Rules = Rules {
    lo: Vec3::new(-0.8, 1.5, -0.8),
    cell: CELL,
    size: [16, 8, 16],
    lamps: [Vec3::new(0.0, 8.0, 0.0), Vec3::new(9.0, 9.0, 9.0)],
    extinction: 2.0,
    air: Air { density: 0.6, ..Air::DEFAULT }.motion(CELL),
    ..Rules::new(slab)
};

/// The lump, on which bodies cast shadows.
static SHADED: Rules = Rules { shaded: true, ..RULES };

/// The lump in the evening, straight ahead.
fn scene() -> Scene {
    const STOPS: &[Stop] = &[
        Stop { y: -1.0, colour: Vec3::new(0.02, 0.02, 0.05) },
        Stop { y: 0.1, colour: Vec3::new(0.5, 0.2, 0.1) },
        Stop { y: 1.0, colour: Vec3::new(0.05, 0.1, 0.4) },
    ];
    let light = |position, colour| Light { position, colour, kind: LightKind::Point };
    Scene {
        camera: Camera {
            position: Vec3::new(-3.0, 1.0, 5.0),
            target: Vec3::new(0.0, 1.0, 2.0),
            roll: 0.0,
            fov: 0.4,
        },
        background: Background { stops: STOPS.to_vec(), ..Background::default() },
        lights: vec![
            light(RULES.lamps[0], Vec3::new(60.0, 30.0, 10.0)),
            light(RULES.lamps[1], Vec3::new(10.0, 10.0, 30.0)),
        ],
        smoke: Some(Smoke { rules: &RULES, steps: 30, behind: 0.25 }),
        grade: Grade { grain: 0.0, ..Grade::DEFAULT },
        ..Scene::default()
    }
}

/// Every pixel by one ray, in steps of a share of a cell.
fn exact(smoke: f32) -> Quality {
    Quality { smoke, edge_samples: 0, ..Quality::named("high").unwrap().every_pixel() }
}

fn draw(scene: &Scene, quality: &Quality) -> Picture {
    let (pixels, _) = picture::draw(scene, SIZE, quality);
    Picture { width: SIZE.0, height: SIZE.1, pixels }
}

/// Greatest difference of a channel, in steps of 1/255, and that of all in dB.
fn worst(a: &Picture, b: &Picture) -> (i32, f64) {
    let found = a.pixels.iter().zip(&b.pixels).map(|(&a, &b)| distance(a, b)).max().unwrap_or(0);
    let db = psnr(&a.pixels, &b.pixels);
    if std::env::var_os("LUC_TELL").is_some() {
        println!("{found} of 255, {db:.1} dB");
    }
    (found, db)
}

/// The picture, left and right changed.
fn turned(picture: &Picture) -> Picture {
    let rows = picture.pixels.chunks(picture.width as usize);
    Picture { pixels: rows.flat_map(|row| row.iter().rev().copied()).collect(), ..*picture }
}

#[test]
fn a_mirror_shows_what_a_camera_behind_it_would_see() {
    let straight = scene();
    let mut mirrored = scene();
    mirrored.camera.position.x = 3.0;
    let plane = Plane { point: Vec3::ZERO, normal: Vec3::X, reach: f32::INFINITY, material: 0 };
    mirrored.planes.push(plane);
    let mirror = Material { diffuse: 0.0, f0: Vec3::ONE, reflection: 1.0, ..Material::default() };
    mirrored.materials.push(mirror);
    // Rays of mirrors take steps three times as long.
    for (pace, most, least) in [(0.1, 1, 60.0), (1.0, 20, 40.0)] {
        let quality = exact(pace);
        let (seen, clear) = (draw(&straight, &quality), draw(&Scene { smoke: None, ..scene() }, &quality));
        assert!(worst(&seen, &clear).0 > 80, "there is smoke to see");
        let (off, db) = worst(&seen, &turned(&draw(&mirrored, &quality)));
        assert!(off <= most && db > least, "{off} of 255 off, {db:.1} dB, with steps of {pace} cells");
    }
}

#[test]
fn a_clear_pane_before_or_in_smoke_changes_nothing() {
    let clear = Material { diffuse: 0.0, transparency: 1.0, shadow: Vec3::ONE, ..Material::default() };
    // Rays behind glass take steps three times as long.
    for (pace, most, least) in [(0.1, 1, 60.0), (1.0, 20, 40.0)] {
        let quality = exact(pace);
        let seen = draw(&scene(), &quality);
        // Half way, and through the middle of the lump.
        for share in [0.5, 1.0] {
            let mut behind = scene();
            let eye = behind.camera.position;
            let way = Vec3::new(3.0, 1.0, -1.0) - eye;
            let base = eye + way * share;
            let axis = luc_core::math::normalize(way);
            behind.cylinders.push(Cylinder { base, axis, radius: 9.0, length: 0.01, material: 0 });
            behind.materials.push(clear);
            let (off, db) = worst(&seen, &draw(&behind, &quality));
            let place = format!("steps of {pace} cells, pane at {share} of the way");
            assert!(off <= most && db > least, "{off} of 255 off, {db:.1} dB, {place}");
        }
    }
}

#[test]
fn smoke_is_sampled_coarsely_and_bodies_in_it_have_no_halo() {
    // A bar before the smoke, a ball in it and one behind it.
    let mut bodies = scene();
    let ball = |centre| Sphere { centre, radius: 0.35, material: 0, blend: 0.0 };
    bodies.spheres = vec![ball(Vec3::new(2.9, 1.1, -0.9)), ball(Vec3::new(4.6, 1.0, -1.9))];
    bodies.cylinders.push(Cylinder::between(Vec3::new(1.0, 0.4, 0.2), Vec3::new(2.4, 1.7, 1.2), 0.05, 0));
    bodies.materials.push(Material { colour: Vec3::new(0.1, 0.3, 0.2), ..Material::default() });
    let (quality, size) = (Quality::named("high").unwrap(), (640, 360));
    let draw = |scene: &Scene, quality: &Quality| {
        let (mut renderer, mut pixels) = (Renderer::default(), vec![0; (size.0 * size.1) as usize]);
        renderer.frame(scene, 0, size, quality, &mut pixels);
        (pixels, renderer.counters)
    };
    // Smoke alone takes a ray for 28 pixels.
    let (_, counters) = draw(&scene(), &quality);
    let rays = counters.get(Counter::PrimaryRays) as f64 / f64::from(size.0 * size.1);
    let (adaptive, _) = draw(&bodies, &quality);
    let (full, _) = draw(&bodies, &quality.every_pixel());
    // Up to 7 px from edges, and away from them: how far it is off at most, in sum, and over how many pixels.
    let (clear, _) = draw(&Scene { smoke: None, ..bodies.clone() }, &quality.every_pixel());
    let is_edge =
        |i: usize| distance(clear[i], clear[i + 1]).max(distance(clear[i], clear[i + size.0 as usize])) > 24;
    let (width, mut near, mut far) = (size.0 as usize, (0, 0, 0), (0, 0, 0));
    for (y, x) in (8..size.1 as usize - 8).flat_map(|y| (8..width - 8).map(move |x| (y, x))) {
        let i = y * width + x;
        let off = distance(adaptive[i], full[i]);
        let is_near = (0..225).any(|k| is_edge((y + k / 15 - 7) * width + x + k % 15 - 7));
        let found = if is_near { &mut near } else { &mut far };
        *found = (found.0.max(off), found.1 + off, found.2 + 1);
    }
    let mean = |found: (i32, i32, i32)| f64::from(found.1) / f64::from(found.2);
    let figures =
        format!("{rays:.3} rays a pixel, off by {near:?} {:.3}, {far:?} {:.3}", mean(near), mean(far));
    if std::env::var_os("LUC_TELL").is_some() {
        println!("{figures}");
    }
    assert!(rays < 0.05 && near.0 <= 30 && mean(near) < 0.6 && far.0 <= 20 && mean(far) < 0.15, "{figures}");
}

#[test]
fn smoke_that_is_not_there_changes_no_byte() {
    let quality = Quality::named("high").unwrap().every_pixel();
    let mut before = scene();
    before.smoke = Some(Smoke { rules: &RULES, steps: 0, behind: 0.0 });
    before.spheres.push(Sphere { centre: Vec3::new(3.0, 0.6, -1.0), radius: 0.4, material: 0, blend: 0.0 });
    before.materials.push(Material { colour: Vec3::ONE, ..Material::default() });
    let without = Scene { smoke: None, ..before.clone() };
    assert_eq!(draw(&without, &quality).compare(&draw(&before, &quality)), None);
}

#[test]
fn the_shadow_of_even_smoke_is_that_of_its_depth() {
    // A lamp high over the slab, which hides itself from the eye under it.
    let light =
        |colour| Light { position: SLAB.lamps[0], colour: Vec3::splat(colour), kind: LightKind::Point };
    let dark = Light { position: SLAB.lamps[1], colour: Vec3::ZERO, kind: LightKind::Point };
    let mut floor = Scene { grade: scene().grade, lights: vec![light(60.0), dark], ..Scene::default() };
    floor.camera = Camera { position: Vec3::new(0.0, 1.2, 2.0), target: Vec3::ZERO, ..Camera::default() };
    floor.planes.push(Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 50.0, material: 0 });
    floor.materials.push(Material { colour: Vec3::splat(0.8), ..Material::default() });
    let quality = exact(1.0);
    let middle =
        |scene: &Scene| channels(draw(scene, &quality).pixels[(SIZE.0 * SIZE.1 + SIZE.0) as usize / 2]);
    let open = middle(&floor);
    // Density 0.6 and extinction 2 over 0.8 units.
    let through = exp(-0.6 * 2.0 * 0.8);
    let dimmed = middle(&Scene { lights: vec![light(60.0 * through), dark], ..floor.clone() });
    let shaded = middle(&Scene { smoke: Some(Smoke { rules: &SLAB, steps: 60, behind: 0.0 }), ..floor });
    for k in 0..3 {
        let off = (shaded[k] - dimmed[k]).abs();
        assert!(off <= 4 && open[k] > dimmed[k] + 30, "{shaded:?}, not {dimmed:?}, of {open:?}");
    }
}

#[test]
fn bodies_cast_shadows_on_smoke_that_asks_for_them() {
    let quality = exact(1.0);
    let mut open = scene();
    open.smoke = open.smoke.map(|smoke| Smoke { rules: &SHADED, ..smoke });
    let frame = |scene: &Scene| {
        let (mut renderer, mut pixels) = (Renderer::default(), vec![0; (SIZE.0 * SIZE.1) as usize]);
        renderer.frame(scene, 0, SIZE, &quality, &mut pixels);
        let rays = renderer.counters.get(Counter::SmokeShadowRays);
        assert_eq!(rays > 0, Plan::of(scene, &quality).names(Counter::SmokeShadowRays));
        (Picture { width: SIZE.0, height: SIZE.1, pixels }, rays)
    };
    let (lit, rays) = frame(&open);
    // Where there are no bodies, each lamp is asked for from each place, in vain.
    let mut renderer = Renderer::default();
    renderer.frame(&open, 0, SIZE, &quality, &mut vec![0; (SIZE.0 * SIZE.1) as usize]);
    assert_eq!(rays, 2 * renderer.counters.get(Counter::SmokeMarched));
    assert_eq!(lit.compare(&draw(&scene(), &quality)), None, "no bodies, no shadow");
    // A ball around a lamp takes its light away, to the bit.
    let around = |k: usize, material| {
        let mut hidden = open.clone();
        hidden.spheres.push(Sphere { centre: RULES.lamps[k], radius: 0.5, material: 0, blend: 0.0 });
        hidden.materials.push(material);
        hidden
    };
    for k in 0..2 {
        let mut off = scene();
        off.lights[k].colour = Vec3::ZERO;
        let (hidden, rays) = frame(&around(k, Material::default()));
        assert_eq!(hidden.compare(&draw(&off, &quality)), None, "lamp {k}");
        assert!(rays > 0 && worst(&hidden, &lit).0 > 20, "lamp {k} lights the smoke");
    }
    // One of glass gives it its colour.
    let glass = Material { transparency: 1.0, shadow: Vec3::new(1.0, 0.5, 0.25), ..Material::default() };
    let mut dyed = scene();
    dyed.lights[0].colour *= glass.shadow;
    assert!(worst(&frame(&around(0, glass)).0, &draw(&dyed, &quality)).0 <= 1);
    // Half a wall shades the half behind it: of the lump as seen from the lamp, the far side.
    let mut wall = open.clone();
    let (lamp, eye) = (RULES.lamps[1], open.camera.position);
    let to = Vec3::new(3.0, 1.0, -1.0) - lamp;
    let side = luc_core::math::normalize(Vec3::new(-to.z, 0.0, to.x));
    let edge = lamp + to * 0.1;
    let corners = [edge + Vec3::Y, edge - Vec3::Y, edge + side];
    wall.triangles.push(Triangle { corners, material: 0 });
    wall.materials.push(Material::default());
    let straight = |p: Vec3| {
        luc_core::math::normalize(p - eye).dot(luc_core::math::normalize(Vec3::new(3.0, 1.0, -1.0) - eye))
    };
    assert!(corners.iter().all(|&p| straight(p) < 0.92), "it is out of the picture");
    let (half, _) = frame(&wall);
    let light = |picture: &Picture| picture.pixels.iter().map(|&p| i64::from(channels(p)[2])).sum::<i64>();
    let (all, none) = (light(&lit), light(&frame(&around(1, Material::default())).0));
    let share = (light(&half) - none) as f64 / (all - none) as f64;
    assert!((0.25..0.75).contains(&share), "{share} of the lamp's light is left");
}

#[test]
fn a_frame_alone_is_the_frame_come_to_by_playing_and_by_seeking() {
    let part = show::PARTS.iter().find(|part| part.name == "smoke").expect("a part of the show");
    let quality = Quality::named("low").unwrap();
    let draw = |renderer: &mut Renderer, frame: u64| {
        let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
        renderer.frame(&(part.scene)(frame), frame, SIZE, &quality, &mut pixels);
        Picture { width: SIZE.0, height: SIZE.1, pixels }
    };
    let alone = |frame| draw(&mut Renderer::default(), frame);
    let mut played = Renderer::default();
    let mut at_300 = None;
    let mut steps = 0;
    for frame in 0..=300 {
        let picture = draw(&mut played, frame);
        steps += u64::from(played.counters.get(Counter::SmokeCells) > 0);
        if [150, 300].contains(&frame) {
            let command = golden::replay("smoke", frame, "low", SIZE);
            assert_eq!(alone(frame).compare(&picture), None, "frame {frame}; replay: {command}");
        }
        at_300 = if frame == 300 { Some(picture) } else { at_300 };
    }
    assert_eq!(steps, 150, "one step every other frame");
    // Backwards, forwards, over other parts, at other sizes.
    let mut sought = Renderer::default();
    let mut other = vec![0; 32 * 18];
    for frame in [300, 299, 120, 300, 420, 300, 0, 300, 301, 300] {
        sought.frame(&(show::PARTS[0].scene)(frame), frame, (32, 18), &quality, &mut other);
        let picture = draw(&mut sought, frame);
        let kept = if frame == 300 { at_300.as_ref() } else { None };
        if let Some(kept) = kept {
            assert_eq!(kept.compare(&picture), None, "frame 300, sought");
        }
    }
    // And by the program, which comes to it from the start.
    let at_300 = at_300.expect("frame 300 was played");
    let dir = tempfile::tempdir().unwrap();
    let args = ["--scene", "smoke", "--frame", "300", "--size", "160x90", "--quality", "low", "-o", "-"];
    let output = run(dir.path(), &args);
    let written = Picture::read_ppm(&output.stdout).expect("a picture");
    assert_eq!(at_300.compare(&written), None, "{}", luc().display());
}
