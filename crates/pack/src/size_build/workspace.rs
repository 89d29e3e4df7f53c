//! A second workspace in the target folder, with trimmed dependencies.
//!
//! Cargo writes replaced dependencies into the lock file, and the committed one must not change.
//! So the size build works in `target/pack/workspace`: symbolic links to everything in the
//! project, a manifest with `[patch.crates-io]` added, and a lock file in which the replaced
//! crates have no registry to come from.

use super::edit::{Source, write_if_new};
use super::std_source::link;
use super::toolchain::Toolchain;
use super::trim;
use crate::Error;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The target that the size build is for.
pub const TARGET: &str = "x86_64-unknown-linux-gnu";

/// What is replaced lies in the workspace without being part of it.
const OWN_WORKSPACE: &str = "[workspace]\nexclude = [\"deps\", \"std\"]";

/// A dependency as cargo has downloaded it.
struct Dependency {
    /// Name and version.
    package: String,
    directory: PathBuf,
}

/// Makes the workspace up to date and returns its directory.
pub fn prepare(root: &Path, output: &Path, toolchain: &Toolchain) -> Result<PathBuf, Error> {
    let metadata = metadata(root, toolchain)?;
    let workspace = output.join("workspace");
    let read = |name: &str| {
        let dependency = find(&metadata, name)?;
        Source::read(&dependency.package, &dependency.directory)
    };
    let mut minifb = read("minifb")?;
    let mut x11_dl = read("x11-dl")?;
    trim::minifb::trim(&mut minifb, &trim::minifb::named_keys(root)?)?;
    trim::x11_dl::trim(&mut x11_dl, &trim::x11_dl::called_functions(&minifb)?)?;
    let mut crossbeam_deque = read("crossbeam-deque")?;
    trim::crossbeam_deque::trim(&mut crossbeam_deque)?;
    let mut rayon_core = read("rayon-core")?;
    trim::rayon_core::trim(&mut rayon_core)?;
    let mut wide = read("wide")?;
    trim::wide(&mut wide)?;

    let mut replaced = Vec::new();
    let mut manifest = read_text(&root.join("Cargo.toml"))?.replacen("[workspace]", OWN_WORKSPACE, 1);
    manifest.push_str("\n[patch.crates-io]\n");
    let replacements = [
        ("minifb", minifb),
        ("x11-dl", x11_dl),
        ("rayon-core", rayon_core),
        ("crossbeam-deque", crossbeam_deque),
        ("wide", wide),
    ];
    for (name, source) in replacements {
        source.write(&workspace.join("deps").join(name))?;
        manifest.push_str(&format!("{name} = {{ path = \"deps/{name}\" }}\n"));
        replaced.push(name);
    }
    std::fs::create_dir_all(&workspace).map_err(Error::file(&workspace))?;
    link_everything(root, &workspace)?;
    write_if_new(&workspace.join("Cargo.toml"), manifest.as_bytes())?;
    let lock = without_registry(&read_text(&root.join("Cargo.lock"))?, &replaced);
    write_if_new(&workspace.join("Cargo.lock"), lock.as_bytes())?;
    Ok(workspace)
}

/// Asks cargo where the dependencies' sources are; it downloads what is missing.
fn metadata(root: &Path, toolchain: &Toolchain) -> Result<Value, Error> {
    let mut command = toolchain.cargo();
    command
        .args(["metadata", "--format-version=1", "--locked", "--filter-platform", TARGET])
        .current_dir(root);
    let failed = |why: &str| Error::Command(format!("cargo metadata {why}"));
    let output = command.output().map_err(|error| failed(&format!("cannot be run: {error}")))?;
    if !output.status.success() {
        let message = String::from_utf8_lossy(&output.stderr);
        let line = message.lines().find(|line| line.starts_with("error")).unwrap_or("");
        return Err(failed(&format!("failed: {line}")));
    }
    serde_json::from_slice(&output.stdout).map_err(|_| failed("did not answer in JSON"))
}

fn find(metadata: &Value, name: &str) -> Result<Dependency, Error> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let found: Vec<&Value> = packages.filter(|package| package["name"] == name).collect();
    let [package] = found[..] else {
        return Err(Error::Command(format!(
            "the size build wants one version of {name}, cargo knows {}",
            found.len()
        )));
    };
    let (version, manifest) = (package["version"].as_str(), package["manifest_path"].as_str());
    let directory = Path::new(manifest.unwrap_or_default()).parent().unwrap_or(Path::new(""));
    Ok(Dependency {
        package: format!("{name} {}", version.unwrap_or_default()),
        directory: directory.to_owned(),
    })
}

/// Links to all in the project but what the workspace has of its own.
fn link_everything(root: &Path, workspace: &Path) -> Result<(), Error> {
    for entry in std::fs::read_dir(root).map_err(Error::file(root))? {
        let entry = entry.map_err(Error::file(root))?;
        let (name, target) = (entry.file_name(), entry.path());
        let hidden = name.to_string_lossy().starts_with('.');
        if hidden || name == "target" || name == "Cargo.toml" || name == "Cargo.lock" {
            continue;
        }
        link(&target, &workspace.join(&name))?;
    }
    // A link to what is no longer there would only be in the way.
    for entry in std::fs::read_dir(workspace).map_err(Error::file(workspace))?.flatten() {
        if entry.path().is_symlink() && !entry.path().exists() {
            let _ = std::fs::remove_file(entry.path());
        }
    }
    Ok(())
}

/// A lock file in which the packages `replaced` come from no registry, as for local crates.
fn without_registry(lock: &str, replaced: &[&str]) -> String {
    let mut local = false;
    let mut kept = String::new();
    for line in lock.lines() {
        if let Some(name) = line.strip_prefix("name = ") {
            local = replaced.contains(&name.trim_matches('"'));
        }
        if !(local && (line.starts_with("source = ") || line.starts_with("checksum = "))) {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    kept
}

fn read_text(path: &Path) -> Result<String, Error> {
    std::fs::read_to_string(path).map_err(Error::file(path))
}

#[cfg(test)]
mod tests {
    #[test]
    fn replaced_packages_lose_their_registry() {
        let lock = "[[package]]\nname = \"a\"\nsource = \"r\"\n\n[[package]]\nname = \"b\"\nsource = \"r\"\nchecksum = \"1\"\ndependencies = [\n \"a\",\n]\n";
        let expected = "[[package]]\nname = \"a\"\nsource = \"r\"\n\n[[package]]\nname = \"b\"\ndependencies = [\n \"a\",\n]\n";
        assert_eq!(super::without_registry(lock, &["b"]), expected);
    }
}
