//! A file taken apart, so that any part can change and everything that depends on it can be made right.

use welkin::format::{ENCODING_RAW, ENCODING_ZSTD, parse};

#[derive(Clone)]
pub struct Chunk {
    pub entry: [u8; 64],
    /// The payload, decoded.
    pub payload: Vec<u8>,
    /// Stored as a frame.
    pub packed: Option<Frame>,
    /// Fields of the entry that follow from the payload are left as they are.
    pub stale: bool,
}

/// How a payload is compressed.
#[derive(Clone, Copy, Default)]
pub struct Frame {
    pub checksum: bool,
    /// A byte of the frame and what it is changed by.
    pub damage: Option<(u32, u8)>,
    /// What follows the frame.
    pub tail: u8,
    /// Bytes of a Dictionary_ID of 0.
    pub dictionary: u8,
}

#[derive(Clone)]
pub struct Parts {
    pub header: Vec<u8>,
    pub arrays: Vec<u8>,
    pub chunks: Vec<Chunk>,
    pub gap: u8,
}

impl Parts {
    pub fn of(file: &[u8]) -> Self {
        let contents = parse(file).expect("a valid file");
        let directory = contents.head_length - 64 * contents.directory.len();
        let entries = file[directory..contents.head_length].chunks_exact(64);
        let chunks = contents.directory.iter().zip(entries).map(|(e, entry)| {
            let stored = &file[e.offset..e.offset + e.length];
            let unpacked = zstd::bulk::decompress(stored, e.raw_length.min(1 << 24));
            let packed = unpacked
                .as_ref()
                .ok()
                .filter(|_| e.encoding == ENCODING_ZSTD);
            Chunk {
                entry: entry.try_into().expect("64 bytes"),
                packed: packed.map(|_| Frame::default()),
                payload: packed.cloned().unwrap_or_else(|| stored.to_vec()),
                stale: false,
            }
        });
        Self {
            header: file[..128].to_vec(),
            arrays: file[128..directory].to_vec(),
            chunks: chunks.collect(),
            gap: 0,
        }
    }

    /// The file, with places, lengths and checksums as they must be.
    pub fn assembled(&self) -> Vec<u8> {
        let mut bytes = [&self.header[..], &self.arrays].concat();
        let directory = bytes.len();
        let head_length = directory + 64 * self.chunks.len();
        bytes.resize(head_length, 0);
        for (i, chunk) in self.chunks.iter().enumerate() {
            bytes.resize(bytes.len().next_multiple_of(64), self.gap);
            let stored = chunk.stored();
            let mut entry = chunk.entry;
            entry[8..16].copy_from_slice(&(bytes.len() as u64).to_le_bytes());
            entry[16..24].copy_from_slice(&(stored.len() as u64).to_le_bytes());
            if !chunk.stale {
                entry[24..32].copy_from_slice(&(chunk.payload.len() as u64).to_le_bytes());
                let encoding = chunk.packed.map_or(ENCODING_RAW, |_| ENCODING_ZSTD);
                entry[32..36].copy_from_slice(&encoding.to_le_bytes());
                entry[36..40].copy_from_slice(&crc32fast::hash(&stored).to_le_bytes());
            }
            bytes[directory + 64 * i..][..64].copy_from_slice(&entry);
            bytes.extend(stored);
        }
        let length = bytes.len() as u64;
        bytes[16..24].copy_from_slice(&length.to_le_bytes());
        bytes[24..32].copy_from_slice(&(head_length as u64).to_le_bytes());
        bytes[36..40].copy_from_slice(&(self.chunks.len() as u32).to_le_bytes());
        seal(&mut bytes, head_length);
        bytes
    }
}

/// Makes the checksum of a head right.
pub fn seal(bytes: &mut [u8], head_length: usize) {
    let Some(head) = bytes
        .get_mut(..head_length)
        .filter(|head| head.len() >= 128)
    else {
        return;
    };
    head[32..36].fill(0);
    let crc = crc32fast::hash(head);
    head[32..36].copy_from_slice(&crc.to_le_bytes());
}

impl Chunk {
    fn stored(&self) -> Vec<u8> {
        match self.packed {
            None => self.payload.clone(),
            Some(frame) => frame.pack(&self.payload),
        }
    }
}

impl Frame {
    fn pack(self, payload: &[u8]) -> Vec<u8> {
        let mut compressor = zstd::bulk::Compressor::new(1).expect("an encoder");
        compressor
            .include_checksum(self.checksum)
            .expect("a known parameter");
        let mut frame = compressor.compress(payload).expect("a frame");
        if self.dictionary > 0 && frame[4] & 0x23 == 0x20 {
            let n = [0, 1, 2, 4][usize::from(self.dictionary % 4)];
            frame[4] |= self.dictionary % 4;
            frame.splice(5..5, std::iter::repeat_n(0, n));
        }
        if let Some((at, change)) = self.damage {
            let at = at as usize % frame.len().min(16);
            frame[at] ^= change;
        }
        frame.extend(std::iter::repeat_n(0, usize::from(self.tail)));
        frame
    }
}
