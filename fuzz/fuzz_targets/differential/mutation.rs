//! Changes of a file that follow its structure.

use crate::bytes::Bytes;
use crate::parts::{Chunk, Frame, Parts, seal};
use crate::spectrum;

/// What the changes were.
#[derive(Default)]
pub struct Changes {
    pub count: usize,
    /// A number became absurd: values are not compared.
    pub wild: bool,
    /// What was done, for whoever reads a finding.
    pub told: Vec<String>,
}

const DOUBLES: [f64; 28] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    8.0,
    9.0,
    0.99,
    1e-3,
    9.99e-4,
    1e-6,
    9e-7,
    1e6,
    1.1e6,
    1e9,
    1.1e9,
    1e3,
    999.0,
    1e30,
    1.1e30,
    1e300,
    5e-324,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    std::f64::consts::FRAC_PI_2,
    -std::f64::consts::FRAC_PI_2,
];
const SINGLES: [f32; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    1e6,
    1.1e6,
    1e-30,
    1e30,
    88.0,
    -88.0,
    1e-45,
    f32::MAX,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
];
const HALVES: [u16; 10] = [
    0, 0x8000, 0x3c00, 0xbc00, 1, 0x7bff, 0xfbff, 0x7c00, 0xfc00, 0x7e00,
];
const WORDS: [u32; 20] = [
    0,
    1,
    2,
    3,
    4,
    5,
    8,
    9,
    16,
    17,
    24,
    25,
    32,
    33,
    64,
    65,
    256,
    257,
    1 << 31,
    u32::MAX,
];
const LONGS: [u64; 8] = [0, 1, 63, 64, 128, 1 << 32, 1 << 63, u64::MAX];

/// The file that the bytes say, made from one that is valid.
pub fn mutated(bytes: &mut Bytes, parts: &Parts) -> (Vec<u8>, Changes) {
    let mut parts = parts.clone();
    let mut changes = Changes::default();
    for _ in 0..bytes.below(4) {
        change_part(bytes, &mut parts, &mut changes);
        changes.count += 1;
    }
    let mut file = parts.assembled();
    if bytes.below(6) == 0 {
        change_file(bytes, &mut file, &mut changes);
        changes.count += 1;
    }
    (file, changes)
}

fn change_part(bytes: &mut Bytes, parts: &mut Parts, changes: &mut Changes) {
    let told = match bytes.below(19) {
        0 => header_number(bytes, &mut parts.header, changes),
        1 => header_count(bytes, &mut parts.header),
        2 | 3 => nudged_double(bytes, &mut parts.header[64..], changes),
        4 | 5 => arrays(bytes, &mut parts.arrays, changes),
        6 => entry(bytes, &mut parts.chunks),
        7 => directory(bytes, &mut parts.chunks),
        8 => unknown(bytes, &mut parts.chunks),
        9..=12 => payload(bytes, &mut parts.chunks, changes),
        13 => length(bytes, &mut parts.chunks),
        14 => frame(bytes, &mut parts.chunks),
        15..=17 => spectrum::change(bytes, &parts.header, &mut parts.chunks),
        _ => {
            parts.gap = bytes.byte();
            Some("gaps".to_owned())
        }
    };
    changes.told.extend(told);
}

fn header_number(bytes: &mut Bytes, header: &mut [u8], changes: &mut Changes) -> Option<String> {
    let at = 64 + 8 * bytes.below(8);
    let value = bytes.one_of(&DOUBLES);
    changes.wild = true;
    header[at..at + 8].copy_from_slice(&value.to_le_bytes());
    Some(format!("header {at} = {value}"))
}

fn header_count(bytes: &mut Bytes, header: &mut [u8]) -> Option<String> {
    let at = 40 + 2 * bytes.below(12);
    let value = bytes.one_of(&[
        0u16,
        1,
        2,
        3,
        4,
        5,
        16,
        17,
        256,
        257,
        1024,
        1025,
        16384,
        u16::MAX,
    ]);
    header[at..at + 2].copy_from_slice(&value.to_le_bytes());
    Some(format!("count {at} = {value}"))
}

/// A number becomes a little larger or smaller.
fn nudged_double(bytes: &mut Bytes, table: &mut [u8], changes: &mut Changes) -> Option<String> {
    let at = 8 * bytes.below(table.len() / 8);
    let place: &mut [u8; 8] = (&mut table[at..at + 8]).try_into().ok()?;
    let old = f64::from_le_bytes(*place);
    let value = old * bytes.one_of(&[0.9, 0.99, 1.01, 1.1, 1.0 + 1e-9]);
    changes.wild |= !value.is_finite();
    *place = value.to_le_bytes();
    Some(format!("double {at}: {old} to {value}"))
}

fn arrays(bytes: &mut Bytes, arrays: &mut [u8], changes: &mut Changes) -> Option<String> {
    if bytes.below(3) > 0 {
        // The doubles come first.
        let most = (arrays.len() / 2).min(4096) & !7;
        return nudged_double(bytes, &mut arrays[..most], changes);
    }
    changes.wild = true;
    match bytes.below(4) {
        0 => {
            let at = bytes.below(arrays.len());
            arrays[at] ^= bytes.byte();
            Some(format!("array byte {at}"))
        }
        1 => put(arrays, bytes.u32(), &bytes.one_of(&WORDS).to_le_bytes()),
        2 => put(arrays, bytes.u32(), &bytes.one_of(&SINGLES).to_le_bytes()),
        _ => put(arrays, bytes.u32(), &bytes.one_of(&DOUBLES).to_le_bytes()),
    }
}

/// Writes a number at a place that its size divides.
fn put(table: &mut [u8], place: u32, value: &[u8]) -> Option<String> {
    let n = value.len();
    let places = table.len() / n;
    let at = n * (place as usize).checked_rem(places)?;
    table[at..at + n].copy_from_slice(value);
    Some(format!("{value:?} at {at} of {}", table.len()))
}

fn any<'a>(bytes: &mut Bytes, chunks: &'a mut [Chunk]) -> Option<&'a mut Chunk> {
    let n = chunks.len();
    chunks.get_mut(bytes.below(n))
}

fn entry(bytes: &mut Bytes, chunks: &mut [Chunk]) -> Option<String> {
    let chunk = any(bytes, chunks)?;
    let (at, value): (usize, Vec<u8>) = match bytes.below(9) {
        0 => (0, bytes.one_of(&WORDS).to_le_bytes().to_vec()),
        1 => (
            4,
            bytes
                .one_of(&[0u16, 1, 2, 3, u16::MAX])
                .to_le_bytes()
                .to_vec(),
        ),
        2 => (
            6,
            bytes
                .one_of(&[0u16, 1, 2, 3, u16::MAX])
                .to_le_bytes()
                .to_vec(),
        ),
        3 => (24, bytes.one_of(&LONGS).to_le_bytes().to_vec()),
        4 => (32, bytes.one_of(&WORDS).to_le_bytes().to_vec()),
        5 => (
            40,
            bytes
                .one_of(&[0u32, 1, 4, 5, 6, 16, 17, 4096, 4097])
                .to_le_bytes()
                .to_vec(),
        ),
        6 => (44, bytes.one_of(&WORDS).to_le_bytes().to_vec()),
        7 => (
            48 + 4 * bytes.below(2),
            bytes.one_of(&SINGLES).to_le_bytes().to_vec(),
        ),
        _ => (56, bytes.one_of(&LONGS).to_le_bytes().to_vec()),
    };
    chunk.entry[at..at + value.len()].copy_from_slice(&value);
    if [24, 32].contains(&at) {
        chunk.stale = true;
        // Still a right checksum.
        let crc = crc32fast::hash(&chunk.payload);
        chunk.entry[36..40].copy_from_slice(&crc.to_le_bytes());
    }
    Some(format!("entry {at} = {value:?}"))
}

fn directory(bytes: &mut Bytes, chunks: &mut Vec<Chunk>) -> Option<String> {
    let n = chunks.len();
    if n == 0 {
        return None;
    }
    let (a, b) = (bytes.below(n), bytes.below(n));
    match bytes.below(4) {
        0 => {
            let copy = chunks[a].clone();
            chunks.insert(b, copy);
            Some(format!("chunk {a} again at {b}"))
        }
        1 => {
            chunks.swap(a, b);
            Some(format!("chunks {a} and {b} swapped"))
        }
        2 => {
            chunks[a].payload = chunks[b].payload.clone();
            Some(format!("payload of {b} in {a}"))
        }
        _ => {
            chunks.remove(a);
            Some(format!("without chunk {a}"))
        }
    }
}

fn unknown(bytes: &mut Bytes, chunks: &mut Vec<Chunk>) -> Option<String> {
    let mut entry = [bytes.byte(); 64];
    let kind = bytes.one_of(&[0u32, 9, 10, 1 << 31, u32::MAX]);
    entry[..4].copy_from_slice(&kind.to_le_bytes());
    let length = bytes.one_of(&[0, 1, 5, 64]);
    let chunk = Chunk {
        entry,
        payload: vec![bytes.byte(); length],
        packed: None,
        stale: true,
    };
    let at = bytes.below(chunks.len() + 1);
    chunks.insert(at, chunk);
    Some(format!("unknown kind {kind} of {length} bytes at {at}"))
}

/// Numbers of a payload: absurd ones, or others of the same table.
fn payload(bytes: &mut Bytes, chunks: &mut [Chunk], changes: &mut Changes) -> Option<String> {
    let chunk = any(bytes, chunks)?;
    let of_halves = [3, 7].contains(&u32::from_le_bytes(chunk.entry[..4].try_into().ok()?));
    let table = &mut chunk.payload;
    // Counts stand in front, where they are.
    let near = match bytes.below(3) {
        0 => table.len().min(40),
        _ => table.len(),
    };
    let table = &mut table[..near];
    let told = match bytes.below(6) {
        0 => put(table, bytes.u32(), &bytes.one_of(&WORDS).to_le_bytes()),
        1 => put(table, bytes.u32(), &bytes.one_of(&HALVES).to_le_bytes()),
        2 => put(table, bytes.u32(), &bytes.one_of(&SINGLES).to_le_bytes()),
        3 => put(table, bytes.u32(), &bytes.one_of(&DOUBLES).to_le_bytes()),
        4 => {
            // Half of a larger number is another number altogether.
            changes.wild |= !of_halves;
            return neighbour(bytes, table, 2);
        }
        _ => return neighbour(bytes, table, 4),
    };
    changes.wild = true;
    told
}

fn neighbour(bytes: &mut Bytes, table: &mut [u8], size: usize) -> Option<String> {
    let places = table.len() / size;
    if places < 2 {
        return None;
    }
    let at = size * (bytes.u32() as usize % (places - 1));
    table.copy_within(at + size..at + 2 * size, at);
    Some(format!("{size} bytes at {at} like those behind them"))
}

fn length(bytes: &mut Bytes, chunks: &mut [Chunk]) -> Option<String> {
    let chunk = any(bytes, chunks)?;
    let n = chunk.payload.len();
    let n = bytes.one_of(&[
        0,
        1,
        4,
        7,
        8,
        31,
        32,
        n / 2,
        n.saturating_sub(4),
        n.saturating_sub(2),
        n + 2,
        n + 4,
    ]);
    chunk.payload.resize(n, 0);
    Some(format!("payload of {n} bytes"))
}

fn frame(bytes: &mut Bytes, chunks: &mut [Chunk]) -> Option<String> {
    let chunk = any(bytes, chunks)?;
    let damage = (bytes.below(2) == 0).then(|| (bytes.u32(), bytes.byte()));
    chunk.packed = Some(Frame {
        checksum: bytes.below(2) == 0,
        damage,
        tail: bytes.one_of(&[0, 0, 0, 0, 1, 4]),
        dictionary: bytes.one_of(&[0, 0, 1, 2, 3]),
    });
    chunk.stale = false;
    Some(format!("a frame, damaged at {damage:?}"))
}

/// Changes that assembling would undo.
fn change_file(bytes: &mut Bytes, file: &mut Vec<u8>, changes: &mut Changes) {
    let head = u64::from_le_bytes(file[24..32].try_into().expect("eight bytes")) as usize;
    let told = match bytes.below(8) {
        0 => {
            let at = bytes.below(file.len());
            file[at] ^= 1 << bytes.below(8);
            changes.wild = true;
            format!("a bit at {at}")
        }
        1 => {
            let n = bytes.one_of(&[0, 5, 8, 100, 128, head / 2, file.len() - 1]);
            file.truncate(n);
            format!("{n} bytes")
        }
        2 => {
            file.push(0);
            "a byte too many".to_owned()
        }
        3 => {
            file.extend([0; 64]);
            let length = file.len() as u64;
            file[16..24].copy_from_slice(&length.to_le_bytes());
            "a hole at the end".to_owned()
        }
        4 => {
            let at = bytes.one_of(&[8, 10, 12, 14]);
            file[at] ^= bytes.byte();
            format!("version or features at {at}")
        }
        5 => {
            let at = bytes.one_of(&[16, 24]);
            let old = u64::from_le_bytes(file[at..at + 8].try_into().expect("eight bytes"));
            let value = bytes.one_of(&[0, old + 1, old - 8, old + 8, old + 64, u64::MAX]);
            file[at..at + 8].copy_from_slice(&value.to_le_bytes());
            format!("length at {at} = {value}")
        }
        6 => {
            let value = bytes.one_of(&WORDS);
            let at = bytes.one_of(&[36, 60]);
            file[at..at + 4].copy_from_slice(&value.to_le_bytes());
            format!("count at {at} = {value}")
        }
        _ => return change_place(bytes, file, head, changes),
    };
    changes.told.push(told);
    if bytes.below(4) > 0 {
        seal(file, head);
    }
}

/// Where a chunk is, how long it is, or its checksum.
fn change_place(bytes: &mut Bytes, file: &mut [u8], head: usize, changes: &mut Changes) {
    let count = u32::from_le_bytes(file[36..40].try_into().expect("four bytes")) as usize;
    if count == 0 {
        return;
    }
    let entry = head - 64 * (1 + bytes.below(count));
    let at = entry + bytes.one_of(&[8, 16, 36]);
    let old = u64::from_le_bytes(file[at..at + 8].try_into().expect("eight bytes"));
    let value = match bytes.below(5) {
        0 => bytes.one_of(&LONGS),
        1 => old.wrapping_add(64),
        2 => old.wrapping_sub(64),
        3 => old.wrapping_add(1),
        _ => old.wrapping_sub(1),
    };
    let n = if at - entry == 36 { 4 } else { 8 };
    file[at..at + n].copy_from_slice(&value.to_le_bytes()[..n]);
    seal(file, head);
    changes.told.push(format!("entry {} = {value}", at - entry));
}
