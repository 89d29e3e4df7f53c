//! Any text as a model or as its materials: what is read holds together, or an error that names a line.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[allow(dead_code, reason = "the lab uses the rest")]
#[path = "."]
mod render {
    #[path = "../../crates/lab/src/render/mtl.rs"]
    pub mod mtl;
    #[path = "../../crates/lab/src/render/obj.rs"]
    pub mod obj;
    #[path = "../../crates/lab/src/render/polygon.rs"]
    pub mod polygon;
}

use render::{mtl::Told, obj::Model};
use std::path::Path;

fuzz_target!(|data: &[u8]| {
    let text = String::from_utf8_lossy(data);
    match Model::read(&text) {
        Ok(model) => {
            assert!(model.positions.iter().chain(&model.normals).all(|v| v.is_finite()));
            for corners in &model.triangles {
                assert!(corners.at.iter().all(|&i| i < model.positions.len()), "{corners:?}");
                assert!(corners.uv.is_none_or(|uv| uv.iter().all(|&i| i < model.uvs.len())), "{corners:?}");
                assert!(
                    corners.normal.is_none_or(|n| n.iter().all(|&i| i < model.normals.len())),
                    "{corners:?}"
                );
                assert!(corners.material < model.materials.len(), "{corners:?}");
            }
        }
        Err(told) => assert!(told.starts_with("line ") && !told.contains('\n'), "{told}"),
    }
    match Told::read(Path::new("materials.mtl"), &text) {
        Ok(materials) => {
            materials.iter().for_each(|told| assert!(told.exponent.is_finite() && told.ior.is_finite()))
        }
        Err(told) => assert!(told.starts_with("line ") && !told.contains('\n'), "{told}"),
    }
});
