//! Voxels in frames: what is drawn of them is what is drawn of the same cubes made of triangles, with their
//! faces, colours, shadows and mirrored pictures.

mod support;

use luc_core::math::Vec3;
use luc_core::math::hash::{hash2, mix};
use luc_core::quality::Quality;
use luc_core::scene::{
    Background, Camera, Grade, Light, LightKind, Material, Plane, Scene, Shading, Sphere, Stop, Triangle,
    Voxels,
};
use support::picture::{self, distance, psnr};

const SIZE: (u32, u32) = (320, 180);

/// A heap of cells of three colours.
fn heap() -> Voxels {
    let mut grid = Voxels::new(Vec3::new(-1.5, 0.3, -1.5), 0.5, [6, 5, 6]);
    grid.material = 2;
    // Not even the dark line of a pixel that grooves of no width leave.
    grid.groove = -1.0;
    grid.edit_all_by(&mut |[x, y, z], _| {
        let bits = mix(hash2(x as u32, y as u32), z as u32);
        if bits % 5 >= y as u32 { 1 + (bits / 5 % 3) as u8 } else { Voxels::EMPTY }
    });
    grid
}

/// The faces of its cells that are seen from outside.
fn faces(grid: &Voxels) -> Vec<Triangle> {
    let [nx, ny, nz] = grid.size().map(|n| n as i32);
    let mut triangles = Vec::new();
    for at in (0..nx * ny * nz).map(|i| [i % nx, i / nx % ny, i / (nx * ny)]) {
        let value = grid.get(at);
        for (axis, up) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut beside = at;
            beside[axis] += 2 * up - 1;
            if !Voxels::is_solid(value) || Voxels::is_solid(grid.get(beside)) {
                continue;
            }
            // Anticlockwise seen from outside: the next axis and the one after it turn so around this one.
            let corner = |i: i32, j: i32| {
                let mut p = at;
                p[axis] += up;
                p[(axis + 1) % 3] += i;
                p[(axis + 2) % 3] += j;
                grid.lo + Vec3::from_array(p.map(|i| i as f32)) * grid.cell
            };
            let mut around = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if up == 0 {
                around.reverse();
            }
            let [a, b, c, d] = around;
            let material = grid.material + usize::from(value) - 1;
            triangles.push(Triangle { corners: [a, b, c], material });
            triangles.push(Triangle { corners: [a, c, d], material });
        }
    }
    triangles
}

/// Around the heap: a floor that mirrors a little, a mirror ball, a sun and its opposite.
fn scene(shading: Shading) -> Scene {
    const STOPS: &[Stop] = &[
        Stop { y: -1.0, colour: Vec3::new(0.1, 0.1, 0.2) },
        Stop { y: 1.0, colour: Vec3::new(0.3, 0.5, 0.9) },
    ];
    let dull = |colour| Material {
        colour,
        specular: Vec3::splat(0.2),
        exponent: 12.0,
        f0: Vec3::splat(0.04),
        roughness: 0.5,
        ..Material::default()
    };
    let mirror = Material { diffuse: 0.0, f0: Vec3::splat(0.9), reflection: 1.0, ..Material::default() };
    let floor = Material { reflection: 1.0, f0: Vec3::splat(0.2), ..dull(Vec3::splat(0.4)) };
    let light = |position, colour| Light { position, colour, kind: LightKind::Point };
    Scene {
        camera: Camera {
            position: Vec3::new(2.5, 3.0, 6.0),
            target: Vec3::new(0.3, 0.7, 0.0),
            roll: 0.0,
            fov: 0.8,
        },
        background: Background { stops: STOPS.to_vec(), ..Background::default() },
        planes: vec![Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 40.0, material: 0 }],
        spheres: vec![Sphere { centre: Vec3::new(2.3, 0.8, 0.6), radius: 0.8, material: 1, blend: 0.0 }],
        materials: vec![
            floor,
            mirror,
            dull(Vec3::new(0.7, 0.2, 0.1)),
            dull(Vec3::new(0.2, 0.6, 0.2)),
            dull(Vec3::new(0.2, 0.3, 0.8)),
        ],
        lights: vec![
            light(Vec3::new(-4.0, 6.0, 5.0), Vec3::splat(40.0)),
            light(Vec3::new(6.0, 3.0, -3.0), Vec3::new(20.0, 10.0, 5.0)),
        ],
        ambient: [Vec3::splat(0.05), Vec3::splat(0.2)],
        grade: Grade { grain: 0.0, ..Grade::DEFAULT },
        shading,
        ..Scene::default()
    }
}

fn draw(scene: &Scene) -> Vec<u32> {
    let quality = Quality { edge_samples: 0, ..Quality::named("high").unwrap().every_pixel() };
    picture::draw(scene, SIZE, &quality).0
}

#[test]
fn voxels_are_drawn_as_cubes_of_triangles() {
    for shading in [Shading::Phong, Shading::CookTorrance, Shading::Ggx] {
        let empty = scene(shading);
        let cells = draw(&Scene { voxels: vec![heap()], ..empty.clone() });
        let cubes = draw(&Scene { triangles: faces(&heap()), ..empty.clone() });
        // Rays that graze an edge may see either side of it.
        let wrong = cells.iter().zip(&cubes).filter(|&(&a, &b)| distance(a, b) > 1).count();
        let db = psnr(&cells, &cubes);
        let seen = psnr(&cells, &draw(&empty));
        assert!(seen < 25.0, "there is something to see: {seen:.1} dB");
        assert!(wrong <= cells.len() / 2_000 && db > 45.0, "{shading:?}: {wrong} pixels, {db:.1} dB");
    }
}
