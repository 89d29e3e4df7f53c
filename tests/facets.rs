//! The cathedral of Facets by its numbers.

use luc::show;
use luc_core::math::Vec3;
use luc_core::mesh::Mesh;
use luc_core::scene::Scene;

fn part() -> &'static show::Part {
    show::PARTS.iter().find(|part| part.name == "facets").expect("the show has it")
}

/// Triangles of a frame: all, and those with a corner in the picture.
fn triangles(scene: &Scene) -> [usize; 2] {
    let camera = &scene.camera;
    let view_from_world = camera.world_from_camera().transpose();
    let (wide, high) = (camera.half_width(), camera.half_width() * 9.0 / 16.0);
    let in_view = |p: Vec3| {
        let p = view_from_world * (p - camera.position);
        p.z > 0.0 && p.x.abs() < wide * p.z && p.y.abs() < high * p.z
    };
    let mut counts = [0; 2];
    for instance in scene.meshes.instances() {
        for triangle in instance.mesh().triangles() {
            counts[0] += 1;
            counts[1] += usize::from(triangle.iter().any(|&p| in_view(instance.to_world(p))));
        }
    }
    counts
}

#[test]
fn a_hundred_thousand_triangles_are_in_view_when_it_has_grown() {
    // Seven to nine seconds after the cut, before the camera has passed the first bays.
    for n in [420, 480, 540] {
        let [all, in_view] = triangles(&(part().scene)(n));
        assert!(in_view >= 100_000, "{in_view} of {all} at frame {n}");
    }
    let [all, in_view] = triangles(&(part().scene)(0));
    assert!(in_view < 20_000, "it grows: {in_view} of {all} at first");
}

#[test]
fn a_tree_over_all_of_them_is_sound() {
    let scene = (part().scene)(540);
    let world = scene.meshes.instances().iter().flat_map(|instance| {
        instance.mesh().triangles().iter().map(|triangle| triangle.map(|p| instance.to_world(p)))
    });
    let world: Vec<[Vec3; 3]> = world.collect();
    assert!(world.len() > 100_000);
    Mesh::flat(world).validate().unwrap();
}
