//! Where the command writes, and what it leaves behind.
#![cfg(all(unix, feature = "cli"))]

mod common;

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use common::command::{fifo, welkin};

struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("m.welkin"), common::model_bytes()).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, line: &str) -> Command {
        welkin(self.0.path(), &line.split(' ').collect::<Vec<_>>())
    }

    fn run(&self, line: &str) -> Output {
        self.command(line).output().unwrap()
    }

    fn works(&self, line: &str) -> Output {
        let output = self.run(line);
        assert!(output.status.success(), "{line}: {output:?}");
        output
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

const RENDER: &str = "render --model m.welkin --size 8";
const FROXELS: &str = "froxels --size 2x2x2";
const SUBSET: &str = "subset --model m.welkin";
const SHEET: &str = "contact-sheet --size 16";

#[test]
fn names_that_are_none_and_folders_are_refused_before_the_work() {
    let bench = Bench::new();
    fs::create_dir(bench.path("d")).unwrap();
    let before = bench.names();
    for command in [RENDER, FROXELS, SUBSET, SHEET] {
        for out in [
            "d",
            "d/",
            "d/.",
            ".",
            "..",
            "missing/",
            "missing/file.exr",
            "missing/file.png",
        ] {
            let output = bench.run(&format!("{command} --out {out}"));
            let text = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(2), "{command} {out}: {text}");
            assert_eq!(text.lines().count(), 1, "{text}");
            assert!(!text.contains("panicked") && output.stdout.is_empty());
        }
    }
    for (line, word) in [
        ("render --out sky.jpg", ".exr or .png"),
        ("render --out sky.jpg --format png", ".exr or .png"),
        ("render --out sky.exr --format png", "another format"),
        ("render --out .exr", "name is missing"),
        ("render --out d/.png", "name is missing"),
        ("render --out -", "--format"),
        ("render --out /dev/null", "--format"),
        ("froxels --out volume.png", ".exr or .raw"),
        ("froxels --out volume", ".exr or .raw"),
        ("froxels --out .raw", "name is missing"),
        ("contact-sheet --out sheet.jpeg", ".png"),
    ] {
        let start = Instant::now();
        let output = bench.run(line);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert!(text.contains(word), "{line}: {text}");
        // The contact sheet alone takes longer.
        assert!(start.elapsed() < Duration::from_secs(20));
    }
    assert_eq!(bench.names(), before);
    assert!(fs::read_dir(bench.path("d")).unwrap().next().is_none());
}

#[test]
fn what_begins_with_a_digit_is_no_extension() {
    let bench = Bench::new();
    bench.works(&format!("{RENDER} --out visibility-59.4"));
    assert!(
        bench.path("visibility-59.4.exr").exists() && bench.path("visibility-59.4.png").exists()
    );
}

/// Standard output holds the file alone.
#[test]
fn files_go_to_standard_output() {
    let bench = Bench::new();
    bench.works(&format!("{RENDER} --out a"));
    for out in ["-", "/dev/stdout"] {
        for (format, name) in [("exr", "a.exr"), ("png", "a.png")] {
            let output = bench.works(&format!("{RENDER} --format {format} --out {out}"));
            assert_eq!(output.stdout, fs::read(bench.path(name)).unwrap());
            assert!(String::from_utf8(output.stderr).unwrap().contains("wrote"));
        }
        let file = bench.works(&format!("{SUBSET} --out {out}")).stdout;
        assert!(welkin::Model::from_bytes(file).is_ok());
        let raw = bench.works(&format!("{FROXELS} --format raw --out {out}"));
        assert!(raw.stdout.starts_with(b"WLKFROXL"));
    }
    assert!(
        bench
            .works(&format!("{SHEET} --out -"))
            .stdout
            .starts_with(b"\x89PNG")
    );
    // A shell's redirection, too.
    let file = fs::File::create(bench.path("b.png")).unwrap();
    let line = format!("{RENDER} --format png --out /dev/stdout");
    assert!(
        bench
            .command(&line)
            .stdout(file)
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(
        fs::read(bench.path("b.png")).unwrap(),
        fs::read(bench.path("a.png")).unwrap()
    );
}

#[test]
fn pipes_devices_and_links_stay_what_they_are() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let bench = Bench::new();
    let pipe = bench.path("pipe");
    fifo(&pipe);
    for line in [
        format!("{RENDER} --format exr --out pipe"),
        format!("{SUBSET} --out pipe"),
        format!("{FROXELS} --format exr --out pipe"),
    ] {
        let source = pipe.clone();
        let reader = std::thread::spawn(move || fs::read(source).unwrap());
        bench.works(&line);
        assert!(reader.join().unwrap().len() > 100, "{line}");
    }
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    bench.works(&format!("{RENDER} --format png --out /dev/null"));
    symlink("/dev/null", bench.path("null")).unwrap();
    bench.works(&format!("{SUBSET} --out null"));
    assert!(
        fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );
    symlink("target.png", bench.path("link.png")).unwrap();
    bench.works(&format!("{RENDER} --out link.png"));
    assert!(
        fs::symlink_metadata(bench.path("link.png"))
            .unwrap()
            .is_symlink()
    );
    assert!(
        fs::read(bench.path("target.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
}

/// Ordinary users meet folders that they may write to but not read. The superuser may read all, unless a tool takes
/// that away.
#[test]
fn folders_may_be_unreadable() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::new();
    let folder = bench.path("drop");
    fs::create_dir(&folder).unwrap();
    fs::set_permissions(bench.0.path(), fs::Permissions::from_mode(0o755)).unwrap();
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o333)).unwrap();
    let line = format!("{RENDER} --out drop/a");
    let mut command = match fs::read_dir(&folder) {
        Err(_) => bench.command(&line),
        Ok(_) => as_nobody(&bench, &line),
    };
    let output = match command.output() {
        Ok(output) => output,
        // Without that tool there is nothing to see.
        Err(_) => return,
    };
    assert!(output.status.success(), "{output:?}");
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o755)).unwrap();
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
}

/// The command without the rights of the superuser, with a copy where all may run it.
fn as_nobody(bench: &Bench, line: &str) -> Command {
    let program = bench.path("welkin");
    fs::copy(env!("CARGO_BIN_EXE_welkin"), &program).unwrap();
    let mut command = Command::new("setpriv");
    command.args(["--reuid", "65534", "--regid", "65534", "--clear-groups"]);
    command.arg(program).args(line.split(' '));
    command.current_dir(bench.0.path());
    command
}

fn wait_for(condition: impl Fn() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < Duration::from_secs(120), "it never came");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn temporaries(folder: &Path) -> usize {
    let names = fs::read_dir(folder).unwrap();
    let names = names.map(|e| e.unwrap().file_name().into_string().unwrap());
    names.filter(|n| n.ends_with(".tmp")).count()
}

/// A render whose PNG goes to a FIFO that nobody reads: it stops when the temporary file of the EXR is complete.
fn stopped_midway(bench: &Bench) -> Child {
    use std::os::unix::fs::symlink;
    let pipe = bench.path("pipe");
    fifo(&pipe);
    symlink("pipe", bench.path("sky.png")).unwrap();
    fs::write(bench.path("sky.exr"), "old").unwrap();
    let line = format!("{RENDER} --out sky");
    let child = bench
        .command(&line)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let folder = bench.0.path().to_owned();
    wait_for(|| {
        let names = fs::read_dir(&folder).unwrap().map(|e| e.unwrap());
        let mut sizes = names
            .filter(|e| e.path().extension().is_some_and(|e| e == "tmp"))
            .map(|e| e.metadata().map_or(0, |m| m.len()));
        sizes.any(|size| size > 100)
    });
    child
}

#[test]
fn a_killed_writer_leaves_the_old_file_and_the_next_write_sweeps() {
    let bench = Bench::new();
    let mut child = stopped_midway(&bench);
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(fs::read(bench.path("sky.exr")).unwrap(), b"old");
    assert_eq!(temporaries(bench.0.path()), 1);
    fs::remove_file(bench.path("sky.png")).unwrap();
    bench.works(&format!("{RENDER} --out sky"));
    assert_eq!(temporaries(bench.0.path()), 0);
    assert_ne!(fs::read(bench.path("sky.exr")).unwrap(), b"old");
}

#[test]
fn signals_leave_nothing_behind() {
    use std::os::unix::process::ExitStatusExt;
    // Whoever runs tests in the background of a script has them ignore some.
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|l| l.strip_prefix("SigIgn:"));
    let mask = mask.map_or(0, |m| u64::from_str_radix(m.trim(), 16).unwrap());
    let signals = [("INT", 2), ("TERM", 15), ("HUP", 1)];
    for (name, number) in signals {
        if mask >> (number - 1) & 1 == 1 {
            continue;
        }
        let bench = Bench::new();
        let mut child = stopped_midway(&bench);
        let signal = format!("kill -{name} {}", child.id());
        assert!(
            Command::new("sh")
                .args(["-c", &signal])
                .status()
                .unwrap()
                .success()
        );
        let status = child.wait().unwrap();
        assert_eq!(status.signal(), Some(number), "{name}: {status}");
        assert_eq!(fs::read(bench.path("sky.exr")).unwrap(), b"old");
        assert_eq!(temporaries(bench.0.path()), 0, "{name}");
        let mut text = String::new();
        child
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut text)
            .unwrap();
        assert!(text.is_empty(), "{text}");
    }
}

/// `nohup` means it.
#[cfg(target_os = "linux")]
#[test]
fn ignored_signals_stay_ignored() {
    let bench = Bench::new();
    let script = format!(
        "trap '' HUP; {} {RENDER} --out a & sleep 0.05; kill -HUP $!; wait $!",
        env!("CARGO_BIN_EXE_welkin")
    );
    let status = Command::new("bash")
        .args(["-c", &script])
        .current_dir(bench.0.path())
        .status();
    assert!(status.unwrap().success());
    assert!(bench.path("a.exr").exists());
}
