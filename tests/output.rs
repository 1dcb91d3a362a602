//! Files are written whole or not at all, and to where their names lead.
#![cfg(unix)]

use std::fs;
use std::io::{ErrorKind, Read};
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

use welkin::Error;
use welkin::output::{check, replace_file, replace_files};

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    }
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().mode() & 0o7777
}

fn kind(error: Error) -> ErrorKind {
    match error {
        Error::Io { source, .. } => source.kind(),
        other => panic!("{other}"),
    }
}

fn fifo(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

#[test]
fn files_are_replaced_with_their_modes_and_no_litter() {
    let folder = Folder::new();
    let file = folder.path("a");
    for allowed in [0o600, 0o644, 0o666, 0o751, 0o4755] {
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(allowed)).unwrap();
        let before = fs::metadata(&file).unwrap();
        replace_file(&file, b"new").unwrap();
        let after = fs::metadata(&file).unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(mode(&file), allowed, "{allowed:o}");
        assert_ne!(before.ino(), after.ino(), "written in its place");
        assert_eq!((before.uid(), before.gid()), (after.uid(), after.gid()));
    }
    assert_eq!(folder.names(), ["a"]);
}

/// Only the superuser can give files away.
#[test]
fn owners_are_kept() {
    let folder = Folder::new();
    let file = folder.path("a");
    fs::write(&file, "old").unwrap();
    if std::os::unix::fs::chown(&file, Some(12345), Some(23456)).is_err() {
        return;
    }
    fs::set_permissions(&file, fs::Permissions::from_mode(0o6711)).unwrap();
    replace_file(&file, b"new").unwrap();
    let after = fs::metadata(&file).unwrap();
    assert_eq!((after.uid(), after.gid()), (12345, 23456));
    assert_eq!(mode(&file), 0o6711);
}

#[test]
fn links_stay_and_lead_to_what_is_written() {
    let folder = Folder::new();
    fs::create_dir(folder.path("elsewhere")).unwrap();
    fs::write(folder.path("elsewhere/old"), "old").unwrap();
    // Relative to the folder of the link, not of the process.
    symlink("elsewhere/old", folder.path("to-old")).unwrap();
    symlink("to-old", folder.path("twice")).unwrap();
    symlink("elsewhere/missing", folder.path("dangling")).unwrap();
    symlink("dangling", folder.path("twice-dangling")).unwrap();
    for (link, target) in [
        ("to-old", "elsewhere/old"),
        ("twice", "elsewhere/old"),
        ("dangling", "elsewhere/missing"),
        ("twice-dangling", "elsewhere/missing"),
    ] {
        replace_file(folder.path(link), link.as_bytes()).unwrap();
        assert!(
            fs::symlink_metadata(folder.path(link))
                .unwrap()
                .is_symlink()
        );
        assert_eq!(fs::read(folder.path(target)).unwrap(), link.as_bytes());
    }
    assert_eq!(fs::read_dir(folder.path("elsewhere")).unwrap().count(), 2);
    symlink("b", folder.path("a")).unwrap();
    symlink("a", folder.path("b")).unwrap();
    assert!(replace_file(folder.path("a"), b"").is_err());
    assert!(check(folder.path("a")).is_err());
    symlink("elsewhere", folder.path("folder")).unwrap();
    let refused = replace_file(folder.path("folder"), b"").unwrap_err();
    assert_eq!(kind(refused), ErrorKind::IsADirectory);
}

#[test]
fn what_is_no_file_is_written_straight_to() {
    let folder = Folder::new();
    let pipe = folder.path("pipe");
    fifo(&pipe);
    symlink("pipe", folder.path("link")).unwrap();
    for name in ["pipe", "link"] {
        let source = pipe.clone();
        let reader = std::thread::spawn(move || fs::read(source).unwrap());
        check(folder.path(name)).unwrap();
        replace_file(folder.path(name), &[7; 100_000]).unwrap();
        assert_eq!(reader.join().unwrap(), [7; 100_000]);
    }
    symlink("/dev/null", folder.path("null")).unwrap();
    replace_file(folder.path("null"), b"gone").unwrap();
    let socket = std::os::unix::net::UnixListener::bind(folder.path("socket")).unwrap();
    let reader = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        socket.accept().unwrap().0.read_to_end(&mut bytes).unwrap();
        bytes
    });
    replace_file(folder.path("socket"), b"sent").unwrap();
    assert_eq!(reader.join().unwrap(), b"sent");
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    assert!(
        fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );
    assert_eq!(folder.names(), ["link", "null", "pipe", "socket"]);
}

/// An open file that the process was given is appended to, even where it is a regular one.
#[cfg(target_os = "linux")]
#[test]
fn descriptors_keep_what_is_in_them() {
    use std::os::fd::AsRawFd;
    let folder = Folder::new();
    let file = folder.path("a");
    fs::write(&file, "before, ").unwrap();
    let open = fs::File::open(&file).unwrap();
    let inode = open.metadata().unwrap().ino();
    replace_file(format!("/dev/fd/{}", open.as_raw_fd()), b"after").unwrap();
    assert_eq!(fs::read(&file).unwrap(), b"before, after");
    assert_eq!(fs::metadata(&file).unwrap().ino(), inode);
}

#[test]
fn names_may_be_as_long_as_the_system_allows() {
    let folder = Folder::new();
    for name in ["n".repeat(254), "é".repeat(127), "n".repeat(255)] {
        replace_file(folder.path(&name), b"new").unwrap();
        replace_file(folder.path(&name), b"newer").unwrap();
        assert_eq!(fs::read(folder.path(&name)).unwrap(), b"newer");
    }
    assert_eq!(folder.names().len(), 3);
}

#[test]
fn folders_and_missing_names_are_refused() {
    let folder = Folder::new();
    fs::create_dir(folder.path("folder")).unwrap();
    for (name, expected) in [
        ("folder", ErrorKind::IsADirectory),
        ("folder/", ErrorKind::InvalidInput),
        ("folder/.", ErrorKind::InvalidInput),
        ("folder/..", ErrorKind::InvalidInput),
        ("missing/", ErrorKind::InvalidInput),
        ("missing/file", ErrorKind::NotFound),
    ] {
        let path = folder.path(name);
        assert_eq!(kind(check(&path).unwrap_err()), expected, "{name}");
        assert_eq!(kind(replace_file(&path, b"").unwrap_err()), expected);
    }
    for name in ["", ".", "..", "/"] {
        assert_eq!(kind(check(name).unwrap_err()), ErrorKind::InvalidInput);
    }
    assert_eq!(folder.names(), ["folder"]);
}

#[test]
fn checks_leave_everything_as_it_was() {
    let folder = Folder::new();
    fs::write(folder.path("old"), "old").unwrap();
    check(folder.path("old")).unwrap();
    check(folder.path("new")).unwrap();
    assert_eq!(fs::read(folder.path("old")).unwrap(), b"old");
    assert_eq!(folder.names(), ["old"]);
}

#[test]
fn files_that_belong_together_are_written_together() {
    let folder = Folder::new();
    let [a, b] = ["a", "b"].map(|n| folder.path(n));
    fs::write(&a, "old").unwrap();
    let refused = replace_files(&[(&a, b"new"), (&folder.path("missing/b"), b"new")]);
    assert_eq!(kind(refused.unwrap_err()), ErrorKind::NotFound);
    assert_eq!(fs::read(&a).unwrap(), b"old");
    assert_eq!(folder.names(), ["a"]);
    replace_files(&[(&a, b"new"), (&b, b"new")]).unwrap();
    assert_eq!([&a, &b].map(|p| fs::read(p).unwrap()), [b"new", b"new"]);
    assert_eq!(folder.names(), ["a", "b"]);
}

/// Every reader sees the bytes of one writer, however many there are.
#[test]
fn writers_of_one_file_do_not_meet() {
    let folder = Folder::new();
    let file = folder.path("a");
    replace_file(&file, &[0; 5000]).unwrap();
    std::thread::scope(|scope| {
        for writer in 1..=24 {
            let file = &file;
            scope.spawn(move || {
                for _ in 0..20 {
                    replace_file(file, &[writer; 5000]).unwrap();
                }
            });
        }
        for _ in 0..300 {
            let bytes = fs::read(&file).unwrap();
            assert!(bytes.len() == 5000 && bytes.iter().all(|b| *b == bytes[0]));
        }
    });
    assert_eq!(folder.names(), ["a"]);
}

/// Temporary files without a living writer go with the next write of any file beside them, and only those.
#[test]
fn litter_of_the_dead_is_swept_and_the_living_are_left_alone() {
    let folder = Folder::new();
    let temporary = |name: &str, n: usize| {
        let hash = crc32fast::hash(name.as_bytes());
        folder.path(&format!(".welkin-{hash:08x}-{n}.tmp"))
    };
    let (dead, living) = ([0, 2, 6], 1);
    for n in dead {
        fs::write(temporary("a", n), "half").unwrap();
    }
    fs::write(temporary("b", 0), "of another target").unwrap();
    fs::write(folder.path(".welkin-notes.tmp"), "of somebody else").unwrap();
    let alive = fs::File::create(temporary("a", living)).unwrap();
    alive.try_lock().unwrap();
    replace_file(folder.path("a"), b"new").unwrap();
    for n in dead {
        assert!(!temporary("a", n).exists(), "{n}");
    }
    assert!(!temporary("b", 0).exists());
    assert!(temporary("a", living).exists());
    assert_eq!(folder.names().len(), 3);
    drop(alive);
    replace_file(folder.path("a"), b"new").unwrap();
    assert_eq!(folder.names(), [".welkin-notes.tmp", "a"]);
}
