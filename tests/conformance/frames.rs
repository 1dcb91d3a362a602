//! zstd frames with other headers than an encoder writes (RFC 8878, section 3.1.1.1).

/// What stands before the blocks of a frame.
#[derive(Clone, Copy, Default)]
pub struct Start<'a> {
    /// Window_Descriptor; without it the window is as wide as the content.
    pub window: Option<u8>,
    /// Dictionary_ID: 0, 1, 2 or 4 bytes.
    pub dictionary: &'a [u8],
    /// Without Frame_Content_Size.
    pub silent: bool,
    /// The reserved bit of the descriptor.
    pub reserved: bool,
}

/// The blocks of `frame` behind another start. The frame must be as the encoder makes it of content of known length.
pub fn restarted(frame: &[u8], start: Start) -> Vec<u8> {
    let (descriptor, magic) = (frame[4], &frame[..4]);
    assert!(
        descriptor & 0x2b == 0x20,
        "a frame of one segment without dictionary"
    );
    let width = [1, 2, 4, 8][usize::from(descriptor >> 6)];
    let (size, blocks) = frame[5..].split_at(width);
    let mut declared = [0; 8];
    declared[..width].copy_from_slice(size);
    let declared = u64::from_le_bytes(declared) + if width == 2 { 256 } else { 0 };
    let flag = match start.dictionary.len() {
        4 => 3,
        n => n as u8,
    };
    let size = if start.silent { 0 } else { 3 << 6 };
    let segment = u8::from(start.window.is_none()) << 5;
    let reserved = u8::from(start.reserved) << 3;
    let descriptor = size | segment | reserved | (descriptor & 4) | flag;
    let mut bytes = [magic, &[descriptor]].concat();
    bytes.extend(start.window);
    bytes.extend(start.dictionary);
    if !start.silent {
        bytes.extend(declared.to_le_bytes());
    }
    bytes.extend(blocks);
    bytes
}

/// A frame that ends with a checksum of its content.
pub fn with_checksum(content: &[u8]) -> Vec<u8> {
    let mut compressor = zstd::bulk::Compressor::new(3).expect("an encoder");
    compressor
        .include_checksum(true)
        .expect("a known parameter");
    compressor.compress(content).expect("a frame")
}
