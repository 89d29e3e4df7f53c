//! `lab accuracy` from end to end, on one part and in miniature.

use std::fs::{read_to_string, write};
use std::path::Path;
use std::process::{Command, Output};

fn lab(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_luc-lab")).args(args).output().expect("the lab starts")
}

fn study(out: &Path) {
    let out = out.to_str().unwrap();
    let done = lab(&["accuracy", "--quick", "--size", "40x24", "--part", "gold", "--out", out]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn a_study_makes_a_page_whose_files_are_all_there_and_goes_on_where_it_was_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    study(out);
    let page = read_to_string(out.join("index.html")).unwrap();
    let mut images = 0;
    for file in page.split("src=\"").skip(1).map(|rest| rest.split('"').next().unwrap()) {
        assert!(out.join(file).is_file(), "{file} is missing");
        images += 1;
    }
    assert!(images > 30, "{images} images");
    assert!(!page.contains("http://") && !page.contains("https://"), "the page asks for the network");
    assert!(!page.contains("NaN") && !page.contains("inf"), "a figure without sense");

    let table = read_to_string(out.join("study.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    let kept = lines.len() - 7;
    write(out.join("study.csv"), lines[..kept].join("\n") + "\n").unwrap();
    study(out);
    let again = read_to_string(out.join("study.csv")).unwrap();
    let again: Vec<&str> = again.lines().collect();
    assert_eq!(again[..kept], lines[..kept], "what was there is kept");
    let names = |lines: &[&str]| {
        let mut names: Vec<String> =
            lines.iter().map(|line| line.split('"').take(2).collect::<Vec<_>>().join("\"")).collect();
        names.sort();
        names
    };
    assert_eq!(names(&again[2..]), names(&lines[2..]), "what was lost is measured again");
}

#[test]
fn bad_input_is_one_clear_line_and_code_2() {
    for (args, part) in [
        (&["accuracy", "--part", "silver"][..], "no part is called silver"),
        (&["accuracy", "--size", "big"], "such as 1280x720"),
        (&["accuracy", "--slow"], "--slow"),
        (&["measure"], "'measure' is no command"),
        (&["stats", "x"], "FRAME must be a whole number"),
        (&["stats", "0", "best"], "a quality is one of draft"),
    ] {
        let done = lab(args);
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{args:?}: {said}");
        assert!(said.contains(part), "{args:?}: {said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{args:?}: {said}");
    }
}
