//! `lab capture`: resumed, sharded and streamed captures equal the whole byte for byte.

use std::fs::{read, remove_file, write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Frames over the cut between two parts, three chunks and a bit.
const WHAT: [&str; 10] =
    ["--from", "713", "--to", "726", "--size", "48x27", "--quality", "draft", "--chunk", "4"];

fn capture(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_luc-lab")).arg("capture").args(WHAT).args(args).output().unwrap()
}

fn captured(out: &Path, args: &[&str]) {
    let done = capture(&[&["-o", out.to_str().unwrap()], args].concat());
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn the_file_is_a_header_and_thirteen_frames_and_the_stream_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.y4m");
    captured(&file, &[]);
    let bytes = read(&file).unwrap();
    let header = bytes.iter().position(|&b| b == b'\n').unwrap() + 1;
    assert!(bytes.starts_with(b"YUV4MPEG2 W48 H27 F60:1 Ip A1:1 C444 "));
    let frame = 6 + 3 * 48 * 27;
    assert_eq!(bytes.len(), header + 13 * frame);
    assert!(bytes[header..].chunks(frame).all(|f| f.starts_with(b"FRAME\n")));
    let stream = capture(&["-o", "-"]);
    assert!(stream.status.success());
    assert_eq!(stream.stdout, bytes);
}

#[test]
fn an_interrupted_capture_goes_on_and_equals_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.y4m");
    captured(&file, &[]);
    let whole = read(&file).unwrap();
    for kept in [0, 10, whole.len() / 3, whole.len() / 2, whole.len() - 1, whole.len()] {
        write(&file, &whole[..kept]).unwrap();
        captured(&file, &[]);
        assert!(read(&file).unwrap() == whole, "after {kept} of {} bytes", whole.len());
    }
}

#[test]
fn shards_joined_equal_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole.y4m");
    captured(&whole, &[]);
    let out = folder.path().join("show.y4m");
    let chunks: Vec<PathBuf> = (0..4).map(|k| folder.path().join(format!("show.y4m.{k:06}"))).collect();
    for shard in ["3/3", "1/3", "2/3"] {
        captured(&out, &["--shard", shard]);
    }
    // One is lost and made again, the others are kept.
    remove_file(&chunks[2]).unwrap();
    captured(&out, &["--shard", "3/3"]);
    let joined: Vec<u8> = chunks.iter().flat_map(|chunk| read(chunk).unwrap()).collect();
    assert!(joined == read(&whole).unwrap(), "joined shards differ from the whole");
    assert_eq!(folder.path().read_dir().unwrap().count(), 5, "nothing unfinished is left");
}

#[test]
fn another_file_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.y4m");
    for other in [
        &b"my only copy of something"[..],
        b"YUV4MPEG2 W48 H27 F60:1 Ip A1:1 C444 XCOLORRANGE=LIMITED XLUC=high,1-2\n",
    ] {
        write(&file, other).unwrap();
        let done = capture(&["-o", file.to_str().unwrap()]);
        assert_eq!(done.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&done.stderr).contains("holds something else"));
        assert_eq!(read(&file).unwrap(), other);
    }
}

#[test]
fn bad_input_is_one_clear_line_and_code_2() {
    for (args, part) in [
        (&["--shard", "4/3"][..], "such as 2/8"),
        (&["--shard", "1/3", "-o", "-"], "--shard writes files"),
        (&["--to", "5"], "--to must be greater"),
        (&["--quality", "best"], "one of draft"),
        (&["--part", "silver"], "one of luc"),
        (&["--chunk", "0"], "from 1 on"),
        (&["-o", "/nowhere/at/all.y4m"], "/nowhere/at/all.y4m"),
    ] {
        let done = capture(args);
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{args:?}: {said}");
        assert!(said.contains(part), "{args:?}: {said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{args:?}: {said}");
    }
}

#[test]
fn a_reader_that_has_gone_ends_it_without_a_word() {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut lab = Command::new(env!("CARGO_BIN_EXE_luc-lab"));
    let done = lab.arg("help").stdout(writer).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&done.stderr), "");
}
