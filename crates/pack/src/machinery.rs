//! What of the engine's machinery is in the file, against what its parts call for.
//!
//! Cargo tells with which features it compiled luc-core and luc, in the messages of the size build; plans
//! tell what the frames of the parts in the file call for. Both lists must be equal: what no part calls for
//! costs bytes, and what one calls for without having it is drawn wrong.

use luc::show::{PARTS, Part};
use luc_core::features;
use luc_core::plan::Plan;
use luc_core::quality::Quality;
use serde_json::Value;

/// Frames between two that are asked, besides a part's last one.
const EVERY: usize = 30;

/// Features of luc-core that are no machinery of their own: others bring them along.
const SHARED: [&str; 1] = ["effects"];

/// The features that a package was compiled with, from cargo's messages, one JSON object a line.
pub fn compiled(messages: &str, package: &str) -> Vec<String> {
    let mut features = Vec::new();
    for message in messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok()) {
        let is_library = message["target"]["name"] == package.replace('-', "_").as_str();
        if message["reason"] == "compiler-artifact" && is_library {
            let names = message["features"].as_array().into_iter().flatten();
            features.extend(names.filter_map(|name| Some(name.as_str()?.to_owned())));
        }
    }
    features.sort();
    features.dedup();
    features
}

/// The parts that a program with these features of luc has. What this program has, but not by such a
/// feature, all have.
pub fn parts<'a>(of_luc: &'a [String]) -> impl Iterator<Item = &'static Part> + 'a {
    let optional = |name: &str| luc::show::OPTIONAL.contains(&name);
    PARTS.iter().filter(move |part| !optional(part.name) || of_luc.iter().any(|f| f == part.name))
}

/// Features of luc-core that frames of these parts call for, over their whole length and at all presets.
pub fn called(parts: impl Iterator<Item = &'static Part>) -> Vec<String> {
    let mut found = vec![false; features::ALL.len()];
    for part in parts {
        for frame in (0..part.frames).step_by(EVERY).chain([part.frames - 1]) {
            let scene = (part.scene)(frame);
            for (_, quality) in Quality::PRESETS {
                let plan = Plan::of(&scene, &quality);
                for (found, (_, counter)) in found.iter_mut().zip(features::ALL) {
                    *found |= plan.names(counter);
                }
            }
        }
    }
    let names = features::ALL.iter().zip(found).filter_map(|((name, _), found)| found.then_some(*name));
    let mut names: Vec<String> = names.map(str::to_owned).collect();
    names.sort();
    names
}

/// What is wrong with the machinery compiled in, if anything.
pub fn difference(compiled: &[String], called: &[String]) -> Option<String> {
    let lacks = |list: &[String], name: &String| !list.contains(name);
    let unused = compiled.iter().filter(|name| lacks(called, name) && !SHARED.contains(&name.as_str()));
    let missing = called.iter().filter(|name| lacks(compiled, name));
    let words =
        |names: Vec<&str>, what: &str| (!names.is_empty()).then(|| format!("{what}: {}", names.join(", ")));
    let unused = words(unused.map(String::as_str).collect(), "compiled in, but no part calls for it");
    let missing = words(missing.map(String::as_str).collect(), "called for, but not compiled in");
    match (unused, missing) {
        (Some(unused), Some(missing)) => Some(format!("{unused}; {missing}")),
        (unused, missing) => unused.or(missing),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Messages of a build of luc-core with these features.
    fn messages(features: &[String]) -> String {
        let names = features.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(",");
        let message = |package: &str, features: &str| {
            format!(
                "{{\"reason\":\"compiler-artifact\",\"target\":{{\"name\":\"{package}\"}},\"features\":[{features}]}}\n"
            )
        };
        message("glam", "\"std\"") + &message("luc_core", &names) + "no JSON\n" + &message("luc", "\"sound\"")
    }

    #[test]
    fn an_effect_that_no_part_calls_for_is_found() {
        let of_luc = compiled(&messages(&[]), "luc");
        assert_eq!(of_luc, ["sound"]);
        let called = called(parts(&of_luc));
        assert!(
            called.contains(&"meshes".to_owned()) && !called.contains(&"voxels".to_owned()),
            "{called:?}"
        );
        // Just what is called for is right, and what effects share doesn't count.
        let mut features = called.clone();
        features.push("effects".to_owned());
        assert_eq!(difference(&compiled(&messages(&features), "luc-core"), &called), None);
        // An effect added by mistake.
        features.push("effect-grain".to_owned());
        let complaint = difference(&compiled(&messages(&features), "luc-core"), &called).unwrap_or_default();
        assert_eq!(complaint, "compiled in, but no part calls for it: effect-grain");
        // And one forgotten.
        features.retain(|name| name != "ggx");
        let complaint = difference(&compiled(&messages(&features), "luc-core"), &called).unwrap_or_default();
        assert!(complaint.ends_with("; called for, but not compiled in: ggx"), "{complaint}");
    }

    #[test]
    fn a_part_that_the_file_lacks_calls_for_nothing() {
        let with = |part: &str| called(parts(&["sound".to_owned(), part.to_owned()]));
        assert!(with("smoke").contains(&"smoke".to_owned()) && !with("cost").contains(&"smoke".to_owned()));
        assert!(with("cost").contains(&"split".to_owned()) && !with("smoke").contains(&"split".to_owned()));
    }
}
