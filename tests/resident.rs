//! Memory that a process holds for one sky. Alone in its file, so that nothing else runs in the process.
#![cfg(all(target_os = "linux", feature = "mmap"))]

use std::hint::black_box;
use welkin::{BakedSky, Conditions, Model};

/// Resident memory of this process, kB: anonymous, and the pages of files with this ending.
///
/// Page by page: the sums in /proc/self/status are kept per processor and lag behind.
fn resident(ending: &str) -> [usize; 2] {
    let maps = std::fs::read_to_string("/proc/self/smaps").unwrap();
    let mut here = false;
    let [mut anonymous, mut pages] = [0, 0];
    for line in maps.lines() {
        let mut words = line.split_whitespace();
        let name = words.next().unwrap_or_default();
        let number = |word: Option<&str>| word.and_then(|n| n.parse::<usize>().ok()).unwrap();
        match name {
            "Anonymous:" => anonymous += number(words.next()),
            "Rss:" if here => pages += number(words.next()),
            // The first line of a mapping: its addresses.
            _ if name.contains('-') => here = line.ends_with(ending),
            _ => {}
        }
    }
    [anonymous, pages]
}

#[test]
fn a_sky_on_the_ground_takes_less_than_a_megabyte() {
    let [before, _] = resident("default.welkin");
    let model = Model::open("models/default.welkin").unwrap();
    let sky = model.colour_sky(&Conditions::default()).unwrap();
    let colour = sky.bake(BakedSky::TOLERANCE).unwrap();
    drop(sky);
    black_box(colour.xyz([0.0, 0.0, 1.0]).unwrap());
    let [after, mapped] = resident("default.welkin");
    let anonymous = after.saturating_sub(before);
    println!("anonymous {anonymous} kB, of the model {mapped} kB");
    // The code that runs for the first time comes on top: the tool `resident` counts it, too.
    assert!(anonymous > 0 && mapped > 0);
    assert!(anonymous + mapped <= 1000, "{anonymous} {mapped}");
    assert!(model.touched_bytes() < 300_000);
}
