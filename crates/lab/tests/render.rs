//! `lab render` and `lab mesh` from end to end.

use std::fs::{File, create_dir, write};
use std::path::Path;
use std::process::{Command, Output};

const PYRAMID: &str = "mtllib p.mtl\nv 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nv 1 2 1\nusemtl sand\nf 1 2 3 4\n\
    f 2 1 5\nf 3 2 5\nf 4 3 5\nf 1 4 5\n";

fn lab(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_luc-lab"))
        .args(args)
        .current_dir(folder)
        .output()
        .expect("the lab starts")
}

/// Draws a file and gives its red, green and blue bytes.
fn drawn(folder: &Path, args: &[&str]) -> Vec<u8> {
    let common = ["--size", "64x48", "--quality", "low", "-o", "out.png"];
    let done = lab(folder, &[&["render"], args, &common].concat());
    assert!(done.status.success(), "{args:?}: {}", String::from_utf8_lossy(&done.stderr));
    let mut reader = png::Decoder::new(std::io::BufReader::new(File::open(folder.join("out.png")).unwrap()))
        .read_info()
        .unwrap();
    assert_eq!((reader.info().width, reader.info().height), (64, 48));
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    bytes
}

#[test]
fn a_model_is_drawn_in_the_colours_of_its_materials() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder.join("p.obj"), PYRAMID).unwrap();
    let middle = |bytes: &[u8]| {
        let at = 3 * (28 * 64 + 32);
        [0, 1, 2].map(|k| i32::from(bytes[at + k]))
    };
    write(folder.join("p.mtl"), "newmtl sand\nKd 0.9 0.1 0.05\nKs 0 0 0\n").unwrap();
    let [r, g, b] = middle(&drawn(folder, &["p.obj"]));
    assert!(r > 2 * g && r > 2 * b, "red: {r} {g} {b}");
    write(folder.join("p.mtl"), "newmtl sand\nKd 0.05 0.1 0.9\nKs 0 0 0\n").unwrap();
    let blue = drawn(folder, &["p.obj"]);
    let [r, _, b] = middle(&blue);
    assert!(b > 2 * r, "blue: {r} {b}");
    assert_eq!(drawn(folder, &["p.obj"]), blue, "the same picture again");
    for args in [
        &["p.obj", "--turn", "75"][..],
        &["p.obj", "--frame", "60"],
        &["p.obj", "--up", "z"],
        &["p.obj", "--no-floor"],
        &["p.obj", "--height", "-30"],
    ] {
        assert!(drawn(folder, args) != blue, "{args:?} changes the picture");
    }
    assert_eq!(drawn(folder, &["p.obj", "--frame", "0"]), drawn(folder, &["p.obj", "--frame", "240"]));
}

#[test]
fn meshes_that_are_written_are_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, args) in [("knot", &["--triangles", "600"][..]), ("facets", &["--frame", "120"])] {
        let file = format!("a/{name}.obj");
        let done = lab(folder, &[&["mesh", name, "-o", &file], args].concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let bytes = drawn(folder, &[&file]);
        let [darkest, brightest] = [bytes.iter().min(), bytes.iter().max()].map(|b| *b.unwrap());
        assert!(brightest - darkest > 60, "{name}: from {darkest} to {brightest}");
    }
}

#[test]
fn bad_input_is_one_clear_line_and_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder.join("p.obj"), PYRAMID).unwrap();
    write(folder.join("p.mtl"), "newmtl sand\nKd 1 0\n").unwrap();
    write(folder.join("empty.obj"), "").unwrap();
    write(folder.join("bytes.obj"), [0, 255, 254, 10, 200, 13, 10, 7]).unwrap();
    write(folder.join("broken.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n").unwrap();
    create_dir(folder.join("folder.obj")).unwrap();
    for (args, words) in [
        (&["render"][..], "which file?"),
        (&["render", "none.obj"], "none.obj: No such file"),
        (&["render", "folder.obj"], "folder.obj: "),
        (&["render", "empty.obj"], "empty.obj: there are no faces in it"),
        (&["render", "bytes.obj"], "no faces"),
        (&["render", "broken.obj"], "broken.obj: line 4: there is no position 9; 3 stand before it"),
        (&["render", "p.obj"], "p.mtl: line 2: 2 numbers where 3 are needed"),
        (&["render", "p.obj", "p.obj"], "unexpected argument"),
        (&["render", "p.obj", "--size", "0x9"], "such as 1280x720"),
        (&["render", "p.obj", "--quality", "best"], "a quality is one of"),
        (&["render", "p.obj", "--turn", "far"], "an angle in degrees, not 'far'"),
        (&["render", "p.obj", "--normals", "odd"], "file, flat or smooth"),
        (&["render", "p.obj", "--up", "x"], "up is y or z"),
        (&["render", "p.obj", "--texture", "wood"], "a texture is none, noise"),
        (&["mesh"], "which mesh? one of knot, gold"),
        (&["mesh", "silver"], "a mesh is one of knot, gold"),
        (&["mesh", "luc"], "not 'luc'"),
    ] {
        let done = lab(folder, args);
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{args:?}: {said}");
        assert!(said.contains(words), "{args:?}: {said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{args:?}: {said}");
    }
}

/// A PNG file of four colours: red and green above, blue and white below.
fn quarters(path: &Path) {
    let mut encoder = png::Encoder::new(File::create(path).unwrap(), 64, 64);
    encoder.set_color(png::ColorType::Rgb);
    let texel = |i: usize| match (i / 64 < 32, i % 64 < 32) {
        (true, true) => [255, 0, 0],
        (true, false) => [0, 255, 0],
        (false, true) => [0, 0, 255],
        (false, false) => [255, 255, 255],
    };
    let bytes: Vec<u8> = (0..64 * 64).flat_map(texel).collect();
    encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
}

/// A wall that faces the eye under `--turn 0 --height 0`, the image once over it.
const WALL: &str = "mtllib w.mtl\nv -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n\
    usemtl paint\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";

const FACE: [&str; 5] = ["--turn", "0", "--height", "0", "--no-floor"];

/// Names of the colours that four places of the wall have, in reading order.
fn seen(bytes: &[u8]) -> [char; 4] {
    [(22, 14), (42, 14), (22, 34), (42, 34)].map(|(x, y)| {
        let [r, g, b] = [0, 1, 2].map(|k| i32::from(bytes[3 * (y * 64 + x) + k]));
        match (r > 2 * g.max(b), g > 2 * r.max(b), b > 2 * r.max(g)) {
            (true, ..) => 'r',
            (_, true, _) => 'g',
            (.., true) => 'b',
            _ if r > 60 => 'w',
            _ => '-',
        }
    })
}

#[test]
fn images_lie_on_models_by_their_texture_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    create_dir(folder.join("maps")).unwrap();
    quarters(&folder.join("maps/four colours.png"));
    write(folder.join("w.obj"), WALL).unwrap();
    // A curved mesh: the same wall with a normal that is not its own.
    write(folder.join("s.obj"), WALL.replace("vn 0 0 1\n", "vn 0.1 0 1\n")).unwrap();
    for (map, expected) in [
        ("map_Kd maps/four colours.png", ['r', 'g', 'b', 'w']),
        ("map_Kd maps\\four colours.png", ['r', 'g', 'b', 'w']),
        ("map_Kd -o 0.5 0 -blendu on maps/four colours.png", ['g', 'r', 'w', 'b']),
        ("map_Kd -s 1 -1 1 maps/four colours.png", ['b', 'w', 'r', 'g']),
        ("Kd 1 0 0\nmap_Kd maps/four colours.png", ['r', '-', '-', 'r']),
        ("Kd 0 0 0\nPm 1\nmap_Kd maps/four colours.png", ['r', 'g', 'b', 'w']),
    ] {
        write(folder.join("w.mtl"), format!("newmtl paint\nPr 1\n{map}\n")).unwrap();
        for file in ["w.obj", "s.obj"] {
            assert_eq!(seen(&drawn(folder, &[&[file], &FACE[..]].concat())), expected, "{file}: {map}");
        }
    }
}

#[test]
fn images_of_other_formats_are_read_too() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder.join("w.obj"), WALL).unwrap();
    write(folder.join("w.mtl"), "newmtl paint\nPr 1\nmap_Kd a.tga\n").unwrap();
    // Truevision TGA: two by two texels, blue, green, red, from the upper left.
    let head = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 24, 0x20];
    let texels = [0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255];
    write(folder.join("a.tga"), [&head[..], &texels].concat()).unwrap();
    assert_eq!(seen(&drawn(folder, &[&["w.obj"], &FACE[..]].concat())), ['r', 'g', 'b', 'w']);
}

#[test]
fn without_its_image_a_model_is_drawn_in_its_colours_and_the_line_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    quarters(&folder.join("a.png"));
    write(folder.join("broken.png"), &std::fs::read(folder.join("a.png")).unwrap()[..60]).unwrap();
    write(folder.join("w.obj"), WALL).unwrap();
    write(folder.join("bare.obj"), WALL.replace("f 1/1/1 2/2/1 3/3/1 4/4/1", "f 1 2 3 4")).unwrap();
    for (file, line, words) in [
        ("w.obj", "map_Kd none.png", "w.mtl: line 3: without its image (none.png: "),
        ("w.obj", "map_Kd broken.png", "w.mtl: line 3: without its image (broken.png: "),
        ("w.obj", "map_Kd p.obj", "w.mtl: line 3: without its image (p.obj: "),
        ("w.obj", "map_Bump a.png", "w.mtl: line 3: of images only map_Kd is drawn, no map_Bump"),
        ("bare.obj", "map_Kd a.png", "bare.obj: 2 triangles without texture coordinates go without"),
    ] {
        write(folder.join("w.mtl"), format!("newmtl paint\nKd 0 0 1\n{line}\n")).unwrap();
        let done = lab(folder, &["render", file, "--size", "16x16", "--quality", "draft", "-o", "o.png"]);
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success() && said.contains(words), "{line}: {said}");
        assert_eq!(said.trim_end().lines().count(), 2, "{line}: {said}");
        let bytes = drawn(folder, &[&[file], &FACE[..]].concat());
        assert_eq!(seen(&bytes), ['b'; 4], "{line}");
    }
}

#[test]
fn what_has_no_material_wears_a_pattern() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder.join("w.obj"), WALL.replace("mtllib w.mtl\n", "")).unwrap();
    let plain = drawn(folder, &["w.obj", "--texture", "none"]);
    let grain = drawn(folder, &["w.obj"]);
    assert!(grain != plain);
    let others = ["noise", "cells", "stripes", "brick", "scratches"];
    let all = others.map(|name| drawn(folder, &["w.obj", "--texture", name]));
    for (i, picture) in all.iter().enumerate() {
        assert!(*picture != plain && all[..i].iter().all(|other| other != picture), "{}", others[i]);
    }
}
